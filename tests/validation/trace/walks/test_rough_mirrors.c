/* Rough mirrors in the tracer: what the eye sees of lamps and surroundings in them, and where they
 * send photons, against the lobe and its closed form. */
#include "tests/validation/trace/walks/light_walks.h"
#include "tests/validation/trace_scene.h"

#include "base/maths.h"
#include "validation/trace/tracer/tracer_state.h"

/* Straight down onto a plate of reflectance 0.8, half a metre up; under it a floor that shows
 * nothing. */
#define DOWN                                                                                       \
  "materials: glass.yaml\ncamera: {eye: [0, 0, 2], target: [0, 0, 0], up: [0, 1, 0], fov: 0.1}\n"
#define PLATE(surface)                                                                             \
  "objects:\n- {name: plate, shape: rectangle, width: 1, height: 1, mirror: 0.8, " surface         \
  "transform: [{translate: [0, 0, 0.5]}]}\n"                                                       \
  "- {name: floor, shape: rectangle, width: 0.5, height: 0.5, reflectance: 0}\n"
#define LIGHT(text) "lights:\n- {name: lamp, " text "}\n"

typedef struct view {
  abbe_scene scene;
  abbe_tracer *tracer;
  double y, error; /* mean of the picture, and its standard error */
} view;

static void see(const char *text, uint32_t passes, view *v) {
  const abbe_trace_desc desc = {
      .width = 4, .height = 4, .no_map = true, .threads = 1, .space = ABBE_RGB_SPACE_XYZ};
  double sum = 0, square = 0, count = 0;
  v->scene = scene_of(text);
  v->tracer = make_tracer(&v->scene, &desc);
  for (uint32_t pass = 0; pass < passes; pass++)
    for (size_t pixel = 0; pixel < 16; pixel++) {
      abbe_eye_sample s;
      abbe_eye_walk_pixel(&v->tracer->eye, pixel, pass, &s);
      sum += (double)s.rgb[1];
      square += (double)s.rgb[1] * (double)s.rgb[1];
      count++;
    }
  v->y = sum / count;
  v->error = sqrt(fmax(square / count - v->y * v->y, 0) / count);
}

static void forget(view *v) {
  abbe_tracer_free(v->tracer);
  abbe_scene_free(&v->scene);
}

/* As tests/spectral/test_microfacets.c has it: of uniform light, seen straight on. */
static double straight(double alpha) {
  enum { PIECES = 100000 };
  double sum = 0;
  for (int i = 0; i < PIECES; i++) {
    const double t = (i + 0.5) / PIECES, tangent2 = 4 * t / ((1 - t) * (1 - t));
    sum += alpha * alpha / pow(alpha * alpha + t, 2) * 2 / (1 + sqrt(1 + alpha * alpha * tangent2));
  }
  return sum / PIECES;
}

/* Light that is alike all around: a rough mirror shows what its facets let out. */
TEST(uniform_light_keeps_what_facets_let_out) {
  static const double alpha[] = {0.05, 0.3, 1};
  for (int i = 0; i < 3; i++) {
    view v;
    see(printed(DOWN "environment: {size: 64, uniform: 2}\n" PLATE("roughness: %.17g, "), alpha[i]),
        200, &v);
    assert_true(v.error < 0.01 * v.y);
    assert_near(v.y, 2 * 0.8 * straight(alpha[i]), 4 * v.error + 2e-4);
    forget(&v);
  }
}

/* A lamp without size, which no path meets: exactly the lobe's. Grooves along x spread light along
 * y. */
TEST(a_point_lamp_shows_the_lobe) {
  static const char *const place[] = {"0.3, 0, 0.9", "0, 0.3, 0.9"};
  static const char *const brushed[] = {"along: [1, 0, 0]", "along: [0, 1, 0]"};
  static const double up[3] = {0, 0, 1};
  double seen[2][2];
  for (int i = 0; i < 2; i++)
    for (int b = 0; b < 2; b++) {
      view v;
      see(printed(DOWN LIGHT("kind: point, position: [%s], intensity: 3")
                      PLATE("roughness: [0.1, 0.3], brushed: {%s}, "),
                  place[i], brushed[b]),
          1, &v);
      const bool across = (i == 1) == (b == 0);
      const abbe_microfacets m = {0.1, 0.3};
      const double wi[3] = {across ? 0 : 0.6, across ? 0.6 : 0, 0.8};
      const double white = (double)v.tracer->white[0][1];
      assert_near(v.y / (0.8 * 3 / 0.25 * 0.8 * abbe_microfacets_reflect(&m, wi, up) * white), 1,
                  5e-3);
      seen[i][b] = v.y;
      forget(&v);
    }
  assert_true(seen[1][0] > 3 * seen[0][0]);
  assert_near(seen[0][1], seen[1][0], 1e-3 * seen[1][0]);
}

/* A lamp of some size is met by the lobe's ways and sought by its own points: their weights make
 * one of both, where the lamp is the narrower and where the lobe is. */
