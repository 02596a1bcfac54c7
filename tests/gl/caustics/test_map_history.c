/* Frames that follow one another: a still scene, a jump, slow motion. */
#include "tests/gl/frame.h"

enum { SIDE = 96, FRAMES = ABBE_RENDER_MAX_HISTORY };

/* Where photons start in frames of a sequence, parts of a cell. */
static const double places[FRAMES][2] = {
    {-0.375, 0.125}, {0.375, -0.125}, {0.125, 0.375}, {-0.125, -0.375}};

static const abbe_render_desc desc = FIELDS(.width = 16, .height = 16, .photons = 40,
                                            .map_size = SIDE, .wavelengths = 5, .history = FRAMES);

/* A brick of crown glass, so far to the right: what comes through it is a patch or a few. */
static void load_brick(double x, abbe_scene *scene) {
  const int digits = (int)lround(1e5 * x);
  *scene = scene_of(printed(
      CAMERA POINT_LIGHT FLOOR
      "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], transform: [{rotate: {axis: [0, "
      "0, 1], angle: 20}}, {translate: [0.%05d, 0, 0.2]}], material: crown}\n",
      digits));
  look_aside(scene);
}

/* Even texels around bricks up to 0.3 m to the right. */
static void lay_out(const abbe_scene *scene, abbe_map_layout *out) {
  static const double window[4] = {-0.5, 0.9, -0.5, 0.5};
  abbe_renderer *renderer = make_renderer(scene, &desc);
  abbe_renderer_map_layout(renderer, 0, out);
  abbe_renderer_free(renderer);
  memcpy(out->view.window, window, sizeof window);
  abbe_map_layout_make(&out->view, out);
}

/* A frame alone, of the sequence's number k. */
static void draw_alone(const abbe_scene *scene, const abbe_render_desc *like, size_t k,
                       abbe_image *out) {
  abbe_render_desc alone = *like;
  alone.history = 0;
  memcpy(alone.photon_shift, places[k % FRAMES], sizeof alone.photon_shift);
  make_map(scene, &alone, out);
}

/* The mean of frames first to last of the sequence. */
static void draw_mean(const abbe_scene *scene, const abbe_render_desc *like, size_t first,
                      size_t last, abbe_image *out) {
  draw_alone(scene, like, first, out);
  for (size_t k = first + 1; k <= last; k++) {
    FILLED(abbe_image, one, draw_alone(scene, like, k, &one));
    for (size_t i = 0; i < 3 * SIDE * SIDE; i++) out->data[i] += one.data[i];
  }
  for (size_t i = 0; i < 3 * SIDE * SIDE; i++) out->data[i] /= (float)(last - first + 1);
}

static double apart(const abbe_image *a, const abbe_image *b) {
  double most = 0;
  for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
    most = fmax(most, fabs((double)a->data[i] - (double)b->data[i]));
  return most / image_max(b, 1);
}

GROUP(make_context, free_context);

TEST(a_still_scene_comes_to_the_mean) {
  abbe_map_layout layout;
  OWNED(abbe_image, map) = {0}, mean = {0}, last = {0};
  FILLED(abbe_scene, scene, load_brick(0.1, &scene));
  lay_out(&scene, &layout);
  abbe_render_desc given = desc;
  given.map_layout = &layout;
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &given);
  for (size_t k = 0; k < FRAMES; k++) {
    abbe_image_free(&map);
    abbe_image_free(&mean);
    draw_frame(renderer);
    map = map_of(renderer, 0);
    draw_mean(&scene, &given, 0, k, &mean);
    assert_true(apart(&map, &mean) < 1e-6);
  }
  draw_alone(&scene, &given, 0, &last);
  assert_true(apart(&last, &mean) > 0.01); /* passes do differ */
  abbe_image_free(&last);
  /* and stays */
  const abbe_statistics s = draw_frame(renderer);
  assert_true(s.kept[ABBE_PASS_SPECTRAL_MAP] && s.kept[ABBE_PASS_PHOTONS]);
  last = map_of(renderer, 0);
  assert_same_pixels(&map, &last);
}

