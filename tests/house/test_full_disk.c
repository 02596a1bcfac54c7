/* Every kind of file that the library writes, on a disk that is full after each byte, and with each
 * call on the way failing: the old file or the new one, nothing besides, and a sentence. */
#include "tests/brick.h"
#include "tests/check.h"
#include "tests/faults/disk.h"
#include "tests/fontconfig.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/plot/chart.h"
#include "scenes/export/pov_file.h"
#include "scenes/import/scene_file.h"
#include "spectral/editing/table_edit.h"
#include "validation/lab/volume_sums.h"
#include "validation/trace/tracer/checkpoint.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#define PARTS ABBE_SOURCE_DIR "/tests/fuzz/parts/"

static char folder[] = "/tmp/abbe-test-disk-XXXXXX";

/* ---- what is written ---- */

typedef struct target {
  const char *name;
  abbe_result (*write)(const char *path, abbe_error *error);
  const char *old; /* what stands there before; NULL: any text */
  const char *end; /* cairo numbers what it draws: a whole file ends with this; else NULL */
} target;

static abbe_image image;
static abbe_scene scene;
static abbe_tracer *tracer;

static abbe_result write_text(const char *path, abbe_error *error) {
  static const char text[] = "{\n  \"passes\": 3\n}\n";
  return abbe_file_write(path, text, sizeof text - 1, error);
}

static abbe_result write_exr(const char *path, abbe_error *error) {
  return abbe_exr_write(path, &image, error);
}

static abbe_result write_half(const char *path, abbe_error *error) {
  return abbe_exr_write_half(path, &image, error);
}

static abbe_result write_png(const char *path, abbe_error *error) {
  return abbe_png_write(path, &image, 8, error);
}

static abbe_result write_chart(const char *path, abbe_error *error) {
  static const double x[] = {1, 2}, y[] = {1, 2};
  const abbe_chart_series series = {.count = 2, .x = x, .y = y};
  const abbe_chart chart = {.series_count = 1, .series = &series};
  return abbe_chart_write(path, &chart, 1, 64, 64, error);
}

static abbe_result write_checkpoint(const char *path, abbe_error *error) {
  return abbe_checkpoint_save(tracer, path, error);
}

static abbe_result write_volume_checkpoint(const char *path, abbe_error *error) {
  static double values[1200];
  const abbe_kept_bytes part = {values, sizeof values};
  return abbe_volume_checkpoint_save(path, 7, 3, &part, 1, error);
}

static abbe_result write_pov(const char *path, abbe_error *error) {
  return abbe_pov_file_write(path, &scene, NULL, error);
}

static const char table[] =
    "materials:\n- {name: a, model: constant, coefficients: [1.5], source: s}\n";

static abbe_result edit_table(const char *path, abbe_error *error) {
  abbe_table_edit *edit = NULL;
  abbe_result result = abbe_table_edit_open(path, &edit, error);
  if (result == ABBE_OK) result = abbe_table_edit_set_text(edit, "a", "source", "elsewhere", error);
  if (result == ABBE_OK) result = abbe_table_edit_save(edit, error);
  abbe_table_edit_free(edit);
  return result;
}

static const target targets[] = {
    {"stats.json", write_text, NULL, NULL},
    {"picture.exr", write_exr, NULL, NULL},
    {"half.exr", write_half, NULL, NULL},
    {"picture.png", write_png, NULL, NULL},
    {"chart.svg", write_chart, NULL, "</svg>\n"},
    {"chart.png", write_chart, NULL, NULL},
    {"trace.checkpoint", write_checkpoint, NULL, NULL},
    {"volume.checkpoint", write_volume_checkpoint, NULL, NULL},
    {"scene.pov", write_pov, NULL, NULL},
    {"table.yaml", edit_table, table, NULL},
};

/* ---- the disk ---- */

static size_t entries(void) {
  size_t count = 0;
  DIR *dir = opendir(folder);
  assert_non_null(dir);
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) count++;
  closedir(dir);
  return count;
}

static const char *old_of(const target *t) {
  return t->old != NULL ? t->old : "what stood here before\n";
}

static void put(const char *path, const char *text) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fputs(text, file);
  assert_int_equal(fclose(file), 0);
}

typedef struct content {
  char *data;
  size_t size;
} content;

static content read_whole(const char *path) {
  content c = {0};
  OK(abbe_file_read(path, 1 << 24, &c.data, &c.size, &error));
  return c;
}

static bool holds(const char *path, const char *data, size_t size) {
  content c = read_whole(path);
  const bool same = c.size == size && memcmp(c.data, data, size) == 0;
  free(c.data);
  return same;
}

static void limit_files(size_t bytes) {
  static struct rlimit whole;
  if (whole.rlim_max == 0) assert_int_equal(getrlimit(RLIMIT_FSIZE, &whole), 0);
  struct rlimit limit = whole;
  if (bytes != (size_t)-1) limit.rlim_cur = bytes;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

static const char *path_of(const target *t) {
  static char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, t->name);
  return path;
}

static bool is_whole(const target *t, const content *whole) {
  if (t->end == NULL) return holds(path_of(t), whole->data, whole->size);
  content c = read_whole(path_of(t));
  const size_t length = strlen(t->end);
  const bool ends = c.size >= length && memcmp(c.data + c.size - length, t->end, length) == 0;
  free(c.data);
  return ends;
}

