#include "scenes/import/scene_file.h"

#include "base/file.h"
#include "base/thread/watch.h"
#include "base/yaml/yaml.h"
#include "scenes/import/scene_reading.h"
#include "scenes/import/scene_value.h"
#include "scenes/medium/medium.h"
#include "spectral/formats/material_import.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCENE_MOST_BYTES ((size_t)16 << 20) /* as of every YAML file */

/* --- objects --- */

static abbe_result read_objects(abbe_yaml *yaml, abbe_yaml_node root, const char *folder,
                                abbe_scene *out, abbe_error *error) {
  abbe_yaml_node list;
  size_t count, faces = 0;
  abbe_result result =
      abbe_scene_value_list(yaml, root, "objects", ABBE_SCENE_MAX_OBJECTS, &list, &count, error);
  if (result != ABBE_OK || count == 0) return result;
  out->object = calloc(ABBE_SCENE_MAX_OBJECTS, sizeof *out->object);
  if (!out->object)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu objects", count);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    const abbe_yaml_node item = abbe_yaml_item(yaml, list, i);
    /* one for each entry that is to come stays free */
    const size_t first = out->object_count, room = ABBE_SCENE_MAX_OBJECTS - first - (count - 1 - i);
    size_t made = 0;
    result = abbe_watch_check(error);
    if (result != ABBE_OK) break;
    result =
        abbe_object_read(yaml, item, folder, &out->table, &out->object[first], room, &made, error);
    out->object_count += made;
    for (size_t k = first; k < out->object_count; k++) faces += out->object[k].mesh.face_count;
    if (result == ABBE_OK && faces > ABBE_MESH_MAX_FACES)
      result = abbe_yaml_fail(yaml, item, error,
                              "with this object the scene has %zu faces; at most %u are possible",
                              faces, ABBE_MESH_MAX_FACES);
  }
  return result;
}

static abbe_result read_environment(abbe_yaml *yaml, abbe_yaml_node root, const char *folder,
                                    abbe_scene *out, abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(yaml, root, "environment");
  if (node.id == 0) return ABBE_OK;
  out->environment = calloc(1, sizeof *out->environment);
  if (!out->environment)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the surroundings");
  return abbe_environment_read(yaml, node, folder, out->environment, error);
}

/* --- the scene --- */

enum { NAMES = 4 * ABBE_SCENE_MAX_OBJECTS };

static void add_name(const char *name, const char *names[NAMES], size_t *count) {
  if (name && strcmp(name, ABBE_OBJECT_FROM_FILE) != 0 && *count < NAMES) names[(*count)++] = name;
}

/* The materials that the objects and their settings name, so that of a store of many no others are
 * read. */
static size_t names_in(abbe_yaml *yaml, abbe_yaml_node root, const char *names[NAMES]) {
  const abbe_yaml_node list = abbe_yaml_get(yaml, root, "objects");
  const size_t count = abbe_yaml_is_sequence(yaml, list) ? abbe_yaml_count(yaml, list) : 0;
  size_t found = 0;
  for (size_t i = 0; i < count; i++) {
    const abbe_yaml_node object = abbe_yaml_item(yaml, list, i);
    if (!abbe_yaml_is_mapping(yaml, object)) continue;
    add_name(abbe_yaml_text(yaml, abbe_yaml_get(yaml, object, "material")), names, &found);
    add_name(abbe_yaml_text(yaml, abbe_yaml_get(yaml, object, "mirror")), names, &found);
    const abbe_yaml_node setting = abbe_yaml_get(yaml, object, "setting");
    const bool several = abbe_yaml_is_sequence(yaml, setting);
    for (size_t k = 0; k < (several ? abbe_yaml_count(yaml, setting) : setting.id != 0); k++) {
      const abbe_yaml_node one = several ? abbe_yaml_item(yaml, setting, k) : setting;
      if (abbe_yaml_is_mapping(yaml, one))
        add_name(abbe_yaml_text(yaml, abbe_yaml_get(yaml, one, "metal")), names, &found);
    }
  }
  return found;
}

