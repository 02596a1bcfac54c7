/* What a glTF file says under each of its keys: one file of all that is read, in which one text is
 * put in the place of another. */
#include "tests/scenes/import/mesh/meshes.h"

#include "base/file.h"
#include "base/maths.h"
#include "scenes/import/mesh/gltf_data.h"

#include <unistd.h>

static char *whole;
static size_t whole_size;

static void load_whole(void) {
  OK(abbe_file_read(ABBE_SOURCE_DIR "/tests/fuzz/corpus/mesh_file/gltf_instances", 1 << 16, &whole,
                    &whole_size, &error));
}

static void free_whole(void) {
  free(whole);
}

GROUP(load_whole, free_whole);

/* The file with `to` in the place of the first `from`. */
static const char *changed(const char *from, const char *to) {
  const char *text = whole + 1, *at = strstr(text, from); /* its first byte picks the reader */
  if (at == NULL) fail_msg("the file has no %s", from);
  return printed("%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
}

static abbe_result read_changed(const char *from, const char *to, abbe_mesh *out) {
  const char *text = changed(from, to);
  return test_read(abbe_gltf_read, "t.gltf", NULL, text, strlen(text), out);
}

#define ACCESSORS "\"accessors\":["
#define INDICES_VIEW "{\"bufferView\":1,"
#define SPARSE "\"sparse\":{\"count\":1"
#define SPARSE_INDICES "{\"bufferView\":3,\"componentType\":5121}"
#define SPARSE_VALUES "{\"bufferView\":4}"
#define VIEW_OF_INDICES "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}"
#define POSITION "{\"POSITION\":0}"
#define TRANSLATION "{\"TRANSLATION\":2}"
#define SCENES ",\"scenes\":[{\"nodes\":[0]}],\"scene\":0"
#define LAST "\"type\":\"VEC3\"}]"

TEST(what_a_key_may_not_be) {
  static const struct {
    const char *from, *to, *words;
    abbe_result code;
  } rows[] = {
      {"\"count\":4", "\"count\":-1", "'count' of an accessor is no whole number", ABBE_SCHEMA},
      {"\"count\":4", "\"count\":\"four\"", "'count' of an accessor is no whole", ABBE_SCHEMA},
      {"\"componentType\":5121,\"normalized\"", "\"componentType\":0.5,\"normalized\"",
       "'componentType' of an accessor is no whole number", ABBE_SCHEMA},
      {INDICES_VIEW, INDICES_VIEW "\"byteOffset\":-1,", "'byteOffset' of an accessor", ABBE_SCHEMA},
      {INDICES_VIEW, INDICES_VIEW "\"byteOffset\":100,", "go beyond the 104 bytes of buffer 0",
       ABBE_PARSE},
      {INDICES_VIEW "\"componentType\":5123,\"count\":12",
       INDICES_VIEW "\"componentType\":5123,\"count\":1099511627776", "elements 2 bytes apart",
       ABBE_SCHEMA},
      {INDICES_VIEW "\"componentType\":5123,\"count\":12",
       "{\"bufferView\":0,\"byteOffset\":4,\"componentType\":5120,\"count\":4", "an index is -1",
       ABBE_GEOMETRY},
      {VIEW_OF_INDICES, "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":-24}",
       "'byteLength' of a buffer view", ABBE_SCHEMA},
      {VIEW_OF_INDICES, "{\"buffer\":0,\"byteOffset\":-48,\"byteLength\":24}",
       "'byteOffset' of a buffer view", ABBE_SCHEMA},
      {"\"byteStride\":4", "\"byteStride\":\"wide\"", "'byteStride' of a buffer view", ABBE_SCHEMA},
      {VIEW_OF_INDICES, "{\"buffer\":1}", "'buffer' of a buffer view is 1, and the file has 1",
       ABBE_SCHEMA},
      {"\"bufferView\":1,", "\"bufferView\":-1,", "'bufferView' of an accessor", ABBE_SCHEMA},
      {VIEW_OF_INDICES, "{\"buffer\":0,\"byteOffset\":105,\"byteLength\":24}", "go beyond",
       ABBE_PARSE},
      {VIEW_OF_INDICES, "{}", "names no 'buffer'", ABBE_SCHEMA},
      {"}],\"bufferViews\":[", "},{}],\"bufferViews\":[{\"buffer\":1,\"byteLength\":9},",
       "buffer 1 has no 'uri', and no bytes", ABBE_UNSUPPORTED},
      {"}],\"bufferViews\":[",
       "},{\"extensions\":{\"KHR_meshopt_compression\":{}}}],\"bufferViews\":[{\"buffer\":1},",
       "but those that meshopt_compression makes", ABBE_UNSUPPORTED},
      {"AAAAAP8A", "AAAA:P8A", "is not base64: ':P8A", ABBE_PARSE},
      {SPARSE, "\"sparse\":{\"count\":-1", "'count' of a sparse accessor", ABBE_SCHEMA},
      {SPARSE, "\"sparse\":{\"count\":5", "a sparse accessor is not well formed", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"bufferView\":3,\"componentType\":-1}",
       "'componentType' of sparse indices", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"bufferView\":3,\"componentType\":5126}", "not well formed", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"bufferView\":3,\"componentType\":1}", "not well formed", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"componentType\":5121}", "not well formed", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"bufferView\":3,\"byteOffset\":-1,\"componentType\":5121}",
       "'byteOffset' of sparse indices", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"bufferView\":3,\"byteOffset\":1,\"componentType\":5121}", "go beyond",
       ABBE_PARSE},
      {SPARSE_INDICES, "{\"bufferView\":0,\"byteOffset\":4,\"componentType\":5121}",
       "a sparse accessor of 4 elements replaces number 255", ABBE_SCHEMA},
      {SPARSE_INDICES, "{\"bufferView\":0,\"byteOffset\":4,\"componentType\":5120}",
       "replaces number -1", ABBE_SCHEMA},
      {SPARSE_VALUES, "{}", "not well formed", ABBE_SCHEMA},
      {SPARSE_VALUES, "{\"bufferView\":4,\"byteOffset\":-1}", "'byteOffset' of sparse values",
       ABBE_SCHEMA},
      {SPARSE_VALUES, "{\"bufferView\":4,\"byteOffset\":2}", "go beyond", ABBE_PARSE},
      {"\"asset\"", "\"extensionsRequired\":[7],\"asset\"", "requires the extension '?'",
       ABBE_UNSUPPORTED},
      {"\"version\":\"2.0\"", "\"version\":2", "does not say its version", ABBE_SCHEMA},
      {POSITION, "{\"POSITION\":-1}", "'POSITION' of a primitive is no whole", ABBE_SCHEMA},
      {POSITION, "{\"POSITION\":0,\"TEXCOORD_0\":1}", "the accessor of 'TEXCOORD_0' is 'SCALAR'",
       ABBE_SCHEMA},
      {"\"indices\":1}", "\"indices\":1,\"mode\":-1}", "'mode' of a primitive", ABBE_SCHEMA},
      {"\"indices\":1}", "\"indices\":1,\"mode\":7}", "no faces were read from it", ABBE_GEOMETRY},
      {"\"indices\":1}", "\"indices\":1,\"material\":-1}", "'material' of a primitive",
       ABBE_SCHEMA},
      {"\"scale\":[1,2,-3]", "\"translation\":[1,2]", "'translation' of a node is not 3 numbers",
       ABBE_SCHEMA},
      {"\"scale\":[1,2,-3]", "\"scale\":7", "'scale' of a node is not 3 numbers", ABBE_SCHEMA},
      {"\"rotation\":[0,0,1,0]", "\"rotation\":[0,0,1]", "'rotation' of a node is not 4 numbers",
       ABBE_SCHEMA},
      {"\"rotation\":[0,0,1,0]", "\"rotation\":[0,0,1,\"x\"]", "'rotation' of a node is not 4",
       ABBE_SCHEMA},
      {"\"mesh\":0", "\"mesh\":-1", "'mesh' of a node", ABBE_SCHEMA},
      {TRANSLATION, "{\"TRANSLATION\":1}", "the accessor of 'TRANSLATION'", ABBE_SCHEMA},
      {TRANSLATION, "{\"ROTATION\":2}", "the accessor of 'ROTATION' is 'VEC3'", ABBE_SCHEMA},
      {TRANSLATION, "{\"SCALE\":1}", "the accessor of 'SCALE' is 'SCALAR'", ABBE_SCHEMA},
      {TRANSLATION, "{\"TRANSLATION\":2,\"SCALE\":0}", "2 places, 0 rotations and 4 sizes",
       ABBE_SCHEMA},
      {TRANSLATION, "{}", "has none of TRANSLATION, ROTATION and SCALE", ABBE_SCHEMA},
      {"\"children\":[1]", "\"children\":[\"x\"]", "and the file has 2", ABBE_SCHEMA},
      {"\"children\":[1]", "\"children\":[-1]", "and the file has 2", ABBE_SCHEMA},
      {"\"children\":[1]", "\"children\":[2e9]", "and the file has 2", ABBE_SCHEMA},
      {"\"children\":[1]", "\"children\":[1,1,1]", "node 1 is below two nodes", ABBE_SCHEMA},
      {"\"nodes\":[0]", "\"nodes\":[\"x\"]", "and the file has 2", ABBE_SCHEMA},
      {"\"nodes\":[0]", "\"nodes\":[-1]", "and the file has 2", ABBE_SCHEMA},
      {"\"nodes\":[0]", "\"nodes\":[2e9]", "and the file has 2", ABBE_SCHEMA},
      {"\"nodes\":[0]", "\"nodes\":[0,0,0]", "node 0 is below two nodes", ABBE_SCHEMA},
      {"\"scene\":0", "\"scene\":-1", "'scene' of the file is no whole number", ABBE_SCHEMA},
      {"\"scene\":0", "\"scene\":1", "'scene' of the file is 1, and it has 1", ABBE_SCHEMA},
      {"\"scene\":0", "\"scene\":4294967296", "'scene' of the file is 4294967296", ABBE_SCHEMA},
      {SCENES, ",\"scenes\":[]", "'scene' of the file is 0, and it has 0", ABBE_SCHEMA},
      {SCENES, ",\"scene\":1", "'scene' of the file is 1, and it has 0", ABBE_SCHEMA},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_mesh m;
    const abbe_result result = read_changed(rows[i].from, rows[i].to, &m);
    if (result != rows[i].code || strstr(last_error.text, rows[i].words) == NULL)
      fail_msg("%s: %d: %s", rows[i].to, (int)result, last_error.text);
    assert_contains(last_error.text, "t.gltf: ");
    assert_null(m.position);
  }
}

