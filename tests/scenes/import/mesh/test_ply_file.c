#include "tests/scenes/import/mesh/meshes.h"

#include "base/maths.h"

#include <unistd.h>

#define HEADER(format)                                                                             \
  "ply\nformat " format " 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty uchar red\n"      \
  "property float x\nproperty double y\nproperty short z\nelement other 1\n"                       \
  "property list uchar uint what\nelement tristrips 1\nproperty list int int vertex_indices\n"     \
  "end_header\n"

/* Round its four faces in two strips. */
static const int strip[] = {0, 2, 1, 3, 0, 2, -1, 1, 0, 0, 0};
enum { LENGTH = 6, CORNERS = 4 };
static const double corner[CORNERS][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static abbe_result parse(const char *data, size_t size, abbe_mesh *out) {
  return test_read(abbe_ply_read, "t.ply", NULL, data, size, out);
}

static void assert_is_the_tetrahedron(abbe_mesh *m) {
  abbe_mesh_report r;
  assert_int_equal(m->vertex_count, 4);
  assert_int_equal(m->face_count, 4);
  for (int v = 0; v < CORNERS; v++)
    for (int k = 0; k < 3; k++) assert_near(m->position[v][k], corner[v][k], 0);
  OK(abbe_mesh_check(m, &r, &error));
  assert_int_equal(r.open_edges + r.flipped_edges + r.crowded_edges, 0);
  assert_near(r.volume, 1.0 / 6, 1e-15);
  abbe_mesh_free(m);
}

TEST(text_is_read) {
  abbe_mesh m;
  char text[1024];
  snprintf(text, sizeof text, "%s", HEADER("ascii"));
  for (int v = 0; v < CORNERS; v++)
    snprintf(text + strlen(text), sizeof text - strlen(text), "%d %g %g %g\n", 200 + v,
             corner[v][0], corner[v][1], corner[v][2]);
  strcat(text, "3 7 8\r\n9\n6");
  for (int i = 0; i < LENGTH; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text), " %d", strip[i]);
  OK(parse(text, strlen(text), &m));
  assert_is_the_tetrahedron(&m);
}

/* Bytes in the file's order, this machine's or the other. */
static void put(char **to, const void *value, size_t size, bool turned) {
  const char *from = value;
  for (size_t i = 0; i < size; i++) *(*to)++ = from[turned ? size - 1 - i : i];
}

static size_t binary(bool big, char *out) {
  const uint16_t one = 1;
  const bool turned = big == (*(const unsigned char *)&one == 1);
  strcpy(out, big ? HEADER("binary_big_endian") : HEADER("binary_little_endian"));
  char *at = out + strlen(out);
  for (int v = 0; v < CORNERS; v++) {
    const float x = (float)corner[v][0];
    const int16_t z = (int16_t)corner[v][2];
    *at++ = (char)v;
    put(&at, &x, sizeof x, turned);
    put(&at, &corner[v][1], sizeof(double), turned);
    put(&at, &z, sizeof z, turned);
  }
  const uint32_t what[2] = {7, 4000000000u};
  *at++ = 2;
  put(&at, &what[0], 4, turned);
  put(&at, &what[1], 4, turned);
  const int32_t length = LENGTH;
  put(&at, &length, 4, turned);
  for (int i = 0; i < LENGTH; i++) put(&at, &strip[i], 4, turned);
  return (size_t)(at - out);
}

TEST(both_orders_are_read_and_no_part_of_them) {
  for (int big = 0; big < 2; big++) {
    char data[1024];
    abbe_mesh m;
    const size_t size = binary(big, data);
    OK(parse(data, size, &m));
    assert_is_the_tetrahedron(&m);
    for (size_t cut = 0; cut < size; cut++) {
      assert_int_equal(parse(data, cut, &m), ABBE_PARSE);
      assert_contains(last_error.text, "t.ply: ");
      assert_null(m.face);
    }
  }
}

#define PLAIN                                                                                      \
  "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"                  \
  "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"      \
  "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n"

/* Every second triangle runs the other way; -1 begins anew; a point twice turns a corner. */
TEST(strips_alternate_and_begin_anew) {
  static const char *const strips[] = {"5 0 1 2 3 4\n", "9 0 1 2 -1 2 1 3 -1 0\n",
                                       "6 0 1 2 2 3 4\n"};
  static const size_t count[] = {3, 2, 2};
  for (int i = 0; i < 3; i++) {
    const char *text = printed(PLAIN "%s", strips[i]);
    MADE(abbe_mesh, m, parse(text, strlen(text), &m));
    assert_int_equal(m.face_count, count[i]);
    for (size_t f = 0; f < (i < 2 ? m.face_count : 1); f++) {
      double n[3];
      abbe_vector_triangle(m.position[m.face[f][0]], m.position[m.face[f][1]],
                           m.position[m.face[f][2]], n);
      assert_true(n[2] > 0);
    }
  }
}

