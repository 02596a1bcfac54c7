#include "scenes/import/scene_change.h"

#include "base/nearest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NAMES = 256, LONGEST = 256 };

/* What child `index` is called: a key, or an item's 'name'; NULL: an item without one. */
static const char *name_of(abbe_yaml *yaml, abbe_yaml_node parent, size_t index) {
  if (abbe_yaml_is_mapping(yaml, parent))
    return abbe_yaml_text(yaml, abbe_yaml_key(yaml, parent, index));
  const abbe_yaml_node item = abbe_yaml_item(yaml, parent, index);
  return abbe_yaml_is_mapping(yaml, item) ? abbe_yaml_text(yaml, abbe_yaml_get(yaml, item, "name"))
                                          : NULL;
}

static abbe_yaml_node child_of(const abbe_yaml *yaml, abbe_yaml_node parent, size_t index) {
  return abbe_yaml_is_mapping(yaml, parent) ? abbe_yaml_value(yaml, parent, index)
                                            : abbe_yaml_item(yaml, parent, index);
}

/* The child that path begins with, and in *used the length of its name; names may have dots of
 * their own, so the longest that fits is meant. */
static bool find_child(abbe_yaml *yaml, abbe_yaml_node parent, const char *path, size_t *index,
                       size_t *used) {
  const size_t count = abbe_yaml_count(yaml, parent);
  *used = 0;
  for (size_t i = 0; i < count; i++) {
    const char *name = name_of(yaml, parent, i);
    const size_t length = name != NULL ? strlen(name) : 0;
    if (length <= *used || strncmp(name, path, length) != 0) continue;
    if (path[length] != '.' && path[length] != '\0') continue;
    *index = i;
    *used = length;
  }
  if (*used > 0 || !abbe_yaml_is_sequence(yaml, parent)) return *used > 0;
  const size_t digits = strspn(path, "0123456789");
  if (digits == 0 || digits > 6 || (path[digits] != '.' && path[digits] != '\0')) return false;
  *index = strtoul(path, NULL, 10);
  *used = digits;
  return *index < count;
}

static abbe_result no_child(const abbe_yaml_edit *edit, abbe_yaml_node parent, const char *path,
                            const char *step, abbe_error *error) {
  const char *names[MOST_NAMES];
  char word[LONGEST];
  size_t count = 0;
  for (size_t i = 0; i < abbe_yaml_count(edit->yaml, parent) && count < MOST_NAMES; i++)
    if ((names[count] = name_of(edit->yaml, parent, i)) != NULL) count++;
  snprintf(word, sizeof word, "%.*s", (int)strcspn(step, "."), step);
  const char *nearest = abbe_nearest_word(word, names, count);
  const bool empty = abbe_yaml_is_scalar(edit->yaml, parent);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: '%.120s': there is no '%.60s'%s%.60s%s",
                        edit->name, path, word,
                        nearest ? "; did you mean '"
                        : empty ? " in what is one value"
                                : " there",
                        nearest ? nearest : "", nearest ? "'?" : "");
}

static abbe_result set(abbe_yaml_edit *edit, const char *path, const char *value,
                       abbe_error *error) {
  abbe_yaml_node at = abbe_yaml_root(edit->yaml);
  for (const char *step = path;;) {
    size_t index = 0, used = 0;
    if (!find_child(edit->yaml, at, step, &index, &used)) {
      const bool last = strchr(step, '.') == NULL && *step != '\0';
      if (!last || !abbe_yaml_is_mapping(edit->yaml, at))
        return no_child(edit, at, path, step, error);
      return abbe_yaml_edit_insert_pair(edit, at, ABBE_YAML_EDIT_END, step, value, error);
    }
    if (step[used] == '\0') return abbe_yaml_edit_replace(edit, at, index, value, error);
    if (abbe_yaml_edit_is_alias(edit, at, index))
      return abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: '%.120s': '%.*s' is shared with other places of the file by an "
                            "alias; set what is shared, or write it out",
                            edit->name, path, (int)used, step);
    at = child_of(edit->yaml, at, index);
    step += used + 1;
  }
}

