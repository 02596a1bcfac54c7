/* The verbs of `abbe materials` that are about numbers: list, show, nearest, check, fit, from. */
#include "tests/cli/run_json.h"

#include "spectral/formats/material_import.h"

static void answers(const char *line, int code, const char *part) {
  int actual = run_line(line);
  if (actual != code || strstr(run_output, part) == NULL)
    fail_msg("%s\nends with %d, not %d; '%s' is expected in:\n%s%s", line, actual, code, part,
             run_output, run_errors);
}

static const char *text(const cJSON *json, const char *key) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, key);
  return cJSON_IsString(item) ? item->valuestring : "";
}

static const cJSON *first(const cJSON *json, const char *list) {
  return cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, list), 0);
}

/* What a verb prints as a record is read as one. */
static abbe_material_table record_of(const char *line) {
  abbe_material_table table;
  abbe_error error = {0};
  run_must(line);
  const char *table_text = printed("materials:\n%.4000s", run_output);
  if (abbe_material_table_parse(table_text, strlen(table_text), "printed", &table, &error) !=
      ABBE_OK)
    fail_msg("%s\n%s", error.text, table_text);
  assert_int_equal(table.count, 1);
  return table;
}

/* ---- list and show ---- */

GROUP(run_setup, run_teardown);

TEST(lists_are_filtered_sorted_and_cut_into_columns) {
  answers("$abbe materials list --nd 1.5:1.6 --vd 60:70 --sort n_d --columns name,v_d", 0,
          "name        V_d\nn-bk7     64.17\nquartz    69.69\namethyst  69.69\n"
          "citrine   69.69\n");
  answers("$abbe materials list --name 'N-*' --sort n_d --reverse --columns name", 0,
          "name\nn-sf11\nn-baf10\nn-bak4\nn-bk7\n");
  answers("$abbe materials list --source peter1923 --columns name,p_gF,dp_gF", 0,
          "diamond              0.5629  +0.0121");
  answers("$abbe materials list --name nothing", 0, "none of");
  HELD(cJSON, json) = run_json("$abbe materials list --name diamond --json", 0);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "materials")), 2);
  assert_near(json_number(first(json, "materials"), "p_gF"), 0.5629, 5e-5);
}

TEST(show_tells_all_that_is_known) {
  answers("$abbe materials show f2 --at 400", 0, "P_gF 0.5828");
  assert_contains(run_output, "printed       n_d 1.62004 (here +1e-07) V_d 36.37");
  assert_contains(run_output, "rms error 0.000468, largest 0.00184 at 380 nm");
  assert_contains(run_output, "through 10 mm: 0.994 at 400");
  assert_contains(run_output, "0.6045\n"); /* 1/m at 400 nm */
  answers("$abbe materials show bak4 --table thesis", 0,
          "wrong         the column A holds n_d instead of Cauchy's A");
  HELD(cJSON, json) = run_json("$abbe materials show bak4 --table thesis --json", 0);
  assert_string_equal(text(first(json, "findings"), "kind"), "a-is-n_d");
  rerun_json(&json, "$abbe materials show n-bk7 --json", 0);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "findings")), 0);
  assert_near(json_number(cJSON_GetObjectItem(json, "printed"), "n_d"), 1.5168, 0);
  assert_near(json_number(json, "n_e"), 1.51872, 5e-6);
  assert_near(json_number(first(json, "fits"), "residual_max"),
              json_number(first(json, "fits"), "max_error"), 1e-6);
}

/* ---- nearest ---- */