#define FACES(more)                                                                                \
  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"                  \
  "property float z\nelement face 1\nproperty list uchar int vertex_index\n" more                  \
  "end_header\n0 0 0\n1 0 0\n0 1 0\n"

#define BODY "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"
#define FACE_LIST "element face 4\nproperty list uchar int vertex_indices\nend_header\n"

/* What programs put around vertices and faces. */
TEST(texts_of_faces_are_read) {
  static const char *const texts[] = {
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\n" FACE_LIST "0 0 0 9 9\n1 0 0\n0 2\n0 7\n0 0 3\n3 0 2 1 0 0 0\n3 0 1 3\n"
      "3 0 3 2\n3 1 2 3 8 8",
      "ply\nformat ascii 1.0\nelement vertex 4\ncomment Points\nproperty float x\n"
      "comment y follows\nproperty float y\nproperty float z\n" FACE_LIST BODY,
      "ply\nformat ascii 1.0\nelement camera 1\nproperty float focal\nelement vertex 4\n"
      "property float x\nproperty float y\nproperty float z\n" FACE_LIST "35\n" BODY,
      "ply\nformat ascii 1.0\nobj_info a\nelement face 4\nproperty uchar red\n"
      "property list uchar int vertex_index\nelement vertex 4\nproperty double z\n"
      "property double x\nproperty double y\nend_header\n1 3 0 2 1\n1 3 0 1 3\n1 3 0 3 2\n"
      "1 3 1 2 3\n0 0 0\n0 1 0\n0 0 2\n3 0 0\n",
      "ply\rformat ascii 1.0\relement vertex 4\rproperty float x\rproperty float y\rproperty float "
      "z\relement face 4\rproperty list uchar int vertex_index\rend_header\r0 0 0\r1 0 0\r0 2 0\r0 "
      "0 3\r3 0 2 1\r3 0 1 3\r3 0 3 2\r3 1 2 3\r",
      "ply \n\t comment a\n\n \t\n format\tascii  1.0 \t\n element \tvertex\t4\n"
      "\tproperty\tfloat x\n property  float\ty \nproperty float \t z\nelement face 4\n"
      " property   list uchar \t int vertex_indices \n\tend_header\t \n" BODY,
      "ply\nformat ascii 1.0\nelement nothing 0\nelement vertex 4\nproperty float32 x\n"
      "property float64 y\nproperty int8 z\n" FACE_LIST "0\t0 0\n1 0 0\n0 2 0\n0 0 3\n"
      "3\t0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    abbe_mesh m;
    OK(parse(texts[i], strlen(texts[i]), &m));
    assert_tetrahedron(&m, 1, 0, 0);
  }
}

/* Lines of a header are as long as programs make them, where nothing is read from them. */
TEST(comments_may_be_long) {
  static const char *const begins[] = {"comment ", "obj_info ", "element "};
  static char text[4096];
  for (int i = 0; i < 3; i++) {
    abbe_mesh m;
    char *at = text + sprintf(text, "ply\nformat ascii 1.0\n%s", begins[i]);
    memset(at, 'x', 1000);
    strcpy(at + 1000, "\nelement vertex 4\nproperty float x\nproperty float y\n"
                      "property float z\n" FACE_LIST BODY);
    const abbe_result result = parse(text, strlen(text), &m);
    assert_int_equal(result, i < 2 ? ABBE_OK : ABBE_PARSE);
    if (i < 2) assert_tetrahedron(&m, 1, 0, 0);
    if (i == 2) assert_contains(last_error.text, "line 3 is none of a PLY header");
  }
}

/* As many elements and properties as a header may have, and one more; and lines without end. */
TEST(headers_have_an_end) {
  static const struct {
    int elements, properties;
    const char *words;
  } rows[] = {{32, 1, NULL}, {33, 1, "line 67 is"}, {1, 128, NULL}, {1, 129, "line 132 is"}};
  static char text[1 << 17];
  abbe_mesh m;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    char *at = text + sprintf(text, "ply\nformat ascii 1.0\n");
    for (int e = 0; e < rows[i].elements; e++) {
      at += sprintf(at, "element e%d 0\n", e);
      for (int p = 0; p < rows[i].properties; p++) at += sprintf(at, "property char p%d\n", p);
    }
    strcpy(at, "end_header\n");
    assert_int_equal(parse(text, strlen(text), &m), rows[i].words ? ABBE_PARSE : ABBE_GEOMETRY);
    assert_contains(last_error.text, rows[i].words ? rows[i].words : "no faces were read");
  }
  strcpy(text, "ply\n");
  memset(text + 4, '\n', 70000);
  assert_int_equal(parse(text, 70004, &m), ABBE_PARSE);
  assert_contains(last_error.text, "has no end_header");
}

