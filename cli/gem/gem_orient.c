/* Which way a crystal's rough is best turned in its cut. */
#include "cli/gem/gem.h"

#include "base/maths.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct ways {
  const abbe_gem_stone_input *in;
  const char *measure;
  size_t tilts, azimuths, best, worst;
  abbe_gem_orientation *way; /* [tilts][azimuths] */
} ways;

/* Crystals of three indices are alike in all eight octants; the azimuths of two go all around. */
static void place(const ways *w, size_t i, abbe_gem_orientation *out) {
  const bool three = abbe_media_is_biaxial(&w->in->stone.media, 0);
  const size_t t = i / w->azimuths, a = i % w->azimuths;
  const size_t parts = three ? w->azimuths - 1 : w->azimuths;
  *out = (abbe_gem_orientation){0};
  if (w->tilts > 1) out->tilt_rad = ABBE_PI / 2 * (double)t / (double)(w->tilts - 1);
  if (parts > 0) out->azimuth_rad = (three ? ABBE_PI / 2 : 2 * ABBE_PI) * (double)a / (double)parts;
}

static double degrees(double rad) {
  return rad * 180 / ABBE_PI;
}

/* Without what rounding leaves of 0. */
static double tidy(double x) {
  return fabs(x) < 1e-12 ? 0 : x;
}

/* As --axis takes it. */
static void say_axes(const ways *w, const abbe_gem_orientation *o, char text[160]) {
  abbe_gem_axes axes = abbe_gem_orientation_axes(&w->in->stone, o->tilt_rad, o->azimuth_rad);
  for (int k = 0; k < 3; k++) {
    axes.z[k] = tidy(axes.z[k]);
    axes.x[k] = tidy(axes.x[k]);
  }
  int used = snprintf(text, 160, "%.4g,%.4g,%.4g", axes.z[0], axes.z[1], axes.z[2]);
  if (abbe_media_is_biaxial(&w->in->stone.media, 0))
    snprintf(text + used, 160 - (size_t)used, ",%.4g,%.4g,%.4g", axes.x[0], axes.x[1], axes.x[2]);
}

static void print_way(const ways *w, const char *name, const abbe_gem_orientation *o) {
  char axes[160];
  say_axes(w, o, axes);
  printf("%-6s %6.1f %8.1f %8.2f %% %6.2f %6.1f %6.1f %6.1f  --axis %s\n", name,
         degrees(o->tilt_rad), degrees(o->azimuth_rad), 100 * o->value.value, 100 * o->value.error,
         o->lab[0], o->lab[1], o->lab[2], axes);
}

static void print(const ways *w) {
  const bool three = abbe_media_is_biaxial(&w->in->stone.media, 0);
  printf("%s in %s: %s, %%, by how the crystal lies\n%s\n\n%-10s", w->in->in.path,
         w->in->in.material->name, w->measure,
         three
             ? "tilt and azimuth: what looks up through the table, from the crystal's z, and from "
               "its x to its y"
             : "tilt and azimuth: the optic axis, from the cut's z, and from its x",
         "tilt");
  for (size_t a = 0; a < w->azimuths; a++) printf(" %7.1f", degrees(w->way[a].azimuth_rad));
  for (size_t t = 0; t < w->tilts; t++) {
    printf("\n%-10.1f", degrees(w->way[t * w->azimuths].tilt_rad));
    for (size_t a = 0; a < w->azimuths; a++)
      printf(" %7.2f", 100 * w->way[t * w->azimuths + a].value.value);
  }
  printf("\n\n%-6s %6s %8s %10s %6s %6s %6s %6s\n", "", "tilt", "azimuth", "value", "error", "L*",
         "a*", "b*");
  print_way(w, "best", &w->way[w->best]);
  print_way(w, "worst", &w->way[w->worst]);
}

static cJSON *describe(const ways *w, size_t i) {
  const abbe_gem_orientation *o = &w->way[i];
  char axes[160];
  cJSON *one = cJSON_CreateObject();
  say_axes(w, o, axes);
  cJSON_AddNumberToObject(one, "tilt_deg", degrees(o->tilt_rad));
  cJSON_AddNumberToObject(one, "azimuth_deg", degrees(o->azimuth_rad));
  cJSON_AddStringToObject(one, "axis", axes);
  cJSON_AddNumberToObject(one, "value", o->value.value);
  cJSON_AddNumberToObject(one, "error", o->value.error);
  cJSON_AddItemToObject(one, "lab", cJSON_CreateDoubleArray(o->lab, 3));
  return one;
}

static abbe_result print_json(const ways *w, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  cJSON_AddStringToObject(root, "file", w->in->in.path);
  cJSON_AddStringToObject(root, "material", w->in->in.material->name);
  cJSON_AddStringToObject(root, "measure", w->measure);
  cJSON_AddItemToObject(root, "best", describe(w, w->best));
  cJSON_AddItemToObject(root, "worst", describe(w, w->worst));
  cJSON *list = cJSON_AddArrayToObject(root, "ways");
  for (size_t i = 0; i < w->tilts * w->azimuths; i++) cJSON_AddItemToArray(list, describe(w, i));
  return abbe_command_print_json(root, true, error);
}

abbe_result abbe_gem_optimise_axis(const abbe_gem_stone_input *input, const char *measure,
                                   const abbe_gem_optimum_desc *desc, size_t tilts, size_t azimuths,
                                   abbe_error *error) {
  const size_t all = tilts * azimuths;
  ways w = {.in = input, .measure = measure, .tilts = tilts, .azimuths = azimuths};
  abbe_progress progress;
  abbe_result result = ABBE_OK;
  w.way = calloc(all, sizeof *w.way);
  if (w.way == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu ways", all);
  abbe_progress_begin(&progress, "searching", input->in.quiet);
  for (size_t i = 0; i < all && result == ABBE_OK; i++) {
    place(&w, i, &w.way[i]);
    result = abbe_gem_orientation_judge(&input->stone, &input->weights, &desc->view, desc->measure,
                                        &w.way[i], error);
    const double gain = w.way[i].value.value - w.way[w.best].value.value,
                 loss = w.way[i].value.value - w.way[w.worst].value.value;
    if (desc->least ? gain < 0 : gain > 0) w.best = i;
    if (desc->least ? loss > 0 : loss < 0) w.worst = i;
    if (result == ABBE_OK && !abbe_progress_update(&progress, (double)(i + 1) / (double)all))
      result = abbe_error_set(error, ABBE_CANCELLED, "the search was given up");
  }
  abbe_progress_end(&progress);
  if (result == ABBE_OK && input->in.json) result = print_json(&w, error);
  if (result == ABBE_OK && !input->in.json) print(&w);
  free(w.way);
  return result;
}