/* Two tetrahedra in a row, unless instances are others. */
TEST(what_a_key_may_be) {
  static const struct {
    const char *from, *to;
    size_t faces;
    bool alike; /* at the very places of the file as it is */
  } rows[] = {
      {"AP8AAAAA/w", "AP8AAAAA_w", 8, true},
      {SPARSE, "\"sparse\":{\"count\":0", 8, false},
      {ACCESSORS "{\"bufferView\":0,", ACCESSORS "{", 8, false}, /* the others are zeros */
      {"\"scale\":[1,2,-3]", "\"rotation\":[0,0,0,0],\"scale\":[1,2,-3]", 8, true},
      {SCENES, "", 8, true},
      {"\"children\":[1]", "\"children\":[1],\"mesh\":0", 12, false},
      {POSITION, "{\"POSITION\":0,\"NORMAL\":0}", 8, true},
      {TRANSLATION, "{\"SCALE\":2}", 8, false},
  };
  MADE(abbe_mesh, own, read_changed("", "", &own));
  assert_int_equal(own.face_count, 8);
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_mesh, m) = {0};
    if (read_changed(rows[i].from, rows[i].to, &m) != ABBE_OK)
      fail_msg("%s: %s", rows[i].to, last_error.text);
    assert_int_equal(m.face_count, rows[i].faces);
    if (!rows[i].alike) continue;
    assert_int_equal(m.vertex_count, own.vertex_count);
    assert_memory_equal(m.position, own.position, own.vertex_count * sizeof *own.position);
  }
}

