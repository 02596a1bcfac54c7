/* What is drawn next, by scripted events: no scene, no graphics. */
#include "tests/check.h"

#include "cli/view/state/view_state.h"

enum { SHOWS = 2, BESIDE }; /* of two workers, whichever it is */

static size_t worker_of(const abbe_view_refine *r, size_t who) {
  return who < ABBE_VIEW_WORKERS ? who : who == SHOWS ? r->shows : 1 - r->shows;
}

/* The job that is next for that worker; fails where there is none. */
static abbe_view_job next(const abbe_view_refine *r, size_t who, double now) {
  abbe_view_job job = {0};
  assert_true(abbe_view_refine_next(r, worker_of(r, who), now, &job));
  return job;
}

static bool idle(const abbe_view_refine *r, size_t who, double now) {
  abbe_view_job job;
  return !abbe_view_refine_next(r, worker_of(r, who), now, &job);
}

/* It begins what is next. */
static size_t begin(abbe_view_refine *r, size_t who, double now) {
  const size_t worker = worker_of(r, who);
  const abbe_view_job job = next(r, worker, now);
  abbe_view_refine_take(r, worker, &job);
  return worker;
}

/* It draws what is next in that time. */
static abbe_view_job draw(abbe_view_refine *r, size_t who, double now, double ms) {
  const size_t worker = begin(r, who, now);
  const abbe_view_job job = r->hand[worker].job;
  assert_int_equal(abbe_view_refine_end(r, worker, ABBE_VIEW_DONE, ms, ms), !job.warms);
  return job;
}

/* The next picture at rest, and all that comes before it for its programs' sake. */
static abbe_view_job draw_rest(abbe_view_refine *r, double now) {
  for (;;) {
    const size_t who = idle(r, SHOWS, now) ? BESIDE : SHOWS;
    const abbe_view_job job = draw(r, who, now, 20);
    if (!job.warms) return job;
  }
}

static abbe_view_refine begun(void) {
  abbe_view_refine r;
  abbe_view_refine_begin(&r);
  return r;
}

/* Refined up to a stage, at rest, and ready to move. */
static abbe_view_refine refined(abbe_view_stage stage) {
  abbe_view_refine r = begun();
  abbe_view_job job;
  while (r.stage < stage) draw_rest(&r, 0);
  while (abbe_view_refine_next(&r, worker_of(&r, BESIDE), 0, &job) && job.warms)
    draw(&r, BESIDE, 0, 20);
  return r;
}

TEST(stages_follow_each_other) {
  static const abbe_view_stage stages[] = {ABBE_VIEW_MOVING, ABBE_VIEW_BALANCED, ABBE_VIEW_ACCURATE,
                                           ABBE_VIEW_MEAN, ABBE_VIEW_TRACED};
  static const abbe_view_stage lights[] = {ABBE_VIEW_MOVING, ABBE_VIEW_BALANCED, ABBE_VIEW_ACCURATE,
                                           ABBE_VIEW_ACCURATE, ABBE_VIEW_ACCURATE};
  abbe_view_refine r = begun();
  for (size_t i = 0; i < 5; i++) {
    const abbe_view_job job = draw_rest(&r, 0);
    assert_int_equal(job.stage, stages[i]);
    assert_int_equal(job.light, lights[i]);
  }
  for (size_t pass = 1; pass < ABBE_VIEW_TRACED_PASSES; pass++) {
    const abbe_view_job job = draw(&r, BESIDE, 0, 20);
    assert_int_equal(job.stage, ABBE_VIEW_TRACED);
    assert_int_equal(job.pass, pass);
  }
  assert_true(idle(&r, SHOWS, 0) && idle(&r, BESIDE, 0));
  assert_true(abbe_view_refine_wait(&r, 0) < 0);
}

/* Whoever shows is given no stage that it has not drawn before; the other one shows as soon as it
 * has the better light, and has drawn all that moves with it. */
