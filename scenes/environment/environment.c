#include "scenes/environment/environment.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/geometry/digest.h"
#include "scenes/geometry/transform.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Splits the entries into those below the mean, from the front of the list, and those at or above
 * it, from its end; then fills up each of the first from one of the second. */
static void fill(const double *weight, double mean, size_t heaviest, uint32_t *list,
                 abbe_alias_table *out) {
  const size_t count = out->count;
  double *left = out->keep; /* an entry's share, until it is final */
  size_t low = 0, high = count;
  for (size_t i = 0; i < count; i++) {
    left[i] = weight[i] / mean;
    list[left[i] < 1 ? low++ : --high] = (uint32_t)i;
  }
  while (low > 0 && high < count) {
    const uint32_t small = list[--low], large = list[high];
    out->other[small] = large;
    left[large] -= 1 - left[small];
    if (left[large] < 1) {
      high++;
      list[low++] = large;
    }
  }
  /* what is left would be full but for rounding */
  for (; low > 0; low--) {
    const uint32_t i = list[low - 1];
    out->keep[i] = weight[i] > 0 ? 1 : 0;
    out->other[i] = (uint32_t)heaviest;
  }
  for (; high < count; high++) {
    out->keep[list[high]] = 1;
    out->other[list[high]] = list[high];
  }
}

abbe_result abbe_alias_table_make(const double *weight, size_t count, abbe_alias_table *out,
                                  abbe_error *error) {
  *out = (abbe_alias_table){0};
  double sum = 0;
  size_t heaviest = 0;
  bool fine = count > 0 && count <= UINT32_MAX;
  for (size_t i = 0; i < count && fine; i++) {
    fine = isfinite(weight[i]) && weight[i] >= 0;
    if (weight[i] > weight[heaviest]) heaviest = i;
    sum += weight[i];
  }
  const double mean = fine ? sum / (double)count : 0;
  if (!(mean > 0) || !isfinite(1 / mean) || !isfinite(sum))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "there is nothing to draw from: weights want to be finite, at least 0 "
                          "and not all 0");
  uint32_t *list = malloc(count * sizeof *list);
  abbe_alias_table table = {count, malloc(count * sizeof *table.keep),
                            malloc(count * sizeof *table.other)};
  const bool room = list && table.keep && table.other;
  if (room)
    fill(weight, mean, heaviest, list, &table);
  else
    abbe_alias_table_free(&table);
  free(list);
  if (!room)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a table of %zu entries", count);
  *out = table;
  return ABBE_OK;
}

void abbe_alias_table_free(abbe_alias_table *table) {
  if (table == NULL) return;
  free(table->keep);
  free(table->other);
  *table = (abbe_alias_table){0};
}

size_t abbe_alias_table_draw(const abbe_alias_table *table, double u) {
  const double at = u * (double)table->count;
  size_t i = (size_t)at;
  if (i >= table->count) i = table->count - 1;
  return at - (double)i < table->keep[i] ? i : table->other[i];
}

