#include "scenes/lights/environment_lights.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "colorimetry/upsampling.h"
#include "scenes/geometry/digest.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
  COLUMNS = 128,
  ROWS = 64,
  BINS = ROWS * COLUMNS, /* bins for directions of the map */
  MOST_LAMPS = 64,
  VALUES = 7 /* luminance, luminance x direction, RGB */
};

static const double luminance[3] = {0.2126390058715104, 0.7151686787677559, 0.0721923153607337};

static const double OVER_MEAN = 3;      /* so bright is what stands out */
static const double COMPACT = 0.0109;   /* (1 - cos(12 degrees)) / 2 */
static const double LEAST_SHARE = 0.02; /* share of all light that becomes a light */

typedef double sums[VALUES];

/* A place that stands out of its surroundings. */
typedef struct lamp {
  sums value;
  size_t number; /* in the order in which they were found */
} lamp;

/* What of a bin belongs to a compact source: the radiance above that. */
typedef struct cut {
  double above;
  size_t lamp; /* its number; MOST_LAMPS: none's */
} cut;

typedef struct search {
  const abbe_environment *environment;
  sums *bin; /* [BINS], of what is brighter than the present bound */
  unsigned char
      *place;    /* [BINS]: 1 where it is looked for, then 2 where it belongs to a compact source */
  size_t *found; /* [BINS], bins of one compact source */
  cut *cuts;     /* [BINS] */
  double (*way)[2]; /* cosine and sine of each column's azimuth */
  lamp lamp[MOST_LAMPS];
  size_t count;
} search;

static double luminance_of(const float *rgb) {
  double y = 0;
  for (int k = 0; k < 3; k++) y += luminance[k] * (double)rgb[k];
  return y;
}

/* The mean of the radiance as far as it does not stand out of that mean itself. */
static double mean_of_most(const abbe_environment *e) {
  const abbe_radiance_map *map = &e->map;
  double mean = e->luminance / (4 * ABBE_PI);
  for (int pass = 0; pass < 6; pass++) {
    double sum = 0;
    for (size_t y = 0; y < map->height; y++) {
      double row = 0;
      for (size_t x = 0; x < map->width; x++)
        row += fmin(luminance_of(map->rgb + 3 * (y * map->width + x)), OVER_MEAN * mean);
      sum += row * abbe_radiance_map_solid_angle(map, y);
    }
    mean = sum / (4 * ABBE_PI);
  }
  return mean;
}

/* What is above that radiance, in bins that are looked at. */
static void fill(const search *s, double above) {
  const abbe_radiance_map *map = &s->environment->map;
  memset(s->bin, 0, BINS * sizeof *s->bin);
  for (size_t y = 0; y < map->height; y++) {
    const double solid = abbe_radiance_map_solid_angle(map, y);
    double at[3];
    abbe_radiance_map_direction(map, 0.5, (double)y + 0.5, at);
    const double around = hypot(at[0], at[1]);
    for (size_t x = 0; x < map->width; x++) {
      const float *texel = map->rgb + 3 * (y * map->width + x);
      const double bright = luminance_of(texel);
      if (!(bright > above)) continue;
      const size_t bin = y * ROWS / map->height * COLUMNS + x * COLUMNS / map->width;
      if (s->place[bin] != 1) continue;
      const double share = solid * (1 - above / bright), *way = s->way[x];
      double *sum = s->bin[bin];
      sum[0] += share * bright;
      for (int k = 0; k < 2; k++) sum[1 + k] += share * bright * around * way[k];
      sum[3] += share * bright * at[2];
      for (int k = 0; k < 3; k++) sum[4 + k] += share * (double)texel[k];
    }
  }
}

static void take(search *s, size_t bin, size_t *count) {
  if (s->place[bin] != 1 || !(s->bin[bin][0] > 0)) return;
  s->place[bin] = 2;
  s->found[(*count)++] = bin;
}

/* All bins with light that touch each other, from one on; those of a pole's row touch. */
static size_t find_bins(search *s, size_t first) {
  size_t count = 0;
  take(s, first, &count);
  for (size_t i = 0; i < count; i++) {
    const size_t row = s->found[i] / COLUMNS, column = s->found[i] % COLUMNS;
    for (size_t y = row > 0 ? row - 1 : 0; y <= row + 1 && y < ROWS; y++)
      for (size_t x = 0; x < 3; x++)
        take(s, y * COLUMNS + (column + COLUMNS + x - 1) % COLUMNS, &count);
    if (row == 0 || row == ROWS - 1)
      for (size_t x = 0; x < COLUMNS; x++) take(s, row * COLUMNS + x, &count);
  }
  return count;
}