static abbe_result read_table(abbe_yaml *yaml, abbe_yaml_node root, const char *folder,
                              const abbe_scene_options *options, abbe_scene *out,
                              abbe_error *error) {
  char *name = NULL, *path = NULL;
  const char *names[NAMES];
  const size_t count = names_in(yaml, root, names);
  abbe_result result = abbe_yaml_get_string(yaml, root, "materials", &name, error);
  if (result != ABBE_OK) return result;
  const bool given = options && options->materials;
  const bool shipped = !name || strcmp(name, "default") == 0 || strcmp(name, "thesis") == 0;
  if (!given && !shipped) {
    path = abbe_scene_value_path(folder, name);
    if (!path) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  }
  if (result == ABBE_OK)
    result = abbe_material_table_load_named(given     ? options->materials
                                            : shipped ? name
                                                      : path,
                                            names, count, &out->table, error);
  free(path);
  free(name);
  return result;
}

static abbe_result read_brightness(abbe_yaml *yaml, abbe_yaml_node root, abbe_scene *out,
                                   abbe_error *error) {
  const double most = ABBE_SCENE_BRIGHTEST;
  ABBE_TRY(abbe_yaml_get_number(yaml, root, "ambient", 0, most, &out->ambient, error));
  return abbe_yaml_get_number(yaml, root, "background", 0, most, &out->background, error);
}

static abbe_result read_conditions(abbe_yaml *yaml, abbe_yaml_node root, abbe_conditions *out,
                                   abbe_error *error) {
  *out = (abbe_conditions){NAN, NAN};
  ABBE_TRY(abbe_yaml_get_number(yaml, root, "temperature", ABBE_CONDITIONS_LEAST_C,
                                ABBE_CONDITIONS_MOST_C, &out->temperature_c, error));
  return abbe_yaml_get_number(yaml, root, "pressure", 0, ABBE_CONDITIONS_MOST_ATM,
                              &out->pressure_atm, error);
}

/* The materials of refractors; a metal's n and k are known as they were measured alone. */
static abbe_result place_materials(abbe_yaml *yaml, abbe_yaml_node root, abbe_scene *scene,
                                   abbe_error *error) {
  abbe_error why;
  if (!abbe_conditions_given(&scene->conditions)) return ABBE_OK;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *o = &scene->object[i];
    if (o->material == NULL) continue;
    abbe_material *m = o->own_material != NULL
                           ? o->own_material
                           : &scene->table.material[o->material - scene->table.material];
    if (abbe_material_place(m, &scene->conditions, &why) != ABBE_OK)
      return abbe_yaml_fail(yaml, abbe_yaml_get(yaml, root, "temperature"), error,
                            "'temperature': %s", why.text);
  }
  return ABBE_OK;
}

static abbe_result read_scene(abbe_yaml *yaml, const char *folder,
                              const abbe_scene_options *options, abbe_scene *out,
                              abbe_error *error) {
  const abbe_yaml_node root = abbe_yaml_root(yaml);
  if (!abbe_yaml_is_mapping(yaml, root))
    return abbe_yaml_fail(yaml, root, error, "a scene must be a mapping (key: value)");
  ABBE_TRY(abbe_yaml_get_string(yaml, root, "description", &out->description, error));
  ABBE_TRY(read_brightness(yaml, root, out, error));
  ABBE_TRY(read_conditions(yaml, root, &out->conditions, error));
  ABBE_TRY(abbe_scene_value_time(yaml, &out->time, error));
  ABBE_TRY(abbe_camera_read(yaml, root, &out->camera, error));
  ABBE_TRY(abbe_medium_file_read(yaml, root, true, &out->medium, error));
  ABBE_TRY(abbe_lights_read(yaml, root, folder, &out->light, &out->light_count, error));
  /* all keys are known before the costly part begins */
  abbe_yaml_get(yaml, root, "materials");
  abbe_yaml_get(yaml, root, "objects");
  abbe_yaml_get(yaml, root, "environment");
  ABBE_TRY(abbe_yaml_check_keys(yaml, root, "a scene", error));
  ABBE_TRY(read_environment(yaml, root, folder, out, error));
  ABBE_TRY(read_table(yaml, root, folder, options, out, error));
  ABBE_TRY(read_objects(yaml, root, folder, out, error));
  ABBE_TRY(place_materials(yaml, root, out, error));
  ABBE_TRY(abbe_camera_frame(yaml, root, out, error));
  return abbe_scene_check(out, error);
}