/* Rows of a picture go downwards; instances by turns alone; a flat node has no normals. */
TEST(accessors_that_the_file_does_not_use) {
  static const char uv[] =
      "{\"bufferView\":0,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC2\"}";
  static const char turn[] =
      "{\"bufferView\":0,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"}";
  const char *text = changed(LAST, printed("\"type\":\"VEC3\"},%s,%s]", uv, turn));
  char *kept = whole;
  whole = strdup(printed("\3%s", text));
  MADE(abbe_mesh, m, read_changed(POSITION, "{\"POSITION\":0,\"TEXCOORD_0\":3}", &m));
  static const double own[4][2] = {{0, 1}, {1, 1}, {0, 0}, {0, 1}};
  for (size_t v = 0; v < 4; v++)
    for (int k = 0; k < 2; k++) assert_near(m.uv[v][k], own[v][k], 0);
  abbe_mesh_free(&m);
  assert_int_equal(read_changed(POSITION, "{\"POSITION\":0,\"NORMAL\":2}", &m), ABBE_SCHEMA);
  assert_contains(last_error.text, "4 positions, 2 normals and 0 texture coordinates");
  OK(read_changed(TRANSLATION, "{\"ROTATION\":4}", &m));
  assert_int_equal(m.face_count, 16); /* four turns */
  abbe_mesh_free(&m);
  text = changed("\"count\":4,\"type\":\"VEC2\"", "\"count\":3,\"type\":\"VEC2\"");
  free(whole);
  whole = strdup(printed("\3%s", text));
  assert_int_equal(read_changed(POSITION, "{\"POSITION\":0,\"TEXCOORD_0\":3}", &m), ABBE_SCHEMA);
  assert_contains(last_error.text, "4 positions, 0 normals and 3 texture coordinates");
  free(whole);
  whole = kept;
  text = changed(POSITION, "{\"POSITION\":0,\"NORMAL\":0}");
  whole = strdup(printed("\3%s", text));
  OK(read_changed("\"scale\":[1,2,-3]", "\"scale\":[1,0,-3]", &m));
  for (size_t v = 0; v < m.vertex_count; v++) assert_near(abbe_vector_length(m.normal[v]), 0, 0);
  abbe_mesh_free(&m);
  free(whole);
  whole = kept;
}

