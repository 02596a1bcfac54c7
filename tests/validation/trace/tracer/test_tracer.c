#include "tests/validation/trace_scene.h"

#include "validation/trace/tracer/tracer.h"

#define CLOSE                                                                                      \
  "materials: glass.yaml\ncamera: {eye: [0, -0.5, 0.35], target: [0, 0, 0.05], fov: 50}\n"
#define ROOF(material)                                                                             \
  "- {name: roof, shape: prism, apex: 60, side: 0.15, length: 0.2, transform: [{translate: [0, "   \
  "0, 0.3]}], material: " material "}\n"
#define TWO_LIGHTS                                                                                 \
  "lights:\n"                                                                                      \
  "- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"                       \
  "- {name: plate, kind: disk, position: [-0.2, 0, 0.5], target: [0, 0, 0.2], radius: 0.02, "      \
  "radiance: 90, illuminant: A}\n"

static const abbe_trace_desc small = {
    .width = 12, .height = 9, .map_width = 16, .photons = 3000, .threads = 1, .bands = 3};

typedef struct traced {
  abbe_image picture, map;
} traced;

static traced results_of(const abbe_tracer *tracer) {
  traced r;
  OK(abbe_tracer_picture(tracer, &r.picture, &error));
  OK(abbe_tracer_map(tracer, &r.map, &error));
  return r;
}

static void traced_free(traced *r) {
  abbe_image_free(&r->picture);
  abbe_image_free(&r->map);
}

static traced trace(const abbe_scene *scene, const abbe_trace_desc *desc, size_t passes) {
  HELD(abbe_tracer, tracer) = make_tracer(scene, desc);
  run_passes(tracer, passes);
  assert_int_equal(abbe_tracer_passes(tracer), passes);
  traced r = results_of(tracer);
  return r;
}

/* Photons come in tasks of 16384: several of them, so that threads have something to share. */
TEST(threads_do_not_matter_and_the_seed_does) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE TWO_LIGHTS FLOOR BEADS("smoke"));
  abbe_trace_desc desc = small;
  desc.photons = 36000;
  OWNED(traced, one) = trace(&scene, &desc, 2);
  for (size_t threads = 2; threads <= 3; threads++) {
    desc.threads = threads;
    OWNED(traced, more) = trace(&scene, &desc, 2);
    check_same_image(&one.picture, &more.picture);
    check_same_image(&one.map, &more.map);
  }
  desc.seed = 1;
  OWNED(traced, other) = trace(&scene, &desc, 2);
  size_t size = one.picture.width * one.picture.height * one.picture.channels;
  assert_memory_not_equal(one.picture.data, other.picture.data, size * sizeof(float));
  size = one.map.width * one.map.height * one.map.channels;
  assert_memory_not_equal(one.map.data, other.map.data, size * sizeof(float));
  assert_string_equal(abbe_image_attribute_text(&other.map, "abbe:seed"), "1");
}

/* The caller's arithmetic is as it was: numbers below 2^-126 are still numbers. */
/* Maps of two seeds can be compared: their texels lie alike. */
TEST(the_layout_does_not_hang_on_the_seed) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BEADS("crown"));
  abbe_map_layout layout[2];
  for (uint32_t seed = 0; seed < 2; seed++) {
    abbe_trace_desc desc = {.no_picture = true, .map_width = 16, .photons = 1000, .seed = seed};
    OWNED(abbe_image, map) = traced_map(&scene, &desc, 1);
    OK(abbe_map_layout_read(&map, "map", &layout[seed], &error));
  }
  assert_true(abbe_map_layout_same(&layout[0], &layout[1]));
}

TEST(tiny_numbers_are_left_to_the_caller) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR);
  OWNED(traced, r) = trace(&scene, &small, 1);
  volatile float tiny = 0x1p-126f;
  tiny *= 0.5f;
  assert_true(tiny > 0);
}

