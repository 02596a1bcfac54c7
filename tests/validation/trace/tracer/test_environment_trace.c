/* Light from everywhere in the tracer: laws that hold whatever stands in it. */
#include "tests/validation/trace_scene.h"

#include "base/maths.h"
#include "colorimetry/upsampling.h"
#include "scenes/view/view.h"
#include "validation/trace/transport/environment_light.h"

#define SPECK                                                                                      \
  "objects:\n- {name: speck, shape: rectangle, width: 0.05, height: 0.05, reflectance: 0.5}\n"

#define FAR_SPECK                                                                                  \
  "objects:\n- {name: speck, shape: rectangle, width: 1, height: 1, reflectance: 0.5, transform: " \
  "[{translate: [0, 40, -18]}]}\n"

typedef double (*radiance_of)(const double d[3]);

static double uniform(const double d[3]) {
  (void)d;
  return 2;
}

static double cosine_dome(const double d[3]) {
  return d[2] > 0 ? d[2] : 0;
}

static double half_sky(const double d[3]) {
  return d[0] > 0 ? 3 : 0.5;
}

static abbe_environment *surround(radiance_of radiance, size_t width) {
  abbe_environment *e = calloc(1, sizeof *e);
  OK(abbe_radiance_map_make(width, &e->map, &error));
  for (size_t y = 0; y < e->map.height; y++)
    for (size_t x = 0; x < e->map.width; x++) {
      double d[3];
      abbe_radiance_map_direction(&e->map, (double)x + 0.5, (double)y + 0.5, d);
      for (int k = 0; k < 3; k++)
        e->map.rgb[3 * (y * e->map.width + x) + (size_t)k] = (float)radiance(d);
    }
  abbe_environment_turn(0, NULL, 0, e->to_map);
  OK(abbe_illuminant_make("D65", &e->illuminant, &error));
  OK(abbe_environment_prepare(e, &error));
  return e;
}

/* The scene without its lamp, in that environment. */
typedef struct fixture {
  abbe_scene scene;
  size_t lamps;
  abbe_tracer *tracer;
} fixture;

static void make_fine(const char *text, radiance_of radiance, size_t width, fixture *f) {
  f->scene = scene_of(text);
  f->lamps = f->scene.light_count;
  f->scene.light_count = 0;
  f->scene.environment = surround(radiance, width);
}

static void make(const char *text, radiance_of radiance, fixture *f) {
  make_fine(text, radiance, 256, f);
}

static void trace(fixture *f, size_t photons, size_t passes, abbe_image *picture) {
  const abbe_trace_desc desc = {
      .no_map = true, .width = 48, .height = 48, .photons = photons, .threads = 2};
  f->tracer = make_tracer(&f->scene, &desc);
  run_passes(f->tracer, passes);
  OK(abbe_tracer_picture(f->tracer, picture, &error));
}

static void fixture_free(fixture *f) {
  abbe_tracer_free(f->tracer);
  f->scene.light_count = f->lamps;
  abbe_scene_free(&f->scene);
}

static double channel(const abbe_image *p, const char *name, size_t x, size_t y) {
  size_t at = abbe_image_find_channel(p, name);
  assert_true(at < p->channels);
  return (double)p->data[(y * p->width + x) * p->channels + at];
}

/* Of Rec.709 primaries; of a white, which all here is, in any space. */
static double luminance(const abbe_image *p, size_t x, size_t y) {
  return 0.2126 * channel(p, "R", x, y) + 0.7152 * channel(p, "G", x, y) +
         0.0722 * channel(p, "B", x, y);
}

