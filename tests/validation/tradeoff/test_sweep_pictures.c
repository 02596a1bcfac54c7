/* Whole pictures off sweeps: fronts of each tool, told by the yardstick; numbers worked out by
 * hand.
 */
#include "tests/validation/tradeoff/sweep_row.h"

#include "base/yaml/yaml.h"
#include "validation/tradeoff/sweep_pictures.h"

static abbe_sweep_table table_of(const char *of) {
  abbe_sweep_table t = {0};
  abbe_sweep_table_set(&t, ABBE_SWEEP_FACT_CLASS, of);
  return t;
}

static abbe_sweep_row *add(abbe_sweep_table *t, const char *profile, size_t photons, size_t passes,
                           double warm_ms, double error) {
  abbe_sweep_row row = sweep_row(profile, photons);
  row.setting.passes = passes;
  row.number[ABBE_SWEEP_FRAME_MS] = warm_ms / 2;
  row.number[ABBE_SWEEP_WARM_MS] = warm_ms;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = error;
  assert_int_equal(abbe_sweep_table_add(t, &row, NULL), ABBE_OK);
  return &t->row[t->count - 1];
}

static void add_yardstick(abbe_sweep_table *t, double ms, double own) {
  abbe_sweep_row *row = add(t, ABBE_SWEEP_TRACE, ABBE_PICTURE_YARDSTICK_PHOTONS,
                            ABBE_PICTURE_YARDSTICK_PASSES, 10 * ms, 2 * own);
  row->number[ABBE_SWEEP_FRAME_MS] = ms;
  row->number[ABBE_SWEEP_OWN_DE] = own;
}

/* What is written of the class, under a key of that name. */
static char *write(const abbe_sweep_table *tables, size_t count, const char *of) {
  char *text = NULL;
  size_t size = 0;
  FILE *file = open_memstream(&text, &size);
  fprintf(file, "class:\n");
  OK(abbe_sweep_pictures_write(file, tables, count, of, ABBE_SWEEP_CAUSTIC_DE, &error));
  fclose(file);
  return text;
}

static double number(abbe_yaml *yaml, abbe_yaml_node node, const char *key) {
  double value = NAN;
  OK(abbe_yaml_get_number(yaml, node, key, -1e9, 1e9, &value, &error));
  return value;
}

static void assert_point(abbe_yaml *yaml, abbe_yaml_node tool, size_t i, double photons, double ms,
                         double error, double least) {
  abbe_yaml_node point = abbe_yaml_item(yaml, abbe_yaml_get(yaml, tool, "front"), i);
  assert_near(number(yaml, point, "photons"), photons, 0);
  assert_near(number(yaml, point, "ms"), ms, 0.051);
  assert_near(number(yaml, point, "error"), error, 1e-3 * error);
  assert_near(number(yaml, point, "least"), least, 1e-3 * least);
}