static void apply(const double m[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = abbe_vector_dot(m + 3 * i, v);
}

static void apply_inverse(const double m[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
}

/* Luminance of Rec.709's primaries [BT709]. */
static const double luminance[3] = {0.2126390058715104, 0.7151686787677559, 0.0721923153607337};

/* --- making --- */

static abbe_result check_texels(const abbe_radiance_map *map, abbe_error *error) {
  static const char *const channels[] = {"red", "green", "blue"};
  for (size_t i = 0; i < 3 * map->width * map->height; i++) {
    const double value = (double)map->rgb[i];
    if (value >= 0 && value <= ABBE_ENVIRONMENT_MOST) continue;
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s of the texel at column %zu, row %zu is %g; radiance is 0 to %g",
                          channels[i % 3], i / 3 % map->width, i / 3 / map->width, value,
                          ABBE_ENVIRONMENT_MOST);
  }
  return ABBE_OK;
}

static abbe_result make_table(const abbe_radiance_map *map, double *total, abbe_alias_table *out,
                              abbe_error *error) {
  const size_t count = map->width * map->height;
  ABBE_FREED double *weight = malloc(count * sizeof *weight);
  if (weight == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu texels' weights", count);
  *total = 0;
  for (size_t row = 0; row < map->height; row++) {
    const double solid = abbe_radiance_map_solid_angle(map, row);
    double sum = 0;
    for (size_t i = row * map->width; i < (row + 1) * map->width; i++) {
      const float *texel = map->rgb + 3 * i;
      weight[i] = solid * (luminance[0] * (double)texel[0] + luminance[1] * (double)texel[1] +
                           luminance[2] * (double)texel[2]);
      sum += weight[i];
    }
    *total += sum;
  }
  return *total > 1e-30
             ? abbe_alias_table_make(weight, count, out, error)
             : abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "the surroundings are black everywhere; leave them out, or give them "
                              "some light");
}

abbe_result abbe_environment_prepare(abbe_environment *environment, abbe_error *error) {
  assert(environment->map.rgb);
  abbe_environment made = *environment;
  made.level_count = 0;
  made.texels = (abbe_alias_table){0};
  abbe_result result = check_texels(&made.map, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result == ABBE_OK) result = make_table(&made.map, &made.luminance, &made.texels, error);
  made.map_digest = abbe_digest_array(made.map.width, made.map.rgb,
                                      3 * made.map.width * made.map.height, sizeof *made.map.rgb);
  abbe_radiance_map_mean(&made.map, made.mean);
  const abbe_radiance_map *last = &made.map;
  while (result == ABBE_OK && last->height >= 4 && made.level_count < ABBE_ENVIRONMENT_MAX_LEVELS) {
    result = abbe_watch_check(error);
    if (result == ABBE_OK)
      result = abbe_radiance_map_halve(last, &made.level[made.level_count], error);
    if (result == ABBE_OK) last = &made.level[made.level_count++];
  }
  if (result == ABBE_OK) {
    *environment = made;
    return ABBE_OK;
  }
  abbe_alias_table_free(&made.texels);
  for (size_t i = 0; i < made.level_count; i++) abbe_radiance_map_free(&made.level[i]);
  return result;
}

void abbe_environment_free(abbe_environment *environment) {
  if (environment == NULL) return;
  free(environment->path);
  free(environment->illuminant_path);
  abbe_illuminant_free(&environment->illuminant);
  abbe_radiance_map_free(&environment->map);
  abbe_alias_table_free(&environment->texels);
  for (size_t i = 0; i < environment->level_count; i++)
    abbe_radiance_map_free(&environment->level[i]);
  memset(environment, 0, sizeof *environment);
}

void abbe_environment_turn(double rotate_rad, const double axis[3], double tilt_rad,
                           double to_map[9]) {
  double rotation[16], tilt[16];
  abbe_transform_rotate(rotate_rad, (const double[3]){0, 0, 1}, rotation);
  if (axis != NULL) {
    abbe_transform_rotate(tilt_rad, axis, tilt);
    abbe_transform_multiply(tilt, rotation, rotation);
  }
  /* the inverse of a rotation is its transpose: rows here are that matrix's columns */
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) to_map[3 * i + k] = rotation[4 * i + k];
}

/* --- looking --- */

void abbe_environment_radiance(const abbe_environment *environment, const double direction[3],
                               double rgb[3]) {
  abbe_environment_radiance_of_level(environment, 0, direction, rgb);
}

void abbe_environment_radiance_of_level(const abbe_environment *environment, size_t index,
                                        const double direction[3], double rgb[3]) {
  double own[3];
  if (index > environment->level_count) index = environment->level_count;
  apply(environment->to_map, direction, own);
  abbe_radiance_map_at(index == 0 ? &environment->map : &environment->level[index - 1], own, rgb);
}

/* --- sampling --- */

/* A texel's share over polar angle: (a + b t) |sin(middle + t)|, t from its middle, in at most four
 * smooth pieces: up and down, cut where a row goes on over a pole. */
typedef struct polar_piece {
  double from, to, slope, sign;
  double at_from, mass; /* antiderivative where it begins, and the integral over it */
} polar_piece;

/* A row of texels: its middle's polar angle, and how far its share reaches. */
typedef struct polar_row {
  double middle, step, sine, cosine; /* elevation of the middle */
} polar_row;

/* Sine and cosine of middle + t, |t| <= step: by their series where that is short. */
static void angle_at(const polar_row *r, double t, double *sine, double *cosine) {
  if (r->step > 0.1) {
    *sine = sin(r->middle + t);
    *cosine = cos(r->middle + t);
    return;
  }
  const double x = t * t;
  const double s = t * (1 - x / 6 * (1 - x / 20 * (1 - x / 42 * (1 - x / 72))));
  const double c = 1 - x / 2 * (1 - x / 12 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90))));
  *sine = r->sine * c + r->cosine * s;
  *cosine = r->cosine * c - r->sine * s;
}

/* Antiderivative of (1 + slope t) sin(middle + t), and that itself. */
static double antiderivative(const polar_row *r, double slope, double t, double *rate) {
  double sine, cosine;
  angle_at(r, t, &sine, &cosine);
  *rate = (1 + slope * t) * sine;
  return slope * sine - (1 + slope * t) * cosine;
}

