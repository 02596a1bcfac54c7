#include "spectral/uniaxial.h"

#include "base/maths.h"
#include "spectral/film.h"

#include <complex.h>
#include <math.h>
#include <string.h>

typedef double complex number;

static const double grazing = 1e-6; /* below, rounding hides in which direction it goes */

static void cross(const number a[3], const number b[3], number out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* ---- one wave ---- */

double abbe_uniaxial_index(double n_o, double n_e, double cos_axis) {
  const double c = fmin(fabs(cos_axis), 1), s = sqrt((1 - c) * (1 + c));
  return n_o * n_e / hypot(n_e * c, n_o * s);
}

double abbe_uniaxial_walk_off(double n_o, double n_e, double cos_axis) {
  const double c = fmin(fabs(cos_axis), 1), s = sqrt((1 - c) * (1 + c));
  const double o = n_o * n_o, e = n_e * n_e;
  return fabs(atan2((o - e) * s * c, e * c * c + o * s * s));
}

/* E of unit length is across the ray, so that E x H along it has the length of H, and that is the
 * root of E* Re(permittivity) E. */
double abbe_uniaxial_attenuation(double n_o, double n_e, double a_o, double a_e, double cos_ray) {
  const double c = fmin(fabs(cos_ray), 1), along = (1 - c) * (1 + c), across = c * c;
  return (n_o * a_o * across + n_e * a_e * along) / sqrt(n_o * n_o * across + n_e * n_e * along);
}

/* The part of v along the axis times `along`, and the part across it times `across`. */
static void stretch(const abbe_uniaxial *m, const double v[3], double along, double across,
                    double out[3]) {
  const double a = abbe_vector_dot(v, m->axis);
  double stretched[3];
  for (int k = 0; k < 3; k++)
    stretched[k] = across * (v[k] - a * m->axis[k]) + along * a * m->axis[k];
  memcpy(out, stretched, sizeof stretched);
}

static bool bends(const abbe_uniaxial *m, abbe_uniaxial_mode mode) {
  return mode == ABBE_UNIAXIAL_EXTRAORDINARY && m->n_o != m->n_e;
}

/* The ray is normal to the surface of wave vectors, |k_across / n_e|^2 + |k_along / n_o|^2 = 1. */
void abbe_uniaxial_ray(const abbe_uniaxial *m, abbe_uniaxial_mode mode, const double normal[3],
                       double ray[3]) {
  const double o = m->n_o * m->n_o, e = m->n_e * m->n_e;
  if (bends(m, mode))
    stretch(m, normal, e, o, ray);
  else
    memmove(ray, normal, 3 * sizeof *ray);
  abbe_vector_normalise(ray);
}

void abbe_uniaxial_normal(const abbe_uniaxial *m, abbe_uniaxial_mode mode, const double ray[3],
                          double normal[3]) {
  const double o = m->n_o * m->n_o, e = m->n_e * m->n_e;
  if (bends(m, mode))
    stretch(m, ray, o, e, normal);
  else
    memmove(normal, ray, 3 * sizeof *normal);
  abbe_vector_normalise(normal);
}

/* ---- waves of one tangential wave vector ---- */

/* A plane wave at the face; k in units of vacuum's wave number. */
typedef struct wave {
  number k[3], e[3], h[3]; /* |e| = 1, h = k x e */
  double flux;             /* along n */
  bool travels;
} wave;

/* What all waves at the face have in common. */
typedef struct face {
  double n[3], along[3],
      across[3]; /* right-handed; along: the tangential wave vector's direction */
  double k;      /* its length */
} face;

static void make_face(const double n[3], const double k[3], face *f) {
  const double normal = abbe_vector_dot(n, k);
  memcpy(f->n, n, sizeof f->n);
  for (int i = 0; i < 3; i++) f->along[i] = k[i] - normal * n[i];
  f->k = sqrt(abbe_vector_dot(f->along, f->along));
  if (!(f->k > 1e-12)) { /* head on: any direction does */
    const int least = fabs(n[0]) < 0.6 ? 0 : 1;
    for (int i = 0; i < 3; i++) f->along[i] = (i == least) - n[least] * n[i];
    f->k = 0;
  }
  abbe_vector_normalise(f->along);
  for (int i = 0; i < 3; i++)
    f->across[i] = n[(i + 1) % 3] * f->along[(i + 2) % 3] - n[(i + 2) % 3] * f->along[(i + 1) % 3];
}

/* The wave vector along + q n: whether it travels, and q, or else its imaginary part in *decay. q
 * solves A q^2 + 2 B q + C = 0 of the surface of wave vectors, and the ray leaves the face to the
 * side of n (+1 or -1); a wave that does not travel dies out on that side. */
static bool find_wave_vector(const abbe_uniaxial *m, abbe_uniaxial_mode mode, const face *f,
                             double side, double *q, double *decay) {
  const double o = m->n_o * m->n_o, e = m->n_e * m->n_e;
  double a = 1 / o, b = 0, c = f->k * f->k / o - 1;
  if (bends(m, mode)) {
    const double more = 1 / o - 1 / e, at_n = abbe_vector_dot(m->axis, f->n),
                 at_k = f->k * abbe_vector_dot(m->axis, f->along);
    a = 1 / e + more * at_n * at_n;
    b = more * at_n * at_k;
    c = f->k * f->k / e + more * at_k * at_k - 1;
  }
  const double square = b * b - a * c, root = side * sqrt(fabs(square));
  *q = ((square > 0 ? root : 0) - b) / a;
  *decay = root / a;
  return square > 0;
}

static double norm(const number v[3]) {
  double square = 0;
  for (int i = 0; i < 3; i++) square += creal(v[i] * conj(v[i]));
  return sqrt(square);
}

/* A direction across the wave vector, by which both fields are separated: across the axis too or,
 * where that lies along the wave vector or there is none, across the plane of incidence. */
static void across_wave_vector(const abbe_uniaxial *m, const face *f, const number k[3],
                               number out[3]) {
  const number axis[3] = {m->axis[0], m->axis[1], m->axis[2]};
  for (int i = 0; i < 3; i++) out[i] = f->across[i];
  if (m->n_o == m->n_e) return;
  number turned[3];
  cross(axis, k, turned);
  const double length = norm(turned);
  if (length < 1e-9 * m->n_o) return;
  for (int i = 0; i < 3; i++) out[i] = turned[i] / length;
}

/* The same of a wave that travels. */
static void across_real_vector(const abbe_uniaxial *m, const face *f, const double k[3],
                               double out[3]) {
  memcpy(out, f->across, sizeof f->across);
  if (m->n_o == m->n_e) return;
  double turned[3];
  abbe_vector_cross(m->axis, k, turned);
  const double length = abbe_vector_length(turned);
  if (length < 1e-9 * m->n_o) return;
  /* rounding leaves a part along k where the two are nearly parallel */
  const double along = abbe_vector_dot(turned, k) / abbe_vector_dot(k, k);
  for (int i = 0; i < 3; i++) out[i] = (turned[i] - along * k[i]) / length;
}

/* Ordinary: E along axis x k. Extraordinary: H along it, and E = -(k x H) / permittivity. Waves
 * that travel are real, and most do. */
static void make_real_wave(const abbe_uniaxial *m, abbe_uniaxial_mode mode, const face *f, double q,
                           wave *w) {
  double k[3], t[3], e[3], h[3], ray[3];
  for (int i = 0; i < 3; i++) k[i] = f->k * f->along[i] + q * f->n[i];
  across_real_vector(m, f, k, t);
  if (mode == ABBE_UNIAXIAL_ORDINARY) {
    memcpy(e, t, sizeof t);
  } else {
    abbe_vector_cross(t, k, e);
    if (bends(m, mode)) stretch(m, e, m->n_o * m->n_o, m->n_e * m->n_e, e);
  }
  abbe_vector_normalise(e);
  abbe_vector_cross(k, e, h);
  abbe_vector_cross(e, h, ray);
  w->flux = abbe_vector_dot(f->n, ray);
  for (int i = 0; i < 3; i++) {
    w->k[i] = k[i];
    w->e[i] = e[i];
    w->h[i] = h[i];
  }
}

static void make_wave(const abbe_uniaxial *m, abbe_uniaxial_mode mode, const face *f, double side,
                      wave *w) {
  double q, decay;
  w->travels = find_wave_vector(m, mode, f, side, &q, &decay);
  if (w->travels) {
    make_real_wave(m, mode, f, q, w);
    return;
  }
  number t[3];
  for (int i = 0; i < 3; i++) w->k[i] = f->k * f->along[i] + (q + I * decay) * f->n[i];
  across_wave_vector(m, f, w->k, t);
  if (mode == ABBE_UNIAXIAL_ORDINARY) {
    memcpy(w->e, t, sizeof t);
  } else {
    number along = 0;
    const double o = m->n_o * m->n_o, e = m->n_e * m->n_e;
    cross(t, w->k, w->e);
    for (int i = 0; i < 3; i++) along += w->e[i] * m->axis[i];
    for (int i = 0; i < 3; i++)
      w->e[i] = w->e[i] / o + (bends(m, mode) ? (1 / e - 1 / o) * along * m->axis[i] : 0);
  }
  const double length = norm(w->e);
  for (int i = 0; i < 3; i++) w->e[i] /= length;
  cross(w->k, w->e, w->h);
  w->flux = 0;
}

/* ---- the face ---- */

static number part(const number v[3], const double d[3]) {
  return v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
}

static void tangential(const wave *w, const face *f, number out[4]) {
  out[0] = part(w->e, f->along);
  out[1] = part(w->e, f->across);
  out[2] = part(w->h, f->along);
  out[3] = part(w->h, f->across);
}

enum { COME = ABBE_BOUNDARY_COME };

static void tell(const abbe_uniaxial *m, abbe_uniaxial_mode mode, const wave *w, number amplitude,
                 double flux, abbe_uniaxial_wave *out) {
  double square = 0;
  out->travels = w->travels;
  out->share = w->travels ? creal(amplitude * conj(amplitude)) * fabs(w->flux / flux) : 0;
  out->amplitude[0] = creal(amplitude);
  out->amplitude[1] = cimag(amplitude);
  for (int i = 0; i < 3; i++) {
    out->normal[i] = creal(w->k[i]);
    out->field[i] = creal(w->e[i]);
    square += out->normal[i] * out->normal[i];
  }
  out->index = sqrt(square);
  for (int i = 0; i < 3 && square > 0; i++) out->normal[i] /= out->index;
  if (w->travels)
    abbe_uniaxial_ray(m, mode, out->normal, out->ray);
  else
    memcpy(out->ray, out->normal, sizeof out->ray);
}

/* Along the face nothing gets in. */
static void graze(const abbe_uniaxial *from, const double n[3], abbe_uniaxial_mode mode,
                  const double ray[3], abbe_uniaxial_split *out) {
  abbe_uniaxial_wave *w = &out->reflected[mode];
  const double twice = 2 * abbe_vector_dot(ray, n);
  memset(out, 0, sizeof *out);
  for (int i = 0; i < 3; i++) w->ray[i] = ray[i] - twice * n[i];
  abbe_vector_normalise(w->ray);
  abbe_uniaxial_normal(from, mode, w->ray, w->normal);
  w->index = bends(from, mode)
                 ? abbe_uniaxial_index(from->n_o, from->n_e, abbe_vector_dot(w->normal, from->axis))
                 : from->n_o;
  w->share = 1;
  w->amplitude[0] = -1;
  w->travels = true;
}

/* For the modes from first to last, which have one wave vector: one, or both of an isotropic
 * medium.
 */
static void meet(const abbe_uniaxial *from, const abbe_uniaxial *to, const double n[3],
                 abbe_uniaxial_mode first, int count, const double ray[3],
                 abbe_uniaxial_split out[COME]) {
  double k[3];
  abbe_uniaxial_normal(from, first, ray, k);
  const double index =
      bends(from, first) ? abbe_uniaxial_index(from->n_o, from->n_e, abbe_vector_dot(k, from->axis))
                         : from->n_o;
  for (int i = 0; i < 3; i++) k[i] *= index;
  face f;
  make_face(n, k, &f);
  wave incident[COME], waves[4];
  number column[4], m[4][4 + COME];
  for (int i = 0; i < count; i++) {
    make_wave(from, (abbe_uniaxial_mode)((int)first + i), &f, -1, &incident[i]);
    tangential(&incident[i], &f, column);
    for (int r = 0; r < 4; r++) m[r][4 + i] = column[r];
  }
  for (int i = 0; i < 4; i++) {
    const bool inside = i >= 2;
    make_wave(inside ? to : from, (abbe_uniaxial_mode)(i & 1), &f, inside ? -1 : 1, &waves[i]);
    tangential(&waves[i], &f, column);
    for (int r = 0; r < 4; r++) m[r][i] = inside ? column[r] : -column[r];
  }
  abbe_boundary_solve(m, count);
  for (int c = 0; c < count; c++) {
    for (int i = 0; i < 4; i++)
      tell(i < 2 ? from : to, (abbe_uniaxial_mode)(i & 1), &waves[i], m[i][4 + c], incident[c].flux,
           i < 2 ? &out[c].reflected[i] : &out[c].transmitted[i - 2]);
    for (int i = 0; i < 3; i++) out[c].field[i] = creal(incident[c].e[i]);
  }
}

void abbe_uniaxial_meet(const abbe_uniaxial *from, const abbe_uniaxial *to, const double n[3],
                        abbe_uniaxial_mode mode, const double ray[3], abbe_uniaxial_split *out) {
  if (abbe_vector_dot(ray, n) < -grazing)
    meet(from, to, n, mode, 1, ray, out);
  else
    graze(from, n, mode, ray, out);
}

void abbe_uniaxial_meet_both(const abbe_uniaxial *from, const abbe_uniaxial *to, const double n[3],
                             const double ray[3], abbe_uniaxial_split out[COME]) {
  if (abbe_vector_dot(ray, n) < -grazing) {
    meet(from, to, n, ABBE_UNIAXIAL_ORDINARY, COME, ray, out);
  } else {
    graze(from, n, ABBE_UNIAXIAL_ORDINARY, ray, &out[0]);
    graze(from, n, ABBE_UNIAXIAL_EXTRAORDINARY, ray, &out[1]);
  }
}

void abbe_uniaxial_meet_unpolarised(const abbe_uniaxial *from, const abbe_uniaxial *to,
                                    const double n[3], const double ray[3],
                                    abbe_uniaxial_split *out) {
  abbe_uniaxial_split both[COME];
  abbe_uniaxial_meet_both(from, to, n, ray, both);
  *out = both[1];
  for (int i = 0; i < 2; i++) {
    out->reflected[i].share = (both[0].reflected[i].share + both[1].reflected[i].share) / 2;
    out->transmitted[i].share = (both[0].transmitted[i].share + both[1].transmitted[i].share) / 2;
  }
}
