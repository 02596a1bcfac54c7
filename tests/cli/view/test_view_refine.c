/* What is drawn next, by scripted events: no scene, no graphics. */
#include "tests/check.h"

#include "cli/view/state/view_refine.h"

/* The job that is next; fails where there is none. */
static abbe_view_job next(const abbe_view_refine *r, double now) {
  abbe_view_job job = {0};
  assert_true(abbe_view_refine_next(r, now, &job));
  return job;
}

static bool idle(const abbe_view_refine *r, double now) {
  abbe_view_job job;
  return !abbe_view_refine_next(r, now, &job);
}

/* Draws what is next in that time. */
static abbe_view_job draw(abbe_view_refine *r, double now, double ms) {
  const abbe_view_job job = next(r, now);
  abbe_view_refine_end(r, &job, ABBE_VIEW_DONE, ms, now + ms / 1000);
  return job;
}

static abbe_view_refine begun(void) {
  abbe_view_refine r;
  abbe_view_refine_begin(&r);
  return r;
}

/* Refined up to a stage, at rest. */
static abbe_view_refine refined(abbe_view_stage stage) {
  abbe_view_refine r = begun();
  while (r.stage < stage) draw(&r, 0, 20);
  return r;
}

static void test_stages_follow_each_other(void **state) {
  (void)state;
  static const abbe_view_stage stages[] = {ABBE_VIEW_MOVING, ABBE_VIEW_BALANCED, ABBE_VIEW_ACCURATE,
                                           ABBE_VIEW_MEAN, ABBE_VIEW_TRACED};
  abbe_view_refine r = begun();
  for (size_t i = 0; i < 5; i++) assert_int_equal(draw(&r, 0, 20).stage, stages[i]);
  for (size_t pass = 1; pass < ABBE_VIEW_TRACED_PASSES; pass++) {
    const abbe_view_job job = draw(&r, 0, 20);
    assert_int_equal(job.stage, ABBE_VIEW_TRACED);
    assert_int_equal(job.pass, pass);
  }
  assert_true(idle(&r, 0));
  assert_true(abbe_view_refine_wait(&r, 0) < 0);
}

static void test_light_is_of_the_stage(void **state) {
  (void)state;
  abbe_view_refine r = begun();
  assert_int_equal(draw(&r, 0, 20).light, ABBE_VIEW_MOVING);
  assert_int_equal(draw(&r, 0, 20).light, ABBE_VIEW_BALANCED);
  assert_int_equal(draw(&r, 0, 20).light, ABBE_VIEW_ACCURATE);
  assert_int_equal(draw(&r, 0, 20).light, ABBE_VIEW_ACCURATE);
}

static void test_refining_waits_for_rest(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_BALANCED);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 10);
  assert_int_equal(draw(&r, 10, 20).stage, ABBE_VIEW_MOVING);
  assert_true(idle(&r, 10.02));
  assert_near(abbe_view_refine_wait(&r, 10.02), 0.13, 1e-9);
  assert_int_equal(next(&r, 10.16).stage, ABBE_VIEW_BALANCED);
  abbe_view_refine_hold(&r, true, 10.17);
  assert_true(idle(&r, 20));
  assert_true(abbe_view_refine_wait(&r, 20) < 0);
  abbe_view_refine_hold(&r, false, 30); /* the rest begins when the hand is taken off */
  assert_true(idle(&r, 30.1));
  assert_int_equal(next(&r, 30.16).stage, ABBE_VIEW_BALANCED);
}

static void test_a_change_cancels_all_but_what_moves(void **state) {
  (void)state;
  for (abbe_view_stage stage = ABBE_VIEW_MOVING; stage <= ABBE_VIEW_TRACED; stage++) {
    abbe_view_refine r = refined(stage - 1);
    const abbe_view_job job = next(&r, 0);
    assert_int_equal(job.stage, stage);
    assert_false(abbe_view_refine_cancels(&r, &job));
    abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
    assert_int_equal(abbe_view_refine_cancels(&r, &job), stage != ABBE_VIEW_MOVING);
    abbe_view_refine_end(&r, &job, ABBE_VIEW_CANCELLED, 5, 1);
    assert_int_equal(r.stage, ABBE_VIEW_NONE);
    assert_int_equal(next(&r, 1).stage, ABBE_VIEW_MOVING);
  }
}