/* Of base64 there are two alphabets. */
TEST(digits_of_both_alphabets) {
  MADE(abbe_mesh, one, read_changed("AAAAAP8A", "AAAA+P8A", &one));
  MADE(abbe_mesh, other, read_changed("AAAAAP8A", "AAAA-P8A", &other));
  assert_int_equal(one.vertex_count, other.vertex_count);
  assert_memory_equal(one.position, other.position, one.vertex_count * sizeof *one.position);
}

TEST(materials_without_a_name) {
  abbe_mesh m;
  const char *text =
      changed("\"indices\":1}]}],", "\"indices\":1,\"material\":0}]}],\"materials\":[{}],");
  assert_int_equal(test_read(abbe_gltf_read, "t.gltf", "stone", text, strlen(text), &m),
                   ABBE_GEOMETRY);
  assert_contains(last_error.text, "no triangle is of a material called 'stone'");
}

/* Children without a scene: what they name is nobody's concern until it is walked. */
TEST(nodes_without_a_scene) {
  static const char *const none[] = {"\"x\"", "-1", "99"};
  const char *text = changed(SCENES, "");
  char *kept = whole;
  abbe_mesh m;
  whole = strdup(printed("\3%s", text));
  for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
    assert_int_equal(read_changed("\"children\":[1]", printed("\"children\":[%s]", none[i]), &m),
                     ABBE_SCHEMA);
    assert_contains(last_error.text, "and the file has 2");
  }
  free(whole);
  whole = kept;
}

