#include "scenes/mesh.h"

#include "scenes/shape.h"
#include "scenes/transform.h"
#include "scenes/vector.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static bool is_convex(const abbe_mesh *mesh, size_t most, double (*plane)[4], size_t *count) {
  assert_int_equal(abbe_mesh_convex_planes(mesh, most, plane, count, NULL), ABBE_OK);
  return *count > 0;
}

static abbe_mesh sphere(size_t levels) {
  abbe_mesh m;
  assert_int_equal(abbe_shape_sphere(1, levels, &m, NULL), ABBE_OK);
  return m;
}

static abbe_mesh_report check(const abbe_mesh *m) {
  abbe_mesh_report r;
  assert_int_equal(abbe_mesh_check(m, &r, NULL), ABBE_OK);
  return r;
}

static void turn(abbe_mesh *m, size_t f) {
  const uint32_t second = m->face[f][1];
  m->face[f][1] = m->face[f][2];
  m->face[f][2] = second;
}

static void assert_mends(abbe_mesh *m, const char *word) {
  char *what = NULL;
  abbe_error error = {0};
  if (abbe_mesh_mend(m, true, &what, &error) != ABBE_OK) fail_msg("%s", error.text);
  if (word) {
    assert_non_null(what);
    if (!strstr(what, word)) fail_msg("'%s' lacks '%s'", what, word);
  } else {
    assert_null(what);
  }
  free(what);
  const abbe_mesh_report r = check(m);
  assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges + r.degenerate_faces, 0);
  assert_true(r.volume > 0);
}

