/* A light amid refractors: a cube of maps. Its light against solid angles, one view, another turn
 * of the scene and the tracer, which shares no code with it. */
#include "tests/gl/frame.h"
#include "tests/validation/trace_scene.h"

#include "base/maths.h"
#include "gl/plan/examine/examine.h"

typedef struct place {
  double at[3], radius;
} place;

/* Balls and a lamp over a floor, all turned about the lamp's upright axis. */
static void load_balls(const place *ball, size_t count, double turn_degrees, const char *light,
                       abbe_scene *scene) {
  char text[4096];
  const double c = cos(turn_degrees * ABBE_PI / 180), s = sin(turn_degrees * ABBE_PI / 180);
  int used = snprintf(text, sizeof text,
                      "materials: glass.yaml\n"
                      "camera: {eye: [%.12g, %.12g, 1.2], target: [0, 0, 0.05]}\n"
                      "lights:\n- {name: lamp, %s, position: [0, 0, 0.2], intensity: 1}\n"
                      "objects:\n- {name: floor, shape: rectangle, width: 2, height: 2, "
                      "reflectance: 0.5, transform: [{rotate: {axis: [0, 0, 1], angle: %g}}]}\n",
                      s * 0.8, -c * 0.8, light, turn_degrees);
  for (size_t i = 0; i < count; i++)
    used += snprintf(text + used, sizeof text - (size_t)used,
                     "- {name: ball%zu, shape: sphere, radius: %.12g, levels: 3, transform: "
                     "[{translate: [%.12g, %.12g, %.12g]}], material: flat}\n",
                     i, ball[i].radius, c * ball[i].at[0] - s * ball[i].at[1],
                     s * ball[i].at[0] + c * ball[i].at[1], 0.2 + ball[i].at[2]);
  *scene = scene_of(text);
}

static const char point[] = "kind: point";

/* W of 1 W/sr; they do not hide one another. */
static double light_into(const place *ball, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    const double *d = ball[i].at, distance2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    sum += 2 * ABBE_PI * (1 - sqrt(1 - ball[i].radius * ball[i].radius / distance2));
  }
  return sum;
}

static abbe_statistics draw(const abbe_scene *scene, const abbe_render_desc *desc, bool cube,
                            abbe_image *picture) {
  HELD(abbe_renderer, renderer) = make_renderer(scene, desc);
  assert_true(abbe_renderer_plan(renderer)->cubes == cube);
  const abbe_statistics statistics = draw_frame(renderer);
  if (picture != NULL) *picture = read_picture(renderer, desc->aovs);
  return statistics;
}

/* On axes, on seams and on a corner of three faces; all around; all about the lamp's upper half. As
 * many balls in as many faces share their shaders. */
static const struct {
  size_t count;
  place ball[6];
} crowds[] = {
    {6,
     {{{-0.3, 0, 0}, 0.08},
      {{0.3, 0, 0}, 0.08},
      {{-0.3, -0.3, 0}, 0.1},
      {{0.3, 0.3, 0}, 0.1},
      {{0.2, 0.2, 0.2}, 0.1},
      {{0.02, 0, -0.12}, 0.06}}},
    {6,
     {{{0.3, 0.02, 0.1}, 0.08},
      {{-0.3, 0.1, 0}, 0.1},
      {{0.05, 0.3, 0}, 0.07},
      {{0, -0.25, 0.1}, 0.09},
      {{0, 0.05, 0.4}, 0.2},
      {{0.02, 0, -0.12}, 0.06}}},
    {1, {{{0, 0, 0.201}, 0.2}}},
};

GROUP(make_context, free_context);

TEST(all_light_goes_in_once) {
  for (size_t i = 0; i < sizeof crowds / sizeof *crowds; i++) {
    FILLED(abbe_scene, scene, load_balls(crowds[i].ball, crowds[i].count, 0, point, &scene));
    look_aside(&scene);
    const abbe_statistics statistics = draw(&scene, &small_frame, true, NULL);
    const double expected = light_into(crowds[i].ball, crowds[i].count);
    print_message("%zu balls: %.6f of the light, imbalance %.2g\n", crowds[i].count,
                  statistics.energy.reached / expected, abbe_ledger_imbalance(&statistics.energy));
    assert_near(statistics.energy.reached, expected, 2e-3 * expected);
    assert_true(abbe_ledger_imbalance(&statistics.energy) < 1e-4);
  }
}

