/* The renderer's frames against light that is known in closed form: a ring's caustics, images
 * between mirrors, penumbras, a lamp's image through a hole and in a mirror. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "validation/lab/known/forms/closed_form.h"

static const abbe_render_desc tiny =
    FIELDS(.width = 16, .height = 16, .photons = 256, .map_size = 512, .space = ABBE_RGB_SPACE_XYZ,
           .aovs = true);

static void draw(const char *text, const abbe_render_desc *desc, abbe_image *aovs) {
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = make_renderer(&scene, desc);
  const abbe_statistics statistics = draw_frame(renderer);
  assert_true(statistics.energy.reached == 0 || abbe_ledger_imbalance(&statistics.energy) < 1e-4);
  *aovs = aovs_of(renderer);
}

static double drawn_mean(const char *text, const abbe_render_desc *desc, const char *channel) {
  FILLED(abbe_image, aovs, draw(text, desc, &aovs));
  return channel_mean(&aovs, channel);
}

/* ---- the ring ---- */

typedef struct place {
  double height, elevation, lamp[3]; /* radii, degrees */
  double at[2], half;                /* radii */
  size_t branches;
} place;

/* Of a ring of radius 0.05 that reflects 0.9: caustic seen at the place, over what is known. */
static double ring_light(const place *p) {
  const double r = 0.05, e = p->elevation * ABBE_PI / 180, away = 20 * r;
  const double at[2] = {r * p->at[0], r * p->at[1]}, half = r * p->half;
  abbe_catacaustic c = {.radius = r, .height = r * p->height, .elevation = e};
  for (int k = 0; k < 3; k++) c.lamp[k] = r * p->lamp[k];
  char light[200];
  if (e > 0)
    snprintf(light, sizeof light, "kind: directional, direction: [%.9g, 0, %.9g], irradiance: 1",
             cos(e), -sin(e));
  else
    snprintf(light, sizeof light, "kind: point, position: [%.9g, %.9g, %.9g], intensity: 1",
             c.lamp[0], c.lamp[1], c.lamp[2]);
  const char *text = printed(
      "materials: default\ncamera: {eye: [%.9g, %.9g, %.9g], target: [%.9g, %.9g, 0], up: [0, "
      "1, 0], fov: %.9g}\nlights: [{name: lamp, %s}]\nobjects:\n"
      "- {name: floor, shape: rectangle, width: 1, height: 1, reflectance: 1}\n"
      "- {name: ring, shape: lathe, around: 1024, profile: [[%.9g, 0], [%.9g, %.9g]], mirror: "
      "0.9}\n",
      at[0], at[1], away, at[0], at[1], 2 * atan(half / away) * 180 / ABBE_PI, light, r, r,
      c.height);
  size_t branches;
  const double known = abbe_catacaustic_mean(&c, at, half, 12, 0.9, 3, &branches) / ABBE_PI;
  assert_int_equal(branches, p->branches);
  abbe_render_desc desc = tiny;
  desc.photons = 512;
  desc.map_size = 1024;
  return drawn_mean(text, &desc, "caustic.Y") / known;
}

GROUP(make_context, free_context);

TEST(a_ring_throws_its_caustics) {
  static const place places[] = {
      {1, 45, {0}, {0.2, 0}, 0.1, 1},           /* before the nephroid's cusp */
      {1, 45, {0}, {0.75, 0}, 0.07, 3},         /* within the nephroid */
      {3, 45, {0}, {-0.6, 0.1}, 0.1, 4},        /* and by two reflections */
      {2, 0, {0.95, 0, 4}, {0, 0.05}, 0.1, 1},  /* before the cardioid's cusp */
      {2, 0, {0.95, 0, 4}, {-0.6, 0}, 0.07, 3}, /* within the cardioid */
  };
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    const double seen = ring_light(&places[i]);
    print_message("place %zu of the ring: %.4f of its light\n", i, seen);
    assert_near(seen, 1, 0.02);
  }
}

/* ---- two mirrors ---- */

#define TWO_MIRRORS                                                                                \
  "- {name: left, shape: rectangle, width: 8, height: 8, mirror: 0.8, transform: [{rotate: "       \
  "{axis: [0, 1, 0], angle: 90}}, {translate: [-0.5, 0, 3.9]}]}\n"                                 \
  "- {name: right, shape: rectangle, width: 8, height: 8, mirror: 0.8, transform: [{rotate: "      \
  "{axis: [0, 1, 0], angle: 90}}, {translate: [0.5, 0, 3.9]}]}\n"

