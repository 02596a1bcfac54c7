#include "validation/measure/gem/gem_stretch.h"

#include "base/maths.h"
#include "spectral/optics.h"

#include <math.h>
#include <string.h>

/* A plane along the line of sight. */
#define UPRIGHT 1e-12

/* ---- what an exit counts ---- */

static double soft(double x, double *slope) {
  *slope = fabs(x) < 1 ? 0.75 * (1 - x * x) : 0;
  return x <= -1 ? 0 : x >= 1 ? 1 : 0.5 + 0.75 * x - 0.25 * x * x * x;
}

/* 1 where x, a sine or a cosine, is above `from`; wide: how soft. */
static double above(double x, double from, double wide, double *slope) {
  if (!(wide > 0)) {
    *slope = 0;
    return x > from;
  }
  const double s = soft((x - from) / wide, slope);
  *slope /= wide;
  return s;
}

static double outside_head(double to_eye, double cos_head, double wide, double *slope) {
  *slope = 0;
  if (cos_head > 1) return 1;
  const double in = above(to_eye, cos_head, wide * sqrt(1 - cos_head * cos_head), slope);
  *slope = -*slope;
  return 1 - in;
}

static double gemray(const abbe_gem_stretch *w, double e, double *slope) {
  double rise, rim, shape = 1, bend = 0;
  const double up = above(e, 0, w->q->soft_rad, &rise);
  const double seen = outside_head(e, (double)w->light.cos_gemray, w->q->soft_rad, &rim);
  const double across = sqrt(fmax(1 - e * e, 1e-12));
  if (w->q->measure == ABBE_GEM_GEMRAY_COS) shape = e, bend = 1;
  if (w->q->measure == ABBE_GEM_GEMRAY_SC2)
    shape = 2 * e * across, bend = 2 * across - 2 * e * e / across;
  *slope = bend * up * seen + shape * (rise * seen + up * rim);
  return shape * up * seen;
}

/* What light from there counts, and its gradient. */
static double shine(const abbe_gem_stretch *w, const double out[3], double by[3]) {
  const double eye[3] = {-w->sight[0], -w->sight[1], -w->sight[2]};
  const double soft_rad = w->q->soft_rad;
  double rise = 0, rim = 0, value;
  const double e = abbe_vector_dot(out, eye), up = above(out[2], 0, soft_rad, &rise);
  switch (w->q->measure) {
  case ABBE_GEM_AMOUNT_COUNT:
    value = rise = 0;
    break;
  case ABBE_GEM_ISO:
    value = up;
    break;
  case ABBE_GEM_DOWN:
    value = 1 - up;
    rise = -rise;
    break;
  case ABBE_GEM_COS:
    value = fmax(out[2], 0);
    rise = out[2] > 0;
    break;
  case ABBE_GEM_RETURN: {
    const double seen = outside_head(e, (double)w->light.cos_head, soft_rad, &rim);
    value = up * seen;
    rise *= seen;
    rim *= up;
    break;
  }
  default:
    value = gemray(w, e, &rim);
    rise = 0;
  }
  for (int k = 0; k < 3; k++) by[k] = rim * eye[k] + (k == 2 ? rise : 0);
  return value;
}

/* The angle between both colours of what leaves above the horizon, degrees. */
static void add_fire(const abbe_gem_stretch *w, abbe_gem_meeting *m) {
  double off[3], rise;
  const double up = above(m->out[2], 0, w->q->soft_rad, &rise);
  abbe_vector_subtract(m->out_blue, m->out, off);
  const double apart = abbe_vector_length(off), scale = w->q->fire / ABBE_DEGREE;
  if (!(apart > 0)) return;
  m->light += scale * up * apart;
  m->by_out[2] += scale * rise * apart;
  for (int k = 0; k < 3; k++) {
    m->by_blue[k] = scale * up * off[k] / apart;
    m->by_out[k] -= m->by_blue[k];
  }
}

