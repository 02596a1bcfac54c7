/* Caustics by projected surroundings: linear in light, the same turned, what one pinhole adds and
 * by how much its softening lessens that, mirrors' closed forms, and when footprints matter. */
#include "tests/gl/frame.h"
#include "validation/lab/known/forms/closed_form.h"

#include "base/maths.h"
#include "scenes/samples/surface_samples.h"

/* Straight down, half a metre each way at the floor. */
#define DOWN                                                                                       \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 28.0724869}\n"
#define WHITE_FLOOR                                                                                \
  "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1}\n"
/* Upright, facing -x, half a metre wide, its foot on the floor. */
#define WALL(share)                                                                                \
  "- {name: wall, shape: rectangle, width: 0.3, height: 0.5, mirror: " share                       \
  ", transform: [{rotate: {axis: [0, 1, 0], angle: -90}}, {translate: [0.3, 0, 0.15]}]}\n"
#define MIRROR_BALL                                                                                \
  "- {name: ball, shape: sphere, radius: 0.01, levels: 5, mirror: 0.8, transform: [{translate: "   \
  "[0, 0, 0.3]}]}\n"

enum { SIDE = 64 };

static abbe_render_desc request(size_t pinholes) {
  return (abbe_render_desc){.profile = ABBE_PROFILE_WAND2003,
                            .width = SIDE,
                            .height = SIDE,
                            .pinholes = pinholes,
                            .space = ABBE_RGB_SPACE_REC709};
}

/* Irradiance on the white floor at a pixel, of green. */
static double at(const abbe_image *p, size_t x, size_t y) {
  return ABBE_PI * (double)p->data[(y * p->width + x) * p->channels + 1];
}

/* The pixel's place on the floor; rows go down. */
static void place_of(size_t x, size_t y, double p[3]) {
  p[0] = ((double)x + 0.5) / SIDE - 0.5;
  p[1] = 0.5 - ((double)y + 0.5) / SIDE;
  p[2] = 0;
}

#define SOFT "environment: {uniform: 0.5, size: 256}\n"

GROUP(make_context, free_context);

/* What one pinhole adds is A L cos cos / (d2 + eps), eps its disk's diameter squared: of light
 * without it, less by eps / (d2 + eps). */
TEST(one_pinhole) {
  static const char text[] = DOWN SOFT WHITE_FLOOR WALL("0.8");
  abbe_render_desc desc = request(1);
  OWNED(abbe_scene, scene) = scene_of(text);
  FILLED(abbe_image, picture, draw_text(text, &desc, &picture));
  FILLED(abbe_image, base, draw_text(DOWN SOFT WHITE_FLOOR WALL("0"), &desc, &base));
  assert_near(at(&base, 3, 3), 0.5 * ABBE_PI, 1e-3);
  const abbe_mesh *mesh = &scene.object[1].mesh;
  const abbe_surface_sampling sampling = {.count = 1};
  MADE(abbe_surface_samples, s, abbe_surface_samples_make(&mesh, 1, &sampling, &s, &error));
  const double eps = 4 * s.area / ABBE_PI;
  double most = 0;
  for (size_t y = 0; y < SIDE; y += 3)
    for (size_t x = 0; x < SIDE; x += 3) {
      double p[3], d[3];
      place_of(x, y, p);
      if (p[0] > 0.28) continue; /* behind it */
      abbe_vector_subtract(s.sample[0].position, p, d);
      const double d2 = abbe_vector_dot(d, d);
      const double there = fabs(d[0]) / sqrt(d2), here = d[2] / sqrt(d2);
      const double right = 0.8 * 0.5 * s.area * there * here / (d2 + eps);
      most = fmax(most, right);
      assert_near(at(&picture, x, y) - at(&base, x, y), right, 2e-3 * right + 2e-6);
    }
  assert_true(most > 0.01);
}

/* A mirror under light that is alike all around is a lamp of its shape. */
TEST(a_mirror_is_a_lamp_of_its_shape) {
  const double corner[4][3] = {
      {0.3, -0.25, 0}, {0.3, 0.25, 0}, {0.3, 0.25, 0.3}, {0.3, -0.25, 0.3}};
  const abbe_render_desc desc = request(2048);
  FILLED(abbe_image, picture, draw_text(DOWN SOFT WHITE_FLOOR WALL("0.8"), &desc, &picture));
  double worst = 0;
  for (size_t y = 0; y < SIDE; y += 3)
    for (size_t x = 0; x < 44; x += 3) { /* 10 cm away and farther */
      double p[3];
      place_of(x, y, p);
      static const double up[3] = {0, 0, 1};
      const double right = 0.8 * 0.5 * ABBE_PI * abbe_closed_form_polygon(corner, 4, p, up);
      worst = fmax(worst, fabs(at(&picture, x, y) - 0.5 * ABBE_PI - right) / right);
    }
  print_message("off by %.4f at most\n", worst);
  assert_true(worst < 0.04);
}

