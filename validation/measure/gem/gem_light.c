#include "validation/measure/gem/gem_light.h"

#include "base/maths.h"
#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/random.h"

#include <math.h>

#define GOLDEN_RAD (ABBE_PI * (3 - sqrt(5.0))) /* the angle of the spiral [Vogel1979] */

enum { LANES = 64 };

abbe_gem_lamps abbe_gem_lamps_make(const abbe_gem_eye *eye, size_t repeat, double head_rad) {
  abbe_gem_lamps out;
  /* the turn of all lights: the golden section of a whole one */
  const double turn = 2 * ABBE_PI * fmod((double)repeat * 0.6180339887498949, 1);
  for (int i = 0; i < LANES; i++) {
    const double height = (i + 0.5) / ABBE_GEM_LAMPS, across = sqrt(fmax(1 - height * height, 0));
    const double azimuth = turn + i * GOLDEN_RAD;
    /* sizes are spread evenly over all heights: by another irrational step */
    const double share = fmod(i * 0.7548776662466927, 1);
    const double radius =
        0.5 * (ABBE_GEM_LAMP_MIN_DEG + share * (ABBE_GEM_LAMP_MAX_DEG - ABBE_GEM_LAMP_MIN_DEG));
    const bool dark = i >= ABBE_GEM_LAMPS || height >= cos(head_rad);
    double d[3];
    for (int k = 0; k < 3; k++)
      d[k] = across * (cos(azimuth) * eye->right[k] + sin(azimuth) * eye->up[k]) +
             height * eye->to_eye[k];
    out.x[i] = (float)d[0];
    out.y[i] = (float)d[1];
    out.z[i] = (float)d[2];
    out.cos_radius[i] = dark ? 2 : (float)cos(radius * ABBE_PI / 180);
  }
  return out;
}

SIDE_BY_SIDE static int lamps_at(const abbe_gem_lamps *l, const float d[3]) {
  const float x = d[0], y = d[1], z = d[2];
  int met = 0;
  for (int i = 0; i < LANES; i++) met += l->x[i] * x + l->y[i] * y + l->z[i] * z > l->cos_radius[i];
  return met;
}

/* Where two lamps overlap there is one. */
float abbe_gem_lamps_light(const abbe_gem_lamps *lamps, const abbe_gem_path *path) {
  float sum = 0;
  for (size_t i = 0; i < path->count; i++)
    if (lamps_at(lamps, path->exit[i].d) > 0) sum += path->exit[i].share;
  return sum;
}

bool abbe_gem_path_enter(const abbe_gem_stone *s, const double o[3], const double d[3], double p[3],
                         double n[3]) {
  double enter = -INFINITY, leave = INFINITY;
  const double *face = NULL;
  for (size_t j = 0; j < s->plane_count; j++) {
    const double *plane = s->plane[j];
    const double ahead = abbe_vector_dot(plane, d), off = plane[3] - abbe_vector_dot(plane, o);
    if (ahead < 0 && off / ahead > enter) {
      enter = off / ahead;
      face = plane;
    }
    if (ahead > 0) leave = fmin(leave, off / ahead);
    if (ahead == 0 && off < 0) return false;
  }
  if (face == NULL || !(enter < leave)) return false;
  for (int k = 0; k < 3; k++) {
    p[k] = o[k] + enter * d[k];
    n[k] = face[k];
  }
  return true;
}

static void add_exit(abbe_gem_path *path, const float d[3], float share) {
  abbe_gem_exit *e = &path->exit[path->count++];
  for (int k = 0; k < 3; k++) e->d[k] = d[k];
  e->share = share;
}

/* What becomes of light at a face. */
typedef struct meeting {
  float reflected, back[3], through[3];
  uint8_t wave; /* in a crystal, of the light that stays in it or comes into it */
} meeting;

static void copy(const float from[3], float to[3]) {
  for (int i = 0; i < 3; i++) to[i] = from[i];
}

/* Of two waves, one goes on, by chance. n: on the side that the light comes from. */
static meeting meet_crystal(const abbe_gem_stone *s, size_t k, bool inside, const float n[3],
                            const float d[3], uint8_t wave, float chance) {
  abbe_wave_ways ways;
  abbe_wave_face face = {inside ? 0 : -1, inside ? -1 : 0, -1, !inside, .wave = wave};
  copy(n, face.n);
  copy(d, face.d);
  abbe_media_ways(&s->media, &face, (uint32_t)k, 0, &ways);
  const abbe_wave_way *back = abbe_wave_ways_choose(&ways, 0, chance),
                      *through = abbe_wave_ways_choose(&ways, 1, chance);
  meeting m = {.reflected = ways.reflected, .wave = inside ? back->wave : through->wave};
  copy(back->d, m.back);
  copy(through->d, m.through);
  return m;
}

static meeting meet_glass(const abbe_gem_stone *s, size_t k, bool inside, const float n[3],
                          const float d[3]) {
  meeting m = {0};
  float cos_t, index = abbe_media_n(&s->media, 0, (uint32_t)k, 0), eta = inside ? index : 1 / index;
  const float cos_i = fminf(fmaxf(-(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]), 0), 1);
  m.reflected = abbe_interface_reflectance(cos_i, eta, &cos_t);
  abbe_interface_reflect(d, n, cos_i, m.back);
  if (m.reflected < 1) abbe_interface_refract(d, n, eta, cos_i, cos_t, m.through);
  return m;
}

