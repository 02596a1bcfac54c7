/* Lights with a size in pictures: what they light in closed form, and that they are opaque, black
 * behind, wherever light comes from and whatever shows them, to renderer and tracer alike. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "tests/validation/trace_scene.h"

/* Mean Y of the picture, as the renderer draws it. */
static double drawn(const char *text) {
  const abbe_render_desc desc =
      FIELDS(.width = 8, .height = 8, .supersample = 1, .photons = 128, .map_size = 128,
             .light_points = 4, .space = ABBE_RGB_SPACE_XYZ);
  FILLED(abbe_image, picture, draw_text(text, &desc, &picture));
  return channel_mean(&picture, "Y");
}

static double traced(const char *text) {
  const abbe_trace_desc desc = FIELDS(.width = 8, .height = 8, .no_map = true, .photons = 1 << 14,
                                      .threads = 1, .space = ABBE_RGB_SPACE_XYZ);
  OWNED(abbe_scene, scene) = scene_of(text);
  OWNED(abbe_image, picture) = traced_picture(&scene, &desc, 8);
  const double seen = channel_mean(&picture, "Y");
  return seen;
}

/* ---- what they light ---- */

typedef struct lit {
  double width, height; /* of a rectangle; a disk: its radius, 0 */
  double above, aside;  /* of its middle over the floor, m, and along x from what is seen */
  bool wall;            /* what is seen faces +x */
} lit;

/* Of unit radiance on what is seen, over pi: by so many even parts of the light a side. */
static double irradiance(const lit *l) {
  enum { PARTS = 600 };
  const double across = l->height > 0 ? l->width : 2 * l->width;
  const double along = l->height > 0 ? l->height : 2 * l->width;
  double sum = 0;
  for (int i = 0; i < PARTS * PARTS; i++) {
    const double u = (i % PARTS + 0.5) / PARTS - 0.5, v = (i / PARTS + 0.5) / PARTS - 0.5;
    const double x = l->aside + across * u, y = along * v;
    const double square = x * x + y * y + l->above * l->above;
    if (l->height == 0 && u * u + v * v > 0.25) continue;
    sum += fmax(l->wall ? x : l->above, 0) * l->above / (square * square);
  }
  return sum * across * along / ((double)PARTS * PARTS * ABBE_PI);
}

static double lit_by_points(const lit *l) {
  const char *size =
      printed(l->height > 0 ? "kind: rectangle, width: %g, height: %g" : "kind: disk, radius: %g",
              l->width, l->height);
  return drawn(printed(
      "materials: glass.yaml\n"
      "camera: {eye: [%.9g, 0, %.9g], target: [0, 0, 0], up: [0, 1, 0], fov: 0.1}\n"
      "lights: [{name: panel, %s, position: [%.9g, 0, %.9g], direction: [0, 0, -1], radiance: "
      "1}]\nobjects:\n- {name: floor, shape: rectangle, width: 9, height: 9, reflectance: 1, "
      "transform: [{rotate: {axis: [0, 1, 0], angle: %d}}]}\n",
      l->wall ? 0.4 * l->above : 0.1 * l->above, l->wall ? 0.1 * l->above : 0.4 * l->above, size,
      l->aside, l->above, l->wall ? 90 : 0));
}

GROUP(make_context, free_context);

TEST(they_light_by_closed_forms) {
  static const lit places[] = {
      {1.6, 1.6, 0.5, 0, false},   {1.6, 1.6, 0.1, 0, false},  {1.6, 1.6, 3, 0, false},
      {1.6, 1.6, 0.5, 1.1, false}, {2, 0.05, 0.1, 0.3, false}, {0.8, 0, 0.5, 0, false},
      {0.8, 0, 0.1, 0.5, false},   {0.8, 0, 0.5, 1.2, false},  {0.8, 0, 30, 2, false},
      {1.6, 1.6, 0.5, 1.1, true},  {1.6, 1.6, 0.3, 0.2, true}, {1.6, 1.6, 0.3, -0.7, true},
      {0.8, 0, 0.3, 0.2, true},    {0.8, 0, 0.3, -0.7, true},  {0.8, 0, 0.3, 0.81, true},
  };
  for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
    const double known = irradiance(&places[i]), seen = lit_by_points(&places[i]);
    print_message("place %zu: %.5f of %.5f\n", i, seen, known);
    assert_near(seen / known, 1, 2e-3);
  }
}

/* ---- soft shadows of convex solids and balls ---- */

enum { STRIP = 64 };

#define A_DISK                                                                                     \
  "lights: [{name: disk, kind: disk, position: [0, 0, 0.6], direction: [0, 0, -1], radius: 0.1, "  \
  "radiance: 1}]\n"
#define A_SOFTBOX "environment: {softboxes: [{elevation: 90, radius: 8, radiance: 9}]}\n"
#define A_SLAB                                                                                     \
  "- {name: slab, shape: box, size: [1, 1, 0.001], material: flat, transform: [{translate: "       \
  "[-0.5, 0, 0.2]}]}\n"
#define A_BALL                                                                                     \
  "- {name: ball, shape: sphere, radius: 0.035, material: flat, transform: [{translate: [0, 0, "   \
  "0.2]}]}\n"

