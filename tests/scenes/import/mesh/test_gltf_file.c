/* A tetrahedron of sides 1, 2 and 3, in all the ways that glTF has for its numbers. */
#include "tests/scenes/import/mesh/meshes.h"

#include <unistd.h>

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5125, FLOAT };

#define INDICES "\0\0\2\0\1\0\0\0\1\0\3\0\0\0\3\0\2\0\1\0\2\0\3\0"
enum { INDEX_BYTES = 24 };

typedef struct wish {
  const char *node, *mesh, *primitive, *attributes, *root; /* more of what stands there */
  const char *uri; /* of the buffer, whose bytes are written there; NULL: base64 */
  int type;        /* of the positions */
  bool normalised, binary;
  double unit, step; /* positions are multiples of unit; bytes between them */
  const char *more;  /* accessors and views behind those of indices and positions */
  const char *more_views;
  const void *bytes;
  size_t size;
} wish;

static void put(unsigned char *at, double value, int type) {
  const float narrow = (float)value;
  uint32_t bits = (uint32_t)(int32_t)lrint(value);
  if (type == FLOAT) memcpy(&bits, &narrow, sizeof bits);
  const int size = type <= UNSIGNED_BYTE ? 1 : type <= UNSIGNED_SHORT ? 2 : 4;
  for (int i = 0; i < size; i++) at[i] = (unsigned char)(bits >> 8 * i);
}

static void encode(const unsigned char *data, size_t size, char *out) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < size; i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; k++) bits = bits << 8 | (i + k < size ? data[i + k] : 0);
    for (size_t k = 0; k < 4; k++)
      *out++ = k < 2 || i + k - 1 < size ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  *out = '\0';
}

