/* A sweep from start to end: stopped and taken up again, its references, and whose rows it takes.
 */
#include "tests/gl/frame.h"

#include "colorimetry/image/exr.h"
#include "validation/sweep/sweep_grid.h"
#include "validation/sweep/sweep_run.h"

#include <unistd.h>

#define SCENE CAMERA POINT_LIGHT FLOOR BALL("crown")

static char folder[] = "/tmp/abbe-test-sweep-run-XXXXXX";

/* Says yes so often. */
static bool tick(void *user, const char *what, double done) {
  size_t *left = user;
  assert_string_equal(what, "sweep");
  assert_true(done >= 0 && done <= 1);
  return *left > 0 && (*left)-- > 0;
}

static void begin(void) {
  assert_non_null(mkdtemp(folder));
  make_context();
}

static void finish(void) {
  free_context();
  static const char *const files[] = {"s.csv", "r.exr"};
  for (size_t i = 0; i < 2; i++) {
    char path[96];
    snprintf(path, sizeof path, "%s/%s", folder, files[i]);
    unlink(path);
  }
  assert_int_equal(rmdir(folder), 0);
}

GROUP(begin, finish);

/* With a picture that is given: tracing one is tested through the program. */
TEST(a_sweep_goes_on_where_it_was_stopped) {
  static const char *const names[] = {"X", "Y", "Z"};
  OWNED(abbe_scene, scene) = {0};
  abbe_image image;
  FREED abbe_sweep_setting *setting = NULL;
  size_t count, refused, left = 0;
  char path[96], picture[96];
  snprintf(path, sizeof path, "%s/s.csv", folder);
  snprintf(picture, sizeof picture, "%s/r.exr", folder);
  load_text(SCENE, &scene);
  OK(abbe_image_make(16, 16, 3, names, &image, &error));
  for (size_t i = 0; i < 16 * 16 * 3; i++) image.data[i] = 0.01f;
  OK(abbe_exr_write(picture, &image, &error));
  abbe_image_free(&image);
  const abbe_sweep_grid grid = {
      .wavelengths = {1, {3}}, .photons = {1, {8}}, .map = {1, {32}}, .samples = {1, {1}}};
  OK(abbe_sweep_grid_expand(&scene, &grid, 1, &setting, &count, &refused, NULL, &error));
  abbe_sweep_request q = {.program = "abbe test",
                          .scene_path = "ball.yaml",
                          .table = path,
                          .reference = picture,
                          .frames = 1,
                          .setting = setting,
                          .setting_count = count,
                          .error = ABBE_SWEEP_PICTURE_DE,
                          .progress = tick,
                          .user = &left};
  abbe_sweep_table t;
  REFUSED(ABBE_CANCELLED, "0 of 1 settings are in ",
          abbe_sweep_run(context, &scene, &q, &t, &error));
  left = 99;
  OK(abbe_sweep_run(context, &scene, &q, &t, &error));
  assert_int_equal(left, 98);
  assert_int_equal(t.count, 1);
  assert_string_equal(t.fact[ABBE_SWEEP_FACT_SIZE], "16x16");
  assert_string_equal(t.fact[ABBE_SWEEP_FACT_CLASS], "spheres");
  assert_true(t.row[0].number[ABBE_SWEEP_PICTURE_DE] > 0 && t.row[0].front);
  abbe_sweep_table_free(&t);
  /* Nothing is left to measure. */
  OK(abbe_sweep_run(context, &scene, &q, &t, &error));
  assert_int_equal(left, 98);
  abbe_sweep_table_free(&t);
  /* Of another program these rows are not. */
  q.program = "abbe other";
  REFUSED(ABBE_INVALID_ARGUMENT, "were measured with the program 'abbe test'",
          abbe_sweep_run(context, &scene, &q, &t, &error));
}

TEST(settings_of_presets) {
  OWNED(abbe_scene, scene) = {0};
  abbe_sweep_setting *setting;
  size_t count;
  load_text(SCENE, &scene);
  OK(abbe_sweep_preset_settings(&scene, NULL, &setting, &count, &error));
  assert_true(count >= 3);
  assert_true(setting[0].photons < setting[count - 1].photons);
  free(setting);
  abbe_scene_free(&scene);
  load_text(CAMERA POINT_LIGHT FLOOR, &scene);
  REFUSED(ABBE_UNSUPPORTED, "", abbe_sweep_preset_settings(&scene, NULL, &setting, &count, &error));
  assert_null(setting);
}
