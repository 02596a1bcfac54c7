/* The page of sweeps: its tables, and the pictures that it names. */
#include "tests/gl/frame.h"
#include "tests/validation/tradeoff/sweep_row.h"

#include "validation/sweep/sweep_page.h"

#include <unistd.h>

static abbe_sweep_table make_table(void) {
  static const double error[] = {8, 4, 2};
  abbe_sweep_table t = {0};
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_SCENE, "no/such/gem.yaml");
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_SIZE, "16x16");
  for (size_t i = 0; i < 3; i++) {
    abbe_sweep_row row = sweep_row("default", 32u << i);
    row.number[ABBE_SWEEP_FRAME_MS] = 10 << i;
    row.number[ABBE_SWEEP_CAUSTIC_DE] = error[i];
    row.number[ABBE_SWEEP_CAUSTIC_DE_NOISE] = 0.5;
    assert_int_equal(abbe_sweep_table_add(&t, &row, NULL), ABBE_OK);
  }
  abbe_sweep_row row = sweep_row("thesis", 512);
  snprintf(row.setting.fill, sizeof row.setting.fill, "smear");
  row.setting.map = 1024;
  row.number[ABBE_SWEEP_FRAME_MS] = 40;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = 8;
  assert_int_equal(abbe_sweep_table_add(&t, &row, NULL), ABBE_OK);
  assert_int_equal(
      abbe_sweep_table_mark(&t, ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAUSTIC_DE, NULL, NULL), ABBE_OK);
  return t;
}

GROUP(make_context, free_context);

TEST(tables_without_their_scene) {
  char path[64], *text;
  size_t size;
  snprintf(path, sizeof path, "/tmp/abbe_test_sweep_page_%ld.md", (long)getpid());
  abbe_sweep_table t = make_table();
  OK(abbe_sweep_page_write(context, path, &t, 1, ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAUSTIC_DE,
                           &error));
  OK(abbe_file_read(path, 1 << 16, &text, &size, &error));
  assert_contains(text, "## gem.yaml");
  assert_contains(text, "6 pictures are missing");
  assert_contains(text, "| w7 p32 m512 s1 | 10 | - | - | 8 (0.5) |");
  assert_contains(text, "| w7 p128 m512 s1 | 40 | - | - | 2 (0.5) |");
  assert_contains(text, "| baseline: thesis w7 p512 m1024 s1 | 40 | - | - | 8 |");
  /* It has the baseline's error four times sooner, and a quarter of it in its time. */
  assert_contains(text,
                  "best factor on its brightness | frame, ms | 4 | 0.25 | 4 | 0.25 | 1 of 1 |");
  free(text);
  unlink(path);
  abbe_sweep_table_free(&t);
}

TEST(names_of_pictures) {
  abbe_sweep_table t[2] = {make_table(), make_table()};
  char path[ABBE_SWEEP_PATH];
  abbe_sweep_page_picture("out/trade.md", t, 0, 0, path);
  assert_string_equal(path, "out/trade-gem-reference.png");
  abbe_sweep_page_picture("out/trade.md", t, 1, 3, path);
  assert_string_equal(path, "out/trade-gem-2-accurate.png");
  for (int i = 0; i < 2; i++) abbe_sweep_table_free(&t[i]);
}