TEST(who_shows_and_who_makes) {
  abbe_view_refine r = begun();
  assert_true(idle(&r, BESIDE, 0)); /* the first picture has the machine for itself */
  draw(&r, 0, 0, 20);
  assert_true(idle(&r, SHOWS, 0));
  abbe_view_job job = draw(&r, 1, 0, 20);
  assert_true(job.warms && job.light == ABBE_VIEW_MOVING);
  assert_int_equal(r.shows, 0); /* neither is better */
  assert_int_equal(draw(&r, 1, 0, 20).stage, ABBE_VIEW_BALANCED);
  assert_int_equal(r.stage, ABBE_VIEW_BALANCED); /* seen at once, */
  assert_int_equal(r.shows, 0);                  /* but nothing moves in it yet */
  const size_t warming = begin(&r, 1, 0);
  assert_true(r.hand[1].job.warms && r.hand[1].job.light == ABBE_VIEW_BALANCED);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  assert_false(abbe_view_refine_cancels(&r, warming)); /* which is wanted the more now */
  assert_int_equal(draw(&r, SHOWS, 1, 20).light, ABBE_VIEW_MOVING);
  assert_false(abbe_view_refine_end(&r, warming, ABBE_VIEW_DONE, 20, 20));
  assert_int_equal(r.shows, 1);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1.1);
  assert_int_equal(draw(&r, SHOWS, 1.1, 20).light, ABBE_VIEW_BALANCED);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, 1.2);
  assert_int_equal(draw(&r, SHOWS, 1.2, 20).light, ABBE_VIEW_MOVING);
  assert_int_equal(draw(&r, 0, 9, 20).stage, ABBE_VIEW_BALANCED); /* its programs hold */
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 10);
  draw(&r, SHOWS, 10, 20);
  assert_true(draw(&r, BESIDE, 20, 20).warms); /* and do not */
}

/* A stage that takes its time, in the compiler say, keeps nothing that moves waiting. */
TEST(motion_waits_for_nothing) {
  abbe_view_refine r = refined(ABBE_VIEW_BALANCED);
  const size_t worker = begin(&r, BESIDE, 0);
  assert_int_equal(r.hand[worker].job.stage, ABBE_VIEW_ACCURATE);
  for (int i = 0; i < 3; i++) {
    abbe_view_refine_change(&r, i < 2 ? ABBE_VIEW_MOVED_CAMERA : ABBE_VIEW_CHANGED_LIGHT, 1 + i);
    assert_true(abbe_view_refine_cancels(&r, worker));
    const abbe_view_job job = draw(&r, SHOWS, 1 + i, 20);
    assert_int_equal(job.stage, ABBE_VIEW_MOVING);
    assert_int_equal(job.light, i < 2 ? ABBE_VIEW_BALANCED : ABBE_VIEW_MOVING);
  }
  /* what comes too late is not shown, and no light for this scene */
  assert_false(abbe_view_refine_end(&r, worker, ABBE_VIEW_DONE, 3000, 3000));
  assert_int_equal(r.stage, ABBE_VIEW_MOVING);
  assert_int_equal(draw(&r, BESIDE, 9, 20).stage, ABBE_VIEW_BALANCED);
}

TEST(refining_waits_for_rest) {
  abbe_view_refine r = refined(ABBE_VIEW_BALANCED);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, 10);
  assert_int_equal(draw(&r, SHOWS, 10, 20).stage, ABBE_VIEW_MOVING);
  assert_true(idle(&r, BESIDE, 10.02));
  assert_near(abbe_view_refine_wait(&r, 10.02), 0.13, 1e-9);
  assert_int_equal(next(&r, BESIDE, 10.16).stage, ABBE_VIEW_BALANCED);
  abbe_view_refine_hold(&r, true, 10.17);
  assert_true(idle(&r, SHOWS, 20) && idle(&r, BESIDE, 20));
  assert_true(abbe_view_refine_wait(&r, 20) < 0);
  abbe_view_refine_hold(&r, false, 30); /* the rest begins when the hand is taken off */
  assert_true(idle(&r, BESIDE, 30.1));
  assert_int_equal(next(&r, BESIDE, 30.16).stage, ABBE_VIEW_BALANCED);
}