/* Flux that a convex body meets is pi times its surface times the radiance. */
TEST(a_convex_body_meets_pi_times_its_surface) {
  static const struct {
    const char *body;
    double surface;
  } cases[] = {{BALL("crown"), 4 * 3.14159265358979 * 0.08 * 0.08},
               {"- {name: brick, shape: box, size: [0.2, 0.05, 0.1], transform: [{rotate: {axis: "
                "[1, 1, 0], angle: 20}}, {translate: [0, 0, 0.4]}], material: crown}\n",
                2 * (0.2 * 0.05 + 0.2 * 0.1 + 0.05 * 0.1)}};
  for (size_t i = 0; i < 2; i++) {
    FILLED(fixture, f,
           make(printed(CAMERA POINT_LIGHT FAR_SPECK "%s", cases[i].body), uniform, &f));
    FILLED(abbe_image, picture, trace(&f, 1 << 14, 32, &picture));
    abbe_trace_statistics s;
    abbe_tracer_statistics(f.tracer, &s);
    assert_near(s.ledger.reached / (ABBE_PI * 2 * cases[i].surface), 1, 2e-3);
  }
}

/* A photon goes to a body by its share of all their area, however small that is. */
TEST(photons_find_a_grain_beside_a_boulder) {
  static const double radius = 1e-4;
  OWNED(fixture, f) = {0};
  make(CAMERA POINT_LIGHT FAR_SPECK "- {name: boulder, shape: sphere, radius: 1, mirror: 1}\n"
                                    "- {name: grain, shape: sphere, radius: 1e-4, mirror: 1, "
                                    "transform: [{translate: [3, 0, 0]}]}\n",
       uniform, &f);
  const abbe_spectral_sampling_desc spectrum = {.min_nm = 380, .max_nm = 780, .uniform = 0.15};
  const abbe_bands none = {0};
  MADE(abbe_geometry, geometry, abbe_geometry_make(&f.scene, &geometry, &error));
  MADE(abbe_spectral_sampling, sampling,
       abbe_spectral_sampling_make(&f.scene, &spectrum, &sampling, &error));
  MADE(abbe_environment_light, light,
       abbe_environment_light_make(&geometry, &sampling, &none, ABBE_RGB_SPACE_ACESCG, &light,
                                   &error));
  const double grain[3] = {3, 0, 0}, share = radius * radius / (1 + radius * radius);
  float centre[3];
  abbe_geometry_to_frame(&geometry, grain, centre);
  for (int i = -20; i <= 20; i++) { /* the boulder's share comes first */
    const double u[6] = {0.3, 0.4, 0.5, 1 - share * (1 - (i + 0.5) * 0.04), 0.5, 0.5};
    float o[3], d[3], rgb[3], along = 0, off = 0;
    abbe_environment_light_ray(&light, u, o, d, rgb);
    for (int k = 0; k < 3; k++) along += (centre[k] - o[k]) * d[k];
    for (int k = 0; k < 3; k++) off += powf(centre[k] - o[k] - along * d[k], 2);
    assert_true((sqrtf(off) * (float)geometry.unit < 1.1e-4f) == (u[3] >= 1 - share));
  }
}

/* Through clear glass every ray ends in the same light: no pixel shows the glass. */
TEST(clear_glass_is_not_seen_in_uniform_light) {
  OWNED(fixture, f) = {0};
  make(CAMERA POINT_LIGHT FAR_SPECK "- {name: stone, shape: brilliant, diameter: 0.3, transform: "
                                    "[{translate: [0, 0, 0.2]}], material: crown}\n",
       uniform, &f);
  FILLED(abbe_image, picture, trace(&f, 1024, 8, &picture));
  double sum = 0;
  for (size_t y = 0; y < 48; y++)
    for (size_t x = 0; x < 48; x++) sum += luminance(&picture, x, y);
  assert_near(sum / (48 * 48) / 2, 1, 2e-3);
  /* where only sky shows it is exact */
  assert_near(luminance(&picture, 1, 1), 2, 1e-3);
}

