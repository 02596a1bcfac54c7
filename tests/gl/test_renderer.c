/* The renderer's laws: energy is kept, frames repeat, white stays white without dispersion. */
#include "tests/gl/frame.h"

#include "colorimetry/weights.h"

static const char *const shipped[] = {"sphere", "ring",  "gem",    "bunny",
                                      "glass",  "prism", "rainbow"};
enum { SHIPPED = sizeof shipped / sizeof *shipped };

/* The ledger's parts and the map are whole multiples of 2^-24 and 2^-28 of a cell's flux: what is
 * left of the balance is rounding, far below the 1e-4 that is promised. */
static void assert_balance(const abbe_statistics *s, const char *name) {
  double imbalance = abbe_ledger_imbalance(&s->energy);
  if (!(imbalance < 1e-4)) print_error("%s: imbalance %g\n", name, imbalance);
  assert_true(imbalance < 1e-4);
  assert_true(s->energy.reached > 0);
  assert_true(s->energy.deposited > 0);
  assert_true(s->energy.deposited < s->energy.reached);
  assert_true(s->energy.reflected > 0);
}

/* The map read as a picture holds what the ledger says was deposited, but on receivers' tiles. */
static void assert_map_holds(abbe_renderer *renderer, const abbe_ledger *l) {
  const double deposited = l->deposited - l->on_tiles;
  OWNED(abbe_image, map) = map_of(renderer, 0);
  assert_finite(&map);
  /* A texel is a float: 6e-8 of it, and all of them together no more. */
  assert_near(image_sum(&map, 1) / deposited, 1, 1e-6);
}

static void assert_repeats(abbe_renderer *renderer) {
  abbe_image map[2] = {{0}, {0}};
  OWNED(abbe_image, first) = picture_of(renderer);
  map[0] = map_of(renderer, 0);
  abbe_renderer_redraw(renderer);
  draw_frame(renderer);
  OWNED(abbe_image, second) = picture_of(renderer);
  map[1] = map_of(renderer, 0);
  assert_finite(&first);
  assert_true(image_max(&first, 1) > 0);
  assert_same_pixels(&first, &second);
  assert_same_pixels(&map[0], &map[1]);
  abbe_image_free(&map[0]);
  abbe_image_free(&map[1]);
}

/* What ran is what the plan says. */
static void assert_as_planned(const abbe_renderer *renderer, const abbe_statistics *s) {
  for (size_t i = 0; i < s->pass_count; i++) {
    const abbe_plan_entry *entry = abbe_plan_find(abbe_renderer_plan(renderer), s->pass[i].pass, 0);
    if (entry == NULL || !entry->runs)
      print_error("'%s' ran unplanned\n", abbe_plan_item_text(s->pass[i].pass));
    assert_true(entry != NULL && entry->runs);
  }
}

GROUP(make_context, free_context);

/* All of them balance in their reference tests. */
TEST(shipped_scenes_balance_and_repeat) {
  for (int i = 0; i < SHIPPED; i += all_cases() ? 1 : 2) {
    OWNED(abbe_scene, scene) = shipped_scene(shipped[i]);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &small_frame);
    abbe_statistics s = draw_frame(renderer);
    assert_balance(&s, shipped[i]);
    assert_true(s.photons > 0 && s.photons <= 64 * 64);
    assert_int_equal(s.wavelengths, 7);
    assert_as_planned(renderer, &s);
    assert_map_holds(renderer, &s.energy);
    assert_repeats(renderer);
  }
}

/* The thesis's map is the light's own frustum, so that it holds nothing of the prism's light. */
static void the_thesis_renders(abbe_profile profile, int step) {
  for (int i = 0; i < SHIPPED; i += all_cases() ? 1 : step) {
    abbe_render_desc desc = small_frame;
    desc.profile = profile;
    OWNED(abbe_scene, scene) = shipped_scene(shipped[i]);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    abbe_statistics s = draw_frame(renderer);
    assert_int_equal(s.wavelengths, 7);
    assert_true(s.photons > 0);
    OWNED(abbe_image, image) = picture_of(renderer);
    OWNED(abbe_image, map) = map_of(renderer, 0);
    assert_finite(&image);
    assert_finite(&map);
    assert_true(image_max(&image, 0) > 0);
    if (strcmp(shipped[i], "prism") != 0) assert_true(image_max(&map, 0) > 0);
  }
}

