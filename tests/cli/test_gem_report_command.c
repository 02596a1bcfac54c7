/* `abbe gem report` and `abbe gem optimise` as people and programs meet them. */
#include "tests/cli/run_json.h"

#define GEM "\"$abbe\" gem "
#define DIAMOND " \"$house\"/scenes/designs/brilliant-diamond.asc --quiet "
#define SMALL " --material diamond --size 24 --wavelengths 5 "

static double value(const cJSON *object, const char *key) {
  const cJSON *pair = json_item(object, key);
  assert_true(json_number(pair, "error") >= 0);
  return json_number(pair, "value");
}

static void shares_add_up(const cJSON *m) {
  const double lost = value(m, "absorbed") + value(m, "left");
  assert_near(value(m, "iso") + value(m, "leakage") + lost, 1, 1e-4);
  assert_near(value(m, "return") + value(m, "head"), value(m, "iso"), 1e-4);
  assert_near(value(m, "aset_green") + value(m, "aset_red") + value(m, "aset_blue") +
                  value(m, "aset_leakage") + lost,
              1, 1e-4);
  assert_true(value(m, "cos") <= value(m, "iso"));
}

GROUP(run_setup, run_teardown);

TEST(numbers_add_up) {
  cJSON *json = run_json(GEM "report" DIAMOND SMALL "--step 15 --json", 0);
  const cJSON *m = json_item(json, "measures"), *one;
  shares_add_up(m);
  assert_near(value(m, "area_brilliant") + value(m, "area_window") + value(m, "area_extinct"), 1,
              1e-9);
  assert_near(value(json_item(json, "return_xyz"), "Y"), value(m, "return"), 1e-4);
  assert_true(value(m, "iso") > 0.85 && value(m, "fire") > 0.02);
  assert_int_equal(cJSON_GetArraySize(json_item(json, "wavelengths")), 5);
  cJSON_ArrayForEach(one, json_item(json, "wavelengths")) shares_add_up(one);
  assert_int_equal(cJSON_GetArraySize(json_item(json, "tilts")), 4 * 5);
  cJSON_ArrayForEach(one, json_item(json, "tilts")) {
    assert_true(value(one, "cos") <= value(one, "iso"));
    assert_near(value(one, "iso") + value(one, "leakage"), 1, 2e-4);
  }
  cJSON_Delete(json);
  /* One wavelength has no fire: neither a number, nor a curve, nor a chart. */
  json = run_json(GEM "report" DIAMOND SMALL "--step 15 --wavelengths 1 --json", 0);
  assert_null(cJSON_GetObjectItem(json_item(json, "measures"), "fire"));
  cJSON_ArrayForEach(one, json_item(json, "tilts")) assert_null(cJSON_GetObjectItem(one, "fire"));
  cJSON_Delete(json);
  assert_int_equal(
      run_line(GEM "report" DIAMOND SMALL
                   "--step 15 --wavelengths 1 --csv -o one.pdf > one.csv && grep -q ^iso one.csv"),
      0);
  run_says(GEM "report" DIAMOND SMALL "--tilt 0 --wavelengths 1", "each at 1 wavelength;");
  run_must("! grep -q ^fire one.csv && rm one.csv one.pdf");
  /* Without a head all that comes from above is returned; a wider one takes more. */
  double before = 1;
  for (int head = 0; head <= 30; head += 10) {
    json =
        run_json(printed(GEM "report" DIAMOND SMALL "--tilt 0 --json --head-shadow %d", head), 0);
    const double back = value(json_item(json, "measures"), "return");
    if (head == 0) assert_near(back, value(json_item(json, "measures"), "iso"), 1e-9);
    assert_true(back < before);
    before = back;
    cJSON_Delete(json);
  }
}

TEST(pages_maps_and_tables) {
  run_says("mkdir maps && " GEM "report" DIAMOND SMALL
           "--step 15 --wavelengths 2 -o r.pdf --maps maps && head -c 5 r.pdf",
           "GemRay's ISO");
  assert_contains(run_output, "%PDF-");
  assert_int_equal(
      run_line("cd maps && ls && \"$abbe\" info maps.exr && cd .. && rm -r maps r.pdf"), 0);
  assert_contains(run_output, "aset.png");
  assert_contains(run_output, "ideal-scope.png");
  assert_contains(run_output, "aset_green");
  run_says(GEM "report" DIAMOND SMALL "--tilt 0 --csv",
           "measure,axis_deg,tilt_deg,wavelength_nm,value,standard_error\niso,");
  assert_int_equal(run_left(), 0);
}

