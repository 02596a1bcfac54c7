#include "scenes/import/mesh/gltf_data.h"

#include "base/file.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

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

abbe_result abbe_gltf_fail(const abbe_gltf *g, abbe_result code, const char *format, ...) {
  char prefix[600];
  va_list arguments;
  va_start(arguments, format);
  snprintf(prefix, sizeof prefix, "%.590s: ", g->to->path);
  abbe_error_set_list(g->error, code, prefix, format, arguments);
  va_end(arguments);
  return code;
}

static abbe_result no_memory(const abbe_gltf *g) {
  return abbe_mesh_reading_no_memory(g->to, g->error);
}

/* ---- what the JSON says ---- */

abbe_result abbe_gltf_list_make(const abbe_gltf *g, const cJSON *object, const char *name,
                                abbe_gltf_list *out) {
  const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, name), *item;
  const size_t count = cJSON_IsArray(list) ? (size_t)cJSON_GetArraySize(list) : 0;
  *out = (abbe_gltf_list){malloc((count + 1) * sizeof *out->item), 0};
  if (out->item == NULL) return no_memory(g);
  if (count > 0) cJSON_ArrayForEach(item, list) out->item[out->count++] = item;
  return ABBE_OK;
}

abbe_result abbe_gltf_whole(const abbe_gltf *g, const cJSON *object, const char *key,
                            const char *what, size_t fallback, size_t *out) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  *out = fallback;
  if (item == NULL) return ABBE_OK;
  const double value = cJSON_IsNumber(item) ? item->valuedouble : -1;
  if (!(value >= 0 && value <= 1099511627776.0 && value == floor(value)))
    return abbe_gltf_fail(g, ABBE_SCHEMA, "'%s' of %s is no whole number from 0 on", key, what);
  *out = (size_t)value;
  return ABBE_OK;
}

abbe_result abbe_gltf_reference(const abbe_gltf *g, const cJSON *object, const char *key,
                                const char *what, const abbe_gltf_list *list, const cJSON **out) {
  size_t index;
  *out = NULL;
  ABBE_TRY(abbe_gltf_whole(g, object, key, what, SIZE_MAX, &index));
  if (index == SIZE_MAX) return ABBE_OK;
  if (index >= list->count)
    return abbe_gltf_fail(g, ABBE_SCHEMA, "'%s' of %s is %zu, and the file has %zu of them", key,
                          what, index, list->count);
  *out = list->item[index];
  return ABBE_OK;
}

/* ---- buffers ---- */

static int digit_of(char c) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const char *at = strchr(digits, c == '-' ? '+' : c == '_' ? '/' : c);
  return at != NULL ? (int)(at - digits) : -1;
}

static abbe_result decode_base64(const abbe_gltf *g, const char *text, abbe_gltf_buffer *out) {
  unsigned bits = 0, held = 0;
  out->owned = malloc(strlen(text) / 4 * 3 + 4);
  if (out->owned == NULL) return no_memory(g);
  for (; *text != '\0' && *text != '='; text++) {
    const int digit = digit_of(*text);
    if (digit < 0)
      return abbe_gltf_fail(g, ABBE_PARSE, "a buffer's data is not base64: '%.10s'", text);
    bits = bits << 6 | (unsigned)digit;
    held += 6;
    if (held >= 8) out->owned[out->size++] = (char)(bits >> (held -= 8) & 255);
  }
  return ABBE_OK;
}

