#include "spectral/biaxial.h"

#include "base/maths.h"

#include <complex.h>
#include <math.h>
#include <string.h>

typedef double complex number;

static const double grazing = 1e-6; /* below, rounding hides which way it goes */

/* n^power along each axis, applied to v. */
static void apply(const abbe_biaxial *m, int power, const double v[3], double out[3]) {
  double made[3] = {0};
  for (int p = 0; p < 3; p++) {
    const double square = m->n[p] * m->n[p];
    const double along = abbe_vector_dot(m->axis[p], v) * (power == 2 ? square : 1 / square);
    for (int k = 0; k < 3; k++) made[k] += along * m->axis[p][k];
  }
  memcpy(out, made, sizeof made);
}

/* ---- one wave ---- */

/* The larger value of the tensor's section across v and the unit direction that has it. */
static double section(const abbe_biaxial *m, int power, const double v[3], double high[3]) {
  double a[3] = {0}, b[3], ta[3], tb[3];
  a[fabs(v[0]) < 0.6 ? 0 : 1] = 1;
  abbe_vector_cross(v, a, b);
  abbe_vector_normalise(b);
  abbe_vector_cross(b, v, a);
  apply(m, power, a, ta);
  apply(m, power, b, tb);
  const double off = abbe_vector_dot(a, tb), aa = abbe_vector_dot(a, ta),
               bb = abbe_vector_dot(b, tb), d = (aa - bb) / 2, s = hypot(d, off);
  double x = d >= 0 ? s + d : off, y = d >= 0 ? off : s - d;
  if (!(x != 0 || y != 0)) x = 1;
  for (int k = 0; k < 3; k++) high[k] = x * a[k] + y * b[k];
  abbe_vector_normalise(high);
  return (aa + bb) / 2 + s;
}

void abbe_biaxial_of_normal(const abbe_biaxial *m, abbe_biaxial_mode mode, const double normal[3],
                            abbe_biaxial_state *out) {
  double d[3], e[3];
  section(m, -2, normal, d);
  if (mode == ABBE_BIAXIAL_SLOW) {
    double other[3];
    abbe_vector_cross(normal, d, other);
    memcpy(d, other, sizeof d);
  }
  apply(m, -2, d, e);
  out->index = 1 / sqrt(abbe_vector_dot(d, e));
  abbe_vector_normalise(e);
  const double along = abbe_vector_dot(e, normal);
  for (int k = 0; k < 3; k++) {
    out->normal[k] = normal[k];
    out->field[k] = e[k];
    out->ray[k] = normal[k] - along * e[k];
  }
  abbe_vector_normalise(out->ray);
}

/* E across the ray; H across both, of the length of the root of E D; k = D x H / H^2. */
void abbe_biaxial_of_ray(const abbe_biaxial *m, abbe_biaxial_mode mode, const double ray[3],
                         abbe_biaxial_state *out) {
  double e[3], d[3], h[3], k[3];
  section(m, 2, ray, e);
  if (mode == ABBE_BIAXIAL_FAST) {
    double other[3];
    abbe_vector_cross(ray, e, other);
    memcpy(e, other, sizeof e);
  }
  apply(m, 2, e, d);
  const double along = sqrt(abbe_vector_dot(e, d)); /* the index along the ray */
  abbe_vector_cross(ray, e, h);
  abbe_vector_cross(d, h, k);
  out->index = sqrt(abbe_vector_dot(k, k)) / along;
  abbe_vector_normalise(k);
  memcpy(out->normal, k, sizeof k);
  memcpy(out->ray, ray, sizeof k);
  memcpy(out->field, e, sizeof e);
}

double abbe_biaxial_half_angle(const double n[3]) {
  const double a = 1 / (n[0] * n[0]), b = 1 / (n[1] * n[1]), c = 1 / (n[2] * n[2]);
  return atan2(sqrt(a - b), sqrt(b - c));
}

