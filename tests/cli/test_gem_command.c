/* `abbe gem` as people and programs meet it: what a design holds, sheets, conversions, other
 * angles, refusals that leave nothing behind. */
#include "tests/cli/run_json.h"

#define GEM "\"$abbe\" gem "
#define QUARTZ " \"$house\"/scenes/designs/brilliant-quartz.asc "

GROUP(run_setup, run_teardown);

TEST(a_design_is_described) {
  run_says(GEM "info" QUARTZ "--material diamond --width 6.5 --density 3.52",
           "57 + 16 girdle: 33 crown, 24 pavilion; 57 corners, 128 edges");
  assert_contains(run_output, "critical angle 40.37 degrees");
  assert_contains(run_output, "Meet A-A-B-B");
  assert_contains(run_output, "main       crown 42.00 degrees, facets B; pavilion 43.00 degrees");
  assert_contains(run_output, "carats");
  HELD(cJSON, json) = run_json(GEM "info" QUARTZ "--json", 0);
  assert_near(json_number(json_item(json, "facets"), "girdle"), 16, 0);
  assert_near(json_number(json_item(json, "ratios"), "L/W"), 1, 1e-9);
  assert_near(json_number(json_item(json, "ratios"), "Vol/W^3"), 2.097983 / pow(2.039182, 3), 1e-6);
  assert_near(json_number(json_item(json, "main_deg"), "crown"), 42, 0);
  assert_near(json_number(json_item(json, "main_deg"), "pavilion"), 43, 0);
  assert_int_equal(cJSON_GetArraySize(json_item(json, "tiers")), 7);
  const cJSON *tier = cJSON_GetArrayItem(json_item(json, "tiers"), 2);
  assert_near(json_number(tier, "angle_deg"), -43, 0);
  assert_int_equal(cJSON_GetArraySize(json_item(tier, "facets")), 8);
}

TEST(there_and_back) {
  run_says(GEM "convert" QUARTZ "-o s.gem && " GEM "convert s.gem -o s.asc && " GEM "info s.asc -q",
           "57 + 16 girdle");
  assert_contains(run_output, "Round brilliant for quartz");
  run_must(
      GEM
      "convert" QUARTZ "--width 8 -o s.stl && " GEM "convert" QUARTZ "--width 8 -o s.obj && " GEM
      "convert" QUARTZ
      "--width 8 --material diamond -o s.glb && test -s s.stl -a -s s.obj -a -s s.glb && rm s.*");
  assert_int_equal(run_left(), 0);
}

TEST(other_angles) {
  run_says(GEM "info" QUARTZ "--material quartz --rough 0.5inx9mmx12", "a stone of ");
  run_says(GEM "retarget" QUARTZ "--material sapphire", "at the same width 6.1 % less weight");
  HELD(cJSON, json) = run_json(GEM "retarget" QUARTZ "--index 1.768 -o s.asc --json", 0);
  const cJSON *pavilion = json_item(json, "pavilion");
  assert_near(json_number(pavilion, "from_deg"), 43, 0);
  assert_true(json_number(pavilion, "to_deg") > 40.5 && json_number(pavilion, "to_deg") < 41.5);
  assert_near(json_number(pavilion, "tangent_ratio"),
              json_number(json_item(json, "crown"), "tangent_ratio"), 0);
  cJSON_Delete(json);
  json = run_json(GEM "info s.asc --json", 0);
  assert_near(json_number(json, "cut_for_index"), 1.768, 0);
  assert_near(json_number(json, "corners"), 57, 0);
  cJSON_Delete(json);
  json = run_json(GEM "retarget" QUARTZ "--pavilion 41 --json", 0);
  assert_near(json_number(json_item(json, "crown"), "tangent_ratio"), 1, 0);
  assert_near(json_number(json_item(json, "pavilion"), "to_deg"), 41, 0);
  run_must("rm s.asc");
}

TEST(sheets) {
  run_must(GEM "diagram" QUARTZ "-o d.pdf && " GEM "diagram" QUARTZ "-o d.png && " GEM
               "diagram" QUARTZ "-o d.svg --material diamond && rm d.*");
}

TEST(what_is_refused) {
  static const struct {
    const char *line, *part;
    int code;
  } wrong[] = {
      {GEM, "a verb is wanted", 2},
      {GEM "inform x.asc", "did you mean 'info'?", 2},
      {GEM "info", "which design?", 2},
      {GEM "info" QUARTZ "--rough 12x9mm", "such as 12x9x7mm", 2},
      {GEM "info" QUARTZ "--rough 12x9x7kg", "is not a length", 2},
      {GEM "info none.asc", "none.asc", 1},
      {GEM "info \"$house\"/README.md", "is no design that is known by its name", 1},
      {GEM "info" QUARTZ "--material gold", "is a metal", 1},
      {GEM "info" QUARTZ "--material dimond", "diamond", 1},
      {GEM "info" QUARTZ "--weld 0.5", "--weld", 2},
      {GEM "diagram" QUARTZ, "where to?", 2},
      {GEM "diagram" QUARTZ "-o d.jpg", "ends with .pdf, .svg or .png", 1},
      {GEM "convert" QUARTZ "-o s.gltf", "a design is written as .asc, .gem or .gcs", 1},
      {GEM "retarget" QUARTZ, "for which stone?", 2},
      {GEM "retarget" QUARTZ "--index 1.6 --material diamond", "one of them", 2},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    assert_true(run_refuses(wrong[i].line, wrong[i].code, wrong[i].part));
  /* An open stone, and a design that does not say for which index it was made. */
  run_fails("printf 'g 96 0\\na -90 1 96 24 48 72\\n' >o.asc; " GEM "info o.asc", 1, "open");
  run_fails("printf 'a 40 1 96 24 48 72\\na -40 1 96 24 48 72\\n' >>o.asc; " GEM
            "retarget o.asc --index 1.7",
            1, "--from-index");
  /* A design is not written over itself. */
  run_fails("cp" QUARTZ "o.asc; " GEM "retarget o.asc --index 1.7 -o o.asc", 2, "o.asc");
  run_must("rm o.asc");
  assert_int_equal(run_left(), 0);
}