static void make_checks_sizes(void **state) {
  (void)state;
  abbe_mesh m;
  assert_int_equal(abbe_mesh_make(0, 1, false, &m, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_make(SIZE_MAX, 1, false, &m, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_make(3, ABBE_MESH_MAX_FACES + 1u, false, &m, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_null(m.position);
  abbe_mesh_free(&m);
  abbe_mesh_free(NULL);
}

static void check_counts_what_is_wrong(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  m.face_count--;
  assert_int_equal(check(&m).open_edges, 3);
  m.face_count++;
  turn(&m, 10);
  assert_int_equal(check(&m).flipped_edges, 3);
  turn(&m, 10);
  memcpy(m.face[3], m.face[4], sizeof m.face[3]);
  const abbe_mesh_report r = check(&m);
  assert_true(r.open_edges == 3 || r.open_edges == 2);
  assert_true(r.crowded_edges >= 2);
  abbe_mesh_free(&m);
}

static void a_sound_mesh_is_left_alone(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  const double(*before)[3] = (const double(*)[3])m.position;
  assert_mends(&m, NULL);
  assert_ptr_equal(before, m.position);
  abbe_mesh_free(&m);
}

static void an_inverted_mesh_is_turned(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  for (size_t f = 0; f < m.face_count; f++) turn(&m, f);
  assert_true(check(&m).volume < 0);
  assert_mends(&m, "inside-out part turned");
  assert_true(abbe_vector_dot(m.normal[0], m.position[0]) > 0.99);
  abbe_mesh_free(&m);
}

static void single_flipped_faces_are_turned(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  turn(&m, 0);
  turn(&m, 77);
  assert_mends(&m, "2 faces turned");
  abbe_mesh_free(&m);
}

static void small_and_flat_holes_are_closed(void **state) {
  (void)state;
  abbe_mesh m = sphere(3);
  m.face_count--;
  assert_mends(&m, "1 hole closed");
  assert_int_equal(m.face_count, 1280);
  abbe_mesh_free(&m);
  const double size[3] = {1, 1, 1};
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  m.face_count -= 2;
  assert_mends(&m, "1 hole closed");
  assert_true(fabs(check(&m).volume - 1) < 1e-12);
  abbe_mesh_free(&m);
}

static void a_large_bent_hole_is_refused_and_counted(void **state) {
  (void)state;
  abbe_mesh m = sphere(3);
  m.face_count -= 200;
  abbe_error error;
  char *what = NULL;
  assert_int_equal(abbe_mesh_mend(&m, true, &what, &error), ABBE_GEOMETRY);
  assert_null(what);
  assert_non_null(strstr(error.text, "open edges"));
  assert_int_equal(m.face_count, 1080);
  abbe_mesh_free(&m);
}

static void degenerate_faces_are_mended(void **state) {
  (void)state;
  abbe_mesh m;
  /* a box whose top has a vertex in the middle of one edge: one face without area beside it */
  const double at[9][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},  {0, 0, 1},
                           {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0.5, 0, 1}};
  const uint32_t face[16][3] = {{0, 2, 1}, {0, 3, 2}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6},
                                {3, 0, 4}, {3, 4, 7}, {0, 1, 5}, {0, 5, 4}, {4, 5, 8}, {4, 8, 7},
                                {8, 5, 6}, {8, 6, 7}, {0, 0, 1}, {6, 7, 7}};
  assert_int_equal(abbe_mesh_make(9, 16, false, &m, NULL), ABBE_OK);
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  assert_int_equal(check(&m).degenerate_faces, 3);
  assert_int_equal(check(&m).open_edges, 0);
  assert_mends(&m, "1 face without area split away");
  assert_true(fabs(check(&m).volume - 1) < 1e-12);
  abbe_mesh_free(&m);
}

/* Two shells in one mesh: b is moved into a. */
static abbe_mesh joined(abbe_mesh *a, abbe_mesh *b) {
  abbe_mesh m;
  assert_int_equal(abbe_mesh_make(a->vertex_count + b->vertex_count, a->face_count + b->face_count,
                                  false, &m, NULL),
                   ABBE_OK);
  memcpy(m.position, a->position, a->vertex_count * sizeof *a->position);
  memcpy(m.position + a->vertex_count, b->position, b->vertex_count * sizeof *b->position);
  memcpy(m.face, a->face, a->face_count * sizeof *a->face);
  for (size_t f = 0; f < b->face_count; f++)
    for (int k = 0; k < 3; k++)
      m.face[a->face_count + f][k] = (uint32_t)a->vertex_count + b->face[f][k];
  abbe_mesh_free(a);
  abbe_mesh_free(b);
  return m;
}

static void a_bubble_faces_into_itself(void **state) {
  (void)state;
  abbe_mesh outer = sphere(2), inner;
  assert_int_equal(abbe_shape_sphere(0.5, 2, &inner, NULL), ABBE_OK);
  const double whole = check(&outer).volume, hole = check(&inner).volume;
  abbe_mesh m = joined(&outer, &inner);
  assert_int_equal(check(&m).shells, 2);
  assert_mends(&m, "1 inside-out part");
  assert_true(fabs(check(&m).volume - (whole - hole)) < 1e-12);
  assert_mends(&m, NULL);
  const double in_glass[3] = {0.7, 0.1, 0.1}, in_bubble[3] = {0.1, 0.2, 0.1}, out[3] = {2, 0, 0};
  assert_true(abbe_mesh_contains(&m, in_glass));
  assert_false(abbe_mesh_contains(&m, in_bubble));
  assert_false(abbe_mesh_contains(&m, out));
  abbe_mesh_free(&m);
}

static void subdivision_keeps_a_mesh_closed_and_smooth(void **state) {
  (void)state;
  abbe_mesh m;
  const double size[3] = {1, 1, 1};
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_subdivide(&m, 3, NULL), ABBE_OK);
  assert_int_equal(m.face_count, 12 * 64);
  assert_int_equal(check(&m).open_edges, 0);
  assert_true(check(&m).volume > 0.2 && check(&m).volume < 0.9);
  abbe_error error;
  assert_int_equal(abbe_mesh_subdivide(&m, 60, &error), ABBE_INVALID_ARGUMENT);
  abbe_mesh_free(&m);
  assert_int_equal(abbe_shape_rectangle(1, 1, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_subdivide(&m, 2, NULL), ABBE_OK);
  assert_int_equal(m.face_count, 32);
  for (size_t v = 0; v < m.vertex_count; v++) assert_true(m.normal[v][2] == 1);
  abbe_mesh_free(&m);
}

/* Every vertex that is left lies on the sphere, so what is off are the faces' middles. */
static void simplifying_keeps_within_the_distance(void **state) {
  (void)state;
  abbe_mesh m = sphere(6), few;
  size_t last = m.face_count;
  for (double within = 1e-3; within < 0.05; within *= 10) {
    uint32_t(*face)[3] = NULL;
    size_t count = 0;
    double farthest = 0;
    assert_int_equal(abbe_mesh_simplify(&m, within, &face, &count, NULL), ABBE_OK);
    assert_true(count > 20 && 3 * count < 2 * last);
    last = count;
    for (size_t f = 0; f < count; f++) {
      double middle[3] = {0};
      for (int k = 0; k < 9; k++) {
        assert_true(face[f][k / 3] < m.vertex_count);
        middle[k % 3] += m.position[face[f][k / 3]][k % 3] / 3;
      }
      farthest = fmax(farthest, 1 - abbe_vector_length(middle));
    }
    assert_true(farthest > 0.1 * within && farthest < 4 * within);
    assert_int_equal(abbe_mesh_make(m.vertex_count, count, false, &few, NULL), ABBE_OK);
    memcpy(few.position, m.position, m.vertex_count * sizeof *m.position);
    memcpy(few.face, face, count * sizeof *face);
    const abbe_mesh_report r = check(&few);
    assert_int_equal(r.open_edges + r.flipped_edges + r.degenerate_faces, 0);
    assert_true(1000 * r.crowded_edges < count);
    assert_true(r.volume > 0 && fabs(r.volume - 4.18879) < 4 * 12.6 * within + 0.01);
    abbe_mesh_free(&few);
    free(face);
  }
  abbe_mesh_free(&m);
}

static void simplifying_a_faceted_mesh_holds_its_edges(void **state) {
  (void)state;
  const double size[3] = {1, 2, 3};
  abbe_mesh m;
  uint32_t(*face)[3] = NULL;
  size_t count = 0;
  abbe_error error;
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_simplify(&m, 0.01, &face, &count, NULL), ABBE_OK);
  assert_int_equal(count, m.face_count);
  free(face);
  assert_int_equal(abbe_mesh_simplify(&m, 0, &face, &count, NULL), ABBE_OK);
  assert_int_equal(count, m.face_count);
  assert_memory_equal(face, m.face, count * sizeof *face);
  free(face);
  assert_int_equal(abbe_mesh_simplify(&m, -1, &face, &count, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_simplify(&m, NAN, &face, &count, &error), ABBE_INVALID_ARGUMENT);
  assert_null(face);
  abbe_mesh_free(&m);
}

static void subdividing_an_octahedron_weights_the_limit_right(void **state) {
  (void)state;
  /* Loop on a regular octahedron by hand: a corner (valence 4, beta 3/32) goes from 1 to 5/8 */
  const double at[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const uint32_t face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                               {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  abbe_mesh m;
  assert_int_equal(abbe_mesh_make(6, 8, false, &m, NULL), ABBE_OK);
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  assert_int_equal(abbe_mesh_subdivide(&m, 1, NULL), ABBE_OK);
  assert_int_equal(m.vertex_count, 18);
  size_t corners = 0, middles = 0;
  for (size_t v = 0; v < 18; v++) {
    const double r = abbe_vector_length(m.position[v]);
    corners += fabs(r - 0.625) < 1e-12;
    middles += fabs(r - 0.375 * sqrt(2)) < 1e-12;
  }
  assert_int_equal(corners, 6);
  assert_int_equal(middles, 12);
  abbe_mesh_free(&m);
}

static void transforms_mirror_and_keep_outwards(void **state) {
  (void)state;
  abbe_mesh m = sphere(2);
  const double factor[3] = {-1, 2, 1}, offset[3] = {5, 0, 0}, flat[3] = {1, 0, 1};
  double scale[16], move[16];
  abbe_transform_scale(factor, scale);
  abbe_transform_translate(offset, move);
  abbe_transform_multiply(move, scale, scale);
  assert_int_equal(abbe_mesh_transform(&m, scale, NULL), ABBE_OK);
  assert_true(check(&m).volume > 0);
  assert_true(fabs(check(&m).max[0] - 6) < 0.02);
  for (size_t f = 0; f < m.face_count; f++) {
    double n[3];
    abbe_vector_triangle(m.position[m.face[f][0]], m.position[m.face[f][1]],
                         m.position[m.face[f][2]], n);
    assert_true(abbe_vector_dot(n, m.normal[m.face[f][0]]) > 0);
  }
  abbe_transform_scale(flat, scale);
  assert_int_equal(abbe_mesh_transform(&m, scale, NULL), ABBE_INVALID_ARGUMENT);
  abbe_mesh_free(&m);
}

static void convex_planes_say_no_to_what_is_not(void **state) {
  (void)state;
  double plane[256][4];
  size_t count = 0;
  abbe_mesh m = sphere(6);
  assert_false(is_convex(&m, 256, plane, &count));
  abbe_mesh_free(&m);
  m = sphere(1);
  assert_true(is_convex(&m, 256, plane, &count));
  assert_int_equal(count, 80);
  m.face_count--;
  assert_false(is_convex(&m, 256, plane, &count));
  m.face_count++;
  m.position[0][0] *= 0.5, m.position[0][1] *= 0.5, m.position[0][2] *= 0.5;
  assert_false(is_convex(&m, 256, plane, &count));
  abbe_mesh_free(&m);
  const double size[3] = {1, 1, 1}, offset[3] = {1000, 0, 0};
  double move[16];
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  abbe_transform_translate(offset, move);
  assert_int_equal(abbe_mesh_transform(&m, move, NULL), ABBE_OK);
  assert_true(is_convex(&m, 6, plane, &count));
  assert_int_equal(count, 6);
  assert_true(plane[0][0] == 1 && fabs(plane[0][3] - 1000.5) < 1e-9);
  assert_false(is_convex(&m, 5, plane, &count));
  abbe_mesh_free(&m);
}

static void write_text(const char *path, const char *text) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(text, 1, strlen(text), f), strlen(text));
  assert_int_equal(fclose(f), 0);
}

static const char tetrahedron_obj[] = "v 0 0 0\nv 1e-5 0 0\nv 0 1e-5 0\nv 0 0 1e-5\n"
                                      "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
static const char tetrahedron_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
static const char tetrahedron_stl[] =
    "solid t\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal -1 0 0\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "endsolid t\n";
/* positions, then indices 0 2 1, 0 1 3, 1 2 3, 2 0 3 as 16-bit numbers */
static const char tetrahedron_gltf[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0,\"scale\":[2,2,2]}],\"meshes\":[{\"primitives\":[{\"attributes\":"
    "{\"POSITION\":0},\"indices\":1}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,"
    "\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,"
    "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"buffers\":[{"
    "\"byteLength\":72,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
    "AAACAAEAAAABAAMAAQACAAMAAgAAAAMA\"}]}";

static void loads_tetrahedra(void **state) {
  (void)state;
  static const struct {
    const char *path, *text;
    double volume;
  } files[] = {{"t_mesh.obj", tetrahedron_obj, 1e-15 / 6},
               {"t_mesh.ply", tetrahedron_ply, 1.0 / 6},
               {"t_mesh.stl", tetrahedron_stl, 1.0 / 6},
               {"t_mesh.gltf", tetrahedron_gltf, 8.0 / 6}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    abbe_error error = {0};
    write_text(files[i].path, files[i].text);
    for (int smooth = 0; smooth < 2; smooth++) {
      if (abbe_mesh_load(files[i].path, smooth, &m, &error) != ABBE_OK) fail_msg("%s", error.text);
      assert_int_equal(m.face_count, 4);
      assert_int_equal(m.vertex_count, smooth ? 4 : 12);
      assert_int_equal(check(&m).open_edges, 0);
      assert_true(fabs(check(&m).volume / files[i].volume - 1) < 1e-6);
      abbe_mesh_free(&m);
    }
    unlink(files[i].path);
  }
}

static void bad_files_are_refused(void **state) {
  (void)state;
  static const struct {
    const char *path, *text;
  } files[] = {
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"},
      {"bad_mesh.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"bad_mesh.obj", ""},
      {"bad_mesh.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                       "end_header\n0\n"},
      {"bad_mesh.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
                       "property float y\nproperty float z\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\nabc"},
      {"bad_mesh.stl", "solid nothing\n"},
      {"bad_mesh.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[7]}]}"},
      {"bad_mesh.gltf", "{not json"},
      {"bad_mesh.glb", "glTF\2"},
      {"bad_mesh.gltf",
       "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
       "\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
       "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2000000000,\"type\":"
       "\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":12}],\"buffers\":[{"
       "\"byteLength\":12,\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA\"}]}"},
      {"bad_mesh.fbx", "no"},
      {"bad_mesh", "no"},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    abbe_error error = {0};
    write_text(files[i].path, files[i].text);
    if (abbe_mesh_load(files[i].path, true, &m, &error) == ABBE_OK)
      fail_msg("file %zu (%s) was read", i, files[i].path);
    assert_non_null(strstr(error.text, files[i].path));
    assert_null(m.face);
    unlink(files[i].path);
  }
  abbe_mesh m;
  abbe_error error;
  assert_int_equal(abbe_mesh_load("no_such_file.obj", true, &m, &error), ABBE_IO);
}

static void smooth_normals_are_shared_across_split_vertices(void **state) {
  (void)state;
  const double size[3] = {1, 1, 1};
  abbe_mesh m;
  assert_int_equal(abbe_shape_box(size, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_compute_normals(&m, true, NULL), ABBE_OK);
  assert_int_equal(m.vertex_count, 24);
  for (size_t v = 0; v < 24; v++)
    assert_true(abbe_vector_dot(m.normal[v], m.position[v]) > 0.8 * sqrt(0.75));
  abbe_mesh_free(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(make_checks_sizes),
      cmocka_unit_test(check_counts_what_is_wrong),
      cmocka_unit_test(a_sound_mesh_is_left_alone),
      cmocka_unit_test(an_inverted_mesh_is_turned),
      cmocka_unit_test(single_flipped_faces_are_turned),
      cmocka_unit_test(small_and_flat_holes_are_closed),
      cmocka_unit_test(a_large_bent_hole_is_refused_and_counted),
      cmocka_unit_test(degenerate_faces_are_mended),
      cmocka_unit_test(a_bubble_faces_into_itself),
      cmocka_unit_test(subdivision_keeps_a_mesh_closed_and_smooth),
      cmocka_unit_test(subdividing_an_octahedron_weights_the_limit_right),
      cmocka_unit_test(transforms_mirror_and_keep_outwards),
      cmocka_unit_test(convex_planes_say_no_to_what_is_not),
      cmocka_unit_test(simplifying_keeps_within_the_distance),
      cmocka_unit_test(simplifying_a_faceted_mesh_holds_its_edges),
      cmocka_unit_test(loads_tetrahedra),
      cmocka_unit_test(bad_files_are_refused),
      cmocka_unit_test(smooth_normals_are_shared_across_split_vertices),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
