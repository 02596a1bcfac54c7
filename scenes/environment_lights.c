#include "scenes/environment_lights.h"

#include "colorimetry/upsampling.h"
#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ROWS = 64, VALUES = 7 }; /* luminance, luminance x direction, RGB */

static const double PI = 3.14159265358979323846;
static const double luminance[3] = {0.2126390058715104, 0.7151686787677559, 0.0721923153607337};

/* Sums over all texels above and left of a corner. */
typedef struct sums {
  size_t width, height;
  double (*at)[VALUES]; /* [height + 1][width + 1] */
} sums;

typedef struct part {
  size_t x0, x1, y0, y1;
  double value[VALUES];
} part;

/* A level of few texels, so that all cuts can be tried. */
static const abbe_radiance_map *coarse_map(const abbe_environment *e) {
  const abbe_radiance_map *map = &e->map;
  for (size_t i = 0; i < e->level_count && map->height > MOST_ROWS; i++) map = &e->level[i];
  return map;
}

/* Of a texel of that row: its share of all integrals, or of a level what it covers. */
static double solid_angle(const abbe_radiance_map *map, bool is_level, size_t row) {
  if (!is_level) return abbe_radiance_map_solid_angle(map, row);
  const double step = PI / (double)map->height;
  return 2 * PI / (double)map->width * (cos(step * (double)row) - cos(step * ((double)row + 1)));
}

static bool make_sums(const abbe_environment *e, sums *s) {
  const abbe_radiance_map *map = coarse_map(e);
  s->width = map->width;
  s->height = map->height;
  s->at = calloc((s->width + 1) * (s->height + 1), sizeof *s->at);
  if (s->at == NULL) return false;
  for (size_t y = 0; y < s->height; y++) {
    const double solid = solid_angle(map, map != &e->map, y);
    double row[VALUES] = {0};
    for (size_t x = 0; x < s->width; x++) {
      const float *texel = map->rgb + 3 * (y * s->width + x);
      double d[3], y_of = 0;
      abbe_radiance_map_direction(map, (double)x + 0.5, (double)y + 0.5, d);
      for (int k = 0; k < 3; k++) y_of += luminance[k] * (double)texel[k];
      row[0] += solid * y_of;
      for (int k = 0; k < 3; k++) row[1 + k] += solid * y_of * d[k];
      for (int k = 0; k < 3; k++) row[4 + k] += solid * (double)texel[k];
      for (int k = 0; k < VALUES; k++)
        s->at[(y + 1) * (s->width + 1) + x + 1][k] = s->at[y * (s->width + 1) + x + 1][k] + row[k];
    }
  }
  return true;
}

static part sum_part(const sums *s, size_t x0, size_t x1, size_t y0, size_t y1) {
  part p = {x0, x1, y0, y1, {0}};
  const size_t w = s->width + 1;
  for (int k = 0; k < VALUES; k++)
    p.value[k] = s->at[y1 * w + x1][k] - s->at[y0 * w + x1][k] - s->at[y1 * w + x0][k] +
                 s->at[y0 * w + x0][k];
  return p;
}

/* What one light along the mean direction leaves out. */
static double lost(const part *p) {
  return p->value[0] - abbe_vector_length(p->value + 1);
}

/* The cut that leaves least out; false for a single texel. */
static bool cut(const sums *s, const part *p, part out[2]) {
  double least = INFINITY;
  for (int across = 0; across < 2; across++) {
    const size_t from = across ? p->x0 : p->y0, to = across ? p->x1 : p->y1;
    for (size_t at = from + 1; at < to; at++) {
      const part a =
          across ? sum_part(s, p->x0, at, p->y0, p->y1) : sum_part(s, p->x0, p->x1, p->y0, at);
      const part b =
          across ? sum_part(s, at, p->x1, p->y0, p->y1) : sum_part(s, p->x0, p->x1, at, p->y1);
      if (!(lost(&a) + lost(&b) < least)) continue;
      least = lost(&a) + lost(&b);
      out[0] = a;
      out[1] = b;
    }
  }
  return least < INFINITY;
}

static int by_light(const void *a, const void *b) {
  const double x = abbe_vector_length(((const part *)a)->value + 1);
  const double y = abbe_vector_length(((const part *)b)->value + 1);
  return (x < y) - (x > y);
}

/* At most count parts, brightest first; those without light are left out. */
static size_t cut_all(const sums *s, size_t count, part *parts) {
  size_t made = 1;
  parts[0] = sum_part(s, 0, s->width, 0, s->height);
  while (made < count) {
    size_t worst = 0;
    for (size_t i = 1; i < made; i++)
      if (lost(&parts[i]) > lost(&parts[worst])) worst = i;
    part two[2];
    if (!(lost(&parts[worst]) > 0) || !cut(s, &parts[worst], two)) break;
    parts[worst] = two[0];
    parts[made++] = two[1];
  }
  qsort(parts, made, sizeof *parts, by_light);
  while (made > 0 && !(abbe_vector_length(parts[made - 1].value + 1) > 1e-9 * parts[0].value[0]))
    made--;
  return made;
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

static abbe_result set_light(const abbe_environment *e, const abbe_upsampling *up, const part *p,
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
  out->power = sum;
  for (int k = 0; k < 3; k++) rgb[k] /= y;
  char name[40];
  snprintf(name, sizeof name, "environment %zu", number);
  out->name = strdup(name);
  if (out->name == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light");
  return set_spectrum(e, up, rgb, &out->illuminant, error);
}

abbe_result abbe_environment_lights_add(const abbe_scene *scene, size_t count, double min_nm,
                                        double max_nm, abbe_scene *out, abbe_error *error) {
  ABBE_REQUIRE(scene && out, error);
  const abbe_environment *e = scene->environment;
  const size_t own = scene->light_count, room = ABBE_SCENE_MAX_LIGHTS - own;
  *out = *scene;
  out->light = calloc(own + count + 1, sizeof *out->light);
  part *parts = calloc(count + 1, sizeof *parts);
  sums s = {0};
  abbe_upsampling up;
  abbe_result result = ABBE_OK;
  if (count > room) count = room;
  if (out->light == NULL || parts == NULL || (e != NULL && !make_sums(e, &s)))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment's lights");
  if (result == ABBE_OK && e != NULL)
    result = abbe_upsampling_make(&e->illuminant, min_nm, max_nm, &up, error);
  if (out->light != NULL && own > 0) memcpy(out->light, scene->light, own * sizeof *out->light);
  if (result == ABBE_OK && e != NULL && count > 0) {
    const size_t made = cut_all(&s, count, parts);
    for (size_t i = 0; i < made && result == ABBE_OK; i++) {
      out->environment_lights++;
      out->light_count++;
      result = set_light(e, &up, &parts[i], i + 1, &out->light[own + i], error);
    }
  }
  free(parts);
  free(s.at);
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
  *copy = (abbe_scene){0};
}
