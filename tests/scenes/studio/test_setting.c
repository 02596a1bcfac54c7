#include "tests/check.h"
#include "tests/patience.h"

#include "base/maths.h"
#include "scenes/cuts/cut_file.h"
#include "scenes/import/scene_file.h"
#include "scenes/object_motion.h"
#include "scenes/shapes/shape.h"
#include "scenes/studio/setting.h"

#define WIDTH 0.0065

static void load(const char *design, abbe_object *out) {
  OWNED(abbe_cut_polyhedron, stone);
  MADE(abbe_cut, cut,
       abbe_cut_file_read_stone(printed(ABBE_SOURCE_DIR "/scenes/designs/%s.asc", design),
                                ABBE_CUT_WELD, &cut, &stone, NULL, &error));
  const double own = fmin(stone.max[0] - stone.min[0], stone.max[1] - stone.min[1]);
  *out = (abbe_object){0};
  OK(abbe_cut_polyhedron_mesh(&cut, &stone, WIDTH / own, &out->mesh, &error));
}

static abbe_mesh_report closed(const abbe_mesh *mesh, size_t shells) {
  abbe_mesh_report report;
  OK(abbe_mesh_check(mesh, &report, &error));
  assert_int_equal(report.open_edges, 0);
  assert_int_equal(report.crowded_edges + report.touching_edges, 0);
  assert_int_equal(report.flipped_edges, 0);
  assert_int_equal(report.degenerate_faces, 0);
  assert_int_equal(report.shells, shells);
  assert_true(report.volume > 0);
  return report;
}

/* The least distance between the two surfaces' corners and the other's faces, m. */
static double apart(const abbe_object *a, const abbe_object *b) {
  double least = INFINITY;
  for (size_t v = 0; v < a->mesh.vertex_count; v++)
    least = fmin(least, abbe_object_distance_within(b, a->mesh.position[v], least));
  for (size_t v = 0; v < b->mesh.vertex_count; v++)
    least = fmin(least, abbe_object_distance_within(a, b->mesh.position[v], least));
  return least;
}

/* Every kind around every design is closed, holds the stone by the gap and does not enter it. */
TEST(metal_holds_every_cut) {
  static const char *const designs[] = {"brilliant-diamond", "oval",    "cushion",  "pear",
                                        "marquise",          "emerald", "princess", "barion"};
  static const size_t shells[] = {6, 1, 6, 1, 5};
  for (size_t d = 0; d < sizeof designs / sizeof *designs; d++) {
    abbe_object stone;
    load(designs[d], &stone);
    for (int kind = 0; kind < ABBE_SETTING_COUNT; kind++) {
      abbe_object metal = {0};
      OK(abbe_setting_make(&stone.mesh, &(abbe_setting){.kind = (abbe_setting_kind)kind},
                           &metal.mesh, &error));
      closed(&metal.mesh, shells[kind]);
      for (size_t v = 0; v < metal.mesh.vertex_count; v++)
        assert_false(abbe_mesh_contains(&stone.mesh, metal.mesh.position[v]));
      for (size_t v = 0; v < stone.mesh.vertex_count; v++)
        assert_false(abbe_mesh_contains(&metal.mesh, stone.mesh.position[v]));
      const double gap = apart(&stone, &metal), meant = ABBE_SETTING_GAP * WIDTH;
      if (kind == ABBE_SETTING_BAND) /* below the culet, which is not always in the middle */
        assert_true(gap > 0.19 * ABBE_SETTING_THICK * WIDTH && gap < 0.1 * WIDTH);
      else if (!(gap > 0.3 * meant && gap < 1.5 * meant))
        fail_msg("%s, kind %d: %g of %g", designs[d], kind, gap, meant);
      abbe_mesh_free(&metal.mesh);
    }
    abbe_mesh_free(&stone.mesh);
  }
}

