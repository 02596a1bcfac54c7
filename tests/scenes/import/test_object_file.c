#include "tests/check.h"

#include "base/maths.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/import/scene_file.h"
#include "scenes/import/scene_reading.h"
#include "scenes/import/scene_value.h"
#include "spectral/formats/material_import.h"

static abbe_material_table table;

static void load_table(void) {
  OK(abbe_material_table_load(NULL, &table, &error));
}

static void free_table(void) {
  abbe_material_table_free(&table);
}

/* The object as a scene of its own, which frees it. */
static abbe_scene read(const char *text) {
  abbe_yaml *yaml;
  enum { ROOM = 4 };
  abbe_scene scene = {.object = calloc(ROOM, sizeof(abbe_object))};
  assert_non_null(scene.object);
  OK(abbe_yaml_parse(text, strlen(text), "text", &yaml, &error));
  OK(abbe_object_read(yaml, abbe_yaml_root(yaml), ABBE_SOURCE_DIR "/tests/bad/", &table,
                      scene.object, ROOM, &scene.object_count, &error));
  abbe_yaml_free(yaml);
  return scene;
}

/* In a sentence that has those words and the line. */
static void refuses(const char *object, const char *says) {
  OWNED(abbe_scene, one) = {.object = calloc(1, sizeof *one.object)};
  abbe_error why = {0};
  abbe_yaml *yaml;
  const char *text = printed("\n%s", object);
  OK(abbe_yaml_parse(text, strlen(text), "text", &yaml, &error));
  assert_int_not_equal(abbe_object_read(yaml, abbe_yaml_root(yaml), ABBE_SOURCE_DIR "/tests/bad/",
                                        &table, one.object, 1, &one.object_count, &why),
                       ABBE_OK);
  if (strstr(why.text, says) == NULL || strstr(why.text, "text:2:") == NULL)
    fail_msg("%s", why.text);
  abbe_yaml_free(yaml);
}

GROUP(load_table, free_table);

/* Designs that ship keep their planes, and are as wide as they are asked to be. */
TEST(cuts_are_solids_of_their_planes) {
  static const struct {
    const char *design;
    size_t planes;
    double height; /* of the width */
  } cuts[] = {{"brilliant-quartz", 73, (0.980784 + 0.473982) / 2.039182},
              {"brilliant-diamond", 73, (0.903536 + 0.349458) / 2.039182},
              {"step-square", 21, 0}};
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
    OWNED(abbe_scene, scene) = read(
        printed("{shape: cut, file: ../../scenes/designs/%s.asc, width: 0.01, material: water}",
                cuts[i].design));
    const abbe_object *stone = &scene.object[0];
    assert_int_equal(stone->exact.kind, ABBE_EXACT_CONVEX);
    assert_int_equal(stone->exact.count, cuts[i].planes);
    assert_true(fabs(fmax(stone->max[0] - stone->min[0], stone->max[1] - stone->min[1]) - 0.01) <
                1e-12);
    if (cuts[i].height > 0)
      assert_true(fabs((stone->max[2] - stone->min[2]) / 0.01 - cuts[i].height) < 1e-6);
    bool listed = false; /* among what the scene is read from */
    for (size_t k = 0; k < abbe_scene_file_count(&scene); k++) {
      const char *file = abbe_scene_file(&scene, k);
      listed = listed || (file != NULL && strstr(file, cuts[i].design) != NULL);
    }
    assert_true(listed);
  }
}

#define STONE "{shape: cut, width: 0.01, material: water, file: "

static abbe_scene read_stone(const char *file, const char *keys) {
  return read(printed(STONE "'%s'%s}", file, keys));
}

/* Whether the stone has the plane that another one's becomes where tangents grow by k. */
static bool has_plane(const abbe_exact *stone, const double plane[4], double k) {
  double n[3] = {plane[0], plane[1], plane[2] / k}, off[3];
  assert_true(abbe_vector_normalise(n));
  for (size_t i = 0; i < stone->count; i++) {
    abbe_vector_subtract(stone->plane[i], n, off);
    if (abbe_vector_length(off) < 1e-9) return true;
  }
  return false;
}

/* Every facet's tangent is as many times what it was as the main facets' is, its azimuth and the
 * outline stay, and no corner lies outside any plane. */