static size_t make(const wish *w, char *out) {
  static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  unsigned char data[1024] = {0};
  char coded[2048], json[4096];
  const int type = w->type ? w->type : FLOAT, step = w->step > 0 ? (int)w->step : 12;
  const double unit = w->unit > 0 ? w->unit : 1;
  const int size = type <= UNSIGNED_BYTE ? 1 : type <= UNSIGNED_SHORT ? 2 : 4;
  size_t used = INDEX_BYTES + 4 * (size_t)step;
  memcpy(data, INDICES, INDEX_BYTES);
  for (int v = 0; v < 4; v++)
    for (int k = 0; k < 3; k++)
      put(data + INDEX_BYTES + v * step + k * size, corner[v][k] / unit, type);
  if (w->size > 0) memcpy(data + used, w->bytes, w->size);
  used += w->size;
  encode(data, used, coded);
  if (w->uri != NULL) {
    FILE *file = fopen("t gltf%1.bin", "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, used, file), used);
    fclose(file);
  }
#define OR(text) (text ? text : "")
  const int length = snprintf(
      json, sizeof json,
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
      "\"mesh\":0%s}],\"meshes\":[{\"primitives\":[{\"indices\":0,\"attributes\":{\"POSITION\":1%s}"
      "%s}]%s}],\"accessors\":[{\"bufferView\":0,\"componentType\":5123,\"count\":12,\"type\":"
      "\"SCALAR\"},{\"bufferView\":1,\"componentType\":%d,\"count\":4,\"type\":\"VEC3\","
      "\"normalized\":%s}%s],\"bufferViews\":[{\"buffer\":0,\"byteLength\":24},{\"buffer\":0,"
      "\"byteOffset\":24,\"byteLength\":%d,\"byteStride\":%d}%s],\"buffers\":[{\"byteLength\":%zu%"
      "s%s%s}]%s}",
      OR(w->node), OR(w->attributes), OR(w->primitive), OR(w->mesh), type,
      w->normalised ? "true" : "false", OR(w->more), 4 * step, step, OR(w->more_views), used,
      w->binary ? ""
      : w->uri  ? ",\"uri\":\""
                : ",\"uri\":\"data:application/octet-stream;base64,",
      w->binary ? ""
      : w->uri  ? w->uri
                : coded,
      w->binary ? "" : "\"", OR(w->root));
  assert_true(length > 0 && (size_t)length < sizeof json);
  if (!w->binary) {
    memcpy(out, json, (size_t)length);
    return (size_t)length;
  }
  const size_t padded = ((size_t)length + 3) / 4 * 4, whole = 28 + padded + used;
  unsigned char *at = (unsigned char *)out;
  memset(at, ' ', whole);
  memcpy(at, "glTF", 4);
  put(at + 4, 2, UNSIGNED_INT);
  put(at + 8, (double)whole, UNSIGNED_INT);
  put(at + 12, (double)padded, UNSIGNED_INT);
  memcpy(at + 16, "JSON", 4);
  memcpy(at + 20, json, (size_t)length);
  put(at + 20 + padded, (double)used, UNSIGNED_INT);
  memcpy(at + 24 + padded, "BIN", 4);
  memcpy(at + 28 + padded, data, used);
  return whole;
}

/* With y up, as the file has it. */
static abbe_result read_turned(const char *path, const void *data, size_t size, abbe_mesh *out) {
  const abbe_result result = test_read(abbe_gltf_read, path, NULL, data, size, out);
  for (size_t v = 0; result == ABBE_OK && v < out->vertex_count; v++) {
    double *const turned[] = {out->position[v], out->normal[v]};
    for (int i = 0; i < 2; i++) {
      const double y = turned[i][1];
      turned[i][1] = turned[i][2];
      turned[i][2] = -y;
    }
  }
  return result;
}

static abbe_result read_wish(const wish *w, abbe_mesh *out) {
  static char data[8192];
  const size_t size = make(w, data);
  return read_turned(w->binary ? "t.glb" : "t.gltf", data, size, out);
}

static void assert_reads(const wish *w, double size, double shift, double tolerance) {
  abbe_mesh m;
  OK(read_wish(w, &m));
  assert_tetrahedron(&m, size, shift, tolerance);
}

/* The tetrahedron is 1 wide, 2 high along glTF's y and 3 deep. */
TEST(meshes_stand) {
  static char data[8192];
  abbe_mesh_report r;
  const size_t size = make(&(wish){.type = FLOAT}, data);
  MADE(abbe_mesh, m, test_read(abbe_gltf_read, "t.gltf", NULL, data, size, &m));
  OK(abbe_mesh_check(&m, &r, &error));
  assert_near(r.volume, 1, 1e-12); /* not mirrored */
  static const double min[] = {0, -3, 0}, max[] = {1, 0, 2};
  for (int k = 0; k < 3; k++) {
    assert_near(r.min[k], min[k], 0);
    assert_near(r.max[k], max[k], 0);
  }
}

TEST(numbers_are_read_of_every_kind) {
  static const wish wishes[] = {
      {.type = FLOAT},
      {.type = FLOAT, .binary = true},
      {.type = FLOAT, .step = 28},
      {.type = UNSIGNED_SHORT, .unit = 1e-3, .step = 8, .node = ",\"scale\":[0.001,0.001,0.001]"},
      {.type = SHORT, .unit = 1e-3, .step = 8, .node = ",\"scale\":[0.001,0.001,0.001]"},
      {.type = BYTE, .unit = 0.025, .step = 4, .node = ",\"scale\":[0.025,0.025,0.025]"},
      FIELDS(.type = UNSIGNED_BYTE, .unit = 0.0125, .step = 4,
             .node = ",\"scale\":[0.0125,0.0125,0.0125]"),
      FIELDS(.type = BYTE, .normalised = true, .unit = 3 / 126.0, .step = 4,
             .node = ",\"scale\":[3.0238095238095237,3.0238095238095237,3.0238095238095237]"),
      FIELDS(.type = UNSIGNED_BYTE, .normalised = true, .unit = 3 / 255.0, .step = 4,
             .node = ",\"scale\":[3,3,3]"),
      FIELDS(.type = SHORT, .normalised = true, .unit = 3 / 32766.0, .step = 8,
             .node = ",\"scale\":[3.00009155831,3.00009155831,3.00009155831]"),
      FIELDS(.type = UNSIGNED_SHORT, .normalised = true, .unit = 3 / 65535.0, .step = 8,
             .node = ",\"scale\":[3,3,3]"),
  };
  for (size_t i = 0; i < sizeof wishes / sizeof *wishes; i++) assert_reads(&wishes[i], 1, 0, 1e-6);
}

TEST(nodes_place_meshes) {
  static const wish placed[] = {
      {.node = ",\"translation\":[5,0,0],\"scale\":[2,2,2]"},
      {.node = ",\"matrix\":[2,0,0,0,0,2,0,0,0,0,2,0,5,0,0,1]"},
      {.node = ",\"children\":[1],\"name\":\"x\"},{\"translation\":[1,0,0]"}};
  for (int i = 0; i < 2; i++) assert_reads(&placed[i], 2, 5, 1e-12);
  assert_reads(&placed[2], 1, 0, 0);
  /* a mirror turns faces, so that they look outwards again */
  abbe_mesh_report r;
  MADE(abbe_mesh, m, read_wish(&(wish){.node = ",\"scale\":[-1,1,1]"}, &m));
  OK(abbe_mesh_check(&m, &r, &error));
  assert_near(r.volume, 1, 1e-12);
  assert_near(r.min[0], -1, 0);
  abbe_mesh_free(&m);
  /* a quarter turn about z takes x to y */
  OK(read_wish(&(wish){.node = ",\"rotation\":[0,0,0.7071067811865476,0.7071067811865476]"}, &m));
  OK(abbe_mesh_check(&m, &r, &error));
  assert_near(r.min[0], -2, 1e-12);
  assert_near(r.max[1], 1, 1e-12);
}

#define VEC(width, type, count)                                                                    \
  "{\"componentType\":" #type ",\"count\":" #count ",\"type\":\"VEC" #width "\",\"bufferView\":"

TEST(instances_are_read) {
  const float place[6] = {0, 0, 0, 10, 0, 0}, size[6] = {1, 1, 1, 2, 2, 2};
  const signed char turn[8] = {0, 0, 0, 127, 0, 0, 127, 0}; /* the second by half a turn about z */
  unsigned char bytes[56];
  memcpy(bytes, place, 24);
  memcpy(bytes + 24, size, 24);
  memcpy(bytes + 48, turn, 8);
  const wish w =
      FIELDS(.node = ",\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
                     "\"TRANSLATION\":2,\"SCALE\":3,\"ROTATION\":4}}}",
             .more = "," VEC(3, 5126, 2) "2}," VEC(3, 5126, 2) "3}," VEC(
                 4, 5120, 2) "4,\"normalized\":true}",
             .more_views =
                 ",{\"buffer\":0,\"byteOffset\":72,\"byteLength\":24},{\"buffer\":0,\"byteOffset\":"
                 "96,\"byteLength\":24},{\"buffer\":0,\"byteOffset\":120,\"byteLength\":8}",
             .root = ",\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\"]", .bytes = bytes,
             .size = sizeof bytes);
  abbe_mesh_report r;
  MADE(abbe_mesh, m, read_wish(&w, &m));
  assert_int_equal(m.face_count, 8);
  OK(abbe_mesh_check(&m, &r, &error));
  assert_near(r.volume, 1 + 8, 1e-9);
  assert_int_equal(r.shells, 2);
  assert_near(r.max[0], 10, 1e-9);
  assert_near(r.min[1], -4, 1e-9);
}

/* The last corner stands elsewhere. */
TEST(sparse_numbers_are_read) {
  unsigned char bytes[16] = {3};
  const float away[3] = {0, 0, 6};
  memcpy(bytes + 4, away, sizeof away);
  const wish w = FIELDS(.more = ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":2,"
                                "\"componentType\":5121},\"values\":{\"bufferView\":3}}",
                        .more_views = ",{\"buffer\":0,\"byteOffset\":72,\"byteLength\":1},{"
                                      "\"buffer\":0,\"byteOffset\":76,\"byteLength\":12}",
                        .bytes = bytes, .size = sizeof bytes);
  /* it belongs to the accessor of positions, whose object is closed before */
  static char data[8192];
  abbe_mesh_report r;
  size_t size = make(&w, data);
  data[size] = '\0';
  char *sparse = strstr(data, "},\"sparse\""), *end = strstr(data, "],\"bufferViews\"");
  assert_true(sparse != NULL && end != NULL);
  memmove(sparse, sparse + 1, (size_t)(end - sparse) - 1);
  end[-1] = '}';
  MADE(abbe_mesh, m, read_turned("t.gltf", data, size, &m));
  OK(abbe_mesh_check(&m, &r, &error));
  assert_near(r.volume, 2, 1e-12);
}

/* Positions that only an extension has are no zeros. */
TEST(compressed_meshes_are_refused) {
  static char data[8192];
  abbe_mesh m;
  const size_t size = make(
      &(wish){.primitive = ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0}}"},
      data);
  data[size] = '\0';
  char *view = strstr(data, "\"bufferView\":1,");
  assert_non_null(view);
  memset(view, ' ', 15);
  assert_int_equal(read_turned("t.gltf", data, size, &m), ABBE_UNSUPPORTED);
  assert_contains(last_error.text, "compressed by KHR_draco_mesh_compression");
  const size_t whole = make(&(wish){.binary = false}, data);
  data[whole] = '\0';
  char *uri = strstr(data, ",\"uri\"");
  assert_non_null(uri);
  strcpy(uri, ",\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}]}");
  assert_int_equal(read_turned("t.gltf", data, strlen(data), &m), ABBE_UNSUPPORTED);
  assert_contains(last_error.text, "meshopt_compression");
}