/* Whatever is around, a ball sends the same to all sides far away: r2 / 4 of the integral of
 * radiance. */
TEST(a_ball_sends_light_to_all_sides) {
  static const char sky[] =
      "environment: {size: 256, spots: [{elevation: 50, azimuth: 30, radiance: 8, sigma: 12}, "
      "{elevation: -30, azimuth: 200, radiance: 4, sigma: 20}], uniform: 0.1}\n";
  const abbe_render_desc desc = request(2048);
  const char *text = printed(DOWN "%s" WHITE_FLOOR MIRROR_BALL, sky);
  /* a mirror that adds nothing */
  const char *bare = printed(DOWN "%s" WHITE_FLOOR WALL("0"), sky);
  OWNED(abbe_scene, scene) = scene_of(text);
  const double all = 4 * ABBE_PI * scene.environment->mean[1];
  FILLED(abbe_image, picture, draw_text(text, &desc, &picture));
  FILLED(abbe_image, without, draw_text(bare, &desc, &without));
  for (size_t y = 4; y < SIDE; y += 8)
    for (size_t x = 2; x < 24; x += 3) {
      double p[3];
      place_of(x, y, p);
      const double d2 = p[0] * p[0] + p[1] * p[1] + 0.09;
      const double right = 0.8 * 1e-4 / 4 * all / d2 * 0.3 / sqrt(d2);
      assert_near(at(&picture, x, y) - at(&without, x, y), right, 0.06 * right + 2e-6);
    }
}

#define SPOT(sigma, radiance)                                                                      \
  "environment: {size: 512, uniform: 0.2, spots: [{elevation: 55, azimuth: 160, "                  \
  "radiance: " radiance ", sigma: " sigma "}]}\n"
#define PIPE                                                                                       \
  "- {name: pipe, shape: lathe, around: 256, profile: [[0.3, 0], [0.3, 0.2]], mirror: 0.9}\n"

TEST(linear) {
  OWNED(abbe_image, two);
  const abbe_render_desc desc = request(200);
  FILLED(abbe_image, one, draw_text(DOWN SPOT("12", "5") WHITE_FLOOR PIPE, &desc, &one));
  draw_text(DOWN "environment: {size: 512, scale: 3, uniform: 0.2, spots: [{elevation: 55, "
                 "azimuth: 160, radiance: 5, sigma: 12}]}\n" WHITE_FLOOR PIPE,
            &desc, &two);
  for (size_t i = 0; i < SIDE * SIDE * 3; i++)
    assert_near((double)two.data[i], 3 * (double)one.data[i], 2e-6 + 1e-5 * (double)two.data[i]);
}

/* Surroundings, mirror and eye by 90 degrees about z: the pixels of a quarter turn are as before,
 * but for how triangles and texels lie. */
TEST(turned_together) {
  static const char mirror[] =
      "- {name: mirror, shape: rectangle, width: 0.3, height: 0.2, mirror: 0.9, transform: "
      "[{rotate: {axis: [0, 1, 0], angle: -60}}, {translate: [0.3, 0.1, 0.3]}%s]}\n";
  char text[2][2048], object[512];
  abbe_image picture[2];
  const abbe_render_desc desc = request(300);
  for (int k = 0; k < 2; k++) {
    snprintf(object, sizeof object, mirror,
             k == 0 ? "" : ", {rotate: {axis: [0, 0, 1], angle: 90}}");
    snprintf(text[k], sizeof text[k],
             "materials: glass.yaml\n"
             "camera: {eye: [0, 0, 2], target: [0, 0, 0], up: [%d, %d, 0], fov: 28.0724869}\n"
             "environment: {size: 512, rotate: %d, uniform: 0.2, spots: [{elevation: 40, azimuth: "
             "120, radiance: 5, sigma: 15}]}\n" WHITE_FLOOR "%s",
             k == 0 ? 0 : -1, k == 0 ? 1 : 0, k == 0 ? 0 : 90, object);
    draw_text(text[k], &desc, &picture[k]);
  }
  for (size_t i = 1; i < SIDE * SIDE * 3; i += 3) {
    const double a = (double)picture[0].data[i], b = (double)picture[1].data[i];
    assert_near(a, b, 0.01 * a);
  }
  abbe_image_free(&picture[0]);
  abbe_image_free(&picture[1]);
}

/* Root mean square of the difference of footprints on and off, over the mean of what mirrors add.
 */
