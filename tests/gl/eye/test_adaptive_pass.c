/* More rays where a receiver's light bends: against areas known in closed form, and many samples.
 */
#include "tests/gl/frame.h"

#include "gl/renderer_state.h"

enum { SIDE = 48 };

/* From straight above: half the height of what is seen at z = 0 is 0.5 m. */
#define FROM_ABOVE                                                                                 \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], fov: 53.13010235415598}\n"           \
  "ambient: 1\nbackground: 0.1\n"
#define TURN "transform: [{rotate: {axis: [0, 0, 1], angle: 20}}], reflectance: 0.5}\n"
#define TURNED_SQUARE "objects:\n- {name: tile, shape: rectangle, width: 0.5, height: 0.5, " TURN
#define SUN_ABOVE                                                                                  \
  "lights:\n- {name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}\n"
/* A light with a hard edge, straight and slanting. */
#define SHARP_SPOT                                                                                 \
  "lights:\n- {name: lamp, kind: spot, position: [0.1, 0.2, 0.6], target: [0, 0, 0], "             \
  "intensity: 1, cone: 25, soft: 0}\n"

static const abbe_render_desc plain = {
    .width = SIDE, .height = SIDE, .photons = 64, .map_size = 256, .supersample = 1, .aovs = true};

/* Draws the scene with so many rays a side, or as the mean of 4 x 4 samples: 0; samples that were
 * listed. */
static size_t draw(const abbe_scene *scene, size_t adaptive, abbe_image *out) {
  abbe_render_desc desc = plain;
  desc.adaptive = adaptive > 0 ? adaptive : 1;
  desc.supersample = adaptive > 0 ? 1 : 4;
  HELD(abbe_renderer, renderer) = make_renderer(scene, &desc);
  const abbe_statistics statistics = draw_frame(renderer);
  assert_true(abbe_statistics_ran(&statistics, ABBE_PASS_EYE_ADAPTIVE) == (adaptive > 1));
  *out = aovs_of(renderer);
  return adaptive > 1 ? abbe_gpu_read_count(&renderer->gpu, renderer->adaptive.samples) : 0;
}

/* What is left of a polygon on the side of a line where n . p <= w. */
static size_t cut(const double from[][2], size_t count, const double n[2], double w,
                  double to[][2]) {
  size_t kept = 0;
  for (size_t i = 0; i < count; i++) {
    const double *a = from[i], *b = from[(i + 1) % count];
    const double over_a = n[0] * a[0] + n[1] * a[1] - w, over_b = n[0] * b[0] + n[1] * b[1] - w;
    if (over_a <= 0) memcpy(to[kept++], a, sizeof *to);
    if ((over_a <= 0) == (over_b <= 0)) continue;
    const double t = over_a / (over_a - over_b);
    for (int k = 0; k < 2; k++) to[kept][k] = a[k] + t * (b[k] - a[k]);
    kept++;
  }
  return kept;
}

