/* What pinholes come to: distances by hand; the limit is drawn once; more samples are nearer to it.
 */
#include "tests/gl/frame.h"

#include "validation/sweep/studies/pinhole_limits.h"

GROUP(make_context, free_context);

TEST(distance) {
  float a[8] = {3, 0, 0, 9, 0, 4, 0, 7}, b[8] = {3, 0, 2, 1, 0, 4, 0, 5};
  const abbe_image limit = {.width = 2, .height = 1, .channels = 4, .data = a},
                   picture = {.width = 2, .height = 1, .channels = 4, .data = b};
  assert_near(abbe_pinhole_limits_distance(&picture, &limit), 0.4, 1e-12);
  assert_near(abbe_pinhole_limits_distance(&limit, &limit), 0, 0);
}

TEST(more_samples_are_nearer) {
  OWNED(abbe_scene, scene) = {0};
  abbe_pinhole_limits known = {.pictures = 2, .samples = 1024};
  const abbe_image *first, *again;
  load_text(
      "materials: glass.yaml\n"
      "camera: {eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 28}\n"
      "environment: {size: 256, uniform: 0.2, spots: [{elevation: 40, azimuth: 200, radiance: "
      "4, sigma: 15}]}\n"
      "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1}\n"
      "- {name: wall, shape: rectangle, width: 0.3, height: 0.5, mirror: 0.9, transform: "
      "[{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.3, 0, 0.15]}]}\n",
      &scene);
  double rmse[3];
  abbe_render_desc desc = {.profile = ABBE_PROFILE_WAND2003, .width = 16, .height = 16};
  for (int k = 0; k < 3; k++) {
    desc.pinholes = (size_t)4 << 3 * k;
    OK(abbe_pinhole_limits_measure(&known, context, &scene, &desc, &rmse[k], &error));
    print_message("%zu: %g\n", desc.pinholes, rmse[k]);
  }
  assert_true(rmse[1] < 0.7 * rmse[0] && rmse[2] < 0.7 * rmse[1]);
  assert_int_equal(known.count, 1);
  OK(abbe_pinhole_limits_find(&known, context, &scene, &desc, &first, &error));
  desc.pinholes = 1;
  OK(abbe_pinhole_limits_find(&known, context, &scene, &desc, &again, &error));
  assert_ptr_equal(first, again);
  abbe_pinhole_limits_free(&known);
}
