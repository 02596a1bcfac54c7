/* Rough faces, haze, films, crystals and glow in refractors: every watt is in the ledger, and in
 * even surroundings what is clear cannot be seen. */
#include "tests/validation/trace/walks/light_walks.h"

#include "base/maths.h"
#include "validation/trace/tracer/tracer.h"
#include "validation/trace/walks/eye_shading.h"

#define SCENE "camera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n" POINT_LIGHT FLOOR

static const char *const bodies[] = {
    "n-bk7, roughness: 0.3",
    "calcite, axis: [1, 0.3, 0.5], roughness: [{alpha: 1, faces: pavilion}]",
    "n-bk7, coating: {layers: [[1.38, 99.6]]}, roughness: 0.5",
    "n-bk7, medium: {scattering: 12, g: 0.5}",
    "calcite, axis: [1, 0.3, 0.5], medium: {scattering: [[400, 20], [700, 10]], g: -0.4}",
    "n-bk7, roughness: 0.2, medium: {scattering: 5}, clouds: [{centre: [0, 0, 0], radius: 0.03, "
    "medium: {scattering: 40, g: 0.9}}, {centre: [0.08, 0.05, 0], size: [0.05, 0.1, 0.04]}]",
};
enum { BODIES = sizeof bodies / sizeof *bodies };

static void count_known(void *user, const abbe_light_stretch *stretch) {
  size_t *count = user;
  count[stretch->known]++;
}

TEST(every_watt_is_in_the_ledger) {
  for (int i = 0; i < BODIES; i++) {
    FREED fixture *f = malloc(sizeof *f);
    make(printed(SCENE SLAB("%s"), bodies[i]), NULL, f);
    size_t count[2] = {0};
    abbe_light_walk_watch(f->walk, count_known, count);
    flood(f, 8);
    const abbe_light_ledger *l = &f->ledger;
    assert_near(l->deposited + l->absorbed + l->missed + l->lost, l->reached, 1e-5 * l->reached);
    assert_true(l->lost <= 1e-3 * l->reached);
    assert_true(l->scattered == 0);
    if (i == 1) /* all but what the table mirrors */
      assert_true(l->frosted > 0.9 * l->reached && l->frosted < 0.97 * l->reached);
    else if (i < 3)
      assert_near(l->frosted, l->reached, 1e-6 * l->reached);
    assert_true(i < 3 ? l->turned == 0 : l->turned > 0.2 * l->reached);
    /* all that comes in by a rough face is known from there on, else what haze has turned */
    assert_true((count[0] > 0) == (i == 1 || i == 3 || i == 4));
    assert_true((count[1] > 0) == (i != 1));
    assert_true(l->turned <= l->reached && l->frosted <= l->reached);
    fixture_free(f);
  }
}

enum { FACES = 39, TIMES = 5 };

static void count_held(void *user, const abbe_light_stretch *stretch) {
  size_t *held = user;
  for (uint32_t i = 0, faces = FACES; i < TIMES; i++, faces *= 4)
    held[i] += stretch->medium == 0 && stretch->steps == faces;
}

/* No face of a box of glass keeps what came in by another. One of quartz turns a little of it into
 * the other wave, which all faces may reflect totally, and that has to turn back: a walk at random,
 * of which after four times as many faces half is left. Nothing stays, for reflection can be
 * reversed: no more light can end in there than can begin. */
TEST(what_comes_into_a_smooth_crystal_leaves_it_again) {
  FREED fixture *f = malloc(sizeof *f);
  make(SCENE "- {name: stone, shape: box, size: [0.12, 0.1, 0.07], material: quartz, "
             "axis: [-0.1, 0.995, 0.021], transform: [{translate: [0, 0, 0.3]}]}\n",
       NULL, f);
  size_t held[TIMES] = {0};
  uint64_t random = 5;
  abbe_light_walk_watch(f->walk, count_held, held);
  for (uint32_t b = 0; b < (all_cases() ? 4000 : SANITIZED ? 60 : 1000); b++) {
    for (uint32_t i = 0; i < BATCH; i++) { /* evenly from all around */
      double d[3], across[3], from[3];
      random_unit(&random, d);
      random_unit(&random, across);
      const double along = abbe_vector_dot(across, d);
      const double away = 0.09 * sqrt(random_between(&random, 0, 1) / (1 - along * along));
      for (int k = 0; k < 3; k++)
        from[k] = (k == 2 ? 0.3 : 0) - d[k] + away * (across[k] - along * d[k]);
      f->photon[i] = photon_of(f, from, d, i);
    }
    abbe_light_walk_run(f->walk, NULL, b, f->photon, BATCH, f->hit, &f->ledger);
  }
  print_message("%.0f came, of which %zu, %zu, %zu, %zu, %zu met 39 faces and four times as many\n",
                f->ledger.reached, held[0], held[1], held[2], held[3], held[4]);
  assert_true((double)held[0] < 1e-3 * f->ledger.reached);
  for (int i = 0; i + 1 < TIMES; i++)
    assert_true(2 * (double)held[i + 1] <= (double)held[i] + 8 * sqrt((double)held[i]));
  assert_true(f->ledger.lost <= (double)held[TIMES - 1]); /* a photon is 1 W */
  fixture_free(f);
}