/* A pass that is stopped is forgotten: the next ones give what they would have given. */
TEST(a_stopped_pass_is_forgotten) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BEADS("crown"));
  OWNED(traced, whole) = trace(&scene, &small, 3);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  volatile int stop = 1;
  REFUSED(ABBE_CANCELLED, "", abbe_tracer_pass(tracer, &stop, &error));
  assert_int_equal(abbe_tracer_passes(tracer), 0);
  run_passes(tracer, 1);
  REFUSED(ABBE_CANCELLED, "", abbe_tracer_pass(tracer, &stop, &error));
  stop = 0;
  OK(abbe_tracer_pass(tracer, &stop, &error));
  run_passes(tracer, 1);
  assert_int_equal(abbe_tracer_passes(tracer), 3);
  OWNED(traced, broken) = results_of(tracer);
  check_same_image(&whole.picture, &broken.picture);
  check_same_image(&whole.map, &broken.map);
  abbe_trace_statistics s;
  abbe_tracer_statistics(tracer, &s);
  assert_near((double)s.photons, 3 * 3000, 0);
}

/* Over independent seeds the means spread as their standard errors say. The ratio of the two
 * variances has mean 1; over V values from S seeds its deviation is about sqrt(2 / (S - 1) / V) for
 * values that are independent, and the tolerance is four of them for a third of the values. */
TEST(standard_errors_are_honest) {
  enum { SEEDS = 10, VALUES = 16 };
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BEADS("crown"));
  abbe_trace_desc desc = {
      .width = 4, .height = 2, .map_width = 4, .map_height = 2, .photons = 1000, .threads = 1};
  abbe_tracer *first = make_tracer(&scene, &desc);
  traced like = results_of(first);
  abbe_map_layout layout;
  OK(abbe_map_layout_read(&like.map, "map", &layout, &error));
  traced_free(&like);
  abbe_tracer_free(first);
  desc.layout = &layout;
  double sum[VALUES] = {0}, square[VALUES] = {0}, told[VALUES] = {0};
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    desc.seed = 100 + seed;
    OWNED(traced, r) = trace(&scene, &desc, 12);
    for (size_t i = 0; i < VALUES; i++) {
      const abbe_image *image = i < 8 ? &r.picture : &r.map;
      const char *name = i < 8 ? "G" : "Y", *error = i < 8 ? "stderr.G" : "stderr.Y";
      const float *at = image->data + i % 8 * image->channels;
      double value = (double)at[abbe_image_find_channel(image, name)];
      sum[i] += value / SEEDS;
      square[i] += value * value / SEEDS;
      told[i] += pow((double)at[abbe_image_find_channel(image, error)], 2) / SEEDS;
    }
  }
  double ratio = 0, values = 0;
  for (size_t i = 0; i < VALUES; i++) {
    if (!(told[i] > 0)) continue;
    ratio += (square[i] - sum[i] * sum[i]) * SEEDS / (SEEDS - 1) / told[i];
    values++;
  }
  assert_true(values >= 12);
  assert_near(ratio / values, 1, 4 * sqrt(2.0 / (SEEDS - 1) / (values / 3)));
}

/* How many of a map's texels differ in colour from the light's white beyond their errors. */
static size_t coloured_texels(const char *text) {
  OWNED(abbe_scene, scene) = scene_of(text);
  abbe_trace_desc desc = {
      .no_picture = true, .map_width = 24, .photons = 20000, .threads = 1, .seed = 3};
  OWNED(abbe_image, map) = traced_map(&scene, &desc, 8);
  const double white[3] = {0.95047, 1, 1.08883}; /* D65 */
  size_t channel[3], errors[3], coloured = 0, lit = 0;
  const char *const names[3] = {"X", "Y", "Z"};
  const char *const error_names[3] = {"stderr.X", "stderr.Y", "stderr.Z"};
  for (int k = 0; k < 3; k++) {
    channel[k] = abbe_image_find_channel(&map, names[k]);
    errors[k] = abbe_image_find_channel(&map, error_names[k]);
  }
  for (size_t i = 0; i < map.width * map.height; i++) {
    const float *at = map.data + i * map.channels;
    double y = (double)at[channel[1]];
    /* seven passes' freedom: errors are known to a quarter, so five of them are wide enough */
    for (int k = 0; k < 3; k += 2)
      coloured += fabs((double)at[channel[k]] - white[k] * y) >
                  5 * ((double)at[errors[k]] + white[k] * (double)at[errors[1]]) + 2e-3 * y;
    lit += y > 0;
  }
  assert_true(lit > 20);
  double sum = channel_sum(&map, "Y");
  for (int k = 0; k < 3; k++)
    assert_near(channel_sum(&map, names[k]) / sum, white[k], 0.02 * white[k]);
  return coloured;
}