/* The folder of a path with its slash, "" for a plain name; malloc'd. */
static char *folder_of(const char *path) {
  char *folder = strdup(path);
  if (!folder) return NULL;
  char *slash = strrchr(folder, '/');
  if (slash)
    slash[1] = '\0';
  else
    folder[0] = '\0';
  return folder;
}

/* Reads and frees the document; path stands in messages and says where relative paths start. */
static abbe_result read_document(abbe_yaml *yaml, const char *path,
                                 const abbe_scene_options *options, abbe_scene *out,
                                 abbe_error *error) {
  char *folder = folder_of(path);
  out->path = strdup(path);
  abbe_result result = folder && out->path ? read_scene(yaml, folder, options, out, error)
                                           : abbe_error_set(error, ABBE_NO_MEMORY,
                                                            "%s: no memory for its path", path);
  free(folder);
  abbe_yaml_free(yaml);
  if (result == ABBE_OK) result = abbe_watch_check(error); /* whatever was given up */
  if (result != ABBE_OK) abbe_scene_free(out);
  return result;
}

/* The text with the changes in it. */
static abbe_result change_text(const char *text, size_t size, const char *name,
                               const abbe_scene_options *options, abbe_yaml_edit *out,
                               abbe_error *error) {
  ABBE_TRY(abbe_yaml_edit_make(text, size, name, out, error));
  if (options && options->stone) ABBE_TRY(abbe_scene_change_material(out, options->stone, error));
  for (size_t i = 0; options && i < options->set_count; i++)
    ABBE_TRY(abbe_scene_change_set(out, options->set[i], error));
  return ABBE_OK;
}

/* The same as a document, with the values of its time in the place of keyframes where asked for. */
static abbe_result parse_changed(const char *text, size_t size, const char *name,
                                 const abbe_scene_options *options, bool keyframes, abbe_yaml **out,
                                 abbe_error *error) {
  ABBE_OWNED(abbe_yaml_edit, edit) = {0};
  ABBE_TRY(change_text(text, size, name, options, &edit, error));
  if (keyframes) ABBE_TRY(abbe_scene_change_keyframes(&edit, error));
  return abbe_yaml_parse(edit.text, edit.size, name, out, error);
}

static bool changes(const abbe_scene_options *options) {
  return options && (options->stone || options->set_count > 0);
}

static abbe_result parse_document(const char *text, size_t size, const char *name,
                                  const abbe_scene_options *options, abbe_yaml **out,
                                  abbe_error *error) {
  const bool changed = changes(options);
  ABBE_TRY(changed ? parse_changed(text, size, name, options, false, out, error)
                   : abbe_yaml_parse(text, size, name, out, error));
  if (!abbe_scene_change_has_keyframes(*out)) return ABBE_OK;
  abbe_yaml_free(*out);
  *out = NULL;
  return parse_changed(text, size, name, options, true, out, error);
}

/* The file's text, or the scene that is made for a stone's file. */
static abbe_result read_text(const char *path, const abbe_scene_options *options, char **text,
                             size_t *size, abbe_error *error) {
  if (!abbe_studio_is_stone(path))
    return abbe_file_read_text(path, SCENE_MOST_BYTES, text, size, error);
  abbe_studio studio = {0};
  if (options && options->studio) studio = *options->studio;
  if (options && options->materials) studio.table = options->materials;
  if (options && options->stone && strchr(options->stone, '=') == NULL)
    studio.material = options->stone;
  ABBE_FREED char *folder = folder_of(path);
  return folder != NULL ? abbe_studio_scene(path, &studio, studio.folder ? studio.folder : folder,
                                            text, size, error)
                        : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
}