/* Of the same, what lies within a cone about -z of that cosine: a lattice over each ball's disk. */
static double light_into_cone(const place *ball, size_t count, double least_cosine) {
  enum { RINGS = 500, ROUND = 1000 };
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    const double whole = light_into(&ball[i], 1) / (2 * ABBE_PI);
    size_t inside = 0;
    for (int k = 0; k < RINGS * ROUND; k++) {
      const double c = 1 - whole * (k / ROUND + 0.5) / RINGS, s = sqrt(1 - c * c);
      /* The balls' middles are level with the light. */
      if (-s * sin(2 * ABBE_PI * (k % ROUND + 0.5) / ROUND) >= -least_cosine) continue;
      inside++;
    }
    sum += 2 * ABBE_PI * whole * (double)inside / (RINGS * ROUND);
  }
  return sum;
}

TEST(a_wide_spot_has_a_cube_too) {
  static const place ball[2] = {{{-0.3, 0, 0}, 0.08}, {{0.3, 0, 0}, 0.08}};
  OWNED(abbe_scene, scene);
  load_balls(ball, 2, 0, "kind: spot, direction: [0, 0, -1], cone: 85, soft: 0", &scene);
  look_aside(&scene);
  const abbe_statistics spot = draw(&scene, &small_frame, true, NULL);
  const double expected = light_into_cone(ball, 2, cos(85 * ABBE_PI / 180));
  print_message("a wide spot: %.6f of the light\n", spot.energy.reached / expected);
  assert_near(spot.energy.reached, expected, 5e-3 * expected);
}

/* A picture whose balls lie across seams is no farther from that whose balls lie on the faces' axes
 * than one whose balls lie beside them, in one face each. */
TEST(seams_are_not_seen) {
  static const place ball[2] = {{{-0.3, 0, 0}, 0.08}, {{0.3, 0, 0}, 0.08}};
  static const double turn[3] = {0, 20, 45};
  abbe_render_desc desc = small_frame;
  abbe_image picture[3] = {{0}, {0}, {0}};
  double reached[3], light[3] = {0, 0, 0}, apart[3] = {0, 0, 0};
  desc.photons = 128;
  desc.map_size = 256;
  desc.aovs = true;
  for (int i = 0; i < 3; i++) {
    abbe_scene scene;
    load_balls(ball, 2, turn[i], point, &scene);
    reached[i] = draw(&scene, &desc, true, &picture[i]).energy.reached;
    abbe_scene_free(&scene);
    const size_t pixels = picture[i].width * picture[i].height, channels = picture[i].channels;
    const size_t caustic = abbe_image_find_channel(&picture[i], "caustic.G");
    for (size_t p = 0; p < pixels; p++) {
      const double a = (double)picture[0].data[p * channels + caustic];
      const double b = (double)picture[i].data[p * channels + caustic];
      light[i] += b;
      apart[i] += (a - b) * (a - b);
    }
    apart[i] = sqrt(apart[i] * (double)pixels) / light[0];
    print_message("turned by %g degrees: caustics differ by %.4f\n", turn[i], apart[i]);
    assert_true(light[i] > 0);
    assert_near(reached[i], reached[0], 1e-3 * reached[0]);
    assert_near(light[i], light[0], 5e-3 * light[0]);
  }
  assert_true(apart[2] < 1.3 * apart[1]);
  for (int i = 0; i < 3; i++) abbe_image_free(&picture[i]);
}

/* Direct light with both balls is the less of what it is with either, whose lamp has one view. */
TEST(direct_light_is_whole) {
  static const place ball[2] = {{{-0.25, -0.25, -0.1}, 0.08}, {{0.25, 0.25, -0.1}, 0.08}};
  static const abbe_model models[] = {ABBE_MODEL_AUTO, ABBE_MODEL_BVH, ABBE_MODEL_LAYERS};
  for (int m = 0; m < (all_cases() ? 3 : 2); m++) {
    abbe_render_desc desc = small_frame;
    abbe_image one[2] = {{0}, {0}};
    size_t shaded = 0, wrong = 0;
    desc.aovs = true;
    desc.supersample = desc.adaptive = 1; /* the least of places, not of areas */
    desc.model = models[m];
    desc.width = desc.height = 128;
    abbe_scene scene;
    load_balls(ball, 2, 0, point, &scene);
    FILLED(abbe_image, both, draw(&scene, &desc, true, &both));
    abbe_scene_free(&scene);
    for (int i = 0; i < 2; i++) {
      load_balls(&ball[i], 1, 0, point, &scene);
      draw(&scene, &desc, false, &one[i]);
      abbe_scene_free(&scene);
    }
    const size_t direct = abbe_image_find_channel(&both, "direct.G");
    for (size_t i = 0; i < both.width * both.height; i++) {
      const size_t at = i * both.channels + direct;
      const double a = (double)one[0].data[at], b = (double)one[1].data[at];
      const double most = fmax(a, b), least = fmin(a, b);
      if (least < 0.5 * most) shaded++;
      if (!(fabs((double)both.data[at] - least) <= 1e-5 * most)) wrong++;
    }
    print_message("%s: %zu shaded pixels, %zu wrong\n", abbe_model_name(models[m]), shaded, wrong);
    assert_true(shaded > 500);
    /* Shadows of triangles have the rim that a view's texels give them. */
    assert_true(wrong <= (models[m] == ABBE_MODEL_AUTO ? 0 : shaded / 8));
    for (int i = 0; i < 2; i++) abbe_image_free(&one[i]);
  }
}

