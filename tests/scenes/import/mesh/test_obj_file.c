#include "tests/scenes/import/mesh/meshes.h"

#include "base/file.h"

#include <unistd.h>

#define POINTS "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n"

TEST(tetrahedra_are_read) {
  static const char *const texts[] = {
      POINTS "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
      "# made up\r\nmtllib no.mtl\r\no a\r\nv 0 0 0\r\nv 1 0 0 # x\r\nv 0 2 0\r\nv 0 0 3\r\ng b\r\n"
      "s 1\r\nf -4 -2 -3\r\nf -4 -3 -1\r\nf -4 -1 -2\r\nf -3 -2 -1",
      "  v\t0 0 \\\n 0\nv 1. 0e0 -0 0.5 0.5 1\nv 0 2.0 0 1\n\n\nvt 0.5\nv 0 0 +3\n"
      "f 1/1 3/1 \\\r\n 2/1\nf 1/1/ 2/ 4\nf 1// 4 3\nfo 2 3 4\nl 1 2\np 3\nf 1 2\nf 3\n",
      "v 0 0 0 # x \rv 1 \\\r0 0\rv 0 2 0 \rv 0 0 3\rf 1 3 2\rf 1 2 4\rf 1 4 3\rf 2 3 4 \\\r",
  };
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    abbe_mesh m;
    OK(test_read(abbe_obj_read, "t.obj", NULL, texts[i], strlen(texts[i]), &m));
    assert_false(m.given_normals);
    assert_tetrahedron(&m, 1, 0, 0);
  }
}

/* Editors put a mark before the first line, which is a vertex, and may write UTF-16. */
TEST(marks_of_encodings_are_heeded) {
  static const char text[] = POINTS "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  enum { LENGTH = sizeof text - 1 };
  char bytes[2 * LENGTH + 2];
  abbe_mesh m;
  memcpy(bytes, "\xef\xbb\xbf", 3);
  memcpy(bytes + 3, text, LENGTH);
  OK(test_read(abbe_obj_read, "t.obj", NULL, bytes, LENGTH + 3, &m));
  assert_tetrahedron(&m, 1, 0, 0);
  for (size_t big = 0; big < 2; big++) {
    memcpy(bytes, big ? "\xfe\xff" : "\xff\xfe", 2);
    for (size_t i = 0; i < LENGTH; i++) {
      bytes[2 + 2 * i + big] = text[i];
      bytes[2 + 2 * i + !big] = '\0';
    }
    OK(test_read(abbe_obj_read, "t.obj", NULL, bytes, sizeof bytes, &m));
    assert_tetrahedron(&m, 1, 0, 0);
  }
}

TEST(corners_have_their_own_uv_and_normals) {
  static const char text[] = POINTS "vt 0.25 0.75\nvt 1 0 0\nvn 0 0 1\nvn 0 0 -2\n"
                                    "f 1/1/1 2/2/2 3/-1/-2\nf 4//1 2/1/2 1/2/1\n";
  MADE(abbe_mesh, m, test_read(abbe_obj_read, "t.obj", NULL, text, strlen(text), &m));
  assert_true(m.given_normals);
  assert_int_equal(m.face_count, 2);
  static const double uv[6][2] = {{0.25, 0.75}, {1, 0}, {1, 0}, {0, 0}, {0.25, 0.75}, {1, 0}};
  static const double z[6] = {1, -2, 1, 1, -2, 1};
  for (size_t i = 0; i < 6; i++) {
    const uint32_t v = m.face[i / 3][i % 3];
    assert_near(m.uv[v][0], uv[i][0], 0);
    assert_near(m.uv[v][1], uv[i][1], 0);
    assert_near(m.normal[v][2], z[i], 0);
  }
}

/* Programs write faces whose texture coordinates and normals they leave out. */
TEST(what_is_not_there_is_not_taken) {
  static const char text[] = POINTS "f 1/1/1 3/2/1 2/3/1\nf 1/1/9 2 4\nf 1 4 3\nf 2 3 4\n";
  abbe_mesh m;
  OK(test_read(abbe_obj_read, "t.obj", NULL, text, strlen(text), &m));
  assert_false(m.given_normals);
  assert_null(m.uv);
  assert_tetrahedron(&m, 1, 0, 0);
}

TEST(a_material_s_faces_are_read_alone) {
  static const char text[] =
      POINTS "f 1 2 3\nusemtl clear glass \t\nf 1 2 3 4\nusemtl clear\nf 1 2 3\n";
  abbe_mesh m;
  OK(test_read(abbe_obj_read, "t.obj", "clear glass", text, strlen(text), &m));
  assert_int_equal(m.face_count, 2);
  abbe_mesh_free(&m);
  assert_int_equal(test_read(abbe_obj_read, "t.obj", "stone", text, strlen(text), &m),
                   ABBE_GEOMETRY);
  assert_contains(last_error.text, "no triangle is of a material called 'stone'");
}