static abbe_result load_document(const char *path, const abbe_scene_options *options,
                                 abbe_yaml **out, abbe_error *error) {
  char *text = NULL, name[PATH_MAX];
  size_t size = 0;
  /* lines are those of the scene that is made of a stone's file */
  snprintf(name, sizeof name, "%s%s", path, abbe_studio_is_stone(path) ? "'s scene" : "");
  abbe_result result = read_text(path, options, &text, &size, error);
  if (result == ABBE_OK) result = parse_document(text, size, name, options, out, error);
  free(text);
  return result;
}

abbe_result abbe_scene_load(const char *path, const abbe_scene_options *options, abbe_scene *out,
                            abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_yaml *yaml = NULL;
  ABBE_TRY(load_document(path, options, &yaml, error));
  return read_document(yaml, path, options, out, error);
}

/* A value set anew may take another line, and what comes after it moves. */
static void number_objects(abbe_yaml *yaml, abbe_yaml_node root, abbe_scene *scene) {
  const abbe_yaml_node list = abbe_yaml_get(yaml, root, "objects");
  const size_t items = abbe_yaml_count(yaml, list);
  size_t item = 0, before = 0;
  for (size_t i = 0; i < scene->object_count; i++) {
    if (i > 0 && scene->object[i].line != before) item++;
    before = scene->object[i].line;
    if (item < items)
      scene->object[i].line = abbe_yaml_line(yaml, abbe_yaml_item(yaml, list, item));
  }
}

static void swap_light(abbe_scene *a, abbe_scene *b) {
  const abbe_scene kept = *a;
  a->light = b->light;
  a->light_count = b->light_count;
  a->ambient = b->ambient;
  a->background = b->background;
  b->light = kept.light;
  b->light_count = kept.light_count;
  b->ambient = kept.ambient;
  b->background = kept.background;
}

abbe_result abbe_scene_load_lights(const char *path, const abbe_scene_options *options,
                                   abbe_scene *scene, abbe_error *error) {
  abbe_yaml *yaml = NULL;
  abbe_scene lit = {0};
  abbe_result result = load_document(path, options, &yaml, error);
  if (result != ABBE_OK) return result;
  const abbe_yaml_node root = abbe_yaml_root(yaml);
  char *folder = folder_of(path);
  if (folder == NULL) result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  if (result == ABBE_OK) result = read_brightness(yaml, root, &lit, error);
  if (result == ABBE_OK)
    result = abbe_lights_read(yaml, root, folder, &lit.light, &lit.light_count, error);
  if (result == ABBE_OK) {
    swap_light(scene, &lit);
    result = abbe_scene_check(scene, error);
    if (result == ABBE_OK)
      number_objects(yaml, root, scene);
    else
      swap_light(scene, &lit);
  }
  abbe_lights_free(lit.light, lit.light_count);
  free(folder);
  abbe_yaml_free(yaml);
  return result;
}

abbe_result abbe_scene_parse(const char *text, size_t size, const char *name,
                             const abbe_scene_options *options, abbe_scene *out,
                             abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_yaml *yaml = NULL;
  ABBE_TRY(parse_document(text, size, name, options, &yaml, error));
  return read_document(yaml, name, options, out, error);
}

static abbe_result read_changed(const char *path, const abbe_scene_options *options,
                                abbe_yaml_edit *edit, abbe_error *error) {
  ABBE_FREED char *text = NULL;
  size_t bytes = 0;
  ABBE_TRY(read_text(path, options, &text, &bytes, error));
  return change_text(text, bytes, path, options, edit, error);
}

abbe_result abbe_scene_text(const char *path, const abbe_scene_options *options, char **out,
                            size_t *size, abbe_error *error) {
  ABBE_OWNED(abbe_yaml_edit, edit) = {0};
  *out = NULL;
  *size = 0;
  ABBE_TRY(read_changed(path, options, &edit, error));
  *out = edit.text;
  *size = edit.size;
  edit.text = NULL;
  return ABBE_OK;
}

abbe_result abbe_scene_number(const char *path, const abbe_scene_options *options, const char *key,
                              double *value, abbe_error *error) {
  ABBE_OWNED(abbe_yaml_edit, edit) = {0};
  ABBE_TRY(read_changed(path, options, &edit, error));
  return abbe_scene_change_number(&edit, key, value, error);
}