/* Its faces' maps, laid out as one, hold what the tracer finds there. */
TEST(the_tracer_agrees) {
  enum { SIDE = 64, BLOCK = 8, BLOCKS = SIDE / BLOCK, PASSES = 12 };
  static const abbe_model models[] = {ABBE_MODEL_AUTO, ABBE_MODEL_BVH, ABBE_MODEL_LAYERS};
  abbe_image drawn;
  abbe_map_layout layout;
  FILLED(abbe_scene, scene, load_balls(crowds[1].ball, crowds[1].count, 0, point, &scene));
  look_aside(&scene);
  static const double down[3] = {0, 0, -1}, up[3] = {0, 1, 0},
                      floor[4][3] = {{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {1, 1, 0}};
  abbe_view view; /* that no face looks through alone */
  abbe_view_look(scene.light[0].position, down, up, false, &view);
  abbe_view_fit(&view, floor, 4);
  abbe_view_pad(&view, 0.01);
  abbe_map_layout_make(&view, &layout);
  HELD(abbe_tracer, tracer) = make_tracer(&scene, &(abbe_trace_desc){.no_picture = true,
                                                                     .layout = &layout,
                                                                     .map_width = SIDE,
                                                                     .map_height = SIDE,
                                                                     .photons = 1 << 17,
                                                                     .space = ABBE_RGB_SPACE_XYZ});
  run_passes(tracer, PASSES);
  MADE(abbe_image, traced, abbe_tracer_map(tracer, &traced, &error));
  for (int m = 0; m < (all_cases() ? 3 : 2); m++) {
    abbe_render_desc desc = small_frame;
    double block[2][BLOCKS * BLOCKS] = {{0}}, light[2] = {0, 0}, apart = 0;
    desc.photons = 128;
    desc.map_size = SIDE;
    desc.map_layout = &layout;
    desc.model = models[m];
    abbe_renderer *renderer = drawn_renderer(&scene, &desc);
    drawn = map_of(renderer, 0);
    abbe_renderer_free(renderer);
    for (int k = 0; k < 2; k++) {
      const abbe_image *map = k == 0 ? &traced : &drawn;
      const size_t y = abbe_image_find_channel(map, "Y");
      for (size_t i = 0; i < SIDE * SIDE; i++) {
        const double flux = (double)map->data[i * map->channels + y];
        block[k][i / SIDE / BLOCK * BLOCKS + i % SIDE / BLOCK] += flux;
        light[k] += flux;
      }
    }
    for (int i = 0; i < BLOCKS * BLOCKS; i++) apart += fabs(block[0][i] - block[1][i]);
    print_message("%s: %.4f of the tracer's %.4f W, %.4f of it elsewhere\n",
                  abbe_model_name(models[m]), light[1] / light[0], light[0], apart / light[0]);
    assert_true(light[0] > 0.1);
    assert_near(light[1], light[0], 0.02 * light[0]);
    assert_true(apart < 0.04 * light[0]);
    abbe_image_free(&drawn);
  }
}

TEST(a_cube_has_no_single_layout) {
  abbe_image map = {0};
  FILLED(abbe_scene, scene, load_balls(crowds[0].ball, crowds[0].count, 0, point, &scene));
  look_aside(&scene);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &small_frame);
  REFUSED(ABBE_UNSUPPORTED, "'lamp' has a cube of maps",
          abbe_renderer_read_map(renderer, 0, true, &map, &error));
  REFUSED(ABBE_UNSUPPORTED, "", abbe_renderer_read_map_bands(renderer, 0, 3, &map, &error));
  /* A further face is no light of the scene. */
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_renderer_read_map(renderer, 1, true, &map, &error));
}
