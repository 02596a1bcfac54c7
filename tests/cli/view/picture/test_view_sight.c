/* Where a look into refractors ends: a slab, a cube that light cannot leave by its side, a ball. */
#include "tests/check.h"

#include "cli/view/picture/view_feed.h"

static abbe_material glass = {.name = "glass", .min_nm = 380, .max_nm = 780};

/* A box, outward all around. */
static void make_box(const double low[3], const double high[3], const abbe_material *material,
                     abbe_object *object) {
  static const uint32_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  *object = (abbe_object){.material = material};
  OK(abbe_mesh_make(8, 12, false, &object->mesh, &error));
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 3; k++) object->mesh.position[i][k] = (i >> k & 1) != 0 ? high[k] : low[k];
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 3; k++) {
      object->mesh.face[2 * i][k] = side[i][k];
      object->mesh.face[2 * i + 1][k] = side[i][k == 0 ? 0 : k + 1];
    }
}

/* A box of glass over a floor far below, and a look down at an angle to the vertical. */
static void look(const double low[3], const double high[3], double x, double angle,
                 abbe_view_sight *out) {
  static const double ground[2][3] = {{-100, -100, -11}, {100, 100, -10}};
  abbe_object object[2];
  const abbe_scene scene = {.object_count = 2, .object = object};
  glass.dispersion.model = ABBE_DISPERSION_CONSTANT;
  glass.dispersion.count = 1;
  glass.dispersion.c[0] = 1.5;
  make_box(low, high, &glass, &object[0]);
  make_box(ground[0], ground[1], NULL, &object[1]);
  /* off the diagonals of the sides */
  const double along[3] = {sin(angle), 0, -cos(angle)};
  const double eye[3] = {x - 5 * along[0], 0.13, high[2] - 5 * along[2]};
  abbe_view_sight_follow(&scene, eye, along, 550, out);
  for (int k = 0; k < 2; k++) abbe_mesh_free(&object[k].mesh);
}

/* Its ray goes on as it came, beside its line by t sin(a) (1 - cos(a) / (n cos(b))). */
TEST(a_slab_shifts) {
  static const double low[3] = {-50, -50, -1}, high[3] = {50, 50, 0};
  for (int degrees = 0; degrees < 80; degrees += 20) {
    const double a = degrees * acos(-1) / 180, b = asin(sin(a) / 1.5);
    abbe_view_sight sight;
    look(low, high, 0.2, a, &sight);
    assert_true(sight.lands);
    assert_int_equal(sight.count, 3);
    const double straight = 0.2 + 10 * tan(a), shift = sin(a) * (1 - cos(a) / (1.5 * cos(b)));
    assert_near(sight.place[2][0], straight - shift / cos(a), 1e-9);
    assert_near(sight.place[2][2], -10, 1e-9);
    assert_near(sight.length, 5 + 1 / cos(b) + 9 / cos(a), 1e-9);
  }
}

/* From n = 1.5 no light that came in by the top leaves by a side: asin(1 / 1.5) is 41.8 degrees,
 * and it meets sides at 48.2 or more. It leaves by the bottom as it came in, its x turned back. */
TEST(a_cube_turns_it_back) {
  static const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  const double a = 0.9, b = asin(sin(a) / 1.5);
  abbe_view_sight sight;
  look(low, high, 0.7, a, &sight);
  assert_true(sight.lands);
  assert_int_equal(sight.count, 4); /* top, side, bottom, ground */
  assert_near(sight.place[1][0], 1, 1e-12);
  assert_near(sight.place[2][2], -1, 1e-12);
  const double out = 2 - (0.7 + 2 * tan(b));
  assert_near(sight.place[2][0], out, 1e-9);
  assert_near(sight.place[3][0], out - 9 * tan(a), 1e-9);
}

TEST(what_does_not_land) {
  static const double low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
  abbe_view_sight sight;
  look(low, high, 0, acos(-1), &sight); /* upward, from below the floor's top */
  assert_int_equal(sight.count, 2);
  assert_false(sight.lands);
  abbe_object object;
  make_box(low, high, &glass, &object);
  const abbe_scene alone = {.object_count = 1, .object = &object};
  abbe_view_sight_follow(&alone, (const double[3]){0.2, 0.1, 5}, (const double[3]){0, 0, -1}, 550,
                         &sight);
  assert_int_equal(sight.count, 2);
  assert_false(sight.lands);
  abbe_view_sight_follow(&alone, (const double[3]){0.2, 0.1, 5}, (const double[3]){0, 0, -1}, 900,
                         &sight); /* no index is known there */
  assert_int_equal(sight.count, 1);
  abbe_view_sight_follow(&alone, (const double[3]){0.2, 0.1, 5}, (const double[3]){0, 0, 1}, 550,
                         &sight);
  assert_int_equal(sight.count, 0);
  abbe_mesh_free(&object.mesh);
}