/* ---- following a place of the line ---- */

static double bent(double cosine, double eta) {
  return sqrt(fmax(1 - eta * eta * (1 - cosine * cosine), 0));
}

/* eta d + (cos_t - eta cosine) n, with n on the side to which it goes. */
static void refract(const double d[3], const double n[3], double cosine, double eta,
                    double out[3]) {
  const double along = bent(cosine, eta) - eta * cosine;
  for (int k = 0; k < 3; k++) out[k] = eta * d[k] + along * n[k];
}

static void reflect(const double d[3], const double n[3], double cosine, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = d[k] - 2 * cosine * n[k];
}

/* For how long the place stays on its face. */
static void bound(abbe_gem_stretch *w, size_t index) {
  const abbe_gem_meeting *m = &w->at[index];
  for (size_t i = 0; i < w->stone->plane_count; i++) {
    const double *plane = w->stone->plane[i], rate = abbe_vector_dot(plane, m->v);
    if (i == m->plane || fabs(rate) < UPRIGHT) continue;
    const double t = w->t + (plane[3] - abbe_vector_dot(plane, m->p)) / rate;
    if (rate > 0 && t < w->high) {
      w->high = t;
      w->high_at = index;
      w->high_plane = i;
    }
    if (rate < 0 && t > w->low) {
      w->low = t;
      w->low_at = index;
      w->low_plane = i;
    }
  }
}

/* Onto the plane, along d, from a place and a speed. */
static void project(const double plane[4], const double d[3], const double p[3], const double v[3],
                    abbe_gem_meeting *m) {
  const double ahead = abbe_vector_dot(plane, d);
  const double way = (plane[3] - abbe_vector_dot(plane, p)) / ahead;
  const double slide = abbe_vector_dot(plane, v) / ahead;
  for (int k = 0; k < 3; k++) {
    m->p[k] = p[k] + way * d[k];
    m->v[k] = v[k] - slide * d[k];
  }
}

static void enter(abbe_gem_stretch *w, const double o[3]) {
  const abbe_gem_stone *s = w->stone;
  abbe_gem_meeting *m = &w->at[0];
  double last = -INFINITY;
  for (size_t i = 0; i < s->plane_count; i++) {
    const double ahead = abbe_vector_dot(s->plane[i], w->sight);
    const double way = (s->plane[i][3] - abbe_vector_dot(s->plane[i], o)) / ahead;
    if (!(ahead < -UPRIGHT && way > last)) continue;
    last = way;
    m->plane = i;
  }
  const double *n = s->plane[m->plane];
  project(n, w->sight, o, w->line, m);
  m->cosine = m->cosine_blue = -abbe_vector_dot(n, w->sight);
  m->reflected = abbe_optics_fresnel(m->cosine, 1 / w->n);
  for (int k = 0; k < 3; k++) m->out[k] = w->sight[k] + 2 * m->cosine * n[k];
  m->way = 0;
  m->share = 1;
}

static bool leaves_blue(const abbe_gem_stretch *w, const abbe_gem_meeting *m) {
  return w->n_blue * sqrt(1 - m->cosine_blue * m->cosine_blue) < 1;
}

/* What leaves through the face. */
static void leave(const abbe_gem_stretch *w, abbe_gem_meeting *m) {
  const double *n = w->stone->plane[m->plane];
  m->reflected = abbe_optics_fresnel(m->cosine, w->n);
  if (m->reflected >= 1) return;
  refract(m->d, n, m->cosine, w->n, m->out);
  if (leaves_blue(w, m)) refract(m->d_blue, n, m->cosine_blue, w->n_blue, m->out_blue);
}

/* What counts of that in the measure at hand. */
static void judge(const abbe_gem_stretch *w, abbe_gem_meeting *m) {
  m->light = 0;
  memset(m->by_out, 0, sizeof m->by_out);
  memset(m->by_blue, 0, sizeof m->by_blue);
  if (m != w->at && m->reflected >= 1) return;
  m->light = shine(w, m->out, m->by_out);
  if (m != w->at && w->q->fire != 0 && leaves_blue(w, m)) add_fire(w, m);
}