static meeting meet(const abbe_gem_stone *s, size_t k, int face, const float n[3], const float d[3],
                    uint8_t wave, uint32_t seed) {
  float chance[4];
  if (!abbe_media_is_crystal(&s->media, 0)) return meet_glass(s, k, face > 0, n, d);
  if (face == 0) return meet_crystal(s, k, false, n, d, wave, abbe_random_float(seed));
  abbe_random4(seed, (uint32_t)face, 0, 0, chance);
  return meet_crystal(s, k, true, n, d, wave, chance[0]);
}

void abbe_gem_path_follow(const abbe_gem_stone *s, size_t k, const double p0[3], const double n0[3],
                          const double d0[3], uint32_t seed, abbe_gem_path *out) {
  float p[3], n[3], d[3];
  for (int i = 0; i < 3; i++) {
    p[i] = (float)p0[i];
    n[i] = (float)n0[i];
    d[i] = (float)d0[i];
  }
  out->count = 0;
  out->absorbed = 0;
  meeting m = meet(s, k, 0, n, d, 0, seed);
  add_exit(out, m.back, m.reflected);
  copy(m.through, d);
  float share = 1 - m.reflected;
  const float least =
      abbe_media_is_crystal(&s->media, 0) ? ABBE_GEM_LEAST_CRYSTAL : ABBE_GEM_LEAST_SHARE;
  for (int face = 1;
       face < ABBE_GEM_MOST_FACES && out->count < ABBE_GEM_MOST_EXITS && share >= least; face++) {
    float q[3], t = abbe_solid_leave(&s->solid, p, d, q, n);
    copy(q, p);
    const float loss = abbe_media_loss(&s->media, 0, (uint32_t)k, 0, d, m.wave);
    if (loss > 0) {
      const float kept = share * expf(-loss * t);
      out->absorbed += share - kept;
      share = kept;
    }
    for (int i = 0; i < 3; i++) n[i] = -n[i];
    m = meet(s, k, face, n, d, m.wave, seed);
    if (m.reflected < 1) {
      add_exit(out, m.through, share * (1 - m.reflected));
      share *= m.reflected;
    }
    copy(m.back, d);
  }
  out->left = share;
}

static const char *const names[] = {
#define ABBE_GEM_AMOUNT_NAME(code, name, text) name,
    ABBE_GEM_AMOUNTS(ABBE_GEM_AMOUNT_NAME)
#undef ABBE_GEM_AMOUNT_NAME
};
static const char *const texts[] = {
#define ABBE_GEM_AMOUNT_TEXT(code, name, text) text,
    ABBE_GEM_AMOUNTS(ABBE_GEM_AMOUNT_TEXT)
#undef ABBE_GEM_AMOUNT_TEXT
};

const char *abbe_gem_amount_name(abbe_gem_amount amount) {
  return (unsigned)amount < ABBE_GEM_AMOUNT_COUNT ? names[amount] : "unknown";
}

const char *abbe_gem_amount_text(abbe_gem_amount amount) {
  return (unsigned)amount < ABBE_GEM_AMOUNT_COUNT ? texts[amount] : "unknown";
}

abbe_gem_light abbe_gem_light_make(const double eye[3], double head_rad) {
  abbe_gem_light light;
  for (int k = 0; k < 3; k++) light.eye[k] = (float)eye[k];
  /* beyond any cosine where there is no head */
  light.cos_head = head_rad > 0 ? (float)cos(head_rad) : 2;
  light.cos_gemray = (float)cos(ABBE_GEM_GEMRAY_HEAD_DEG * ABBE_DEGREE);
  return light;
}

void abbe_gem_light_judge(const abbe_gem_light *light, const abbe_gem_path *path,
                          float amount[ABBE_GEM_AMOUNT_COUNT]) {
  for (int k = 0; k < ABBE_GEM_AMOUNT_COUNT; k++) amount[k] = 0;
  for (size_t i = 0; i < path->count; i++) {
    const abbe_gem_exit *e = &path->exit[i];
    const float up = e->d[2];
    const float to_eye =
        e->d[0] * light->eye[0] + e->d[1] * light->eye[1] + e->d[2] * light->eye[2];
    const bool head = to_eye >= light->cos_head;
    if (up > 0) {
      amount[ABBE_GEM_ISO] += e->share;
      amount[ABBE_GEM_COS] += e->share * fminf(up, 1);
      amount[head ? ABBE_GEM_HEAD : ABBE_GEM_RETURN] += e->share;
    } else {
      amount[ABBE_GEM_DOWN] += e->share;
    }
    if (to_eye > 0 && to_eye <= light->cos_gemray) {
      amount[ABBE_GEM_GEMRAY_ISO] += e->share;
      amount[ABBE_GEM_GEMRAY_COS] += e->share * to_eye;
      amount[ABBE_GEM_GEMRAY_SC2] += e->share * 2 * to_eye * sqrtf(1 - to_eye * to_eye);
    }
    amount[to_eye <= 0            ? ABBE_GEM_BELOW
           : head                 ? ABBE_GEM_BLUE
           : to_eye > 0.70710678f ? ABBE_GEM_RED
                                  : ABBE_GEM_GREEN] += e->share;
  }
  amount[ABBE_GEM_ABSORBED] = path->absorbed;
  amount[ABBE_GEM_LEFT] = path->left;
}

