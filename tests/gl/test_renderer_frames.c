/* What a renderer's caller gets: frames that can be stopped, pictures, maps, and refusals. */
#include "tests/gl/frame.h"

static bool stop_now(void *user, double done) {
  assert_true(done >= 0 && done <= 1);
  ++*(int *)user;
  return false;
}

static bool count_calls(void *user, double done) {
  double *last = user;
  assert_true(done >= *last && done <= 1);
  *last = done;
  return true;
}

static void assert_picture_again(abbe_renderer *renderer, const abbe_image *before) {
  OWNED(abbe_image, after) = picture_of(renderer);
  assert_same_pixels(before, &after);
}

GROUP(make_context, free_context);

TEST(a_frame_can_be_stopped_and_drawn_again) {
  int calls = 0;
  double last = 0;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &small_frame);
  OWNED(abbe_image, before) = picture_of(renderer);
  abbe_renderer_redraw(renderer);
  REFUSED(ABBE_CANCELLED, "", abbe_renderer_frame(renderer, stop_now, &calls, NULL, &error));
  assert_int_equal(calls, 1);
  OK(abbe_renderer_frame(renderer, count_calls, &last, NULL, &error));
  assert_near(last, 1, 0);
  assert_picture_again(renderer, &before);
}

TEST(the_baseline_and_a_rest_leave_the_picture) {
  for (size_t samples = 1; samples <= 2; samples++) {
    double ms = 0;
    OWNED(abbe_scene, scene) = shipped_scene("sphere");
    const abbe_render_desc desc = FIELDS(.width = 32, .height = 32, .photons = 64, .map_size = 64,
                                         .wavelengths = 3, .supersample = samples);
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    OWNED(abbe_image, before) = picture_of(renderer);
    OK(abbe_renderer_baseline(renderer, &ms, &error));
    assert_true(ms > 0);
    assert_picture_again(renderer, &before);
    abbe_renderer_rest(renderer);
    assert_picture_again(renderer, &before);
    abbe_renderer_redraw(renderer);
    draw_frame(renderer);
    assert_picture_again(renderer, &before);
  }
}

/* One sample for 2 x 2 pixels is a picture of half the size, and between its pixels what lies
 * between them, or, of what moves, left to who shows it; where sides are odd the last sample stands
 * for what is left. */
TEST(fewer_samples_than_pixels) {
  enum { KINDS = 5 };
  abbe_image coarse = {0}, half = {0}, odd = {0}, fine = {0}, moving = {0};
  OWNED(abbe_scene, scene) = shipped_scene("sphere");
  abbe_render_desc desc = FIELDS(.width = 64, .height = 48, .photons = 32, .map_size = 64,
                                 .wavelengths = 3, .aovs = true, .upsample = 2);
  abbe_image *const out[KINDS] = {&coarse, &half, &odd, &fine, &moving};
  const size_t sizes[KINDS][2] = {{64, 48}, {32, 24}, {63, 47}, {63, 47}, {64, 48}},
               up[KINDS] = {2, 1, 2, 1, 2};
  for (size_t i = 0; i < KINDS; i++) {
    desc.width = sizes[i][0];
    desc.height = sizes[i][1];
    desc.upsample = up[i];
    desc.supersample = i == 3 ? 4 : 1;
    desc.adaptive = i == 1 ? 1 : 0; /* as with upsample */
    desc.coarse = i == 4 ? ABBE_COARSE_EYE : ABBE_COARSE_NONE;
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    *out[i] = aovs_of(renderer);
  }
  double worst = 0;
  for (size_t y = 0; y < 48; y++)
    for (size_t x = 0; x < 64; x++)
      for (size_t c = 0; c < coarse.channels; c++) {
        double sum = 0;
        for (int k = 0; k < 4 && c != 3; k++) { /* not between distances */
          const size_t beside[2] = {x % 2 == 0 ? x / 2 - (x > 0) : x / 2 + (x < 63),
                                    y % 2 == 0 ? y / 2 - (y > 0) : y / 2 + (y < 47)};
          const size_t column = k % 2 == 0 ? x / 2 : beside[0],
                       row = k / 2 == 0 ? y / 2 : beside[1];
          sum += (k % 2 == 0 ? 0.75 : 0.25) * (k / 2 == 0 ? 0.75 : 0.25) *
                 (double)half.data[(row * 32 + column) * half.channels + c];
        }
        if (c == 3) sum = (double)half.data[(y / 2 * 32 + x / 2) * half.channels + c];
        worst = fmax(worst, fabs(sum - (double)coarse.data[(y * 64 + x) * coarse.channels + c]) /
                                fmax(fabs(sum), 1e-3));
      }
  /* paths in glass end sooner */
  double apart = 0;
  for (size_t i = 0; i < moving.width * moving.height * moving.channels; i++)
    apart += fabs((double)moving.data[i] - (double)half.data[i]);
  assert_int_equal(moving.width, half.width);
  assert_int_equal(moving.height, half.height);
  const double light = (image_sum(&half, 0) + image_sum(&half, 1) + image_sum(&half, 2));
  print_message("of what moves %.4f of the light lies elsewhere\n", apart / light);
  assert_true(apart < 0.01 * light);
  const double mean = image_sum(&odd, 1) / image_sum(&fine, 1);
  print_message("off by %.2g at the most, odd sides %.4f of the light\n", worst, mean);
  assert_true(worst < 1e-5);
  assert_true(fabs(mean - 1) < 0.01);
  for (size_t i = 0; i < KINDS; i++) abbe_image_free(out[i]);
}