static int hex(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/* In place: %20 is a blank. */
static void decode_percent(char *text) {
  char *to = text;
  for (; *text != '\0'; text++) {
    const int high = *text == '%' ? hex(text[1]) : -1, low = high >= 0 ? hex(text[2]) : -1;
    if (low >= 0 && 16 * high + low > 0) {
      *to++ = (char)(16 * high + low);
      text += 2;
    } else {
      *to++ = *text;
    }
  }
  *to = '\0';
}

/* Beside the file; malloc'd. */
static char *path_beside(const char *path, const char *uri, bool decoded) {
  const size_t folder = (size_t)(abbe_file_name(path) - path);
  char *out = malloc(folder + strlen(uri) + 1);
  if (out == NULL) return NULL;
  memcpy(out, path, folder);
  strcpy(out + folder, uri);
  if (decoded) decode_percent(out + folder);
  return out;
}

static abbe_result load_file(abbe_gltf *g, const char *uri, abbe_gltf_buffer *out) {
  char *path = path_beside(g->to->path, uri, true);
  /* some programs write names as they are */
  char *plain = path_beside(g->to->path, uri, false);
  abbe_result result = path == NULL || plain == NULL ? no_memory(g) : ABBE_OK;
  const bool is_plain = result == ABBE_OK && access(path, F_OK) != 0 && access(plain, F_OK) == 0;
  const char *name = is_plain ? plain : path;
  if (result == ABBE_OK)
    result =
        abbe_file_read(name, ABBE_MESH_FILES_MOST - g->loaded, &out->owned, &out->size, g->error);
  if (result == ABBE_OK && !abbe_mesh_list_add(&g->to->others, strlen(name) + 1, 1, name))
    result = no_memory(g);
  free(path);
  free(plain);
  return result;
}

static abbe_result load(abbe_gltf *g, size_t index) {
  abbe_gltf_buffer *b = &g->buffer[index];
  const cJSON *item = g->buffers.item[index];
  const char *uri = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(item, "uri"));
  abbe_result result = ABBE_OK;
  if (b->bytes != NULL) return ABBE_OK;
  if (uri == NULL && (index != 0 || g->json.bytes == NULL))
    return abbe_gltf_fail(g, ABBE_UNSUPPORTED, "buffer %zu has no 'uri', and no bytes%s", index,
                          abbe_gltf_extension(item, "EXT_meshopt_compression") != NULL ||
                                  abbe_gltf_extension(item, "KHR_meshopt_compression") != NULL
                              ? " but those that meshopt_compression makes, which is not read"
                              : "");
  if (uri == NULL) {
    b->bytes = g->json.bytes;
    b->size = g->json.size;
    return ABBE_OK;
  }
  const char *data = strncmp(uri, "data:", 5) == 0 ? strstr(uri, ";base64,") : NULL;
  if (data != NULL)
    result = decode_base64(g, data + 8, b);
  else if (strstr(uri, "://") != NULL || strncmp(uri, "data:", 5) == 0)
    result = abbe_gltf_fail(g, ABBE_UNSUPPORTED,
                            "buffer %zu is at '%.60s'; buffers are files beside it, or data in "
                            "base64",
                            index, uri);
  else
    result = load_file(g, uri, b);
  b->bytes = b->owned;
  g->loaded += b->size;
  if (result == ABBE_OK && g->loaded > ABBE_MESH_FILES_MOST)
    return abbe_gltf_fail(g, ABBE_UNSUPPORTED, "it and its buffers have more than %zu bytes",
                          ABBE_MESH_FILES_MOST);
  return result;
}

/* Bytes from offset on of a view, at least size of them. */
static abbe_result find_bytes(abbe_gltf *g, const cJSON *object, size_t offset, size_t size,
                              size_t *stride, const char **out) {
  const cJSON *view, *buffer;
  size_t start = 0, length = 0, step = 0;
  ABBE_TRY(abbe_gltf_reference(g, object, "bufferView", "an accessor", &g->views, &view));
  ABBE_TRY(abbe_gltf_reference(g, view, "buffer", "a buffer view", &g->buffers, &buffer));
  ABBE_TRY(abbe_gltf_whole(g, view, "byteOffset", "a buffer view", 0, &start));
  ABBE_TRY(abbe_gltf_whole(g, view, "byteLength", "a buffer view", 0, &length));
  ABBE_TRY(abbe_gltf_whole(g, view, "byteStride", "a buffer view", 0, &step));
  if (buffer == NULL) return abbe_gltf_fail(g, ABBE_SCHEMA, "a buffer view names no 'buffer'");
  const size_t index = (size_t)cJSON_GetObjectItemCaseSensitive(view, "buffer")->valuedouble;
  ABBE_TRY(load(g, index));
  if (stride != NULL && step > 0) *stride = step;
  const size_t has = g->buffer[index].size;
  if (start > has || length > has - start || offset > length || size > length - offset)
    return abbe_gltf_fail(g, ABBE_PARSE,
                          "an accessor's bytes, or those of its view, go beyond the %zu bytes of "
                          "buffer %zu",
                          has, index);
  *out = g->buffer[index].bytes + start + offset;
  return ABBE_OK;
}