/* What it covers alone is in a transparent picture, and what is behind it through it. */
TEST(a_transparent_picture_is_premultiplied) {
  OWNED(fixture, f) = {0};
  make("materials: glass.yaml\ncamera: {frame: [stone], fov: 30}\n" POINT_LIGHT "objects:\n"
       "- {name: grain, shape: rectangle, width: 0.01, height: 0.01, reflectance: 0.5,\n"
       "   centre: [0, 2.5, -4.33]}\n"
       "- {name: stone, shape: brilliant, diameter: 0.3, material: crown}\n",
       uniform, &f);
  f.scene.transparent = true;
  FILLED(abbe_image, picture, trace(&f, 1024, 16, &picture));
  MADE(abbe_image, alpha, abbe_coverage_make(&f.scene, 48, 48, 8, &alpha, &error));
  double sum = 0, covered = 0;
  for (size_t y = 0; y < 48; y++)
    for (size_t x = 0; x < 48; x++) {
      const double a = (double)alpha.data[y * 48 + x];
      sum += luminance(&picture, x, y);
      covered += a;
    }
  assert_near(luminance(&picture, 1, 1), 0, 0);
  assert_true(covered > 100);
  assert_near(sum / covered / 2, 1, 1e-2);
}

TEST(a_whole_mirror_is_not_seen_in_uniform_light) {
  OWNED(fixture, f) = {0};
  make(CAMERA POINT_LIGHT FAR_SPECK
       "- {name: ring, shape: ring, major: 0.15, minor: 0.05, around: 32, across: 16, transform: "
       "[{translate: [0, 0, 0.1]}], mirror: 1}\n",
       uniform, &f);
  FILLED(abbe_image, picture, trace(&f, 1024, 4, &picture));
  for (size_t y = 0; y < 48; y++)
    for (size_t x = 0; x < 48; x++) assert_near(luminance(&picture, x, y), 2, 2e-3);
}

static void check_floor(radiance_of radiance, double irradiance) {
  FILLED(fixture, f, make(CAMERA POINT_LIGHT FLOOR, radiance, &f));
  FILLED(abbe_image, picture, trace(&f, 1024, 16, &picture));
  double sum = 0;
  for (size_t y = 24; y < 48; y++)
    for (size_t x = 0; x < 48; x++) sum += luminance(&picture, x, y) / (24 * 48);
  assert_near(sum / (0.5 * irradiance / ABBE_PI), 1, 5e-3);
}

TEST(an_open_floor_has_its_irradiance) {
  check_floor(uniform, 2 * ABBE_PI);
  check_floor(cosine_dome, 2 * ABBE_PI / 3);
  check_floor(half_sky, 0.5 * ABBE_PI * (3 + 0.5));
}

/* However many texels are drawn from, the light on an open floor is theirs: within four standard
 * errors of its mean, as the passes tell them. `abbe validate` has as many as a map may have. */
TEST(light_does_not_depend_on_how_many_texels_there_are) {
  enum { PASSES = 64 };
  static const size_t widths[] = {64, 1024, 2048};
  for (size_t w = 0; w < (SANITIZED ? 2 : 3); w++) {
    double sum = 0, square = 0, before = 0;
    FILLED(fixture, f, make_fine(CAMERA POINT_LIGHT FLOOR, uniform, widths[w], &f));
    const abbe_trace_desc desc = {
        .no_map = true, .width = 48, .height = 48, .photons = 256, .threads = 2};
    f.tracer = make_tracer(&f.scene, &desc);
    for (size_t p = 1; p <= PASSES; p++) {
      double so_far = 0;
      run_passes(f.tracer, 1);
      MADE(abbe_image, picture, abbe_tracer_picture(f.tracer, &picture, &error));
      for (size_t y = 24; y < 48; y++)
        for (size_t x = 0; x < 48; x++) so_far += luminance(&picture, x, y) / (24 * 48);
      const double one = (double)p * so_far - before;
      before = (double)p * so_far;
      sum += one / PASSES;
      square += one * one / PASSES;
    }
    const double error = sqrt((square - sum * sum) / (PASSES - 1));
    print_message("%zu texels: %.5f of the light, standard error %.5f\n", widths[w], sum, error);
    assert_true(error < 1e-3);
    assert_near(sum, 1, 4 * error + 1e-4);
  }
}

static double beam;

static double from_below(const double d[3]) {
  return d[2] < -0.99 ? beam : 0;
}

