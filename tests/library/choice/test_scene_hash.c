/* A reference stays with its scene: what changes a crystal's picture changes the hash. */
#include "tests/scenes/scene_text.h"

#include "library/choice/finer_scene.h"

#define SCENE "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR

static void absorb(abbe_spectrum **to, double per_m) {
  const double lambda_nm = 550;
  abbe_spectrum_free(*to);
  OK(abbe_spectrum_make(&lambda_nm, &per_m, 1, ABBE_INTERPOLATION_LINEAR, to, &error));
}

TEST(crystals_have_axes_two_indices_and_two_losses) {
  OWNED(abbe_scene, scene) = scene_of(SCENE BALL("tourmaline-green"));
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