/* White in, white out; a prism spreads the light where its glass does, and not where not. */
TEST(no_dispersion_no_colour) {
  assert_int_equal(coloured_texels(CLOSE POINT_LIGHT FLOOR ROOF("flat")), 0);
  assert_true(coloured_texels(CLOSE POINT_LIGHT FLOOR ROOF("crown")) > 8);
}

/* The map holds what landed, within its window; the light's cone around the ball was all reached.
 */
TEST(the_map_holds_what_landed) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BALL("flat"));
  abbe_trace_desc desc = {.no_picture = true, .map_width = 32, .photons = 30000, .threads = 1};
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  run_passes(tracer, 2);
  abbe_trace_statistics s;
  abbe_tracer_statistics(tracer, &s);
  double away = sqrt(0.05 * 0.05 + 0.03 * 0.03 + 0.4 * 0.4);
  double cone = 2 * 3.14159265358979 * (1 - cos(asin(0.08 / away)));
  assert_near(s.ledger.reached / cone, 1, 0.01);
  double parts = s.ledger.deposited + s.ledger.missed + s.ledger.absorbed + s.ledger.trapped;
  assert_near((parts + s.ledger.lost) / s.ledger.reached, 1, 1e-3);
  assert_true(s.ledger.lost < 1e-4 * s.ledger.reached);
  MADE(abbe_image, map, abbe_tracer_map(tracer, &map, &error));
  double held = channel_sum(&map, "Y") / s.ledger.deposited;
  assert_true(held > 0.9 && held < 1.001);
  assert_string_equal(abbe_image_attribute_text(&map, "abbe:kind"), "receiver map");
  assert_string_equal(abbe_image_attribute_text(&map, "abbe:physics"), "full");
  assert_string_equal(abbe_image_attribute_text(&map, "abbe:passes"), "2");
  assert_string_equal(abbe_image_attribute_text(&map, "abbe:map_light"), "lamp");
  abbe_image none;
  assert_int_equal(abbe_tracer_picture(tracer, &none, NULL), ABBE_INVALID_ARGUMENT);
}

/* Watts a nanometre times the bands' width are watts: of an even light, Y's mean is that too. */
TEST(bands_hold_the_maps_watts) {
  OWNED(abbe_scene, scene) =
      scene_of(CLOSE "lights:\n- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: "
                     "1, illuminant: E}\n" FLOOR BALL("flat"));
  abbe_trace_desc desc = {
      .no_picture = true, .map_width = 8, .photons = 40000, .threads = 1, .bands = 4};
  OWNED(traced, r) = {.picture = {0}};
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  run_passes(tracer, 2);
  OK(abbe_tracer_map(tracer, &r.map, &error));
  const char *const bands[4] = {"S0.430,000000nm", "S0.530,000000nm", "S0.630,000000nm",
                                "S0.730,000000nm"};
  double y = channel_sum(&r.map, "Y");
  for (int i = 0; i < 4; i++) assert_near(channel_sum(&r.map, bands[i]) * 100 / y, 0.25, 0.01);
  assert_true(channel_sum(&r.map, "stderr.S0.430,000000nm") > 0);
  assert_string_equal(abbe_image_attribute_text(&r.map, "emissiveUnits"), "W.nm^-1");
  assert_string_equal(abbe_image_attribute_text(&r.map, "spectralLayoutVersion"), "1.0");
}

/* Without glass there is no caustic, and the map is empty; the picture stands. */
TEST(a_scene_without_glass) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR);
  OWNED(traced, r) = trace(&scene, &small, 2);
  assert_true(channel_sum(&r.map, "Y") == 0);
  assert_true(channel_sum(&r.picture, "caustic.G") == 0);
  assert_true(channel_sum(&r.picture, "G") > 0);
}