TEST(a_change_cancels_all_but_what_moves) {
  for (abbe_view_stage stage = ABBE_VIEW_MOVING; stage <= ABBE_VIEW_TRACED; stage++) {
    abbe_view_refine r = refined(stage - 1);
    const size_t worker = begin(&r, stage == ABBE_VIEW_MOVING ? SHOWS : BESIDE, 0);
    assert_int_equal(r.hand[worker].job.stage, stage);
    assert_false(abbe_view_refine_cancels(&r, worker));
    abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
    assert_int_equal(abbe_view_refine_cancels(&r, worker), stage != ABBE_VIEW_MOVING);
    assert_false(abbe_view_refine_end(&r, worker, ABBE_VIEW_CANCELLED, 5, 5));
    assert_int_equal(r.stage, ABBE_VIEW_NONE);
    assert_int_equal(next(&r, SHOWS, 1).stage, ABBE_VIEW_MOVING);
  }
}

TEST(the_camera_keeps_the_light) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  for (int i = 0; i < 2; i++) {
    abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1 + i);
    const abbe_view_job job = draw(&r, SHOWS, 1 + i, 20);
    assert_int_equal(job.stage, ABBE_VIEW_MOVING);
    assert_int_equal(job.light, ABBE_VIEW_ACCURATE);
  }
  /* nobody has to draw that light once more */
  assert_true(idle(&r, BESIDE, 3));
  const abbe_view_job job = draw(&r, SHOWS, 3, 20);
  assert_int_equal(job.stage, ABBE_VIEW_ACCURATE);
  assert_int_equal(job.light, ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 4); /* which ends it, as any stage */
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, 5);
  assert_int_equal(draw(&r, SHOWS, 5, 20).light, ABBE_VIEW_MOVING);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 5.1);
  assert_int_equal(draw(&r, SHOWS, 5.1, 20).light, ABBE_VIEW_MOVING);
  r = refined(ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 6);
  draw(&r, SHOWS, 6, 20);
  const size_t worker = begin(&r, SHOWS, 7);
  assert_int_equal(r.hand[worker].job.stage, ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 7);
  assert_true(abbe_view_refine_cancels(&r, worker));
  assert_false(abbe_view_refine_end(&r, worker, ABBE_VIEW_CANCELLED, 5, 5));
  assert_int_equal(draw(&r, SHOWS, 7, 20).light, ABBE_VIEW_ACCURATE);
}

/* Whoever was kept from it draws the change as it moves first, and once. */
TEST(a_change_is_seen_before_its_stages) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  assert_int_equal(draw(&r, SHOWS, 9, 20).stage, ABBE_VIEW_MOVING);
  assert_int_equal(draw(&r, SHOWS, 9, 20).stage, ABBE_VIEW_ACCURATE);
  r = refined(ABBE_VIEW_MOVING);
  draw(&r, BESIDE, 0, 20);
  const size_t warming = begin(&r, BESIDE, 0), shows = r.shows;
  assert_true(r.hand[warming].job.warms);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  begin(&r, SHOWS, 1);
  abbe_view_refine_end(&r, warming, ABBE_VIEW_DONE, 20, 20); /* it shows from now on */
  assert_int_equal(r.shows, warming);
  assert_true(idle(&r, SHOWS, 1.1) && idle(&r, SHOWS, 9));
  assert_true(abbe_view_refine_end(&r, shows, ABBE_VIEW_DONE, 900, 900));
  assert_int_equal(next(&r, SHOWS, 9).stage, ABBE_VIEW_BALANCED);
}

/* A light that was drawn for a scene that is gone counts for nothing. */
TEST(a_late_picture_brings_no_light) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  const size_t worker = begin(&r, SHOWS, 1);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, 1.01);
  assert_true(
      abbe_view_refine_end(&r, worker, ABBE_VIEW_DONE, 20, 20)); /* newer than what stands */
  assert_int_equal(r.hand[worker].light, ABBE_VIEW_NONE);
  assert_int_equal(next(&r, SHOWS, 1.02).light, ABBE_VIEW_MOVING);
}