/* Bytes with a sign; a face's own texture coordinates go before those of its vertices. */
TEST(bytes_have_signs) {
  static const char head[] =
      "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 3\r\nproperty char x\r\n"
      "property char y\r\nproperty char z\r\nproperty uchar u\r\nproperty uchar v\r\n"
      "element face 1\r\nproperty list uchar uchar vertex_index\r\n"
      "property list uchar uchar texcoord\r\nend_header\r";
  static const char body[] = {-1, 0, 0, 5, 5, 1, 0, 0, 5, 5, 0, 1, 0,
                              5,  5, 3, 0, 1, 2, 6, 1, 2, 3, 4, 5, 6};
  char data[600];
  memcpy(data, head, sizeof head - 1);
  memcpy(data + sizeof head - 1, body, sizeof body);
  /* after the last return the body begins, for it does not go on with a line feed */
  MADE(abbe_mesh, m, parse(data, sizeof head - 1 + sizeof body, &m));
  assert_near(m.position[m.face[0][0]][0], -1, 0);
  for (int k = 0; k < 3; k++) {
    assert_near(m.uv[m.face[0][k]][0], 1 + 2 * k, 0);
    assert_near(m.uv[m.face[0][k]][1], 2 + 2 * k, 0);
  }
  /* where the header ends the file, nothing of it is there */
  abbe_mesh none;
  assert_int_equal(parse(head, sizeof head - 1, &none), ABBE_PARSE);
  assert_contains(last_error.text, "in element 'vertex' 1 of 3");
}

/* The ending of the header's lines is that of its first: the body may begin with either byte. */
TEST(a_body_may_begin_with_the_end_of_a_line) {
  static const char *const endings[] = {"\n", "\r\n", "\r"};
  static const char *const lines[] = {"ply",
                                      "format binary_little_endian 1.0",
                                      "element vertex 3",
                                      "property uchar x",
                                      "property uchar y",
                                      "property uchar z",
                                      "element face 1",
                                      "property list uchar uchar vertex_index",
                                      "end_header"};
  for (int e = 0; e < 3; e++)
    for (unsigned char first = '\n'; first <= '\r'; first++) {
      char data[512] = "";
      const unsigned char body[] = {first, 0, 0, 1, 0, 0, 0, 1, 0, 3, 0, 1, 2};
      for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        strcat(data, lines[i]);
        strcat(data, endings[e]);
      }
      const size_t head = strlen(data);
      /* after a lone return, a line feed is the body's own */
      memcpy(data + head, body, sizeof body);
      MADE(abbe_mesh, m, parse(data, head + sizeof body, &m));
      assert_near(m.position[0][0], first, 0);
    }
}

TEST(vertices_and_corners_have_uv_and_normals) {
  static const char vertices[] =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "property float s\nproperty float t\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 1 0.5 0.25\n1 0 0 0 0 2 1 0\n0 1 0 0 0 3 0 1\n3 0 1 2\n";
  static const char corners[] =
      FACES("property list uchar float texcoord\n") "3 0 1 2 6 0.5 0.25 1 0 0 1\n";
  for (int i = 0; i < 2; i++) {
    const char *text = i == 0 ? vertices : corners;
    MADE(abbe_mesh, m, parse(text, strlen(text), &m));
    assert_true(m.given_normals == (i == 0));
    if (i == 0) assert_near(m.normal[m.face[0][2]][2], 3, 0);
    assert_near(m.uv[m.face[0][0]][0], 0.5, 0);
    assert_near(m.uv[m.face[0][0]][1], 0.25, 0);
    assert_near(m.uv[m.face[0][2]][1], 1, 0);
  }
}

/* Lists of texture coordinates are their own face's: one before the corners, one of a face of two
 * corners, and none where as many others are as vertices. */