static void recut(const char *file, const char *keys, double crown, double pavilion) {
  OWNED(abbe_scene, own) = read_stone(file, "");
  OWNED(abbe_scene, other) = read_stone(file, keys);
  const abbe_object *a = &own.object[0], *b = &other.object[0];
  const double upright = 1e-6;
  assert_int_equal(b->exact.kind, ABBE_EXACT_CONVEX);
  assert_int_equal(a->exact.count, b->exact.count);
  for (size_t i = 0; i < a->exact.count; i++) {
    const double *p = a->exact.plane[i], *q = b->exact.plane[i];
    const double k = fabs(p[2]) < upright ? 1 : p[2] > 0 ? crown : pavilion;
    if (!has_plane(&b->exact, p, k)) fail_msg("%s%s: plane %zu of %g", file, keys, i, p[2]);
    for (size_t v = 0; v < b->mesh.vertex_count; v++)
      assert_true(abbe_vector_dot(q, b->mesh.position[v]) <= q[3] + 1e-9 * 0.01);
  }
  for (int k = 0; k < 2; k++) {
    assert_near(b->min[k], a->min[k], 1e-12);
    assert_near(b->max[k], a->max[k], 1e-12);
    assert_near(b->cut_deg[k], a->cut_deg[k], 0); /* the design's, not what it is cut at */
  }
}

static void write_gcs(const char *path) {
  MADE(abbe_cut, cut,
       abbe_cut_file_read(ABBE_SOURCE_DIR "/scenes/designs/emerald.asc", &cut, NULL, &error));
  MADE(abbe_cut_polyhedron, stone, abbe_cut_polyhedron_make(&cut, 0, &stone, &error));
  FILE *to = fopen(path, "w");
  assert_non_null(to);
  OK(abbe_cut_gcs_write(&cut, &stone, to, NULL, &error));
  fclose(to);
}

TEST(cuts_are_cut_at_other_angles) {
  const double turn = 3.14159265358979323846 / 180;
  const char *const quartz = "../../scenes/designs/brilliant-quartz.asc";
  char folder[] = "/tmp/abbe-test-design-XXXXXX";
  abbe_scene scene = read_stone(quartz, "");
  assert_near(scene.object[0].cut_deg[0], 42, 0);
  assert_near(scene.object[0].cut_deg[1], 43, 0);
  abbe_scene_free(&scene);
  recut(quartz, ", crown: 36", tan(36 * turn) / tan(42 * turn), 1);
  recut(quartz, ", pavilion: 40.5", 1, tan(40.5 * turn) / tan(43 * turn));
  recut(quartz, ", crown: 55, pavilion: 60", tan(55 * turn) / tan(42 * turn),
        tan(60 * turn) / tan(43 * turn));
  recut(quartz, ", crown: 42, pavilion: 43", 1, 1);
  /* its crown and pavilion meet between the girdle's facets: one angle moves both */
  const char *const barion = "../../scenes/designs/barion.asc";
  const double both = tan(38 * turn) / tan(41 * turn);
  scene = read_stone(barion, "");
  assert_near(scene.object[0].cut_deg[0], 0, 0);
  assert_near(scene.object[0].cut_deg[1], 41, 0);
  abbe_scene_free(&scene);
  recut(barion, ", pavilion: 38", both, both);
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/emerald.gcs", folder);
  write_gcs(path);
  scene = read_stone(path, "");
  const double own[] = {scene.object[0].cut_deg[0], scene.object[0].cut_deg[1]};
  assert_true(own[0] > 20 && own[0] < 70 && own[1] > 20 && own[1] < 70);
  abbe_scene_free(&scene);
  recut(path, printed(", crown: %.9f, pavilion: %.9f", own[0] - 4, own[1] + 3),
        tan((own[0] - 4) * turn) / tan(own[0] * turn),
        tan((own[1] + 3) * turn) / tan(own[1] * turn));
  assert_int_equal(remove(path), 0);
  assert_int_equal(remove(folder), 0);
}