/* A conductor has n, k and what it reflects; what is of glasses alone is left out or refused. */
TEST(metals_are_told_by_n_and_k) {
  answers("$abbe materials show silver --at 582.1", 0, "582.1    0.050000    3.858000    0.987490");
  assert_null(strstr(run_output, "V_d"));
  assert_null(strstr(run_output, "nan"));
  assert_null(strstr(run_output, "Cauchy"));
  HELD(cJSON, json) = run_json("$abbe materials show gold --at 582.1 --json", 0);
  const cJSON *nk = cJSON_GetObjectItem(json, "nk"), *colour;
  assert_int_equal(cJSON_GetArraySize(nk), 4);
  assert_near(json_number(cJSON_GetArrayItem(nk, 3), "reflectance"), 0.88236330895380525, 1e-12);
  colour = cJSON_GetObjectItem(json, "colour_rec709"); /* yellow */
  assert_true(cJSON_GetArrayItem(colour, 0)->valuedouble >
              cJSON_GetArrayItem(colour, 1)->valuedouble);
  assert_true(cJSON_GetArrayItem(colour, 1)->valuedouble >
              1.8 * cJSON_GetArrayItem(colour, 2)->valuedouble);
  assert_null(cJSON_GetObjectItem(json, "v_d"));
  answers("$abbe materials list --name gold --columns name,n_d,v_d,model", 0,
          "gold             -    -  conductor");
  answers("$abbe materials plot gold n-bk7 -o metal.svg && grep -c 'gold, k\\|svg' metal.svg >&2; "
          "rm metal.svg",
          0, "");
  static const struct {
    const char *line, *part;
  } refused[] = {
      {"$abbe materials show gold --at 300", "data reach from 354.2 to 892 nm"},
      {"$abbe materials show gold --fit", "gold is a conductor"},
      {"$abbe materials fit gold", "gold is a conductor"},
      {"$abbe materials nearest --like gold", "gold is a conductor"},
      {"$abbe materials plot gold --fits -o metal.svg", "gold is a conductor"},
  };
  for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++)
    assert_true(run_refuses(refused[i].line, 1, refused[i].part));
}

TEST(nearest_finds_by_numbers_curve_and_points) {
  HELD(cJSON, json) = run_json("$abbe materials nearest --nd 1.517 --vd 64.2 --count 2 --json", 0);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "nearest")), 2);
  assert_string_equal(text(first(json, "nearest"), "name"), "n-bk7");
  rerun_json(&json, "$abbe materials nearest --like bk7 --like-table thesis --json", 0);
  assert_string_equal(text(first(json, "nearest"), "name"), "n-bk7");
  rerun_json(&json, "$abbe materials nearest --like sf11 --json", 0); /* not itself */
  assert_string_equal(text(first(json, "nearest"), "name"), "n-sf11");
  rerun_json(&json,
             "printf '0.4861,1.6321\\n0.5876,1.62\\n0.6563,1.6150\\n' >p.csv\n"
             "$abbe materials nearest --points p.csv --json",
             0);
  assert_string_equal(text(first(json, "nearest"), "name"), "f2");
  assert_true(json_number(first(json, "nearest"), "rms") < 1e-4);
  answers("$abbe materials nearest --like n-bk7 --range 500:2000", 0, "were skipped");
}

/* An index that a file says is relative to vacuum stays so in tables and stores and back. */
TEST(an_index_relative_to_vacuum_stays_so) {
  run_must("printf 'REFERENCES: r\\nDATA:\\n- {type: formula 5, wavelength_range: 0.4 0.7, "
           "coefficients: 1.5}\\nCONDITIONS: {n_absolute: true, temperature: 293.15}\\n' > v.yml");
  run_must("$abbe materials import v.yml --name v -o v.yaml");
  run_must("$abbe materials import v.yaml -o v.sqlite");
  run_must("$abbe materials export v --table v.sqlite --to rii -o w.yml");
  run_must("$abbe materials import w.yml --name v -o w.yaml");
  static const char *const tables[] = {"v.yaml", "v.sqlite", "w.yaml"};
  for (int i = 0; i < 3; i++) {
    char line[128];
    snprintf(line, sizeof line, "$abbe materials show v --table %s --pressure 0", tables[i]);
    answers(line, 0, "index         relative to vacuum\n");
    assert_contains(run_output, "n_d 1.500000 relative to vacuum");
    strcat(line, " --at 550 --json");
    HELD(cJSON, json) = run_json(line, 0);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(json, "n_absolute")));
    assert_near(json_number(first(json, "n"), "n"), 1.5, 1e-12);
    assert_near(json_number(first(json, "n"), "n_absolute"), 1.5, 1e-12);
  }
}