#define BRILLIANT " \"$house\"/scenes/designs/brilliant-quartz.asc --quiet "

/* The first page is for who buys the stone: with a design beside it that is named, that is shipped,
 * or that has other angles, and with a picture. Its words are packed in the file. */
TEST(a_page_for_a_customer) {
  static const struct {
    const char *line;
    int pages;
  } made[] = {{GEM "report" BRILLIANT "--material quartz --size 12 --wavelengths 2 --tilt 0 "
                   "--maps . -o p.pdf && " GEM "report" BRILLIANT
                   "--material quartz --size 12 --wavelengths 2 --tilt 0 --picture aset.png "
                   "--ideal \"$house\"/scenes/designs/oval.asc -o p.pdf",
               2},
              {GEM "report \"$house\"/scenes/designs/rose.asc -q --material ruby --size 12 "
                   "--wavelengths 2 --tilt 4 -o p.pdf",
               3}};
  for (int i = 0; i < 2; i++) {
    char count[200];
    run_says(made[i].line, "light return");
    snprintf(count, sizeof count, "test $(grep -acE '/Type /Page( |$)' p.pdf) = %d", made[i].pages);
    run_must(count);
  }
  run_must("rm p.pdf *.png maps.exr");
  assert_int_equal(run_left(), 0);
}

TEST(crystals_lie_in_their_cut) {
  cJSON *json =
      run_json(GEM "report" BRILLIANT
                   "--material zircon --axis 0,1,0 --size 24 --wavelengths 3 --tilt 0 --json",
               0);
  shares_add_up(json_item(json, "measures"));
  assert_near(json_item(json_item(json, "axes"), "z")->child->next->valuedouble, 1, 1e-12);
  const cJSON *ways = json_item(json, "orientations");
  assert_int_equal(cJSON_GetArraySize(ways), 3);
  const double upright = value(ways->child, "iso");
  assert_true(upright > value(ways->child->next, "iso") + 0.02);
  assert_near(value(json_item(json, "measures"), "iso_lying_y"),
              value(json_item(json, "measures"), "iso"), 0.03);
  cJSON_Delete(json);
  run_says(GEM "report" BRILLIANT "--material peridot --size 16 --wavelengths 2 --tilt 0",
           "both waves of a crystal of three indices, z along 0 0 1, x along 1 0 0");
  assert_contains(run_output, "crystal's x up");
  /* the search for a way finds the same, and hands back what --axis takes */
  json = run_json(GEM "optimise" BRILLIANT "--material zircon --axis 3x2 --size 24 --json", 0);
  assert_int_equal(cJSON_GetArraySize(json_item(json, "ways")), 6);
  const cJSON *best = json_item(json, "best");
  assert_string_equal(json_item(best, "axis")->valuestring, "0,0,1");
  assert_near(json_number(best, "value"), upright, 0.02);
  assert_true(json_number(best, "value") > json_number(json_item(json, "worst"), "value") + 0.02);
  cJSON_Delete(json);
  run_says(GEM "optimise" BRILLIANT "--material peridot --axis 2x2 --size 12",
           "--axis 1,0,0,0,0,1");
  run_says(GEM "optimise" BRILLIANT "--material zircon --axis 1,0,0 --tilt 10,45 --grid 1x1 "
               "--size 12",
           "best");
}

TEST(the_best_is_written_and_is_as_good_as_said) {
  HELD(cJSON, json) =
      run_json(GEM "optimise \"$house\"/scenes/designs/brilliant-quartz.asc --quiet --material "
                   "quartz --grid 3x3 --pavilion 36:46 --size 24 -o b.asc --plot p.png --json",
               0);
  const double best = json_number(json_item(json, "best"), "value");
  assert_true(best >= json_number(json_item(json, "design"), "value") - 0.02);
  assert_near(json_number(json_item(json, "best"), "pavilion_deg"), 41, 5.001);
  assert_int_equal(cJSON_GetArraySize(json_item(json, "grid")), 9);
  rerun_json(&json,
             GEM "report b.asc -q --material quartz --wavelengths 6 --size 24 --tilt 0 --json", 0);
  assert_near(value(json_item(json, "measures"), "iso"), best, 1e-4); /* the same rays */
  rerun_json(&json, GEM "info b.asc --json", 0);
  assert_near(json_number(json, "corners"), 57, 0); /* all meets */
  run_clears("rm b.asc p.png");
}