/* Direct light along x on the floor, 0.06 m to both sides. */
static void draw_strip(const char *light, const char *object, double out[STRIP]) {
  const abbe_render_desc desc = {.width = STRIP,
                                 .height = STRIP,
                                 .supersample = 1,
                                 .photons = 16,
                                 .map_size = 64,
                                 .aovs = true};
  OWNED(abbe_scene, scene) = scene_of(
      printed("materials: glass.yaml\n"
              "camera: {eye: [0, -0.16, 0.12], target: [0, 0, 0], up: [0, 0, 1], fov: %.9g}\n"
              "%sobjects:\n- {name: floor, shape: rectangle, width: 3, height: 3, "
              "reflectance: 1}\n%s",
              2 * atan(0.06 / 0.2) * 180 / ABBE_PI, light, object));
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  OWNED(abbe_image, picture) = aovs_of(renderer);
  const size_t channel = abbe_image_find_channel(&picture, "direct.G");
  for (size_t i = 0; i < STRIP; i++)
    out[i] = (double)picture.data[(STRIP * STRIP / 2 + i) * picture.channels + channel];
}

/* The share of the light on the floor at x that a slab leaves, which reaches to x = 0 at 0.2 m, or
 * a ball there. The disk of 0.1 m lies at 0.6 m; a softbox's is as far as places differ little. */
static double left_of(bool far, bool ball, double x) {
  enum { PARTS = 400 };
  double seen = 0, all = 0;
  const double r = far ? tan(8 * ABBE_PI / 180) : 0.1 / 0.6;
  for (int i = 0; i < PARTS * PARTS; i++) {
    const double u = r * (2 * (i % PARTS + 0.5) / PARTS - 1);
    const double v = r * (2 * (i / PARTS + 0.5) / PARTS - 1);
    if (u * u + v * v > r * r) continue;
    const double d[3] = {far ? u : u - x / 0.6, v, 1}, length = abbe_vector_length(d);
    const double along = (0.2 - x * d[0]) / length; /* to beside the ball's middle */
    const double off = sqrt(fmax(x * x + 0.04 - along * along, 0));
    all += pow(length, -4);
    if (ball ? off > 0.035 : x + 0.2 * d[0] > 0) seen += pow(length, -4);
  }
  return seen / all;
}

TEST(convex_solids_and_balls_shade_them_softly) {
  static const struct {
    bool far, ball;
    double worst, mean, step;
  } row[] = {
      {false, false, 0.07, 0.02, 0.03}, /* eight points have their middle 4 % of the radius aside */
      {true, false, 0.03, 0.01, 0.06},
      {true, true, 0.03, 0.01, 0.06},
  };
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    double bare[STRIP], left[STRIP], worst = 0, mean = 0, step = 0;
    const char *light = row[k].far ? A_SOFTBOX : A_DISK;
    draw_strip(light, "", bare);
    draw_strip(light, row[k].ball ? A_BALL : A_SLAB, left);
    for (int i = 0; i < STRIP; i++) {
      left[i] /= bare[i];
      const double x = 0.06 * ((2 * i + 1.0) / STRIP - 1);
      const double off = left[i] - left_of(row[k].far, row[k].ball, x);
      worst = fmax(worst, fabs(off));
      mean += off / STRIP;
      if (i > 0) step = fmax(step, fabs(left[i] - left[i - 1]));
    }
    print_message("%zu: at most %.4f off, in the mean %.4f; steps of %.4f\n", k, worst, mean, step);
    assert_true(worst < row[k].worst && fabs(mean) < row[k].mean && step < row[k].step);
  }
}

/* ---- what they hide, and what shows them ---- */

#define SEEN_FROM(eye, target)                                                                     \
  "materials: glass.yaml\ncamera: {eye: " eye ", target: " target ", up: [0, 1, 0], fov: 1}\n"
#define PANEL                                                                                      \
  "- {name: panel, kind: rectangle, position: [0, 0, 0.3], direction: [0, 0, -1], width: 0.3, "    \
  "height: 0.3, radiance: 2}\n"
#define DISK                                                                                       \
  "- {name: disk, kind: disk, position: [0, 0, 0.6], direction: [0, 0, 1], radius: 0.3, "          \
  "radiance: 3}\n"
#define NOON "- {name: noon, kind: directional, direction: [0, 0, -1], irradiance: 3.14159265}\n"
#define LAMP "- {name: lamp, kind: point, position: [0, 0, 0.9], intensity: 1}\n"
#define WHITE "objects:\n- {name: floor, shape: rectangle, width: 3, height: 3, reflectance: 1}\n"
#define NEAR                                                                                       \
  "- {name: near, kind: rectangle, position: [0, 0, 1.99], direction: [0, 0, -1], width: 0.1, "    \
  "height: 0.1, radiance: 2}\n"
#define ROUGH                                                                                      \
  "- {name: rough, shape: rectangle, width: 0.2, height: 0.2, mirror: 0.5, roughness: 0.1, "       \
  "transform: [{translate: [0, 0, 0.01]}]}\n"
