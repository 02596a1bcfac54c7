/* Tables of haze against what the scene says, and places drawn on a way through it. */
#include "tests/scenes/scene_text.h"

#include "tests/random.h"
#include "validation/trace/transport/media.h"

enum { STEPS = 40 };

typedef struct fixture {
  abbe_scene scene;
  abbe_geometry geometry;
  abbe_media media;
  double lambda_nm[STEPS + 1];
} fixture;

static void make(const char *text, fixture *f) {
  f->scene = scene_of(text);
  OK(abbe_geometry_make(&f->scene, &f->geometry, &error));
  for (int k = 0; k <= STEPS; k++) f->lambda_nm[k] = 400 + 300.0 * k / STEPS;
  OK(abbe_media_make(&f->geometry, f->lambda_nm, STEPS, &f->media, &error));
}

static void fixture_free(fixture *f) {
  abbe_media_free(&f->media);
  abbe_geometry_free(&f->geometry);
  abbe_scene_free(&f->scene);
}

#define MIST(scattering, absorption)                                                               \
  "medium: {scattering: " scattering ", absorption: " absorption ", g: 0.4,\n"                     \
  "         box: [[-1, -2, -3], [1, 2, 3]]}\n"

TEST(tables_are_the_scene_s) {
  OWNED(fixture, f) = {0};
  make(CAMERA POINT_LIGHT MIST("[[400, 4], [700, 1]]", "0.5")
           FLOOR BALL("smoke") "- {name: cloudy, shape: sphere, radius: 0.02, material: grey, "
                               "medium: {scattering: 3, g: -0.2}}\n",
       &f);
  const abbe_haze *h = &f.media.haze;
  const double unit = f.geometry.unit;
  assert_true(abbe_haze_is(h) && h->air);
  assert_true(abbe_haze_scatters(h, -1) && abbe_haze_scatters(h, 1));
  assert_false(abbe_haze_scatters(h, 0));
  assert_true(abbe_haze_is_coloured(h, -1) && abbe_haze_is_coloured(h, 0));
  assert_false(abbe_haze_is_coloured(h, 1));
  for (uint32_t k = 0; k < STEPS; k += 13) {
    const double nm = f.lambda_nm[k] + 0.5 * 300 / STEPS;
    const double air = abbe_medium_scattering(f.scene.medium, nm);
    assert_near((double)abbe_haze_scattering(h, -1, k, 0.5f), air * unit, 1e-6 * unit);
    assert_near((double)abbe_haze_extinction(h, -1, k, 0.5f), (air + 0.5) * unit, 1e-6 * unit);
    assert_near((double)abbe_haze_extinction(h, 1, k, 0.5f), 13 * unit, 1e-5 * unit);
    assert_near((double)abbe_haze_extinction(h, 0, k, 0.5f),
                (double)abbe_media_attenuation(&f.media, 0, k, 0.5f), 1e-6 * unit);
  }
  for (double cosine = -1; cosine <= 1; cosine += 0.25) {
    assert_near((double)abbe_haze_phase(h, -1, (float)cosine), abbe_medium_phase(0.4, cosine),
                1e-6);
    assert_near((double)abbe_haze_phase(h, 1, (float)cosine), abbe_medium_phase(-0.2, cosine),
                1e-6);
  }
}

/* The part [*from, *to] of the line o + t d that is in a box. */
static bool clip(const double min[3], const double max[3], const double o[3], const double d[3],
                 double *from, double *to) {
  for (int k = 0; k < 3; k++) {
    if (d[k] == 0) {
      if (!(o[k] >= min[k] && o[k] <= max[k])) return false;
      continue;
    }
    const double a = (min[k] - o[k]) / d[k], b = (max[k] - o[k]) / d[k];
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
  }
  return *from < *to;
}

TEST(a_way_is_as_long_as_its_part_in_the_region) {
  FILLED(fixture, f, make(CAMERA POINT_LIGHT MIST("0.3", "0.2") FLOOR BALL("flat"), &f));
  const abbe_haze *h = &f.media.haze;
  uint64_t random = 9;
  for (int i = 0; i < 300; i++) {
    double o[3], d[3], from = 0, to = INFINITY, length = 0;
    float p[3], along[3];
    for (int k = 0; k < 3; k++) {
      o[k] = random_between(&random, -3, 3);
      d[k] = random_between(&random, -1, 1);
      length += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) along[k] = (float)(d[k] / sqrt(length));
    abbe_geometry_to_frame(&f.geometry, o, p);
    const bool some = clip(f.scene.medium->min, f.scene.medium->max, o, d, &from, &to);
    const double left = some ? exp(-0.5 * (to - from) * sqrt(length)) : 1;
    assert_near((double)abbe_haze_left(h, -1, p, along, 0, INFINITY, 3, 0.5f), left, 1e-4);
  }
}

/* Places as dense as they say, on thin and thick ways: their mean weight is the length. */
TEST(places_have_their_density) {
  static const float extinction[] = {0, 1e-4f, 0.3f, 4, 60};
  enum { PARTS = 100000 };
  for (size_t i = 0; i < sizeof extinction / sizeof *extinction; i++) {
    double length = 0, middle = 0;
    for (int k = 0; k < PARTS; k++) {
      float density;
      const float t = abbe_haze_place(extinction[i], 2, ((float)k + 0.5f) / PARTS, &density);
      assert_true(t >= 0 && t <= 2 && density > 0);
      if (extinction[i] > 10) continue; /* where hardly any go far in, weights are large there */
      length += 1 / (double)density / PARTS;
      middle += (double)t / (double)density / PARTS;
    }
    if (extinction[i] > 10) continue;
    assert_near(length, 2, 2e-3);
    assert_near(middle, 2, 3e-3); /* the integral of t over [0, 2] */
  }
}

/* Zeros are no haze, so that nothing changes by them. */
TEST(nothing_is_no_haze) {
  fixture f;
  make(CAMERA POINT_LIGHT MIST("0", "0") FLOOR BALL("smoke"), &f);
  assert_false(abbe_haze_is(&f.media.haze));
  float from = 0, to = 1;
  const float o[3] = {0}, d[3] = {0, 0, 1};
  assert_false(abbe_haze_clip(&f.media.haze, -1, o, d, &from, &to));
  assert_true(abbe_haze_left(&f.media.haze, -1, o, d, 0, 1, 0, 0) == 1);
  fixture_free(&f);
  abbe_haze_free(NULL);
}
