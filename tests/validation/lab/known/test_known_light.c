/* The known answers that whole runs are held to, with few photons; `abbe validate` has many. */
#include "tests/check.h"

#include "validation/lab/known/known_light.h"

static const abbe_known_options few = {.samples = 1 << 15, .threads = 1};

/* Every row is within what its own noise allows, whether or not that is narrow enough to pass. */
static void check_rows(abbe_known_answers *a, size_t rows) {
  assert_int_equal(a->count, rows);
  for (size_t i = 0; i < a->count; i++) {
    const abbe_known_answer *r = &a->row[i];
    if (!(fabs(r->error) <= r->tolerance && r->tolerance < 0.2 * fabs(r->exact)))
      fail_msg("%s: %s: %.9g, not %.9g within %g", r->group, r->quantity, r->traced, r->exact,
               r->tolerance);
    assert_int_equal(r->passed, r->tolerance <= r->useful);
  }
  abbe_known_answers_free(a);
}

static abbe_result make_picture(abbe_known_run *run, size_t index, bool other, abbe_error *error) {
  (void)other;
  return abbe_known_picture_setting(run, index, error);
}

typedef abbe_result (*setting_maker)(abbe_known_run *run, size_t index, bool other,
                                     abbe_error *error);

static void check_setting(setting_maker make, size_t index, bool other, size_t rows) {
  abbe_known_answers a = {0};
  abbe_known_run run = {.options = &few, .out = &a, .group = "group", .to = 1};
  OK(make(&run, index, other, &error));
  check_rows(&a, rows);
}

TEST(panes_reflect_pass_and_absorb) {
  check_setting(abbe_known_pane_setting, 3, false, 1);  /* reflected at 60 degrees */
  check_setting(abbe_known_pane_setting, 11, false, 1); /* of a crystal */
  check_setting(abbe_known_pane_setting, 13, false, 1); /* under a film */
  check_setting(abbe_known_pane_setting, 3, true, 1);   /* what absorbing glass leaves, aslant */
}

TEST(spheres_throw_rings) {
  check_setting(abbe_known_sphere_setting, 3, false, 5);  /* a point's light, silica */
  check_setting(abbe_known_sphere_setting, 18, false, 5); /* two faces only */
}

TEST(settings_end) {
  static const struct {
    setting_maker make;
    size_t index;
    bool other;
  } beyond[] = {{abbe_known_sphere_setting, 20, false},
                {abbe_known_sphere_setting, 3, true},
                {abbe_known_pane_setting, 14, false},
                {abbe_known_pane_setting, 7, true},
                {make_picture, 3, false}};
  for (int i = 0; i < 5; i++) {
    abbe_known_answers a = {0};
    abbe_known_run run = {.options = &few, .out = &a, .group = "group", .to = 1};
    assert_int_equal(beyond[i].make(&run, beyond[i].index, beyond[i].other, NULL),
                     ABBE_INVALID_ARGUMENT);
    assert_int_equal(a.count, 0);
  }
}

/* t of 9 degrees of freedom: 4.297 at 1e-3 one-sided; four of a normal is 3.17e-5. */
TEST(few_passes_are_trusted_less) {
  assert_near(abbe_known_sigmas(1000000), 4, 1e-3);
  assert_true(abbe_known_sigmas(10) > 4.297);
  assert_true(abbe_known_sigmas(10) > abbe_known_sigmas(64));
  assert_true(isinf(abbe_known_sigmas(1)));
}

TEST(means_and_their_errors) {
  double sum[4][3] = {{0, 1, 0}, {0, 10, 0}, {0, 3, 0}, {0, 20, 0}}; /* two passes of two rings */
  double mean, spread;
  abbe_known_mean(sum, 2, 2, 0, 1, 1, &mean, &spread);
  assert_near(mean, 2, 1e-15);
  assert_near(spread, 1, 1e-15); /* sqrt(2 / 1 / 2) */
  abbe_known_mean(sum, 2, 2, 0, 2, 1, &mean, &spread);
  assert_near(mean, 17, 1e-14);
  assert_near(spread, 6, 1e-14);
  abbe_known_mean(sum, 1, 2, 0, 2, 1, &mean, &spread);
  assert_true(isinf(spread));
}

TEST(samples_become_passes) {
  abbe_known_options options = {.seed = 9, .threads = 3};
  abbe_known_run run = {.options = &options};
  abbe_trace_desc desc = {0};
  assert_int_equal(abbe_known_passes(&run, 1 << 20, &desc), 64);
  assert_int_equal(desc.photons, 1 << 14);
  assert_int_equal(desc.seed, 9);
  assert_int_equal(desc.threads, 3);
  options.samples = (uint64_t)1 << 36; /* more than passes of the largest size hold */
  assert_int_equal(abbe_known_passes(&run, 1 << 20, &desc) * desc.photons, options.samples);
  assert_true(desc.photons <= ABBE_TRACER_MAX_PHOTONS);
  abbe_known_narrow(500, &desc);
  assert_true(desc.min_nm < 500 && desc.max_nm > 500 && desc.max_nm - desc.min_nm < 0.2);
}