/* Beside two indices stand two losses, as the record gives them. */
TEST(losses_stand_by_wave) {
  HELD(cJSON, json) = run_json("$abbe materials show tourmaline-green --at 550 --json", 0);
  MADE(abbe_material_table, table, abbe_material_table_load("default", &table, &error));
  const abbe_material *m = NULL;
  OK(abbe_material_table_find(&table, "tourmaline-green", &m, &error));
  const double ordinary = abbe_material_attenuation_along(m, 0, 550),
               extraordinary = abbe_material_attenuation_along(m, 2, 550);
  assert_true(ordinary > 1.5 * extraordinary);
  assert_near(json_number(first(json, "n"), "attenuation_per_m"), ordinary, 1e-9 * ordinary);
  assert_near(json_number(first(json, "n"), "attenuation_extraordinary_per_m"), extraordinary,
              1e-9 * ordinary);
  answers("$abbe materials show tourmaline-green --at 550", 0,
          printed("%14.4g%19.4g\n", ordinary, extraordinary));
  assert_contains(run_output, "ordinary 1/m  extraordinary 1/m\n");
}

TEST(partners_are_listed_and_drawn) {
  HELD(cJSON, json) = run_json(
      "$abbe materials partners n-bk7 --json -o map.svg && grep -q svg map.svg && rm map.svg", 0);
  const cJSON *best = first(json, "partners");
  assert_string_equal(text(best, "name"), "fluorite");
  const cJSON *powers = cJSON_GetObjectItem(best, "powers");
  assert_int_equal(cJSON_GetArraySize(powers), 2);
  assert_near(cJSON_GetArrayItem(powers, 0)->valuedouble +
                  cJSON_GetArrayItem(powers, 1)->valuedouble,
              1, 1e-12);
  answers("$abbe materials partners n-bk7 --with sf10 --count 2", 0, "f_d-f_F mm");
  answers("$abbe materials partners n-bk7 --most-power 3 --count 1", 0, "sf10");
}

/* ---- check ---- */

TEST(check_finds_the_four_wrong_rows_of_the_thesis) {
  HELD(cJSON, json) = run_json("$abbe materials check --table thesis --json", 3);
  assert_near(json_number(json, "wrong"), 4, 0);
  assert_near(json_number(json, "doubtful"), 0, 0);
  const cJSON *f;
  cJSON_ArrayForEach(f, cJSON_GetObjectItem(json, "findings")) {
    assert_string_equal(text(f, "kind"), "a-is-n_d");
    assert_string_not_equal(text(f, "name"), "bk7");
  }
  answers("$abbe materials check --table thesis", 3, "5 rows, 4 wrong, 0 doubtful, 0 to note");
  assert_contains(run_errors, "4 findings in 'thesis' want a look");
  answers("$abbe materials check bk7 --table thesis", 0, "5 rows, 0 wrong");
  answers("$abbe materials check", 0, "0 wrong, 0 doubtful");
}

TEST(fix_changes_a_copy_and_leaves_the_rest) {
  answers("cp $house/spectral/materials/thesis.yaml t.yaml\n"
          "$abbe materials check --table t.yaml --fix --dry-run && cmp t.yaml "
          "$house/spectral/materials/thesis.yaml",
          0, "");
  assert_contains(run_errors, "4 values would be fixed");
  answers("$abbe materials check --table t.yaml --fix", 0, "5 rows, 0 wrong, 0 doubtful");
  assert_contains(run_errors,
                  "fused-silica, k5, bak4, baf10: the row's own warning stays as it was");
  answers("diff $house/spectral/materials/thesis.yaml t.yaml | grep -c '^[<>]'", 0, "8\n");
  answers("$abbe materials check --table t.yaml --fix", 0, "0 wrong");
}