/* Finds compact sources brighter than the bound: those small enough for a sharp light are kept;
 * others are looked for again above twice the bound, where their light is theirs alone. */
static void find_lamps(search *s, double above) {
  const double least = LEAST_SHARE * s->environment->luminance;
  memset(s->place, 1, BINS);
  for (size_t i = 0; i < BINS; i++) s->cuts[i].lamp = MOST_LAMPS;
  for (bool wide = true; wide && abbe_watch_goes_on();
       above = above > 0 ? 2 * above : s->environment->luminance * 1e-3) {
    wide = false;
    fill(s, above);
    for (size_t first = 0; first < BINS; first++) {
      if (s->place[first] != 1 || !(s->bin[first][0] > 0)) continue;
      sums value = {0};
      const size_t count = find_bins(s, first);
      for (size_t i = 0; i < count; i++)
        for (int k = 0; k < VALUES; k++) value[k] += s->bin[s->found[i]][k];
      if (!(value[0] > least)) continue;
      if (value[0] - abbe_vector_length(value + 1) > COMPACT * value[0]) {
        for (size_t i = 0; i < count; i++) s->place[s->found[i]] = 3;
        wide = true;
      } else if (s->count < MOST_LAMPS) {
        for (size_t i = 0; i < count; i++) s->cuts[s->found[i]] = (cut){above, s->count};
        s->lamp[s->count].number = s->count;
        memcpy(s->lamp[s->count++].value, value, sizeof value);
      }
    }
    for (size_t i = 0; i < BINS; i++) s->place[i] = s->place[i] == 3;
  }
}

static int by_light(const void *a, const void *b) {
  const double x = abbe_vector_length(((const lamp *)a)->value + 1);
  const double y = abbe_vector_length(((const lamp *)b)->value + 1);
  return (x < y) - (x > y);
}

/* The environment's own where the part is grey, else that times the colour's lift. */
static abbe_result set_spectrum(const abbe_environment *e, const abbe_upsampling *up,
                                const double rgb[3], abbe_illuminant *out, abbe_error *error) {
  enum { STEP_NM = 5, MOST = 512 };
  const bool grey = fabs(rgb[0] - rgb[1]) + fabs(rgb[1] - rgb[2]) <= 1e-6 * (rgb[0] + rgb[1]);
  *out = (abbe_illuminant){.kind = e->illuminant.kind};
  if (grey && e->illuminant.kind != ABBE_ILLUMINANT_TABULATED) return ABBE_OK;
  double nm[MOST], power[MOST];
  size_t count = (size_t)((up->max_nm - up->min_nm) / STEP_NM) + 2;
  if (count > MOST) count = MOST;
  for (size_t i = 0; i < count; i++) {
    nm[i] = up->min_nm + (up->max_nm - up->min_nm) * (double)i / (double)(count - 1);
    power[i] =
        abbe_illuminant_power(&e->illuminant, nm[i]) * fmax(abbe_upsampling_at(up, rgb, nm[i]), 0);
  }
  out->kind = ABBE_ILLUMINANT_TABULATED;
  return abbe_spectrum_make(nm, power, count, ABBE_INTERPOLATION_LINEAR, &out->spectrum, error);
}

/* For its observer, of a colour that to the observer of 1931 is as bright as white: lights of one
 * power are equally bright to any. */
static double brightness(const abbe_upsampling *up, const double rgb[3]) {
  if (up->observer == ABBE_OBSERVER_CIE_1931) return 1;
  return up->to_xyz[3] * rgb[0] + up->to_xyz[4] * rgb[1] + up->to_xyz[5] * rgb[2];
}

