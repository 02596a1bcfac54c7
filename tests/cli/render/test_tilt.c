/* `--tilt`: of every command that reads a scene, and what is no tilt. */
#include "tests/cli/run_program.h"

#include <cjson/cJSON.h>

#define STONE "\"$house\"/scenes/stone.yaml "

/* Extent of the stone along z, m, by the plan. */
static double height(const char *options) {
  const char *line = printed("\"$abbe\" plan " STONE "--json %s", options);
  if (run_line(line) != 0) fail_msg("%s", run_errors);
  cJSON *json = cJSON_Parse(run_output);
  const cJSON *stone = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, "objects"), 0);
  double ends[2];
  for (int k = 0; k < 2; k++)
    ends[k] = cJSON_GetNumberValue(
        cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(stone, k ? "max" : "min"), 2));
  cJSON_Delete(json);
  return ends[1] - ends[0];
}

GROUP(run_setup, run_teardown);

/* A round stone lying on its side is as high as it is wide, 8 mm at least, about any axis. */
TEST(a_stone_is_tilted) {
  const double level = height("");
  assert_int_in_range((int)(1e6 * level), 5000, 6500);
  assert_near(height("--tilt 0"), level, 0);
  assert_near(height("--tilt 180"), level, 1e-9);
  assert_true(height("--tilt 90") > 0.00799 && height("--tilt -90,45") > 0.00799);
  assert_true(height("--tilt 10") > level + 1e-4);
}

TEST(what_is_no_tilt) {
#define PLAN "\"$abbe\" plan "
  assert_true(run_refuses(PLAN STONE "--tilt steep", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt 10,", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt 10,x", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt 400", 2, "--tilt"));
  assert_true(run_refuses(PLAN STONE "--tilt ''", 2, "--tilt"));
  assert_true(run_refuses(PLAN "\"$house\"/scenes/gem.yaml --tilt 1e99", 2, "--tilt"));
}