TEST(nodes_may_be_a_thousand_deep) {
  for (int deep = 1000; deep <= 1001; deep++) {
    static char text[64000];
    abbe_mesh m;
    char *at = text;
    at += sprintf(at, "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (int i = 1; i <= deep; i++) at += sprintf(at, "{\"children\":[%d]},", i);
    sprintf(at, "{}]}");
    const abbe_result result = test_read(abbe_gltf_read, "t.gltf", NULL, text, strlen(text), &m);
    assert_int_equal(result, deep == 1000 ? ABBE_GEOMETRY : ABBE_SCHEMA);
    assert_contains(last_error.text, deep == 1000 ? "no faces" : "node 1001 is too deep below");
  }
}

/* A name may be written as it is, though it reads as if it were coded. */
TEST(names_that_are_not_coded) {
  FILE *file = fopen("t%6cx%20.bin", "wb");
  assert_non_null(file);
  assert_int_equal(fwrite("abc", 1, 3, file), 3);
  fclose(file);
  static const char *const names[] = {"t%6cx%20.bin", "t%256cx%2520.bin", "t%6Cx%20.bin",
                                      "t%256cx%2G%g0%00%:.bin"};
  static const char *const says[] = {"go beyond the 3 bytes", "go beyond the 3 bytes", "tlx .bin",
                                     "t%6cx%2G%g0%00%:.bin"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    abbe_mesh m;
    const char *text = printed("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"%s\"}],"
                               "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],\"accessors\":"
                               "[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"
                               "\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"attributes\":"
                               "{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}]}",
                               names[i]);
    assert_int_equal(test_read(abbe_gltf_read, "t.gltf", NULL, text, strlen(text), &m),
                     i < 2 ? ABBE_PARSE : ABBE_IO);
    assert_contains(last_error.text, says[i]);
  }
  assert_int_equal(unlink("t%6cx%20.bin"), 0);
}

/* So many numbers, and none more: files of next to nothing that ask for many. */
static abbe_result ask_for(size_t count, abbe_mesh *out) {
  enum { OTHERS = 32 };
  char nodes[4000], *at = nodes;
  for (int i = 0; i <= OTHERS; i++)
    at += sprintf(at,
                  ",{\"mesh\":1,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":"
                  "{\"TRANSLATION\":%d}}}}",
                  i < OTHERS ? 2 : 3);
  /* the count is always as long, for bytes of the file count as well */
  const char *text = printed(
      "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"uri\":\"data:;base64,"
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],\"bufferViews\":[{\"buffer\":0,"
      "\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
      "\"type\":\"VEC3\"},{},{\"componentType\":5126,\"count\":1398101,\"type\":\"VEC3\"},"
      "{\"componentType\":5126,\"count\":%7zu,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{"
      "\"attributes\":{\"POSITION\":0}}]},{\"primitives\":[]}],\"nodes\":[{}%s,{\"mesh\":0}]}",
      count, nodes);
  return test_read(abbe_gltf_read, "t.gltf", NULL, text, strlen(text), out);
}

TEST(numbers_have_an_end) {
  size_t fits = 1, too_many = 10000;
  while (too_many - fits > 1) {
    const size_t middle = (fits + too_many) / 2;
    OWNED(abbe_mesh, m) = {0};
    *(ask_for(middle, &m) == ABBE_OK ? &fits : &too_many) = middle;
  }
  MADE(abbe_mesh, m, ask_for(fits, &m));
  assert_int_equal(m.face_count, 1);
  /* each of the steps after which nothing is left: a primitive, its numbers, its triangles */
  for (size_t count = too_many; count < too_many + (SANITIZED ? 2 : 20); count++) {
    abbe_mesh none;
    assert_int_equal(ask_for(count, &none), ABBE_UNSUPPORTED);
    assert_contains(last_error.text, "make more than the");
  }
}

TEST(json_has_an_end) {
  const size_t size = ABBE_GLTF_MOST_JSON + 1;
  char *text = calloc(size, 1);
  abbe_gltf_json json;
  assert_non_null(text);
  REFUSED(ABBE_UNSUPPORTED, "its JSON has 67108865 bytes, the limit is 67108864",
          abbe_gltf_json_parse("t", text, size, &json, &error));
  REFUSED(ABBE_PARSE, "t: its JSON is not well formed",
          abbe_gltf_json_parse("t", text, size - 1, &json, &error));
  free(text);
}
