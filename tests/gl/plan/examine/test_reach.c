/* What a light's cone and the eye's window may meet, at their rims and far from them. */
#include "tests/random.h"
#include "tests/scenes/scene_text.h"

#include "gl/plan/examine/examine.h"

static abbe_object box(double x, double y, double z, double half) {
  abbe_object object = {.min = {x - half, y - half, z - half},
                        .max = {x + half, y + half, z + half}};
  return object;
}

static abbe_object ball(double x, double y, double z, double radius) {
  abbe_object object = box(x, y, z, radius * 0.9); /* triangles lie inside */
  object.exact.kind = ABBE_EXACT_SPHERE;
  object.exact.radius = radius;
  const double centre[3] = {x, y, z};
  memcpy(object.exact.centre, centre, sizeof centre);
  return object;
}

static const abbe_light spot = {
    .kind = ABBE_LIGHT_SPOT, .position = {0, 0, 1}, .direction = {0, 0, -1}, .cone_rad = 0.3};

/* A ball at the distance d, a off the axis, is touched where a is the cone and asin(r / d). */
TEST(a_cone_touches_a_ball) {
  const double d = 0.8, r = 0.1, rim = 0.3 + asin(r / d);
  for (int k = -1; k <= 1; k += 2) {
    double a = rim + 1e-3 * k;
    abbe_object object = ball(d * sin(a), 0, 1 - d * cos(a), r);
    assert_int_equal(abbe_reach_light(&spot, &object), k < 0);
  }
}

/* A ball of 0.1 at the distance 1 from a lamp: what stands behind, before and beside it. */
TEST(what_stands_behind_a_ball) {
  const abbe_object object = ball(0, 0, 0, 0.1);
  const double tangent = 0.1 / sqrt(1 - 0.01);
  abbe_light light = spot;
  for (int turn = 0; turn < 2; turn++) {
    light.kind = turn == 0 ? ABBE_LIGHT_POINT : ABBE_LIGHT_DIRECTIONAL;
    /* the shadow at z = -1 is 2 tangents wide from a point, as wide as the ball along a direction
     */
    const double rim = turn == 0 ? 2 * tangent : 0.1;
    for (int k = -1; k <= 1; k += 2) {
      const abbe_object beside = {.min = {rim + 1e-3 * k, -1, -1}, .max = {2, 1, -1}};
      assert_int_equal(abbe_reach_through(&light, &object, &beside), k < 0);
      const abbe_object above = {.min = {-1, -1, 0.1 + 1e-3 * k}, .max = {1, 1, 0.1 + 1e-3 * k}};
      assert_int_equal(abbe_reach_through(&light, &object, &above), k < 0);
    }
    const abbe_object floor = {.min = {-1, -1, -1}, .max = {1, 1, -1}};
    assert_true(abbe_reach_through(&light, &object, &floor));
  }
  light.kind = ABBE_LIGHT_POINT;
  const abbe_object around = ball(0, 0, 1, 0.1), anywhere = box(0, 5, 0, 0.1);
  assert_true(abbe_reach_through(&light, &around, &anywhere));
}

TEST(light_without_a_cone_goes_everywhere) {
  abbe_object behind = ball(0, 0, 3, 0.1), around = ball(0, 0, 1, 0.1);
  abbe_light light = spot;
  assert_false(abbe_reach_light(&light, &behind));
  assert_true(abbe_reach_light(&light, &around));
  light.kind = ABBE_LIGHT_POINT;
  assert_true(abbe_reach_light(&light, &behind));
  light.kind = ABBE_LIGHT_DIRECTIONAL;
  assert_true(abbe_reach_light(&light, &behind));
}

/* No box that holds a lit place is said to be missed. */
TEST(a_cone_is_never_wrongly_said_to_miss) {
  uint64_t seed = 1;
  size_t missed = 0, lit = 0;
  for (int i = 0; i < 20000; i++) {
    abbe_object object = box(random_between(&seed, -2, 2), random_between(&seed, -2, 2),
                             random_between(&seed, -2, 2), random_between(&seed, 0.01, 0.5));
    double at[3], length = 0;
    for (int k = 0; k < 3; k++) {
      at[k] = random_between(&seed, object.min[k], object.max[k]) - spot.position[k];
      length += at[k] * at[k];
    }
    for (int k = 0; k < 3; k++) at[k] /= sqrt(length);
    bool reached = abbe_reach_light(&spot, &object);
    missed += !reached;
    if (!(abbe_light_profile(&spot, at) > 0)) continue;
    lit++;
    assert_true(reached);
  }
  assert_true(lit > 200 && missed > 10000);
}

