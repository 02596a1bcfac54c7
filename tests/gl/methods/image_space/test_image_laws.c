/* What is known of photons in image space and of caustics mapping, in units: a flat mirror's light,
 * a mirror ball's, and frames that move or are noisy. */
#include "tests/gl/methods/image_space/floor_map.h"

/* M1 and P3. A flat mirror's light is that of the lamp's image, to its edges and no farther. */
static const double mirror_centre[3] = {0.1, 0, 0.15}, mirror_lamp[3] = {0.05, 0.03, 0.6};
#define FLAT_MIRROR                                                                                \
  CAMERA POINT_LIGHT FLOOR                                                                         \
      "- {name: mirror, shape: rectangle, width: 0.1, height: 0.1, mirror: 0.8, transform: "       \
      "[{rotate: {axis: [0, 1, 0], angle: 60}}, {translate: [0.1, 0, 0.15]}]}\n"

/* How far inside the mirror's edges the ray from the lamp's image to p passes, m; outside: below 0.
 * *light: what comes there. */
static double inside_mirror(const double p[3], double *light) {
  const double n[3] = {sin(ABBE_PI / 3), 0, 0.5}, along[3] = {0.5, 0, -sin(ABBE_PI / 3)};
  double to[3], image[3], ray[3], at[3];
  abbe_vector_subtract(mirror_lamp, mirror_centre, to);
  for (int k = 0; k < 3; k++) image[k] = mirror_lamp[k] - 2 * abbe_vector_dot(to, n) * n[k];
  abbe_vector_subtract(p, image, ray);
  abbe_vector_subtract(mirror_centre, image, to);
  const double t = abbe_vector_dot(to, n) / abbe_vector_dot(ray, n);
  for (int k = 0; k < 3; k++) at[k] = image[k] + t * ray[k] - mirror_centre[k];
  *light = 0.8 * image[2] * pow(abbe_vector_dot(ray, ray), -1.5);
  return 0.05 - fmax(fabs(abbe_vector_dot(at, along)), fabs(at[1]));
}

GROUP(make_context, free_context);

TEST(a_facets_light_has_edges) {
  static const abbe_fill fills[] = {ABBE_FILL_QUADS, ABBE_FILL_TRIANGLES};
  for (int f = 0; f < 2; f++) {
    abbe_render_desc desc = units;
    floor_map m;
    size_t within = 0, without = 0;
    double worst = 0, stray = 0, mean = 0;
    desc.fill = fills[f];
    desc.map_size = 512;
    make_floor_map(FLAT_MIRROR, &desc, &m);
    for (size_t i = 0; i < m.image.width * m.image.height; i++) {
      double at[3], area, light, known, least = INFINITY, most = -INFINITY;
      if (!texel_at(&m, i % m.image.width, i / m.image.width, at, &area, &light)) continue;
      for (int k = 0; k < 9; k++) { /* a texel and a half around */
        double near[3], ignored;
        if (!floor_at(&m, (double)(i % m.image.width) + 0.5 + 1.5 * (k % 3 - 1),
                      (double)(i / m.image.width) + 0.5 + 1.5 * (k / 3 - 1), near))
          continue;
        const double inside = inside_mirror(near, &ignored);
        least = fmin(least, inside);
        most = fmax(most, inside);
      }
      inside_mirror(at, &known);
      if (least > 0) {
        worst = fmax(worst, fabs(light / known - 1));
        mean += light / known;
        within++;
      } else if (most < 0) {
        stray = fmax(stray, light);
        without++;
      }
    }
    print_message("%s: %zu texels within, %.4f of the light, off by %.3f; outside %.2g\n",
                  abbe_fill_name(fills[f]), within, mean / (double)within, worst, stray);
    assert_true(within > 20 && without > 1000);
    assert_near(mean / (double)within, 1, 0.02);
    assert_true(worst < 0.15 && stray < 1e-3);
    abbe_image_free(&m.image);
  }
}

/* M2. A small mirror ball far away sends rho E0 R^2 / 4 into every direction. */
TEST(a_ball_shines_alike_everywhere) {
  enum { RINGS = 4 };
  static const char text[] =
      "materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
      "lights: [{name: lamp, kind: spot, position: [0, 0, 2], target: [0, 0, 0], intensity: 4, "
      "cone: 20}]\n"
      "objects:\n- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 0.5}\n"
      "- {name: ball, shape: sphere, radius: 0.02, levels: 6, mirror: 0.8, transform: [{translate: "
      "[0, 0, 0.2]}]}\n";
  const double away = 1.8, intensity = 0.8 * 4 / (away * away) * 0.02 * 0.02 / 4;
  abbe_render_desc desc = units;
  floor_map m;
  double ratio[RINGS] = {0};
  size_t count[RINGS] = {0};
  desc.photons = 2048;
  desc.map_size = 64;
  make_floor_map(text, &desc, &m);
  for (size_t i = 0; i < 64 * 64; i++) {
    double at[3], area, light;
    if (!texel_at(&m, i % 64, i / 64, at, &area, &light)) continue;
    const double r = hypot(at[0], at[1]), d2 = r * r + 0.04;
    const int ring = (int)floor((r - 0.12) / 0.08);
    if (ring < 0 || ring >= RINGS || r < 0.12) continue;
    ratio[ring] += light / (intensity * 0.2 * pow(d2, -1.5));
    count[ring]++;
  }
  for (int k = 0; k < RINGS; k++) {
    print_message("ball, ring %d: %.3f of its light, %zu texels\n", k, ratio[k] / (double)count[k],
                  count[k]);
    assert_true(count[k] > 10);
    assert_near(ratio[k] / (double)count[k], 1, 0.1);
  }
  abbe_image_free(&m.image);
}