/* As many claws as asked for, and all reach over the crown and touch it. */
TEST(prongs_are_counted) {
  abbe_object stone;
  load("brilliant-diamond", &stone);
  for (size_t count = 3; count <= 8; count += count == 4 ? 2 : 1) {
    MADE(abbe_mesh, metal,
         abbe_setting_make(&stone.mesh, &(abbe_setting){.count = count}, &metal, &error));
    closed(&metal, count + 2);
    for (size_t i = 0; i < count; i++) {
      const double a = 2 * ABBE_PI * ((double)i + 0.5) / (double)count;
      double nearest = INFINITY, in = INFINITY;
      for (size_t v = 0; v < metal.vertex_count; v++) {
        const double *p = metal.position[v], out = p[0] * cos(a) + p[1] * sin(a);
        if (fabs(p[1] * cos(a) - p[0] * sin(a)) > 0.07 * WIDTH || out < 0 || p[2] < 0.0006)
          continue;
        nearest = fmin(nearest, abbe_object_distance(&stone, p));
        in = fmin(in, out);
      }
      assert_true(nearest < 3 * ABBE_SETTING_GAP * WIDTH);
      assert_true(in < 0.46 * WIDTH);
    }
  }
  abbe_mesh_free(&stone.mesh);
}

/* Around a cylinder, whose metal is known: a wall of revolution with a lip, and a plate with a
 * round hole. */
TEST(volumes_are_those_of_their_sections) {
  enum { SIDES = 2048 };
  static const double r = 0.003, high = 0.002, t = 0.0006;
  const double profile[][2] = {{0, 0}, {r, 0}, {r, high}, {0, high}};
  MADE(abbe_mesh, stone, abbe_shape_lathe(profile, 4, SIDES, &stone, &error));
  const double gap = ABBE_SETTING_GAP * 2 * r, in = r + gap;
  MADE(abbe_mesh, metal,
       abbe_setting_make(&stone, &(abbe_setting){.kind = ABBE_SETTING_PAVE, .thick = t, .count = 2},
                         &metal, &error));
  abbe_mesh_report report = closed(&metal, 3);
  const double side = 2 * r + t, bead = 4.0 / 3 * ABBE_PI * pow(0.35 * t, 3);
  const double plate = (side * side - ABBE_PI * in * in) * (high + 0.5 * t);
  assert_near(report.volume, plate + 2 * bead, 2e-3 * plate);
  abbe_mesh_free(&metal);
  OK(abbe_setting_make(&stone, &(abbe_setting){.kind = ABBE_SETTING_BAND, .thick = t}, &metal,
                       &error));
  report = closed(&metal, 1);
  /* a superellipse of the fourth power, by Pappus */
  const double section = 4 * t * 1.3 * t * pow(tgamma(1.25), 2) / tgamma(1.5);
  const double band = section * 2 * ABBE_PI * (ABBE_SETTING_FINGER + t);
  assert_near(report.volume, band, 0.02 * band);
  abbe_mesh_free(&metal);
  OK(abbe_setting_make(&stone, &(abbe_setting){.kind = ABBE_SETTING_CHANNEL, .thick = t}, &metal,
                       &error));
  report = closed(&metal, 6);
  const double wall = 0.6 * t, foot = -0.4 * t, under = high + gap, half = r + t;
  const double walls =
      2 * 2 * half * (wall * (under + 0.2 * wall - foot) + 0.4 * wall * (1.3 * wall + gap));
  const double bars = 2 * (half - 0.1 * wall - in) * 2 * (in + 0.5 * wall) * wall;
  assert_near(report.volume, walls + bars, 1e-3 * walls);
}