double abbe_biaxial_attenuation(const abbe_biaxial *m, const double a[3], const double field[3]) {
  double loss = 0, square = 0;
  for (int p = 0; p < 3; p++) {
    const double along = abbe_vector_dot(m->axis[p], field);
    loss += m->n[p] * a[p] * along * along;
    square += m->n[p] * m->n[p] * along * along;
  }
  return loss / sqrt(square);
}

/* ---- waves of one tangential wave vector ---- */

/* In the face's frame: along the tangential wave vector, across it, along n. */
typedef struct wave {
  number k[3], e[3], h[3]; /* |e| = 1, h = k x e */
  double flux;             /* along n */
  bool travels;
} wave;

/* A medium at the face. */
typedef struct side_medium {
  const abbe_biaxial *m;
  double k;         /* tangential, in units of vacuum's wave number */
  double eta[3][3]; /* inverse permittivity in the face's frame */
} side_medium;

static bool is_isotropic(const abbe_biaxial *m) {
  return m->n[0] == m->n[1] && m->n[1] == m->n[2];
}

static void finish_wave(wave *w) {
  double square = 0;
  for (int i = 0; i < 3; i++) square += creal(w->e[i] * conj(w->e[i]));
  for (int i = 0; i < 3; i++) w->e[i] /= sqrt(square);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    w->h[i] = w->k[j] * w->e[k] - w->k[k] * w->e[j];
  }
  w->flux = w->travels ? creal(w->e[0] * conj(w->h[1]) - w->e[1] * conj(w->h[0])) : 0;
}

/* s and p that leave the face to its side +1 or -1, or die out there. */
static void isotropic_waves(const side_medium *f, double side, wave out[2]) {
  const double n = f->m->n[0], square = (n - f->k) * (n + f->k), root = sqrt(fabs(square));
  const number z = side * (square > 0 ? root : I * root);
  out[0] = (wave){.k = {f->k, 0, z}, .e = {0, 1, 0}, .travels = square > 0};
  out[1] = (wave){.k = {f->k, 0, z}, .e = {-z, 0, f->k}, .travels = square > 0};
  for (int i = 0; i < 2; i++) finish_wave(&out[i]);
}

/* H = h1 across + h2 (k x across) / k turns -k x eta (k x H) into a symmetric matrix of two rows
 * whose values are 1 for waves: the larger one of the faster wave. */
typedef struct sheet {
  number difference, off, root, square; /* (P - Q) / 2, w, S, k^2 */
  number value, slope;                  /* and its derivative by kz */
} sheet;

static sheet look_at(const side_medium *f, number z, bool fast) {
  const double(*t)[3] = f->eta, k = f->k;
  sheet s;
  s.square = k * k + z * z;
  s.off = k * t[1][2] - z * t[0][1];
  const number p = z * z * t[0][0] - 2 * k * z * t[0][2] + k * k * t[2][2];
  const number q = s.square * t[1][1];
  const number dp = 2 * (z * t[0][0] - k * t[0][2]), dq = 2 * z * t[1][1];
  s.difference = (p - q) / 2;
  s.root = csqrt(s.difference * s.difference + s.square * s.off * s.off);
  number slope = 0;
  if (s.root != 0)
    slope =
        (s.difference * (dp - dq) / 2 + z * s.off * s.off - s.square * s.off * t[0][1]) / s.root;
  s.value = (p + q) / 2 + (fast ? s.root : -s.root);
  s.slope = (dp + dq) / 2 + (fast ? slope : -slope);
  return s;
}

