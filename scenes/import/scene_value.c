#include "scenes/import/scene_value.h"

#include "base/maths.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *abbe_scene_value_path(const char *folder, const char *path) {
  const size_t prefix = path[0] == '/' ? 0 : strlen(folder), size = prefix + strlen(path) + 1;
  char *joined = malloc(size);
  if (joined) snprintf(joined, size, "%.*s%s", (int)prefix, folder, path);
  return joined;
}

abbe_result abbe_scene_value_locate(const abbe_yaml *yaml, abbe_yaml_node node, abbe_result code,
                                    abbe_error *error) {
  if (!error) return code;
  char sentence[sizeof error->text];
  memcpy(sentence, error->text, sizeof sentence);
  abbe_yaml_fail(yaml, node, error, "%s", sentence);
  error->code = code;
  return code;
}

abbe_result abbe_scene_value_point(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                   double out[3], abbe_error *error) {
  abbe_yaml_node ignored;
  ABBE_TRY(abbe_yaml_require(yaml, mapping, key, &ignored, error));
  return abbe_yaml_get_lengths(yaml, mapping, key, 3, -ABBE_SCENE_FAR, ABBE_SCENE_FAR, out, error);
}

abbe_result abbe_scene_value_list(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t most, abbe_yaml_node *list, size_t *count,
                                  abbe_error *error) {
  *list = abbe_yaml_get(yaml, mapping, key);
  *count = abbe_yaml_count(yaml, *list);
  if (list->id != 0 && !abbe_yaml_is_sequence(yaml, *list))
    return abbe_yaml_fail(yaml, *list, error, "'%s' wants a list", key);
  if (*count > most)
    return abbe_yaml_fail(yaml, *list, error, "'%s' has %zu entries; at most %zu are possible", key,
                          *count, most);
  return ABBE_OK;
}

abbe_result abbe_scene_value_time(abbe_yaml *yaml, double *out, abbe_error *error) {
  *out = 0;
  return abbe_yaml_get_number(yaml, abbe_yaml_root(yaml), "time", -ABBE_SCENE_FAR, ABBE_SCENE_FAR,
                              out, error);
}

abbe_result abbe_scene_value_illuminant(abbe_yaml *yaml, abbe_yaml_node mapping, const char *folder,
                                        abbe_illuminant *out, char **path, abbe_error *error) {
  char *name = NULL, *joined = NULL;
  abbe_result result = abbe_yaml_get_string(yaml, mapping, "illuminant", &name, error);
  if (result == ABBE_OK && name) {
    joined = abbe_scene_value_path(abbe_illuminant_is_name(name) ? "" : folder, name);
    result = joined ? abbe_illuminant_make(joined, out, error)
                    : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result == ABBE_IO) {
      char sentence[512];
      snprintf(sentence, sizeof sentence, "%.500s", error ? error->text : "");
      abbe_error_set(error, result,
                     "the illuminant '%.60s' is neither " ABBE_ILLUMINANT_NAMES
                     " nor a file that can be read: %s",
                     name, sentence);
    }
    if (result != ABBE_OK)
      abbe_scene_value_locate(yaml, abbe_yaml_get(yaml, mapping, "illuminant"), result, error);
    if (result == ABBE_OK && out->kind == ABBE_ILLUMINANT_TABULATED && out->name[0] == '\0') {
      *path = joined;
      joined = NULL;
    }
  }
  free(joined);
  free(name);
  return result;
}

abbe_result abbe_scene_value_polariser(abbe_yaml *yaml, abbe_yaml_node mapping, abbe_polariser *out,
                                       abbe_error *error) {
  static const char *const kinds[] = {"linear", "right", "left", NULL};
  const abbe_yaml_node node = abbe_yaml_get(yaml, mapping, "polariser");
  if (node.id == 0) return ABBE_OK;
  int kind = 0;
  double angle = 0;
  ABBE_TRY(abbe_yaml_get_choice(yaml, node, "kind", kinds, &kind, error));
  ABBE_TRY(abbe_yaml_get_number(yaml, node, "angle", -360, 360, &angle, error));
  if (kind != 0 && abbe_yaml_get(yaml, node, "angle").id != 0)
    return abbe_yaml_fail(yaml, node, error,
                          "a circular polariser is alike at every 'angle': leave it out");
  *out = (abbe_polariser){(abbe_polariser_kind)(kind + 1), angle * ABBE_DEGREE};
  return abbe_yaml_check_keys(yaml, node, "a polariser", error);
}