TEST(angles_that_no_stone_has) {
  static const char *const wrong[][2] = {
      {", crown: 90", "'crown' is the angle of that side's main facets, between 0 and 90"},
      {", pavilion: 0", "'pavilion' is the angle"},
      {", pavilion: -41", "'pavilion' is the angle"},
      {", crown: steep", "crown: steep"},
      {", crown: 89.9", "tangents can become"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    refuses(printed(STONE "../../scenes/designs/brilliant-quartz.asc%s}", wrong[i][0]),
            wrong[i][1]);
  }
  refuses(STONE "../../scenes/designs/rose.asc, pavilion: 40}", "pavilion has no slanted facet");
  refuses(STONE "../../scenes/designs/barion.asc, crown: 30, pavilion: 40}", "same tangent ratio");
}

/* With its defaults; refusals name the line. */
TEST(knots_are_read) {
  static const struct {
    const char *keys, *says;
  } bad[] = {{"radius: 0.03", "meets itself"},
             {"spines: 9", "'radius'"},
             {"radius: 0.01, across: 9999", "across: 9999"},
             {"radius: 0.01, spine: -1", "spine: -1"}};
  abbe_scene scene = read("{shape: knot, major: 0.05, minor: 0.025, radius: 0.01, spines: 20, "
                          "along: 90, across: 12, material: water}");
  assert_int_equal(scene.object[0].mesh.face_count, 2 * 90 * 12);
  abbe_scene_free(&scene);
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    refuses(printed("{shape: knot, major: 0.05, minor: 0.025, %s, reflectance: 0.5}", bad[i].keys),
            bad[i].says);
  }
}

/* With room for no object more. */
TEST(rooms_are_full) {
  refuses("{shape: sphere, radius: 1, material: water, clouds: [{radius: 0.1}]}",
          "as far as the scene has room");
  refuses("{shape: sphere, radius: 1, material: water, setting: {kind: band, metal: gold}}",
          "1 settings: a stone has up to 4, and a scene 1024 objects");
  refuses("{shape: water, size: [1, 1, 0.1], material: water, time: soon}", "'time: soon'");
}

/* More names of facets than a sentence has room for. */
TEST(many_names_of_facets) {
  char text[4096] = "g 96 0\na 90 1 96 n G 24 48 72\na -40 0.3 96 24 48 72\n";
  for (int i = 0; i < 24; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "a %d %g %d n a-name-that-is-long-%d\n", 20 + i % 2, 0.4 + 1e-4 * i, 1 + 4 * i, i);
  char path[] = "/tmp/abbe-test-names-XXXXXX";
  assert_non_null(mkdtemp(path));
  const char *file = printed("%s/a.asc", path);
  FILE *to = fopen(file, "w");
  assert_non_null(to);
  fputs(text, to);
  fclose(to);
  refuses(printed("{shape: cut, file: %s, width: 0.01, material: water, coating: {layers: [[1.38, "
                  "1]], faces: culet}}",
                  file),
          "a-name-that-is-long-3, a-name-that");
  assert_int_equal(remove(file) + remove(path), 0);
}

TEST(a_sphere_stays_one_under_similarities_only) {
  OWNED(abbe_scene, scene) =
      read("{shape: sphere, radius: 2, material: water, transform: [{scale: 0.5}, {rotate: {axis: "
           "[1, 2, 3], angle: 40}}, {translate: [1, 2, 3]}]}");
  const abbe_exact *exact = &scene.object[0].exact;
  assert_int_equal(exact->kind, ABBE_EXACT_SPHERE);
  assert_true(fabs(exact->radius - 1) < 1e-12);
  assert_true(fabs(exact->centre[2] - 3) < 1e-12);
  assert_true(fabs(scene.object[0].max[0] - 2) < 1e-12);
  abbe_scene_free(&scene);
  scene = read("{shape: sphere, radius: 1, material: water, transform: [{scale: [-2, 2, 2]}]}");
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_SPHERE);
  assert_true(fabs(scene.object[0].exact.radius - 2) < 1e-12);
  assert_null(scene.object[0].fixes);
  abbe_scene_free(&scene);
  scene = read("{shape: sphere, radius: 1, material: water, transform: [{scale: [1, 1, 2]}]}");
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_NONE);
}

/* z unless the scene says else, turned and never stretched with the object. */
TEST(crystals_have_an_optic_axis) {
  const struct {
    const char *keys;
    double axis[3];
  } rows[] = {
      {"", {0, 0, 1}},
      {"axis: [0, 3, 4],", {0, 0.6, 0.8}},
      {"axis: [0, 0, -1e-3],", {0, 0, -1}},
      {"axis: [1, 0, 1], transform: [{rotate: {axis: [0, 0, 1], angle: 90}}, {scale: 7}],",
       {0, 0.70710678118654752, 0.70710678118654752}},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    OWNED(abbe_scene, scene) =
        read(printed("{shape: box, size: [1, 1, 1], %s material: calcite}", rows[i].keys));
    for (int k = 0; k < 3; k++)
      assert_true(fabs(scene.object[0].axis[k] - rows[i].axis[k]) < 1e-12);
  }
}