TEST(a_disk_lamp_counts_once) {
  static const double alpha[] = {0.02, 0.1, 0.5}, up[3] = {0, 0, 1};
  for (int i = 0; i < 3; i++) {
    enum { RINGS = 200, SECTORS = 200 };
    const abbe_microfacets m = {alpha[i], alpha[i]};
    const double radius = 0.08, high = 0.6, aside = 0.12;
    view v;
    double sum = 0;
    for (int r = 0; r < RINGS; r++)
      for (int s = 0; s < SECTORS; s++) {
        const double rho = radius * sqrt((r + 0.5) / RINGS), a = 2 * ABBE_PI * (s + 0.5) / SECTORS;
        const double x = aside + rho * cos(a), y = rho * sin(a);
        const double far2 = x * x + y * y + high * high, far = sqrt(far2);
        const double wi[3] = {x / far, y / far, high / far};
        sum += abbe_microfacets_reflect(&m, wi, up) * wi[2] * wi[2] / far2;
      }
    const double expected = 0.8 * 5 * sum * ABBE_PI * radius * radius / (RINGS * SECTORS);
    see(printed(DOWN LIGHT("kind: disk, position: [0.12, 0, 1.1], direction: [0, 0, -1], radius: "
                           "0.08, radiance: 5") PLATE("roughness: %.17g, "),
                alpha[i]),
        400, &v);
    assert_true(v.error < 0.05 * v.y);
    assert_near(v.y / (double)v.tracer->white[0][1], expected,
                4 * v.error / (double)v.tracer->white[0][1] + 1e-3 * expected);
    forget(&v);
  }
}

/* The same of surroundings that are dark but for a spot. */
TEST(a_bright_spot_counts_once) {
  static const double alpha[] = {0.03, 0.15, 0.6}, up[3] = {0, 0, 1};
  for (int i = 0; i < 3; i++) {
    enum { RINGS = 400, SECTORS = 400 };
    const abbe_microfacets m = {alpha[i], alpha[i]};
    view v;
    double sum = 0;
    see(printed(DOWN "environment: {size: 128, spots: [{elevation: 75, azimuth: 0, radiance: 4, "
                     "sigma: 6}]}\n" PLATE("roughness: %.17g, "),
                alpha[i]),
        400, &v);
    for (int r = 0; r < RINGS; r++)
      for (int s = 0; s < SECTORS; s++) {
        const double polar = ABBE_PI / 2 * (r + 0.5) / RINGS, a = 2 * ABBE_PI * (s + 0.5) / SECTORS;
        const double t = sin(polar), wi[3] = {t * cos(a), t * sin(a), cos(polar)};
        const float d[3] = {(float)wi[0], (float)wi[1], (float)wi[2]};
        float rgb[3];
        abbe_environment_light_seen(v.tracer->eye.environment, d, rgb);
        sum += abbe_microfacets_reflect(&m, wi, up) * wi[2] * t * (double)rgb[1];
      }
    const double expected = 0.8 * sum * ABBE_PI * ABBE_PI / (RINGS * SECTORS);
    assert_true(expected > 0 && v.error < 0.05 * v.y);
    assert_near(v.y, expected, 4 * v.error + 5e-3 * expected);
    forget(&v);
  }
}

/* A room that is a ball, so far off that light lands by its direction alone. */
#define ROOM "- {name: room, shape: sphere, radius: 500, levels: 3, reflectance: 0.5}\n"

/* Of light straight down, the halfway slope along each way: less than its roughness in 1 / sqrt 2.
 */
TEST(photons_follow_the_lobe) {
  static const double across[2] = {0.02, 0.1}, from[3] = {0, 0, 1}, down[3] = {0, 0, -1};
  static fixture f;
  enum { BATCHES = 24 };
  double within[2] = {0}, all = 0;
  size_t shot = 0;
  make(CAMERA POINT_LIGHT FLOOR ROOM
       "- {name: plate, shape: rectangle, width: 1, height: 1, mirror: 0.8, roughness: [0.02, "
       "0.1], brushed: {along: [1, 0, 0]}, transform: [{translate: [0, 0, 0.5]}]}\n",
       NULL, &f);
  for (uint32_t b = 0; b < BATCHES; b++) {
    for (uint32_t i = 0; i < BATCH; i++) f.photon[i] = photon_of(&f, from, down, b * BATCH + i);
    const size_t count =
        abbe_light_walk_run(f.walk, &f.scene.light[0], b, f.photon, BATCH, f.hit, &f.ledger);
    for (size_t i = 0; i < count; i++) {
      double p[3], length = 0;
      abbe_geometry_to_world(&f.geometry, f.hit[i].p, p);
      p[2] -= 0.5;
      for (int k = 0; k < 3; k++) length += p[k] * p[k];
      const double steep = p[2] / sqrt(length) + 1; /* halfway to straight up */
      for (int k = 0; k < 2; k++)
        within[k] += fabs(p[k] / sqrt(length) / steep) < across[k] ? (double)f.hit[i].flux : 0;
      all += (double)f.hit[i].flux;
    }
    shot += BATCH;
  }
  const double noise = 5 * 0.46 / sqrt((double)shot) + 5e-3;
  for (int k = 0; k < 2; k++) assert_near(within[k] / all, sqrt(0.5), noise);
  assert_near(all / (double)shot, 0.8, 5e-3);
  const abbe_light_ledger *l = &f.ledger;
  assert_near((l->deposited + l->absorbed + l->missed + l->lost) / l->reached, 1, 1e-5);
  fixture_free(&f);
}