TEST(the_thesis_profiles_render) {
  the_thesis_renders(ABBE_PROFILE_THESIS, 2);
  the_thesis_renders(ABBE_PROFILE_THESIS_CIE, 5); /* the sphere and the prism */
}

/* Every model, light and material at once, at sizes that divide nothing; the first (with all cases,
 * the last, too) also with one photon and with a map of one texel. */
TEST(mixed_scenes_balance) {
  static const char *const texts[] = {
      CAMERA POINT_LIGHT FLOOR BALL("smoke"),
      CAMERA POINT_LIGHT FLOOR BRICK("crown"),
      CAMERA POINT_LIGHT FLOOR RING("smoke"),
      CAMERA SUN FLOOR BALL("crown"),
      CAMERA SUN FLOOR HILL RING("crown"),
      CAMERA POINT_LIGHT
      "- {name: sun, kind: directional, direction: [1, 0, -2], irradiance: 2}\n" FLOOR HILL BALL(
          "smoke") BRICK("crown"),
  };
  static const size_t photons[] = {1, 3, 30, 100}, maps[] = {1, 7, 100};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
    abbe_render_desc desc = small_frame;
    if (!all_cases() && (i == 1 || i == 2 || i == 3)) continue;
    desc.photons = photons[2 + i % 2];
    desc.map_size = maps[2];
    OWNED(abbe_scene, scene) = scene_of(texts[i]);
    look_aside(&scene);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    abbe_statistics s = draw_frame(renderer);
    assert_balance(&s, texts[i]);
    assert_int_equal(s.energy.absorbed > 0, abbe_renderer_plan(renderer)->absorbing);
    const bool ends = i == 0 || (all_cases() && i + 1 == sizeof texts / sizeof *texts);
    for (size_t k = ends ? 0 : 3; k < 4; k++) {
      desc.photons = photons[k % 2];
      desc.map_size = maps[k / 2];
      OK(abbe_renderer_change(renderer, &scene, &desc, &error));
      s = draw_frame(renderer);
      assert_true(abbe_ledger_imbalance(&s.energy) < 1e-4);
    }
  }
}

/* Samples go to the device in batches; their number changes neither balance nor total. */
TEST(many_wavelengths_add_up) {
  static const size_t counts[] = {1, 2, 64, 65, 200};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  look_aside(&scene);
  double first = 0;
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    abbe_render_desc desc = small_frame;
    desc.wavelengths = counts[i];
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    abbe_statistics s = draw_frame(renderer);
    assert_balance(&s, "flat ball");
    if (i == 0) first = s.energy.deposited;
    /* One constant index: the same light, whole multiples of 2^-28 apart for each sample. */
    assert_near(s.energy.deposited / first, 1, 1e-4);
  }
}

/* D65's white over the range, in the space asked for. */
static void white_of(abbe_rgb_space space, double white[3]) {
  const abbe_illuminant d65 = {0};
  MADE(abbe_wavelengths, w, abbe_wavelengths_make(7, 380, 780, &w, &error));
  MADE(abbe_weights, weights, abbe_weights_make(&w, &d65, space, &weights, &error));
  memcpy(white, weights.sum, sizeof weights.sum);
}

/* By 2^-93 and 2^93: light that floats could not sum is scaled inside, and back. */
TEST(faint_light_is_the_same_light) {
  static const int powers[] = {0, -93, 93};
  abbe_image picture[3], map[3];
  abbe_ledger energy[3];
  abbe_render_desc desc = small_frame;
  desc.aovs = true;
  for (int i = 0; i < 3; i++) {
    abbe_scene scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("murk"));
    scene.light[0].power = ldexp(1, powers[i]);
    scene.ambient = ldexp(0.25, powers[i]);
    scene.background = ldexp(0.125, powers[i]);
    abbe_renderer *renderer = make_renderer(&scene, &desc);
    energy[i] = draw_frame(renderer).energy;
    picture[i] = aovs_of(renderer);
    map[i] = map_of(renderer, 0);
    abbe_renderer_free(renderer);
    abbe_scene_free(&scene);
    assert_true(energy[i].reached > 0 && abbe_ledger_imbalance(&energy[i]) < 1e-4);
    assert_near(ldexp(energy[i].reached, -powers[i]) / energy[0].reached, 1, 0);
    assert_near(ldexp(energy[i].deposited, -powers[i]) / energy[0].deposited, 1, 0);
    for (size_t k = 0; k < map[0].width * map[0].height * map[0].channels; k++)
      assert_near(ldexp((double)map[i].data[k], -powers[i]), (double)map[0].data[k],
                  1e-6 * (double)map[0].data[k] + 0x1p-50);
    for (size_t k = 0; k < picture[0].width * picture[0].height * picture[0].channels; k++) {
      const bool depth = k % picture[0].channels == 3;
      assert_near(ldexp((double)picture[i].data[k], depth ? 0 : -powers[i]),
                  (double)picture[0].data[k], 0);
    }
  }
  for (int i = 0; i < 3; i++) {
    abbe_image_free(&picture[i]);
    abbe_image_free(&map[i]);
  }
}