/* Whole or open, with its exact surface where that is known, and nothing of it is mended. */
TEST(mirrors_are_metals_or_numbers_of_any_shape) {
  static const struct {
    const char *text;
    abbe_exact_kind exact;
    const char *conductor; /* NULL: the number */
    double reflectance;
  } rows[] = {
      {"{shape: sphere, radius: 1, mirror: silver}", ABBE_EXACT_SPHERE, "silver", 0},
      {"{shape: sphere, radius: 1, mirror: 0.9}", ABBE_EXACT_SPHERE, NULL, 0.9},
      {"{shape: rectangle, width: 1, height: 1, mirror: 1}", ABBE_EXACT_PARALLELOGRAMS, NULL, 1},
      {"{shape: box, size: [1, 2, 3], mirror: Gold}", ABBE_EXACT_PARALLELOGRAMS, "gold", 0},
      {"{shape: ring, major: 1, minor: 0.2, mirror: 0}", ABBE_EXACT_NONE, NULL, 0},
      {"{shape: prism, side: 1, length: 1, mirror: mercury}", ABBE_EXACT_NONE, "mercury", 0},
      {"{shape: brilliant, diameter: 1, mirror: 5e-1}", ABBE_EXACT_NONE, NULL, 0.5},
      {"{mesh: open.obj, mirror: copper, fit: 0.5}", ABBE_EXACT_NONE, "copper", 0},
      {"{mesh: inverted.obj, mirror: copper}", ABBE_EXACT_NONE, "copper", 0},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    OWNED(abbe_scene, scene) = read(rows[i].text);
    const abbe_object *o = &scene.object[0];
    assert_int_equal(scene.object_count, 1);
    assert_int_equal(abbe_object_kind_of(o), ABBE_OBJECT_MIRROR);
    assert_ptr_equal(abbe_scene_mirror(&scene), o);
    assert_int_equal(o->exact.kind, rows[i].exact);
    assert_null(o->material);
    assert_null(o->fixes);
    assert_true(o->mirror_reflectance == rows[i].reflectance);
    if (rows[i].conductor != NULL)
      assert_string_equal(o->conductor->name, rows[i].conductor);
    else
      assert_null(o->conductor);
  }
  OWNED(abbe_scene, scene) = read("{shape: sphere, radius: 1, material: water}");
  assert_int_equal(abbe_object_kind_of(&scene.object[0]), ABBE_OBJECT_REFRACTOR);
  assert_null(abbe_scene_mirror(&scene));
}

/* Along a direction or around an axis, which turns with the object. */
TEST(mirrors_may_be_brushed) {
  OWNED(abbe_scene, scene) = read("{shape: sphere, radius: 1, mirror: silver, roughness: 0.25}");
  assert_true(scene.object[0].brushing.facets.x == 0.25);
  assert_true(scene.object[0].brushing.facets.y == 0.25);
  abbe_scene_free(&scene);
  scene =
      read("{shape: sphere, radius: 1, mirror: 0.9, roughness: [0.1, 0.4], brushed: {around: [0, "
           "0, 2]}, transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [1, 2, 3]}]}");
  const abbe_brushing *b = &scene.object[0].brushing;
  assert_true(abbe_brushing_is_rough(b) && b->around);
  assert_true(b->facets.x == 0.1 && b->facets.y == 0.4);
  assert_true(fabs(b->axis[1] + 1) < 1e-12 && fabs(b->centre[1] - 2) < 1e-12);
  abbe_scene_free(&scene);
  scene = read("{shape: sphere, radius: 1, mirror: 0.9, roughness: 0}");
  assert_false(abbe_brushing_is_rough(&scene.object[0].brushing));
}