/* A mirror `at` m off its place, seen by what it sends to the floor alone. */
static void load_moved(double at, double share, abbe_scene *out) {
  *out = scene_of(printed(
      "materials: glass.yaml\ncamera: {eye: [0.9, 0, 0.6], target: [0.34, 0, 0], fov: "
      "22}\n" POINT_LIGHT FLOOR
      "- {name: mirror, shape: rectangle, width: 0.06, height: 0.06, mirror: %.9g, transform: "
      "[{rotate: {axis: [0, 1, 0], angle: 60}}, {translate: [0.09, %.9g, 0.15]}]}\n",
      share, at));
}

/* The next frame's picture, light's middle and variance in it, in pixels across; less `dark`. */
static void moments(abbe_renderer *renderer, const abbe_image *dark, double out[2]) {
  double sum = 0, first = 0, second = 0;
  abbe_renderer_redraw(renderer);
  draw_frame(renderer);
  OWNED(abbe_image, picture) = picture_of(renderer);
  for (size_t i = 0; i < picture.width * picture.height; i++) {
    const double way = (double)(i % picture.width);
    const double light = (double)picture.data[picture.channels * i + 1] -
                         (dark != NULL ? (double)dark->data[dark->channels * i + 1] : 0);
    sum += light;
    first += light * way;
    second += light * way * way;
  }
  out[0] = first / sum;
  out[1] = second / sum - out[0] * out[0];
}

/* T3. Of v pixels a frame, four frames lag by 1.5 v and spread by 1.25 v^2 more. */
TEST(motion_lags) {
  enum { FRAMES = 8 };
  abbe_render_desc desc = units;
  abbe_scene scene[FRAMES], dark[FRAMES];
  double own[FRAMES][2], kept[FRAMES][2];
  abbe_image black[FRAMES];
  desc.width = desc.height = 128;
  desc.supersample = desc.upsample = 1;
  desc.photons = 1400;
  desc.wavelengths = 1;
  desc.fill = ABBE_FILL_GATHER_EYE;
  for (int pass = 0; pass < 2; pass++) {
    HELD(abbe_renderer, renderer) = NULL;
    desc.history = pass == 0 ? 1 : 4;
    for (int k = 0; k < FRAMES; k++) {
      if (pass == 0) {
        load_moved(0.003 * k - 0.01, 0, &dark[k]);
        load_moved(0.003 * k - 0.01, 0.8, &scene[k]);
        abbe_render_desc few = desc; /* a mirror that mirrors nothing sends no light */
        few.photons = 8;
        HELD(abbe_renderer, other) = drawn_renderer(&dark[k], &few);
        black[k] = picture_of(other);
      }
      if (renderer == NULL)
        renderer = make_renderer(&scene[k], &desc);
      else
        OK(abbe_renderer_change(renderer, &scene[k], &desc, &error));
      moments(renderer, &black[k], pass == 0 ? own[k] : kept[k]);
    }
  }
  double lag = 0, more = 0, v = (own[FRAMES - 1][0] - own[1][0]) / (FRAMES - 2);
  for (int k = 4; k < FRAMES; k++) {
    double spread = 0;
    for (int i = 0; i < 4; i++) spread += own[k - i][1] / 4;
    lag += (own[k][0] - kept[k][0]) / (FRAMES - 4);
    more += (kept[k][1] - spread) / (FRAMES - 4);
  }
  print_message("%.3f pixels a frame: lag %.3f of them, variance %.3f of their square\n", v,
                lag / v, more / (v * v));
  assert_true(fabs(v) > 1);
  assert_near(lag / v, 1.5, 0.1);
  assert_near(more / (v * v), 1.25, 0.15);
  for (int k = 0; k < FRAMES; k++) {
    abbe_scene_free(&scene[k]);
    abbe_scene_free(&dark[k]);
    abbe_image_free(&black[k]);
  }
}

/* Mean over texels of the variance over frames whose grids lie anywhere. */
static double noise(const abbe_scene *scene, size_t history) {
  enum { SAMPLES = 24, SIDE = 96 };
  static double sum[2 * SIDE * SIDE];
  double variance = 0;
  unsigned seed = 12345;
  abbe_render_desc desc = units;
  HELD(abbe_renderer, renderer) = NULL;
  memset(sum, 0, sizeof sum);
  desc.photons = 96;
  desc.map_size = SIDE;
  desc.history = history;
  for (size_t k = 0; k < (SAMPLES + 1) * history; k++) {
    for (int axis = 0; axis < 2; axis++) {
      seed = seed * 1664525u + 1013904223u;
      desc.photon_shift[axis] = (double)(seed >> 8) / 0x1p24 - 0.5;
    }
    if (renderer == NULL)
      renderer = make_renderer(scene, &desc);
    else
      OK(abbe_renderer_change(renderer, scene, &desc, &error));
    draw_frame(renderer);
    if (k < history || k % history != history - 1) continue;
    OWNED(abbe_image, map) = map_of(renderer, 0);
    for (size_t i = 0; i < SIDE * SIDE; i++) {
      const double light = (double)map.data[map.channels * i + 1];
      sum[2 * i] += light / SAMPLES;
      sum[2 * i + 1] += light * light / SAMPLES;
    }
  }
  for (size_t i = 0; i < SIDE * SIDE; i++) variance += sum[2 * i + 1] - sum[2 * i] * sum[2 * i];
  return variance / (SIDE * SIDE);
}

/* T4. Frames whose noise is independent leave a quarter of its variance. */
TEST(noise_goes_by_four) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  const double one = noise(&scene, 1), four = noise(&scene, 4);
  print_message("variance of four frames: %.3f of one's\n", four / one);
  assert_near(four / one, 0.25, 0.07);
}
