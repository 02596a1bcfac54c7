/* Parallelograms that rays meet: known places, the first of two, parts by the index, sides, and
 * what hides the light, of an object that stands turned. */
#include "tests/check.h"

#include "scenes/volume/exits/exit_sheets.h"

/* A quarter turn about y: the object's x is down, its z the world's x. */
static const abbe_volume_place place = {.centre = {1, 2, 3}, .turn = {0, 0, 1, 0, 1, 0, -1, 0, 0}};
/* The floor at z = 0, U x V up, and a shelf at z = 1 over x > 1, U x V down. */
static const double floor_and_shelf[2][9] = {{-4, -4, 0, 10, 0, 0, 0, 10, 0},
                                             {1, -4, 1, 0, 10, 0, 5, 0, 0}};

static void make_sheets(abbe_exit_sheet sheet[2]) {
  for (int i = 0; i < 2; i++) abbe_exit_sheet_make(floor_and_shelf[i], &place, &sheet[i]);
  assert_near(sheet[0].area, 100, 1e-12);
  assert_near(sheet[1].area, 50, 1e-12);
}

/* Straight down from the object's middle, and by the index 0.5 m to the side for a step of 1. */
static const abbe_exit_ray down = {.way = {1, 0, 0}, .place_by = {0, 0, -0.5}, .share = 1};

static void meet(size_t first, size_t sheets, const float *step, size_t parts,
                 abbe_exit_landing *at) {
  abbe_exit_sheet sheet[2];
  abbe_exit_track track[2];
  make_sheets(sheet);
  abbe_exit_sheets_track(sheet + first, sheets, &down, track);
  abbe_exit_sheets_meet(track, sheets, step, parts, at);
}

TEST(parts) {
  const float step[ABBE_EXIT_MOST_PARTS] = {0, 1, 2, -1, 20};
  abbe_exit_landing at;
  meet(0, 1, step, 5, &at);
  for (int i = 0; i < 4; i++) {
    assert_int_equal(at.page[i], 0);
    assert_near((double)at.far[i], 3, 1e-6);
    assert_near((double)at.u[i], (1 - 0.5 * (double)step[i] + 4) / 10, 1e-6);
    assert_near((double)at.v[i], 0.6, 1e-6);
  }
  assert_int_equal(at.page[4], -1); /* beside the floor */
}

TEST(the_first) {
  const float step[ABBE_EXIT_MOST_PARTS] = {0.1f, -1};
  abbe_exit_landing at;
  meet(0, 2, step, 2, &at);
  assert_int_equal(at.page[0], 0); /* beside the shelf */
  assert_int_equal(at.page[1], 3); /* on it, which is met along its normal */
  assert_near((double)at.far[1], 2, 1e-6);
  assert_near((double)at.u[1], 0.6, 1e-6);
  assert_near((double)at.v[1], 0.1, 1e-6);
  meet(1, 1, step, 1, &at);
  assert_int_equal(at.page[0], -1);
}

TEST(hiding) {
  static const double up[3] = {-1, 0, 0}, below[3] = {2.5, 0, 0.5}, on[3] = {2, 0, 0.5};
  abbe_exit_sheet sheet[2];
  make_sheets(sheet);
  assert_true(abbe_exit_sheets_hide(sheet, 2, below, up, INFINITY));
  assert_false(abbe_exit_sheets_hide(sheet, 2, below, up, 0.4));
  assert_false(abbe_exit_sheets_hide(sheet, 1, below, up, INFINITY)); /* the floor is behind it */
  assert_false(abbe_exit_sheets_hide(sheet, 2, on, up, INFINITY));    /* what stands on the shelf */
}
