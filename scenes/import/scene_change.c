#include "scenes/import/scene_reading.h"

#include "base/text.h"
#include "scenes/import/scene_value.h"

#include <math.h>
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

/* Without a value the key goes. */
static abbe_result set(abbe_yaml_edit *edit, const char *path, const char *value,
                       abbe_error *error) {
  abbe_yaml_node at = abbe_yaml_root(edit->yaml);
  for (const char *step = path;;) {
    size_t index = 0, used = 0;
    if (!find_child(edit->yaml, at, step, &index, &used)) {
      const bool last = strchr(step, '.') == NULL && *step != '\0' && *value != '\0';
      if (!last || !abbe_yaml_is_mapping(edit->yaml, at))
        return no_child(edit, at, path, step, error);
      return abbe_yaml_edit_insert_pair(edit, at, ABBE_YAML_EDIT_END, step, value, error);
    }
    if (step[used] == '\0')
      return *value != '\0' ? abbe_yaml_edit_replace(edit, at, index, value, error)
                            : abbe_yaml_edit_remove(edit, at, index, error);
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
  if (equals == NULL || equals == assignment || (size_t)(equals - assignment) >= sizeof path)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%.80s' sets nothing; write KEY=VALUE, such as camera.fov=30 or "
                          "lights.lamp.intensity=2",
                          assignment);
  snprintf(path, sizeof path, "%.*s", (int)(equals - assignment), assignment);
  return set(edit, path, equals + 1, error);
}

/* Names of numbers there, or of what holds some. */
static const char *near_number(abbe_yaml *yaml, abbe_yaml_node parent, const char *word) {
  const char *names[MOST_NAMES];
  size_t count = 0;
  for (size_t i = 0; i < abbe_yaml_count(yaml, parent) && count < MOST_NAMES; i++) {
    double value;
    const char *name = name_of(yaml, parent, i);
    const abbe_yaml_node child = child_of(yaml, parent, i);
    const bool serves =
        !abbe_yaml_is_scalar(yaml, child) ||
        abbe_yaml_length(yaml, child, "", -HUGE_VAL, HUGE_VAL, &value, NULL) == ABBE_OK;
    if (name != NULL && serves && strcmp(name, word) != 0) names[count++] = name;
  }
  const char *nearest = abbe_nearest_word(word, names, count);
  return nearest != NULL ? nearest : count > 0 ? names[0] : NULL;
}

abbe_result abbe_scene_change_number(const abbe_yaml_edit *edit, const char *path, double *value,
                                     abbe_error *error) {
  abbe_yaml *yaml = edit->yaml;
  abbe_yaml_node at = abbe_yaml_root(yaml);
  const char *step = path;
  for (;;) {
    size_t index = 0, used = 0;
    if (!find_child(yaml, at, step, &index, &used)) return no_child(edit, at, path, step, error);
    const abbe_yaml_node child = child_of(yaml, at, index);
    if (step[used] == '\0') {
      if (abbe_yaml_is_scalar(yaml, child) &&
          abbe_yaml_length(yaml, child, step, -HUGE_VAL, HUGE_VAL, value, NULL) == ABBE_OK)
        return ABBE_OK;
      const char *near = near_number(yaml, at, step);
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: '%.120s' is no number%s%.*s%.60s%s",
                            edit->name, path, near ? "; one near it is '" : "",
                            near ? (int)(step - path) : 0, path, near ? near : "", near ? "'" : "");
    }
    at = child;
    step += used + 1;
  }
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
    if (strcmp(key, "material") != 0) continue;
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
    if (material == NULL ||
        (strcmp(material, name) != 0 && (object == NULL || strcmp(object, name) != 0)))
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

/* ---- keyframes ---- */

enum { MOST_FRAMES = 10000, MOST_NUMBERS = 16 };

typedef struct keyframe {
  double time, value[MOST_NUMBERS];
  size_t count; /* 0: a number alone, value[0] */
} keyframe;

static bool has_key(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *wanted) {
  for (size_t i = 0; i < abbe_yaml_count(yaml, mapping); i++)
    if (strcmp(abbe_yaml_text(yaml, abbe_yaml_key(yaml, mapping, i)), wanted) == 0) return true;
  return false;
}

/* The first child, in the order of the file, that has keyframes, and its parent. */
static bool find_keyframes(const abbe_yaml *yaml, abbe_yaml_node at, abbe_yaml_node *parent,
                           size_t *index) {
  if (abbe_yaml_is_scalar(yaml, at)) return false;
  for (size_t i = 0; i < abbe_yaml_count(yaml, at); i++) {
    const abbe_yaml_node child = child_of(yaml, at, i);
    if (abbe_yaml_is_mapping(yaml, child) && has_key(yaml, child, "keyframes")) {
      *parent = at;
      *index = i;
      return true;
    }
    if (find_keyframes(yaml, child, parent, index)) return true;
  }
  return false;
}