/* Strips turn every second triangle; a strip round a tetrahedron closes it. */
TEST(strips_and_fans_are_read) {
  static const unsigned short strip[6] = {1, 0, 3, 2, 1, 0}, fan[6] = {0, 1, 3, 2, 1};
  for (int mode = 5; mode <= 6; mode++) {
    char primitive[40], more[80];
    snprintf(primitive, sizeof primitive, ",\"mode\":%d,\"indices\":2", mode);
    snprintf(more, sizeof more,
             ",{\"bufferView\":2,\"componentType\":5123,\"count\":%d,\"type\":\"SCALAR\"}",
             mode == 5 ? 6 : 5);
    const wish w = FIELDS(.primitive = primitive, .more = more,
                          .more_views = ",{\"buffer\":0,\"byteOffset\":72,\"byteLength\":12}",
                          .bytes = mode == 5 ? (const void *)strip : fan, .size = sizeof strip);
    static char data[8192];
    abbe_mesh_report r;
    size_t size = make(&w, data);
    data[size] = '\0';
    char *first = strstr(data, "\"indices\":0,"); /* one key of the name alone */
    assert_non_null(first);
    memset(first, ' ', 12);
    MADE(abbe_mesh, m, read_turned("t.gltf", data, size, &m));
    OK(abbe_mesh_check(&m, &r, &error));
    assert_int_equal(r.flipped_edges + r.crowded_edges, 0);
    assert_int_equal(m.face_count, mode == 5 ? 4 : 3);
    assert_int_equal(r.open_edges, mode == 5 ? 0 : 3);
    if (mode == 5) assert_near(fabs(r.volume), 1, 1e-12);
  }
}