/* Direct light is shadowed by glass, and the caustic brings a part of it back; ACEScg and XYZ are
 * one picture in two spaces. */
TEST(the_caustic_is_part_of_the_picture) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BEADS("crown"));
  abbe_trace_desc desc = small;
  desc.bands = 0;
  desc.no_map = true;
  double y[ABBE_RGB_SPACE_COUNT];
  for (int space = 0; space < ABBE_RGB_SPACE_COUNT; space += 2) {
    desc.space = (abbe_rgb_space)space;
    HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
    run_passes(tracer, 4);
    MADE(abbe_image, picture, abbe_tracer_picture(tracer, &picture, &error));
    bool xyz = space == ABBE_RGB_SPACE_XYZ;
    const char *const names[3] = {xyz ? "X" : "R", xyz ? "Y" : "G", xyz ? "Z" : "B"};
    double to_xyz[9], sum[3];
    for (int k = 0; k < 3; k++) sum[k] = channel_sum(&picture, names[k]);
    abbe_rgb_space_to_xyz((abbe_rgb_space)space, to_xyz);
    abbe_rgb_space_apply(to_xyz, sum, sum);
    y[space] = sum[1];
    double caustic = channel_sum(&picture, xyz ? "caustic.Y" : "caustic.G");
    assert_true(caustic > 0 && caustic < channel_sum(&picture, names[1]));
    assert_true(abbe_rgb_space_of_chromaticities(picture.xy) == (abbe_rgb_space)space);
    abbe_image none;
    assert_int_equal(abbe_tracer_map(tracer, &none, NULL), ABBE_INVALID_ARGUMENT);
  }
  assert_near(y[ABBE_RGB_SPACE_XYZ] / y[ABBE_RGB_SPACE_ACESCG], 1, 2e-3);
}

/* One pass has no spread: its files say nothing of errors, and two passes' do. */
TEST(one_pass_has_no_errors) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BEADS("crown"));
  abbe_trace_desc desc = small;
  desc.bands = 4;
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
  for (size_t passes = 1; passes <= 2; passes++) {
    run_passes(tracer, 1);
    for (int map = 0; map < 2; map++) {
      MADE(abbe_image, image, (map ? abbe_tracer_map : abbe_tracer_picture)(tracer, &image, NULL));
      size_t errors = 0;
      for (size_t c = 0; c < image.channels; c++)
        errors += strncmp(image.channel[c], "stderr.", 7) == 0;
      assert_int_equal(errors, passes == 1 ? 0 : 3 + 4);
      for (size_t i = 0; i < image.width * image.height * image.channels; i++)
        assert_true(isfinite(image.data[i]));
    }
  }
}

TEST(the_error_falls) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BEADS("crown"));
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &small);
  assert_true(isinf(abbe_tracer_error(tracer)));
  run_passes(tracer, 1);
  assert_true(isinf(abbe_tracer_error(tracer)));
  run_passes(tracer, 7);
  double early = abbe_tracer_error(tracer);
  run_passes(tracer, 24);
  double late = abbe_tracer_error(tracer);
  /* four times the passes: half the error, within what such an error is known to */
  assert_near(late / early, 0.5, 0.2);
  abbe_trace_statistics s;
  abbe_tracer_statistics(tracer, &s);
  assert_int_equal(s.passes, 32);
  assert_true(s.light_rays > 32 * 3000 && s.eye_rays >= 32 * 12 * 9);
  assert_true(s.cuts == 0 && s.radius > 0);
}

static void refuse(const abbe_scene *scene, abbe_trace_desc desc, abbe_result why,
                   const char *part) {
  abbe_tracer *tracer = NULL;
  abbe_error error = {0};
  desc.threads = desc.threads ? desc.threads : 1;
  abbe_result result = abbe_tracer_make(scene, &desc, &tracer, &error);
  if (result != why) print_error("%d: %s\n", result, error.text);
  assert_int_equal(result, why);
  assert_null(tracer);
  assert_contains(error.text, part);
}

