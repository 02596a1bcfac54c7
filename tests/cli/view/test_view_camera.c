/* A camera led by hand: known places, what a move keeps, and what it may not reach. */
#include "tests/check.h"

#include "base/maths.h"
#include "cli/view/state/view_camera.h"

#define DEGREES (3.14159265358979323846 / 180)
static const double tolerance = 1e-12; /* doubles of order one, some dozen operations */

/* 2 m in front of the origin, looking along +y. */
static abbe_camera straight(void) {
  return (abbe_camera){.eye = {0, -2, 0}, .up = {0, 0, 3}, .fov_y_rad = 90 * DEGREES};
}

static void assert_point(const double p[3], double x, double y, double z) {
  assert_near(p[0], x, tolerance);
  assert_near(p[1], y, tolerance);
  assert_near(p[2], z, tolerance);
}

TEST(orbits_end_at_known_places) {
  abbe_camera c = straight();
  abbe_view_camera_orbit(&c, 90 * DEGREES, 0);
  assert_point(c.eye, 2, 0, 0);
  abbe_view_camera_orbit(&c, -180 * DEGREES, 30 * DEGREES);
  assert_point(c.eye, -2 * cos(30 * DEGREES), 0, 1);
  assert_point(c.target, 0, 0, 0);
  abbe_view_camera_orbit(&c, 180 * DEGREES, -30 * DEGREES);
  assert_point(c.eye, 2, 0, 0);
}

TEST(no_move_reaches_the_pole) {
  abbe_camera c = straight();
  for (int i = 0; i < 5; i++) abbe_view_camera_orbit(&c, 1, 1);
  assert_near(c.eye[2], 2 * sin(89 * DEGREES), tolerance);
  assert_near(abbe_vector_length(c.eye), 2, tolerance);
  /* from the pole itself, where a scene may begin, it comes away */
  abbe_camera above = {.eye = {0, 0, 2}, .up = {0, 1e-9, 1}, .fov_y_rad = 1};
  abbe_view_camera_orbit(&above, 0, -45 * DEGREES);
  assert_true(abbe_vector_finite(above.eye) && above.eye[2] < 1.5);
}

TEST(looking_about_keeps_the_eye) {
  abbe_camera c = straight();
  abbe_view_camera_look(&c, 90 * DEGREES, 0);
  assert_point(c.eye, 0, -2, 0);
  assert_point(c.target, 2, -2, 0);
  abbe_view_camera_look(&c, 0, 45 * DEGREES);
  assert_point(c.target, sqrt(2), -2, sqrt(2));
}

TEST(pan_zoom_and_fly) {
  abbe_camera c = straight();
  abbe_view_camera_pan(&c, 0.5, 0.25); /* the picture shows 4 m at 2 m */
  assert_point(c.eye, 2, -2, 1);
  assert_point(c.target, 2, 0, 1);
  c = straight();
  abbe_view_camera_zoom(&c, 0.25);
  assert_point(c.eye, 0, -0.5, 0);
  abbe_view_camera_fly(&c, (const double[3]){1, 2, 3});
  assert_point(c.eye, 1, 2.5, 2);
  assert_point(c.target, 1, 3, 2);
}

TEST(points_show_where_they_should) {
  const abbe_camera c = straight();
  double xy[2];
  assert_true(abbe_view_camera_project(&c, 400, 200, (const double[3]){0, 0, 0}, xy));
  assert_near(xy[0], 200, 1e-9);
  assert_near(xy[1], 100, 1e-9);
  assert_true(abbe_view_camera_project(&c, 400, 200, (const double[3]){2, 0, 1}, xy));
  assert_near(xy[0], 300, 1e-9);
  assert_near(xy[1], 50, 1e-9);
  assert_false(abbe_view_camera_project(&c, 400, 200, (const double[3]){0, -3, 0}, xy));
}

/* A point that is dragged shows where the pointer is. */
TEST(what_is_dragged_follows) {
  abbe_camera c = straight();
  abbe_view_camera_orbit(&c, 0.7, 0.5);
  const double p[3] = {0.3, 0.2, -0.1};
  double from[2], to[2], shown[2], moved[3];
  assert_true(abbe_view_camera_project(&c, 512, 384, p, from));
  to[0] = from[0] + 37, to[1] = from[1] - 21;
  assert_true(abbe_view_camera_drag(&c, 512, 384, ABBE_VIEW_DRAG_LEVEL, p, from, to, moved));
  assert_near(moved[2], p[2], tolerance);
  assert_true(abbe_view_camera_project(&c, 512, 384, moved, shown));
  assert_near(shown[0], to[0], 1e-8);
  assert_near(shown[1], to[1], 1e-8);
  assert_true(abbe_view_camera_drag(&c, 512, 384, ABBE_VIEW_DRAG_UPRIGHT, p, from, to, moved));
  assert_near(moved[0], p[0], tolerance);
  assert_near(moved[1], p[1], tolerance);
  assert_true(moved[2] > p[2] + 0.05);
  assert_true(abbe_view_camera_project(&c, 512, 384, moved, shown));
  assert_near(shown[1], to[1], 1.0); /* upright lines lean by perspective */
}

/* Arrows point to what is out of the picture, above, behind and straight behind the camera. */
TEST(what_is_beyond_is_pointed_to) {
  static const double half = 0.70710678118654752;
  static const struct {
    double point[3], xy[2], way[2];
  } cases[] = {{{0, 0, 5}, {200, 10}, {0, -1}},
               {{9, -3, 0}, {390, 100}, {1, 0}},
               {{3, -4, 3}, {290, 10}, {half, -half}},
               {{0, -4, 0}, {200, 190}, {0, 1}}};
  const abbe_camera c = straight();
  const double seen[3] = {0.1, 0, 0.1};
  double xy[2], way[2];
  assert_false(abbe_view_camera_beyond(&c, 400, 200, seen, 10, xy, way));
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    assert_true(abbe_view_camera_beyond(&c, 400, 200, cases[i].point, 10, xy, way));
    for (int k = 0; k < 2; k++) {
      assert_near(xy[k], cases[i].xy[k], 1e-9);
      assert_near(way[k], cases[i].way[k], 1e-12);
    }
  }
}

TEST(drags_above_the_horizon_move_nothing) {
  const abbe_camera c = straight();
  const double p[3] = {0, 0, -1}, from[2] = {200, 150}, sky[2] = {200, 20};
  double moved[3];
  assert_false(abbe_view_camera_drag(&c, 400, 200, ABBE_VIEW_DRAG_LEVEL, p, from, sky, moved));
  assert_point(moved, 0, 0, -1);
  const abbe_camera down = {
      .eye = {0, 0, 2}, .up = {0, 0, 1}, .target = {0.01, 0, 0}, .fov_y_rad = 1};
  assert_false(abbe_view_camera_drag(&down, 400, 200, ABBE_VIEW_DRAG_UPRIGHT, p, from, sky, moved));
  assert_point(moved, 0, 0, -1);
}
