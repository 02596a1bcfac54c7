/* Which facets feed a place, with hits that are made here. */
#include "tests/check.h"

#include "cli/view/picture/view_feed.h"

#include <math.h>
#include <string.h>

enum { GRID = 16 };

static void assert_ok(abbe_result result, const abbe_error *error) {
  if (result != ABBE_OK) fail_msg("%s", error->text);
}

/* A cube of 2 m around the origin, a quad a side in two triangles. */
static void make_cube(abbe_object *object) {
  static const double corner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                                      {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
  static const uint32_t side[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  static const abbe_material glass = {.name = "glass"};
  abbe_error error = {0};
  *object = (abbe_object){.material = &glass, .min = {-1, -1, -1}, .max = {1, 1, 1}};
  assert_ok(abbe_mesh_make(8, 12, false, &object->mesh, &error), &error);
  memcpy(object->mesh.position, corner, sizeof corner);
  for (int i = 0; i < 6; i++)
    for (int k = 0; k < 3; k++) {
      object->mesh.face[2 * i][k] = side[i][k];
      object->mesh.face[2 * i + 1][k] = side[i][k == 0 ? 0 : k + 1];
    }
}

/* Photons of a beam downward from above, one a cell, which all land at their own cell's place on
 * the level z = -3. */
static void shine(float *at, unsigned *cell, abbe_view_hits *out, double tilt) {
  const double origin[3] = {3 * tilt, 0, 3}, down[3] = {-tilt, 0, -1}, up[3] = {0, 1, 0};
  abbe_view_look(origin, down, up, true, &out->view);
  const double window[4] = {-0.8, 0.8, -0.8, 0.8};
  memcpy(out->view.window, window, sizeof window);
  out->at = at;
  out->cell = cell;
  out->count = (size_t)GRID * GRID;
  out->slots = out->samples = 1;
  out->grid = GRID;
  for (unsigned y = 0; y < GRID; y++)
    for (unsigned x = 0; x < GRID; x++) {
      const unsigned i = y * GRID + x;
      cell[i] = x | y << 16;
      const float hit[4] = {(float)x, (float)y, -3, 0.5F};
      memcpy(at + 4 * (size_t)i, hit, sizeof hit);
    }
}

static void test_light_from_above_comes_through_the_top(void **state) {
  (void)state;
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  abbe_object object[2] = {{0}};
  make_cube(&object[1]);
  const abbe_scene scene = {.object_count = 2, .object = object};
  abbe_view_hits hits;
  abbe_error error = {0};
  shine(at, cell, &hits, 0);
  abbe_view_feed_begin((const double[3]){4, 7, -3}, 1.1, &feed); /* that cell and four around */
  assert_ok(abbe_view_feed_add(&feed, &hits, &error), &error);
  abbe_view_feed_end(&feed, &scene);
  assert_int_equal(feed.photons, 5);
  assert_int_equal(feed.ray_count, 5);
  double whole = 0;
  for (size_t i = 0; i < 5; i++) {
    whole += feed.ray[i].share;
    assert_near(feed.ray[i].entry[2], 1, 1e-12); /* the top, straight below where it began */
    for (int k = 0; k < 2; k++) assert_near(feed.ray[i].entry[k], feed.ray[i].light[k], 1e-12);
    assert_int_equal(feed.ray[i].facet, 0);
  }
  assert_near(whole, 1, 1e-12);
  assert_int_equal(feed.facet_count, 1);
  assert_int_equal(feed.facet[0].object, 1);
  assert_near(feed.facet[0].normal[2], 1, 1e-12);
  assert_near(feed.facet[0].offset, 1, 1e-12);
  assert_near(feed.facet[0].share, 1, 1e-12);
  assert_int_equal(feed.edge_count, 4); /* of two triangles, but for the one that they share */
  for (size_t i = 0; i < 4; i++)
    for (int k = 0; k < 2; k++) assert_near(feed.edge[i][k][2], 1, 0);
  abbe_mesh_free(&object[1].mesh);
}

/* Aslant, of the beam's height one part meets the top and one the side, as the sines say. */
static void test_two_facets_share_as_they_are_seen(void **state) {
  (void)state;
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  abbe_object object = {0};
  make_cube(&object);
  const abbe_scene scene = {.object_count = 1, .object = &object};
  abbe_view_hits hits;
  abbe_error error = {0};
  shine(at, cell, &hits, 1);
  abbe_view_feed_begin((const double[3]){7.5, 7.5, -3}, 7.6, &feed); /* 178 cells, all alike */
  assert_ok(abbe_view_feed_add(&feed, &hits, &error), &error);
  abbe_view_feed_end(&feed, &scene);
  assert_true(feed.photons > 150 && feed.photons < ABBE_VIEW_FEED_RAYS);
  assert_int_equal(feed.ray_count, feed.photons);
  assert_int_equal(feed.facet_count, 2); /* at 45 degrees they are seen alike */
  assert_near(feed.facet[0].share, 0.5, 1e-12);
  assert_near(feed.facet[0].share + feed.facet[1].share, 1, 1e-12);
  for (size_t i = 0; i < feed.ray_count; i++) {
    const abbe_view_facet *f = &feed.facet[feed.ray[i].facet];
    double along = 0;
    for (int k = 0; k < 3; k++) along += f->normal[k] * feed.ray[i].entry[k];
    assert_near(along, f->offset, 1e-9);
  }
  assert_int_equal(feed.edge_count, 8);
  abbe_mesh_free(&object.mesh);
}

static void test_nothing_lands_or_nothing_is_met(void **state) {
  (void)state;
  static float at[4 * GRID * GRID];
  static unsigned cell[GRID * GRID];
  static abbe_view_feed feed;
  const abbe_scene scene = {0};
  abbe_view_hits hits;
  abbe_error error = {0};
  shine(at, cell, &hits, 0);
  abbe_view_feed_begin((const double[3]){4, 7, 5}, 1.1, &feed);
  assert_ok(abbe_view_feed_add(&feed, &hits, &error), &error);
  abbe_view_feed_end(&feed, &scene);
  assert_int_equal(feed.photons + feed.ray_count + feed.facet_count + feed.edge_count, 0);
  abbe_view_feed_begin((const double[3]){4, 7, -3}, 1.1, &feed);
  assert_ok(abbe_view_feed_add(&feed, &hits, &error), &error);
  abbe_view_feed_end(&feed, &scene);
  assert_int_equal(feed.photons, 5);
  assert_int_equal(feed.ray_count + feed.facet_count, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_light_from_above_comes_through_the_top),
                                     cmocka_unit_test(test_two_facets_share_as_they_are_seen),
                                     cmocka_unit_test(test_nothing_lands_or_nothing_is_met)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