/* The share of a pixel that shows the turned square. */
static double coverage(size_t x, size_t y) {
  const double pixel = 1.0 / SIDE, left = (double)x * pixel - 0.5, top = 0.5 - (double)y * pixel;
  const double turn = 20 * acos(-1) / 180;
  double polygon[2][12][2] = {
      {{left, top - pixel}, {left + pixel, top - pixel}, {left + pixel, top}, {left, top}}};
  size_t count = 4;
  for (int k = 0; k < 4; k++) {
    const double n[2] = {cos(turn + k * acos(0)), sin(turn + k * acos(0))};
    count = cut((const double(*)[2])polygon[k % 2], count, n, 0.25, polygon[1 - k % 2]);
  }
  double twice = 0;
  for (size_t i = 0; i < count; i++) {
    const double *a = polygon[0][i], *b = polygon[0][(i + 1) % count];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice / (pixel * pixel);
}

/* Mean and greatest error of the square's share of pixels that show its edge. */
static void measure_edge(const abbe_image *image, double *mean, double *worst) {
  const double inside = 0.5 / acos(-1), outside = 0.1;
  size_t count = 0;
  *mean = *worst = 0;
  for (size_t y = 0; y < SIDE; y++)
    for (size_t x = 0; x < SIDE; x++) {
      const double share = coverage(x, y);
      const double seen = (double)image->data[(y * SIDE + x) * image->channels + 1];
      const double error = fabs((seen - outside) / (inside - outside) - share);
      if (share < 1e-6 || share > 1 - 1e-6) assert_near(error, 0, 1e-4);
      if (share < 1e-6 || share > 1 - 1e-6) continue;
      *mean += error;
      *worst = fmax(*worst, error);
      count++;
    }
  assert_true(count > SIDE);
  *mean /= (double)count;
}

GROUP(make_context, free_context);

/* Of a pixel at an edge the mean is that of what it covers, as near as so many rays can tell. */
TEST(an_edge_is_covered) {
  double mean[3], worst[3];
  OWNED(abbe_scene, scene) = scene_of(FROM_ABOVE SUN_ABOVE TURNED_SQUARE);
  scene.light[0].power = 1e-6; /* ambient light is what it shows */
  for (size_t i = 0; i < 3; i++) {
    const size_t rays[] = {1, 2, 8};
    OWNED(abbe_image, image) = {0};
    const size_t listed = draw(&scene, rays[i], &image);
    measure_edge(&image, &mean[i], &worst[i]);
    print_message("%zu rays a side: coverage off by %.3f, %.3f at the most; %zu listed\n", rays[i],
                  mean[i], worst[i], listed);
  }
  assert_true(worst[0] > 0.4);
  assert_true(worst[2] < 0.5 / 8 && mean[2] < 0.02);
  assert_true(mean[1] < 0.6 * mean[0] && mean[2] < 0.4 * mean[1]);
}

/* What is alike all over asks for nothing, and stays to the bit. */
TEST(flat_light_is_left_alone) {
  OWNED(abbe_image, more) = {0};
  OWNED(abbe_scene, scene) = scene_of(FROM_ABOVE SUN_ABOVE FLOOR);
  FILLED(abbe_image, once, draw(&scene, 1, &once));
  assert_int_equal(draw(&scene, 4, &more), 0);
  assert_same_pixels(&once, &more);
}

/* Squares of the differences of two pictures from a finer one, summed. */
static void measure_squares(const abbe_image *a, const abbe_image *b, const abbe_image *fine,
                            size_t channel, double sum[2]) {
  sum[0] = sum[1] = 0;
  for (size_t i = channel; i < SIDE * SIDE * fine->channels; i += fine->channels) {
    sum[0] += pow((double)a->data[i] - (double)fine->data[i], 2);
    sum[1] += pow((double)b->data[i] - (double)fine->data[i], 2);
  }
}

/* The picture and what it is made of come nearer to those of 16 samples a pixel; the parts are
 * still the whole. */
static void assert_nearer(const char *text, double most_left) {
  OWNED(abbe_image, once) = {0}, more = {0}, fine = {0};
  OWNED(abbe_scene, scene) = scene_of(text);
  scene.ambient = scene.background = 0;
  draw(&scene, 0, &fine);
  draw(&scene, 1, &once);
  const size_t listed = draw(&scene, 4, &more);
  print_message("%zu of %d samples listed;", listed, SIDE * SIDE);
  assert_true(listed > 0 && listed < SIDE * SIDE / 3);
  static const size_t of[] = {1, 5, 8}; /* green: all, direct, caustic */
  for (size_t k = 0; k < 3; k++) {
    double squares[2];
    measure_squares(&once, &more, &fine, of[k], squares);
    assert_true(squares[1] <= most_left * squares[0]);
    if (squares[0] > 0) print_message(" %.3f of the squares left", squares[1] / squares[0]);
  }
  print_message("\n");
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    const float *p = more.data + i * more.channels;
    const bool receiver = fine.data[i * fine.channels + 5] > 0 && p[5] + p[8] > 0;
    if (receiver && scene.object_count == 1)
      assert_near((double)p[1], (double)(p[5] + p[8]), 1e-5 * (double)p[1]);
  }
}

TEST(pictures_come_nearer_to_many_samples) {
  assert_nearer(FROM_ABOVE SHARP_SPOT FLOOR, 0.05);
  assert_nearer(CAMERA POINT_LIGHT FLOOR BALL("crown"), 0.2);
  /* triangles, and what hides them from light */
  assert_nearer(FROM_ABOVE SHARP_SPOT FLOOR
                "- {name: hill, shape: sphere, radius: 0.1, levels: 3, transform: [{translate: "
                "[0.1, 0, 0]}], reflectance: 0.5}\n",
                0.05);
}

/* Whether a pixel's middle shows the ball, or is so near to its rim that this is not sure. */
static bool shows_ball(const abbe_scene *scene, size_t x, size_t y) {
  abbe_view view;
  double forward[3], from[3], d[3], along = 0, square = 0, length = 0;
  const double half = tan(0.5 * scene->camera.fov_y_rad) * 2 / SIDE, middle = 0.5 * (SIDE - 1);
  const double right = half * ((double)x - middle), up = half * (middle - (double)y);
  for (int k = 0; k < 3; k++) forward[k] = scene->camera.target[k] - scene->camera.eye[k];
  abbe_view_look(scene->camera.eye, forward, scene->camera.up, false, &view);
  for (int k = 0; k < 3; k++) {
    d[k] = view.forward[k] + right * view.right[k] + up * view.up[k];
    from[k] = scene->object[1].exact.centre[k] - scene->camera.eye[k];
    along += d[k] * from[k];
    square += from[k] * from[k];
    length += d[k] * d[k];
  }
  return sqrt(square - along * along / length) < 0.98 * scene->object[1].exact.radius;
}

/* What lies behind a refractor is none of a ray's that is spread over a sample beside it. */
TEST(samples_beside_a_refractor_stay) {
  size_t beside = 0, changed = 0;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  scene.background = 1; /* the floor ends behind it */
  scene.camera.eye[2] = 0.25;
  FILLED(abbe_image, once, draw(&scene, 1, &once));
  FILLED(abbe_image, more, draw(&scene, 4, &more));
  for (size_t y = 1; y + 1 < SIDE; y++)
    for (size_t x = 1; x + 1 < SIDE; x++) {
      bool near = false;
      for (size_t k = 0; k < 9; k++)
        near = shows_ball(&scene, x + k % 3 - 1, y + k / 3 - 1) || near;
      const size_t at = (y * SIDE + x) * once.channels;
      const bool same = memcmp(once.data + at, more.data + at, 3 * sizeof *once.data) == 0;
      assert_true(same || !near);
      beside += near && !shows_ball(&scene, x, y);
      changed += !same;
    }
  print_message("%zu samples beside it, %zu changed elsewhere\n", beside, changed);
  assert_true(beside > 10 && changed > 10);
}