static abbe_result set_light(const abbe_environment *e, const abbe_upsampling *up, const lamp *p,
                             size_t number, abbe_light *out, abbe_error *error) {
  double towards[3], rgb[3], y = 0;
  memcpy(towards, p->value + 1, sizeof towards);
  const double sum = abbe_vector_length(towards);
  abbe_vector_normalise(towards);
  for (int i = 0; i < 3; i++) /* world from map: the inverse of a rotation */
    out->direction[i] = -(e->to_map[i] * towards[0] + e->to_map[3 + i] * towards[1] +
                          e->to_map[6 + i] * towards[2]);
  for (int k = 0; k < 3; k++) rgb[k] = p->value[4 + k];
  for (int k = 0; k < 3; k++) y += luminance[k] * rgb[k];
  out->kind = ABBE_LIGHT_DIRECTIONAL;
  for (int k = 0; k < 3; k++) rgb[k] /= y;
  out->power = sum * brightness(up, rgb);
  /* A disk's directions have half of (1 - cos) of its edge's angle from their mean. */
  const double edge = fmax(2 * sum / p->value[0] - 1, 0.5);
  out->radius = sqrt(fmax(1 - edge * edge, 0)) / edge;
  char name[40];
  snprintf(name, sizeof name, "environment %zu", number);
  out->name = strdup(name);
  if (out->name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light");
  return set_spectrum(e, up, rgb, &out->illuminant, error);
}

/* Irradiance of all but the lights, by normal. By luminance it is nowhere negative: a compact
 * source's own irradiance is that of its light, or, on planes that only some of it is before,
 * more. */
static void find_soft(const search *s, abbe_irradiance_map *out) {
  for (size_t row = 0; row < ABBE_IRRADIANCE_MAP_ROWS; row++)
    for (size_t column = 0; column < ABBE_IRRADIANCE_MAP_COLUMNS; column++) {
      double world[3], n[3], rgb[3] = {0};
      abbe_irradiance_map_normal(row, column, world);
      for (int i = 0; i < 3; i++) n[i] = abbe_vector_dot(s->environment->to_map + 3 * i, world);
      for (size_t i = 0; i < BINS; i++) {
        const double *bin = s->bin[i], facing = abbe_vector_dot(n, bin + 1);
        if (!(facing > 0)) continue;
        for (int k = 0; k < 3; k++) rgb[k] += facing / bin[0] * bin[4 + k];
      }
      for (size_t i = 0; i < s->count; i++) {
        const double *light = s->lamp[i].value;
        const double facing = fmax(abbe_vector_dot(n, light + 1), 0);
        for (int k = 0; k < 3; k++) rgb[k] -= facing / light[0] * light[4 + k];
      }
      for (int k = 0; k < 3; k++) out->rgb[row][column][k] = (float)fmax(rgb[k], 0);
    }
}

static void drop_search(search *s) {
  free(s->bin);
  free(s->place);
  free(s->found);
  free(s->cuts);
  free(s->way);
}

/* The brightest compact sources, at most so many. */
static abbe_result look_for_lamps(const abbe_environment *e, size_t most, search *s,
                                  abbe_error *error) {
  *s = (search){.environment = e,
                .bin = malloc(BINS * sizeof *s->bin),
                .place = malloc(BINS),
                .found = malloc(BINS * sizeof *s->found),
                .cuts = malloc(BINS * sizeof *s->cuts),
                .way = malloc(e->map.width * sizeof *s->way)};
  if (s->bin == NULL || s->place == NULL || s->found == NULL || s->cuts == NULL || s->way == NULL) {
    drop_search(s);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment's lights");
  }
  for (size_t x = 0; x < e->map.width; x++) {
    double level[3];
    abbe_radiance_map_direction(&e->map, (double)x + 0.5, (double)e->map.height / 2, level);
    memcpy(s->way[x], level, sizeof s->way[x]);
  }
  find_lamps(s, OVER_MEAN * mean_of_most(e));
  qsort(s->lamp, s->count, sizeof *s->lamp, by_light);
  if (s->count > most) s->count = most;
  return ABBE_OK;
}

static bool is_kept(const search *s, size_t number) {
  for (size_t i = 0; i < s->count; i++)
    if (s->lamp[i].number == number) return true;
  return false;
}

abbe_result abbe_environment_lights_leave(const abbe_environment *environment, size_t count,
                                          abbe_radiance_map *out, abbe_error *error) {
  const abbe_radiance_map *map = &environment->map;
  search s;
  *out = (abbe_radiance_map){0};
  ABBE_TRY(look_for_lamps(environment, count, &s, error));
  abbe_result result = abbe_radiance_map_make(map->width, out, error);
  for (size_t i = 0; result == ABBE_OK && i < map->width * map->height; i++) {
    const size_t x = i % map->width, y = i / map->width;
    const cut *c = &s.cuts[y * ROWS / map->height * COLUMNS + x * COLUMNS / map->width];
    const double bright = luminance_of(map->rgb + 3 * i);
    const double share = bright > c->above && is_kept(&s, c->lamp) ? c->above / bright : 1;
    for (size_t k = 0; k < 3; k++) out->rgb[3 * i + k] = (float)share * map->rgb[3 * i + k];
  }
  drop_search(&s);
  return result;
}

/* The lights and what they leave, into the copy. */
static abbe_result add_all(search *s, const abbe_environment_lights_desc *d, abbe_scene *out,
                           abbe_error *error) {
  const abbe_environment *e = s->environment;
  abbe_upsampling up;
  abbe_result result =
      abbe_upsampling_make_by(d->observer, &e->illuminant, d->min_nm, d->max_nm, &up, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < s->count && result == ABBE_OK; i++) {
    result = set_light(e, &up, &s->lamp[i], i + 1, &out->light[out->light_count], error);
    out->environment_lights++;
    out->light_count++;
  }
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result != ABBE_OK) return result;
  memset(s->place, 1, BINS);
  fill(s, 0);
  find_soft(s, out->soft_light);
  return ABBE_OK;
}