static void test_the_camera_keeps_the_light(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  abbe_view_job job = draw(&r, 1, 20);
  assert_int_equal(job.stage, ABBE_VIEW_MOVING);
  assert_int_equal(job.light, ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1.1);
  assert_int_equal(draw(&r, 1.1, 20).light, ABBE_VIEW_ACCURATE);
  job = draw(&r, 2, 20);
  assert_int_equal(job.stage, ABBE_VIEW_BALANCED);
  assert_int_equal(job.light, ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 3);
  assert_int_equal(draw(&r, 3, 20).light, ABBE_VIEW_MOVING);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 3.1);
  assert_int_equal(draw(&r, 3.1, 20).light, ABBE_VIEW_MOVING);
}

/* A light that was drawn for a scene that is gone counts for nothing. */
static void test_a_late_picture_brings_no_light(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  const abbe_view_job job = next(&r, 1);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 1.01);
  abbe_view_refine_end(&r, &job, ABBE_VIEW_DONE, 20, 1.02);
  assert_int_equal(r.light, ABBE_VIEW_NONE);
  assert_int_equal(next(&r, 1.02).light, ABBE_VIEW_MOVING);
}

/* Moving jobs take the steps that the times of the last ones lead to, those at rest none. */
static void test_slow_pictures_get_cheaper(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  double now = 1;
  /* a picture of 400 ms, of which a step takes its share */
  for (int i = 0; i < 10; i++, now += 0.05) {
    abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, now);
    const abbe_view_job job = next(&r, now);
    abbe_view_refine_end(&r, &job, ABBE_VIEW_DONE,
                         400.0 / (double)((job.eye_step + 1) * (job.eye_step + 1)), now);
  }
  assert_int_equal(r.pace.eye_step, 2); /* 100 is too long, 44 is not, and 100 is no way back */
  assert_near(r.pace.ms, 400.0 / 9, 1e-9);
  now += 1;
  assert_int_equal(next(&r, now).stage, ABBE_VIEW_BALANCED);
  assert_int_equal(next(&r, now).eye_step, 0);
  draw(&r, now, 3000); /* at rest it may take its time */
  assert_int_equal(r.pace.eye_step, 2);
  for (int i = 0; i < 40; i++, now += 0.05) {
    abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, now);
    const abbe_view_job job = draw(&r, now, i < 5 ? 80 : 5);
    if (i == 4) assert_true(job.light_step > 0);
  }
  assert_int_equal(r.pace.eye_step + r.pace.light_step, 0);
}

static void test_what_is_refused_waits_for_a_change(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_BALANCED);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 1);
  const abbe_view_job job = next(&r, 1);
  abbe_view_refine_end(&r, &job, ABBE_VIEW_REFUSED, 5, 1);
  assert_true(idle(&r, 5));
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 6);
  const abbe_view_job again = next(&r, 6);
  assert_int_equal(again.stage, ABBE_VIEW_MOVING);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 6.1);
  abbe_view_refine_end(&r, &again, ABBE_VIEW_REFUSED, 5, 6.2); /* of what is gone already */
  assert_false(idle(&r, 6.2));
}

/* What would wait for the compiler is left, whatever moves is drawn meanwhile, and what comes then
 * waits for nothing. */
