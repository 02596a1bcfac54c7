/* Presets off sweeps: what is common to a class, its worst errors, and the three that get names. */
#include "tests/validation/tradeoff/sweep_row.h"

#include "base/file.h"
#include "base/yaml/yaml.h"
#include "validation/tradeoff/sweep_presets.h"

#include <unistd.h>

static char path[64];

static void setup(void) {
  snprintf(path, sizeof path, "/tmp/abbe-test-presets-XXXXXX");
  int file = mkstemp(path);
  assert_false(file < 0);
  assert_int_equal(close(file), 0);
}

static void teardown(void) {
  assert_false(unlink(path));
}

static void add(abbe_sweep_table *t, const char *profile, size_t photons, double light, double eye,
                double error) {
  abbe_sweep_row row = sweep_row(profile, photons);
  row.number[ABBE_SWEEP_LIGHT_MS] = light;
  row.number[ABBE_SWEEP_EYE_MS] = eye;
  row.number[ABBE_SWEEP_FRAME_MS] = light + eye;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = error;
  assert_int_equal(abbe_sweep_table_add(t, &row, NULL), ABBE_OK);
}

static abbe_sweep_table table_of(const char *scene, const char *of) {
  abbe_sweep_table t = {0};
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_SCENE, scene);
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_CLASS, of);
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_MACHINE, "a \"good\" one");
  return t;
}

static bool is_fine(const abbe_sweep_setting *setting) {
  return setting->photons > 300;
}

static double number(abbe_yaml *yaml, abbe_yaml_node node, const char *key) {
  double value = NAN;
  OK(abbe_yaml_get_number(yaml, node, key, -1e9, 1e9, &value, &error));
  return value;
}

GROUP(setup, teardown);

TEST(a_class_of_two_scenes) {
  static const char *const names[] = {"n.csv", "a.csv", "b.csv", "c.csv"};
  abbe_sweep_table all[] = {
      table_of("scenes/noisy.yaml", "convex"), table_of("scenes/gem.yaml", "convex"),
      table_of("scenes/prism.yaml", "convex"), table_of("scenes/ball.yaml", "spheres")};
  abbe_sweep_table *t = all + 1;
  /* A reference so noisy that its errors tell nothing: no part of the class. */
  add(&all[0], "default", 64, 1, 1, 90);
  all[0].row[0].number[ABBE_SWEEP_CAUSTIC_DE_NOISE] = 85;
  add(&t[0], "default", 64, 10, 1, 8);
  add(&t[1], "default", 64, 40, 4, 4);
  add(&t[0], "default", 128, 20, 1, 3);
  add(&t[1], "default", 128, 80, 1, 2);
  add(&t[0], "default", 256, 90, 1, 2.02);
  add(&t[1], "default", 256, 90, 1, 1);
  add(&t[0], "default", 512, 400, 1, 2);
  add(&t[1], "default", 512, 400, 1, 1);
  add(&t[0], "default", 1024, 1600, 1, 1.99);
  add(&t[1], "default", 1024, 1600, 1, 1);
  add(&t[0], "default", 48, 1, 1, 1);  /* in one of the two only */
  add(&t[1], "default", 32, 1, 1, 50); /* of an unknown error in the other */
  add(&t[0], "default", 32, 1, 1, NAN);
  add(&t[0], "thesis", 16, 1, 1, 0.1); /* no preset whatever it is worth */
  add(&t[1], "thesis", 16, 1, 1, 0.1);
  for (int k = 0; k < 2; k++) { /* cheap, but it gives up what others may be made of */
    add(&t[k], "default", 24, 1, 1, 0.5);
    t[k].row[t[k].count - 1].setting.share = 0.1;
  }
  add(&t[2], "default", 64, 5, 5, 1);
  abbe_error error = {0};
  abbe_yaml *yaml = NULL;
  if (abbe_sweep_presets_write(path, all, names, 4, ABBE_SWEEP_CAUSTIC_DE, is_fine, &error) !=
      ABBE_OK)
    fail_msg("%s", error.text);
  if (abbe_yaml_load(path, &yaml, &error) != ABBE_OK) fail_msg("%s", error.text);
  abbe_yaml_node root = abbe_yaml_root(yaml), classes = abbe_yaml_get(yaml, root, "classes");
  assert_string_equal(abbe_yaml_text(yaml, abbe_yaml_get(yaml, root, "error")), "caustic_de");
  assert_contains(abbe_yaml_text(yaml, abbe_yaml_get(yaml, root, "run")), "a \"good\" one");
  assert_int_equal(abbe_yaml_count(yaml, classes), 2);
  abbe_yaml_node convex = abbe_yaml_item(yaml, classes, 0);
  assert_string_equal(abbe_yaml_text(yaml, abbe_yaml_get(yaml, convex, "scenes")), "gem, prism");
  abbe_yaml_node front = abbe_yaml_get(yaml, convex, "front");
  /* The cheapest: geometric means. The others: that times the worse of the two scenes' ratios, 2
   * and 2, 9 and 2.25, 40 and 10 for the light, 1 and 0.25 for the eye. Errors: worst and best. */
  static const double right[][5] = {{64, 20, 2, 8, 4},
                                    {128, 40, 2, 3, 2},
                                    {256, 180, 2, 2.02, 1},
                                    {512, 800, 2, 2, 1},
                                    {1024, 3200, 2, 1.99, 1}};
  static const char *const keys[] = {"photons", "light_ms", "eye_ms", "error", "least"};
  assert_int_equal(abbe_yaml_count(yaml, front), 5);
  for (size_t i = 0; i < 5; i++)
    for (size_t k = 0; k < 5; k++)
      assert_near(number(yaml, abbe_yaml_item(yaml, front, i), keys[k]), right[i][k], 1e-6);
  /* Either scene left out: the gem's 2.02 against the prism's 1 is the worst; and its 91 ms against
   * the 10 x 2.25 + 1 x 0.25 that the prism's ratios promise. */
  assert_near(number(yaml, convex, "margin"), 2.02, 1e-9);
  assert_near(number(yaml, convex, "time_margin"), 4, 1e-9);
  assert_near(number(yaml, convex, "margin_scenes"), 2, 0);
  /* One scene tells nothing of others: the widest margins there are. */
  abbe_yaml_node spheres = abbe_yaml_item(yaml, classes, 1);
  assert_near(number(yaml, spheres, "margin"), 2.02, 1e-9);
  assert_near(number(yaml, spheres, "time_margin"), 4, 1e-9);
  assert_near(number(yaml, spheres, "margin_scenes"), 0, 0);
  assert_near(number(yaml, convex, "draft"), 0, 0);
  assert_near(number(yaml, convex, "balanced"), 1, 0); /* the one between */
  /* 2.02 is within 2 % of all that follow, but no finer than the defaults; 2 is within 2 % of 1.99
   */
  assert_near(number(yaml, convex, "accurate"), 3, 0);
  assert_true(isnan(number(yaml, spheres, "accurate")));
  abbe_yaml_free(yaml);
  char *text;
  size_t size;
  assert_int_equal(abbe_file_read(path, 1 << 16, &text, &size, NULL), ABBE_OK);
  assert_contains(text, "# accurate: no setting that is finer than the defaults is on the front");
  assert_contains(text, "# left out, for its reference's noise explains its errors: noisy.yaml");
  free(text);
  /* Alone it makes no presets. */
  assert_int_equal(
      abbe_sweep_presets_write(path, all, names, 1, ABBE_SWEEP_CAUSTIC_DE, is_fine, &error),
      ABBE_INVALID_ARGUMENT);
  assert_contains(error.text, "n.csv");
  for (int i = 0; i < 4; i++) abbe_sweep_table_free(&all[i]);
}