static abbe_result find_all(const abbe_environment *environment,
                            const abbe_environment_lights_desc *desc, size_t count, abbe_scene *out,
                            abbe_error *error) {
  search s;
  ABBE_TRY(look_for_lamps(environment, count, &s, error));
  abbe_result result = abbe_watch_check(error);
  if (result == ABBE_OK) result = add_all(&s, desc, out, error);
  drop_search(&s);
  return result;
}

static uint64_t digest_of(const abbe_environment *e, const abbe_environment_lights_desc *desc,
                          size_t count) {
  const abbe_spectrum *spectrum = e->illuminant.spectrum;
  const double range[2] = {desc->min_nm, desc->max_nm};
  const int kinds[2] = {(int)desc->observer, (int)e->illuminant.kind};
  uint64_t h = abbe_digest(e->map_digest, &count, sizeof count);
  h = abbe_digest(h, range, sizeof range);
  h = abbe_digest(h, kinds, sizeof kinds);
  h = abbe_digest(h, e->to_map, sizeof e->to_map);
  if (spectrum != NULL) {
    const size_t n = abbe_spectrum_count(spectrum);
    const int interpolation = (int)abbe_spectrum_interpolation(spectrum);
    h = abbe_digest(h, &interpolation, sizeof interpolation);
    h = abbe_digest_array(h, abbe_spectrum_lambda_nm(spectrum), n, sizeof(double));
    h = abbe_digest_array(h, abbe_spectrum_value(spectrum), n, sizeof(double));
  }
  return h != 0 ? h : 1;
}

static abbe_result copy_light(const abbe_light *from, abbe_light *out, abbe_error *error) {
  const abbe_spectrum *spectrum = from->illuminant.spectrum;
  *out = *from;
  out->illuminant.spectrum = NULL;
  out->name = strdup(from->name);
  if (out->name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light");
  return spectrum == NULL
             ? ABBE_OK
             : abbe_spectrum_make(abbe_spectrum_lambda_nm(spectrum), abbe_spectrum_value(spectrum),
                                  abbe_spectrum_count(spectrum),
                                  abbe_spectrum_interpolation(spectrum), &out->illuminant.spectrum,
                                  error);
}

/* As they were found for an earlier copy. */
static abbe_result take_all(const abbe_scene *before, abbe_scene *out, abbe_error *error) {
  const size_t count = before->environment_lights;
  abbe_result result = ABBE_OK;
  *out->soft_light = *before->soft_light;
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    result = copy_light(&before->light[before->light_count - count + i],
                        &out->light[out->light_count++], error);
    out->environment_lights++;
  }
  return result;
}

abbe_result abbe_environment_lights_add(const abbe_scene *scene,
                                        const abbe_environment_lights_desc *desc,
                                        const abbe_scene *before, abbe_scene *out,
                                        abbe_error *error) {
  size_t count = desc->count;
  const size_t own = scene->light_count, room = ABBE_SCENE_MAX_LIGHTS - own;
  *out = *scene;
  if (count > room) count = room;
  out->light = calloc(own + count + 1, sizeof *out->light);
  if (out->light == NULL) {
    *out = (abbe_scene){0};
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment's lights");
  }
  if (own > 0) memcpy(out->light, scene->light, own * sizeof *out->light);
  if (scene->environment == NULL) return ABBE_OK;
  out->surrounded_by = digest_of(scene->environment, desc, count);
  out->soft_light = malloc(sizeof *out->soft_light);
  abbe_result result =
      out->soft_light != NULL
          ? ABBE_OK
          : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment's lights");
  if (result == ABBE_OK)
    result = before != NULL && before->surrounded_by == out->surrounded_by
                 ? take_all(before, out, error)
                 : find_all(scene->environment, desc, count, out, error);
  if (result != ABBE_OK) abbe_environment_lights_drop(out);
  return result;
}

void abbe_environment_lights_drop(abbe_scene *copy) {
  if (copy == NULL) return;
  for (size_t i = 0; i < copy->environment_lights; i++) {
    abbe_light *light = &copy->light[copy->light_count - 1 - i];
    free(light->name);
    abbe_illuminant_free(&light->illuminant);
  }
  free(copy->light);
  free(copy->soft_light);
  *copy = (abbe_scene){0};
}
