/* What a stone of a scene returns of light, and its derivatives. */
#include "cli/derive/derive.h"

#include "base/maths.h"
#include "base/text.h"
#include "cli/base/command.h"
#include "cli/base/progress.h"
#include "validation/measure/gem/gem_derive.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROWS = 1 + ABBE_DERIVE_MOST_KEYS, MEASURES = ABBE_GEM_DERIVE_MEASURE_COUNT, WAVES = 16 };

typedef struct work {
  size_t object;
  abbe_wavelengths wavelengths;
  abbe_weights weights;
  abbe_gem_derive_stone base;
  abbe_gem_derive_key key[ABBE_DERIVE_MOST_KEYS];
  abbe_gem_number number[MEASURES * ROWS]; /* [measures][1 + keys] */
  bool felt[ABBE_DERIVE_MOST_KEYS];
} work;

static abbe_result find_stone(const abbe_derive_request *q, const abbe_scene *scene, size_t *out,
                              abbe_error *error) {
  const char *names[ABBE_SCENE_MAX_OBJECTS] = {0};
  size_t count = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    if (strcmp(scene->object[i].name, q->stone) == 0) {
      *out = i;
      return ABBE_OK;
    }
    if (scene->object[i].material != NULL) names[count++] = scene->object[i].name;
  }
  const char *near = abbe_nearest_word(q->stone, names, count);
  if (near == NULL && count > 0) near = names[0];
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "--stone: %s has no object '%s'%s%s%s",
                        q->path, q->stone, near ? "; did you mean '" : "", near ? near : "",
                        near ? "'?" : "");
}

static abbe_result make_key(const abbe_pixels_key *key, const abbe_scene *scene, const work *w,
                            abbe_gem_derive_key *out, abbe_error *error) {
  out->name = key->name;
  out->step = key->step;
  for (int s = 0; s < 2; s++) {
    if (key->moved[s]->object_count != scene->object_count)
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "--by %.120s changes how many objects there are", key->name);
    ABBE_TRY(abbe_gem_derive_stone_make(&key->moved[s]->object[w->object], &key->shift[s],
                                        &w->wavelengths, &out->moved[s], error));
  }
  return ABBE_OK;
}

static abbe_result measure(const abbe_derive_request *q, const abbe_scene *scene,
                           const abbe_pixels_key *key, work *w, abbe_error *error) {
  const abbe_illuminant d65 = {0};
  const double from = q->work.min_nm > 0 ? q->work.min_nm : ABBE_WAVELENGTH_MIN_NM;
  const double to = q->work.max_nm > 0 ? q->work.max_nm : ABBE_WAVELENGTH_MAX_NM;
  ABBE_TRY(find_stone(q, scene, &w->object, error));
  ABBE_TRY(abbe_wavelengths_make(WAVES, from, to, &w->wavelengths, error));
  ABBE_TRY(abbe_weights_make(&w->wavelengths, &d65, ABBE_RGB_SPACE_XYZ, &w->weights, error));
  ABBE_TRY(abbe_gem_derive_stone_make(&scene->object[w->object], NULL, &w->wavelengths, &w->base,
                                      error));
  for (size_t k = 0; k < q->keys; k++) ABBE_TRY(make_key(&key[k], scene, w, &w->key[k], error));
  abbe_progress progress;
  const abbe_gem_derive_desc desc = {.base = &w->base,
                                     .weights = &w->weights,
                                     .keys = q->keys,
                                     .key = w->key,
                                     .head_rad = ABBE_GEM_HEAD_DEG * ABBE_DEGREE,
                                     .lines = q->lines,
                                     .threads = q->work.threads,
                                     .progress = abbe_progress_update,
                                     .user = &progress};
  abbe_gem_derive_measure all[MEASURES];
  for (int m = 0; m < MEASURES; m++) all[m] = (abbe_gem_derive_measure)m;
  abbe_progress_begin(&progress, "deriving", q->quiet);
  const abbe_result result = abbe_gem_derive_make(&desc, all, MEASURES, w->number, w->felt, error);
  abbe_progress_end(&progress);
  return result;
}

static void print(const abbe_derive_request *q, const work *w) {
  printf("%-34s %-10s %13s %11s  %s\n", "by", "of", "value", "std error", "unit");
  for (size_t row = 0; row <= q->keys; row++)
    for (int m = 0; m < MEASURES; m++) {
      const char *by = m > 0 ? "" : row == 0 ? "(as it is)" : q->key[row - 1];
      const abbe_gem_number n = w->number[(size_t)m * (1 + q->keys) + row];
      printf("%-34s %-10s %13.5g %11.2g  %s%s\n", by,
             abbe_gem_derive_measure_name((abbe_gem_derive_measure)m), n.value, n.error,
             abbe_gem_derive_measure_unit((abbe_gem_derive_measure)m),
             row > 0 ? " by one of it" : "");
    }
}

static abbe_result print_json(const abbe_derive_request *q, const work *w, abbe_error *error) {
  cJSON *root = cJSON_CreateObject(), *list = cJSON_AddArrayToObject(root, "rows");
  cJSON_AddStringToObject(root, "scene", q->path);
  cJSON_AddStringToObject(root, "stone", q->stone);
  for (size_t row = 0; row <= q->keys; row++) {
    cJSON *one = cJSON_CreateObject();
    cJSON_AddItemToArray(list, one);
    if (row > 0) cJSON_AddStringToObject(one, "by", q->key[row - 1]);
    for (int m = 0; m < MEASURES; m++) {
      const double e[2] = {w->number[(size_t)m * (1 + q->keys) + row].value,
                           w->number[(size_t)m * (1 + q->keys) + row].error};
      cJSON_AddItemToObject(one, abbe_gem_derive_measure_name((abbe_gem_derive_measure)m),
                            cJSON_CreateDoubleArray(e, 2));
    }
  }
  return abbe_command_print_json(root, true, error);
}

abbe_result abbe_derive_stone(const abbe_derive_request *q, const abbe_scene *scene,
                              const abbe_pixels_key *key, abbe_error *error) {
  ABBE_FREED work *w = calloc(1, sizeof *w);
  if (w == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the keys");
  abbe_result result = measure(q, scene, key, w, error);
  for (size_t k = 0; k < q->keys && result == ABBE_OK; k++)
    if (!w->felt[k] && !q->quiet)
      fprintf(stderr, "note: the stone does not change with '%s': its derivatives are 0\n",
              q->key[k]);
  if (result == ABBE_OK && q->json) result = print_json(q, w, error);
  if (result == ABBE_OK && !q->json) print(q, w);
  for (size_t k = 0; k < q->keys; k++)
    for (int s = 0; s < 2; s++) abbe_gem_derive_stone_free(&w->key[k].moved[s]);
  abbe_gem_derive_stone_free(&w->base);
  abbe_weights_free(&w->weights);
  abbe_wavelengths_free(&w->wavelengths);
  return result;
}