/* A floor in ambient light above a light that reaches no pixel, however bright that is. */
TEST(what_is_not_seen_takes_nothing_away) {
  for (int power = 0; power <= 12; power += 3) {
    OWNED(fixture, f) = {0};
    beam = pow(10, power);
    make_fine("materials: glass.yaml\nambient: 0.15\ncamera: {eye: [0, 0, 1], target: [0, 0, 0], "
              "up: [0, 1, 0], fov: 20}\n" POINT_LIGHT FLOOR,
              from_below, 64, &f);
    FILLED(abbe_image, picture, trace(&f, 256, 2, &picture));
    for (size_t x = 0; x < 48; x++) {
      assert_near(luminance(&picture, x, 20), 0.15 * 0.5 / ABBE_PI, 1e-6);
      assert_near(channel(&picture, "stderr.G", x, 20), 0, 1e-6);
    }
  }
}

/* What no sums can hold together is told. */
TEST(lights_too_far_apart_are_told) {
  OWNED(fixture, f) = {0};
  abbe_trace_statistics s;
  beam = 1e12;
  make_fine("materials: glass.yaml\nambient: 1e-9\ncamera: {eye: [0, 0, 1], target: [0, 0, 0], up: "
            "[0, 1, 0]}\n" POINT_LIGHT FLOOR,
            from_below, 64, &f);
  FILLED(abbe_image, picture, trace(&f, 256, 1, &picture));
  abbe_tracer_statistics(f.tracer, &s);
  assert_true(s.faintest < ABBE_TRACER_FAINTEST);
  assert_near(s.faintest * f.scene.environment->luminance / 1e-9, 1, 1e-12);
}

/* A stone over a black table is seen, and no photon is followed for it; few are where a table lies
 * far off, and all where they fall on one that reflects a little. */
TEST(photons_are_for_what_shows_them) {
  static const struct {
    const char *reflectance, *place;
    uint64_t least, most;
  } cases[] = {{"0", "0, 0, 0", 0, 0},
               {"0.5", "0, 40, -18", 1, 100000},
               {"0.001", "0, 0, 0", 999990, 1000000}};
  for (size_t i = 0; i < 3; i++) {
    FILLED(fixture, f,
           make(printed(CAMERA POINT_LIGHT
                        "objects:\n- {name: stone, shape: brilliant, diameter: 0.3, "
                        "transform: [{translate: [0, 0, 0.2]}], material: crown}\n"
                        "- {name: table, shape: rectangle, width: 1, height: 1, "
                        "reflectance: %s, transform: [{translate: [%s]}]}\n",
                        cases[i].reflectance, cases[i].place),
                uniform, &f));
    FILLED(abbe_image, picture, trace(&f, 500000, 2, &picture));
    abbe_trace_statistics s;
    abbe_tracer_statistics(f.tracer, &s);
    print_message("%llu photons of 1000000\n", (unsigned long long)s.photons);
    assert_true(s.photons >= cases[i].least && s.photons <= cases[i].most);
    if (i == 1) {
      double sum = 0;
      for (size_t y = 0; y < 48; y++)
        for (size_t x = 0; x < 48; x++) sum += luminance(&picture, x, y) / (48 * 48);
      assert_near(sum, 2, 5e-3);
    }
  }
}

/* What a clear ball takes from the speck below it, it brings back: as much light falls on it. */
TEST(a_clear_ball_takes_nothing_away) {
  OWNED(fixture, f) = {0};
  make(CAMERA POINT_LIGHT SPECK "- {name: ball, shape: sphere, radius: 0.08, levels: 2, transform: "
                                "[{translate: [0, 0, 0.1]}], material: crown}\n",
       uniform, &f);
  const double eye[3] = {0, -0.3, 0.06}, target[3] = {0, 0, 0};
  memcpy(f.scene.camera.eye, eye, sizeof eye);
  memcpy(f.scene.camera.target, target, sizeof target);
  f.scene.camera.fov_y_rad = 3.0 * ABBE_PI / 180;
  FILLED(abbe_image, picture, trace(&f, 1 << 19, 8, &picture));
  double sum = 0, caustic = 0;
  for (size_t y = 22; y < 26; y++)
    for (size_t x = 12; x < 36; x++) {
      sum += luminance(&picture, x, y) / (4 * 24);
      caustic += channel(&picture, "caustic.G", x, y) / (4 * 24);
    }
  assert_true(caustic > 0.3); /* of 1 */
  assert_near(sum, 1, 1.5e-2);
}