TEST(texture_coordinates_stay_with_their_face) {
#define VERTICES(count)                                                                            \
  "ply\nformat ascii 1.0\nelement vertex " count                                                   \
  "\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
  static const char before[] =
      VERTICES("3") "property list uchar float texcoord\nproperty list uchar int vertex_indices\n"
                    "end_header\n0 0 0\n1 0 0\n0 1 0\n"
                    "6 0.5 0.25 1 0 0 1 3 0 1 2\n4 9 9 9 9 2 0 1\n";
  static const char none[] =
      VERTICES("4") "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
                    "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                    "4 1 2 3 0 8 0 0 1 0 1 1 0 1\n3 1 2 3 0\n";
  MADE(abbe_mesh, m, parse(before, strlen(before), &m));
  assert_int_equal(m.face_count, 1);
  assert_near(m.uv[m.face[0][0]][0], 0.5, 0);
  assert_near(m.uv[m.face[0][1]][0], 1, 0);
  assert_near(m.uv[m.face[0][2]][1], 1, 0);
  abbe_mesh_free(&m);
  OK(parse(none, strlen(none), &m));
  assert_int_equal(m.face_count, 3);
  assert_near(m.uv[m.face[0][1]][0], 1, 0);
  for (int k = 0; k < 3; k++)
    for (int c = 0; c < 2; c++) assert_near(m.uv[m.face[2][k]][c], 0, 0);
}

TEST(what_is_wrong_is_said) {
  static const struct {
    const char *text, *part;
    abbe_result result;
  } files[] = {
      {PLAIN "3 0 1 5\n", "none of the file's 5", ABBE_GEOMETRY},
      {PLAIN "3 0 1 -2\n", "'tristrips' 1 names a vertex by what is no whole number",
       ABBE_GEOMETRY},
      {PLAIN "3 0 1 1.5\n", "no whole number", ABBE_GEOMETRY},
      {PLAIN "3 0 0 1\n", "no faces were read from it", ABBE_GEOMETRY},
      {PLAIN "3 0 1 2\n7\n", "it goes on with '7", ABBE_PARSE},
      {FACES("") "3 0 1 5\n", "face 1 names vertex 5", ABBE_GEOMETRY},
      {FACES("") "3 0 1 -1\n", "no whole number", ABBE_GEOMETRY},
      {FACES("property list uchar float texcoord\n") "3 0 1 2 4 0 0 1 1\n",
       "another number of texture coordinates", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n0\n1\nnan\n",
       "in element 'vertex' 3 of 3", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n", "no end_header", ABBE_PARSE},
      {FACES("property list uchar float texcoord\n") "3 0 1 2 5 0 0 1 1 0\n",
       "another number of texture coordinates", ABBE_PARSE},
      {FACES("property list uchar float texcoord\n") "3 0 1 2 6 0 0\n", "in element 'face' 1 of 1",
       ABBE_PARSE},
      {FACES("property list uchar float texcoord\n") "3 0 1 2 6 0\n", "in element 'face' 1 of 1",
       ABBE_PARSE},
      {"ply\nformat\nend_header\n", "line 2 is none of", ABBE_PARSE},
      {"ply\nformat asciii 1.0\nend_header\n", "line 2 is none of", ABBE_PARSE},
      {"ply\nformat askii 1.0\nend_header\n", "line 2 is none of", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float u\n"
       "property float v\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
       "0 0 0\n1 0 0\n2 0 0\n3 0 1 5\n",
       "face 1 names vertex 5", ABBE_GEOMETRY},
      {PLAIN "4 0 1 2\n", "it ends", ABBE_PARSE},
      {PLAIN "-1 0 1 2\n", "it ends", ABBE_PARSE},
      {PLAIN "3 0 1 x\n", "something else than a number", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement vertex 900\nproperty float x\nend_header\n0\n",
       "line 3 announces 900 elements 'vertex'", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "line 3", ABBE_PARSE},
      {"ply\nformat ebcdic 1.0\nend_header\n", "line 2", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement tristrips 1\nproperty list float int i\nend_header\n",
       "line 4", ABBE_PARSE},
      {"plx\n", "line 1", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement vertex 5\n"
       "property float x\nelement tristrips 1\nproperty list int int i\nend_header\n"
       "0\n1\n2\n3\n4\n5\n3 0 1 2\n",
       "line 5", ABBE_PARSE},
      {"ply\nformat ascii 1.0\nelement vertex 1844\nelement tristrips 1\n"
       "property list int int i\nend_header\n3 0 1 2\n",
       "line 3 announces", ABBE_PARSE},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    assert_int_equal(parse(files[i].text, strlen(files[i].text), &m), files[i].result);
    assert_contains(last_error.text, files[i].part);
    assert_null(m.position);
  }
}

TEST(a_mesh_is_loaded_from_them) {
  char data[1024];
  OWNED(abbe_mesh, m);
  const size_t size = binary(false, data);
  FILE *f = fopen("t_strips.ply", "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(data, 1, size, f), size);
  fclose(f);
  const abbe_result result =
      abbe_mesh_load("t_strips.ply", ABBE_NORMALS_FLAT, &m, NULL, &last_error);
  unlink("t_strips.ply");
  if (result != ABBE_OK) fail_msg("%s", last_error.text);
  assert_int_equal(m.face_count, 4);
  assert_int_equal(m.vertex_count, 12);
}