static void test_a_stage_waits_for_its_compiler_beside_it(void **state) {
  (void)state;
  abbe_view_refine r = begun();
  r.ahead = true;
  assert_true(next(&r, 0).compiles); /* nothing stands yet */
  draw(&r, 0, 20);
  const abbe_view_job job = next(&r, 0);
  assert_int_equal(job.stage, ABBE_VIEW_BALANCED);
  assert_false(job.compiles);
  abbe_view_refine_end(&r, &job, ABBE_VIEW_UNCOMPILED, 5, 1);
  assert_true(r.compiling && idle(&r, 9) && abbe_view_refine_wait(&r, 9) < 0);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 10);
  assert_int_equal(draw(&r, 20, 20).stage, ABBE_VIEW_MOVING);
  assert_true(idle(&r, 21));
  abbe_view_refine_compiled(&r, true);
  assert_int_equal(next(&r, 21).stage, ABBE_VIEW_BALANCED);
  assert_true(draw(&r, 21, 20).compiles);
  assert_false(next(&r, 21).compiles);
  /* of what is gone already nothing is compiled */
  const abbe_view_job late = next(&r, 21);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 22);
  abbe_view_refine_end(&r, &late, ABBE_VIEW_UNCOMPILED, 5, 22);
  assert_false(r.compiling);
  abbe_view_refine_compiled(&r, false); /* nobody can: each stage does it itself */
  draw(&r, 22, 20);
  for (int i = 0; i < 3; i++) assert_true(draw(&r, 30, 20).compiles);
}

/* Light that was begun is not there, nor what it was to take the place of. */
static void test_a_stage_that_ends_early_leaves_no_light(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_BALANCED);
  const abbe_view_job job = next(&r, 0);
  assert_int_equal(job.light, ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  abbe_view_refine_end(&r, &job, ABBE_VIEW_CANCELLED, 5, 1);
  assert_int_equal(next(&r, 1).light, ABBE_VIEW_MOVING);
  r = refined(ABBE_VIEW_ACCURATE);
  const abbe_view_job mean = next(&r, 0);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  abbe_view_refine_end(&r, &mean, ABBE_VIEW_CANCELLED, 5, 1);
  assert_int_equal(next(&r, 1).light, ABBE_VIEW_ACCURATE); /* which it did not touch */
}

static void test_a_spectrum_is_traced_before_the_mean(void **state) {
  (void)state;
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  const abbe_view_job mean = next(&r, 0);
  assert_int_equal(mean.stage, ABBE_VIEW_MEAN);
  r.spectrum = true;
  assert_true(abbe_view_refine_cancels(&r, &mean));
  abbe_view_refine_end(&r, &mean, ABBE_VIEW_CANCELLED, 5, 0);
  assert_int_equal(draw(&r, 0, 20).stage, ABBE_VIEW_TRACED);
  assert_int_equal(draw(&r, 0, 20).pass, 1);
}

/* Without a mean the tracer follows, or nothing. */
static void test_a_picture_without_a_mean(void **state) {
  (void)state;
  abbe_view_refine r = begun();
  r.single = true;
  while (r.stage < ABBE_VIEW_ACCURATE) draw(&r, 0, 20);
  assert_int_equal(next(&r, 0).stage, ABBE_VIEW_TRACED);
  r.last = ABBE_VIEW_MEAN;
  assert_true(idle(&r, 9));
}

static void test_stages_end_where_they_are_wanted(void **state) {
  (void)state;
  abbe_view_refine r = begun();
  r.last = ABBE_VIEW_BALANCED;
  draw(&r, 0, 20);
  assert_int_equal(draw(&r, 0, 20).stage, ABBE_VIEW_BALANCED);
  assert_true(idle(&r, 9));
  r.last = ABBE_VIEW_MOVING;
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 10);
  assert_int_equal(draw(&r, 11, 20).stage, ABBE_VIEW_MOVING);
  assert_true(idle(&r, 20));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_stages_follow_each_other),
      cmocka_unit_test(test_light_is_of_the_stage),
      cmocka_unit_test(test_refining_waits_for_rest),
      cmocka_unit_test(test_a_change_cancels_all_but_what_moves),
      cmocka_unit_test(test_the_camera_keeps_the_light),
      cmocka_unit_test(test_a_late_picture_brings_no_light),
      cmocka_unit_test(test_slow_pictures_get_cheaper),
      cmocka_unit_test(test_what_is_refused_waits_for_a_change),
      cmocka_unit_test(test_a_picture_without_a_mean),
      cmocka_unit_test(test_a_stage_waits_for_its_compiler_beside_it),
      cmocka_unit_test(test_a_stage_that_ends_early_leaves_no_light),
      cmocka_unit_test(test_a_spectrum_is_traced_before_the_mean),
      cmocka_unit_test(test_stages_end_where_they_are_wanted)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
