#include "validation/measure/gem/gem_judgement.h"

#include "tests/validation/measure/gem/gem_stones.h"
#include "validation/measure/gem/gem_light.h"

static abbe_gem_tilts tilts_of(const judged *j, const abbe_gem_tilts_desc *desc) {
  abbe_gem_tilts tilts;
  OK(abbe_gem_tilts_make(&j->stone, &j->weights, desc, &tilts, &error));
  return tilts;
}

static const abbe_gem_tilts_desc few = {
    .head_rad = 15 * DEG, .steps = 2, .side = SANITIZED ? 8 : 16, .repeats = 6, .threads = 2};

/* A brilliant of one index, and what few rays tell of it. */
static judged brilliant;
static abbe_gem_tilts brilliant_tilts;

static void make_brilliant(void) {
  brilliant = judged_plain(design_b, 2.417);
  brilliant_tilts = tilts_of(&brilliant, &few);
}

static void free_brilliant(void) {
  abbe_gem_tilts_free(&brilliant_tilts);
  judged_free(&brilliant);
}

static double apart(abbe_gem_number a, abbe_gem_number b) {
  return fabs(a.value - b.value) / (hypot(a.error, b.error) + 1e-9);
}

GROUP(make_brilliant, free_brilliant);

/* What is even at all tilts has no spread, and a plate without dispersion no fire. */
TEST(curves_agree_with_views) {
  const judged j = brilliant;
  const abbe_gem_tilts t = brilliant_tilts;
  assert_int_equal(t.tilts, 5);
  assert_near(t.tilt_rad[0], -30 * DEG, 1e-12);
  assert_near(t.tilt_rad[2], 0, 1e-12);
  for (size_t i = 0; i < 5; i += 2) {
    const abbe_gem_view_desc desc =
        FIELDS(.axis_rad = 45 * DEG, .tilt_rad = t.tilt_rad[i], .head_rad = 15 * DEG,
               .side = SANITIZED ? 32 : 96, .repeats = 4);
    OWNED(abbe_gem_view, v) = judged_view(&j, &desc);
    assert_true(apart(abbe_gem_view_amount(&v, ABBE_GEM_ISO), t.curve[ABBE_GEM_TILT_ISO][5 + i]) <
                5);
    assert_true(apart(abbe_gem_view_amount(&v, ABBE_GEM_DOWN), t.curve[ABBE_GEM_TILT_DOWN][5 + i]) <
                5);
  }
  for (size_t i = 0; i < 20; i++) {
    assert_true(t.curve[ABBE_GEM_TILT_COS][i].value <= t.curve[ABBE_GEM_TILT_ISO][i].value);
    assert_near(t.curve[ABBE_GEM_TILT_FIRE][i].value, 0, 0); /* of one wavelength */
  }
}

TEST(level_and_mirrored_tilts_are_the_same) {
  const abbe_gem_tilts t = brilliant_tilts;
  for (int c = 0; c < ABBE_GEM_TILT_CURVE_COUNT; c++)
    for (size_t a = 0; a < ABBE_GEM_AXES; a++) {
      /* the same rays where it lies level, but for rounding in the axis */
      assert_near(t.curve[c][a * 5 + 2].value, t.curve[c][2].value, 1e-3);
      for (size_t k = 0; k < 2; k++)
        assert_true(apart(t.curve[c][a * 5 + k], t.curve[c][a * 5 + 4 - k]) < 6);
    }
}

static abbe_material coloured(double dispersion) {
  static char name[] = "coloured";
  /* Cauchy: n and its fall from violet to red */
  return (abbe_material){.name = name,
                         .dispersion = {.model = ABBE_DISPERSION_CAUCHY,
                                        .count = 2,
                                        .c = {2.417 - dispersion / 0.35, dispersion}},
                         .min_nm = 300,
                         .max_nm = 800};
}