TEST(what_is_refused) {
  static const char *const names[] = {"a.csv", "b.csv"};
  abbe_sweep_table t[] = {table_of("gem.yaml", "convex"), table_of("prism.yaml", "convex")};
  char *text;
  size_t size;
  OK(abbe_file_write(path, "before", 6, &error));
  add(&t[0], "default", 64, 1, 1, 1);
  add(&t[1], "default", 32, 1, 1, 1);
  REFUSED(ABBE_INVALID_ARGUMENT, "a.csv: its class, convex, has no setting",
          abbe_sweep_presets_write(path, t, names, 2, ABBE_SWEEP_CAUSTIC_DE, is_fine, &error));
  abbe_sweep_table_set(&t[1], ABBE_SWEEP_FACT_MACHINE, "another");
  REFUSED(ABBE_INVALID_ARGUMENT, "a.csv and b.csv are of different machines",
          abbe_sweep_presets_write(path, t, names, 2, ABBE_SWEEP_CAUSTIC_DE, is_fine, &error));
  abbe_sweep_table_set(&t[0], ABBE_SWEEP_FACT_CLASS, "");
  REFUSED(ABBE_INVALID_ARGUMENT, "does not name its scene's class",
          abbe_sweep_presets_write(path, t, names, 1, ABBE_SWEEP_CAUSTIC_DE, is_fine, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_sweep_presets_write(path, t, names, 0, ABBE_SWEEP_CAUSTIC_DE, is_fine, &error));
  /* The file that was there is as it was. */
  OK(abbe_file_read(path, 100, &text, &size, &error));
  assert_string_equal(text, "before");
  free(text);
  for (int i = 0; i < 2; i++) abbe_sweep_table_free(&t[i]);
}