/* As the images of the lamp shine, the k-th by 0.8^k. */
TEST(a_lamp_shines_by_its_images) {
  enum { STEPS = 20 };
  double known = 0;
  for (int k = 1; k < 40; k++)
    for (int i = 0; i < 2 * STEPS * STEPS; i++) {
      const double x = (i % 2 ? k : -k) + (k % 2 ? -0.1 : 0.1) + 0.15;
      const double a = x - 0.3 * ((2 * (i / 2 % STEPS) + 1.0) / STEPS - 1);
      const double b = 0.3 * ((2 * (i / 2 / STEPS) + 1.0) / STEPS - 1);
      known += pow(0.8, k) * 0.5 * pow(0.25 + a * a + b * b, -1.5) / (ABBE_PI * STEPS * STEPS);
    }
  abbe_render_desc desc = tiny;
  desc.energy_share = 1e-3;
  desc.exits = ABBE_RENDER_MAX_EXITS;
  const double seen = drawn_mean(
      "materials: default\ncamera: {eye: [-0.15, 0, 2], target: [-0.15, 0, 0], up: [0, 1, 0], fov: "
      "17.061}\nlights: [{name: lamp, kind: point, position: [0.1, 0, 0.5], intensity: 1}]\n"
      "objects:\n- {name: floor, shape: rectangle, width: 20, height: 20, reflectance: "
      "1}\n" TWO_MIRRORS,
      &desc, "caustic.Y");
  print_message("%.4f of the images' light\n", seen / known);
  assert_near(seen / known, 1, 0.02);
}

TEST(the_eye_sees_by_four_reflections) {
  assert_near(drawn_mean("materials: default\ncamera: {eye: [0.25, 0, 0], target: [0.75, 0, -0.5], "
                         "fov: 1}\nenvironment: {size: 64, uniform: 2}\nobjects:\n"
                         "- {name: mote, shape: rectangle, width: 0.001, height: 0.001, "
                         "reflectance: 1, transform: [{translate: [9, 9, 9]}]}\n"
                         "- {name: below, shape: rectangle, width: 4, height: 4, mirror: 0.8, "
                         "transform: [{translate: [2, 0, -0.5]}]}\n"
                         "- {name: above, shape: rectangle, width: 4, height: 4, mirror: 0.8, "
                         "transform: [{translate: [2, 0, 0.5]}]}\n",
                         &tiny, "Y"),
              2 * 0.4096, 2e-3);
}

/* ---- lights with a size ---- */

#define WHITE_FLOOR                                                                                \
  "objects:\n- {name: floor, shape: rectangle, width: 9, height: 9, reflectance: 1}\n"

/* What an edge half way down leaves of the light, in as many steps as it has points. */
static void check_penumbra(const char *light, bool disk, size_t points) {
  const double half = 0.02, area = disk ? ABBE_PI * half * half : 4 * half * half;
  abbe_render_desc desc = tiny;
  desc.light_points = points;
  double worst = 0;
  for (int i = -6; i <= 6; i++) {
    const double at = 0.2 * i,
                 share = disk ? abbe_closed_form_penumbra(at) : fmax(0, fmin(1, 0.5 * (1 + at)));
    const double seen =
        drawn_mean(
            printed(
                "materials: default\ncamera: {eye: [%.9g, 0, 0.1], target: [%.9g, 0, 0], up: [0, "
                "1, "
                "0], fov: 0.1}\nlights: [{name: lamp, kind: %s, position: [0, 0, 2], direction: "
                "[0, "
                "0, -1], radiance: 1000}]\n" WHITE_FLOOR
                "- {name: jaw, shape: rectangle, width: 1, height: 1, reflectance: 0, transform: "
                "[{translate: [-0.5, 0, 1]}]}\n",
                at * half, at * half, light),
            &desc, "direct.Y") /
        (1000 * area / (4 * ABBE_PI));
    worst = fmax(worst, fabs(seen - share));
    if (fabs(at) > 1) assert_near(seen, share, 1e-3);
  }
  print_message("%zu points: penumbra off by %.3f at the most\n", points, worst);
  assert_true(worst < (disk ? 1.5 : 2.5) / (double)points);
}

TEST(a_penumbra_has_its_width) {
  if (all_cases()) check_penumbra("disk, radius: 0.02", true, 8);
  check_penumbra("disk, radius: 0.02", true, 16);
  check_penumbra("rectangle, width: 0.04, height: 0.04", false, 16);
}