abbe_result abbe_scene_change_set(abbe_yaml_edit *edit, const char *assignment, abbe_error *error) {
  const char *equals = strchr(assignment, '=');
  char path[LONGEST];
  if (equals == NULL || equals == assignment || equals[1] == '\0' ||
      (size_t)(equals - assignment) >= sizeof path)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%.80s' sets nothing; write KEY=VALUE, such as camera.fov=30 or "
                          "lights.lamp.intensity=2",
                          assignment);
  snprintf(path, sizeof path, "%.*s", (int)(equals - assignment), assignment);
  return set(edit, path, equals + 1, error);
}

/* ---- materials ---- */

static abbe_yaml_node objects_of(const abbe_yaml_edit *edit) {
  const abbe_yaml_node list = abbe_yaml_get(edit->yaml, abbe_yaml_root(edit->yaml), "objects");
  return abbe_yaml_is_sequence(edit->yaml, list) ? list : (abbe_yaml_node){0};
}

/* What object i is made of, and where that stands in it; NULL: it is no refractor. */
static const char *material_of(const abbe_yaml_edit *edit, size_t i, size_t *index) {
  const abbe_yaml_node object = abbe_yaml_item(edit->yaml, objects_of(edit), i);
  for (size_t k = 0; k < abbe_yaml_count(edit->yaml, object); k++) {
    if (!abbe_yaml_is_mapping(edit->yaml, object)) return NULL;
    const char *key = abbe_yaml_text(edit->yaml, abbe_yaml_key(edit->yaml, object, k));
    if (key == NULL || strcmp(key, "material") != 0) continue;
    *index = k;
    return abbe_yaml_text(edit->yaml, abbe_yaml_value(edit->yaml, object, k));
  }
  return NULL;
}

/* The one material of all refractors. */
static abbe_result only_material(const abbe_yaml_edit *edit, size_t count, const char *stone,
                                 char name[LONGEST], abbe_error *error) {
  name[0] = '\0';
  for (size_t i = 0; i < count; i++) {
    size_t index = 0;
    const char *material = material_of(edit, i, &index);
    if (material == NULL) continue;
    if (name[0] != '\0' && strcmp(name, material) != 0)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: '%.60s' in the place of what? It has %.60s and %.60s; write "
                            "%.60s=%.60s",
                            edit->name, stone, name, material, name, stone);
    snprintf(name, LONGEST, "%s", material);
  }
  if (name[0] != '\0') return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: none of its objects has a 'material' to be replaced by '%.60s'",
                        edit->name, stone);
}

abbe_result abbe_scene_change_material(abbe_yaml_edit *edit, const char *text, abbe_error *error) {
  const size_t count = abbe_yaml_count(edit->yaml, objects_of(edit));
  const char *equals = strchr(text, '='), *stone = equals != NULL ? equals + 1 : text;
  const char *known[2 * MOST_NAMES];
  char name[LONGEST];
  size_t changed = 0, known_count = 0;
  abbe_result result = ABBE_OK;
  if (equals == NULL)
    result = only_material(edit, count, stone, name, error);
  else
    snprintf(name, sizeof name, "%.*s", (int)(equals - text), text);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    size_t index = 0;
    const char *material = material_of(edit, i, &index);
    const char *object = name_of(edit->yaml, objects_of(edit), i);
    if (material == NULL || (strcmp(material, name) != 0 &&
                             (equals == NULL || object == NULL || strcmp(object, name) != 0)))
      continue;
    result = abbe_yaml_edit_replace(edit, abbe_yaml_item(edit->yaml, objects_of(edit), i), index,
                                    stone, error);
    changed++;
  }
  if (result != ABBE_OK || changed > 0) return result;
  for (size_t i = 0; i < count && known_count + 2 < 2 * MOST_NAMES; i++) {
    size_t index = 0;
    const char *material = material_of(edit, i, &index);
    if (material == NULL) continue;
    known[known_count++] = material;
    const char *object = name_of(edit->yaml, objects_of(edit), i);
    if (object != NULL) known[known_count++] = object;
  }
  const char *nearest = abbe_nearest_word(name, known, known_count);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: nothing in it is made of '%.60s', or is an object of that name that "
                        "has a material%s%.60s%s",
                        edit->name, name, nearest ? "; did you mean '" : "", nearest ? nearest : "",
                        nearest ? "'?" : "");
}