static double scatter(double square, size_t count) {
  return count < 2 ? NAN : sqrt(square * ((double)count - 1) / (double)count);
}

abbe_gem_number abbe_gem_number_jackknife(double whole, const double *without, size_t count) {
  double mean = 0, square = 0;
  for (size_t i = 0; i < count; i++) mean += without[i] / (double)count;
  for (size_t i = 0; i < count; i++) square += (without[i] - mean) * (without[i] - mean);
  return (abbe_gem_number){whole, scatter(square, count)};
}

static double ratio(double sum, double weight) {
  return weight > 0 ? sum / weight : 0;
}

abbe_gem_number abbe_gem_number_ratio(const double *sum, const double *weight, size_t count) {
  double s = 0, w = 0, mean = 0, square = 0;
  for (size_t i = 0; i < count; i++) {
    s += sum[i];
    w += weight[i];
  }
  for (size_t i = 0; i < count; i++) mean += ratio(s - sum[i], w - weight[i]) / (double)count;
  for (size_t i = 0; i < count; i++) square += pow(ratio(s - sum[i], w - weight[i]) - mean, 2);
  return (abbe_gem_number){ratio(s, w), scatter(square, count)};
}

void abbe_gem_sums_add(abbe_gem_sums *s, const double *value, const float *weight, size_t count) {
  const double n = (double)count, unbiased = n / (n - 1);
  double v = 0, w = 0;
  for (size_t r = 0; r < count; r++) {
    v += value[r];
    w += (double)weight[r];
  }
  s->value += v;
  s->weight += w;
  for (size_t r = 0; r < count; r++) {
    const double dv = value[r] - v / n, dw = (double)weight[r] - w / n;
    s->value_square += unbiased * dv * dv;
    s->product += unbiased * dv * dw;
    s->weight_square += unbiased * dw * dw;
  }
}

void abbe_gem_sums_join(abbe_gem_sums *to, const abbe_gem_sums *other) {
  to->value += other->value;
  to->weight += other->weight;
  to->value_square += other->value_square;
  to->product += other->product;
  to->weight_square += other->weight_square;
}

abbe_gem_number abbe_gem_sums_ratio(const abbe_gem_sums *s) {
  const double is = ratio(s->value, s->weight);
  const double square = s->value_square - 2 * is * s->product + is * is * s->weight_square;
  return (abbe_gem_number){is, ratio(sqrt(fmax(square, 0)), s->weight)};
}

/* A vector of the stone's, seen from the eye's frame before the stone turned: turned back. */
static void turn(const double axis[2], double c, double s, const double in[3], double out[3]) {
  const double along = axis[0] * in[0] + axis[1] * in[1];
  const double cross[3] = {axis[1] * in[2], -axis[0] * in[2], axis[0] * in[1] - axis[1] * in[0]};
  for (int k = 0; k < 3; k++)
    out[k] = c * in[k] + s * cross[k] + (1 - c) * along * (k < 2 ? axis[k] : 0);
}

abbe_gem_eye abbe_gem_eye_make(double axis_rad, double tilt_rad) {
  static const double base[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double axis[2] = {cos(axis_rad), sin(axis_rad)};
  abbe_gem_eye eye;
  double *to[3] = {eye.right, eye.up, eye.to_eye};
  /* the stone turns one way, and the eye in its axes the other */
  for (int k = 0; k < 3; k++) turn(axis, cos(tilt_rad), -sin(tilt_rad), base[k], to[k]);
  return eye;
}

void abbe_gem_eye_ray(const abbe_gem_eye *eye, size_t side, size_t column, size_t row, double u,
                      double v, double o[3], double d[3]) {
  const double x = 2 * ((double)column + u) / (double)side - 1;
  const double y = 1 - 2 * ((double)row + v) / (double)side;
  for (int k = 0; k < 3; k++) {
    o[k] = x * eye->right[k] + y * eye->up[k] + 2 * eye->to_eye[k];
    d[k] = -eye->to_eye[k];
  }
}

uint32_t abbe_gem_eye_place(size_t side, size_t column, size_t row, size_t repeat, double *u,
                            double *v) {
  uint32_t bits[4];
  abbe_random_bits((uint32_t)column, (uint32_t)row, (uint32_t)side, (uint32_t)repeat, bits);
  *u = (double)abbe_random_float(bits[0]);
  *v = (double)abbe_random_float(bits[1]);
  /* of a pixel's repeats, so that its first choices are spread evenly [Roberts2018] */
  abbe_random_bits((uint32_t)column, (uint32_t)row, (uint32_t)side, 0, bits);
  return bits[2] + (uint32_t)repeat * 2654435769u;
}
