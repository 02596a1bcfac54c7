/* Files are watched as they were read. */
#include "tests/check.h"

#include "cli/view/work/view_files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char names[2][32];

static void set_time(const char *path, long seconds) {
  const struct timespec times[2] = {{.tv_sec = seconds}, {.tv_sec = seconds}};
  assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static int make(void **state) {
  (void)state;
  for (int i = 0; i < 2; i++) {
    snprintf(names[i], sizeof names[i], "/tmp/abbe-files-XXXXXX");
    const int file = mkstemp(names[i]);
    if (file < 0 || close(file) != 0) return 1;
    set_time(names[i], 100);
  }
  return 0;
}

static int drop(void **state) {
  (void)state;
  for (int i = 0; i < 2; i++) unlink(names[i]);
  return 0;
}

/* As if a scene of these had just been read. */
static void take(abbe_view_files *files, size_t count) {
  abbe_view_scene_news news = {.file_count = count};
  news.file = calloc(count + 1, sizeof *news.file);
  assert_non_null(news.file);
  for (size_t i = 0; i < count; i++) news.file[i] = strdup(names[i]);
  abbe_view_files_take(files, &news);
  assert_int_equal(files->count, count);
  assert_null(news.file);
  abbe_view_scene_news_free(&news);
}

static void test_a_change_is_told_once(void **state) {
  (void)state;
  abbe_view_files files = {0};
  assert_false(abbe_view_files_changed(&files));
  take(&files, 2);
  assert_false(abbe_view_files_changed(&files));
  set_time(names[1], 200);
  assert_true(abbe_view_files_changed(&files));
  assert_false(abbe_view_files_changed(&files));
  unlink(names[1]);
  assert_false(abbe_view_files_changed(&files));
  abbe_view_files_free(&files);
}

/* One worker reads a file, it changes, and another one reads it: the first has to read again. */
static void test_what_two_have_read_is_watched_from_the_first(void **state) {
  (void)state;
  abbe_view_files files = {0};
  take(&files, 1);
  set_time(names[0], 300);
  take(&files, 2);
  assert_true(abbe_view_files_changed(&files));
  assert_false(abbe_view_files_changed(&files));
  abbe_view_files_free(&files);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_a_change_is_told_once, make, drop),
      cmocka_unit_test_setup_teardown(test_what_two_have_read_is_watched_from_the_first, make,
                                      drop)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