TEST(what_is_out_of_limits_is_refused) {
  OWNED(abbe_scene, scene) = scene_of(CLOSE POINT_LIGHT FLOOR BALL("narrow"));
  const abbe_result bad = ABBE_INVALID_ARGUMENT;
  refuse(&scene, (abbe_trace_desc){.width = 8193}, bad, "8193");
  refuse(&scene, (abbe_trace_desc){.height = SIZE_MAX}, bad, "height");
  refuse(&scene, (abbe_trace_desc){.map_width = 100000}, bad, "map");
  refuse(&scene, (abbe_trace_desc){.photons = ABBE_TRACER_MAX_PHOTONS + 1}, bad, "67108865");
  refuse(&scene, (abbe_trace_desc){.threads = 257}, bad, "threads");
  refuse(&scene, (abbe_trace_desc){.map_light = 1}, bad, "light");
  refuse(&scene, (abbe_trace_desc){.no_map = true, .no_picture = true}, bad, "neither");
  refuse(&scene, (abbe_trace_desc){.min_nm = 700, .max_nm = 500}, bad, "700:500");
  refuse(&scene, (abbe_trace_desc){.min_nm = 1000, .max_nm = 1100}, bad, "eye");
  refuse(&scene, (abbe_trace_desc){.min_nm = NAN}, bad, "range");
  refuse(&scene, (abbe_trace_desc){.min_nm = 450, .max_nm = 650, .bands = 257}, bad, "257");
  /* the glass is known from 400 to 700 nm */
  refuse(&scene, (abbe_trace_desc){.width = 8}, ABBE_OUT_OF_RANGE, "narrow");
  abbe_map_layout broken = {.knot = {{0}}};
  refuse(&scene, (abbe_trace_desc){.min_nm = 450, .max_nm = 650, .layout = &broken}, bad, "");
  size_t objects = scene.object_count, lights = scene.light_count;
  scene.light_count = 0;
  refuse(&scene, (abbe_trace_desc){.width = 8}, bad, "no light");
  scene.light_count = lights;
  scene.object_count = 0;
  refuse(&scene, (abbe_trace_desc){.width = 8}, bad, "no object");
  scene.object_count = objects;
  abbe_scene_free(&scene);
  scene = scene_of(CLOSE FLOOR BALL("flat") "environment: {size: 64, uniform: 1}\n");
  refuse(&scene, (abbe_trace_desc){.width = 8}, bad, "a map is of one light");
  abbe_tracer_free(NULL);
}

/* Scenes of a tenth of a millimetre and of a hundred kilometres have the same picture as one of a
 * metre: lengths times s, intensities times s^2. */
TEST(size_does_not_matter) {
  double expected = 0, lit = 0;
  for (int i = 0; i < 3; i++) {
    double s = i == 0 ? 1 : i == 1 ? 1e-4 : 1e5;
    OWNED(abbe_scene, scene) = scene_of(printed(
        "materials: glass.yaml\ncamera: {eye: [0, %.9g, %.9g], target: [0, 0, %.9g], fov: "
        "50}\nlights:\n- {name: lamp, kind: point, position: [%.9g, %.9g, %.9g], intensity: "
        "1}\nobjects:\n- {name: floor, shape: rectangle, width: %.9g, height: %.9g, "
        "reflectance: 0.5}\n- {name: ball, shape: sphere, radius: %.9g, transform: "
        "[{translate: [0, 0, %.9g]}], material: crown}\n",
        -0.5 * s, 0.35 * s, 0.05 * s, 0.05 * s, 0.03 * s, 0.6 * s, 2 * s, 2 * s, 0.08 * s,
        0.2 * s));
    scene.light[0].power = s * s;
    OWNED(traced, r) = trace(&scene, &small, 4);
    double picture = channel_sum(&r.picture, "G"), map = channel_sum(&r.map, "Y") / (s * s);
    if (i == 0) {
      expected = picture;
      lit = map;
    }
    assert_true(picture > 0 && map > 0);
    assert_near(picture / expected, 1, 0.01);
    assert_near(map / lit, 1, 0.01);
  }
}