/* All four roots of det(k k - k^2 + permittivity) = 0 in kz at once, by Aberth's iteration. */
static void find_roots(const side_medium *f, number z[4]) {
  enum { MOST = 80 };
  const double(*t)[3] = f->eta, k = f->k;
  const double p[3] = {1 - k * k * t[2][2], 2 * k * t[0][2], -t[0][0]};
  const double q[3] = {1 - k * k * t[1][1], 0, -t[1][1]}, w[2] = {k * t[1][2], -t[0][1]};
  const double ww[3] = {w[0] * w[0], 2 * w[0] * w[1], w[1] * w[1]};
  double c[5] = {0};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) c[i + j] += p[i] * q[j];
    c[i] -= k * k * ww[i];
    c[i + 2] -= ww[i];
  }
  /* about those of a medium of one index between */
  const double square = 3 / (t[0][0] + t[1][1] + t[2][2]) - k * k, size = sqrt(fabs(square)) + 1e-3;
  const number near = square > 0 ? size : I * size, off = 0.02 * (1 + 0.5 * I) * size;
  for (int i = 0; i < 4; i++) z[i] = (i < 2 ? near : -near) + (i & 1 ? off : -off);
  double moved = 1;
  for (int round = 0; round < MOST && moved > 1e-9; round++) {
    moved = 0;
    for (int i = 0; i < 4; i++) {
      number value = c[4], slope = 0, others = 0;
      for (int j = 3; j >= 0; j--) {
        slope = slope * z[i] + value;
        value = value * z[i] + c[j];
      }
      if (value == 0) continue;
      for (int j = 0; j < 4; j++)
        if (j != i && z[j] != z[i]) others += 1 / (z[i] - z[j]);
      const number step = value / (slope - value * others);
      if (!(abbe_boundary_size(step) < 1e6)) continue;
      z[i] -= step;
      moved = fmax(moved, abbe_boundary_size(step));
    }
  }
}

/* A root and the sheet that it lies on. */
typedef struct root {
  number z;
  bool fast, travels;
  double leaves; /* above 0: to the side of n */
} root;

/* Newton on the sheet, which knows its root to rounding also where both sheets all but meet. */
static void polish(const side_medium *f, root *r) {
  enum { MOST = 8 };
  const number first = r->z;
  r->travels = fabs(cimag(r->z)) < 1e-7 * (1 + cabs(r->z));
  if (r->travels) r->z = creal(r->z);
  for (int round = 0; round < MOST; round++) {
    const sheet s = look_at(f, r->z, r->fast);
    const number step = s.slope != 0 ? (s.value - 1) / s.slope : 0;
    if (!(cabs(r->z - step - first) < 1e-4 * (1 + cabs(first)))) break;
    r->z -= step;
    if (abbe_boundary_size(step) < 1e-15) break;
  }
  const double slope = creal(look_at(f, r->z, r->fast).slope);
  /* energy goes the way in which the value grows */
  r->leaves = r->travels ? slope / (1 + fabs(slope)) : cimag(r->z) > 0 ? 2 : -2;
}

static double misses(const side_medium *f, number z, bool fast) {
  return abbe_boundary_size(look_at(f, z, fast).value - 1);
}

/* First the two that leave to the side of n, then the others, each on its sheet. */
static void crystal_roots(const side_medium *f, root all[4]) {
  number z[4];
  find_roots(f, z);
  for (int i = 0; i < 4; i++) {
    all[i] = (root){.z = z[i], .fast = misses(f, z[i], true) <= misses(f, z[i], false)};
    for (int j = 0; j < i; j++)
      if (cabs(z[i] - z[j]) < 1e-4 && all[j].fast == all[i].fast) {
        /* Two roots on one sheet are further from the other than the root of rounding. Else both
         * sheets are here: the pair takes one each, as fits better. */
        const bool fast = all[i].fast;
        const double kept = misses(f, z[j], fast) + misses(f, z[i], !fast),
                     swapped = misses(f, z[j], !fast) + misses(f, z[i], fast);
        if (!(fmin(kept, swapped) < 1e-6)) continue;
        all[i].fast = kept <= swapped ? !fast : fast;
        all[j].fast = kept <= swapped ? fast : !fast;
      }
  }
  for (int i = 0; i < 4; i++) polish(f, &all[i]);
  for (int i = 0; i < 3; i++)
    for (int j = i + 1; j < 4; j++)
      if (all[j].leaves > all[i].leaves) {
        const root swapped = all[i];
        all[i] = all[j];
        all[j] = swapped;
      }
}

