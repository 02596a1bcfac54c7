/* Light scattered once in the air, of one ray: known integrals, and where a cone cuts a line. */
#include "tests/scenes/scene_text.h"

#include "tests/random.h"
#include "validation/trace/medium/air_light.h"
#include "validation/trace/transport/media.h"

/* Places of the line, asked one by one. */
TEST(a_cone_cuts_lines) {
  uint64_t random = 11;
  size_t met = 0;
  for (int i = 0; i < 3000; i++) {
    double tip[3], axis[3], o[3], d[3], lengths[2] = {0};
    for (int k = 0; k < 3; k++) {
      tip[k] = random_between(&random, -0.3, 0.3);
      axis[k] = random_between(&random, -1, 1);
      o[k] = random_between(&random, -1, 1);
      d[k] = random_between(&random, -1, 1);
      lengths[0] += axis[k] * axis[k];
      lengths[1] += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) {
      axis[k] /= sqrt(lengths[0]);
      d[k] /= sqrt(lengths[1]);
      if (i % 3 == 0) d[k] = axis[k];       /* along the axis */
      if (i % 3 == 1) o[k] = tip[k] - d[k]; /* through the tip */
    }
    const double angle = random_between(&random, 0.01, 1.5);
    double from = 0, to = 3;
    const bool some = abbe_air_light_cone(tip, axis, angle, o, d, &from, &to);
    met += some;
    for (int j = 0; j < 60; j++) {
      const double t = 0.05 * (j + 0.5);
      double v[3], along = 0, length = 0;
      for (int k = 0; k < 3; k++) {
        v[k] = o[k] + t * d[k] - tip[k];
        along += v[k] * axis[k];
        length += v[k] * v[k];
      }
      const double off = along - cos(angle) * sqrt(length);
      if (fabs(off) < 1e-9) continue;
      assert_int_equal(off > 0, some && t > from && t < to);
    }
  }
  assert_int_in_range(met, 500, 2900);
}

enum { STEPS = 4, PARTS = 4000 };

typedef struct fixture {
  abbe_scene scene;
  abbe_geometry geometry;
  abbe_media media;
} fixture;

static void make(const char *text, fixture *f) {
  const double lambda_nm[STEPS + 1] = {500, 525, 550, 575, 600};
  f->scene = scene_of(text);
  OK(abbe_geometry_make(&f->scene, &f->geometry, &error));
  OK(abbe_media_make(&f->geometry, lambda_nm, STEPS, &f->media, &error));
}

static void fixture_free(fixture *f) {
  abbe_media_free(&f->media);
  abbe_geometry_free(&f->geometry);
  abbe_scene_free(&f->scene);
}

#define MIST "medium: {scattering: 0.7, absorption: 0.2, g: 0.5, box: [[-1, -1, 0], [1, 1, 1]]}\n"
#define SPOT                                                                                       \
  "lights:\n- {name: lamp, kind: spot, position: [0.05, 0.03, 0.6], direction: [0, 0, -1], "       \
  "cone: 20, soft: 10, intensity: 2}\n"
#define PANEL                                                                                      \
  "lights:\n- {name: lamp, kind: rectangle, position: [0.05, 0.03, 0.6], direction: [0, 0, -1], "  \
  "width: 1.0e-3, height: 1.0e-3, radiance: 2.0e+6}\n"

/* The same in doubles and even steps: a horizontal ray through the mist, under the lamp, over which
 * a plate hides a part. */