/* Moving jobs take the steps that the times of the last ones lead to, those at rest none. */
TEST(slow_pictures_get_cheaper) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  double now = 1;
  bool fewer = false;
  /* a picture of 400 ms, of which a step takes its share */
  for (int i = 0; i < 10; i++, now += 0.05) {
    abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, now);
    const abbe_view_job job = next(&r, SHOWS, now);
    draw(&r, SHOWS, now, 400.0 / (double)((job.eye_step + 1) * (job.eye_step + 1)));
  }
  assert_int_equal(r.pace.eye_step, 3); /* 44 is too long, 25 is not, and 44 is no way back */
  assert_near(r.pace.ms, 400.0 / 16, 1e-9);
  now += 1;
  assert_int_equal(next(&r, SHOWS, now).stage, ABBE_VIEW_ACCURATE);
  assert_int_equal(draw(&r, SHOWS, now, 3000).eye_step, 0); /* at rest it may take its time */
  assert_int_equal(r.pace.eye_step, 3);
  for (int i = 0; i < 40; i++, now += 0.05) {
    abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, now);
    const abbe_view_job job = draw(&r, SHOWS, now, i < 6 ? 80 : 5);
    fewer = fewer || job.light_step > 0;
  }
  assert_true(fewer);
  assert_int_equal(r.pace.eye_step + r.pace.light_step, 0);
}

/* What the first picture of a kind takes is the compiler's, and coarser ones, whose programs nobody
 * knows, would be compiled too. */
TEST(no_step_follows_from_the_compiler) {
  abbe_view_refine r = begun();
  draw(&r, SHOWS, 0, 3000);
  assert_int_equal(r.pace.light_step, 0);
  assert_int_equal(r.pace.eye_step, 1); /* since nothing is known */
  r.held = true;
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
  assert_int_equal(draw(&r, SHOWS, 1, 90).eye_step, 1);
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 2);
  assert_true(draw(&r, SHOWS, 2, 2).eye_step > 1); /* of the same programs */
}

/* Of the first picture what was not its worker's own work was drawing. */
TEST(the_first_step_follows_from_the_drawing) {
  static const struct {
    double drawn_ms;
    size_t eye_step;
  } cases[] = {{20, 1}, {94, 1}, {97, 2}, {300, 3}, {2000, 3}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_view_refine r = begun();
    begin(&r, SHOWS, 0);
    abbe_view_refine_end(&r, 0, ABBE_VIEW_DONE, 3000 + cases[i].drawn_ms, 3000);
    assert_int_equal(r.pace.eye_step, cases[i].eye_step);
  }
}

TEST(what_is_refused_waits_for_a_change) {
  abbe_view_refine r = refined(ABBE_VIEW_BALANCED);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 1);
  const size_t worker = begin(&r, SHOWS, 1);
  assert_false(abbe_view_refine_end(&r, worker, ABBE_VIEW_REFUSED, 5, 5));
  assert_true(idle(&r, SHOWS, 5) && idle(&r, BESIDE, 5));
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 6);
  begin(&r, SHOWS, 6);
  assert_int_equal(r.hand[worker].job.stage, ABBE_VIEW_MOVING);
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 6.1);
  abbe_view_refine_end(&r, worker, ABBE_VIEW_REFUSED, 5, 5); /* of what is gone already */
  assert_false(idle(&r, SHOWS, 6.2));
}

