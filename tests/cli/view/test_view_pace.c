/* How coarse moving pictures are, by injected times: of machines whose pictures take so long for
 * what is fixed, for the light of the finest step and for the eye's samples of the finest. */
#include "tests/check.h"

#include "cli/view/state/view_state.h"

typedef struct machine {
  double fixed, light, eye;
} machine;

static double time_of(const machine *m, size_t light, size_t eye, bool lit) {
  return m->fixed + (lit ? m->light / (double)(1u << light) : 0) +
         m->eye / (double)((eye + 1) * (eye + 1));
}

/* Draws so many pictures; the last one's time. */
static double draw(abbe_view_pace *p, const machine *m, bool lit, int pictures) {
  double ms = 0;
  for (int i = 0; i < pictures; i++) {
    ms = time_of(m, p->light_step, p->eye_step, lit);
    abbe_view_pace_take(p, p->light_step, p->eye_step, lit, ms);
    assert_true(p->light_step < ABBE_VIEW_LIGHT_STEPS && p->eye_step < ABBE_VIEW_EYE_STEPS);
  }
  return ms;
}

/* Where any step keeps the time, it is kept after a few pictures, whatever takes it, and but for
 * one in eight from then on; where the finest does, it is the finest. */
TEST(the_time_is_kept_where_it_can_be) {
  static const double parts[] = {0, 3, 12, 26, 47, 90, 180};
  enum { PARTS = sizeof parts / sizeof *parts };
  for (size_t f = 0; f < 4; f++)
    for (size_t l = 0; l < PARTS; l++)
      for (size_t e = 0; e < PARTS; e++) {
        const machine m = {parts[f], parts[l], parts[e]};
        abbe_view_pace p = {0};
        const bool can = time_of(&m, ABBE_VIEW_LIGHT_STEPS - 1, ABBE_VIEW_EYE_STEPS - 1, true) <=
                         ABBE_VIEW_MOVING_MS;
        draw(&p, &m, true, 20);
        const double ms = time_of(&m, p.light_step, p.eye_step, true);
        if (can && ms > ABBE_VIEW_MOVING_MS)
          fail_msg("%g + %g + %g: %g ms", m.fixed, m.light, m.eye, ms);
        if (time_of(&m, 0, 0, true) <= ABBE_VIEW_MOVING_MS)
          assert_int_equal(p.light_step + p.eye_step, 0);
        int late = 0; /* finer ones are tried now and then */
        for (int i = 0; i < 48; i++) late += draw(&p, &m, true, 1) > ABBE_VIEW_MOVING_MS;
        if (can && late > 6) fail_msg("%g + %g + %g: %d late", m.fixed, m.light, m.eye, late);
      }
}

/* Fewer photons and samples are no end: where they save nothing the picture is whole. */
TEST(what_saves_nothing_is_left) {
  static const machine fixed = {170, 0, 0}, nearly = {170, 3, 6}, eye = {100, 0, 300};
  abbe_view_pace p = {0};
  draw(&p, &fixed, true, 20);
  assert_int_equal(p.light_step + p.eye_step, 0);
  p = (abbe_view_pace){0};
  draw(&p, &nearly, true, 20);
  assert_int_equal(p.light_step + p.eye_step, 0);
  p = (abbe_view_pace){0};
  draw(&p, &eye, true, 20); /* 400, 175, 133 and 119 ms */
  assert_int_equal(p.eye_step, 2);
}

TEST(the_light_gives_way_first) {
  static const machine even = {3, 34, 12};
  abbe_view_pace p = {0};
  draw(&p, &even, true, 10); /* 49, 32 and 23.5 ms */
  assert_int_equal(p.light_step, 2);
  assert_int_equal(p.eye_step, 0);
}

/* What is kept of the light takes no time, so the eye's steps alone count then. */
TEST(a_camera_that_moves) {
  static const machine m = {2, 1000, 400};
  abbe_view_pace p = {0};
  draw(&p, &m, false, 10);
  assert_int_equal(p.light_step, 0);
  assert_int_equal(p.eye_step, 3);
  static const machine fast = {2, 1000, 12};
  draw(&p, &fast, false, 3);
  assert_int_equal(p.eye_step, 0);
}

/* What else the machine does comes and goes. */
TEST(times_that_change) {
  static const machine quiet = {3, 9, 8}, busy = {9, 36, 28};
  abbe_view_pace p = {0};
  draw(&p, &quiet, true, 5);
  assert_int_equal(p.light_step + p.eye_step, 0);
  for (int turn = 0; turn < 3; turn++) {
    draw(&p, &busy, true, 6);
    assert_true(time_of(&busy, p.light_step, p.eye_step, true) <= ABBE_VIEW_MOVING_MS);
    draw(&p, &quiet, true, 6);
    assert_int_equal(p.light_step + p.eye_step, 0);
  }
}

/* Times of a machine that was busy do not keep pictures coarse for ever. */
TEST(what_was_slow_is_tried_again) {
  abbe_view_pace p = {0};
  for (int i = 0; i < 60; i++)
    abbe_view_pace_take(&p, p.light_step, p.eye_step, true, i < 4 ? 80 : 5);
  assert_int_equal(p.light_step + p.eye_step, 0);
}

/* One picture that waits for a compiler says nothing of the next; two do. */
TEST(one_strange_picture) {
  abbe_view_pace p = {0};
  for (int i = 0; i < 5; i++) {
    abbe_view_pace_take(&p, p.light_step, p.eye_step, true, i == 2 ? 900 : 25);
    assert_int_equal(p.light_step + p.eye_step, 0);
    assert_near(p.ms, 25, 0);
  }
  for (int i = 0; i < 2; i++) abbe_view_pace_take(&p, 0, 0, true, 900);
  assert_true(p.light_step + p.eye_step > 2);
}

/* From the coarsest to the finest in one picture, where there is room for it. */
TEST(the_way_back_is_short) {
  abbe_view_pace p = {.light_step = 3, .eye_step = 3};
  abbe_view_pace_take(&p, 3, 3, true, 1.9);
  assert_int_equal(p.light_step + p.eye_step, 0);
  p = (abbe_view_pace){.light_step = 3};
  abbe_view_pace_take(&p, 3, 0, true, 5.4); /* 13.5 ms are expected of step 1, 24.3 of 0 */
  assert_int_equal(p.light_step, 1);
}