TEST(floors_have_their_form_factors) {
  static const double p[3] = {0, 0, 0}, up[3] = {0, 0, 1};
  static const double corner[4][3] = {
      {0.05, -0.1, 0.4}, {0.35, -0.1, 0.4}, {0.35, 0.1, 0.4}, {0.05, 0.1, 0.4}};
  abbe_render_desc desc = tiny;
  desc.light_points = 16;
#define SMALL_VIEW                                                                                 \
  "materials: default\ncamera: {eye: [0.05, 0, 0.1], target: [0, 0, 0], fov: 0.1}\n"
  assert_near(drawn_mean(SMALL_VIEW
                         "lights: [{name: lamp, kind: disk, position: [0, 0, 0.4], direction: [0, "
                         "0, -1], radius: 0.3, radiance: 5}]\n" WHITE_FLOOR,
                         &desc, "direct.Y") /
                  (5 * abbe_closed_form_coaxial_disks(0, 0.3, 0.4)),
              1, 0.02);
  assert_near(
      drawn_mean(SMALL_VIEW
                 "lights: [{name: lamp, kind: rectangle, position: [0.2, 0, 0.4], direction: [0, "
                 "0, -1], width: 0.3, height: 0.2, radiance: 5}]\n" WHITE_FLOOR,
                 &desc, "direct.Y") /
          (5 * abbe_closed_form_polygon(corner, 4, p, up)),
      1, 0.02);
}

/* The eye sees the disk itself in a mirror, as far behind it as it is before it. */
TEST(a_mirror_shows_the_disk) {
  const double away = hypot(0.6, 1.2), film = pow(2 * tan(2.5 * ABBE_PI / 180), 2);
  const double known = 0.8 * 7 * ABBE_PI * 0.02 * 0.02 * 1.2 / (away * away * away) / film;
  abbe_render_desc desc = tiny;
  desc.width = desc.height = 64;
  desc.supersample = 4;
  const double seen = drawn_mean(
      "materials: default\ncamera: {eye: [-0.3, 0, 0.7], target: [0.3, 0, -0.5], fov: 5}\n"
      "lights: [{name: lamp, kind: disk, position: [0.3, 0, 0.5], direction: [0, 0, -1], radius: "
      "0.02, radiance: 7}]\nobjects:\n- {name: pane, shape: rectangle, width: 1, height: 1, "
      "mirror: 0.8}\n- {name: mote, shape: rectangle, width: 0.001, height: 0.001, reflectance: 1, "
      "transform: [{translate: [9, 9, 9]}]}\n",
      &desc, "Y");
  assert_near(seen / known, 1, 5e-3);
}

/* Through a hole and off a mirror onto a wall: its points' images have the disk's light, and lie as
 * widely. */
TEST(a_hole_throws_the_disks_image) {
  enum { SIDE = 96 };
  const double r = 0.02, s = 0.004, half = 0.03;
  const double known = 0.8 * 1e4 * ABBE_PI * r * r * s * s / (ABBE_PI * 4 * half * half);
  const double square = r * r / 2 + 2 * pow(2 * s, 2) / 12;
  abbe_render_desc desc = tiny;
  desc.width = desc.height = SIDE;
  desc.light_points = 15;
  OWNED(abbe_image, aovs);
  draw("materials: default\ncamera: {eye: [0.2, 0, -0.5], target: [0.5, 0, -0.5], fov: 11.4212}\n"
       "lights: [{name: lamp, kind: disk, position: [0, 0, 1], direction: [0, 0, -1], radius: "
       "0.02, radiance: 1e4}]\nobjects:\n"
       "- {name: wall, shape: rectangle, width: 1, height: 1, reflectance: 1, transform: [{rotate: "
       "{axis: [0, 1, 0], angle: 90}}, {translate: [0.5, 0, -0.5]}]}\n"
       "- {name: mirror, shape: rectangle, width: 0.06, height: 0.06, mirror: 0.8, transform: "
       "[{rotate: {axis: [0, 1, 0], angle: 45}}, {translate: [0, 0, -0.5]}]}\n"
       "- {name: west, shape: rectangle, width: 1, height: 2, reflectance: 0, transform: "
       "[{translate: [-0.502, 0, 0]}]}\n"
       "- {name: east, shape: rectangle, width: 1, height: 2, reflectance: 0, transform: "
       "[{translate: [0.502, 0, 0]}]}\n"
       "- {name: south, shape: rectangle, width: 0.01, height: 1, reflectance: 0, transform: "
       "[{translate: [0, -0.502, 0]}]}\n"
       "- {name: north, shape: rectangle, width: 0.01, height: 1, reflectance: 0, transform: "
       "[{translate: [0, 0.502, 0]}]}\n",
       &desc, &aovs);
  const size_t at = abbe_image_find_channel(&aovs, "caustic.Y");
  double sum = 0, moment = 0;
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    const double x = half * ((2 * (double)(i % SIDE) + 1) / SIDE - 1);
    const double y = half * ((2 * (double)(i / SIDE) + 1) / SIDE - 1);
    const double light = (double)aovs.data[i * aovs.channels + at];
    sum += light;
    moment += light * (x * x + y * y);
  }
  print_message("%.4f of the light, %.4f of its mean square\n", sum / (SIDE * SIDE) / known,
                moment / sum / square);
  assert_near(sum / (SIDE * SIDE) / known, 1, 0.03);
  assert_near(moment / sum / square, 1, 0.05);
}
