#include "cli/options/scene_input.h"

#include "base/number.h"
#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/base/shipped.h"
#include "scenes/import/scene_file.h"
#include "scenes/refractor_tilt.h"

#include <cjson/cJSON.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double RAD = 3.14159265358979323846 / 180;

static void take_tilt(abbe_scene_input_changes *changes, const char *text, const char *program) {
  char tilt[64];
  const size_t length = strcspn(text, ",");
  snprintf(tilt, sizeof tilt, "%.*s", (int)length, text);
  changes->tilt_deg = abbe_command_number(program, "--tilt", tilt, -180, 180);
  changes->axis_deg = text[length] == ','
                          ? abbe_command_number(program, "--tilt", text + length + 1, -360, 360)
                          : 0;
}

error_t abbe_scene_input_take(abbe_scene_input_changes *changes, int key, const char *text,
                              const char *program) {
  if (key == ABBE_SCENE_INPUT_MATERIAL)
    changes->stone = text;
  else if (key == ABBE_SCENE_INPUT_TILT)
    take_tilt(changes, text, program);
  else if (key == ABBE_SCENE_INPUT_AT) {
    changes->timed = true;
    changes->time = abbe_command_number(program, "--at", text, -1e6, 1e6);
  } else if (key != ABBE_SCENE_INPUT_SET)
    return ARGP_ERR_UNKNOWN;
  else if (changes->set_count < ABBE_SCENE_INPUT_MOST)
    changes->set[changes->set_count++] = text;
  else {
    fprintf(stderr, "%s: no more than %d --set; write the values into the scene\n", program,
            ABBE_SCENE_INPUT_MOST);
    exit(ABBE_EXIT_USAGE);
  }
  return 0;
}

abbe_result abbe_scene_input_load(const char *program, const char *path, const char *materials,
                                  abbe_scene *out, abbe_error *error) {
  const abbe_scene_input_changes none = {0};
  return abbe_scene_input_load_with(program, path, materials, &none, out, error);
}

/* With the changes in it. */
static abbe_result load(const char *path, const char *materials,
                        const abbe_scene_input_changes *changes, abbe_scene *out,
                        abbe_error *error) {
  const char *set[ABBE_SCENE_INPUT_MOST + 1];
  char time[64];
  memcpy(set, changes->set, sizeof changes->set);
  set[changes->set_count] = time;
  abbe_number_format(time, sizeof time, "time=%.17g", changes->time);
  const abbe_scene_options options = {.materials = materials,
                                      .stone = changes->stone,
                                      .set = set,
                                      .set_count = changes->set_count + changes->timed};
  const abbe_result result = abbe_scene_load(path, &options, out, error);
  if (result != ABBE_OK || changes->tilt_deg == 0) return result;
  return abbe_refractors_tilt(out, changes->tilt_deg * RAD, changes->axis_deg * RAD, error);
}

abbe_result abbe_scene_input_load_with(const char *program, const char *path, const char *materials,
                                       const abbe_scene_input_changes *changes, abbe_scene *out,
                                       abbe_error *error) {
  char shipped[2 * PATH_MAX];
  const char *found = abbe_shipped_find(path, shipped, sizeof shipped);
  if (found != path) fprintf(stderr, "note: %s is not here; %s is taken\n", path, found);
  const abbe_result result = load(found, materials, changes, out, error);
  for (size_t i = 0; result == ABBE_OK && i < abbe_scene_file_count(out); i++)
    abbe_arguments_add(program, ABBE_ARGUMENT_READS, "the scene's file", abbe_scene_file(out, i));
  return result;
}

abbe_result abbe_scene_input_at(const abbe_scene *scene, const char *materials,
                                const abbe_scene_input_changes *changes, double time,
                                abbe_scene *out, abbe_error *error) {
  abbe_scene_input_changes timed = *changes;
  timed.timed = true;
  timed.time = time;
  return load(scene->path, materials, &timed, out, error);
}