static double expected(const fixture *f, const double o[3], double reach) {
  const abbe_light *l = &f->scene.light[0];
  double sum = 0;
  enum { EVEN = 200000 };
  for (int i = 0; i < EVEN; i++) {
    const double t = reach * (i + 0.5) / EVEN, x[3] = {o[0] + t, o[1], o[2]};
    double to[3], away[3], distance = 0, hidden;
    for (int k = 0; k < 3; k++) {
      to[k] = l->kind == ABBE_LIGHT_DIRECTIONAL ? -l->direction[k] : l->position[k] - x[k];
      distance += to[k] * to[k];
    }
    distance = sqrt(distance);
    for (int k = 0; k < 3; k++) {
      to[k] /= distance;
      away[k] = -to[k];
    }
    /* a plate of 0.1 by 0.1 at the height 0.35 */
    const double rise = (0.35 - x[2]) / to[2];
    hidden = fabs(x[0] + rise * to[0]) < 0.05 && fabs(x[1] + rise * to[1]) < 0.05;
    if (hidden) continue;
    double power = l->power * abbe_light_profile(l, away), way = distance;
    if (l->kind == ABBE_LIGHT_DIRECTIONAL)
      way = (1 - x[2]) / to[2];
    else
      power /= distance * distance;
    if (l->kind == ABBE_LIGHT_RECTANGLE) power *= abbe_light_area(l);
    sum += reach / EVEN * 0.7 * abbe_medium_phase(0.5, to[0]) * exp(-0.9 * (t + way)) * power;
  }
  return sum;
}

TEST(lamps_light_the_mist) {
  static const char *const lights[] = {POINT_LIGHT, SPOT, SUN, PANEL};
  for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
    FILLED(fixture, f,
           make(printed(CAMERA "%s" MIST FLOOR
                               "- {name: plate, shape: rectangle, width: 0.1, height: 0.1, "
                               "reflectance: 1, transform: [{translate: [0, 0, 0.35]}]}\n",
                        lights[i]),
                &f));
    const double o[3] = {-0.8, 0.02, 0.15}, unit = f.geometry.unit;
    abbe_air_ray ray = FIELDS(.geometry = &f.geometry, .haze = &f.media.haze, .d = {1, 0, 0},
                              .to = (float)(1.5 / unit), .step = 1);
    abbe_geometry_to_frame(&f.geometry, o, ray.o);
    double sum = 0;
    uint32_t rays = 0;
    for (int k = 0; k < PARTS; k++) {
      const float u[3] = {((float)k + 0.5f) / PARTS, 0.3f, 0.6f};
      sum += (double)abbe_air_light_lamp(&ray, 0, u, &rays) / PARTS;
    }
    const double exact = expected(&f, o, 1.5);
    assert_true(exact > 1e-3 && rays > 0);
    assert_near(sum / exact, 1, 4e-3);
  }
}

/* In light that is alike from everywhere scattering alone changes nothing: what it takes it gives,
 * but for what it would have to scatter again. */
TEST(an_even_sky_lights_mist_evenly) {
  OWNED(fixture, f) = {0};
  make("materials: glass.yaml\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
       "environment: {uniform: 3}\n"
       "medium: {scattering: 1.0e-3, g: 0.7, box: [[-1, -1, 0], [1, 1, 1]]}\n"
       "objects:\n- {name: far, shape: rectangle, width: 1.0e-3, height: 1.0e-3, reflectance: "
       "0.5}\n",
       &f);
  const abbe_environment_light light = {.environment = f.scene.environment};
  const double o[3] = {-0.9, 0.1, 0.5};
  abbe_air_ray ray = FIELDS(.geometry = &f.geometry, .haze = &f.media.haze, .d = {1, 0, 0},
                            .to = (float)(1.5 / f.geometry.unit), .step = 1);
  abbe_geometry_to_frame(&f.geometry, o, ray.o);
  uint64_t random = 1;
  uint32_t rays = 0;
  double sum = 0;
  for (int k = 0; k < 20000; k++) {
    double u[6];
    float rgb[3];
    for (int i = 0; i < 6; i++) u[i] = random_between(&random, 0, 1);
    abbe_air_light_surroundings(&ray, &light, u, rgb, &rays);
    sum += (double)rgb[1] / 20000;
  }
  assert_near(sum / (3 * 1e-3 * 1.5), 1, 0.02);
}