/* D is a direction of the section across k, and E = eta D. */
static void crystal_wave(const side_medium *f, const root *r, wave *w) {
  const sheet s = look_at(f, r->z, r->fast);
  const double sign = r->fast ? 1 : -1;
  /* from two forms of the same vector, the one without a difference */
  const number sum = sign * s.root + s.difference, rest = sign * s.root - s.difference;
  const bool first = cabs(sum) >= cabs(rest);
  number a = first ? s.square * s.off : rest, b = first ? sum : s.off;
  if (cabs(s.root) < 1e-13) { /* rounding alone */
    a = r->fast;
    b = !r->fast;
  }
  const number d[3] = {-r->z * b, a, f->k * b};
  *w = (wave){.k = {f->k, 0, r->z}, .travels = r->travels};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) w->e[i] += f->eta[i][j] * d[j];
  finish_wave(w);
}

/* Two waves of a clear medium carry no energy together, but directions are known to rounding over
 * the distance of wave vectors alone: the wave of less flux is rid of what does with the other. */
static void part_pair(wave w[2]) {
  if (!w[0].travels || !w[1].travels) return;
  wave *more = &w[fabs(w[1].flux) > fabs(w[0].flux)], *less = more == w ? w + 1 : w;
  const number *e = more->e, *h = more->h, *other = less->e, *its = less->h;
  const number shared =
      conj(e[0]) * its[1] - conj(e[1]) * its[0] + other[0] * conj(h[1]) - other[1] * conj(h[0]);
  for (int k = 0; k < 3; k++) less->e[k] -= shared / (2 * more->flux) * more->e[k];
  finish_wave(less);
}

/* First those that leave to the side of n. */
static void make_waves(const side_medium *f, wave out[4]) {
  if (is_isotropic(f->m)) {
    isotropic_waves(f, 1, out);
    isotropic_waves(f, -1, out + 2);
    return;
  }
  root roots[4];
  crystal_roots(f, roots);
  for (int i = 0; i < 4; i++) crystal_wave(f, &roots[i], &out[i]);
  part_pair(out);
  part_pair(out + 2);
}

/* ---- the face ---- */

enum { COME = ABBE_BOUNDARY_COME };

static void make_frame(const double n[3], const double k[3], double frame[3][3],
                       double *tangential) {
  const double normal = abbe_vector_dot(n, k);
  double *along = frame[0];
  for (int i = 0; i < 3; i++) along[i] = k[i] - normal * n[i];
  *tangential = sqrt(abbe_vector_dot(along, along));
  if (!(*tangential > 1e-12)) { /* head on: any direction does */
    const int least = fabs(n[0]) < 0.6 ? 0 : 1;
    for (int i = 0; i < 3; i++) along[i] = (i == least) - n[least] * n[i];
    *tangential = 0;
  }
  abbe_vector_normalise(along);
  memcpy(frame[2], n, sizeof frame[2]);
  abbe_vector_cross(n, along, frame[1]);
}

static side_medium place(const abbe_biaxial *m, double frame[3][3], double k) {
  side_medium f = {.m = m, .k = k};
  for (int i = 0; i < 3; i++) {
    double turned[3];
    apply(m, -2, frame[i], turned);
    for (int j = 0; j < 3; j++) f.eta[i][j] = abbe_vector_dot(frame[j], turned);
  }
  return f;
}

static void to_world(double frame[3][3], const number v[3], double out[3]) {
  for (int k = 0; k < 3; k++) {
    out[k] = 0;
    for (int i = 0; i < 3; i++) out[k] += creal(v[i]) * frame[i][k];
  }
}