/* The next face that is met in direction d. */
static size_t face_ahead(const abbe_gem_stone *s, const double p[3], const double d[3]) {
  double least = INFINITY;
  size_t face = 0;
  for (size_t i = 0; i < s->plane_count; i++) {
    const double ahead = abbe_vector_dot(s->plane[i], d);
    if (!(ahead > 0)) continue;
    const double way = (s->plane[i][3] - abbe_vector_dot(s->plane[i], p)) / ahead;
    if (way < least) {
      least = way;
      face = i;
    }
  }
  return face;
}

void abbe_gem_stretch_follow(abbe_gem_stretch *w, const double o[3]) {
  const abbe_gem_stone *s = w->stone;
  w->count = 0;
  w->low = -INFINITY;
  w->high = INFINITY;
  enter(w, o);
  bound(w, 0);
  w->count = 1;
  double share = 1 - w->at[0].reflected;
  const double least = w->q->least_share > 0 ? w->q->least_share : 0.003;
  const size_t most = w->q->meetings > 0 ? w->q->meetings : 16;
  while (w->count < most && share >= least) {
    const abbe_gem_meeting *from = &w->at[w->count - 1];
    const double *n = s->plane[from->plane];
    abbe_gem_meeting *m = &w->at[w->count];
    if (w->count == 1) { /* into the stone: the other side's normal */
      const double in[3] = {-n[0], -n[1], -n[2]};
      refract(w->sight, in, from->cosine, 1 / w->n, m->d);
      refract(w->sight, in, from->cosine, 1 / w->n_blue, m->d_blue);
    } else {
      reflect(from->d, n, from->cosine, m->d);
      reflect(from->d_blue, n, from->cosine_blue, m->d_blue);
    }
    m->plane = face_ahead(s, from->p, m->d);
    project(s->plane[m->plane], m->d, from->p, from->v, m);
    m->cosine = fmin(abbe_vector_dot(s->plane[m->plane], m->d), 1);
    m->cosine_blue = fmin(abbe_vector_dot(s->plane[m->plane], m->d_blue), 1);
    bound(w, w->count++);
    leave(w, m);
    share *= m->reflected;
  }
}

/* Moves all places along the line, which changes ways and shares. */
static void move_to(abbe_gem_stretch *w, double t) {
  for (size_t i = 0; i < w->count; i++) {
    abbe_gem_meeting *m = &w->at[i];
    for (int k = 0; k < 3; k++) m->p[k] += (t - w->t) * m->v[k];
    if (i == 0) continue;
    double way[3];
    abbe_vector_subtract(m->p, m[-1].p, way);
    m->way = abbe_vector_dot(way, m->d);
    const double left = i == 1 ? 1 - m[-1].reflected : m[-1].share * m[-1].reflected;
    m->share = left * (w->loss > 0 ? exp(-w->loss * m->way) : 1);
  }
  w->t = t;
}

/* ---- derivatives, traced back ---- */

static void add(double to[3], double by, const double what[3]) {
  for (int k = 0; k < 3; k++) to[k] += by * what[k];
}

/* Of Fresnel's reflectance by the cosine before the face. */
static double fresnel_slope(double cosine, double eta) {
  const double t = bent(cosine, eta), by = eta * eta * cosine / t; /* of t by the cosine */
  const double s = (eta * cosine - t) / (eta * cosine + t);
  const double p = (cosine - eta * t) / (cosine + eta * t);
  const double s_by = 2 * eta * (t - cosine * by) / pow(eta * cosine + t, 2);
  const double p_by = 2 * eta * (t - cosine * by) / pow(cosine + eta * t, 2);
  return t > 0 ? s * s_by + p * p_by : 0;
}