/* ---- accessors ---- */

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5125, FLOAT };

static size_t size_of(size_t type) {
  return type == BYTE || type == UNSIGNED_BYTE     ? 1
         : type == SHORT || type == UNSIGNED_SHORT ? 2
         : type == UNSIGNED_INT || type == FLOAT   ? 4
                                                   : 0;
}

/* Numbers are little-endian. */
static double value_at(const char *at, size_t type, bool normalised) {
  const unsigned char *b = (const unsigned char *)at;
  const uint16_t two = size_of(type) >= 2 ? (uint16_t)(b[0] | b[1] << 8) : 0;
  const uint32_t four =
      size_of(type) == 4 ? (uint32_t)two | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24 : 0;
  float value;
  switch (type) {
  case BYTE:
    return normalised ? fmax((int8_t)b[0] / 127.0, -1) : (int8_t)b[0];
  case UNSIGNED_BYTE:
    return normalised ? b[0] / 255.0 : b[0];
  case SHORT:
    return normalised ? fmax((int16_t)two / 32767.0, -1) : (int16_t)two;
  case UNSIGNED_SHORT:
    return normalised ? two / 65535.0 : two;
  case UNSIGNED_INT:
    return four;
  default:
    memcpy(&value, &four, sizeof value);
    return value;
  }
}

typedef struct accessor {
  const cJSON *item;
  const char *bytes;
  size_t count, width, type, offset, stride;
  bool normalised;
} accessor;

static abbe_result read_accessor(const abbe_gltf *g, const cJSON *item, const char *key,
                                 size_t width, accessor *a) {
  static const char *const shapes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const char *shape = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(item, "type"));
  *a = (accessor){.item = item, .width = width};
  a->normalised = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(item, "normalized"));
  ABBE_TRY(abbe_gltf_whole(g, item, "count", "an accessor", 0, &a->count));
  ABBE_TRY(abbe_gltf_whole(g, item, "componentType", "an accessor", 0, &a->type));
  ABBE_TRY(abbe_gltf_whole(g, item, "byteOffset", "an accessor", 0, &a->offset));
  if (shape == NULL || strcmp(shape, shapes[width]) != 0 || size_of(a->type) == 0)
    return abbe_gltf_fail(g, ABBE_SCHEMA,
                          "the accessor of '%s' is '%.20s' of component type %zu; it is %s of 5120 "
                          "to 5123, 5125 or 5126",
                          key, shape != NULL ? shape : "", a->type, shapes[width]);
  return ABBE_OK;
}

/* Where its numbers lie, stride apart; nowhere: they are zeros. */
static abbe_result locate(abbe_gltf *g, accessor *a) {
  const size_t size = a->width * size_of(a->type);
  a->stride = size;
  if (a->count == 0 || cJSON_GetObjectItemCaseSensitive(a->item, "bufferView") == NULL)
    return ABBE_OK;
  ABBE_TRY(find_bytes(g, a->item, a->offset, size, &a->stride, &a->bytes));
  if (a->count - 1 > (((size_t)1 << 40) - size) / a->stride)
    return abbe_gltf_fail(g, ABBE_SCHEMA, "an accessor has %zu elements %zu bytes apart", a->count,
                          a->stride);
  return find_bytes(g, a->item, a->offset, (a->count - 1) * a->stride + size, NULL, &a->bytes);
}

static void take(const accessor *a, double *out) {
  for (size_t i = 0; i < a->count && a->bytes != NULL; i++)
    for (size_t k = 0; k < a->width; k++)
      out[i * a->width + k] =
          value_at(a->bytes + i * a->stride + k * size_of(a->type), a->type, a->normalised);
}