bool abbe_scene_change_has_keyframes(const abbe_yaml *yaml) {
  abbe_yaml_node parent;
  size_t index;
  return find_keyframes(yaml, abbe_yaml_root(yaml), &parent, &index);
}

static abbe_result read_keyframe(abbe_yaml *yaml, abbe_yaml_node node, keyframe *out,
                                 abbe_error *error) {
  if (!abbe_yaml_is_sequence(yaml, node) || abbe_yaml_count(yaml, node) != 2)
    return abbe_yaml_fail(
        yaml, node, error,
        "a keyframe is a time and a value, such as [1.5, 30] or [1.5, [0, 0, 1]]");
  const abbe_yaml_node value = abbe_yaml_item(yaml, node, 1);
  const bool list = abbe_yaml_is_sequence(yaml, value);
  abbe_result result = abbe_yaml_number(yaml, abbe_yaml_item(yaml, node, 0), "keyframes",
                                        -ABBE_SCENE_FAR, ABBE_SCENE_FAR, &out->time, error);
  out->count = list ? abbe_yaml_count(yaml, value) : 0;
  if (result == ABBE_OK && list && (out->count == 0 || out->count > MOST_NUMBERS))
    return abbe_yaml_fail(yaml, value, error, "a keyframe's value is a number or 1 to %d numbers",
                          MOST_NUMBERS);
  for (size_t k = 0; k < (list ? out->count : 1) && result == ABBE_OK; k++)
    result = abbe_yaml_length(yaml, list ? abbe_yaml_item(yaml, value, k) : value, "keyframes",
                              -1e12, 1e12, &out->value[k], error);
  return result;
}

static bool follows(const keyframe *before, const keyframe *next) {
  return next->time > before->time && next->count == before->count;
}

static abbe_result interpolate(abbe_yaml *yaml, abbe_yaml_node list, double time, keyframe *out,
                               abbe_error *error) {
  const size_t count = abbe_yaml_count(yaml, list);
  keyframe before, next;
  if (!abbe_yaml_is_sequence(yaml, list) || count == 0 || count > MOST_FRAMES)
    return abbe_yaml_fail(yaml, list, error,
                          "'keyframes' wants a list of 1 to %d pairs [TIME, VALUE]", MOST_FRAMES);
  abbe_result result = read_keyframe(yaml, abbe_yaml_item(yaml, list, 0), &before, error);
  if (result == ABBE_OK) *out = before;
  for (size_t i = 1; i < count && result == ABBE_OK; i++, before = next) {
    const abbe_yaml_node node = abbe_yaml_item(yaml, list, i);
    result = read_keyframe(yaml, node, &next, error);
    if (result == ABBE_OK && !follows(&before, &next))
      return abbe_yaml_fail(yaml, node, error,
                            "keyframes come in rising order of time, all with as many numbers");
    if (result != ABBE_OK || time < before.time) continue;
    const double t = fmin((time - before.time) / (next.time - before.time), 1);
    for (size_t k = 0; k < (next.count > 0 ? next.count : 1); k++)
      out->value[k] = before.value[k] + t * (next.value[k] - before.value[k]);
  }
  return result;
}

static abbe_result value_at(abbe_yaml *yaml, abbe_yaml_node node, double time, keyframe *out,
                            abbe_error *error) {
  double repeat = 0;
  const abbe_yaml_node length = abbe_yaml_get(yaml, node, "repeat");
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "repeat", 0, ABBE_SCENE_FAR, &repeat, error));
  if (length.id != 0 && !(repeat > 0))
    return abbe_yaml_fail(yaml, length, error, "'repeat' is a time in seconds, above 0");
  if (repeat > 0) time -= repeat * floor(time / repeat);
  ABBE_TRY(interpolate(yaml, abbe_yaml_get(yaml, node, "keyframes"), time, out, error));
  return abbe_yaml_check_keys(yaml, node, "a value with keyframes", error);
}

abbe_result abbe_scene_change_keyframes(abbe_yaml_edit *edit, abbe_error *error) {
  abbe_yaml_node parent;
  size_t index;
  double time;
  abbe_result result = abbe_scene_value_time(edit->yaml, &time, error);
  while (result == ABBE_OK &&
         find_keyframes(edit->yaml, abbe_yaml_root(edit->yaml), &parent, &index)) {
    keyframe at;
    char *text = NULL;
    result = value_at(edit->yaml, child_of(edit->yaml, parent, index), time, &at, error);
    if (result == ABBE_OK)
      result = abbe_yaml_edit_list(at.value, at.count > 0 ? at.count : 1, &text, error);
    if (result == ABBE_OK && at.count == 0) text[strlen(text) - 1] = '\0'; /* no brackets */
    if (result == ABBE_OK)
      result = abbe_yaml_edit_replace(edit, parent, index, at.count > 0 ? text : text + 1, error);
    free(text);
  }
  return result;
}
