/* Rough mirrors as the renderer draws them: what samples of one send to a floor, and what the
 * camera sees in one, against sums over the lobe. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "spectral/microfacets.h"

#define DOWN                                                                                       \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 28.0724869}\n"
#define DIM "environment: {uniform: 1e-4, size: 64}\n"
#define SIDEWAYS                                                                                   \
  "lights:\n- {name: sun, kind: directional, direction: [0.8, 0, -0.6], irradiance: 3}\n"
#define WHITE_FLOOR                                                                                \
  "objects:\n- {name: floor, shape: rectangle, width: 4, height: 4, reflectance: 1}\n"
#define WALL(share, facets)                                                                        \
  "- {name: wall, shape: rectangle, width: 0.3, height: 0.5, mirror: " share                       \
  ", roughness: " facets                                                                           \
  ", brushed: {along: [0, 1, 0]}, transform: [{rotate: {axis: [0, 1, 0], angle: -90}}, "           \
  "{translate: [0.3, 0, 0.15]}]}\n"

enum { SIDE = 24 };

static void draw(const char *text, size_t pinholes, abbe_image *out) {
  const abbe_render_desc desc =
      FIELDS(.width = SIDE, .height = SIDE, .supersample = 1, .map_size = 256, .photons = 64,
             .wavelengths = 1,
             .transport = pinholes > 0 ? ABBE_TRANSPORT_PINHOLE : ABBE_TRANSPORT_AUTO,
             .pinholes = pinholes, .space = ABBE_RGB_SPACE_REC709);
  OWNED(abbe_scene, scene) = scene_of(text);
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
  *out = picture_of(renderer);
  assert_finite(out);
}

static double at(const abbe_image *p, size_t x, size_t y) {
  return (double)p->data[(y * p->width + x) * p->channels + 1];
}

/* Irradiance at p of the floor by the wall's side that looks along -x, of light along d, E across
 * it. */
static double sent_by_the_wall(const abbe_microfacets *m, double reflectance, double e,
                               const double d[3], const double p[3]) {
  enum { STEPS = 150 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++)
    for (int k = 0; k < STEPS; k++) {
      const double q[3] = {0.3, 0.5 * ((i + 0.5) / STEPS - 0.5), 0.3 * (k + 0.5) / STEPS};
      double to[3], far2 = 0;
      for (int c = 0; c < 3; c++) {
        to[c] = p[c] - q[c];
        far2 += to[c] * to[c];
      }
      const double far = sqrt(far2);
      /* x along y, y along z, z along -x */
      const double wo[3] = {to[1] / far, to[2] / far, -to[0] / far}, wi[3] = {-d[1], -d[2], d[0]};
      if (!(wo[2] > 0)) continue;
      sum += abbe_microfacets_reflect(m, wi, wo) * wi[2] * wo[2] * (q[2] / far) / far2;
    }
  return reflectance * e * sum * 0.15 / (STEPS * STEPS);
}

GROUP(make_context, free_context);

/* In light of one direction, less what the floor has straight. Grooves spread it across them. */
TEST(samples_send_the_lobe) {
  static const double d[3] = {0.8, 0, -0.6}, straight = 3 * 0.6;
  static const abbe_microfacets m = {0.2, 0.5};
  OWNED(abbe_image, picture);
  double worst = 0, most = 0;
  draw(DOWN SIDEWAYS WHITE_FLOOR WALL("0.9", "[0.2, 0.5]"), 200, &picture);
  for (size_t y = 2; y < SIDE; y += 4)
    for (size_t x = 1; x < 15; x += 2) {
      const double p[3] = {((double)x + 0.5) / SIDE - 0.5, 0.5 - ((double)y + 0.5) / SIDE, 0};
      const double right = sent_by_the_wall(&m, 0.9, 3, d, p);
      worst = fmax(worst, fabs(ABBE_PI * at(&picture, x, y) - straight - right));
      most = fmax(most, right);
    }
  print_message("off by %.4f of the most\n", worst / most);
  assert_true(most > 0.1 && worst < 0.04 * most);
}