/* Of the cosine behind the face by eta. */
static double bent_by_eta(double cosine, double eta) {
  const double t = bent(cosine, eta);
  return t > 0 ? -eta * (1 - cosine * cosine) / t : 0;
}

static double fresnel_by_eta(double cosine, double eta) {
  const double t = bent(cosine, eta), by = bent_by_eta(cosine, eta);
  const double s = (eta * cosine - t) / (eta * cosine + t);
  const double p = (cosine - eta * t) / (cosine + eta * t);
  const double s_by = 2 * cosine * (t - eta * by) / pow(eta * cosine + t, 2);
  const double p_by = -2 * cosine * (t + eta * by) / pow(cosine + eta * t, 2);
  return t > 0 ? s * s_by + p * p_by : 0;
}

/* Of a refracted direction by eta, along what counts of it. */
static double refract_by_eta(const double d[3], const double n[3], double cosine, double eta,
                             const double out[3]) {
  return abbe_vector_dot(out, d) + (bent_by_eta(cosine, eta) - cosine) * abbe_vector_dot(out, n);
}

/* What is traced back: derivatives by what goes on from a meeting. */
typedef struct back {
  double p[3], d[3], d_blue[3], share;
} back;

/* The place came along d, and that from the plane's n and d. way: its derivative alone. */
static void back_place(const double plane[4], const double d[3], const double p[3], double length,
                       double way, back *b, double by_d[3], double by_plane[4]) {
  const double ahead = abbe_vector_dot(plane, d);
  const double g = (way + abbe_vector_dot(b->p, d)) / ahead;
  add(by_d, length, b->p);
  add(by_d, -g * length, plane);
  add(b->p, -g, plane);
  add(by_plane, -g, p);
  by_plane[3] += g;
}

/* Back through a refraction, of an outgoing direction. */
static void back_refract(const double n[3], double cosine, double eta, const double out[3],
                         double by_d[3], double by_n[3], double *by_cosine) {
  const double t = bent(cosine, eta);
  add(by_d, eta, out);
  add(by_n, t - eta * cosine, out);
  *by_cosine += abbe_vector_dot(out, n) * (t > 0 ? eta * eta * cosine / t - eta : 0);
}

/* One direction's: from what goes on and what leaves to what came. */
static void back_ray(const double d[3], const double n[3], double cosine, double eta,
                     const double out[3], double by_cosine, double by[3], double by_n[3]) {
  by_cosine -= 2 * abbe_vector_dot(by, n);
  add(by_n, -2 * cosine, by);
  back_refract(n, cosine, eta, out, by, by_n, &by_cosine);
  add(by, by_cosine, n);
  add(by_n, by_cosine, d);
}

static void add_plane(size_t plane, const double own[4], const double *weight, size_t count,
                      abbe_gem_stretch_by *by) {
  for (size_t j = 0; j < count; j++)
    for (int k = 0; k < 4; k++) by[j].plane[plane][k] += weight[j] * own[k];
}

/* With `lit` the stretch's value, of one weight; without it what b has of the place of meeting
 * `from`. */
