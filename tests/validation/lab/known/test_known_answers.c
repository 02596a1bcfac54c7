/* The table of known answers: every row passes, and a wrong one would not. */
#include "tests/check.h"

#include "validation/lab/known/known_light.h"

static abbe_known_answers make(const char *only) {
  abbe_known_answers answers;
  const abbe_known_options options = {.only = only};
  OK(abbe_known_answers_make(&options, &answers, &error));
  return answers;
}

static void check_rows(const abbe_known_answers *a) {
  for (size_t i = 0; i < a->count; i++) {
    const abbe_known_answer *r = &a->row[i];
    if (!r->passed)
      print_error("%s: %s: %.12g, not %.12g within %g\n", r->group, r->quantity, r->traced,
                  r->exact, r->tolerance);
    assert_true(isfinite(r->exact) && isfinite(r->traced));
    assert_true(strlen(r->reason) > 10 && strlen(r->unit) > 0);
    assert_true(strlen(r->quantity) + 1 < sizeof r->quantity);
  }
  assert_int_equal(abbe_known_answers_failed(a), 0);
}

static const abbe_known_answer *find(const abbe_known_answers *a, const char *quantity) {
  for (size_t i = 0; i < a->count; i++)
    if (strcmp(a->row[i].quantity, quantity) == 0) return &a->row[i];
  fail_msg("no row '%s'", quantity);
  return NULL;
}

TEST(single_rays_meet_the_closed_forms) {
  static const struct {
    const char *group;
    size_t rows;
  } groups[] = {{"prism", 13},   {"slit", 8},  {"ball", 10},    {"nest", 7},    {"slab", 7},
                {"fresnel", 14}, {"film", 33}, {"crystal", 22}, {"rainbow", 6}, {"derive", 33}};
  for (size_t g = 0; g < sizeof groups / sizeof *groups; g++) {
    OWNED(abbe_known_answers, a) = make(groups[g].group);
    check_rows(&a);
    assert_int_equal(a.count, groups[g].rows);
    for (size_t i = 0; i < a.count; i++) assert_string_equal(a.row[i].group, groups[g].group);
  }
}

/* The exact column itself against what others print. */
TEST(the_exact_column_is_the_books) {
  OWNED(abbe_known_answers, a) = make("prism");
  assert_near(find(&a, "n-bk7 at d, least deviation")->exact, 38.65, 5e-3);
  assert_near(find(&a, "diamond at d, rays that leave the second face")->exact, 0, 0);
  abbe_known_answers_free(&a);
  a = make("rainbow");
  assert_near(find(&a, "water, primary bow at 700 nm, from the antisolar point")->exact, 42.4, 0.1);
  assert_near(find(&a, "water, secondary bow at 700 nm, from the antisolar point")->exact, 50.3,
              0.1);
  abbe_known_answers_free(&a);
  a = make("crystal");
  assert_near(find(&a, "calcite, axis at 45 degrees, between its rays")->exact, 6.2, 0.05);
  abbe_known_answers_free(&a);
  a = make("film");
  assert_near(find(&a, "MgF2 on crown, 99.64 nm, reflected at 0 degrees, 550 nm")->exact, 0.0126008,
              5e-8);
  assert_near(find(&a, "0.42 + 2.4i on topaz, inside, 10 nm, passed at 0 degrees, 550 nm")->exact,
              0.7295517, 5e-8);
  abbe_known_answers_free(&a);
  a = make("fresnel");
  assert_near(find(&a, "diamond, critical angle at d")->exact, 24.43, 0.01);
}

TEST(wrong_rows_fail) {
  const abbe_known_options options = {0};
  OWNED(abbe_known_answers, a) = {0};
  abbe_known_run run = {.options = &options, .out = &a, .group = "none", .to = 1};
  const struct {
    double exact, traced, tolerance;
    bool passes;
  } rows[] = {{1, 1.1, 0.2, true}, {1, 1.3, 0.2, false}, {1, 0.7, 0.2, false}, {1, NAN, 9, false},
              {NAN, 1, 9, false},  {1, 1, 0, true},      {1, 2, NAN, false}};
  for (int i = 0; i < 7; i++) {
    abbe_known_answer row =
        FIELDS(.exact = rows[i].exact, .traced = rows[i].traced, .tolerance = rows[i].tolerance,
               .unit = "1", .reason = "made up");
    OK(abbe_known_add(&run, row, &error));
    assert_int_equal(a.row[i].passed, rows[i].passes);
  }
  assert_int_equal(a.count, 7);
  assert_int_equal(abbe_known_answers_failed(&a), 5);
}

TEST(unknown_groups_are_named) {
  abbe_known_answers a;
  const abbe_known_options options = {.only = "prisn"};
  REFUSED(ABBE_NOT_FOUND, "did you mean 'prism'", abbe_known_answers_make(&options, &a, &error));
  assert_null(a.row);
}

typedef struct listener {
  int calls;
  double last;
} listener;

static bool stop_soon(void *user, double done) {
  listener *l = user;
  assert_true(done >= l->last && done <= 1);
  l->last = done;
  return ++l->calls < 2;
}

TEST(work_can_be_stopped) {
  abbe_known_answers a;
  listener l = {0};
  const abbe_known_options options = {.progress = stop_soon, .user = &l};
  REFUSED(ABBE_CANCELLED, "", abbe_known_answers_make(&options, &a, &error));
  assert_int_equal(l.calls, 2);
  assert_null(a.row);
}

static double parabola(double x, void *user) {
  return (x - *(double *)user) * (x - *(double *)user) - 3;
}

static double nowhere(double x, void *user) {
  (void)user;
  return x > 0.4 ? NAN : x;
}

TEST(the_least_value_is_found) {
  for (double at = -0.9; at < 1; at += 0.3)
    assert_near(abbe_known_least(parabola, &at, -1, 1), -3, 1e-14);
  assert_true(isnan(abbe_known_least(nowhere, NULL, 0, 1)));
  const double a[3] = {1, 0, 0}, b[3] = {2e-9, 3, 0}, c[3] = {5, 5e-9, 0};
  assert_near(abbe_known_angle(a, b), acos(-1) / 2 - 2e-9 / 3, 1e-15);
  assert_near(abbe_known_angle(a, c), 1e-9, 1e-20);
}
