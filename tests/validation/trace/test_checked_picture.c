/* A picture of another make against traced passes: how many of them, and which of the two is known
 * to keep the bound.
 */
#include "tests/check.h"

#include "tests/validation/trace_scene.h"
#include "validation/trace/checked_picture.h"

#define SCENE CAMERA POINT_LIGHT FLOOR BEADS("crown")

static abbe_scene scene;

static const abbe_trace_desc trace = {
    .no_map = true, .width = 24, .height = 24, .photons = 1024, .seed = 3};

/* After so many passes, of another seed. */
static abbe_image make_picture(size_t passes) {
  abbe_trace_desc own = trace;
  own.seed = 17;
  return traced_picture(&scene, &own, passes);
}

static abbe_checked_picture check(const abbe_image *picture, double max_error, abbe_image *traced) {
  abbe_checked_picture out;
  const abbe_checked_picture_desc desc = {.trace = trace, .max_error = max_error};
  OK(abbe_checked_picture_make(&scene, &desc, picture, traced, &out, &error));
  return out;
}

static void begin(void) {
  scene = scene_of(SCENE);
}

static void finish(void) {
  abbe_scene_free(&scene);
}

GROUP(begin, finish);

/* To tell that a good picture is one takes fewer passes than to make one. */
TEST(a_good_picture) {
  OWNED(abbe_image, traced) = {0}, picture = make_picture(1024);
  const abbe_checked_picture c = check(&picture, 2, &traced);
  if (!(c.given.bound <= 2) || c.traced.bound <= 2)
    fail_msg("%zu passes: %g, and %g of their own", c.passes, c.given.bound, c.traced.bound);
  assert_true(c.given.estimate <= c.given.bound && c.passes >= 2);
  assert_int_equal(traced.width, 24);
}

TEST(a_bad_picture) {
  OWNED(abbe_image, traced) = {0}, picture = make_picture(64);
  for (size_t i = 0; i < picture.width * picture.height * picture.channels; i++)
    picture.data[i] *= 1.8f;
  const abbe_checked_picture c = check(&picture, 2, &traced);
  assert_true(c.given.bound > 2);
  if (!(c.traced.bound <= 2)) fail_msg("%zu passes: %g of their own", c.passes, c.traced.bound);
  /* The passes are the tracer's own, to the bit. */
  OWNED(abbe_image, own) = traced_picture(&scene, &trace, c.passes);
  check_same_image(&own, &traced);
}

/* A clock that loses a second each time somebody looks. */
static double look(void *user) {
  return *(double *)user -= 1;
}

static abbe_checked_picture check_in(double seconds, double first_s, const abbe_image *picture,
                                     double max_error, bool only_check) {
  abbe_checked_picture out;
  const abbe_checked_picture_desc desc =
      FIELDS(.trace = trace, .max_error = max_error, .only_check = only_check,
             .left = {look, &seconds}, .first_s = first_s);
  MADE(abbe_image, traced,
       abbe_checked_picture_make(&scene, &desc, picture, &traced, &out, &error));
  assert_true((traced.data == NULL) == out.timed_out);
  return out;
}

/* Passes are begun where they end in time, and what was told before stands. */
TEST(in_the_time_that_is_left) {
  OWNED(abbe_image, picture) = make_picture(64), traced = {0};
  abbe_checked_picture c = check_in(100, 90, &picture, 1e-3, false);
  assert_int_equal(c.passes, 0);
  assert_true(c.timed_out && isnan(c.given.bound));
  c = check_in(100, NAN, &picture, 1e-3, false);
  assert_int_equal(c.passes, 0);
  /* More time, more passes; all that were told are those of no limit. */
  size_t last = 0;
  for (double s = 20; s < 1000; s *= 3) {
    c = check_in(s, 1, &picture, 1e-3, false);
    assert_true(c.timed_out && c.passes >= 2 && c.passes > last);
    last = c.passes;
  }
  c = check_in(1e9, 1, &picture, 2, false);
  const abbe_checked_picture free = check(&picture, 2, &traced);
  assert_false(c.timed_out || free.timed_out);
  assert_int_equal(c.passes, free.passes);
  assert_near(c.given.bound, free.given.bound, 0);
  /* Time that ends amid passes. */
  c = check_in(5, 0, &picture, 1e-3, false);
  assert_true(c.timed_out);
  assert_int_equal(c.passes, 0);
}

/* Who only asks is answered as soon as the picture is known to be no good. */
TEST(a_bad_picture_is_soon_known) {
  OWNED(abbe_image, picture) = make_picture(64);
  for (size_t i = 0; i < picture.width * picture.height * picture.channels; i++)
    picture.data[i] *= 4;
  const abbe_checked_picture all = check_in(1e9, 1, &picture, 1, false);
  const abbe_checked_picture soon = check_in(1e9, 1, &picture, 1, true);
  if (!(soon.passes < all.passes && soon.given.estimate > 1))
    fail_msg("%zu of %zu passes: %g", soon.passes, all.passes, soon.given.estimate);
  assert_false(soon.timed_out);
}

TEST(what_ends_it) {
  int asked = 0;
  abbe_image traced;
  OWNED(abbe_image, picture) = make_picture(1);
  abbe_checked_picture out;
  abbe_checked_picture_desc desc = {.trace = trace, .progress = stop_at_once, .user = &asked};
  REFUSED(ABBE_INVALID_ARGUMENT, "an error of 0 cannot be kept",
          abbe_checked_picture_make(&scene, &desc, &picture, &traced, &out, &error));
  desc.max_error = 1;
  REFUSED(ABBE_CANCELLED, "",
          abbe_checked_picture_make(&scene, &desc, &picture, &traced, &out, &error));
  assert_int_equal(asked, 1);
  assert_null(traced.data);
  desc.progress = NULL;
  MADE(abbe_image, small, abbe_image_make(8, 8, 1, (const char *const[]){"Y"}, &small, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_checked_picture_make(&scene, &desc, &small, &traced, &out, &error));
  assert_null(traced.data);
}

/* What fits into the time that is left. */

static double two_seconds(void *user) {
  ++*(int *)user;
  return 2;
}

static double none(void *user) {
  (void)user;
  return -1;
}

TEST(what_fits) {
  int asked = 0;
  const abbe_time_left two = {two_seconds, &asked}, over = {none, NULL};
  assert_near(abbe_time_left_seconds(&two), 2, 0);
  assert_true(abbe_time_left_holds(&two, 1.5));
  assert_false(abbe_time_left_holds(&two, 1.6)); /* it may take a third longer */
  assert_int_equal(asked, 3);
  assert_false(abbe_time_left_holds(&two, NAN));
  assert_false(abbe_time_left_holds(&over, 0));
}

TEST(without_an_end) {
  const abbe_time_left always = {0};
  assert_true(isinf(abbe_time_left_seconds(&always)));
  assert_true(abbe_time_left_holds(&always, 1e9));
  assert_true(abbe_time_left_holds(&always, NAN));
}