static void trace_back(const abbe_gem_stretch *w, size_t from, bool lit, const double *weight,
                       size_t count, back *b, abbe_gem_stretch_by *by) {
  for (size_t i = from; i > 0; i--) {
    const abbe_gem_meeting *m = &w->at[i];
    const double *plane = w->stone->plane[m->plane], n = w->n;
    double own[4] = {0}, out[3] = {0}, blue[3] = {0}, by_cosine = 0, way = 0;
    if (lit) {
      const double left = 1 - m->reflected;
      const double by_reflected = left > 0 ? m->share * (b->share - m->light) : 0;
      by_cosine = by_reflected * fresnel_slope(m->cosine, n);
      by->n += *weight * by_reflected * fresnel_by_eta(m->cosine, n);
      add(out, m->share * left, m->by_out);
      add(blue, m->share * left, m->by_blue);
      const double arrives = left * m->light + m->reflected * b->share;
      way = -w->loss * m->share * arrives;
      by->loss -= *weight * m->way * m->share * arrives;
      by->n += *weight * refract_by_eta(m->d, plane, m->cosine, n, out);
      b->share = arrives * (w->loss > 0 ? exp(-w->loss * m->way) : 1);
    }
    back_ray(m->d, plane, m->cosine, n, out, by_cosine, b->d, own);
    if (lit && w->q->fire != 0) {
      by->spread += *weight * refract_by_eta(m->d_blue, plane, m->cosine_blue, w->n_blue, blue);
      back_ray(m->d_blue, plane, m->cosine_blue, w->n_blue, blue, 0, b->d_blue, own);
    }
    back_place(plane, m->d, m->p, m->way, way, b, b->d, own);
    add_plane(m->plane, own, weight, count, by);
  }
  const abbe_gem_meeting *m = &w->at[0];
  const double *plane = w->stone->plane[m->plane];
  const double in[3] = {-plane[0], -plane[1], -plane[2]};
  double own[4] = {0}, by_in[3] = {0}, unused[3] = {0}, by_cosine = 0, by_in_n = 0;
  if (lit) {
    by_cosine = (m->light - b->share) * fresnel_slope(m->cosine, 1 / w->n);
    by_in_n = (m->light - b->share) * fresnel_by_eta(m->cosine, 1 / w->n);
    by->spread -= *weight * refract_by_eta(w->sight, in, m->cosine, 1 / w->n_blue, b->d_blue) /
                  (w->n_blue * w->n_blue);
    by_cosine += 2 * m->reflected * abbe_vector_dot(m->by_out, plane);
    add(own, 2 * m->cosine * m->reflected, m->by_out);
    back_refract(in, m->cosine, 1 / w->n_blue, b->d_blue, unused, by_in, &by_cosine);
  }
  by_in_n += refract_by_eta(w->sight, in, m->cosine, 1 / w->n, b->d);
  for (size_t j = 0; j < count; j++) by[j].n -= weight[j] * by_in_n / (w->n * w->n);
  back_refract(in, m->cosine, 1 / w->n, b->d, unused, by_in, &by_cosine);
  add(own, -1, by_in);
  add(own, -by_cosine, w->sight);
  back_place(plane, w->sight, m->p, 0, 0, b, unused, own);
  add_plane(m->plane, own, weight, count, by);
}

void abbe_gem_stretch_light(abbe_gem_stretch *w, double t, double weight,
                            const abbe_gem_slope_desc *measure, size_t count, double *value,
                            double *drift, abbe_gem_stretch_by *by) {
  move_to(w, t);
  for (size_t j = 0; j < count; j++) {
    back b = {0};
    w->q = &measure[j];
    for (size_t i = 0; i < w->count; i++) judge(w, &w->at[i]);
    value[j] = w->at[0].reflected * w->at[0].light;
    for (size_t i = 1; i < w->count; i++)
      value[j] += w->at[i].share * (1 - w->at[i].reflected) * w->at[i].light;
    trace_back(w, w->count - 1, true, &weight, 1, &b, &by[j]);
    drift[j] = abbe_vector_dot(b.p, w->line);
  }
}

void abbe_gem_stretch_move(abbe_gem_stretch *w, bool high, const double *jump, size_t count,
                           abbe_gem_stretch_by *by) {
  const size_t at = high ? w->high_at : w->low_at, i = high ? w->high_plane : w->low_plane;
  const double *plane = w->stone->plane[i];
  move_to(w, high ? w->high : w->low);
  const double speed = 1 / abbe_vector_dot(plane, w->at[at].v);
  double own[4] = {0, 0, 0, speed};
  back b = {0};
  add(b.p, -speed, plane);
  add(own, -speed, w->at[at].p);
  add_plane(i, own, jump, count, by);
  trace_back(w, at, false, jump, count, &b, by);
}