/* The file as it is when nothing fails. */
static content write_whole(const target *t) {
  abbe_error error = {0};
  put(path_of(t), old_of(t));
  if (t->write(path_of(t), &error) != ABBE_OK) fail_msg("%s: %s", t->name, error.text);
  return read_whole(path_of(t));
}

static bool full_after(const target *t, size_t bytes) {
  const char *path = path_of(t), *old = old_of(t);
  abbe_error error = {0};
  limit_files(bytes);
  const abbe_result result = t->write(path, &error);
  limit_files((size_t)-1);
  const bool right = result == ABBE_IO && strstr(error.text, path) != NULL &&
                     strstr(error.text, "File too large") != NULL &&
                     holds(path, old, strlen(old)) && entries() == 3;
  if (!right)
    print_error("%s, full after %zu bytes: %s: %s; %zu entries\n", t->name, bytes,
                abbe_result_text(result), error.text, entries());
  return right;
}

/* Up to two thousand bytes each of them, beyond that and of what takes its time a share of them and
 * the last ones. */
TEST(a_disk_that_is_full_after_each_byte) {
  size_t wrong = 0;
  for (int named = 0; named < 2; named++)
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
      const target *t = &targets[i];
      faults_disk_unnamed(!named);
      content whole = write_whole(t);
      put(path_of(t), old_of(t));
      const bool slow = t->write == write_chart || t->write == write_pov;
      const size_t step = 1 + whole.size / (named || slow ? 40 : 2000);
      for (size_t n = 0; n < whole.size && wrong < 5; n += n + 20 < whole.size ? step : 1)
        wrong += !full_after(t, n);
      limit_files(whole.size + (t->end != NULL ? 1000 : 0));
      abbe_error error = {0};
      const abbe_result result = t->write(path_of(t), &error);
      limit_files((size_t)-1);
      if (result != ABBE_OK) fail_msg("%s, with room for it: %s", t->name, error.text);
      assert_true(is_whole(t, &whole));
      free(whole.data);
      unlink(path_of(t));
    }
  assert_int_equal(wrong, 0);
}

/* The n-th call failing: the old file with a sentence, or the new one. */
static bool fails_at(const target *t, const content *whole, size_t n, int number) {
  const char *path = path_of(t), *old = old_of(t);
  abbe_error error = {0};
  put(path, old);
  faults_disk_begin(n, number);
  const abbe_result result = t->write(path, &error);
  faults_disk_end();
  bool right = entries() == 3;
  if (result == ABBE_OK)
    right = right && is_whole(t, whole);
  else
    right = right && result == ABBE_IO && strstr(error.text, path) != NULL &&
            strstr(error.text, strerror(number)) != NULL && holds(path, old, strlen(old));
  if (!right)
    print_error("%s, call %zu (%s): %s: %s; %zu entries\n", t->name, n, faults_disk_what(),
                abbe_result_text(result), error.text, entries());
  return right;
}

TEST(each_call_failing) {
  static const int numbers[] = {EIO, ENOSPC};
  size_t wrong = 0, all = 0;
  for (int named = 0; named < 2; named++)
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
      const target *t = &targets[i];
      faults_disk_unnamed(!named);
      content whole = write_whole(t);
      put(path_of(t), old_of(t));
      faults_disk_begin(0, 0);
      assert_int_equal(t->write(path_of(t), NULL), ABBE_OK);
      const size_t calls = faults_disk_end();
      for (size_t n = 1; n <= calls; n++, all++) wrong += !fails_at(t, &whole, n, numbers[n % 2]);
      free(whole.data);
      unlink(path_of(t));
    }
  assert_int_equal(wrong, 0);
  assert_true(all > 100);
}

/* ---- set-up ---- */

static void setup(void) {
  static const char *const names[] = {"R", "G", "B"};
  const abbe_trace_desc desc = {
      .width = 3, .height = 2, .map_width = 2, .map_height = 2, .photons = 64, .threads = 1};
  abbe_error error = {0};
  signal(SIGXFSZ, SIG_IGN);
  assert_non_null(mkdtemp(folder));
  abbe_result result = abbe_image_make(7, 5, 3, names, &image, &error);
  for (size_t i = 0; i < 7 * 5 * 3 && result == ABBE_OK; i++) image.data[i] = 0.01f * (float)i;
  if (result == ABBE_OK)
    result =
        abbe_scene_parse(brick_scene, sizeof brick_scene - 1, PARTS "f.yaml", NULL, &scene, &error);
  if (result == ABBE_OK) result = abbe_tracer_make(&scene, &desc, &tracer, &error);
  if (result == ABBE_OK) result = abbe_tracer_pass(tracer, NULL, &error);
  if (result != ABBE_OK) fprintf(stderr, "%s\n", error.text);
  assert_int_equal(result, ABBE_OK);
}

static void teardown(void) {
  abbe_tracer_free(tracer);
  abbe_scene_free(&scene);
  abbe_image_free(&image);
  assert_false(rmdir(folder));
}

GROUP(setup, teardown);
