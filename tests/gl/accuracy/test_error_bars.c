/* Error bars: variants that spread evenly, errors that are near the true ones, that shrink, and
 * that are none where nothing can differ. */
#include "tests/gl/frame.h"

#include "gl/accuracy/error_bars.h"
#include "validation/measure/compare.h"

static const abbe_render_desc coarse_frame = {
    .width = 96, .height = 96, .photons = 64, .map_size = 256, .wavelengths = 5, .aovs = true};

static void make_bars(const abbe_scene *scene, const abbe_render_desc *desc,
                      const abbe_error_bars_desc *bars_desc, abbe_image *picture,
                      abbe_error_bars *bars) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, desc);
  if (picture != NULL) *picture = picture_of(renderer);
  OK(abbe_error_bars_make(context, scene, renderer, bars_desc, bars, &error));
}

GROUP(make_context, free_context);

/* Along every axis each variant has a place of its own, evenly spread about the picture's: over a
 * step of the grid and of the texels, over two thirds of the samples' distance,
 * or a third where the picture takes more rays at edges. */
TEST(variants_spread_evenly) {
  static const size_t counts[] = {2, 4, 7, ABBE_ERROR_BARS_MAX_VARIANTS};
  abbe_map_layout map, layout;
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &small_frame);
  abbe_render_desc of = abbe_renderer_plan(renderer)->desc, *desc = &of;
  abbe_renderer_map_layout(renderer, 0, &map);
  for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
    of.adaptive = k % 2 == 0 ? 1 : 4;
    const double part = of.adaptive > 1 ? 1.0 / 3 : 2.0 / 3;
    size_t n = counts[k], seen[4][ABBE_ERROR_BARS_MAX_VARIANTS] = {{0}};
    double moved[2] = {0, 0};
    for (size_t i = 0; i < n; i++) {
      abbe_render_desc request;
      abbe_error_bars_variant(desc, &map, i, n, &layout, &request);
      const double shift[4] = {request.photon_shift[0], request.photon_shift[1],
                               request.sample_shift[0] / part, request.sample_shift[1] / part};
      for (int a = 0; a < 4; a++) {
        assert_true(fabs(shift[a]) < 0.5);
        seen[a][(size_t)((shift[a] + 0.5) * (double)n)]++;
      }
      assert_ptr_equal(request.map_layout, &layout);
      OK(abbe_map_layout_check(&layout, &error));
      for (int axis = 0; axis < 2; axis++) {
        double by = (layout.knot[axis][64] - map.knot[axis][64]) * (double)desc->map_size;
        assert_true(fabs(by) <= 0.5);
        moved[axis] += by;
      }
    }
    for (int a = 0; a < 4; a++)
      for (size_t i = 0; i < n; i++) assert_int_equal(seen[a][i], 1);
    /* In texels; sums of up to 64 numbers that are rounded to 1e-16 of the map's side. */
    assert_near(moved[0], 0, 1e-9);
    assert_near(moved[1], 0, 1e-9);
  }
}

/* A grid that lies elsewhere is as good a grid: it meets the same light. */
TEST(shifted_grids_carry_the_same_light) {
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  double least = INFINITY, most = 0;
  for (int i = 0; i < 3; i++) {
    abbe_render_desc desc = small_frame;
    desc.photon_shift[0] = 0.4 * (i - 1);
    desc.photon_shift[1] = -0.3 * (i - 1);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    double reached = draw_frame(renderer).energy.reached;
    least = fmin(least, reached);
    most = fmax(most, reached);
  }
  /* The outline cuts some 200 of the 3200 cells at random: sqrt(200) / 3200 is half a per cent. */
  assert_true(most / least > 1);
  assert_true(most / least < 1.01);
}

static double true_error(const char *name, const abbe_image *picture) {
  MADE(abbe_field, reference,
       abbe_field_load(printed(ABBE_SOURCE_DIR "/validation/references/%s.exr", name), &reference,
                       &error));
  MADE(abbe_field, test, abbe_field_make(picture, "picture", &test, &error));
  MADE(abbe_comparison, comparison, abbe_compare(&reference, &test, NULL, &comparison, &error));
  return comparison.whole.metric[ABBE_COMPARE_RELATIVE_RMSE].value;
}