static const abbe_camera camera = FIELDS(.eye = {0, -2, 0}, .target = {0, 0, 0}, .up = {0, 0, 1},
                                         .fov_y_rad = 1.0, .width = 200, .height = 100);

/* The window at the distance 2 is tan(0.5) 2 = 1.0926 high and twice as wide, to each side; a pixel
 * is 0.0219. */
TEST(the_eye_sees_to_its_windows_rim) {
  static const struct {
    double x, y, z, half;
    bool seen;
  } rows[] = {
      {0, 0, 0, 0.1, true},      {2.2, 0, 0, 0.01, true},    {2.25, 0, 0, 0.01, false},
      {-2.2, 0, 0, 0.01, true},  {-2.25, 0, 0, 0.01, false}, {0, 0, 1.1, 0.01, true},
      {0, 0, 1.15, 0.01, false}, {0, 0, -1.1, 0.01, true},   {0, 0, -1.15, 0.01, false},
      {0, -3, 0, 0.5, false},    {0, -3, 0, 1.5, true},      {0, 1e6, 0, 0.1, true},
      {2.9, 0.3, 0, 0.5, true},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_object object = box(rows[i].x, rows[i].y, rows[i].z, rows[i].half);
    if (abbe_reach_eye(&camera, 200, 100, &object) != rows[i].seen) fail_msg("row %zu", i);
  }
}

/* A narrower picture of the same height sees less. */
TEST(the_request_decides_the_window) {
  abbe_object object = box(1.5, 0, 0, 0.01);
  assert_true(abbe_reach_eye(&camera, 200, 100, &object));
  assert_false(abbe_reach_eye(&camera, 100, 100, &object));
}

TEST(an_exact_ball_stands_out_of_its_triangles) {
  abbe_object object = ball(2.2 + 0.1, 0, 0, 0.1), triangles = object;
  triangles.exact.kind = ABBE_EXACT_NONE;
  for (int k = 0; k < 3; k++) {
    triangles.min[k] += 0.05;
    triangles.max[k] -= 0.05;
  }
  assert_true(abbe_reach_eye(&camera, 200, 100, &object));
  assert_false(abbe_reach_eye(&camera, 200, 100, &triangles));
}

TEST(sides_and_overlaps) {
  const double floor[9] = {0, 0, 1, 2, 0, 0, 0, 2, 0};
  assert_near(abbe_reach_side(floor, (double[3]){5, 5, 4}), 3, 1e-15);
  assert_near(abbe_reach_side(floor, (double[3]){-5, 0, -1}), -2, 1e-15);
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat") BRICK("flat") RING("flat"));
  assert_false(abbe_reach_overlap(&scene.object[1], &scene.object[2]));
  assert_true(abbe_reach_overlap(&scene.object[1], &scene.object[3]));
}

/* A plane at 45 degrees: boxes on one side of it share its bounds, and are not reached into. */
TEST(a_receiver_reaches_into_what_its_plane_cuts) {
  double slope[1][9] = {{0, 0, 0, 1, 0, 1, 0, 1, 0}};
  abbe_object receiver = {
      .exact = {.kind = ABBE_EXACT_PARALLELOGRAMS, .count = 1, .parallelogram = slope}};
  const abbe_object cut = box(0.5, 0.5, 0.5, 0.1), below = box(0.8, 0.5, 0.2, 0.1);
  const abbe_object apart = box(0.5, 1.5, 0.5, 0.1);
  assert_true(abbe_reach_into(&receiver, &cut));
  assert_false(abbe_reach_into(&receiver, &below));
  assert_false(abbe_reach_into(&receiver, &apart));
  abbe_object mesh = box(0.5, 0.5, 0.5, 0.5);
  assert_true(abbe_reach_into(&mesh, &below));
  assert_false(abbe_reach_into(&mesh, &apart));
}
