#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/mesh/mesh.h"
#include "scenes/shapes/shape.h"
#include "tests/scenes/solids.h"

#include <unistd.h>

TEST(make_checks_sizes) {
  OWNED(abbe_mesh, m);
  assert_int_equal(abbe_mesh_make(0, 1, false, &m, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_make(SIZE_MAX, 1, false, &m, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_mesh_make(3, ABBE_MESH_MAX_FACES + 1u, false, &m, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_null(m.position);
  abbe_mesh_free(NULL);
}

TEST(check_counts_what_is_wrong) {
  OWNED(abbe_mesh, m) = test_sphere(2);
  m.face_count--;
  assert_int_equal(test_mesh_faults(&m).open_edges, 3);
  m.face_count++;
  test_turn_face(&m, 10);
  assert_int_equal(test_mesh_faults(&m).flipped_edges, 3);
  test_turn_face(&m, 10);
  memcpy(m.face[3], m.face[4], sizeof m.face[3]);
  const abbe_mesh_report r = test_mesh_faults(&m);
  assert_true(r.open_edges == 3 || r.open_edges == 2);
  assert_true(r.crowded_edges >= 2);
}

/* Of a unit sphere, whose faces lie within a hundredth of it; many rays pass close by its edges. */
TEST(points_within_a_sphere_are_inside) {
  OWNED(abbe_mesh, m) = test_sphere(4);
  for (int i = 0; i < 400; i++) {
    const double z = (i + 0.5) / 200 - 1, turn = 2.399963 * i, r = sqrt(1 - z * z);
    const double away = i % 2 == 0 ? 0.985 : 1.001;
    const double p[3] = {away * r * cos(turn), away * r * sin(turn), away * z};
    assert_true(abbe_mesh_contains(&m, p) == (i % 2 == 0));
  }
  assert_true(abbe_mesh_contains(&m, (const double[3]){0, 0, 0}));
}

TEST(subdivision_keeps_a_mesh_closed_and_smooth) {
  const double size[3] = {1, 1, 1};
  MADE(abbe_mesh, m, abbe_shape_box(size, &m, &error));
  OK(abbe_mesh_subdivide(&m, 3, &error));
  assert_int_equal(m.face_count, 12 * 64);
  assert_int_equal(test_mesh_faults(&m).open_edges, 0);
  assert_true(test_mesh_faults(&m).volume > 0.2 && test_mesh_faults(&m).volume < 0.9);
  REFUSED(ABBE_INVALID_ARGUMENT, "levels of subdivision of", abbe_mesh_subdivide(&m, 60, &error));
  abbe_mesh_free(&m);
  OK(abbe_shape_rectangle(1, 1, &m, &error));
  OK(abbe_mesh_subdivide(&m, 2, &error));
  assert_int_equal(m.face_count, 32);
  for (size_t v = 0; v < m.vertex_count; v++) assert_true(m.normal[v][2] == 1);
}

TEST(subdividing_an_octahedron_weights_the_limit_right) {
  /* Loop on a regular octahedron by hand: a corner (valence 4, beta 3/32) goes from 1 to 5/8 */
  const double at[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const uint32_t face[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                               {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  MADE(abbe_mesh, m, abbe_mesh_make(6, 8, false, &m, &error));
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  OK(abbe_mesh_subdivide(&m, 1, &error));
  assert_int_equal(m.vertex_count, 18);
  size_t corners = 0, middles = 0;
  for (size_t v = 0; v < 18; v++) {
    const double r = abbe_vector_length(m.position[v]);
    corners += fabs(r - 0.625) < 1e-12;
    middles += fabs(r - 0.375 * sqrt(2)) < 1e-12;
  }
  assert_int_equal(corners, 6);
  assert_int_equal(middles, 12);
}

TEST(transforms_mirror_and_keep_outwards) {
  OWNED(abbe_mesh, m) = test_sphere(2);
  const double factor[3] = {-1, 2, 1}, offset[3] = {5, 0, 0}, flat[3] = {1, 0, 1};
  double scale[16], move[16];
  abbe_transform_scale(factor, scale);
  abbe_transform_translate(offset, move);
  abbe_transform_multiply(move, scale, scale);
  OK(abbe_mesh_transform(&m, scale, &error));
  assert_true(test_mesh_faults(&m).volume > 0);
  assert_true(fabs(test_mesh_faults(&m).max[0] - 6) < 0.02);
  for (size_t f = 0; f < m.face_count; f++) {
    double n[3];
    abbe_vector_triangle(m.position[m.face[f][0]], m.position[m.face[f][1]],
                         m.position[m.face[f][2]], n);
    assert_true(abbe_vector_dot(n, m.normal[m.face[f][0]]) > 0);
  }
  abbe_transform_scale(flat, scale);
  assert_int_equal(abbe_mesh_transform(&m, scale, NULL), ABBE_INVALID_ARGUMENT);
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
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{"
    "\"mesh\":0,\"scale\":[2,2,2]}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
    "\"indices\":1}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,"
    "\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,1,1]},{\"bufferView\":1,\"componentType\":5123,"
    "\"count\":12,\"type\":\"SCALAR\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{"
    "\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],\"buffers\":[{\"byteLength\":72,\"uri\":"
    "\"data:application/"
    "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
    "AAACAAEAAAABAAMAAQACAAMAAgAAAAMA\"}]}";

TEST(loads_tetrahedra) {
  static const struct {
    const char *path, *text;
    double volume;
  } files[] = {{"t_mesh.obj", tetrahedron_obj, 1e-15 / 6},
               {"t_mesh.ply", tetrahedron_ply, 1.0 / 6},
               {"t_mesh.stl", tetrahedron_stl, 1.0 / 6},
               {"t_mesh.gltf", tetrahedron_gltf, 8.0 / 6}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    write_text(files[i].path, files[i].text);
    for (int smooth = 0; smooth < 2; smooth++) {
      OK(abbe_mesh_load(files[i].path, smooth ? ABBE_NORMALS_SMOOTH : ABBE_NORMALS_FLAT, &m, NULL,
                        &error));
      assert_int_equal(m.face_count, 4);
      assert_int_equal(m.vertex_count, smooth ? 4 : 12);
      assert_int_equal(test_mesh_faults(&m).open_edges, 0);
      assert_true(fabs(test_mesh_faults(&m).volume / files[i].volume - 1) < 1e-6);
      abbe_mesh_free(&m);
    }
    unlink(files[i].path);
  }
}

TEST(bad_files_are_refused) {
  static const struct {
    const char *path, *text;
  } files[] = {
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"},
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"},
      {"bad_mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
      {"bad_mesh.ply",
       "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n0 0 0\n1 0 0\n"},
      {"bad_mesh.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"bad_mesh.obj", ""},
      {"bad_mesh.ply", "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\n"
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
       "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
       "\"bufferViews\":[{\"buffer\":0,\"byteLength\":12}],\"buffers\":[{\"byteLength\":12,\"uri\":"
       "\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA\"}]}"},
      {"bad_mesh.fbx", "no"},
      {"bad_mesh", "no"},
  };
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    abbe_mesh m;
    abbe_error why = {0};
    write_text(files[i].path, files[i].text);
    if (abbe_mesh_load(files[i].path, ABBE_NORMALS_AUTO, &m, NULL, &why) == ABBE_OK)
      fail_msg("file %zu (%s) was read", i, files[i].path);
    assert_contains(why.text, files[i].path);
    /* points and lines alone */
    if (i >= 1 && i <= 3) assert_contains(why.text, "no faces were read from it");
    assert_null(m.face);
    unlink(files[i].path);
  }
  abbe_mesh m;
  REFUSED(ABBE_IO, "No such file or directory",
          abbe_mesh_load("no_such_file.obj", ABBE_NORMALS_AUTO, &m, NULL, &error));
}

static abbe_mesh load(const char *path, const char *text, abbe_mesh_normals normals) {
  abbe_mesh m;
  write_text(path, text);
  OK(abbe_mesh_load(path, normals, &m, NULL, &error));
  unlink(path);
  return m;
}

/* Normals of no good length, one against its face, one that grazes it and one that is none. */
static const char normals_obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                  "vn 0 0 -2\nvn 0.6 0 -0.8\nvn 0.6 0 0.8\nvn 1 0 0\nvn 0 0 0\n"
                                  "f 1//1 3//2 2//3\nf 1//4 2//5 4//1\nf 1//1 4//1 3//1\n"
                                  "f 2//1 3//1 4//1\n";

/* Scanners leave points that no face names: they are no part of its bounds. */
TEST(points_without_faces_are_left_out) {
  OWNED(abbe_mesh, m) = load("t_far.ply",
                             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                             "property float y\nproperty float z\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n"
                             "0 0 0\n9 9 9\n1 0 0\n0 1 0\n3 0 2 3\n",
                             ABBE_NORMALS_SMOOTH);
  assert_int_equal(m.vertex_count, 3);
  assert_near(test_mesh_faults(&m).max[2], 0, 0);
}

TEST(a_file_s_normals_are_its_default) {
  OWNED(abbe_mesh, m) = load("t_normals.obj", normals_obj, ABBE_NORMALS_AUTO);
  assert_true(m.given_normals);
  const double *a = m.normal[m.face[0][0]], *b = m.normal[m.face[0][1]],
               *c = m.normal[m.face[0][2]];
  assert_near(a[2], -1, 1e-6);
  assert_near(b[0], 0.6, 1e-6);
  assert_near(c[2], -0.8, 1e-6); /* turned to its face's side */
  assert_near(c[0], -0.6, 1e-6);
  assert_near(m.normal[m.face[1][0]][1], -1, 1e-6); /* the face's own */
  assert_near(m.normal[m.face[1][1]][1], -1, 1e-6);
  abbe_mesh_free(&m);
  m = load("t_normals.obj", normals_obj, ABBE_NORMALS_FLAT);
  assert_false(m.given_normals);
  assert_near(m.normal[m.face[0][1]][2], -1, 1e-12);
  abbe_mesh_free(&m);
  /* an STL's are those of its faces, right or wrong */
  m = load("t_normals.stl", tetrahedron_stl, ABBE_NORMALS_AUTO);
  assert_false(m.given_normals);
}

TEST(smooth_normals_are_shared_across_split_vertices) {
  const double size[3] = {1, 1, 1};
  MADE(abbe_mesh, m, abbe_shape_box(size, &m, &error));
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_SMOOTH, &error));
  assert_int_equal(m.vertex_count, 24);
  for (size_t v = 0; v < 24; v++)
    assert_true(abbe_vector_dot(m.normal[v], m.position[v]) > 0.8 * sqrt(0.75));
}

/* Laws of every mesh: a face's corners lie in its chart's rectangle, and its normal within 60
 * degrees of the rectangle's. */
static void check_laws(const abbe_mesh *mesh, const abbe_mesh_charts *charts) {
  for (size_t i = 0; i < mesh->face_count; i++) {
    double n[3], across[3];
    assert_true(charts->face[i] < charts->count);
    const double *p = charts->parallelogram[charts->face[i]];
    abbe_vector_cross(p + 3, p + 6, across);
    assert_true(abbe_vector_normalise(across));
    for (int c = 0; c < 3; c++) {
      double from[3];
      abbe_vector_subtract(mesh->position[mesh->face[i][c]], p, from);
      for (int edge = 3; edge < 9; edge += 3) {
        const double at = abbe_vector_dot(from, p + edge) / abbe_vector_dot(p + edge, p + edge);
        assert_true(at > -1e-12 && at < 1 + 1e-12);
      }
    }
    abbe_vector_triangle(mesh->position[mesh->face[i][0]], mesh->position[mesh->face[i][1]],
                         mesh->position[mesh->face[i][2]], n);
    assert_true(!abbe_vector_normalise(n) || abbe_vector_dot(n, across) > 0.5 - 1e-12);
  }
}

TEST(a_box_has_a_chart_a_side) {
  const double size[3] = {1, 2, 3};
  MADE(abbe_mesh, box, abbe_shape_box(size, &box, &error));
  MADE(abbe_mesh_charts, charts, abbe_mesh_charts_make(&box, &charts, &error));
  assert_int_equal(charts.count, 6);
  double area = 0;
  for (size_t c = 0; c < charts.count; c++) {
    double across[3];
    abbe_vector_cross(charts.parallelogram[c] + 3, charts.parallelogram[c] + 6, across);
    area += abbe_vector_length(across);
  }
  assert_true(fabs(area - 2 * (1 * 2 + 2 * 3 + 3 * 1)) < 1e-12);
  check_laws(&box, &charts);
}

/* Caps of 60 degrees around x leave bands around y, and those nothing around z but four corners. */
TEST(curved_meshes_have_few) {
  MADE(abbe_mesh, mesh, abbe_shape_sphere(1, 5, &mesh, &error));
  MADE(abbe_mesh_charts, charts, abbe_mesh_charts_make(&mesh, &charts, &error));
  print_message("sphere: %zu charts\n", charts.count);
  assert_int_in_range(charts.count, 6, 6);
  check_laws(&mesh, &charts);
  abbe_mesh_charts_free(&charts);
  abbe_mesh_free(&mesh);
  OK(abbe_shape_ring(1, 0.3, 128, 64, &mesh, &error));
  OK(abbe_mesh_charts_make(&mesh, &charts, &error));
  print_message("ring: %zu charts\n", charts.count);
  assert_int_in_range(charts.count, 8, 16);
  check_laws(&mesh, &charts);
}

/* Split vertices hang together, what only lies side by side does not, and slivers are no charts. */
TEST(what_hangs_together) {
  static const double at[11][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {7, 0, 0}, {8, 0, 0}};
  static const uint32_t face[4][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 9}};
  MADE(abbe_mesh, mesh, abbe_mesh_make(11, 4, false, &mesh, &error));
  memcpy(mesh.position, at, sizeof at);
  memcpy(mesh.face, face, sizeof face);
  MADE(abbe_mesh_charts, charts, abbe_mesh_charts_make(&mesh, &charts, &error));
  assert_int_equal(charts.count, 2);
  assert_int_equal(charts.face[0], charts.face[1]);
  assert_int_not_equal(charts.face[0], charts.face[2]);
  assert_true(charts.parallelogram[charts.face[2]][0] == 5);
  abbe_mesh_charts_free(&charts);
  mesh.face_count = 1;
  mesh.face[0][1] = mesh.face[0][0];
  OK(abbe_mesh_charts_make(&mesh, &charts, &error));
  assert_int_equal(charts.count, 0);
}