static abbe_statistics change_and_draw(abbe_renderer *renderer, const abbe_scene *scene,
                                       const abbe_render_desc *like, abbe_image *out) {
  OK(abbe_renderer_change(renderer, scene, like, &error));
  const abbe_statistics s = draw_frame(renderer);
  abbe_image_free(out);
  *out = map_of(renderer, 0);
  return s;
}

/* Frames that follow changes alone: what stays is drawn once, whichever way the camera turns; what
 * has moved is as with a history that goes on. */
TEST(what_stays_is_drawn_once) {
  abbe_scene scene[2] = {{0}};
  abbe_map_layout layout;
  abbe_image map[2] = {{0}};
  OWNED(abbe_image, kept) = {0};
  for (int k = 0; k < 2; k++) load_brick(0.1 + 0.01 * k, &scene[k]);
  lay_out(&scene[0], &layout);
  abbe_render_desc given = desc;
  given.map_layout = &layout;
  abbe_render_desc once = given;
  once.history_of_changes = true;
  abbe_renderer *renderer[2] = {make_renderer(&scene[0], &given), make_renderer(&scene[0], &once)};
  for (int k = 0; k < 2; k++) {
    draw_frame(renderer[k]);
    map[k] = map_of(renderer[k], 0);
  }
  assert_same_pixels(&map[0], &map[1]);
  scene[0].camera.eye[0] += 0.01;
  abbe_statistics s = change_and_draw(renderer[1], &scene[0], &once, &kept);
  assert_true(s.kept[ABBE_PASS_SPECTRAL_MAP] && s.kept[ABBE_PASS_PHOTONS]);
  assert_same_pixels(&map[1], &kept);
  for (int k = 0; k < 2; k++) {
    s = change_and_draw(renderer[k], &scene[1], k == 0 ? &given : &once, &map[k]);
    assert_false(s.kept[ABBE_PASS_PHOTONS]);
  }
  assert_same_pixels(&map[0], &map[1]);
  assert_true(apart(&map[1], &kept) > 0.01);
  for (int k = 0; k < 2; k++) {
    abbe_renderer_free(renderer[k]);
    abbe_image_free(&map[k]);
    abbe_scene_free(&scene[k]);
  }
}

/* The least and the most of a texel and the eight around it. */
static void nearby(const abbe_image *map, size_t i, double *least, double *most) {
  const int channel = (int)(i % 3), x = (int)(i / 3 % SIDE), y = (int)(i / 3 / SIDE);
  *least = INFINITY;
  *most = 0;
  for (int b = y > 0 ? y - 1 : 0; b <= y + 1 && b < SIDE; b++)
    for (int a = x > 0 ? x - 1 : 0; a <= x + 1 && a < SIDE; a++) {
      const double v = (double)map->data[3 * (b * SIDE + a) + channel];
      *least = fmin(*least, v);
      *most = fmax(*most, v);
    }
}

/* The brick jumps aside. In the first frame already no texel leaves what that frame has
 * around it, so where it is dark nothing is left; after as many frames as are kept it is the mean
 * of these. */
TEST(nothing_is_left_after_a_jump) {
  abbe_scene scene[2] = {{0}};
  abbe_map_layout layout;
  abbe_image map = {0}, alone = {0};
  for (int k = 0; k < 2; k++) load_brick(0.05 + 0.14 * k, &scene[k]);
  lay_out(&scene[0], &layout);
  abbe_render_desc given = desc;
  given.map_layout = &layout;
  abbe_renderer *renderer = make_renderer(&scene[0], &given);
  for (size_t k = 0; k < FRAMES; k++) draw_frame(renderer);
  OWNED(abbe_image, before) = map_of(renderer, 0);
  OK(abbe_renderer_change(renderer, &scene[1], &given, &error));
  for (size_t k = FRAMES; k < 2 * FRAMES; k++) {
    double was = 0, ghost = 0, off = 0;
    draw_frame(renderer);
    abbe_image_free(&map);
    abbe_image_free(&alone);
    map = map_of(renderer, 0);
    draw_mean(&scene[1], &given, FRAMES, k, &alone); /* of those since the jump */
    for (size_t i = 0; i < 3 * SIDE * SIDE; i++) {
      double least, most;
      nearby(&alone, i, &least, &most);
      const double here = (double)map.data[i];
      off += fabs(here - (double)alone.data[i]);
      if (k == FRAMES)
        assert_true(here > least * (1 - 1e-6) - 1e-12 && here < most * (1 + 1e-6) + 1e-12);
      if (most > 0) continue;
      was += (double)before.data[i];
      ghost += here;
    }
    const double all = image_sum(&alone, 0) + image_sum(&alone, 1) + image_sum(&alone, 2);
    print_message("frame %zu after a jump: %.4f of the light elsewhere than without history\n",
                  k - FRAMES + 1, 0.5 * off / all);
    assert_true(was > 0.1 * all && ghost == 0);
    assert_true(0.5 * off / all < (k + 1 < 2 * FRAMES ? 0.25 : 1e-6));
  }
  abbe_renderer_free(renderer);
  abbe_image_free(&map);
  abbe_image_free(&alone);
  for (int k = 0; k < 2; k++) abbe_scene_free(&scene[k]);
}