/* Even light that facets send to the floor: nearly all of what the wall hides. */
TEST(even_light_keeps_nearly_all) {
  OWNED(abbe_image, picture);
  double least = 1, most = 0;
  draw(DOWN "environment: {uniform: 0.5, size: 64}\n" WHITE_FLOOR WALL("1", "[0.05, 0.05]"), 60,
       &picture);
  for (size_t y = 0; y < SIDE; y++)
    for (size_t x = 0; x < 17; x++) {
      least = fmin(least, at(&picture, x, y) / 0.5);
      most = fmax(most, at(&picture, x, y) / 0.5);
    }
  print_message("%.4f to %.4f of open light\n", least, most);
  assert_true(most < 1 + 2e-3 && least > 0.98);
}

/* The camera looks straight down onto a plate. */
#define PLATE(facets)                                                                              \
  "objects:\n- {name: floor, shape: rectangle, width: 0.2, height: 0.2, reflectance: 0.5}\n"       \
  "- {name: plate, shape: rectangle, width: 3, height: 3, mirror: 0.8, roughness: " facets         \
  ", brushed: {along: [0, 1, 0]}, transform: [{translate: [0, 0, 0.5]}]}\n"

/* A lamp's light there is the lobe's; of even light, what straight on is kept (test_microfacets.c):
 * 0.8774 at 0.3, 0.9883 at 0.1. */
TEST(the_camera_sees_the_lobe) {
  static const abbe_microfacets m = {0.1, 0.3};
  OWNED(abbe_image, picture);
  draw(DOWN DIM "lights:\n- {name: sun, kind: directional, direction: [-0.48, 0, -0.8773], "
                "irradiance: 3}\n" PLATE("[0.1, 0.3]"),
       8, &picture);
  for (size_t x = 2; x < SIDE; x += 4) {
    /* x of the picture is across the grooves */
    const double far = ((double)x + 0.5) / SIDE - 0.5, high = 2;
    const double up = high / sqrt(far * far + high * high), aside = -far / high * up;
    const double wo[3] = {0, aside, up}, wi[3] = {0, 0.48 / 1.00003, 0.8773 / 1.00003};
    const double right = 3 * 0.8 * wi[2] * abbe_microfacets_reflect(&m, wi, wo);
    assert_near(at(&picture, x, SIDE / 2) / right, 1, 0.02);
  }
  abbe_image_free(&picture);
  draw(DOWN "environment: {uniform: 2, size: 64}\n" PLATE("[0.3, 0.3]"), 8, &picture);
  double sum = 0;
  for (size_t y = SIDE / 2 - 4; y < SIDE / 2 + 4; y++)
    for (size_t x = SIDE / 2 - 4; x < SIDE / 2 + 4; x++) sum += at(&picture, x, y) / 64;
  print_message("%.4f of even light\n", sum / 1.6);
  assert_near(sum / 1.6, 0.8774, 0.01);
}

TEST(refusals) {
  static const char text[] = DOWN DIM WHITE_FLOOR WALL("0.9", "[0.1, 0.1]");
  static const struct {
    abbe_render_desc desc;
    const char *says;
  } rows[] = {{{.profile = ABBE_PROFILE_WAND2003}, "smooth ones alone"},
              {{.transport = ABBE_TRANSPORT_PHOTONS}, "by the transport 'pinhole' alone"}};
  for (size_t i = 0; i < 2; i++) {
    abbe_renderer *renderer = NULL;
    OWNED(abbe_scene, scene) = scene_of(text);
    REFUSED(ABBE_UNSUPPORTED, rows[i].says,
            abbe_renderer_make(context, &scene, &rows[i].desc, &renderer, &error));
    assert_contains(last_error.text, "'wall'");
  }
}
