/* Files are watched as they were read. */
#include "tests/check.h"

#include "cli/view/work/view_scene.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static char names[2][32];

static void set_time(const char *path, long seconds) {
  const struct timespec times[2] = {{.tv_sec = seconds}, {.tv_sec = seconds}};
  assert_int_equal(utimensat(AT_FDCWD, path, times, 0), 0);
}

static void make(void) {
  for (int i = 0; i < 2; i++) {
    snprintf(names[i], sizeof names[i], "/tmp/abbe-files-XXXXXX");
    const int file = mkstemp(names[i]);
    assert_false(file < 0);
    assert_int_equal(close(file), 0);
    set_time(names[i], 100);
  }
}

static void drop(void) {
  for (int i = 0; i < 2; i++) unlink(names[i]);
}

/* As if a scene of these had just been read. */
static void take(abbe_view_files *files, size_t count) {
  OWNED(abbe_view_scene_news, news) = {.file_count = count};
  news.file = calloc(count + 1, sizeof *news.file);
  assert_non_null(news.file);
  for (size_t i = 0; i < count; i++) news.file[i] = strdup(names[i]);
  abbe_view_files_take(files, &news);
  assert_int_equal(files->count, count);
  assert_null(news.file);
}

EACH(make, drop);

TEST(a_change_is_told_once) {
  OWNED(abbe_view_files, files) = {0};
  assert_false(abbe_view_files_changed(&files));
  take(&files, 2);
  assert_false(abbe_view_files_changed(&files));
  set_time(names[1], 200);
  assert_true(abbe_view_files_changed(&files));
  assert_false(abbe_view_files_changed(&files));
  unlink(names[1]);
  assert_false(abbe_view_files_changed(&files));
}

/* One worker reads a file, it changes, and another one reads it: the first has to read again. */
TEST(what_two_have_read_is_watched_from_the_first) {
  FILLED(abbe_view_files, files, take(&files, 1));
  set_time(names[0], 300);
  take(&files, 2);
  assert_true(abbe_view_files_changed(&files));
  assert_false(abbe_view_files_changed(&files));
}