static double turned(const double d[3]) { /* half_sky, by 90 degrees about z */
  return d[1] > 0 ? 3 : 0.5;
}

static double doubled(const double d[3]) {
  return 2 * half_sky(d);
}

static void draw_stone(const char *angle, const double eye[3], radiance_of radiance,
                       abbe_image *out) {
  FILLED(
      fixture, f,
      make(
          printed(
              CAMERA POINT_LIGHT FLOOR
              "- {name: stone, shape: brilliant, diameter: 0.3, transform: [{rotate: {axis: [0, 0, "
              "1], angle: %s}}, {translate: [0, 0, 0.2]}], material: crown}\n",
              angle),
          radiance, &f));
  memcpy(f.scene.camera.eye, eye, 3 * sizeof *eye);
  f.scene.camera.target[0] = f.scene.camera.target[1] = 0;
  trace(&f, 4096, SANITIZED ? 6 : 24, out);
}

/* Squares of the differences, over what the standard errors of both say. */
static double chi_square(const abbe_image *a, const abbe_image *b, double factor) {
  double sum = 0;
  for (size_t y = 0; y < 48; y++)
    for (size_t x = 0; x < 48; x++) {
      const double d = factor * channel(a, "G", x, y) - channel(b, "G", x, y);
      const double sigma =
          hypot(factor * channel(a, "stderr.G", x, y), channel(b, "stderr.G", x, y));
      sum += d * d / (sigma * sigma + 1e-6) / (48 * 48);
    }
  return sum;
}

TEST(turning_all_changes_nothing) {
  static const double eye[3] = {0.2, -1, 0.5}, eye_turned[3] = {1, 0.2, 0.5};
  OWNED(abbe_image, here) = {0}, there = {0}, left = {0};
  draw_stone("0", eye, half_sky, &here);
  draw_stone("90", eye_turned, turned, &there);
  draw_stone("90", eye_turned, half_sky, &left);
  print_message("chi square a pixel: %.2f turned, %.2f with the environment left\n",
                chi_square(&here, &there, 1), chi_square(&here, &left, 1));
  assert_true(chi_square(&here, &there, 1) < 1.5);
  assert_true(chi_square(&here, &left, 1) > 5);
}

/* The same paths, of twice the light. */
TEST(light_is_linear) {
  static const double eye[3] = {0.2, -1, 0.5};
  FILLED(abbe_image, once, draw_stone("0", eye, half_sky, &once));
  FILLED(abbe_image, twice, draw_stone("0", eye, doubled, &twice));
  for (size_t y = 0; y < 48; y++)
    for (size_t x = 0; x < 48; x++)
      assert_near(channel(&twice, "G", x, y), 2 * channel(&once, "G", x, y),
                  1e-3 * channel(&once, "G", x, y) + 1e-4);
}

/* In the shipped scenes of surroundings and mirrors no light is made or lost. */
TEST(the_ledger_closes) {
  static const char *const names[] = {"metal-ring", "metal-ball",   "spoon",         "metals",
                                      "octahedra",  "glass-studio", "diamond-studio"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i += SANITIZED ? 3 : 1) {
    OWNED(abbe_scene, scene) = shipped_scene(names[i]);
    const abbe_trace_desc desc = {
        .no_map = true, .width = 4, .height = 4, .photons = 30000, .threads = 2};
    HELD(abbe_tracer, tracer) = make_tracer(&scene, &desc);
    run_passes(tracer, 1);
    abbe_trace_statistics s;
    abbe_tracer_statistics(tracer, &s);
    const abbe_light_ledger *l = &s.ledger;
    const double all = l->deposited + l->missed + l->absorbed + l->trapped + l->lost + l->scattered;
    print_message("%s: open by %.2g, %.2g lost\n", names[i], all / l->reached - 1,
                  l->lost / l->reached);
    assert_true(l->reached > 0);
    assert_near(all / l->reached, 1, 1e-4);
    assert_true(l->lost < 1e-4 * l->reached);
  }
}