#define MIST "medium: {scattering: 0.5, box: [[-0.2, -0.2, 0.1], [0.2, 0.2, 0.5]]}\n"
#define WALL                                                                                       \
  "- {name: wall, shape: box, size: [0.01, 0.2, 0.2], reflectance: 0, transform: [{translate: "    \
  "[-0.21, 0, 0.3]}]}\n"
#define ROOF                                                                                       \
  "- {name: roof, shape: rectangle, width: 1, height: 1, reflectance: 1, transform: [{translate: " \
  "[0, 0, 2]}]}\n"
#define PANE                                                                                       \
  "- {name: pane, shape: box, size: [0.6, 0.6, 0.01], material: air, transform: [{translate: [0, " \
  "0, 1]}]}\n"
#define MIRROR(z)                                                                                  \
  "- {name: mirror, shape: rectangle, width: 0.4, height: 0.4, mirror: 0.5, transform: "           \
  "[{translate: [0, 0, " z "]}]}\n"
#define GLASS_BALL(z)                                                                              \
  "- {name: ball, shape: sphere, radius: 0.05, levels: 4, material: flat, transform: "             \
  "[{translate: [0, 0, " z "]}]}\n"

typedef struct view {
  const char *what, *text;
  double known;  /* Y */
  double within; /* of the traced one, as a share */
} view;

TEST(they_are_opaque) {
  static const lit under = {0.3, 0.3, 0.3, 0, false};
  const double own = 2 * irradiance(&under);
  const view views[] = {
      {"its back", SEEN_FROM("[0, 0, 2]", "[0, 0, 0]") "lights:\n" PANEL NOON WHITE, 0, 0},
      {"its front", SEEN_FROM("[0, 0, 0.1]", "[0, 0, 1]") "lights:\n" PANEL WHITE ROOF, 2, 1e-4},
      {"a disk's back", SEEN_FROM("[0, 0, 0.2]", "[0, 0, 1]") "lights:\n" DISK WHITE ROOF, 0, 0},
      {"a disk's front", SEEN_FROM("[0, 0, 2]", "[0, 0, 0]") "lights:\n" DISK NOON WHITE, 3, 1e-4},
      {"beside a disk", SEEN_FROM("[0.29, 0.29, 2]", "[0.29, 0.29, 0]") "lights:\n" DISK NOON WHITE,
       1, 1e-4},
      {"the sun behind it", SEEN_FROM("[0.02, 0, 0.1]", "[0, 0, 0]") "lights:\n" PANEL NOON WHITE,
       own, 0.03},
      {"the sun behind a disk",
       SEEN_FROM("[0.02, 0, 0.1]", "[0, 0, 0]") "lights:\n" DISK NOON WHITE, 0, 0},
      {"a lamp behind it", SEEN_FROM("[0.02, 0, 0.1]", "[0, 0, 0]") "lights:\n" PANEL LAMP WHITE,
       own, 0.03},
      {"one behind another",
       SEEN_FROM("[0.02, 0, 0.4]", "[0, 0, 0.5]") "lights:\n" PANEL DISK WHITE ROOF, 0, 0},
      {"its back in clear glass",
       SEEN_FROM("[0, 0, 2]", "[0, 0, 0]") "lights:\n" PANEL NOON WHITE PANE, 0, 0},
      {"its back in a mirror",
       SEEN_FROM("[0.1, 0, 0.7]", "[0.05, 0, 1]") "lights:\n" PANEL NOON WHITE ROOF MIRROR("1"), 0,
       0},
      {"its front in a mirror",
       SEEN_FROM("[0.08, 0, 0.2]", "[0.04, 0, 0.1]") "lights:\n" PANEL NOON WHITE MIRROR("0.1"), 1,
       1e-4},
      {"the sun through a ball behind it",
       SEEN_FROM("[0.02, 0, 0.1]", "[0, 0, 0]") "lights:\n" PANEL NOON WHITE GLASS_BALL("0.5"), own,
       0.03},
      {"a ball behind a disk",
       SEEN_FROM("[0.02, 0, 0.1]", "[0, 0, 0]") "lights:\n" DISK NOON WHITE GLASS_BALL("0.2"), 0,
       0},
      {"close to the eye", SEEN_FROM("[0, 0, 2]", "[0, 0, 0]") "lights:\n" NEAR NOON WHITE, 0, 0},
      {"mist behind a disk",
       SEEN_FROM("[0.2, 0, 0.3]", "[-0.2, 0, 0.3]") MIST "lights:\n" DISK NOON WHITE WALL, 0, 0},
      {"a lamp behind a disk in a rough mirror",
       SEEN_FROM("[0.02, 0, 0.4]", "[0, 0, 0]") "lights:\n" DISK LAMP WHITE ROUGH, 0, 0},
  };
  for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
    const view *v = &views[i];
    const double renderer = drawn(v->text), tracer = traced(v->text);
    print_message("%s: %.5f drawn, %.5f traced, of %.5f\n", v->what, renderer, tracer, v->known);
    assert_near(renderer, v->known, 2e-3 * v->known);
    assert_near(tracer, v->known, v->within * v->known);
  }
}