static double footprint_matters(const char *text, const char *bare) {
  OWNED(abbe_image, on) = {0}, off = {0}, base = {0};
  abbe_render_desc desc = request(400);
  draw_text(text, &desc, &on);
  draw_text(bare, &desc, &base);
  desc.footprint = ABBE_FOOTPRINT_OFF;
  draw_text(text, &desc, &off);
  double square = 0, sum = 0;
  for (size_t i = 1; i < SIDE * SIDE * 3; i += 3) {
    square += pow((double)(on.data[i] - off.data[i]), 2);
    sum += (double)(on.data[i] - base.data[i]);
  }
  return sqrt(square * SIDE * SIDE) / sum;
}

/* Light that is wider than footprints is looked up alike; light as narrow as theirs is not. */
TEST(footprints) {
  const double wide = footprint_matters(DOWN SPOT("35", "1") WHITE_FLOOR PIPE,
                                        DOWN SPOT("35", "1") WHITE_FLOOR WALL("0"));
  const double narrow = footprint_matters(DOWN SPOT("1.5", "400") WHITE_FLOOR PIPE,
                                          DOWN SPOT("1.5", "400") WHITE_FLOOR WALL("0"));
  print_message("footprints change %.4f of wide light, %.4f of narrow\n", wide, narrow);
  assert_true(wide < 0.02);
  assert_true(narrow > 0.2);
}

/* What an upright mirror wall of a pipe sends of a beam of 1 W/m2 along its axis onto the floor:
 * light that meets it at azimuth phi and height z lands z / tan e on, mirrored about the wall's
 * normal. Means over the pixels of four rows about the middle, by a quadrature. */
static void send_off_pipe(double radius, double height, double e, double share, double out[SIDE]) {
  enum { AROUND = 4000, UP = 2000 };
  memset(out, 0, SIDE * sizeof *out);
  for (int i = 0; i < AROUND; i++)
    for (int k = 0; k < UP; k++) {
      const double phi = ABBE_PI * ((i + 0.5) / AROUND - 0.5), z = height * (k + 0.5) / UP;
      const double s = z / tan(e), flux = share * cos(phi) * cos(e) * ABBE_PI * radius * height /
                                          ((double)AROUND * UP);
      const double x = radius * cos(phi) - s * cos(2 * phi),
                   y = radius * sin(phi) - s * sin(2 * phi);
      const int pixel = (int)floor((x + 0.5) * SIDE);
      if (fabs(y) < 2.0 / SIDE && pixel >= 0 && pixel < SIDE)
        out[pixel] += flux / (4.0 / SIDE / SIDE);
    }
}

/* A pipe's wall under a small sun draws a nephroid, whose cusp is at half the radius. */
TEST(a_pipe_draws_a_nephroid) {
  static const char sun[] =
      "environment: {size: 1024, sun: {elevation: 35, azimuth: 180, irradiance: 1, diameter: 6}}\n";
  abbe_render_desc desc = request(4096);
  const char *text = printed(DOWN "%s" WHITE_FLOOR PIPE, sun);
  const char *bare = printed(DOWN "%s" WHITE_FLOOR WALL("0"), sun);
  FILLED(abbe_image, picture, draw_text(text, &desc, &picture));
  FILLED(abbe_image, base, draw_text(bare, &desc, &base));
  const double radius = 0.3;
  double right[SIDE], worst = 0, most = 0, p[3];
  send_off_pipe(radius, 0.2, 35 * ABBE_PI / 180, 0.9, right);
  for (size_t x = 0; x < SIDE; x++) {
    double caustic = 0;
    for (size_t y = SIDE / 2 - 2; y < SIDE / 2 + 2; y++)
      caustic += (at(&picture, x, y) - at(&base, x, y)) / 4;
    place_of(x, SIDE / 2, p);
    if (p[0] < 0.1 * radius || p[0] > 0.68 * radius) continue; /* nearer softening counts */
    print_message("%.2f R: %.3f of %.3f\n", p[0] / radius, caustic, right[x]);
    worst = fmax(worst, fabs(caustic / right[x] - 1));
    most = fmax(most, caustic);
  }
  assert_true(most > 4);
  assert_true(worst < 0.08);
}

TEST(refusals) {
  static const struct {
    const char *text, *says;
  } cases[] = {
      {DOWN SOFT WHITE_FLOOR, "needs a mirror"},
      {DOWN SUN WHITE_FLOOR WALL("0.9"), "this scene has none"},
      {DOWN SOFT SUN WHITE_FLOOR WALL("0.9"), "'sun'"},
      {DOWN SOFT WHITE_FLOOR WALL("0.9") BALL("flat"), "'ball' is a refractor"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_renderer *renderer = NULL;
    const abbe_render_desc desc = request(10);
    OWNED(abbe_scene, scene) = scene_of(cases[i].text);
    REFUSED(ABBE_UNSUPPORTED, cases[i].says,
            abbe_renderer_make(context, &scene, &desc, &renderer, &error));
  }
}
