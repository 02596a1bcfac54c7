#include "colorimetry/plot/sheet.h"

#include "tests/check.h"
#include "tests/fontconfig.h"

#include <unistd.h>

static char folder[] = "/tmp/abbe-test-sheet-XXXXXX", path[64];

static void setup(void) {
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/s.pdf", folder);
}

static void teardown(void) {
  assert_false(rmdir(folder));
}

static abbe_sheet *begin(void) {
  abbe_sheet *sheet;
  OK(abbe_sheet_make(path, &sheet, &error));
  abbe_sheet_text(sheet, 40, 40, 12, true, false, 0, "a line of text");
  abbe_sheet_line(sheet, 40, 45, 300, 45, 0.5);
  return sheet;
}

GROUP(setup, teardown);

/* Cairo compresses what it draws; the number of pages stands in the open. */
TEST(pages_are_written) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_sheet *sheet = begin();
  MADE(abbe_image, image, abbe_image_make(8, 4, 3, names, &image, &error));
  OK(abbe_sheet_picture(sheet, 40, 60, 160, 80, &image, &error));
  const double x[2] = {0, 1}, y[2] = {1, 2};
  const abbe_chart_series series = {.count = 2, .x = x, .y = y};
  const abbe_chart chart = {.series_count = 1, .series = &series};
  abbe_sheet_turn(sheet);
  OK(abbe_sheet_chart(sheet, 40, 60, 400, 200, 0.7, &chart, &error));
  assert_int_equal(access(path, F_OK), -1); /* not before it is whole */
  OK(abbe_sheet_finish(sheet, &error));
  FILE *file = fopen(path, "rb");
  assert_non_null(file);
  static char data[1 << 20];
  const size_t size = fread(data, 1, sizeof data - 1, file);
  fclose(file);
  assert_memory_equal(data, "%PDF-", 5);
  bool counted = false;
  for (size_t i = 0; i + 8 < size; i++) counted = counted || memcmp(data + i, "/Count 2", 8) == 0;
  assert_true(counted);
  assert_int_equal(unlink(path), 0);
}

TEST(wrong_requests_are_refused) {
  static const char *const grey[] = {"Y"};
  abbe_sheet *sheet;
  REFUSED(ABBE_INVALID_ARGUMENT, ".pdf", abbe_sheet_make("s.png", &sheet, &error));
  REFUSED(ABBE_IO, "", abbe_sheet_make("/nowhere/s.pdf", &sheet, &error));
  sheet = begin();
  MADE(abbe_image, image, abbe_image_make(2, 2, 1, grey, &image, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sheet_picture(sheet, 0, 0, 9, 9, &image, &error));
  const abbe_chart chart = {.x = {.min = 2, .max = 1}};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sheet_chart(sheet, 0, 0, 99, 99, 0, &chart, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sheet_chart(sheet, 0, 0, 99, 99, 1, &chart, &error));
  abbe_sheet_free(sheet); /* and no file is there */
  assert_int_equal(access(path, F_OK), -1);
  abbe_sheet_free(NULL);
}
