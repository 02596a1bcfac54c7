/* What the plan reads off a scene's refractors, and the convexity that it rests on. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/plan.h"
#include "gl/plan/transport.h"
#include "scenes/shapes/shape.h"

static void sides_and_overlaps(void **state) {
  (void)state;
  const double floor[9] = {0, 0, 1, 2, 0, 0, 0, 2, 0};
  assert_near(abbe_transport_side(floor, (double[3]){5, 5, 4}), 3, 1e-15);
  assert_near(abbe_transport_side(floor, (double[3]){-5, 0, -1}), -2, 1e-15);
  abbe_scene scene = {0};
  load_text(CAMERA POINT_LIGHT FLOOR BALL("flat") BRICK("flat") RING("flat"), &scene);
  assert_false(abbe_transport_overlap(&scene.object[1], &scene.object[2]));
  assert_true(abbe_transport_overlap(&scene.object[1], &scene.object[3]));
  abbe_scene_free(&scene);
}

static void what_is_asked_for_is_checked_by_name(void **state) {
  (void)state;
  abbe_error error = {0};
  abbe_scene scene = {0};
  abbe_plan plan = {.desc = {.model = ABBE_MODEL_SPHERE, .min_nm = 380, .max_nm = 780}};
  load_text(CAMERA POINT_LIGHT FLOOR BALL("flat") RING("flat"), &scene);
  assert_int_equal(abbe_transport_check(&scene.object[1], &plan, &error), ABBE_OK);
  assert_int_equal(abbe_transport_check(&scene.object[2], &plan, &error), ABBE_UNSUPPORTED);
  assert_contains(error.text, "'ring'");
  assert_contains(abbe_transport_walk(&scene, &plan), "more than one");
  plan.desc.model = ABBE_MODEL_LAYERS;
  assert_null(abbe_transport_walk(&scene, &plan));
  assert_int_equal(abbe_transport_model(&scene.object[1], &plan), ABBE_REFRACTOR_LAYERS);
  plan.desc.model = ABBE_MODEL_AUTO;
  assert_int_equal(abbe_transport_model(&scene.object[1], &plan), ABBE_REFRACTOR_SPHERE);
  plan.walk = true;
  assert_int_equal(abbe_transport_model(&scene.object[2], &plan), ABBE_REFRACTOR_HIERARCHY);
  char reason[192];
  abbe_transport_reason(&scene.object[2], &plan, reason, sizeof reason);
  assert_contains(reason, "general mesh");
  assert_false(abbe_transport_invisible(&scene, &scene.object[1], &plan));
  abbe_scene_free(&scene);
}

static void convex_meshes_are_known(void **state) {
  (void)state;
  abbe_mesh mesh = {0};
  assert_int_equal(abbe_shape_sphere(2, 3, &mesh, NULL), ABBE_OK);
  assert_true(abbe_mesh_is_convex(&mesh));
  /* one corner drawn in by a tenth */
  for (int k = 0; k < 3; k++) mesh.position[0][k] *= 0.9;
  assert_false(abbe_mesh_is_convex(&mesh));
  abbe_mesh_free(&mesh);
  assert_int_equal(abbe_shape_ring(0.08, 0.02, 32, 16, &mesh, NULL), ABBE_OK);
  assert_false(abbe_mesh_is_convex(&mesh));
  abbe_mesh_free(&mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_and_overlaps),
      cmocka_unit_test(what_is_asked_for_is_checked_by_name),
      cmocka_unit_test(convex_meshes_are_known),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