/* A turned path of the camera stands for the light of every wavelength around its own: on a length
 * in which e is lost and s of it turned all of them together are s / e (1 - exp(-e length)). */
TEST(turned_paths_weigh_the_wavelengths_around_their_own) {
  enum { DRAWS = 20000, BESIDE = ABBE_EYE_BEYOND };
  FREED fixture *f = malloc(sizeof *f);
  make(SCENE SLAB("ruby, axis: [1, 0.3, 0.5], medium: {scattering: [[500, 60], [600, 10]]}"), NULL,
       f);
  double lambda_nm[STEPS + 1];
  for (int k = 0; k <= STEPS; k++) lambda_nm[k] = 500 + 100.0 * k / STEPS;
  const abbe_spectral_sampling sampling = {.steps = STEPS, .lambda_nm = lambda_nm};
  const abbe_photon_grid grid = {0};
  const abbe_eye_walk walk = {.geometry = &f->geometry,
                              .media = &f->media,
                              .sampling = &sampling,
                              .grid = &grid,
                              .window_nm = 37.5};
  const abbe_eye_path path = {
      .d = {0.6f, 0, -0.8f}, .share = 1, .branch = 1, .dispersed = true, .step = 4, .inside = 1};
  const float length = 0.03f / (float)f->geometry.unit;
  double sum[BESIDE] = {0}, square[BESIDE] = {0};
  for (uint32_t i = 0; i < DRAWS; i++) {
    const abbe_eye_context c = {.w = &walk, .pass = i};
    abbe_eye_path own = path, turned;
    assert_true(abbe_eye_turn(&c, &own, length, &turned));
    for (int k = 0; k < BESIDE; k++) {
      const double light = (double)(turned.share * expf(-turned.beyond[k]));
      sum[k] += light / DRAWS;
      square[k] += light * light / DRAWS;
    }
  }
  for (int k = 0; k < BESIDE; k++) { /* a step apart */
    const uint32_t step = (uint32_t)(1 + k);
    const double s = (double)abbe_haze_scattering(&f->media.haze, 0, step, 0);
    const double e = (double)abbe_media_extinction(&f->media, 0, step, 0, path.d, 0);
    assert_true(e > 1.05 * s);
    assert_near(sum[k], -s / e * expm1(-e * (double)length),
                4 * sqrt((square[k] - sum[k] * sum[k]) / DRAWS) + 1e-6);
  }
  fixture_free(f);
}

/* ---- stones of every kind at random ---- */

static const char *const stones[][2] = {{"n-bk7", ""},
                                        {"diamond", ""},
                                        {"cubic-zirconia", ""},
                                        {"quartz", "axis"},
                                        {"calcite", "axis"},
                                        {"zircon", "axis"},
                                        {"ruby", "axis"},
                                        {"alexandrite", "axes"},
                                        {"sphene", "axes"},
                                        {"topaz", "axes"},
                                        {"tanzanite", "axes"},
                                        {"ruby-fluorescent", "axis"},
                                        {"diamond-fluorescent", ""}};
enum { STONES = sizeof stones / sizeof *stones };

static bool by_chance(uint64_t *random, double share) {
  return random_between(random, 0, 1) < share;
}

static void describe(uint64_t *random, char *out, size_t size) {
  const char *const *stone = stones[random_bits(random) % STONES];
  const char *const shapes[] = {
      "shape: sphere, radius: 0.08, levels: 4", "shape: box, size: [0.12, 0.1, 0.07]",
      "shape: gem, sides: 7, girdle: 0.08, table: 0.045, crown: 0.026, pavilion: 0.06"};
  const bool box = by_chance(random, 0.5);
  double x[3], z[3];
  random_unit(random, x);
  random_unit(random, z);
  size_t at = (size_t)snprintf(out, size, "%s, material: %s",
                               shapes[box ? 1 : random_bits(random) % 3], stone[0]);
#define MORE(...) at += (size_t)snprintf(out + at, size - at, __VA_ARGS__)
  if (strcmp(stone[1], "axis") == 0) MORE(", axis: [%g, %g, %g]", z[0], z[1], z[2]);
  if (strcmp(stone[1], "axes") == 0)
    MORE(", axes: {x: [%g, %g, %g], z: [%g, %g, %g]}", x[0], x[1], x[2], z[0], z[1], z[2]);
  if (by_chance(random, 0.4)) MORE(", roughness: %g", random_between(random, 0.01, 1));
  if (by_chance(random, 0.4))
    MORE(", coating: {layers: [[%g, %g], [%g, %g]]}", random_between(random, 1.3, 2.6),
         random_between(random, 10, 400), random_between(random, 1.3, 2.6),
         random_between(random, 10, 400));
  if (by_chance(random, 0.4))
    MORE(", medium: {scattering: %g, g: %g}", random_between(random, 1, 40),
         random_between(random, -0.8, 0.8));
  if (by_chance(random, 0.3))
    MORE(", clouds: [{radius: 0.02, medium: {scattering: %g, g: %g}}]",
         random_between(random, 1, 200), random_between(random, -0.8, 0.8));
#undef MORE
}

