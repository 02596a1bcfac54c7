/* gltf_data.h: numbers that a glTF file keeps in buffers: accessors, views, buffers and their
 * files.
 *
 * A file's lists are indexed once. Buffers are loaded when they are first needed. It knows no
 * meshes. Internal to scenes/. */
#ifndef ABBE_SCENES_IMPORT_MESH_GLTF_DATA_H
#define ABBE_SCENES_IMPORT_MESH_GLTF_DATA_H

#include "base/error.h"
#include "scenes/import/mesh/mesh_reading.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

/* The JSON of a .gltf or .glb file, by cJSON, and the bytes that a .glb has behind it. */

#define ABBE_GLTF_MOST_JSON ((size_t)64 << 20) /* bytes */

typedef struct abbe_gltf_json {
  cJSON *root;       /* an object, of version 2; cJSON_Delete frees it */
  const char *bytes; /* start of the binary chunk, within data; NULL: there is none */
  size_t size;
} abbe_gltf_json;

/* data is the whole file, binary where it begins with 'glTF', as every .glb does. ABBE_PARSE,
 * ABBE_UNSUPPORTED for another version and longer JSON than ABBE_GLTF_MOST_JSON. */
abbe_result abbe_gltf_json_parse(const char *path, const char *data, size_t size,
                                 abbe_gltf_json *out, abbe_error *error);

/* What the object, NULL for none, has under the name of an extension; NULL: nothing. */
const cJSON *abbe_gltf_extension(const cJSON *object, const char *name);

/* Bytes of all files of a mesh together. */
#define ABBE_MESH_FILES_MOST ((size_t)1 << 30)

/* Numbers that a file's accessors, instances and nodes may make, all together: so many, and so many
 * times the bytes of its files; and those of accessors that have no bytes, but say how long they
 * are. Each primitive of a node counts as some. */
#define ABBE_GLTF_VALUES ((size_t)1 << 27)
#define ABBE_GLTF_VALUES_A_BYTE 4
#define ABBE_GLTF_VALUES_OF_NOTHING ((size_t)1 << 22)
#define ABBE_GLTF_VALUES_A_PRIMITIVE 32

typedef struct abbe_gltf_list {
  const cJSON **item;
  size_t count;
} abbe_gltf_list;

typedef struct abbe_gltf_buffer {
  char *owned; /* NULL: the bytes are the file's own, or are not loaded */
  const char *bytes;
  size_t size;
} abbe_gltf_buffer;

typedef struct abbe_gltf {
  abbe_mesh_reading *to;
  abbe_gltf_json json;
  abbe_gltf_list nodes, meshes, materials, accessors, views, buffers;
  abbe_gltf_buffer *buffer; /* [buffers.count] */
  size_t loaded, values;    /* bytes of files; values that accessors were made into */
  abbe_error *error;
} abbe_gltf;

/* Fails with code and a sentence after the file's name. */
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
abbe_result
abbe_gltf_fail(const abbe_gltf *g, abbe_result code, const char *format, ...);

/* The list of that name of an object, empty where there is none; the caller frees item. */
abbe_result abbe_gltf_list_make(const abbe_gltf *g, const cJSON *object, const char *name,
                                abbe_gltf_list *out);

/* A whole number from 0 to 2^40 under the object's key, fallback where there is none. what names
 * the object in messages. */
abbe_result abbe_gltf_whole(const abbe_gltf *g, const cJSON *object, const char *key,
                            const char *what, size_t fallback, size_t *out);

/* The item of the list whose index stands under the object's key; NULL where there is no key. */
abbe_result abbe_gltf_reference(const abbe_gltf *g, const cJSON *object, const char *key,
                                const char *what, const abbe_gltf_list *list, const cJSON **out);

/* All values of the accessor that the attributes name, width a vector (3: "VEC3"), normalised where
 * it says so. *out is malloc'd; NULL, and *count 0, where the attributes do not name it. */
abbe_result abbe_gltf_values(abbe_gltf *g, const cJSON *attributes, const char *key, size_t width,
                             double **out, size_t *count);

/* Counts so many vectors to what the file's accessors have made: ABBE_UNSUPPORTED where that is
 * more than they may. */
abbe_result abbe_gltf_charge(abbe_gltf *g, size_t count, size_t width);

void abbe_gltf_free(abbe_gltf *g);

#endif