/* What is only to know stands in one line of each kind, however many rows it is about. */
TEST(notes_of_many_rows_are_one_line) {
  answers("{ echo materials:; for i in $(seq 200); do echo \"- {name: g$i, model: cauchy, "
          "coefficients: [1.$((1000 + 7 * i)), 0.004], range_nm: [400, 700], source: book}\"; "
          "done; } >n.yaml; $abbe materials check --table n.yaml",
          0,
          "200 rows (g1, g2, g3, \xe2\x80\xa6): note, not-visible: the data do not cover 380 to "
          "780 nm; --all tells of each\n\nn.yaml: 200 rows, 0 wrong, 0 doubtful, 200 to note\n");
  assert_true(strlen(run_output) < 200);
  answers("$abbe materials check --table n.yaml --all", 0, "g200 (line 201): note, not-visible");
  answers("$abbe materials check g7 --table n.yaml", 0, "its data reach from 400 to 700 nm");
  HELD(cJSON, json) = run_json("$abbe materials check --table n.yaml --json; rm n.yaml", 0);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "findings")), 200);
}

TEST(unreadable_records_do_not_stop_a_check) {
  answers("printf 'materials:\\n- {name: a, model: cachy, source: s}\\n"
          "- {name: b, model: cauchy, coefficients: [1.5046, 4200], range_nm: [380, 780], source: "
          "book}\\n' >s.yaml; $abbe materials check --table s.yaml",
          3, "a (line 2): wrong, unread: the record cannot be read");
  assert_contains(run_output, "did you mean 'cauchy'?");
  assert_contains(run_output, "--fix: coefficients: [1.5046, 0.0042]");
  assert_contains(run_output, "2 rows, 2 wrong");
}

/* ---- fit ---- */

TEST(fits_come_with_their_errors) {
  answers("$abbe materials fit n-bk7 --terms 3", 0, "largest error  0.000157 at 380 nm");
  assert_contains(run_output, "401 points from 380 to 780 nm");
  assert_contains(run_output, "covariance");
  HELD(cJSON, json) = run_json(
      "$abbe materials fit n-sf11 --form sellmeier --range 400:700 --over 380:780 --json", 0);
  assert_string_equal(text(json, "model"), "sellmeier2");
  assert_true(json_number(json, "max_error") < 5e-5);
  assert_true(json_number(cJSON_GetObjectItem(json, "over"), "max_error") >
              json_number(json, "max_error"));
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "covariance")), 5);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "residuals")), 301);
  rerun_json(
      &json,
      "$abbe materials fit --formula 'sellmeier2 0 1.3, 0.01' --form sellmeier --terms 1 --json",
      0);
  const cJSON *c = cJSON_GetObjectItem(json, "coefficients");
  assert_near(cJSON_GetArrayItem(c, 1)->valuedouble, 1.3, 1e-9);
  assert_near(cJSON_GetArrayItem(c, 2)->valuedouble, 0.01, 1e-9);
  answers("$abbe materials fit diamond --range 500:900", 0,
          "its data reach from 226 to 760 nm; the rest is continued");
}

#define POINTS                                                                                     \
  "printf 'wavelength_nm,n,uncertainty\\n404.66,1.53023,2e-5\\n435.83,1.52669,2e-5\\n"             \
  "486.13,1.52238,2e-5\\n546.07,1.51871,2e-5\\n587.56,1.51681,2e-5\\n656.27,1.51431,2e-5\\n"       \
  "706.52,1.51289,2e-5\\n' >m.csv\n"

TEST(measured_points_are_fitted_and_drawn) {
  answers(POINTS "$abbe materials fit --points m.csv --terms 3 --residuals --plot m.png && head -c "
                 "4 m.png | tail -c 3",
          0, "in uncertainties");
  assert_contains(run_output, "from the uncertainties");
  assert_contains(run_output, "reduced chi^2");
  assert_contains(run_output, "PNG");
  answers(POINTS "$abbe materials fit --points m.csv --over 300:600", 0,
          "(at the 5 points there, 404.66 to 587.56 nm)");
  answers("$abbe materials fit --points m.csv --plot m.svg >/dev/null && cat m.svg", 0, "<svg");
  OWNED(abbe_material_table, t) =
      record_of(POINTS "$abbe materials fit --points m.csv --terms 3 --record my-glass");
  assert_string_equal(t.material[0].name, "my-glass");
  assert_near(t.material[0].min_nm, 404.66, 0);
  assert_contains(t.material[0].warning, "over 7 points from 404.66 to 706.52 nm");
  double n = 0;
  OK(abbe_material_n(&t.material[0], 587.56, &n, &error));
  assert_near(n, 1.51681, 1e-4);
}