TEST(every_tier_by_itself_is_better) {
  HELD(cJSON, json) = run_json(GEM "optimise" DIAMOND "--material spinel --measure cos --search "
                                   "tiers --size 16 --quiet -o b.asc --json",
                               0);
  const double design = json_number(json_item(json, "design"), "value");
  assert_true(json_number(json_item(json, "best"), "value") > design + 0.03);
  assert_int_equal(cJSON_GetArraySize(json_item(json, "tiers")), 7);
  rerun_json(&json, GEM "info b.asc --json", 0);
  assert_near(json_number(json, "corners"), 57, 0); /* all meets */
  run_clears("rm b.asc");
}

/* The first is the best by the measure alone. */
TEST(designs_between_light_and_fire) {
  HELD(cJSON, json) = run_json(GEM "optimise" DIAMOND "--material spinel --search front --size 8 "
                                   "-o f.asc --plot f.svg --json",
                               0);
  const cJSON *list = json_item(json, "designs");
  assert_int_equal(cJSON_GetArraySize(list), 5);
  const double design = json_number(cJSON_GetArrayItem(list, 0), "value");
  assert_true(json_number(cJSON_GetArrayItem(list, 1), "value") > design + 0.01);
  assert_true(json_number(cJSON_GetArrayItem(list, 4), "fire_error") > 0);
  run_clears("rm f-1.asc f-2.asc f-3.asc f-4.asc f.svg");
}

TEST(a_design_brings_its_index) {
  HELD(cJSON, json) = run_json(GEM "report" DIAMOND "--size 24 --wavelengths 5 --tilt 0 --json", 0);
  assert_string_equal(json_item(json, "material")->valuestring, "index 2.417");
  shares_add_up(json_item(json, "measures"));
}

TEST(what_is_refused) {
  static const struct {
    const char *line, *part;
    int code;
  } wrong[] = {
      {GEM "report", "which design?", 2},
      {"sed '/^I /d' \"$house\"/scenes/designs/brilliant-diamond.asc >no.asc; " GEM
       "report no.asc; code=$?; rm no.asc; exit $code",
       "no.asc says no index; give --material NAME", 1},
      {GEM "report" DIAMOND SMALL "--json --csv", "one of them", 2},
      {GEM "report" DIAMOND SMALL "--head-shadow 45", "--head-shadow", 2},
      {GEM "report" DIAMOND SMALL "-o r.png", ".pdf", 2},
      {GEM "report" DIAMOND SMALL "--picture a.png", "on which page?", 2},
      {GEM "report" DIAMOND SMALL "--tilt 0 --ideal none.asc -o r.pdf", "none.asc", 1},
      {GEM "report" DIAMOND SMALL "--tilt 0 --picture none.png -o r.pdf", "none.png", 1},
      {GEM "report" DIAMOND SMALL "--tilt 0 --maps none", "none/", 1},
      {GEM "report" DIAMOND "--material silver", "is a metal", 1},
      {GEM "optimise" DIAMOND "--material diamond --measure fire",
       "iso, cos, gemray-iso, gemray-cos, gemray-sc2, return, leakage", 2},
      {GEM "report" DIAMOND "--material diamond --axis 1,0,0", "one index in all directions", 1},
      {GEM "report" DIAMOND "--material zircon --axis 0,0,0", "such as 1,0,0", 1},
      {GEM "report" DIAMOND "--material topaz --axis 1,0,0,2,0,0", "parallel", 1},
      {GEM "optimise" DIAMOND "--material diamond --search tiers --plot p.png", "has no grid", 2},
      {GEM "optimise" DIAMOND "--material zircon --axis 3x3 -o b.asc", "keeps the angles", 2},
      {GEM "optimise" DIAMOND "--material diamond --axis 3x3", "no axis to turn", 1},
      {GEM "optimise" DIAMOND "--material diamond --tilt 10,x", "DEGREES,AZIMUTH", 2},
      {GEM "optimise" DIAMOND "--material diamond --crown 30:95", "below 90", 2},
      {GEM "optimise" DIAMOND "--material diamond --grid 1x1 --plot p.jpg", ".png or .svg", 1},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
    if (!run_refuses(wrong[i].line, wrong[i].code, wrong[i].part)) fail_msg("%s", wrong[i].line);
  assert_int_equal(run_left(), 0);
}