TEST(names_of_buffers_are_decoded) {
  static const char *const names[] = {"t%20gltf%251.bin", "t gltf%1.bin", "./t%20gltf%1.bin"};
  for (int i = 0; i < 3; i++) assert_reads(&(wish){.uri = names[i]}, 1, 0, 0);
  /* and are known to who loads the mesh */
  static char data[8192];
  const size_t size = make(&(wish){.uri = names[0]}, data);
  FILE *file = fopen("t_names.gltf", "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(data, 1, size, file), size);
  fclose(file);
  FREED char *others = NULL;
  MADE(abbe_mesh, m, abbe_mesh_load("t_names.gltf", ABBE_NORMALS_FLAT, &m, &others, &error));
  assert_string_equal(others, "t gltf%1.bin");
  assert_string_equal(others + strlen(others) + 1, "");
  unlink("t_names.gltf");
  unlink("t gltf%1.bin");
}

TEST(what_is_not_read_is_named) {
  static const struct {
    wish w;
    const char *words;
    abbe_result code;
  } files[] = {
      {{.root = ",\"extensionsRequired\":[\"KHR_mesh_quantization\",\"EXT_unknown_thing\"]"},
       "'EXT_unknown_thing', which is not read",
       ABBE_UNSUPPORTED},
      {{.root = ",\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]"},
       "'KHR_draco_mesh_compression', which is not read",
       ABBE_UNSUPPORTED},
      {{.primitive = ",\"targets\":[{\"POSITION\":1}]", .mesh = ",\"weights\":[1]"},
       "is morphed",
       ABBE_UNSUPPORTED},
      {{.primitive = ",\"targets\":[{\"POSITION\":1}]", .node = ",\"weights\":[0.5]"},
       "is morphed",
       ABBE_UNSUPPORTED},
      {{.node = ",\"skin\":0"}, "has a 'skin'", ABBE_UNSUPPORTED},
      {{.uri = "https://there/x.bin"}, "buffers are files beside it", ABBE_UNSUPPORTED},
      {{.uri = "not%20there.bin"}, "not there.bin", ABBE_IO},
      {{.node = ",\"children\":[0]"}, "below itself", ABBE_SCHEMA},
      {{.node = ",\"children\":[7]"}, "node", ABBE_SCHEMA},
      {{.node = ",\"matrix\":[1,2]"}, "'matrix' of a node is not 16 numbers", ABBE_SCHEMA},
      {{.attributes = ",\"NORMAL\":0"}, "the accessor of 'NORMAL' is 'SCALAR'", ABBE_SCHEMA},
      {{.attributes = ",\"NORMAL\":9"}, "'NORMAL' of a mesh or node is 9", ABBE_SCHEMA},
      {{.attributes = ",\"NORMAL\":2", .more = "," VEC(3, 5126, 5) "1}"}, "go beyond", ABBE_PARSE},
      {{.attributes = ",\"NORMAL\":2", .more = "," VEC(3, 5126, 3) "1}"},
       "all are as many",
       ABBE_SCHEMA},
      {{.attributes = ",\"NORMAL\":2",
        .more = ",{\"componentType\":5126,\"count\":1398102,\"type\":\"VEC3\"}"},
       "1398102 elements and no 'bufferView'",
       ABBE_UNSUPPORTED},
      {{.primitive = ",\"mode\":1"}, "no faces were read from it", ABBE_GEOMETRY},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    const abbe_result result = read_wish(&files[i].w, &m);
    if (result != files[i].code) fail_msg("%zu: %d (%s)", i, result, last_error.text);
    assert_contains(last_error.text, files[i].words);
    assert_contains(last_error.text, "t");
  }
  unlink("t gltf%1.bin");
  /* targets of no weight change nothing */
  assert_reads(&(wish){.primitive = ",\"targets\":[{\"POSITION\":1}]"}, 1, 0, 0);
}

TEST(cut_files_are_refused) {
  static char data[8192];
  abbe_mesh m;
  const size_t size = make(&(wish){.binary = true}, data);
  for (size_t cut = 1; cut < size; cut += cut < 200 ? 1 : 13)
    assert_int_not_equal(read_turned("t.glb", data, size - cut, &m), ABBE_OK);
}

/* A file of some kilobytes whose lists are gone through once for each of its nodes: primitives that
 * have no triangles, and weights. */
TEST(work_has_an_end) {
  static const struct {
    const char *more, *item; /* in the list that grows */
    int nodes, items;
  } files[] = {
      {"\"primitives\":[{\"mode\":0}", ",{}", 2200, 2200},
      {"\"primitives\":[{\"targets\":[]}],\"weights\":[0", ",0", 12000, 12000},
  };
  static char text[400000];
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    char *at = text;
    at += sprintf(at, "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{%s", files[i].more);
    for (int k = 0; k < files[i].items; k++) at += sprintf(at, "%s", files[i].item);
    at += sprintf(at, "]}],\"nodes\":[{}");
    for (int k = 0; k < files[i].nodes; k++) at += sprintf(at, ",{\"mesh\":0}");
    sprintf(at, "]}");
    assert_int_equal(read_turned("t.gltf", text, strlen(text), &m), ABBE_UNSUPPORTED);
    assert_contains(last_error.text, "make more than the");
  }
}