/* The references are of full physics; with so few photons what the model lacks is a small part. */
TEST(errors_are_near_the_true_ones) {
  static const char *const names[] = {"prism", "gem"};
  for (int i = 0; i < 2; i++) {
    OWNED(abbe_error_bars, bars) = {0};
    OWNED(abbe_scene, scene) = shipped_scene(names[i]);
    FILLED(abbe_image, picture, make_bars(&scene, &coarse_frame, NULL, &picture, &bars));
    double truth = true_error(names[i], &picture), ratio = bars.whole.relative_rmse / truth;
    if (!(ratio > 0.5 && ratio < 2)) print_error("%s: %g of %g\n", names[i], ratio, truth);
    /* Where docs/trade-measured.md finds most scenes and settings. */
    assert_true(ratio > 0.5 && ratio < 2);
    assert_true(true_error(names[i], &bars.mean) < truth);
    assert_true(bars.caustic.pixels > 0 && bars.caustic.pixels < bars.whole.pixels);
    assert_true(bars.caustic.ciede2000 > bars.whole.ciede2000);
    assert_int_equal(bars.variants, 4);
    assert_int_equal(bars.frames, 5);
    assert_finite(&bars.error);
  }
}

/* Nothing that the shipped scenes have: a turned brick under the sun. Its truth is a picture of the
 * same model in steps a quarter as wide. */
TEST(errors_are_near_those_of_a_scene_that_is_not_shipped) {
  OWNED(abbe_error_bars, bars) = {0};
  abbe_render_desc desc = {
      .width = 64, .height = 64, .photons = 64, .map_size = 128, .wavelengths = 7};
  OWNED(abbe_scene, scene) = scene_of(
      "materials: default\nambient: 0.2\n"
      "camera: {eye: [0.1, -0.6, 0.45], target: [0, 0, 0.02], up: [0, 0, 1], fov: 20}\n"
      "lights:\n"
      "- {name: sun, kind: directional, direction: [0.3, 0.2, -1], irradiance: 5}\n"
      "objects:\n"
      "- {name: brick, shape: box, size: [0.06, 0.04, 0.03], material: n-sf11,\n"
      "   transform: [{rotate: {axis: [1, 1, 0.3], angle: 33}}, {translate: [0, 0, 0.07]}]}\n"
      "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.7}\n");
  FILLED(abbe_image, picture, make_bars(&scene, &desc, NULL, &picture, &bars));
  desc.photons *= 4;
  desc.map_size *= 4;
  desc.wavelengths = 25;
  desc.supersample = 4;
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, fine) = picture_of(renderer);
  MADE(abbe_field, reference, abbe_field_make(&fine, "fine", &reference, &error));
  MADE(abbe_field, test, abbe_field_make(&picture, "picture", &test, &error));
  MADE(abbe_comparison, comparison, abbe_compare(&reference, &test, NULL, &comparison, &error));
  double rmse =
      bars.whole.relative_rmse / comparison.whole.metric[ABBE_COMPARE_RELATIVE_RMSE].value;
  double colour = bars.whole.ciede2000 / comparison.whole.metric[ABBE_COMPARE_CIEDE2000_MEAN].value;
  if (!(rmse > 0.5 && rmse < 2 && colour > 0.5 && colour < 2))
    print_error("of the true RMSE %g, of the true CIEDE2000 %g\n", rmse, colour);
  assert_true(rmse > 0.5 && rmse < 2);
  assert_true(colour > 0.5 && colour < 2);
}

TEST(the_mean_has_less_error) {
  abbe_error_bars bars[2] = {{.ms = 0}};
  abbe_error_bars_desc two = {.variants = 2}, desc = {.variants = 2, .of_mean = true};
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  make_bars(&scene, &small_frame, &two, NULL, &bars[0]);
  make_bars(&scene, &small_frame, &desc, NULL, &bars[1]);
  assert_true(bars[1].whole.relative_rmse < bars[0].whole.relative_rmse);
  /* The same variants give the same bits. */
  assert_same_pixels(&bars[0].mean, &bars[1].mean);
  for (size_t i = 0; i < 3 * bars[0].error.width * bars[0].error.height; i++)
    assert_true(bars[1].error.data[i] <= bars[0].error.data[i]);
  abbe_error_bars_free(&bars[0]);
  abbe_error_bars_free(&bars[1]);
}