typedef struct motion {
  double flicker, error; /* root mean square over the mean */
} motion;

/* The lamp of the gem moves by a millimetre a frame: pictures of each frame alone and with history,
 * against those of many photons. flicker: of the change from frame to frame of what a frame is off.
 */
static void measure_motion(motion out[2]) {
  enum { STEPS = 8, WARM = 3, WIDTH = 80, MANY = 2 };
  abbe_render_desc moving[3];
  abbe_scene scene[3] = {{0}};
  abbe_renderer *renderer[3] = {NULL};
  static double last[2][WIDTH * WIDTH];
  double change[2] = {0}, off[2] = {0}, mean = 0;
  size_t count = 0;
  for (int k = 0; k < 3; k++) {
    moving[k] = (abbe_render_desc){.width = WIDTH,
                                   .height = WIDTH,
                                   .supersample = 1,
                                   .adaptive = 1,
                                   .photons = k == MANY ? 192 : 48,
                                   .map_size = k == MANY ? 512 : 256,
                                   .wavelengths = 5,
                                   .aovs = true,
                                   .history = k == MANY ? 0
                                              : k == 0  ? 1
                                                        : FRAMES};
    scene[k] = shipped_scene("gem");
  }
  for (int step = 0; step < STEPS; step++) {
    abbe_image picture[3] = {{0}};
    for (int k = 0; k < 3; k++) {
      scene[k].light[0].position[0] += 1e-3;
      if (step == 0)
        renderer[k] = make_renderer(&scene[k], &moving[k]);
      else
        OK(abbe_renderer_change(renderer[k], &scene[k], &moving[k], &error));
      draw_frame(renderer[k]);
      picture[k] = aovs_of(renderer[k]);
    }
    const size_t y = abbe_image_find_channel(&picture[0], "caustic.Y"), n = picture[0].channels;
    for (size_t i = 0; i < WIDTH * WIDTH; i++) {
      const double truth = (double)picture[MANY].data[i * n + y];
      for (int k = 0; k < 2; k++) {
        const double now = (double)picture[k].data[i * n + y] - truth;
        change[k] += step < WARM ? 0 : (now - last[k][i]) * (now - last[k][i]);
        off[k] += step < WARM ? 0 : now * now;
        last[k][i] = now;
      }
      mean += step < WARM ? 0 : truth;
      count += step >= WARM;
    }
    for (int k = 0; k < 3; k++) abbe_image_free(&picture[k]);
  }
  mean /= (double)count;
  for (int k = 0; k < 2; k++) {
    out[k].flicker = sqrt(change[k] / (double)count) / mean;
    out[k].error = sqrt(off[k] / (double)count) / mean;
  }
  for (int k = 0; k < 3; k++) {
    abbe_renderer_free(renderer[k]);
    abbe_scene_free(&scene[k]);
  }
}

TEST(what_moves_flickers_less) {
  motion moved[2];
  measure_motion(moved);
  print_message("flicker %.3f alone, %.3f with history; error %.3f, %.3f\n", moved[0].flicker,
                moved[1].flicker, moved[0].error, moved[1].error);
  assert_true(moved[1].flicker < 0.85 * moved[0].flicker);
  assert_true(moved[1].error < 1.05 * moved[0].error);
}