TEST(boxes_are_planes_or_parallelograms) {
  OWNED(abbe_scene, scene) = read("{shape: box, size: [1, 2, 3], material: diamond}");
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_CONVEX);
  assert_int_equal(scene.object[0].exact.count, 6);
  abbe_scene_free(&scene);
  scene = read("{shape: box, size: [1, 2, 3], reflectance: [0.1, 0.2, 0.3], transform: [{scale: "
               "[-1, 1, 1]}, {rotate: {axis: [0, 0, 1], angle: 30}}]}");
  const abbe_object *box = &scene.object[0];
  assert_int_equal(box->exact.kind, ABBE_EXACT_PARALLELOGRAMS);
  assert_int_equal(box->exact.count, 6);
  assert_true(box->reflectance[2] == 0.3);
  for (size_t i = 0; i < 6; i++) {
    const double *p = box->exact.parallelogram[i];
    double n[3], middle[3];
    abbe_vector_cross(p + 3, p + 6, n);
    for (int k = 0; k < 3; k++) middle[k] = p[k] + 0.5 * (p[3 + k] + p[6 + k]);
    assert_true(abbe_vector_dot(n, middle) > 0);
  }
}

TEST(steps_apply_in_order) {
  OWNED(abbe_scene, scene) =
      read("{shape: rectangle, width: 1, height: 1, reflectance: 1, transform: [{translate: [1, 0, "
           "0]}, {rotate: {axis: [0, 0, 1], angle: 90}}]}");
  assert_true(fabs(scene.object[0].min[1] - 0.5) < 1e-12);
  assert_true(fabs(scene.object[0].max[1] - 1.5) < 1e-12);
}

TEST(look_turns_z_to_the_target) {
  OWNED(abbe_scene, scene) = read("{shape: rectangle, width: 2, height: 1, reflectance: 1, "
                                  "transform: [{look: {from: [1, 2, 3], to: [1, -7, 3]}}]}");
  const abbe_object *o = &scene.object[0];
  assert_true(fabs(o->mesh.normal[0][1] + 1) < 1e-12);
  assert_true(fabs(o->max[0] - 2) < 1e-12 && fabs(o->max[2] - 3.5) < 1e-12);
  assert_true(fabs(o->min[1] - 2) < 1e-12 && fabs(o->max[1] - 2) < 1e-12);
}

TEST(an_inverted_mesh_is_fixed_and_said) {
  OWNED(abbe_scene, scene) = read("{mesh: inverted.obj, smooth: false, material: n-sf11}");
  assert_non_null(scene.object[0].fixes);
  assert_non_null(strstr(scene.object[0].fixes, "inside-out"));
  assert_int_equal(scene.object[0].exact.kind, ABBE_EXACT_CONVEX);
  assert_int_equal(scene.object[0].exact.count, 4);
}

/* A cube without normals in its file is cut, unless the scene says otherwise; the same to whoever
 * asks for its planes and to whoever asks for its normals. */
TEST(a_die_is_what_the_scene_says) {
  static const struct {
    const char *key;
    bool cut;
  } dice[] = {{"", true}, {"smooth: true, ", false}, {"smooth: false, ", true}};
  for (size_t i = 0; i < sizeof dice / sizeof *dice; i++) {
    OWNED(abbe_scene, scene) =
        read(printed("{mesh: ../meshes/die.obj, %sfit: 0.02, material: water}", dice[i].key));
    const abbe_object *o = &scene.object[0];
    assert_int_equal(o->exact.kind, dice[i].cut ? ABBE_EXACT_CONVEX : ABBE_EXACT_NONE);
    assert_int_equal(o->exact.convex.verdict,
                     dice[i].cut ? ABBE_CONVEX_SOLID : ABBE_CONVEX_ROUNDED);
    assert_true(fabs(o->max[0] - o->min[0] - 0.02) < 1e-15);
    double own[3];
    const uint32_t *f = o->mesh.face[0];
    abbe_vector_triangle(o->mesh.position[f[0]], o->mesh.position[f[1]], o->mesh.position[f[2]],
                         own);
    assert_true(abbe_vector_normalise(own));
    for (int k = 0; k < 3; k++)
      assert_int_equal(abbe_vector_dot(own, o->mesh.normal[f[k]]) > 0.999, dice[i].cut);
  }
}

