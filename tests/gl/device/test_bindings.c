/* The list of bindings is one for C and GLSL: a number means one buffer. */
#include "tests/check.h"

#include "base/file.h"
#include "gl/device/statistics.h"

enum { MOST = 64 };

typedef struct list {
  char name[MOST][48];
  int number[MOST];
  size_t count;
} list;

static void read_list(const char *prefix, list *out) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/gl/device/bindings.h", 1 << 16, &text, &size, &error));
  out->count = 0;
  for (char *line = text; line != NULL && out->count < MOST;
       line = strchr(line, '\n') != NULL ? strchr(line, '\n') + 1 : NULL) {
    char name[48];
    int number = 0;
    if (sscanf(line, "#define %47s %d", name, &number) != 2) continue;
    if (strncmp(name, prefix, strlen(prefix)) != 0) continue;
    memcpy(out->name[out->count], name, sizeof name);
    out->number[out->count++] = number;
  }
}

static void check_list(const char *prefix, size_t least, int most) {
  list all;
  read_list(prefix, &all);
  assert_true(all.count >= least);
  for (size_t i = 0; i < all.count; i++) {
    if (all.number[i] < 0 || all.number[i] > most)
      fail_msg("%s is %d; at most %d is everywhere", all.name[i], all.number[i], most);
    for (size_t k = 0; k < i; k++)
      if (all.number[k] == all.number[i])
        fail_msg("%s and %s are both %d", all.name[k], all.name[i], all.number[i]);
  }
}

/* Beside them test harnesses have two, 38 and 39. */
TEST(buffers_have_a_number_each) {
  check_list("BINDING_", 20, 37);
}

/* Passes use the units below. All stages together have 96 for sure, and one may look at 16 of them.
 */
TEST(kept_textures_have_a_unit_each) {
  check_list("UNIT_", 5, 95);
}

/* Times by pass, and the balance of the ledger. */

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
