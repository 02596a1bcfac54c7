/* The metal around a stone, key `setting` of an object that refracts (docs/scene-files.md). */
#include "scenes/geometry/transform.h"
#include "scenes/import/scene_reading.h"
#include "scenes/import/scene_value.h"
#include "scenes/studio/setting.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KIND_NAME(code, name) #name,
static const char *const kind_names[] = {ABBE_SETTING_KINDS(KIND_NAME) NULL};
#undef KIND_NAME

static abbe_result refuse(abbe_yaml *yaml, abbe_yaml_node node, const char *key, bool wanted,
                          const char *kind, abbe_error *error) {
  const abbe_yaml_node at = abbe_yaml_get(yaml, node, key);
  if (wanted || at.id == 0) return ABBE_OK;
  return abbe_yaml_fail(yaml, at, error, "a setting of kind '%s' has no '%s': leave it out", kind,
                        key);
}

/* The shape; what has no effect on its kind is refused. */
static abbe_result read_shape(abbe_yaml *yaml, abbe_yaml_node node, abbe_setting *out,
                              abbe_error *error) {
  abbe_yaml_node ignored;
  int kind = 0;
  ABBE_TRY(abbe_yaml_require(yaml, node, "kind", &ignored, error));
  ABBE_TRY(abbe_yaml_get_choice(yaml, node, "kind", kind_names, &kind, error));
  out->kind = (abbe_setting_kind)kind;
  const bool counted = out->kind == ABBE_SETTING_PRONGS || out->kind == ABBE_SETTING_PAVE;
  ABBE_TRY(refuse(yaml, node, "count", counted, kind_names[kind], error));
  ABBE_TRY(refuse(yaml, node, "radius", out->kind == ABBE_SETTING_BAND, kind_names[kind], error));
  ABBE_TRY(abbe_yaml_get_count(yaml, node, "count", ABBE_SETTING_LEAST, ABBE_SETTING_MOST,
                               &out->count, error));
  ABBE_TRY(abbe_yaml_get_length(yaml, node, "thick", 0, ABBE_SCENE_FAR, &out->thick, error));
  return abbe_yaml_get_length(yaml, node, "radius", 0, ABBE_SCENE_FAR, &out->radius, error);
}

static abbe_result read_metal(abbe_yaml *yaml, abbe_yaml_node node,
                              const abbe_material_table *table, abbe_object *out,
                              abbe_error *error) {
  abbe_yaml_node metal;
  char *name = NULL;
  abbe_result result = abbe_yaml_require(yaml, node, "metal", &metal, error);
  if (result == ABBE_OK) result = abbe_yaml_get_string(yaml, node, "metal", &name, error);
  if (result == ABBE_OK) {
    result = abbe_material_table_find(table, name, &out->conductor, error);
    if (result != ABBE_OK) abbe_scene_value_locate(yaml, metal, result, error);
  }
  free(name);
  if (result == ABBE_OK && !abbe_material_is_conductor(out->conductor))
    return abbe_yaml_fail(yaml, metal, error, "'%s' is no metal; take one such as gold",
                          out->conductor->name);
  return result;
}

static abbe_result read_one(const abbe_object_reading *r, abbe_yaml_node node,
                            const abbe_material_table *table, const abbe_object *stone, double unit,
                            abbe_object *out, abbe_error *error) {
  abbe_yaml *yaml = r->yaml;
  abbe_setting setting = {.unit = unit};
  if (!abbe_yaml_is_mapping(yaml, node))
    return abbe_yaml_fail(yaml, node, error,
                          "'setting' must be a mapping such as {kind: prongs, count: 4, metal: "
                          "gold}, or a list of these");
  abbe_result result = read_shape(yaml, node, &setting, error);
  if (result == ABBE_OK) result = read_metal(yaml, node, table, out, error);
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "a setting", error);
  if (result != ABBE_OK) return result;
  out->mirror = out->holds = true;
  out->line = stone->line;
  result = abbe_setting_make(&stone->mesh, &setting, &out->mesh, error);
  if (result != ABBE_OK) return abbe_scene_value_locate(yaml, node, result, error);
  char name[128];
  snprintf(name, sizeof name, "%.90s's %s", stone->name, kind_names[setting.kind]);
  out->name = strdup(name);
  return out->name != NULL ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
}

abbe_result abbe_setting_read(const abbe_object_reading *r, const abbe_material_table *table,
                              const abbe_object *stone, const abbe_object_surface *surface,
                              size_t room, abbe_object out[ABBE_SETTINGS_MOST], size_t *count,
                              abbe_error *error) {
  const abbe_yaml_node node = abbe_yaml_get(r->yaml, r->node, "setting");
  const bool list = abbe_yaml_is_sequence(r->yaml, node);
  const size_t most = node.id == 0 ? 0 : list ? abbe_yaml_count(r->yaml, node) : 1;
  *count = 0;
  if (most > 0 && abbe_yaml_get(r->yaml, r->node, "material").id == 0)
    return abbe_yaml_fail(r->yaml, node, error,
                          "'setting' is the metal around a stone; this object has no 'material'");
  if (most > ABBE_SETTINGS_MOST || most > room)
    return abbe_yaml_fail(r->yaml, node, error,
                          "%zu settings: a stone has up to %d, and a scene %d objects", most,
                          ABBE_SETTINGS_MOST, ABBE_SCENE_MAX_OBJECTS);
  const double unit = most > 0 ? abbe_object_unit(surface, &stone->mesh) : 0;
  for (; *count < most; ++*count)
    ABBE_TRY(read_one(r, list ? abbe_yaml_item(r->yaml, node, *count) : node, table, stone, unit,
                      &out[*count], error));
  return ABBE_OK;
}

abbe_result abbe_setting_place(const abbe_object_surface *surface, abbe_result before,
                               abbe_object metal[ABBE_SETTINGS_MOST], abbe_object *out,
                               size_t *count, abbe_error *error) {
  abbe_object_surface moved = {0};
  const double factor[3] = {out->fitted, out->fitted, out->fitted};
  double step[16];
  size_t one;
  abbe_transform_scale(factor, step);
  abbe_transform_multiply(step, surface->matrix, moved.matrix);
  abbe_transform_translate(out->centring, step);
  abbe_transform_multiply(step, moved.matrix, moved.matrix);
  for (size_t i = 0; i < surface->setting_count; i++) {
    if (before == ABBE_OK) {
      out[*count] = metal[i];
      before = abbe_object_place(&moved, &out[(*count)++], 1, &one, error);
    } else {
      free(metal[i].name);
      abbe_mesh_free(&metal[i].mesh);
    }
  }
  return before;
}
