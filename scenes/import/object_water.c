/* Water at the scene's time, as an object of a scene file asks for it. */
#include "scenes/import/scene_reading.h"
#include "scenes/import/scene_value.h"
#include "scenes/shapes/water.h"

#include <stdlib.h>

static abbe_result need_length(abbe_yaml *yaml, abbe_yaml_node node, const char *key, double *out,
                               abbe_error *error) {
  abbe_yaml_node ignored;
  const abbe_result result = abbe_yaml_require(yaml, node, key, &ignored, error);
  return result == ABBE_OK
             ? abbe_yaml_get_length(yaml, node, key, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out, error)
             : result;
}

/* The list under key, of at most `most` mappings, with room for them in *room, zeroed. */
static abbe_result list_of(const abbe_object_reading *r, const char *key, size_t most, size_t size,
                           void **room, size_t *count, abbe_yaml_node *list, abbe_error *error) {
  *list = abbe_yaml_get(r->yaml, r->node, key);
  *count = abbe_yaml_count(r->yaml, *list);
  *room = NULL;
  if (list->id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(r->yaml, *list) || *count > most)
    return abbe_yaml_fail(r->yaml, *list, error, "'%s' wants a list of up to %zu", key, most);
  for (size_t i = 0; i < *count; i++)
    if (!abbe_yaml_is_mapping(r->yaml, abbe_yaml_item(r->yaml, *list, i)))
      return abbe_yaml_fail(r->yaml, abbe_yaml_item(r->yaml, *list, i), error,
                            "an entry of '%s' must be a mapping (key: value)", key);
  *room = calloc(*count + 1, size);
  return *room != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for '%s'", key);
}

static abbe_result read_wave(abbe_yaml *yaml, abbe_yaml_node node, abbe_water_wave *out,
                             abbe_error *error) {
  double direction = 0, phase = 0;
  abbe_result result = need_length(yaml, node, "amplitude", &out->amplitude, error);
  if (result == ABBE_OK) result = need_length(yaml, node, "wavelength", &out->wavelength, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(yaml, node, "direction", -3600, 3600, &direction, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(yaml, node, "phase", -3600, 3600, &phase, error);
  out->direction_rad = direction * ABBE_OBJECT_RADIANS;
  out->phase_rad = phase * ABBE_OBJECT_RADIANS;
  return result == ABBE_OK ? abbe_yaml_check_keys(yaml, node, "a wave", error) : result;
}

static abbe_result read_drop(abbe_yaml *yaml, abbe_yaml_node node, abbe_water_drop *out,
                             abbe_error *error) {
  abbe_yaml_node ignored;
  abbe_result result = abbe_yaml_require(yaml, node, "at", &ignored, error);
  if (result == ABBE_OK)
    result =
        abbe_yaml_get_lengths(yaml, node, "at", 2, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out->at, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(yaml, node, "time", -ABBE_SCENE_FAR, ABBE_SCENE_FAR, &out->time,
                                  error);
  if (result == ABBE_OK) result = need_length(yaml, node, "depth", &out->depth, error);
  if (result == ABBE_OK) result = need_length(yaml, node, "radius", &out->radius, error);
  return result == ABBE_OK ? abbe_yaml_check_keys(yaml, node, "a drop", error) : result;
}

static abbe_result read_rain(const abbe_object_reading *r, abbe_water_rain *out,
                             abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "rain");
  size_t seed = 0;
  if (node.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_mapping(r->yaml, node))
    return abbe_yaml_fail(r->yaml, node, error, "'rain' must be a mapping (key: value)");
  abbe_yaml_node ignored;
  abbe_result result = abbe_yaml_require(r->yaml, node, "every", &ignored, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_number(r->yaml, node, "every", -ABBE_SCENE_FAR, ABBE_SCENE_FAR,
                                  &out->every, error);
  if (result == ABBE_OK && !(out->every > 0))
    result = abbe_yaml_fail(r->yaml, abbe_yaml_get(r->yaml, node, "every"), error,
                            "'every' is the time between two drops, in seconds, above 0");
  if (result == ABBE_OK) result = need_length(r->yaml, node, "depth", &out->depth, error);
  if (result == ABBE_OK) result = need_length(r->yaml, node, "radius", &out->radius, error);
  if (result == ABBE_OK)
    result = abbe_yaml_get_count(r->yaml, node, "seed", 0, UINT32_MAX, &seed, error);
  out->seed = (uint32_t)seed;
  return result == ABBE_OK ? abbe_yaml_check_keys(r->yaml, node, "'rain'", error) : result;
}

/* One number for both sides, or two. */
static abbe_result read_cells(const abbe_object_reading *r, size_t cells[2], abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "cells");
  double number[2] = {0, 0};
  abbe_result result = abbe_yaml_is_sequence(r->yaml, node)
                           ? abbe_yaml_get_numbers(r->yaml, r->node, "cells", 2, 1,
                                                   ABBE_WATER_MOST_CELLS, number, error)
                           : abbe_yaml_get_number(r->yaml, r->node, "cells", 1,
                                                  ABBE_WATER_MOST_CELLS, number, error);
  if (result != ABBE_OK || node.id == 0) return result;
  if (!abbe_yaml_is_sequence(r->yaml, node)) number[1] = number[0];
  for (int k = 0; k < 2; k++) {
    cells[k] = (size_t)number[k];
    if ((double)cells[k] != number[k])
      return abbe_yaml_fail(r->yaml, node, error, "'cells' wants whole numbers");
  }
  return ABBE_OK;
}

abbe_result abbe_object_read_water(const abbe_object_reading *r, abbe_mesh *out,
                                   abbe_error *error) {
  abbe_water water = {0};
  abbe_yaml_node list;
  void *waves = NULL, *drops = NULL;
  abbe_result result = abbe_scene_value_point(r->yaml, r->node, "size", water.size, error);
  if (result == ABBE_OK) result = abbe_scene_value_time(r->yaml, &water.time, error);
  if (result == ABBE_OK) result = read_cells(r, water.cells, error);
  if (result == ABBE_OK)
    result = list_of(r, "waves", ABBE_WATER_MOST_WAVES, sizeof *water.wave, &waves,
                     &water.wave_count, &list, error);
  for (size_t i = 0; i < water.wave_count && result == ABBE_OK; i++)
    result =
        read_wave(r->yaml, abbe_yaml_item(r->yaml, list, i), (abbe_water_wave *)waves + i, error);
  if (result == ABBE_OK)
    result = list_of(r, "drops", 4096, sizeof *water.drop, &drops, &water.drop_count, &list, error);
  for (size_t i = 0; i < water.drop_count && result == ABBE_OK; i++)
    result =
        read_drop(r->yaml, abbe_yaml_item(r->yaml, list, i), (abbe_water_drop *)drops + i, error);
  if (result == ABBE_OK) result = read_rain(r, &water.rain, error);
  water.wave = waves;
  water.drop = drops;
  if (result == ABBE_OK) result = abbe_water_make(&water, out, error);
  free(waves);
  free(drops);
  return result;
}
