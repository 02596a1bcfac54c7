#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/tracer_state.h"

static const abbe_trace_desc small = {
    .width = 12, .height = 9, .map_width = 16, .photons = 3000, .threads = 1, .bands = 3};

static const float *layer(const abbe_image *image, const char *name, size_t pixel) {
  const size_t channel = abbe_image_find_channel(image, name);
  assert_true(channel < image->channels);
  return image->data + pixel * image->channels + channel;
}

typedef struct traced {
  abbe_image picture, map;
} traced;

static traced trace(const abbe_scene *scene, const abbe_trace_desc *desc, size_t passes) {
  HELD(abbe_tracer, tracer) = make_tracer(scene, desc);
  run_passes(tracer, passes);
  traced r;
  OK(abbe_tracer_picture(tracer, &r.picture, &error));
  OK(abbe_tracer_map(tracer, &r.map, &error));
  return r;
}

static void traced_free(traced *r) {
  abbe_image_free(&r->picture);
  abbe_image_free(&r->map);
}

/* Photons and the eye's light make the picture, their variances those of the caustic and the rest
 * where no glass is seen; a floor's guides are the floor's. Nothing else changes by them. */
TEST(guides_are_of_the_picture) {
  OWNED(abbe_scene, scene) =
      scene_of("materials: glass.yaml\ncamera: {eye: [0, -0.5, 0.35], target: [0, 0, 0.05], fov: "
               "50}\n" POINT_LIGHT FLOOR BEADS("crown"));
  abbe_trace_desc desc = small;
  OWNED(traced, plain) = trace(&scene, &desc, 4);
  desc.guides = true;
  OWNED(traced, with) = trace(&scene, &desc, 4);
  static const char *const names[3] = {"R", "G", "B"};
  static const char *const photons[3] = {"photons.R", "photons.G", "photons.B"};
  static const char *const eye[3] = {"eye.R", "eye.G", "eye.B"};
  check_same_image(&plain.map, &with.map);
  size_t lit = 0;
  for (size_t i = 0; i < small.width * small.height; i++) {
    for (size_t c = 0; c < plain.picture.channels; c++)
      assert_true(plain.picture.data[i * plain.picture.channels + c] ==
                  *layer(&with.picture, plain.picture.channel[c], i));
    for (size_t k = 0; k < 3; k++) {
      const double sum =
          (double)*layer(&with.picture, photons[k], i) + (double)*layer(&with.picture, eye[k], i);
      assert_near(sum, (double)*layer(&with.picture, names[k], i), 1e-5 * (1 + sum));
    }
    lit += *layer(&with.picture, "photons.G", i) > 0;
    /* |covariance| <= the product of the errors, as of any two numbers */
    const double most = (double)*layer(&with.picture, "stderr.photons.R", i) *
                        (double)*layer(&with.picture, "stderr.photons.G", i);
    assert_true(fabs((double)*layer(&with.picture, "covariance.photons.RG", i)) <=
                most * 1.00001 + 1e-12);
  }
  assert_true(lit > 10);
  const size_t corner = small.width * small.height - 1; /* the floor, near the eye */
  assert_near((double)*layer(&with.picture, "normal.Z", corner), 1, 1e-6);
  assert_near((double)*layer(&with.picture, "stderr.normal.Z", corner), 0, 1e-6);
  assert_near((double)*layer(&with.picture, "albedo.R", corner), 0.5, 1e-4);
  assert_near((double)*layer(&with.picture, "depth.Z", corner), 0.42, 0.1);
}

/* Variances and covariances of the mean of three passes, by hand. */
TEST(sums_tell_covariances) {
  static const float rgb[3][3] = {{5, 1, 2}, {3, 2, 4}, {4, 6, 0}},
                     eye[3][3] = {{1, 1, 1}, {1, 1, 2}, {1, 4, 0}};
  MADE(abbe_accumulator, picture, abbe_accumulator_make(3, 2, 1e6, &picture, &error));
  MADE(abbe_guide_sums, g, abbe_guide_sums_make(1, picture.unit, &g, &error));
  for (size_t pass = 0; pass < 3; pass++) {
    const abbe_eye_sample sample = {.depth = (float)pass, .albedo = {NAN, 1, 0}};
    for (size_t k = 0; k < 3; k++) abbe_accumulator_add(&picture, k % 2, k, rgb[pass][k]);
    abbe_guide_sums_set(&g, 0, eye[pass], &sample);
    abbe_guide_sums_end_pass(&g, &picture, 3);
    abbe_accumulator_end_pass(&picture);
  }
  /* photons: R 4 2 3, G 0 1 2, B 1 2 0; over three passes of mean 3, 1, 1 */
  const double unit = 1.0 / (3 * 2);
  assert_near(abbe_guide_sums_mean(&g, 3, 0, ABBE_GUIDE_PHOTONS), 3, 1e-6);
  assert_near(abbe_guide_sums_variance(&g, 3, 0, ABBE_GUIDE_PHOTONS), 2 * unit, 1e-6);
  assert_near(abbe_guide_sums_variance(&g, 3, 0, ABBE_GUIDE_EYE), 0, 1e-9);
  assert_near(abbe_guide_sums_variance(&g, 3, 0, ABBE_GUIDE_DEPTH), 2 * unit, 1e-6);
  assert_near(abbe_guide_sums_variance(&g, 3, 0, ABBE_GUIDE_ALBEDO), 0, 0);
  assert_near(abbe_guide_sums_covariance(&g, 3, 0, 0), -1 * unit, 1e-6); /* RG */
  assert_near(abbe_guide_sums_covariance(&g, 3, 0, 1), -1 * unit, 1e-6); /* RB */
  assert_near(abbe_guide_sums_covariance(&g, 3, 0, 2), -1 * unit, 1e-6); /* GB */
  assert_near(abbe_guide_sums_covariance(&g, 3, 0, 5), -3 * unit, 1e-6); /* the eye's GB */
}