TEST(white_in_white_out) {
  abbe_render_desc desc = small_frame;
  desc.wavelengths = 7;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  FILLED(abbe_image, map, make_map(&scene, &desc, &map));
  double white[3], sum[3], total = 0, white_total = 0;
  white_of(ABBE_RGB_SPACE_XYZ, white);
  for (int c = 0; c < 3; c++) {
    total += sum[c] = image_sum(&map, (size_t)c);
    white_total += white[c];
  }
  assert_near(sum[0] / total, white[0] / white_total, 1e-4);
  assert_near(sum[1] / total, white[1] / white_total, 1e-4);
}

/* Grey things, a constant index and 7 wavelengths: every pixel has the light's own chromaticity,
 * whether it is seen straight or through glass. */
TEST(no_dispersion_no_colour) {
  static const char *const texts[] = {CAMERA POINT_LIGHT FLOOR BALL("flat"),
                                      CAMERA POINT_LIGHT FLOOR BRICK("flat"),
                                      CAMERA POINT_LIGHT FLOOR RING("flat")};
  double white[3];
  white_of(ABBE_RGB_SPACE_ACESCG, white);
  for (size_t i = 0; i < 3; i++) {
    abbe_render_desc desc = small_frame;
    desc.wavelengths = 7;
    OWNED(abbe_scene, scene) = scene_of(texts[i]);
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    OWNED(abbe_image, image) = picture_of(renderer);
    double tolerance = 1e-4 * image_max(&image, 1);
    assert_true(tolerance > 0);
    for (size_t k = 0; k < image.width * image.height; k++) {
      const float *rgb = image.data + 3 * k;
      assert_near(rgb[0] / white[0], rgb[1] / white[1], tolerance);
      assert_near(rgb[2] / white[2], rgb[1] / white[1], tolerance);
    }
  }
}

/* The largest difference of two maps' Y as a share of their largest. */
static double difference(const abbe_image *a, const abbe_image *b) {
  double most = 0;
  for (size_t i = 0; i < a->width * a->height; i++)
    most = fmax(most, fabs((double)a->data[3 * i + 1] - (double)b->data[3 * i + 1]));
  return most / image_max(a, 1);
}

static void map_of_dispersion(const char *text, double factor, size_t wavelengths,
                              abbe_image *map) {
  abbe_render_desc desc = small_frame;
  desc.wavelengths = wavelengths;
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t i = 0; i < scene.table.count; i++) scene.table.material[i].dispersion.c[1] *= factor;
  make_map(&scene, &desc, map);
}

TEST(dispersion_goes_to_the_map_without) {
  static const char *const texts[] = {CAMERA POINT_LIGHT FLOOR BALL("crown"),
                                      CAMERA POINT_LIGHT FLOOR BRICK("crown")};
  for (size_t i = 0; i < 2; i++) {
    OWNED(abbe_image, none) = {0}, tiny = {0}, one = {0}, full = {0};
    map_of_dispersion(texts[i], 0, 7, &none);
    map_of_dispersion(texts[i], 1e-6, 7, &tiny);
    map_of_dispersion(texts[i], 0, 1, &one);
    map_of_dispersion(texts[i], 1, 7, &full);
    /* n differs by 4e-8, less than a float resolves: what is left is rounding. */
    assert_true(difference(&none, &tiny) < 1e-3);
    assert_true(difference(&none, &one) < 1e-3);
    assert_true(difference(&none, &full) > 1e-2);
  }
}
