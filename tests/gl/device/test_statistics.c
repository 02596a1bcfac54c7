/* Times by pass, and the balance of the ledger. */
#include "tests/check.h"

#include "gl/device/statistics.h"

TEST(times_add_up_by_pass_and_by_stage) {
  abbe_statistics s = {0};
  abbe_statistics_add_ms(&s, ABBE_PASS_PHOTONS, 2);
  abbe_statistics_add_ms(&s, ABBE_PASS_EYE_PICTURE, 8);
  abbe_statistics_add_ms(&s, ABBE_PASS_PHOTONS, 3);
  abbe_statistics_add_ms(&s, ABBE_PASS_LIGHT_FRONT, 1);
  abbe_statistics_add_ms(&s, ABBE_PASS_COUNT, 100);
  assert_int_equal(s.pass_count, 3);
  assert_int_equal(s.pass[0].pass, ABBE_PASS_PHOTONS);
  assert_int_equal(s.pass[2].pass, ABBE_PASS_LIGHT_FRONT);
  assert_near(s.pass[0].ms, 5, 0);
  assert_near(abbe_statistics_stage_ms(&s, ABBE_STAGE_LIGHT), 6, 0);
  assert_near(abbe_statistics_stage_ms(&s, ABBE_STAGE_EYE), 8, 0);
}

TEST(a_ledger_balances_or_says_by_how_much_not) {
  abbe_ledger l = {.reached = 8, .reflected = 1, .absorbed = 1, .trapped = 1, .missed = 2};
  assert_near(abbe_ledger_imbalance(&l), 3.0 / 8, 1e-15);
  l.deposited = 5;
  l.interpolated = 2;
  assert_near(abbe_ledger_imbalance(&l), 0, 1e-15);
  l.reached = 0;
  assert_near(abbe_ledger_imbalance(&l), 0, 0);
}

TEST(a_ledger_is_scaled_whole) {
  abbe_ledger l = {1, 2, 3, 4, 5, 6, 7, 8};
  const abbe_ledger twice = {2, 4, 6, 8, 10, 12, 14, 16};
  abbe_ledger_scale(&l, 2);
  assert_memory_equal(&l, &twice, sizeof l);
}