TEST(what_cannot_be_set_is_refused) {
  abbe_mesh metal;
  MADE(abbe_mesh, stone, abbe_shape_rectangle(1, 1, &stone, &error));
  REFUSED(ABBE_GEOMETRY, "flat", abbe_setting_make(&stone, &(abbe_setting){0}, &metal, &error));
  abbe_mesh_free(&stone);
  OK(abbe_shape_sphere(1, 2, &stone, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "2 to 24",
          abbe_setting_make(&stone, &(abbe_setting){.count = 25}, &metal, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "half of the stone's width",
          abbe_setting_make(&stone, &(abbe_setting){.thick = 3}, &metal, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "20000 m",
          abbe_setting_make(&stone, &(abbe_setting){.radius = 3e4}, &metal, &error));
  abbe_mesh_free(&stone);
  OK(abbe_shape_sphere(1, 8, &stone, &error));
  assert_true(stone.face_count > ABBE_SETTING_FACES);
  REFUSED(ABBE_UNSUPPORTED, "triangles cannot be set",
          abbe_setting_make(&stone, &(abbe_setting){0}, &metal, &error));
}

/* A watch ends the work soon. */
TEST(a_setting_is_watched) {
  abbe_mesh metal;
  MADE(abbe_mesh, stone, abbe_shape_sphere(1, 2, &stone, &error));
  for (int kind = 0; kind < ABBE_SETTING_COUNT; kind++)
    for (size_t most = 0; most < 60; most += 50) {
      patience user = {.most = most};
      abbe_watch watch = {.goes_on = patience_lasts, .user = &user};
      if (most > 0 && kind == ABBE_SETTING_BAND) continue;
      abbe_watch_set(&watch);
      const abbe_result result =
          abbe_setting_make(&stone, &(abbe_setting){.kind = (abbe_setting_kind)kind}, &metal, NULL);
      abbe_watch_set(NULL);
      assert_int_equal(result, ABBE_CANCELLED);
      assert_int_equal(user.asked, most + 1);
    }
}

static abbe_result parse(const char *stone, abbe_scene *out, abbe_error *error) {
  const char *text =
      printed("camera: {eye: [0, -0.1, 0.1], target: [0, 0, 0]}\nenvironment: {uniform: 1}\n"
              "objects:\n- {name: gem, shape: cut, file: oval.asc, width: 6.5mm, %s}\n",
              stone);
  return abbe_scene_parse(text, strlen(text), ABBE_SOURCE_DIR "/scenes/designs/text", NULL, out,
                          error);
}

/* Metal is an ordinary object behind its stone, moves with it, and stands where both do. */
TEST(a_scene_sets_a_stone) {
  MADE(abbe_scene, scene,
       parse("material: ruby, stand: [1cm, 0, 2mm], transform: [{scale: 2}], setting: [{kind: "
             "prongs, count: 6, metal: platinum}, {kind: band, metal: gold}]",
             &scene, &error));
  assert_int_equal(scene.object_count, 3);
  const abbe_object *stone = &scene.object[0], *claws = &scene.object[1], *band = &scene.object[2];
  assert_string_equal(claws->name, "gem's prongs");
  assert_string_equal(claws->conductor->name, "platinum");
  assert_string_equal(band->conductor->name, "gold");
  closed(&claws->mesh, 8);
  assert_near(band->min[2], 0.002, 1e-12);
  assert_near(0.5 * (stone->min[0] + stone->max[0]), 0.01, 1e-12);
  assert_near(0.5 * (band->min[0] + band->max[0]), 0.01, 1e-12);
  assert_true(claws->holds && band->holds && !stone->holds);
  /* the finger is no larger for a stone that is */
  assert_near(band->max[0] - band->min[0],
              2 * (ABBE_SETTING_FINGER + 2 * ABBE_SETTING_THICK * 2 * WIDTH), 1e-5);
  assert_near(apart(stone, claws), 2 * ABBE_SETTING_GAP * WIDTH, ABBE_SETTING_GAP * WIDTH);
}

static void put_stl(const char *path, const abbe_mesh *mesh) {
  FILE *f = fopen(path, "w");
  assert_non_null(f);
  fprintf(f, "solid stone\n");
  for (size_t i = 0; i < mesh->face_count; i++) {
    fprintf(f, "facet normal 0 0 0\nouter loop\n");
    for (int k = 0; k < 3; k++) {
      const double *p = mesh->position[mesh->face[i][k]];
      fprintf(f, "vertex %.9g %.9g %.9g\n", p[0], p[1], p[2]);
    }
    fprintf(f, "endloop\nendfacet\n");
  }
  fprintf(f, "endsolid stone\n");
  fclose(f);
}

/* A stone in millimetres that gets its width, or is scaled, has a ring of the same finger. */
TEST(lengths_are_of_the_scene) {
  static const char *const sizes[] = {"width: 6.5mm", "fit: 6.5mm", "transform: [{scale: 1e-3}]"};
  MADE(abbe_mesh, ball, abbe_shape_sphere(3.25, 2, &ball, &error));
  put_stl("setting-mm.stl", &ball);
  for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
    const char *text = printed(
        "camera: {eye: [0, -0.1, 0.1], target: [0, 0, 0]}\nenvironment: {uniform: 1}\n"
        "objects:\n- {name: gem, mesh: setting-mm.stl, material: ruby, %s, setting: [{kind: "
        "band, metal: gold}, {kind: band, metal: gold, radius: 7mm, thick: 1mm}]}\n",
        sizes[i]);
    MADE(abbe_scene, scene, abbe_scene_parse(text, strlen(text), "./text", NULL, &scene, &error));
    const double t = ABBE_SETTING_THICK * 0.0065;
    const abbe_object *band = &scene.object[1];
    assert_near(band[0].max[0] - band[0].min[0], 2 * (ABBE_SETTING_FINGER + 2 * t), 1e-4);
    assert_near(band[1].max[0] - band[1].min[0], 2 * (0.007 + 2 * 0.001), 1e-4);
  }
  remove("setting-mm.stl");
}

/* Metal that holds a stone is tilted with it; other mirrors stay. */
TEST(metal_is_tilted_with_its_stone) {
  MADE(abbe_scene, scene,
       parse("material: ruby, setting: {kind: prongs, metal: gold}}\n"
             "- {name: mirror, shape: box, size: [1cm, 1cm, 1mm], mirror: 0.5, stand: [0, 0, -3cm]",
             &scene, &error));
  const double gap = apart(&scene.object[0], &scene.object[1]), mirror = scene.object[2].min[2];
  const double before = scene.object[1].min[2];
  OK(abbe_refractors_tilt(&scene, 0.4, 0, &error));
  assert_near(apart(&scene.object[0], &scene.object[1]), gap, 1e-9);
  assert_true(fabs(scene.object[1].min[2] - before) > 1e-4);
  assert_near(scene.object[2].min[2], mirror, 0);
}

TEST(what_is_no_setting_is_refused) {
  static const struct {
    const char *stone, *says;
    abbe_result code;
  } wrong[] = {
      {"reflectance: 1, setting: {kind: prongs, metal: gold}", "has no 'material'", ABBE_SCHEMA},
      {"material: ruby, setting: prongs", "must be a mapping such as", ABBE_SCHEMA},
      {"material: ruby, setting: {kind: prong, metal: gold}", "did you mean 'prongs'", ABBE_SCHEMA},
      {"material: ruby, setting: {kind: prongs}", "'metal' is missing", ABBE_SCHEMA},
      {"material: ruby, setting: {kind: prongs, metal: glod}", "did you mean 'gold'",
       ABBE_NOT_FOUND},
      {"material: ruby, setting: {kind: prongs, metal: [gold]}", "'metal' wants text", ABBE_SCHEMA},
      {"material: ruby, setting: {kind: bezel, count: 6, metal: gold}", "'bezel' has no 'count'",
       ABBE_SCHEMA},
      {"material: ruby, setting: {kind: prongs, radius: 9mm, metal: gold}",
       "'prongs' has no 'radius'", ABBE_SCHEMA},
      {"material: ruby, setting: {kind: band, radius: 1e5, metal: gold}", "inside is not possible",
       ABBE_INVALID_ARGUMENT},
      {"material: ruby, setting: {kind: prongs, metal: topaz}", "'topaz' is no metal", ABBE_SCHEMA},
      {"material: ruby, setting: {kind: prongs, metal: gold, count: 1}", "from 2 to 24",
       ABBE_SCHEMA},
      {"material: ruby, setting: {kind: bezel, metal: gold, thick: 1cm}", "half of the stone's",
       ABBE_INVALID_ARGUMENT},
      {"material: ruby, setting: {kind: bezel, metal: gold, lip: 1}", "no key 'lip'", ABBE_SCHEMA}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    abbe_scene scene;
    REFUSED(wrong[i].code, wrong[i].says, parse(wrong[i].stone, &scene, &error));
  }
}
