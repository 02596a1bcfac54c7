/* A table that a thread makes: none at first, then the one that abbe_display_table_make makes. */
#include "tests/check.h"

#include "cli/view/picture/view_show.h"

#include <time.h>

enum { SIDE = 64 };

static void make_image(abbe_image *out) {
  static const char *const names[] = {"R", "G", "B"};
  OK(abbe_image_make(SIDE, SIDE, 3, names, out, &error));
  for (size_t i = 0; i < 3 * SIDE * SIDE; i++)
    out->data[i] = (float)exp2(0.01 * (double)(i * 7919 % 1200) - 9);
}

TEST(it_is_the_one_that_is_made_at_once) {
  const abbe_display_desc desc = {.display = "sRGB", .view = "Looking"};
  const struct timespec time = {.tv_nsec = 1000000};
  abbe_display *display = NULL;
  abbe_display_table *other = NULL;
  OK(abbe_display_make(&desc, &display, &error));
  abbe_view_table *table = abbe_view_table_begin(display);
  assert_non_null(table);
  OK(abbe_display_table_make(display, &other, &error));
  while (abbe_view_table_get(table) == NULL) nanosleep(&time, NULL);
  FILLED(abbe_image, a, make_image(&a));
  FILLED(abbe_image, b, make_image(&b));
  OK(abbe_display_table_apply(abbe_view_table_get(table), &a, &error));
  OK(abbe_display_table_apply(other, &b, &error));
  assert_memory_equal(a.data, b.data, 3 * sizeof *a.data * SIDE * SIDE);
  abbe_display_table_free(other);
  abbe_view_table_free(table);
  abbe_display_free(display);
}

TEST(it_may_be_left_before_it_is_made) {
  abbe_display *display = NULL;
  OK(abbe_display_make(&(abbe_display_desc){.view = NULL}, &display, &error));
  abbe_view_table_free(abbe_view_table_begin(display));
  assert_null(abbe_view_table_get(NULL));
  abbe_view_table_free(NULL);
  abbe_display_free(display);
}