/* Which of the two rays of that direction it is. */
static abbe_biaxial_mode mode_of(const abbe_biaxial *m, const abbe_biaxial_state *s) {
  double d[3], r[3], trace = 0;
  apply(m, 2, s->field, d);
  apply(m, 2, s->ray, r);
  for (int p = 0; p < 3; p++) trace += m->n[p] * m->n[p];
  const bool slow = 2 * abbe_vector_dot(s->field, d) > trace - abbe_vector_dot(s->ray, r);
  return slow ? ABBE_BIAXIAL_SLOW : ABBE_BIAXIAL_FAST;
}

static void tell(const abbe_biaxial *m, double frame[3][3], int which, const wave *w,
                 number amplitude, double flux, abbe_biaxial_wave *out) {
  number ray[3];
  abbe_biaxial_state *s = &out->state;
  out->travels = w->travels;
  out->share = w->travels ? creal(amplitude * conj(amplitude)) * fabs(w->flux / flux) : 0;
  out->amplitude[0] = creal(amplitude);
  out->amplitude[1] = cimag(amplitude);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    ray[i] = creal(w->e[j] * conj(w->h[k]) - w->e[k] * conj(w->h[j]));
  }
  to_world(frame, w->k, s->normal);
  to_world(frame, w->e, s->field);
  to_world(frame, ray, s->ray);
  s->index = sqrt(abbe_vector_dot(s->normal, s->normal));
  if (s->index > 0) abbe_vector_normalise(s->normal);
  if (w->travels) abbe_vector_normalise(s->ray);
  out->mode = is_isotropic(m) || !w->travels ? (abbe_biaxial_mode)which : mode_of(m, s);
}

/* Along the face nothing gets in. */
static void graze(const abbe_biaxial *from, const double n[3], abbe_biaxial_mode mode,
                  const double ray[3], abbe_biaxial_split *out) {
  abbe_biaxial_wave *w = &out->reflected[mode];
  const double twice = 2 * abbe_vector_dot(ray, n);
  double mirrored[3];
  *out = (abbe_biaxial_split){0};
  for (int i = 0; i < 3; i++) mirrored[i] = ray[i] - twice * n[i];
  abbe_vector_normalise(mirrored);
  abbe_biaxial_of_ray(from, mode, mirrored, &w->state);
  w->share = 1;
  w->amplitude[0] = -1;
  w->mode = mode;
  w->travels = true;
}

/* The incident wave in the face's frame: one of the two that come from there, whose flux is as
 * exact as that of those that leave, or what it is where these two are one. */
static void come(const abbe_biaxial_state *s, double frame[3][3], const wave coming[2], wave *w) {
  *w = (wave){.travels = true};
  for (int i = 0; i < 3; i++) {
    w->k[i] = s->index * abbe_vector_dot(frame[i], s->normal);
    w->e[i] = abbe_vector_dot(frame[i], s->field);
  }
  for (int i = 0; i < 2; i++) {
    number along = 0;
    for (int c = 0; c < 3; c++) along += coming[i].e[c] * w->e[c];
    if (!coming[i].travels || cabs(along) < 1 - 1e-6 || cabs(coming[i].k[2] - w->k[2]) > 1e-6)
      continue;
    *w = coming[i];
    return;
  }
  finish_wave(w);
}

static void tangential(const wave *w, number out[4]) {
  for (int i = 0; i < 2; i++) {
    out[i] = w->e[i];
    out[2 + i] = w->h[i];
  }
}

/* The tangential fields behind films to their front, where light of both kinds goes on alone. */
static double pass_film(const abbe_biaxial_film *film, double k, number column[4]) {
  number field[2][2] = {{column[1], column[2]}, {column[0], -column[3]}};
  double decay = 0;
  if (film == NULL) return 0;
  abbe_film_fields(film->layer, film->count, film->reversed, k, film->lambda_nm, field, &decay);
  column[0] = field[1][0];
  column[1] = field[0][0];
  column[2] = field[0][1];
  column[3] = -field[1][1];
  return decay;
}