/* ---- from ---- */

TEST(two_numbers_make_a_record) {
  const struct {
    const char *arguments;
    double n_d, v_d;
  } cases[] = {
      {"--nd 1.5168 --vd 64.17", 1.5168, 64.17},
      {"--nd 1.5168 --vd 64.17 --form sellmeier", 1.5168, 64.17},
      {"--ior 1.5 --dispersion 0.4", 1.5, 50},
      {"--a 1.5046 --b 0.0042", 1.5046 + 0.0042 / 0.34522887, 64.43},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED(abbe_material_table, t) = record_of(
        printed("$abbe materials from %s --name x --source 'a book'", cases[i].arguments));
    abbe_dispersion_numbers d = abbe_dispersion_describe(&t.material[0].dispersion);
    assert_near(d.n_d, cases[i].n_d, 1e-7);
    assert_near(d.v_d, cases[i].v_d, 5e-3);
    assert_contains(t.material[0].warning, "known materials of like V_d errs by");
    assert_contains(t.material[0].source, "a book; ");
  }
  HELD(cJSON, json) = run_json("$abbe materials from --nd 2.417 --bg 0.044 --json", 0);
  assert_near(json_number(json, "b_g"), 0.044, 1e-9);
  assert_near(json_number(json, "rounding_error"), 1e-3, 5e-4);
  assert_true(json_number(json, "largest_error") > json_number(json, "typical_error"));
  /* what the check doubts is said, on the side */
  run_must("$abbe materials from --a 1.5690 --b 0.00531");
  assert_contains(run_errors, "the column A holds n_d");
}

/* ---- wrong use ---- */