TEST(fire_comes_with_dispersion) {
  static const double dispersion[] = {0, 0.003, 0.013};
  double fire[3];
  for (int i = 0; i < 3; i++) {
    const abbe_material m = coloured(dispersion[i]);
    OWNED(judged, j) = judged_make(design_b, &m, 9);
    abbe_gem_tilts_desc desc = few;
    desc.steps = 1;
    OWNED(abbe_gem_tilts, t) = tilts_of(&j, &desc);
    fire[i] = t.mean[ABBE_GEM_TILT_FIRE].value;
    assert_true(t.blinks.value > 0 && t.blinks.value < 1);
    assert_true(t.blinks.error > 0 && t.mean[ABBE_GEM_TILT_ISO].error > 0);
  }
  assert_near(fire[0], 0, 0);
  assert_true(fire[1] > 0.005 && fire[2] > 1.5 * fire[1]);
}

/* The roof sends light back from where it came at all tilts about its ridge's cross: the head
 * alone, where no lamp is. */
TEST(nothing_blinks_in_a_stone_that_shows_the_head) {
  char text[256];
  roof_text(45, text);
  OWNED(judged, j) = judged_plain(text, 1.6);
  abbe_gem_tilts_desc desc = few;
  desc.most_rad = 1e-9;
  desc.steps = 1;
  OWNED(abbe_gem_tilts, t) = tilts_of(&j, &desc);
  assert_near(t.blinks.value, 0, 0);
  assert_near(t.mean[ABBE_GEM_TILT_RETURN].value, 0, 1e-6);
  assert_near(t.spread.value, 0, 1e-6);
}

TEST(lamps_cover_what_their_sizes_say) {
  const abbe_gem_eye eye = abbe_gem_eye_make(0.3, 0.4);
  double expected = 0, met = 0;
  const abbe_gem_lamps lamps = abbe_gem_lamps_make(&eye, 3, 0);
  for (int i = 0; i < ABBE_GEM_LAMPS; i++) {
    expected += (1 - (double)lamps.cos_radius[i]) / 2; /* of all directions */
    assert_true(lamps.x[i] * (float)eye.to_eye[0] + lamps.y[i] * (float)eye.to_eye[1] +
                    lamps.z[i] * (float)eye.to_eye[2] >
                0);
  }
  static abbe_gem_path path;
  enum { MANY = 200000 };
  for (int i = 0; i < MANY; i++) {
    const double z = 1 - 2 * (i + 0.5) / MANY, r = sqrt(1 - z * z), a = i * 2.399963229728653;
    path.count = 1;
    path.exit[0] =
        (abbe_gem_exit){{(float)(r * cos(a)), (float)(r * sin(a)), (float)z}, 1.0f / MANY};
    met += (double)abbe_gem_lamps_light(&lamps, &path);
  }
  assert_near(met, expected, 0.03 * expected); /* some overlap */
}

TEST(threads_change_nothing) {
  const judged j = brilliant;
  abbe_gem_tilts_desc desc = few;
  desc.side = 8;
  desc.repeats = 2;
  desc.threads = 1;
  OWNED(abbe_gem_tilts, one) = tilts_of(&j, &desc);
  desc.threads = 5;
  OWNED(abbe_gem_tilts, five) = tilts_of(&j, &desc);
  assert_memory_equal(one.mean, five.mean, sizeof one.mean);
  assert_memory_equal(&one.blinks, &five.blinks, sizeof one.blinks);
  for (int c = 0; c < ABBE_GEM_TILT_CURVE_COUNT; c++)
    assert_memory_equal(one.curve[c], five.curve[c], 20 * sizeof *one.curve[c]);
}

static bool give_up(void *user, double done) {
  *(double *)user = done;
  return false;
}

TEST(work_can_be_given_up_and_wrong_requests_are_refused) {
  const judged j = brilliant;
  abbe_gem_tilts_desc desc = few;
  double done = 0;
  desc.progress = give_up;
  desc.user = &done;
  desc.threads = 1;
  abbe_gem_tilts t;
  REFUSED(ABBE_CANCELLED, "s tilts were given up",
          abbe_gem_tilts_make(&j.stone, &j.weights, &desc, &t, &error));
  assert_near(done, 1.0 / 20, 1e-12);
  static const abbe_gem_tilts_desc wrong[] = {
      {.most_rad = 2}, {.most_rad = -1}, {.steps = 91}, {.repeats = 1}, {.head_rad = 0.8}};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_gem_tilts_make(&j.stone, &j.weights, &wrong[i], &t, &error));
}
