#include "tests/scenes/import/mesh/meshes.h"

static const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
static const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/* As text, with words in such cases and lines that end so. */
static void write_text(bool upper, const char *before, const char *end, const char *last,
                       char *out) {
  char *at = out + sprintf(out, "%ssolid own facet%s", before, end);
  for (int f = 0; f < 4; f++) {
    at += sprintf(at, "facet normal 0 0 0%souter loop%s", end, end);
    for (int k = 0; k < 3; k++) {
      const double *p = corner[face[f][k]];
      at += sprintf(at, "\tvertex  %.9e %.9e %g%s", p[0], p[1], p[2], end);
    }
    at += sprintf(at, "endloop%sendfacet%s", end, end);
  }
  strcpy(at, last);
  for (char *c = out; upper && *c != '\0'; c++)
    if (*c >= 'a' && *c <= 'z') *c = (char)(*c - 'a' + 'A');
}

static size_t write_binary(const char *head, uint32_t count, unsigned char *out) {
  memset(out, 0, 84 + 4 * 50);
  memcpy(out, head, strlen(head));
  for (int i = 0; i < 4; i++) out[80 + i] = (unsigned char)(count >> 8 * i);
  for (int f = 0; f < 4; f++)
    for (int k = 0; k < 3; k++)
      for (int c = 0; c < 3; c++) {
        const float value = (float)corner[face[f][k]][c];
        uint32_t bits;
        memcpy(&bits, &value, sizeof bits);
        for (int i = 0; i < 4; i++)
          out[84 + 50 * f + 12 * (k + 1) + 4 * c + i] = (unsigned char)(bits >> 8 * i);
      }
  return 84 + 4 * 50;
}

TEST(texts_are_read) {
  static const struct {
    bool upper;
    const char *before, *end, *last;
  } ways[] = {{false, "", "\n", "endsolid own"},
              {true, "", "\n", "endsolid own\n"},
              {false, "  \n ", "\r\n", "endsolid\r\n\r\n"},
              {false, "", "\r", "end solid own\r"},
              {false, "", "\n", "endsolid"}};
  for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
    abbe_mesh m;
    char text[4096];
    write_text(ways[i].upper, ways[i].before, ways[i].end, ways[i].last, text);
    OK(test_read(abbe_stl_read, "t.stl", NULL, text, strlen(text), &m));
    assert_false(m.given_normals);
    assert_tetrahedron(&m, 1, 0, 0);
  }
}

TEST(several_solids_are_one_mesh) {
  char one[4096];
  write_text(false, "", "\n", "endsolid own\n", one);
  const char *text = printed("%s%s", one, one);
  MADE(abbe_mesh, m, test_read(abbe_stl_read, "t.stl", NULL, text, strlen(text), &m));
  assert_int_equal(m.face_count, 8);
}

/* Some programs begin these with 'solid' too. */
TEST(binaries_are_read) {
  static const char *const heads[] = {"own", "solid own", "\nsolid"};
  for (size_t i = 0; i < 3; i++) {
    abbe_mesh m;
    unsigned char data[84 + 4 * 50];
    const size_t size = write_binary(heads[i], 4, data);
    OK(test_read(abbe_stl_read, "t.stl", NULL, data, size, &m));
    assert_tetrahedron(&m, 1, 0, 0);
  }
}

TEST(another_count_is_said) {
  static const uint32_t counts[] = {3, 9, 0, 5};
  abbe_mesh m;
  unsigned char data[84 + 4 * 50];
  for (size_t i = 0; i < 4; i++) {
    const size_t size = write_binary("own", counts[i], data);
    assert_int_equal(test_read(abbe_stl_read, "t.stl", NULL, data, size, &m), ABBE_PARSE);
    assert_contains(last_error.text,
                    printed("t.stl: as a binary STL it announces %u triangles", counts[i]));
    assert_contains(last_error.text, "which are 4 triangles and 0 bytes");
  }
  const size_t size = write_binary("own", 4, data);
  for (size_t cut = 1; cut < size; cut++)
    assert_int_equal(test_read(abbe_stl_read, "t.stl", NULL, data, size - cut, &m), ABBE_PARSE);
}

TEST(what_is_wrong_is_said) {
#define FACET "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
  static const struct {
    const char *text, *words;
    abbe_result code;
  } files[] = {
      {"", "line 1: 'solid' belongs here, and the end stands", ABBE_PARSE},
      {"\n\nsolad x\n", "line 3: 'solid' belongs here, and 'solad' stands", ABBE_PARSE},
      {"solid x\nendsolid x\n", "no faces were read from it", ABBE_GEOMETRY},
      {"solid x\n" FACET "endloop\nendfacet\n", "line 9: 'facet' or 'endsolid'", ABBE_PARSE},
      {"solid x\n" FACET "endfacet\n", "line 7: 'vertex' or 'endloop'", ABBE_PARSE},
      {"solid x\n" FACET "endloop\nfacet", "line 8: 'endfacet'", ABBE_PARSE},
      {"solid x\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
       "line 6: 'vertex', three times, belongs here, and 'endloop' stands", ABBE_PARSE},
      {"solid x\nfacet\nouter loop\nvertex 0 0 y\n", "line 4: a number of a vertex", ABBE_PARSE},
      {"solid x\nfacet\nloop\n", "line 3: 'outer loop'", ABBE_PARSE},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    assert_refused(abbe_stl_read, "t.stl", files[i].text, files[i].code, files[i].words);
}