TEST(errors_shrink_with_finer_settings) {
  abbe_render_desc coarse = coarse_frame, fine = coarse_frame;
  abbe_error_bars bars[2] = {{.ms = 0}};
  abbe_error_bars_desc two = {.variants = 2};
  coarse.width = coarse.height = fine.width = fine.height = 64;
  coarse.photons = 32;
  fine.photons = 128;
  fine.map_size = 512;
  fine.wavelengths = 9;
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  make_bars(&scene, &coarse, &two, NULL, &bars[0]);
  make_bars(&scene, &fine, &two, NULL, &bars[1]);
  assert_true(bars[1].caustic.relative_rmse < 0.7 * bars[0].caustic.relative_rmse);
  assert_true(bars[1].caustic.ciede2000 < 0.7 * bars[0].caustic.ciede2000);
  abbe_error_bars_free(&bars[0]);
  abbe_error_bars_free(&bars[1]);
}

/* A floor without end under the sun, and nothing else. */
TEST(no_error_where_nothing_can_differ) {
  OWNED(abbe_error_bars, bars) = {0};
  OWNED(abbe_scene, scene) = scene_of(
      "materials: glass.yaml\ncamera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0]}\n" SUN
      "objects:\n- {name: floor, shape: rectangle, width: 20, height: 20, reflectance: 0.5}\n");
  FILLED(abbe_image, picture, make_bars(&scene, &small_frame, NULL, &picture, &bars));
  assert_true(image_max(&picture, 0) > 0);
  /* Single precision rounds a pixel to 6e-8 of it. */
  for (size_t c = 0; c < 3; c++)
    assert_true(image_max(&bars.error, c) <= 1e-6 * image_max(&picture, c));
  assert_int_equal(bars.frames, 4); /* no photons, no coarse picture */
  assert_int_equal(bars.caustic.pixels, 0);
}

/* Edges are all that differs where nothing refracts. */
TEST(edges_have_errors) {
  abbe_error_bars_desc two = {.variants = 2};
  OWNED(abbe_scene, scene) = scene_of(CAMERA SUN FLOOR HILL);
  FILLED(abbe_error_bars, bars, make_bars(&scene, &small_frame, &two, NULL, &bars));
  assert_true(image_max(&bars.error, 0) > 0);
  assert_finite(&bars.error);
}

TEST(the_layer_is_what_compare_reads) {
  OWNED(abbe_error_bars, bars) = {0};
  abbe_render_desc xyz = small_frame;
  abbe_error_bars_desc two = {.variants = 2};
  xyz.space = ABBE_RGB_SPACE_XYZ;
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  FILLED(abbe_image, picture, make_bars(&scene, &xyz, &two, &picture, &bars));
  assert_string_equal(bars.error.channel[1], "stderr.Y");
  OK(abbe_error_bars_attach(&bars, &picture, &error));
  assert_int_equal(picture.channels, 6);
  assert_string_equal(abbe_image_attribute_text(&picture, "abbe:space"), "xyz");
  MADE(abbe_field, field, abbe_field_make(&picture, "picture", &field, &error));
  assert_non_null(field.colour.error);
  for (size_t i = 0; i < 3 * field.width * field.height; i++)
    assert_true(field.colour.error[i] == bars.error.data[i]);
  /* And they cannot be put onto a picture of another size. */
  picture.width /= 2;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_error_bars_attach(&bars, &picture, &error));
  picture.width *= 2;
}

static bool stop_now(void *user, double done) {
  int *calls = user;
  assert_true(done >= 0 && done <= 1);
  return ++*calls < 4;
}

TEST(what_is_refused) {
  abbe_error_bars bars = {0};
  int calls = 0;
  abbe_error_bars_desc one = {.variants = 1}, many = {.variants = 65};
  abbe_error_bars_desc stopped = {.progress = stop_now, .user = &calls};
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  abbe_renderer *renderer = drawn_renderer(&scene, &small_frame);
  REFUSED(ABBE_INVALID_ARGUMENT, "1 variants: there may be 2 to 64",
          abbe_error_bars_make(context, &scene, renderer, &one, &bars, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_error_bars_make(context, &scene, renderer, &many, &bars, &error));
  REFUSED(ABBE_CANCELLED, "",
          abbe_error_bars_make(context, &scene, renderer, &stopped, &bars, &error));
  assert_null(bars.error.data);
  abbe_renderer_free(renderer);
  REFUSED(ABBE_INVALID_ARGUMENT, "'thesis'",
          abbe_error_bars_check(ABBE_PROFILE_THESIS, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_error_bars_check(ABBE_PROFILE_THESIS_CIE, NULL, &error));
}