void abbe_scene_input_note(const abbe_scene *scene) {
  const abbe_environment *around = scene->environment;
  if (around != NULL && around->map.space_assumed) abbe_command_note_space(around->path);
  for (size_t i = 0; i < scene->object_count; i++)
    if (scene->object[i].fixes != NULL)
      fprintf(stderr, "note: object '%s': %s\n", scene->object[i].name, scene->object[i].fixes);
}

static const char *roughened(const abbe_brushing *b, char *text, size_t size) {
  const size_t used = strlen(text);
  const abbe_microfacets *m = &b->facets;
  if (m->x < m->y || m->y < m->x)
    snprintf(text + used, size - used, ", brushed, %g along and %g across", m->x, m->y);
  else
    snprintf(text + used, size - used, ", rough, %g", m->x);
  return text;
}

static const char *made_of(const abbe_object *o, char *text, size_t size) {
  switch (abbe_object_kind_of(o)) {
  case ABBE_OBJECT_REFRACTOR:
    return o->material->name;
  case ABBE_OBJECT_MIRROR:
    if (o->conductor != NULL)
      snprintf(text, size, "mirror of %s", o->conductor->name);
    else
      snprintf(text, size, "mirror, %g", o->mirror_reflectance);
    return abbe_brushing_is_rough(&o->brushing) ? roughened(&o->brushing, text, size) : text;
  default:
    return "receiver";
  }
}

void abbe_scene_input_list(const abbe_scene *scene) {
  enum { MOST = 48 };
  printf("What is there, with its size and the middle of its bounds, m:\n");
  for (size_t i = 0; i < scene->object_count && i < MOST; i++) {
    const abbe_object *o = &scene->object[i];
    char size[64], middle[64], made[ABBE_MATERIAL_MAX_NAME + 80];
    snprintf(size, sizeof size, "%.3g x %.3g x %.3g", o->max[0] - o->min[0], o->max[1] - o->min[1],
             o->max[2] - o->min[2]);
    snprintf(middle, sizeof middle, "(%.3g, %.3g, %.3g)", 0.5 * (o->min[0] + o->max[0]),
             0.5 * (o->min[1] + o->max[1]), 0.5 * (o->min[2] + o->max[2]));
    printf("  %-26.60s %-26s %-26s %s, %zu faces\n", o->name, size, middle,
           made_of(o, made, sizeof made), o->mesh.face_count);
  }
  if (scene->object_count > MOST) printf("  and %zu objects more\n", scene->object_count - MOST);
  printf("\n");
}

void abbe_scene_input_list_json(const abbe_scene *scene, cJSON *root) {
  cJSON *list = cJSON_AddArrayToObject(root, "objects");
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    cJSON *item = cJSON_CreateObject();
    cJSON_AddStringToObject(item, "name", o->name);
    if (o->material != NULL) cJSON_AddStringToObject(item, "material", o->material->name);
    if (o->conductor != NULL)
      cJSON_AddStringToObject(item, "mirror", o->conductor->name);
    else if (o->mirror)
      cJSON_AddNumberToObject(item, "mirror", o->mirror_reflectance);
    if (abbe_brushing_is_rough(&o->brushing)) {
      const double both[] = {o->brushing.facets.x, o->brushing.facets.y};
      cJSON_AddItemToObject(item, "roughness", cJSON_CreateDoubleArray(both, 2));
    }
    cJSON_AddItemToObject(item, "min", cJSON_CreateDoubleArray(o->min, 3));
    cJSON_AddItemToObject(item, "max", cJSON_CreateDoubleArray(o->max, 3));
    cJSON_AddNumberToObject(item, "faces", (double)o->mesh.face_count);
    if (o->fixes != NULL) cJSON_AddStringToObject(item, "note", o->fixes);
    cJSON_AddItemToArray(list, item);
  }
}