/* Those that other ones are put in place of. */
static abbe_result take_sparse(abbe_gltf *g, const accessor *a, double *out) {
  const cJSON *sparse = cJSON_GetObjectItemCaseSensitive(a->item, "sparse");
  const cJSON *where = cJSON_GetObjectItemCaseSensitive(sparse, "indices");
  const cJSON *what = cJSON_GetObjectItemCaseSensitive(sparse, "values");
  size_t count = 0, type = 0, offset[2] = {0};
  const char *index = NULL, *value = NULL;
  if (sparse == NULL) return ABBE_OK;
  ABBE_TRY(abbe_gltf_whole(g, sparse, "count", "a sparse accessor", 0, &count));
  ABBE_TRY(abbe_gltf_whole(g, where, "componentType", "sparse indices", 0, &type));
  ABBE_TRY(abbe_gltf_whole(g, where, "byteOffset", "sparse indices", 0, &offset[0]));
  ABBE_TRY(abbe_gltf_whole(g, what, "byteOffset", "sparse values", 0, &offset[1]));
  if (count == 0) return ABBE_OK;
  const size_t size = size_of(type), own = a->width * size_of(a->type);
  if (count > a->count || size == 0 || type == FLOAT ||
      cJSON_GetObjectItemCaseSensitive(where, "bufferView") == NULL ||
      cJSON_GetObjectItemCaseSensitive(what, "bufferView") == NULL)
    return abbe_gltf_fail(g, ABBE_SCHEMA, "a sparse accessor is not well formed");
  ABBE_TRY(find_bytes(g, where, offset[0], count * size, NULL, &index));
  ABBE_TRY(find_bytes(g, what, offset[1], count * own, NULL, &value));
  for (size_t i = 0; i < count; i++) {
    const double at = value_at(index + i * size, type, false);
    if (!(at >= 0 && at < (double)a->count))
      return abbe_gltf_fail(g, ABBE_SCHEMA, "a sparse accessor of %zu elements replaces number %g",
                            a->count, at);
    for (size_t k = 0; k < a->width; k++)
      out[(size_t)at * a->width + k] =
          value_at(value + i * own + k * size_of(a->type), a->type, a->normalised);
  }
  return ABBE_OK;
}

abbe_result abbe_gltf_values(abbe_gltf *g, const cJSON *attributes, const char *key, size_t width,
                             double **out, size_t *count) {
  const cJSON *item;
  accessor a;
  *out = NULL;
  *count = 0;
  abbe_result result =
      abbe_gltf_reference(g, attributes, key, "a mesh or node", &g->accessors, &item);
  if (result != ABBE_OK || item == NULL) return result;
  result = read_accessor(g, item, key, width, &a);
  if (result == ABBE_OK) result = locate(g, &a);
  if (result == ABBE_OK) result = abbe_gltf_charge(g, a.count, width);
  if (result != ABBE_OK) return result;
  if (a.bytes == NULL && a.count > ABBE_GLTF_VALUES_OF_NOTHING / width)
    return abbe_gltf_fail(g, ABBE_UNSUPPORTED,
                          "the accessor of '%s' has %zu elements and no 'bufferView'; at the most "
                          "%zu are read",
                          key, a.count, ABBE_GLTF_VALUES_OF_NOTHING / width);
  *out = calloc(a.count * width + 1, sizeof **out);
  if (*out == NULL) return no_memory(g);
  *count = a.count;
  take(&a, *out);
  result = take_sparse(g, &a, *out);
  if (result == ABBE_OK) return ABBE_OK;
  free(*out);
  *out = NULL;
  *count = 0;
  return result;
}

abbe_result abbe_gltf_charge(abbe_gltf *g, size_t count, size_t width) {
  const size_t most = ABBE_GLTF_VALUES + ABBE_GLTF_VALUES_A_BYTE * g->loaded;
  if (count > (most - g->values) / width)
    return abbe_gltf_fail(g, ABBE_UNSUPPORTED,
                          "its accessors, instances and nodes make more than the %zu numbers that "
                          "files of %zu bytes may",
                          most, g->loaded);
  g->values += count * width;
  return ABBE_OK;
}

void abbe_gltf_free(abbe_gltf *g) {
  const abbe_gltf_list lists[] = {g->nodes,     g->meshes, g->materials,
                                  g->accessors, g->views,  g->buffers};
  for (size_t i = 0; i < g->buffers.count && g->buffer != NULL; i++) free(g->buffer[i].owned);
  free(g->buffer);
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) free(lists[i].item);
  cJSON_Delete(g->json.root);
}
