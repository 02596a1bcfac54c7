#include "scenes/import/mesh/gltf_json.h"

#include <stdint.h>
#include <string.h>
#include <strings.h>

static uint32_t word(const char *at) {
  const unsigned char *b = (const unsigned char *)at;
  return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* The chunks of a binary file: JSON first, then bytes perhaps. */
static abbe_result find_chunks(const char *path, const char **text, size_t *length, const char *end,
                               abbe_gltf_json *out, abbe_error *error) {
  enum { HEAD = 12, CHUNK = 8 };
  const char *data = *text;
  if (*length < HEAD + CHUNK || memcmp(data, "glTF", 4) != 0 || word(data + 4) != 2 ||
      memcmp(data + HEAD + 4, "JSON", 4) != 0)
    return abbe_error_set(
        error, ABBE_PARSE,
        "%s: it is no binary glTF of version 2, which begins with 'glTF', 2 and a "
        "chunk of JSON",
        path);
  *text = data + HEAD + CHUNK;
  *length = word(data + HEAD);
  if (*length > (size_t)(end - *text))
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: its JSON is to have %zu bytes, more than the file has", path,
                          *length);
  const char *next = *text + *length;
  if (end - next < CHUNK || memcmp(next + 4, "BIN", 4) != 0) return ABBE_OK;
  out->bytes = next + CHUNK;
  out->size = word(next);
  if (out->size > (size_t)(end - out->bytes))
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: its binary chunk is to have %zu bytes, more than the file has", path,
                          out->size);
  return ABBE_OK;
}

abbe_result abbe_gltf_json_parse(const char *path, const char *data, size_t size,
                                 abbe_gltf_json *out, abbe_error *error) {
  const char *text = data;
  size_t length = size;
  *out = (abbe_gltf_json){0};
  const char *dot = strrchr(path, '.');
  if ((size >= 4 && memcmp(data, "glTF", 4) == 0) || (dot && strcasecmp(dot, ".glb") == 0)) {
    const abbe_result result = find_chunks(path, &text, &length, data + size, out, error);
    if (result != ABBE_OK) return result;
  }
  if (length > ABBE_GLTF_MOST_JSON)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "%s: its JSON has %zu bytes, the limit is %zu",
                          path, length, ABBE_GLTF_MOST_JSON);
  out->root = cJSON_ParseWithLength(text, length);
  const cJSON *asset = cJSON_GetObjectItemCaseSensitive(out->root, "asset");
  const char *version = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(asset, "version"));
  abbe_result result = ABBE_OK;
  if (!cJSON_IsObject(out->root))
    result = abbe_error_set(error, ABBE_PARSE, "%s: its JSON is not well formed", path);
  else if (version != NULL && strncmp(version, "2.", 2) != 0)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%s: it is glTF of version '%.20s'; version 2 is read", path, version);
  if (result == ABBE_OK) return ABBE_OK;
  cJSON_Delete(out->root);
  out->root = NULL;
  return result;
}

const cJSON *abbe_gltf_extension(const cJSON *object, const char *name) {
  return cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(object, "extensions"),
                                          name);
}