/* A map laid out as another of the same scene is that map, to the bit; with half the texels a side
 * its energy is the same, and each light has a map of its own. */
TEST(a_map_takes_a_given_layout) {
  abbe_image fitted, again, half;
  abbe_map_layout first, layout, given;
  OWNED(abbe_scene, scene) = scene_of(
      CAMERA POINT_LIGHT
      "- {name: sun, kind: directional, direction: [0.1, 0.2, -1], irradiance: 1}\n" FLOOR BALL(
          "crown") HILL);
  abbe_render_desc desc = small_frame;
  for (size_t light = 0; light < 2; light++) {
    desc.map_layout = NULL;
    abbe_renderer *renderer = drawn_renderer(&scene, &desc);
    fitted = map_of(renderer, light);
    abbe_renderer_map_layout(renderer, light, &layout);
    abbe_renderer_map_layout(renderer, 1 - light, &first);
    abbe_renderer_free(renderer);
    assert_false(abbe_map_layout_same(&first, &layout));
    assert_string_equal(abbe_image_attribute_text(&fitted, "abbe:map_light"),
                        scene.light[light].name);
    OK(abbe_map_layout_read(&fitted, "map", &given, &error));
    assert_true(abbe_map_layout_same(&layout, &given));

    desc.map_layout = &given;
    desc.map_layout_light = light;
    renderer = make_renderer(&scene, &desc);
    draw_frame(renderer);
    again = map_of(renderer, light);
    assert_same_pixels(&fitted, &again);
    abbe_renderer_map_layout(renderer, 1 - light, &given);
    assert_true(abbe_map_layout_same(&first, &given)); /* the other light's is fitted */
    abbe_renderer_free(renderer);

    desc.map_size /= 2;
    given = layout;
    renderer = make_renderer(&scene, &desc);
    draw_frame(renderer);
    half = map_of(renderer, light);
    /* Light at the rim is spread bilinearly past it from coarser texels: under a thousandth. */
    assert_near(image_sum(&half, 1) / image_sum(&fitted, 1), 1, 1e-3);
    abbe_renderer_free(renderer);
    desc.map_size *= 2;
    abbe_image_free(&fitted);
    abbe_image_free(&again);
    abbe_image_free(&half);
  }
}

TEST(what_is_not_there_is_refused) {
  abbe_image map = {0};
  HELD(abbe_renderer, renderer) = NULL;
  const abbe_render_desc huge = {.photons = ABBE_RENDER_MAX_PHOTONS + 1};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR);
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_renderer_make(context, &scene, &huge, &renderer, &error));
  assert_null(renderer);
  renderer = make_renderer(&scene, &small_frame);
  draw_frame(renderer);
  REFUSED(ABBE_INVALID_ARGUMENT, "no spectral map",
          abbe_renderer_read_map(renderer, 0, true, &map, &error));
  assert_null(map.data);
  abbe_renderer_free(NULL);
}

/* What was not drawn is not black. */
TEST(nothing_is_read_before_a_frame) {
  abbe_image image = {0};
  int calls = 0;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &small_frame);
  for (int turn = 0; turn < 2; turn++) {
    REFUSED(ABBE_INVALID_ARGUMENT, "no frame has been drawn",
            abbe_renderer_read(renderer, false, &image, &error));
    REFUSED(ABBE_INVALID_ARGUMENT, "no frame has been drawn",
            abbe_renderer_read_map(renderer, 0, true, &image, &error));
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_renderer_read_map_bands(renderer, 0, 3, &image, &error));
    assert_null(image.data);
    if (turn > 0) continue;
    draw_frame(renderer);
    image = picture_of(renderer);
    abbe_image_free(&image);
    /* Nor what a frame that was stopped has left. */
    abbe_renderer_redraw(renderer);
    REFUSED(ABBE_CANCELLED, "", abbe_renderer_frame(renderer, stop_now, &calls, NULL, &error));
  }
}

/* Textures of what moves have a row and a column more where sides are powers of two
 * (camera_view.h), and layers are looked up in the part that is drawn. */
TEST(layers_of_what_moves) {
  abbe_image image[2];
  abbe_render_desc desc = FIELDS(.width = 64, .height = 64, .photons = 32, .map_size = 64,
                                 .wavelengths = 3, .supersample = 1, .adaptive = 1,
                                 .energy_share = ABBE_COARSE_SHARE, .model = ABBE_MODEL_LAYERS);
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  for (size_t i = 0; i < 2; i++) {
    desc.coarse = i == 0 ? ABBE_COARSE_NONE : ABBE_COARSE_EYE;
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    image[i] = aovs_of(renderer);
  }
  double apart = 0, light = 0;
  for (size_t i = 0; i < 64 * 64; i++) {
    const double a = (double)image[0].data[i * image[0].channels],
                 b = (double)image[1].data[i * image[1].channels];
    light += a;
    apart += fabs(b - a);
  }
  print_message("by layers, of what moves %.4f of the light lies elsewhere\n", apart / light);
  assert_true(apart < 0.01 * light);
  for (size_t i = 0; i < 2; i++) abbe_image_free(&image[i]);
}

/* One thread a pixel follows what the camera sees there, so a group has many pixels; what they
 * share is no more than a device has, beside mirrors too. */
TEST(programs_of_what_moves_link) {
  static const char *const names[] = {"metal-ring", "metals", "octahedra"};
  const abbe_render_desc desc = FIELDS(.width = 32, .height = 32, .photons = 16, .map_size = 32,
                                       .upsample = 2, .coarse = ABBE_COARSE_ALL);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    OWNED(abbe_scene, scene) = shipped_scene(names[i]);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
  }
}