TEST(parts_of_a_mesh_are_objects) {
  OWNED(abbe_scene, scene) = read("{name: boxes, mesh: ../meshes/crossing.obj, material: water}");
  assert_int_equal(scene.object_count, 2);
  assert_string_equal(scene.object[1].name, "boxes (part 2 of 2)");
  assert_int_equal(scene.object[1].exact.count, 6);
  assert_non_null(strstr(scene.object[0].fixes, "2 solids"));
  abbe_scene_free(&scene);
  /* what receives light is not parted */
  scene = read("{mesh: ../meshes/crossing.obj, reflectance: 1}");
  assert_int_equal(scene.object_count, 1);
  assert_null(scene.object[0].fixes);
}

TEST(paths_follow_the_folder) {
  FREED char *path = abbe_scene_value_path("scenes/", "a.png");
  assert_string_equal(path, "scenes/a.png");
  free(path);
  path = abbe_scene_value_path("scenes/", "/a.png");
  assert_string_equal(path, "/a.png");
}

/* How crystals lie in their objects: what is read, made square and refused. */

#define HEAD                                                                                       \
  "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"                                            \
  "lights: [{name: l, kind: point, position: [0, 0, 2], intensity: 1}]\nobjects:\n"                \
  "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 1}\n"                       \
  "- {name: a, shape: box, size: [0.1, 0.1, 0.1], transform: [{rotate: {axis: [0, 0, 1], angle: "  \
  "90}}, {translate: [0, 0, 0.2]}], "

static abbe_result parse(const char *rest, abbe_scene *scene, abbe_error *error) {
  const char *text = printed(HEAD "%s}\n", rest);
  return abbe_scene_parse(text, strlen(text), "scene", NULL, scene, error);
}

static void check_axes(const char *rest, const double x[3], const double z[3]) {
  MADE(abbe_scene, scene, parse(rest, &scene, &error));
  const abbe_object *o = &scene.object[1];
  for (int k = 0; k < 3; k++) {
    assert_near(o->axis_x[k], x[k], 1e-12);
    assert_near(o->axis[k], z[k], 1e-12);
  }
}

TEST(axes_turn_with_the_object) {
  const double r = sqrt(0.5);
  check_axes("material: topaz", (double[3]){0, 1, 0}, (double[3]){0, 0, 1});
  check_axes("material: topaz, axes: {x: [0, 0, 3], z: [2, 0, 0]}", (double[3]){0, 0, 1},
             (double[3]){0, 1, 0});
  check_axes("material: topaz, axes: {z: [1, 0, 1]}", (double[3]){0, r, -r}, (double[3]){0, r, r});
  check_axes("material: calcite, axes: {z: [0, 1, 0]}", (double[3]){0, 1, 0},
             (double[3]){-1, 0, 0});
}

TEST(x_is_made_square_to_z) {
  MADE(abbe_scene, scene,
       parse("material: topaz, axes: {x: [1, 0, 0.1], z: [0, 0, 1]}", &scene, &error));
  assert_near(abbe_vector_dot(scene.object[1].axis_x, scene.object[1].axis), 0, 1e-15);
  assert_near(scene.object[1].axes_turned, atan(0.1), 1e-12);
}

TEST(axes_that_cannot_be_are_refused) {
  const struct {
    const char *rest, *part;
  } rows[] = {
      {"material: n-bk7, axes: {x: [1, 0, 0], z: [0, 0, 1]}",
       "'axes' is for the axes of a crystal; the material 'n-bk7' has one index"},
      {"material: topaz, axis: [0, 0, 1]", "has three indices: give 'axes'"},
      {"material: topaz, axis: [0, 0, 1], axes: {z: [0, 0, 1]}", "leave one out"},
      {"material: topaz, axes: {x: [1, 0, 1], z: [2, 0, 2]}", "x and z are parallel"},
      {"material: topaz, axes: {x: [0, 0, 0], z: [0, 0, 1]}", "'x' is zero"},
      {"material: topaz, axes: {x: [1, 0], z: [0, 0, 1]}", "'x'"},
      {"material: topaz, axes: {x: [1, 0, 0], z: [0, 0, 1], y: [0, 1, 0]}", "has no key 'y'"},
      {"material: topaz, axes: [0, 0, 1]", "'axes' wants the principal axes x and z"},
      {"reflectance: 1, axes: {z: [0, 0, 1]}", "this object has no 'material'"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_scene scene;
    REFUSED(ABBE_SCHEMA, rows[i].part, parse(rows[i].rest, &scene, &error));
  }
}