/* Names may have blanks, and there may be several. */
TEST(files_of_materials_are_known) {
  static const char text[] =
      "mtllib a.mtl\t my own.mtl \nmtllib b.mtl\nmtllib\n" POINTS "f 1 2 3\n";
  static const char *const names[] = {"a.mtl\t my own.mtl", "a.mtl", "my", "own.mtl", "b.mtl", ""};
  FILE *file = fopen("t_names.obj", "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(text, 1, sizeof text - 1, file), sizeof text - 1);
  fclose(file);
  FREED char *others = NULL;
  MADE(abbe_mesh, m, abbe_mesh_load("t_names.obj", ABBE_NORMALS_FLAT, &m, &others, &error));
  const char *at = others;
  for (size_t i = 0; i < sizeof names / sizeof *names; at += strlen(at) + 1, i++)
    assert_string_equal(at, names[i]);
  unlink("t_names.obj");
}

/* They lie beside the mesh; UTF-16 that ends within a letter is none. */
TEST(files_of_materials_lie_beside_the_mesh) {
  char folder[] = "/tmp/abbe-test-obj-XXXXXX";
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/t.obj", folder);
  static const char text[] = "mtllib a.mtl\n" POINTS "f 1 2 3\n";
  OK(abbe_file_write(path, text, sizeof text - 1, &error));
  FREED char *others = NULL;
  MADE(abbe_mesh, m, abbe_mesh_load(path, ABBE_NORMALS_FLAT, &m, &others, &error));
  assert_string_equal(others, printed("%s/a.mtl", folder));
  assert_string_equal(others + strlen(others) + 1, "");
  assert_int_equal(unlink(path) + rmdir(folder), 0);
  abbe_mesh none;
  assert_int_equal(test_read(abbe_obj_read, "t.obj", NULL, "\xff\xfev\0 \0\0", 7, &none),
                   ABBE_PARSE);
}

/* What is not finite is no normal and no texture coordinate: zeros stand for it. */
TEST(normals_and_uv_are_finite) {
  static const char text[] = POINTS "vn 0 0 1e999\nvt 1e999 2\nf 1/1/1 2/1/1 3/1/1\n";
  MADE(abbe_mesh, m, test_read(abbe_obj_read, "t.obj", NULL, text, strlen(text), &m));
  for (size_t v = 0; v < m.vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      assert_near(m.normal[v][k], 0, 0);
      if (k < 2) assert_near(m.uv[v][k], 0, 0);
    }
}

TEST(what_is_wrong_is_said) {
  static const struct {
    const char *text, *words;
    abbe_result code;
  } files[] = {
      {POINTS "f 1 2 3\nf 1 2 5\n",
       "line 6: a face names vertex 5, counted from 1, that is none of the file's 4",
       ABBE_GEOMETRY},
      {POINTS "f 1 2 3\nf 1 2 7 \\\n 8\nf 1 2 6\n", "line 7: a face names vertex 8", ABBE_GEOMETRY},
      {POINTS "f 1 2 0\n", "line 5: a face's corner", ABBE_PARSE},
      {POINTS "f 1 2 -5\n", "line 5: a face's corner", ABBE_PARSE},
      {POINTS "\nf 1 2 x\n", "line 6: a face's corner", ABBE_PARSE},
      {POINTS "f 1 2 3.5\n", "line 5: a face's corner", ABBE_PARSE},
      {POINTS "f 1 2 99999999999999999999\n", "line 5: a face's corner", ABBE_PARSE},
      {"v 0 0\nf 1 1 1\n", "line 1: a vertex", ABBE_PARSE},
      {"v 0 0 \\\n nan\nf 1 1 1\n", "line 2: a vertex", ABBE_PARSE},
      {"v 0 0 1e999\nf 1 1 1\n", "coordinates must be finite", ABBE_GEOMETRY},
      {"v 0 0 1,5\nf 1 1 1\n", "line 1: a vertex", ABBE_PARSE},
      {POINTS "vn 0 1\n", "line 5: a normal", ABBE_PARSE},
      {POINTS "vt\n", "line 5: a texture coordinate", ABBE_PARSE},
      {POINTS "l 1 2\n", "no faces were read from it", ABBE_GEOMETRY},
      {"", "no faces were read from it", ABBE_GEOMETRY},
      {POINTS "f 1 2 3\nsurf 0 1 0 1 1 2 3 4\n", "line 6: 'surf' is a free-form surface",
       ABBE_UNSUPPORTED},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++)
    assert_refused(abbe_obj_read, "t.obj", files[i].text, files[i].code, files[i].words);
}
