/* gltf_json.h: the JSON of a .gltf or .glb file, by cJSON, and the bytes that a .glb has behind it.
 * Internal to scenes/.
 */
#ifndef ABBE_SCENES_IMPORT_MESH_GLTF_JSON_H
#define ABBE_SCENES_IMPORT_MESH_GLTF_JSON_H

#include "base/error.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

#define ABBE_GLTF_MOST_JSON ((size_t)64 << 20) /* bytes */

typedef struct abbe_gltf_json {
  cJSON *root;       /* an object, of version 2; cJSON_Delete frees it */
  const char *bytes; /* of the binary chunk, within data; NULL: there is none */
  size_t size;
} abbe_gltf_json;

/* data is the whole file, binary where it begins with 'glTF', as every .glb does. ABBE_PARSE,
 * ABBE_UNSUPPORTED for another version and longer JSON than ABBE_GLTF_MOST_JSON. */
abbe_result abbe_gltf_json_parse(const char *path, const char *data, size_t size,
                                 abbe_gltf_json *out, abbe_error *error);

/* What the object, NULL for none, has under the name of an extension; NULL: nothing. */
const cJSON *abbe_gltf_extension(const cJSON *object, const char *name);

#endif