TEST(two_scenes) {
  abbe_sweep_table t[] = {table_of("convex"), table_of("convex"), table_of("spheres")};
  abbe_error error = {0};
  abbe_yaml *yaml;
  /* The second scene takes four times the time and a quarter of the noise: means 20 ms and 4. */
  add_yardstick(&t[0], 10, 8);
  add_yardstick(&t[1], 40, 2);
  add(&t[0], "default", 64, 0, 500, 3);
  add(&t[1], "default", 64, 0, 1000, 5);
  add(&t[0], "default", 256, 0, 600, 1); /* ms: 20 x max(60, 50) */
  add(&t[1], "default", 256, 0, 2000, 2);
  add(&t[0], "default", 512, 0, 900, 4); /* no better: not on the front */
  add(&t[1], "default", 512, 0, 3000, 4);
  add(&t[0], "default", 128, 0, 100, 1); /* the other sweep has no process of it */
  add(&t[1], "default", 128, 0, NAN, 1);
  add(&t[0], ABBE_SWEEP_TRACE, 512, 4, 200, 4); /* of the noise 1/2 and 1/1 */
  add(&t[1], ABBE_SWEEP_TRACE, 512, 4, 1600, 2);
  char *text = write(t, 3, "convex");
  if (abbe_yaml_parse(text, strlen(text), "it", &yaml, &error) != ABBE_OK)
    fail_msg("%s: %s", error.text, text);
  abbe_yaml_node p =
      abbe_yaml_get(yaml, abbe_yaml_get(yaml, abbe_yaml_root(yaml), "class"), "pictures");
  if (p.id == 0) fail_msg("%s", text);
  assert_near(number(yaml, p, "base_ms"), 20, 1e-9);
  assert_near(number(yaml, p, "base_error"), 4, 1e-9);
  assert_near(number(yaml, p, "margin_scenes"), 2, 0);
  /* Each scene beside the other alone: errors 3 and 5, 1 and 2; times 50 and 25, 60 and 50. */
  abbe_yaml_node render = abbe_yaml_get(yaml, p, "render"), trace = abbe_yaml_get(yaml, p, "trace");
  assert_point(yaml, render, 0, 64, 20 * 50, 5, 3);
  assert_point(yaml, render, 1, 256, 20 * 60, 2, 1);
  assert_int_equal(abbe_yaml_count(yaml, abbe_yaml_get(yaml, render, "front")), 2);
  assert_near(number(yaml, render, "margin"), 2, 1e-9);
  assert_near(number(yaml, render, "time_margin"), 2, 1e-9);
  /* The yardstick itself: ten times its frame, twice its own error, in both. */
  assert_point(yaml, trace, 0, 128, 20 * 10, 8, 8);
  assert_point(yaml, trace, 1, 512, 20 * 40, 4, 2);
  assert_near(number(yaml, trace, "margin"), 2, 1e-9);
  assert_near(number(yaml, trace, "time_margin"), 2, 1e-9);
  assert_int_equal(abbe_yaml_get(yaml, p, "trace-filter").id, 0);
  abbe_yaml_free(yaml);
  free(text);
  /* One has no yardstick; another class has none at all. */
  text = write(t, 3, "spheres");
  assert_string_equal(text, "class:\n");
  free(text);
  t[0].row[0].number[ABBE_SWEEP_OWN_DE] = NAN;
  text = write(t, 3, "convex");
  assert_string_equal(text, "class:\n");
  free(text);
  for (int i = 0; i < 3; i++) abbe_sweep_table_free(&t[i]);
}

/* A class with one scene takes the widest margins of the others, tool by tool. */
TEST(one_scene) {
  abbe_sweep_table t[] = {table_of("spheres"), table_of("convex"), table_of("convex"),
                          table_of("meshes"), table_of("meshes")};
  abbe_error error = {0};
  abbe_yaml *yaml;
  for (int i = 0; i < 5; i++) {
    add_yardstick(&t[i], 10, 4);
    add(&t[i], "default", 64, 0, i == 2 ? 1500 : 500, i == 2 ? 6 : 3); /* margins: 3 and 2 */
    add(&t[i], ABBE_SWEEP_TRACE, 512, 4, 200, i == 4 ? 2.5 : 1);       /* 1 and 2.5 */
  }
  add(&t[0], ABBE_SWEEP_TRACE_FILTER, 512, 4, 300, 1); /* the others have none of it */
  char *text = write(t, 5, "spheres");
  if (abbe_yaml_parse(text, strlen(text), "it", &yaml, &error) != ABBE_OK)
    fail_msg("%s: %s", error.text, text);
  abbe_yaml_node p =
      abbe_yaml_get(yaml, abbe_yaml_get(yaml, abbe_yaml_root(yaml), "class"), "pictures");
  abbe_yaml_node render = abbe_yaml_get(yaml, p, "render"), trace = abbe_yaml_get(yaml, p, "trace");
  abbe_yaml_node filtered = abbe_yaml_get(yaml, p, "trace-filter");
  assert_near(number(yaml, p, "margin_scenes"), 0, 0);
  assert_near(number(yaml, render, "margin"), 2, 1e-9);
  assert_near(number(yaml, render, "time_margin"), 3, 1e-9);
  assert_near(number(yaml, trace, "margin"), 2.5, 1e-9);
  assert_near(number(yaml, trace, "time_margin"), 1, 1e-9);
  assert_near(number(yaml, filtered, "margin"), 1, 0);
  abbe_yaml_free(yaml);
  free(text);
  /* Of one with two scenes its own count. */
  text = write(t, 5, "meshes");
  assert_contains(text, "render:\n      margin: 1\n      time_margin: 1\n");
  free(text);
  for (int i = 0; i < 5; i++) abbe_sweep_table_free(&t[i]);
}

TEST(tools) {
  static const char *const profiles[] = {"default", "trace", "trace-filter", "thesis"};
  static const char *const tools[] = {"render", "trace", "trace-filter", "unknown"};
  for (int i = 0; i < 4; i++) {
    abbe_sweep_row row = sweep_row(profiles[i], 64);
    assert_int_equal(abbe_picture_tool_of(&row.setting), i);
    assert_string_equal(abbe_picture_tool_name((abbe_picture_tool)i), tools[i]);
  }
}