TEST(wrong_input_gets_a_sentence) {
  static const struct {
    const char *line;
    int code;
    const char *part;
  } cases[] = {
      {"$abbe materials list --sort nd", 2, "did you mean 'n_d'?"},
      {"$abbe materials list --columns name,vd", 2, "did you mean 'v_d'?"},
      {"$abbe materials list --columns ,", 2, "names no column"},
      {"$abbe materials list --nd 1.5", 2,
       "--nd '1.5' is not a range: two numbers above 0, the smaller first, such as 1.5:1.6"},
      {"$abbe materials from --nd 1.5 --bg 5", 1, "1.5 and 5 go with no material"},
      {"$abbe materials partners", 2, "partners of what?"},
      {"$abbe materials partners gold", 1, "gold has no single index with a V_d and a P_gF"},
      {"$abbe materials partners n-bk7 --with flourite", 1, "did you mean 'fluorite'?"},
      {"$abbe materials partners n-bk7 --with n-bk7", 1, "n-bk7 and n-bk7 are one glass"},
      {"$abbe materials show n-bk7 --fit --temperature -40", 2, "--fit goes without"},
      {"$abbe materials partners n-bk7 --most-power 1", 1, "no glass of 'default' makes"},
      {"$abbe materials nearest", 2, "nearest to what?"},
      {"$abbe materials nearest --nd 1.5", 2, "--nd and --vd go together"},
      {"$abbe materials nearest --nd 1.5 --vd 60 --like diamond", 2, "exclude each other"},
      {"$abbe materials nearest --like dimond", 1, "did you mean 'diamond'?"},
      {"$abbe materials nearest --like water --range 500:2000", 1, "water has no index at 2000 nm"},
      {"$abbe materials nearest diamond", 2, "--like diamond compares"},
      {"$abbe materials nearest --points /no/such.csv", 1, "/no/such.csv"},
      {"$abbe materials nearest --nd 1.5 --vd sixty", 2, "--vd 'sixty' is not a number"},
      {"$abbe materials check --dry-run", 2, "--dry-run goes with --fix"},
      {"$abbe materials check --fix --json --table t", 2, "changes the whole table"},
      {"$abbe materials check --fix", 2, "--table FILE"},
      {"$abbe materials check --fix --table thesis", 1, "--to yaml -o FILE' makes a copy"},
      {"$abbe materials check --table $house/docs/examples/maker.agf", 1,
       "is a Zemax catalogue, not a table of materials; 'abbe materials import "},
      {"$abbe materials list --table $house/docs/examples/measured.csv", 1, "is a list of points"},
      {"$abbe materials set a b=1 --table $house/docs/examples/maker.agf", 1, "Zemax catalogue"},
      {"$abbe materials export n-bk7 --to csv --range 100:200", 1, "no index at 100 nm"},
      {"$abbe materials check --table /no/such.yaml", 1, "/no/such.yaml"},
      {"$abbe materials check dimond", 1, "did you mean 'diamond'?"},
      {"$abbe materials fit", 2, "fit what?"},
      {"$abbe materials fit n-bk7 --points x.csv", 2, "exclude each other"},
      {"$abbe materials fit n-bk7 --form couchy", 2, "did you mean 'cauchy'?"},
      {"$abbe materials fit n-bk7 --terms 33", 2, "--terms '33'"},
      {"$abbe materials fit n-bk7 --terms 32", 1, "cancel beyond double precision"},
      {"$abbe materials fit n-bk7 --form sellmeier --terms 5", 1, "1 to 4 are possible"},
      {"$abbe materials fit n-bk7 --range 200:700", 1, "its data reach from 300 to 2500 nm"},
      {"$abbe materials fit n-bk7 --record ' x'", 1, "is not a name"},
      {"$abbe materials fit n-bk7 --record x --json", 2, "--record prints the record alone"},
      {"$abbe materials fit n-bk7 --plot /tmp/x.jpg", 1, "/tmp/x.jpg"},
      {"$abbe materials fit --formula 'cachy 1'", 1, "is not a model"},
      {"$abbe materials fit --formula 'cauchy 1.5x'", 1, "does not begin with a number"},
      {"$abbe materials fit --formula 'sellmeier 1 2'", 1, "an odd number"},
      {"$abbe materials fit --formula 'cauchy 1.5' --table thesis", 2, "--table goes with"},
      {"printf '500,1.5\\n600,x\\n' >p.csv; $abbe materials fit --points p.csv; c=$?; rm p.csv; "
       "exit $c",
       1, "p.csv:2: this is not a number"},
      {"printf '500,1.5\\n600,1.4\\n' >p.csv; $abbe materials fit --points p.csv --terms 3; c=$?; "
       "rm p.csv; exit $c",
       1, "3 coefficients, and there are points at only 2 wavelengths"},
      {"$abbe materials from --nd 1.5", 2, "two numbers are wanted"},
      {"$abbe materials from --nd 1.5 --vd 60 --bg 0.01", 2, "two numbers are wanted"},
      {"$abbe materials from --nd 0.9 --vd 60", 1, "n_d 0.9 is not an index"},
      {"$abbe materials from 1.5 60", 2, "numbers go with options"},
      {"$abbe materials from --nd 1.5 --vd 60 --name ''", 1, "is not a name"},
  };
  bool good = true;
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    run_each(run_remove, NULL);
    good = run_refuses(cases[i].line, cases[i].code, cases[i].part) && good;
  }
  assert_true(good);
}

TEST(every_verb_helps_by_example) {
  const char *const verbs[] = {"list", "show", "nearest", "partners", "check", "fit", "from"};
  for (size_t i = 0; i < sizeof verbs / sizeof verbs[0]; i++) {
    const char *line = printed("$abbe materials %s --help", verbs[i]);
    answers(line, 0, printed("Examples:\n  abbe materials %s", verbs[i]));
  }
  answers("$abbe materials --help", 0, verbs[0]);
  for (size_t i = 1; i < sizeof verbs / sizeof verbs[0]; i++) assert_contains(run_output, verbs[i]);
}
