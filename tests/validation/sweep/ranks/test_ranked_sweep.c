#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
/* Two ranks measure what one process measures, and take up what ranks before them have left. */
#include "tests/gl/frame.h"

#include "colorimetry/image/exr.h"
#include "tests/validation/ranks/forked_ranks.h"
#include "validation/ranks/rank_files.h"
#include "validation/sweep/ranks/ranked_sweep.h"
#include "validation/sweep/sweep_grid.h"

#include <unistd.h>

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")

static char folder[] = "/tmp/abbe-test-ranked-sweep-XXXXXX";
static char picture[96], table[96], one[96];

typedef struct asked {
  abbe_scene scene;
  abbe_sweep_request q;
  abbe_sweep_setting *setting;
  size_t measured;
  abbe_sweep_table out;
  abbe_error error;
} asked;

static bool tick(void *user, const char *what, double done) {
  asked *a = user;
  (void)what;
  a->measured += done == 0;
  return true;
}

static void prepare(asked *a) {
  static const char *const names[] = {"X", "Y", "Z"};
  const abbe_sweep_grid grid = {
      .wavelengths = {1, {3}}, .photons = {3, {8, 12, 16}}, .map = {1, {32}}, .samples = {1, {1}}};
  abbe_image image;
  size_t refused;
  *a = (asked){0};
  load_text(SCENE, &a->scene);
  OK(abbe_image_make(16, 16, 3, names, &image, &error));
  for (size_t i = 0; i < 16 * 16 * 3; i++) image.data[i] = 0.01f;
  OK(abbe_exr_write(picture, &image, &error));
  abbe_image_free(&image);
  a->q = (abbe_sweep_request){.program = "abbe test",
                              .scene_path = "ball.yaml",
                              .table = table,
                              .reference = picture,
                              .frames = 1,
                              .error = ABBE_SWEEP_PICTURE_DE,
                              .progress = tick,
                              .user = a};
  OK(abbe_sweep_grid_expand(&a->scene, &grid, 1, &a->setting, &a->q.setting_count, &refused, NULL,
                            &error));
  a->q.setting = a->setting;
  assert_int_equal(a->q.setting_count, 3);
}

/* Of a rank that was killed after its one row: as if it had been the last of three. */
static void leave_a_row(const asked *a, double time_ms) {
  OWNED(abbe_sweep_table, t) = {0};
  char path[128];
  OK(abbe_sweep_table_load(one, &t, &error));
  t.row[0] = t.row[2];
  t.row[0].number[ABBE_SWEEP_FRAME_MS] = time_ms;
  t.count = 1;
  assert_true(abbe_sweep_setting_same(&t.row[0].setting, &a->setting[2]));
  snprintf(path, sizeof path, "%s.2", table);
  OK(abbe_sweep_table_save(&t, path, &error));
}

/* A context is made where its process is: none is there when it forks. */
static abbe_result work(const abbe_ranks *ranks, void *user) {
  asked *a = user;
  abbe_context *own = NULL;
  abbe_result result = abbe_context_make(ABBE_CONTEXT_CPU, &own, &a->error);
  if (result != ABBE_OK) return result;
  result = ranks == NULL ? abbe_sweep_run(own, &a->scene, &a->q, &a->out, &a->error)
                         : abbe_ranked_sweep(ranks, own, &a->scene, &a->q, &a->out, &a->error);
  abbe_context_free(own);
  return result;
}

static abbe_result work_alone(const abbe_ranks *ranks, void *user) {
  asked *a = user;
  (void)ranks;
  a->q.table = one;
  return forked_rank == 1 ? work(NULL, a) : ABBE_OK;
}

static void begin(void) {
  assert_non_null(mkdtemp(folder));
  snprintf(picture, sizeof picture, "%s/r.exr", folder);
  snprintf(table, sizeof table, "%s/t.csv", folder);
  snprintf(one, sizeof one, "%s/one.csv", folder);
}

static void finish(void) {
  unlink(picture);
  unlink(table);
  unlink(one);
  assert_int_equal(rmdir(folder), 0);
}

GROUP(begin, finish);

TEST(ranks_measure_what_one_does) {
  asked a;
  abbe_result other;
  abbe_sweep_table whole = {0};
  prepare(&a);
  OK(forked_run(2, work_alone, &a, &other));
  assert_int_equal(other, ABBE_OK);
  leave_a_row(&a, 12345);
  a.q.table = table;
  OK(forked_run(2, work, &a, &other));
  assert_int_equal(other, ABBE_OK);
  OK(abbe_sweep_table_load(one, &whole, &error));
  assert_int_equal(a.out.count, 3);
  for (size_t i = 0; i < 3; i++) {
    assert_true(abbe_sweep_setting_same(&a.out.row[i].setting, &a.setting[i]));
    assert_true(a.out.row[i].number[ABBE_SWEEP_PICTURE_DE] > 0);
    assert_true(a.out.row[i].number[ABBE_SWEEP_PICTURE_DE] ==
                whole.row[i].number[ABBE_SWEEP_PICTURE_DE]);
  }
  assert_near(a.out.row[2].number[ABBE_SWEEP_FRAME_MS], 12345, 0); /* was not measured again */
  size_t *rank, count;
  OK(abbe_rank_files_find(table, &rank, &count, &error));
  assert_int_equal(count, 0);
  abbe_sweep_table_free(&whole);
  abbe_sweep_table_free(&a.out);
  /* rows of another program are refused before any is measured; a process that has drawn does not
   * fork */
  a.q.program = "abbe other";
  assert_int_equal(forked_run(1, work, &a, NULL), ABBE_INVALID_ARGUMENT);
  assert_contains(a.error.text, "were measured with the program 'abbe test'");
  OK(abbe_rank_files_find(table, &rank, &count, &error));
  assert_int_equal(count, 0);
  free(a.setting);
  abbe_scene_free(&a.scene);
}