/* Where the light of some passes went, the picture's mean radiance and its standard error. */
static void follow(const abbe_scene *scene, const abbe_trace_desc *desc, abbe_light_ledger *ledger,
                   double *mean, double *standard_error) {
  enum { PASSES = 12 };
  double before = 0, square = 0;
  abbe_tracer *t = NULL;
  OK(abbe_tracer_make(scene, desc, &t, &error));
  *mean = 0;
  for (int p = 1; p <= PASSES; p++) {
    OK(abbe_tracer_pass(t, NULL, &error));
    OWNED(abbe_image, picture) = {0};
    OK(abbe_tracer_picture(t, &picture, &error));
    const size_t y = abbe_image_find_channel(&picture, "Y"), all = picture.width * picture.height;
    double sum = 0;
    for (size_t i = 0; i < all; i++) sum += (double)picture.data[i * picture.channels + y] / all;
    const double pass = p * sum - (p - 1) * before, off = pass - *mean;
    before = sum;
    *mean += off / p;
    square += off * (pass - *mean);
  }
  *standard_error = sqrt(square / (PASSES - 1) / PASSES);
  abbe_trace_statistics statistics;
  abbe_tracer_statistics(t, &statistics);
  *ledger = statistics.ledger;
  abbe_tracer_free(t);
}

/* By the light of the surroundings photons are followed, where something far off may show them. */
TEST(random_stones_close_their_ledger) {
  const int count = all_cases() ? 1000 : SANITIZED ? 2 : 8;
  uint64_t random = 46;
  double off = 0, weight = 0, worst = 0;
  for (int i = 0; i < count; i++) {
    char stone[1024];
    describe(&random, stone, sizeof stone);
    OWNED(abbe_scene, scene) = scene_of(printed(
        "camera: {eye: [0, -0.4, 0.15], target: [0, 0, 0], fov: 14}\n"
        "environment: {uniform: 1, illuminant: E, size: 64}\nobjects:\n- {name: stone, %s}\n"
        "- {name: far off, shape: rectangle, width: 0.1, height: 0.1, reflectance: 1.0e-9,\n"
        "   transform: [{translate: [0, 0, -5]}]}\n",
        stone));
    abbe_trace_desc desc = {.width = 6,
                            .height = 6,
                            .photons = 4096,
                            .no_map = true,
                            .threads = 1,
                            .seed = (uint32_t)i,
                            .space = ABBE_RGB_SPACE_XYZ};
    if (by_chance(&random, 0.3)) desc.polarisation = ABBE_TRACE_POLARISATION_ON;
    abbe_light_ledger l;
    double mean, standard_error, in;
    bool bounded = false;
    /* two of the few photons that leave late may be 1e-4 of all: more of them tell their mean */
    for (int more = 1; !bounded && more <= 16; more *= 16) {
      desc.photons *= (size_t)more;
      follow(&scene, &desc, &l, &mean, &standard_error);
      in = l.reached + l.glowing;
      /* a clear smooth box keeps for ever what glows outside of its six cones, 3 cos c - 2 at the
         critical angle c, and a ball cos c of what glows at its surface: in diamond 0.74 and 0.91
       */
      const double keeps = strstr(stone, "sphere") != NULL ? 0.92 : 0.75;
      bounded = l.lost <= 1e-4 * in + keeps * l.glowing;
    }
    const double out = l.deposited + l.absorbed + l.missed + l.lost + l.excited;
    const abbe_material *m = scene.object[0].material;
    const bool clear = m->attenuation == NULL && !abbe_material_is_fluorescent(m);
    const bool right = fabs(out - in) <= 1e-6 * in && bounded &&
                       (!clear || fabs(mean - 1) <= 12 * standard_error + 1e-3);
    if (!right)
      print_message(
          "stone %d: %s: ledger %.9f, lost %.2g of it, %.2g glowed, radiance %.5f +- %.5f%s\n", i,
          stone, out / in, l.lost / in, l.glowing / in, mean, standard_error,
          desc.polarisation ? ", polarised" : "");
    assert_true(right);
    worst = fmax(worst, fabs(out / in - 1));
    const double trust = 1 / (standard_error * standard_error + 1e-7);
    off += clear ? trust * (mean - 1) : 0;
    weight += clear ? trust : 0;
  }
  print_message("%d ledgers are off by %.1e at most\n", count, worst);
  assert_near(off / weight, 0, 5 / sqrt(weight) + 2e-4);
}
