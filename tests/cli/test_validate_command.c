/* The program's `validate`, as a person and as a program meet it. */
#include "tests/cli/run_json.h"

GROUP(run_setup, run_teardown);

TEST(a_group_as_text) {
  run_says("\"$abbe\" validate --only rainbow", "secondary bow at 700 nm");
  assert_contains(run_output, "6 of 6 known answers are within tolerance");
  assert_contains(run_output, "tolerance (degrees): ");
  assert_null(strstr(run_output, "FAILS"));
  assert_string_equal(run_errors, "");
}

/* The page's table has as many as the program, of the groups that take no time; all of them
 * together are what the README rounds down. */
TEST(the_pages_count_the_answers) {
  static const char page[] = ABBE_SOURCE_DIR "/docs/validation.md";
  static const char *const groups[] = {"prism",   "slit", "ball",    "nest",    "slab",
                                       "fresnel", "film", "crystal", "rainbow", "derive"};
  for (size_t i = 0; i < sizeof groups / sizeof *groups; i++) {
    assert_int_equal(
        run_line(
            printed("awk -F '[|]' 'NF == 5 && $4 > 0 && $2 == \" `%s` \" {print \"n\" $4 + 0}' %s",
                    groups[i], page)),
        0);
    const int count = atoi(run_output + 1);
    run_says(printed("\"$abbe\" validate --only %s", groups[i]),
             printed("%d of %d known answers", count, count));
  }
  run_says(printed("awk -F '[|]' '/^## /{in_it = /Known answers/} in_it && NF == 5 {n += $4} END "
                   "{print \"over \" int(n / 100) * 100}' %s",
                   page),
           "over ");
  const int all = atoi(strstr(run_output, "over ") + 5);
  run_says("cat " ABBE_SOURCE_DIR "/README.md", printed("passes over %d answers", all));
}

TEST(a_group_as_json) {
  HELD(cJSON, json) = run_json("\"$abbe\" validate --only prism --json", 0);
  const cJSON *list = cJSON_GetObjectItem(json, "answers"), *row = cJSON_GetArrayItem(list, 1);
  assert_int_equal(cJSON_GetArraySize(list), 13);
  assert_int_equal(cJSON_GetObjectItem(json, "passed")->valueint, 13);
  assert_int_equal(cJSON_GetObjectItem(json, "failed")->valueint, 0);
  assert_string_equal(cJSON_GetObjectItem(row, "group")->valuestring, "prism");
  double exact = cJSON_GetObjectItem(row, "exact")->valuedouble;
  double traced = cJSON_GetObjectItem(row, "traced")->valuedouble;
  assert_near(cJSON_GetObjectItem(row, "error")->valuedouble, traced - exact, 1e-12);
  assert_true(cJSON_IsTrue(cJSON_GetObjectItem(row, "passed")));
  assert_true(strlen(cJSON_GetObjectItem(row, "reason")->valuestring) > 0);
}

/* Whole runs, small: their tolerances widen with their noise, and would fail where it tells
 * nothing. Some random stones stand in a furnace each time, in test_turned_paths.
 */
TEST(runs_meet_a_furnace_and_converge) {
  if (all_cases())
    run_says("\"$abbe\" validate --only furnace --samples 65536 --threads 1",
             "10 of 10 known answers are within tolerance");
  run_says("\"$abbe\" validate --only convergence --samples 65536 --threads 1",
           "slope of the error over the photons");
}

TEST(pictures_show_the_caustic) {
  run_says("\"$abbe\" validate --only picture --samples 524288 --threads 1",
           "the caustic through a pane");
}

TEST(noise_is_no_agreement) {
  assert_int_equal(run_line("\"$abbe\" validate --only absorption --samples 1000 --threads 1"), 3);
  assert_contains(run_output, "TOO NOISY");
  assert_contains(run_errors, "of 7 known answers are out of tolerance");
}

TEST(errors_are_drawn) {
  assert_int_equal(
      run_line("\"$abbe\" validate --only slab --chart c.svg && grep -c '<svg' c.svg && rm c.svg"),
      0);
  assert_true(run_refuses("\"$abbe\" validate --chart c.gif", 2, "'c.gif' wants a name"));
}

TEST(help_lists_the_groups) {
  run_says("\"$abbe\" validate --help", "rainbow: primary");
  assert_contains(run_output, "Examples:");
}

TEST(wrong_use_is_explained) {
  bool right = run_refuses("\"$abbe\" validate --only rainbov", 2, "did you mean 'rainbow'");
  right = run_refuses("\"$abbe\" validate extra", 2, "'extra' is one argument too many") && right;
  right = run_refuses("\"$abbe\" validate --samples 0", 2, "--samples '0'") && right;
  right = run_refuses("\"$abbe\" validate --threads 0", 2, "--threads '0'") && right;
  assert_true(right);
}