static int pieces_of(const polar_row *r, polar_piece piece[4]) {
  double cut[5] = {-r->step, 0, r->step};
  int count = 2;
  if (r->middle < r->step) {
    cut[3] = cut[2], cut[2] = cut[1], cut[1] = -r->middle;
    count++;
  }
  if (r->middle > ABBE_PI - r->step) {
    cut[count + 1] = cut[count], cut[count] = ABBE_PI - r->middle;
    count++;
  }
  for (int i = 0; i < count; i++) {
    const double at = (cut[i] + cut[i + 1]) / 2, slope = at < 0 ? 1 / r->step : -1 / r->step;
    const double sign = r->middle + at < 0 || r->middle + at > ABBE_PI ? -1 : 1;
    double rate;
    const double from = antiderivative(r, slope, cut[i], &rate);
    const double mass = sign * (antiderivative(r, slope, cut[i + 1], &rate) - from);
    piece[i] = (polar_piece){cut[i], cut[i + 1], slope, sign, from, fmax(mass, 0)};
  }
  return count;
}

/* Where the piece's integral is that share of the whole, if the sine did not change in it. */
static double guess(const polar_piece *p, double share) {
  const double low = 1 + p->slope * p->from, high = 1 + p->slope * p->to;
  const double there = sqrt(low * low + share * (high * high - low * low));
  return p->from + (there - low) / p->slope;
}

/* By Newton's steps, held in an interval that bisection keeps. Each doubles the digits, so that
 * after one below 1e-7 of a row what is left is rounding. */
static double solve(const polar_row *r, const polar_piece *p, double mass) {
  double low = p->from, high = p->to, t = guess(p, p->mass > 0 ? mass / p->mass : 0);
  if (!(t > low && t < high)) t = (low + high) / 2;
  for (int i = 0; i < 60; i++) {
    double rate;
    const double sum = antiderivative(r, p->slope, t, &rate) - p->at_from;
    const double over = p->sign * sum - mass;
    rate *= p->sign;
    if (over > 0)
      high = t;
    else
      low = t;
    double next = rate > 0 ? t - over / rate : low;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (fabs((next - t) * p->slope) <= 1e-7) return next;
    t = next;
  }
  return t;
}

/* Polar angle of a texel of the row, by share x solid angle; below 0 or above pi it lies over the
 * pole. */
static double polar_of(const abbe_radiance_map *map, size_t row, double u) {
  const double step = ABBE_PI / (double)map->height, middle = ((double)row + 0.5) * step;
  const polar_row r = {middle, step, sin(middle), cos(middle)};
  polar_piece piece[4];
  double sum = 0;
  const int count = pieces_of(&r, piece);
  for (int i = 0; i < count; i++) sum += piece[i].mass;
  double rest = u * sum;
  int i = 0;
  while (i < count - 1 && rest >= piece[i].mass) rest -= piece[i++].mass;
  return middle + solve(&r, &piece[i], fmin(rest, piece[i].mass));
}

static double density(const abbe_environment *environment, const double own[3]) {
  double rgb[3];
  abbe_radiance_map_at(&environment->map, own, rgb);
  return abbe_vector_dot(luminance, rgb) / environment->luminance;
}

void abbe_environment_sample(const abbe_environment *environment, const double u[3],
                             double direction[3], double *pdf, double rgb[3]) {
  const abbe_radiance_map *map = &environment->map;
  const size_t texel = abbe_alias_table_draw(&environment->texels, u[0]);
  /* over longitude the share is a triangle */
  const double aside = u[1] < 0.5 ? sqrt(2 * u[1]) - 1 : 1 - sqrt(2 - 2 * u[1]);
  const double x = (double)(texel % map->width) + 0.5 + aside;
  const double y = polar_of(map, texel / map->width, u[2]) / ABBE_PI * (double)map->height;
  double own[3], share[4];
  size_t around[4];
  abbe_radiance_map_direction(map, x, y, own);
  abbe_radiance_map_texels(map, x, y, around, share);
  for (int k = 0; k < 3; k++) {
    rgb[k] = 0;
    for (int i = 0; i < 4; i++) rgb[k] += share[i] * (double)map->rgb[3 * around[i] + (size_t)k];
  }
  *pdf = abbe_vector_dot(luminance, rgb) / environment->luminance;
  apply_inverse(environment->to_map, own, direction);
}

double abbe_environment_pdf(const abbe_environment *environment, const double direction[3]) {
  double own[3];
  apply(environment->to_map, direction, own);
  return density(environment, own);
}