/* Light that was begun is not there, nor what it was to take the place of. */
TEST(a_stage_that_ends_early_leaves_no_light) {
  static const struct {
    abbe_view_stage after;
    abbe_view_outcome outcome;
    bool keeps;
  } cases[] = {{ABBE_VIEW_BALANCED, ABBE_VIEW_CANCELLED, false}, /* of the accurate one */
               {ABBE_VIEW_MEAN, ABBE_VIEW_CANCELLED, true},      /* the tracer's work */
               {ABBE_VIEW_MEAN, ABBE_VIEW_LOST, false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_view_refine r = refined(cases[i].after);
    const size_t worker = begin(&r, BESIDE, 0);
    const abbe_view_stage before = r.hand[worker].light, shown = r.hand[r.shows].light;
    abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 1);
    abbe_view_refine_end(&r, worker, cases[i].outcome, 5, 5);
    assert_int_equal(r.hand[worker].light, cases[i].keeps ? before : ABBE_VIEW_NONE);
    assert_int_equal(next(&r, SHOWS, 1).light, shown); /* which is another one's */
  }
}

TEST(a_spectrum_is_traced_before_the_mean) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  const size_t worker = begin(&r, BESIDE, 0);
  assert_int_equal(r.hand[worker].job.stage, ABBE_VIEW_MEAN);
  r.spectrum = true;
  assert_true(abbe_view_refine_cancels(&r, worker));
  abbe_view_refine_end(&r, worker, ABBE_VIEW_CANCELLED, 5, 5);
  assert_int_equal(draw(&r, BESIDE, 0, 20).stage, ABBE_VIEW_TRACED);
  assert_int_equal(draw(&r, BESIDE, 0, 20).pass, 1);
}

/* Without a mean the tracer follows, or nothing. */
/* Light that is refused of fewer photons is drawn of more, until the scene is another. */
TEST(photons_are_not_too_few) {
  abbe_view_refine r = begun();
  draw(&r, SHOWS, 0, 20);
  r.pace.light_step = 2;
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, 1);
  const size_t worker = begin(&r, SHOWS, 1);
  assert_int_equal(r.hand[worker].job.light_step, 2);
  assert_false(abbe_view_refine_end(&r, worker, ABBE_VIEW_REFUSED, 5, 5));
  assert_false(r.refused);
  for (int i = 0; i < 5; i++) {
    assert_true(draw(&r, SHOWS, 2 + i, 400).light_step < 2); /* however slow it is */
    abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_LIGHT, 2.5 + i);
  }
  abbe_view_refine_change(&r, ABBE_VIEW_CHANGED_SCENE, 10);
  assert_int_equal(r.pace.lights, 0);
}

TEST(a_picture_without_a_mean) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  r.single = true;
  assert_int_equal(next(&r, BESIDE, 0).stage, ABBE_VIEW_TRACED);
  r.last = ABBE_VIEW_MEAN;
  assert_true(idle(&r, BESIDE, 9));
}

TEST(stages_end_where_they_are_wanted) {
  abbe_view_refine r = begun();
  r.last = ABBE_VIEW_BALANCED;
  draw_rest(&r, 0);
  assert_int_equal(draw_rest(&r, 0).stage, ABBE_VIEW_BALANCED);
  assert_true(draw(&r, BESIDE, 0, 20).warms); /* it is there to be turned */
  assert_true(idle(&r, SHOWS, 9) && idle(&r, BESIDE, 9));
  r.last = ABBE_VIEW_MOVING;
  abbe_view_refine_change(&r, ABBE_VIEW_MOVED_CAMERA, 10);
  assert_int_equal(draw(&r, SHOWS, 11, 20).stage, ABBE_VIEW_MOVING);
  assert_true(idle(&r, SHOWS, 20) && idle(&r, BESIDE, 20));
}

/* A worker that has drawn something else begins anew, and shows nothing. */
TEST(what_a_worker_holds_is_forgotten) {
  abbe_view_refine r = refined(ABBE_VIEW_ACCURATE);
  const size_t shows = r.shows;
  abbe_view_refine_forget(&r, 1 - shows);
  assert_int_equal(r.hand[1 - shows].light, ABBE_VIEW_NONE);
  assert_int_equal(draw(&r, BESIDE, 0, 20).stage, ABBE_VIEW_MEAN);
  assert_int_equal(r.shows, shows);
}
