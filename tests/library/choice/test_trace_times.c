/* The tracer as a contestant: its picture is the tracer's own to the bit, its frames are timed. */
#include "tests/check.h"

#include "gl/plan/plan.h"
#include "library/choice/trace_times.h"
#include "tests/scenes/scene_text.h"
#include "tests/validation/trace_scene.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")

TEST(the_picture_is_the_tracers) {
  abbe_trace_times times;
  const abbe_trace_times_desc desc = {
      .passes = 2, .photons = 16, .width = 16, .height = 12, .frames = 3};
  const abbe_trace_desc same = {
      .no_map = true, .width = 16, .height = 12, .photons = 256, .seed = ABBE_TRACE_TIMES_SEED};
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  MADE(abbe_image, picture, abbe_trace_times_measure(&scene, &desc, &times, &picture, &error));
  OWNED(abbe_image, own) = traced_picture(&scene, &same, 2);
  assert_int_equal(picture.channels, own.channels);
  assert_memory_equal(picture.data, own.data, 16 * 12 * own.channels * sizeof *own.data);
  assert_true(times.fastest_ms > 0);
  assert_true(times.frame_ms >= times.fastest_ms);
  assert_true(times.light_ms + times.eye_ms <= times.frame_ms);
  assert_true(times.own_de > 0);
}

TEST(what_is_refused) {
  int asked = 0;
  abbe_trace_times times;
  abbe_trace_times_desc desc = FIELDS(.passes = 2, .photons = 16, .width = 8, .height = 8,
                                      .progress = stop_at_once, .user = &asked);
  OWNED(abbe_scene, scene) = scene_of(SCENE);
  REFUSED(ABBE_CANCELLED, "", abbe_trace_times_measure(&scene, &desc, &times, NULL, &error));
  assert_int_equal(asked, 1);
  desc.filtered = true;
  desc.passes = 1;
  REFUSED(ABBE_INVALID_ARGUMENT, "too few to trace and filter",
          abbe_trace_times_measure(&scene, &desc, &times, NULL, &error));
}

/* A reference stays with its scene: what changes a crystal's picture changes the hash. */

#define SCENE_HASH_SCENE "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR

static void absorb(abbe_spectrum **to, double per_m) {
  const double lambda_nm = 550;
  abbe_spectrum_free(*to);
  OK(abbe_spectrum_make(&lambda_nm, &per_m, 1, ABBE_INTERPOLATION_LINEAR, to, &error));
}

TEST(crystals_have_axes_two_indices_and_two_losses) {
  OWNED(abbe_scene, scene) = scene_of(SCENE_HASH_SCENE BALL("tourmaline-green"));
  abbe_object *ball = &scene.object[1];
  abbe_material *crystal = (abbe_material *)ball->material;
  absorb(&crystal->attenuation, 10);
  absorb(&crystal->attenuation_yz[1], 10);
  unsigned long long hash[4] = {abbe_scene_hash(&scene)};
  assert_true(abbe_scene_hash(&scene) == hash[0]);
  const double axis[3] = {ball->axis[1], ball->axis[2], ball->axis[0]};
  memcpy(ball->axis, axis, sizeof axis);
  hash[1] = abbe_scene_hash(&scene);
  crystal->extraordinary.c[0] += 1e-4;
  hash[2] = abbe_scene_hash(&scene);
  /* the same mean over the axes */
  absorb(&crystal->attenuation, 5);
  absorb(&crystal->attenuation_yz[1], 20);
  hash[3] = abbe_scene_hash(&scene);
  for (int i = 1; i < 4; i++) assert_true(hash[i] != hash[i - 1]);
}

/* Physics that match the plan: what it follows, and no more. */
TEST(what_the_plan_follows) {
  abbe_plan plan;
  abbe_physics physics = {0};
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  OK(abbe_matched_physics(&scene, 0, 0, &physics, &error));
  OK(abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(physics.matched);
  assert_int_equal(physics.orders, plan.desc.exits);
  assert_int_equal(physics.eye_orders, plan.eye_exits);
  assert_near(physics.energy_share, plan.desc.energy_share, 0);
  assert_near(physics.eye_share, plan.eye_share, 0);
  assert_true(physics.orders > 1 && physics.energy_share > 0);
  abbe_plan_free(&plan);
  /* A request that the renderer refuses has no plan to match. */
  assert_int_not_equal(abbe_matched_physics(&scene, 500, 400, &physics, NULL), ABBE_OK);
}