/* `count` waves of one normal: one, or from an isotropic medium both s and p. */
static void meet(const abbe_biaxial *media[2], const double n[3], const abbe_biaxial_state *coming,
                 int first, int count, const abbe_biaxial_film *film,
                 abbe_biaxial_split out[COME]) {
  double k[3], frame[3][3], along;
  for (int i = 0; i < 3; i++) k[i] = coming->index * coming->normal[i];
  make_frame(n, k, frame, &along);
  wave incident[COME], behind[4], ahead[4];
  const side_medium back = place(media[0], frame, along), front = place(media[1], frame, along);
  make_waves(&back, behind);
  make_waves(&front, ahead);
  const wave waves[4] = {behind[0], behind[1], ahead[2], ahead[3]};
  if (is_isotropic(media[0]))
    memcpy(incident, behind + 2 + first, (size_t)count * sizeof *incident);
  else
    come(coming, frame, behind + 2, &incident[0]);
  double decay = 0;
  number column[4], m[4][4 + COME];
  for (int i = 0; i < 4 + count; i++) {
    tangential(i < 4 ? &waves[i] : &incident[i - 4], column);
    if (i == 2 || i == 3) decay = pass_film(film, along, column);
    for (int r = 0; r < 4; r++) m[r][i] = i < 2 ? -column[r] : column[r];
  }
  abbe_boundary_solve(m, count);
  for (int c = 0; c < count; c++) {
    for (int i = 0; i < 4; i++)
      tell(media[i / 2], frame, i & 1, &waves[i], i < 2 ? m[i][4 + c] : exp(-decay) * m[i][4 + c],
           incident[c].flux, i < 2 ? &out[c].reflected[i] : &out[c].transmitted[i - 2]);
    to_world(frame, incident[c].e, out[c].field);
  }
}

void abbe_biaxial_meet(const abbe_biaxial *from, const abbe_biaxial *to, const double n[3],
                       abbe_biaxial_mode mode, const double ray[3], const abbe_biaxial_film *film,
                       abbe_biaxial_split *out) {
  const abbe_biaxial *media[2] = {from, to};
  abbe_biaxial_state coming;
  if (!(abbe_vector_dot(ray, n) < -grazing)) {
    graze(from, n, mode, ray, out);
    return;
  }
  abbe_biaxial_of_ray(from, mode, ray, &coming);
  abbe_biaxial_split made[COME];
  meet(media, n, &coming, (int)mode, 1, film, made);
  *out = made[0];
}

void abbe_biaxial_meet_both(const abbe_biaxial *from, const abbe_biaxial *to, const double n[3],
                            const double ray[3], const abbe_biaxial_film *film,
                            abbe_biaxial_split out[COME]) {
  const abbe_biaxial *media[2] = {from, to};
  if (abbe_vector_dot(ray, n) < -grazing) {
    abbe_biaxial_state coming;
    abbe_biaxial_of_ray(from, ABBE_BIAXIAL_FAST, ray, &coming);
    meet(media, n, &coming, 0, COME, film, out);
  } else {
    for (int i = 0; i < COME; i++) graze(from, n, (abbe_biaxial_mode)i, ray, &out[i]);
  }
}

void abbe_biaxial_meet_unpolarised(const abbe_biaxial *from, const abbe_biaxial *to,
                                   const double n[3], const double ray[3],
                                   const abbe_biaxial_film *film, abbe_biaxial_split *out) {
  abbe_biaxial_split both[COME];
  abbe_biaxial_meet_both(from, to, n, ray, film, both);
  *out = both[1];
  for (int i = 0; i < 2; i++) {
    out->reflected[i].share = (both[0].reflected[i].share + both[1].reflected[i].share) / 2;
    out->transmitted[i].share = (both[0].transmitted[i].share + both[1].transmitted[i].share) / 2;
  }
}
