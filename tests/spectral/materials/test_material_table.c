#include "tests/spectral/shipped_table.h"

#include "base/file.h"
#include "spectral/dispersion/fit.h"

/* ---- names ---- */

TEST(names_are_found_in_any_case_or_suggested) {
  OWNED(abbe_material_table, table) = load_table("default");
  const abbe_material *m = NULL;
  assert_string_equal(find_material(&table, "DIAMOND")->name, "diamond");
  REFUSED(ABBE_NOT_FOUND, "'default' has no material 'diamnod'; did you mean 'diamond'?",
          abbe_material_table_find(&table, "diamnod", &m, &error));
  REFUSED(ABBE_NOT_FOUND, "it has fused-silica, n-bk7",
          abbe_material_table_find(&table, "kryptonite-glass", &m, &error));
  assert_null(m);
  abbe_material_table_free(&table);
}

TEST(of_a_long_list_whole_names_are_told) {
  char name[300][24];
  abbe_material material[300] = {0};
  abbe_material_table table = {.path = (char[]){"t"}, .count = 300, .material = material};
  for (size_t i = 0; i < 300; i++) {
    snprintf(name[i], sizeof name[i], "glass-number-%zu", 1000 + i);
    material[i].name = name[i];
  }
  const abbe_material *m = NULL;
  abbe_error error = {0};
  assert_int_equal(abbe_material_table_find(&table, "krypton", &m, &error), ABBE_NOT_FOUND);
  assert_contains(error.text, "it has glass-number-1000, glass-number-1001, ");
  assert_contains(error.text, " more; 'abbe materials list' has them");
  size_t shown = 0, more = 0;
  for (const char *c = error.text; (c = strstr(c, "glass-number-")) != NULL; c++) shown++;
  sscanf(strstr(error.text, " and "), " and %zu", &more);
  assert_int_equal(shown + more, 300);
}

/* ---- the format ---- */

#define GOOD_RECORD "- {name: x, model: constant, coefficients: [1.5], source: s}\n"

static abbe_material_table parse(const char *text) {
  abbe_material_table table;
  OK(abbe_material_table_parse(text, strlen(text), "t.yaml", &table, &error));
  return table;
}

TEST(a_record_may_be_short) {
  OWNED(abbe_material_table, t) =
      parse("materials:\n  - {name: x, model: constant, coefficients: [1.5], source: made up}\n");
  assert_int_equal(t.count, 1);
  assert_string_equal(t.path, "t.yaml");
  assert_int_equal(t.material[0].line, 2);
  assert_true(isnan(t.material[0].temperature_c));
  assert_null(t.material[0].attenuation);
  assert_int_equal(t.material[0].fit[0].terms, 0);
  assert_false(t.material[0].extrapolate);
  double n = 0;
  OK(abbe_material_n(&t.material[0], 500, &n, &error));
  assert_near(n, 1.5, 0);
}

TEST(points_make_an_index) {
  OWNED(abbe_material_table, t) =
      parse("materials:\n- name: x\n  model: tabulated\n  interpolation: linear\n"
            "  points: [[400, 1.6], [600, 1.5], [800, 1.45]]\n  source: made up\n"
            "  temperature_c: -5\n");
  const abbe_material *m = &t.material[0];
  double n = 0;
  assert_near(m->min_nm, 400, 0);
  assert_near(m->max_nm, 800, 0);
  assert_near(m->temperature_c, -5, 0);
  OK(abbe_material_n(m, 500, &n, &error));
  assert_near(n, 1.55, 1e-15);
  assert_int_equal(abbe_material_n(m, 399, &n, NULL), ABBE_OUT_OF_RANGE);
}

/* A second index: a formula or points, over the range of the first. */
TEST(crystals_have_two_indices) {
  OWNED(abbe_material_table, t) = parse(
      "materials:\n"
      "- {name: a, model: constant, coefficients: [1.5], source: s,\n"
      "   extraordinary: {model: cauchy, coefficients: [1.4, 0.01]}}\n"
      "- {name: b, model: cauchy, coefficients: [1.5, 0.004], range_nm: [400, 700], source: s,\n"
      "   extraordinary: {model: tabulated, interpolation: linear,\n"
      "     points: [[400, 1.6], [800, 1.4]]}}\n"
      "- {name: c, model: constant, coefficients: [1.5], source: s}\n");
  double n = 0;
  assert_true(abbe_material_is_uniaxial(&t.material[0]));
  OK(abbe_material_n_extraordinary(&t.material[0], 500, &n, &error));
  assert_near(n, 1.44, 1e-15);
  OK(abbe_material_n_extraordinary(&t.material[1], 500, &n, &error));
  assert_near(n, 1.55, 1e-15);
  assert_int_equal(abbe_material_n_extraordinary(&t.material[1], 750, &n, NULL), ABBE_OUT_OF_RANGE);
  assert_false(abbe_material_is_uniaxial(&t.material[2]));
  OK(abbe_material_n_extraordinary(&t.material[2], 500, &n, &error));
  assert_near(n, 1.5, 0);
}

TEST(second_indices_that_cannot_be_are_refused) {
  const struct {
    const char *extraordinary, *part;
  } rows[] = {
      {"1.4", "'extraordinary' wants a model and its numbers"},
      {"{coefficients: [1.4]}", "'model' is missing"},
      {"{model: cauchy}", "'coefficients' is missing"},
      {"{model: cauchy, coefficients: []}", "coefficients"},
      {"{model: cauchy, coefficients: [1.4], points: [[400, 1.4], [800, 1.3]]}",
       "the model cauchy has no use for 'points'"},
      {"{model: cauchy, coefficients: [1.4], range_nm: [400, 700]}",
       "'extraordinary' has no key 'range_nm'"},
      {"{model: conductor, points: [[400, 1.4, 1], [800, 1.3, 1]]}",
       "'extraordinary' is a real index"},
      {"{model: tabulated, points: [[450, 1.4], [800, 1.3]]}",
       "wider than those of its extraordinary index, which reach from 450 to 800 nm"},
      {"{model: cauchy, coefficients: [-1.4]}", "its extraordinary cauchy formula has no real"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_material_table t;
    const char *text =
        printed("materials:\n- {name: x, model: cauchy, coefficients: [1.5, 0.004], source: s,\n"
                "   range_nm: [400, 700], extraordinary: %s}\n",
                rows[i].extraordinary);
    REFUSED(ABBE_SCHEMA,
            "t.yaml:", abbe_material_table_parse(text, strlen(text), "t.yaml", &t, &error));
    assert_contains(last_error.text, rows[i].part);
  }
}

/* A colour at a distance: its transmittances come back at that distance. */
TEST(absorption_is_a_spectrum_or_a_colour) {
  OWNED(abbe_material_table, t) =
      parse("materials:\n"
            "- {name: a, model: constant, coefficients: [1.5], source: s,\n"
            "   absorption: {colour: [0.9, 0.25, 1], distance_m: 0.02}}\n"
            "- {name: b, model: constant, coefficients: [1.5], source: s,\n"
            "   absorption: {attenuation_per_m: [[400, 10], [500, 20]]}}\n");
  const abbe_material *a = &t.material[0], *b = &t.material[1];
  assert_near(exp(-0.02 * abbe_material_attenuation(a, 611.4)), 0.9, 1e-14);
  assert_near(exp(-0.02 * abbe_material_attenuation(a, 549.1)), 0.25, 1e-14);
  assert_near(abbe_material_attenuation(a, 464.2), 0, 0);
  assert_near(abbe_material_attenuation(a, 380), 0, 0);
  assert_near(abbe_material_attenuation(a, 780), -log(0.9) / 0.02, 1e-12);
  assert_near(abbe_material_attenuation(b, 450), 15, 1e-12);
}

TEST(absorption_is_also_a_transmittance_or_k) {
  OWNED(abbe_material_table, t) =
      parse("materials:\n"
            "- {name: a, model: constant, coefficients: [1.5], source: s,\n"
            "   absorption: {transmittance: [[400, 0.5], [500, 1]],\n"
            "     thickness_m: 0.01}}\n"
            "- {name: b, model: constant, coefficients: [1.5], source: s,\n"
            "   absorption: {k: [[400, 1e-7], [500, 2e-7]]}}\n");
  assert_near(exp(-0.01 * abbe_material_attenuation(&t.material[0], 400)), 0.5, 1e-14);
  assert_near(abbe_material_attenuation(&t.material[1], 400), 4 * acos(-1) * 0.25, 1e-12);
}

TEST(what_the_catalogue_prints_is_kept) {
  OWNED(abbe_material_table, t) =
      parse("materials:\n- name: N-BK7\n  model: constant\n  coefficients: [1.5]\n  source: s\n"
            "  n_d: 1.5168\n  v_d: 64.17\n  comment: step 0.5 available\n"
            "  catalogue: {code: '517642.251', status: preferred, melt_frequency: 1,\n"
            "    density_g_cm3: 2.51, expansion_per_k: [7.1e-06, 8.3e-06], dpgf: -0.0009,\n"
            "    thermal: [1.86e-06, 1.31e-08, -1.37e-11, 4.34e-07, 6.27e-10, 0.17],\n"
            "    ratings: [1, 1, 0, 1, 2.3, 2.3]}\n");
  const abbe_material *m = &t.material[0];
  assert_near(m->published_n_d, 1.5168, 0);
  assert_near(m->published_v_d, 64.17, 0);
  assert_string_equal(m->comment, "step 0.5 available");
  assert_string_equal(m->catalogue.code, "517642.251");
  assert_string_equal(m->catalogue.status, "preferred");
  assert_near(m->catalogue.density_g_cm3, 2.51, 0);
  assert_near(m->catalogue.expansion_per_k[1], 8.3e-6, 0);
  assert_near(m->catalogue.dpgf, -0.0009, 0);
  assert_near(m->catalogue.thermal[5], 0.17, 0);
  assert_int_equal(m->catalogue.rating_count, 6);
  assert_near(m->catalogue.ratings[5], 2.3, 0);
}

TEST(materials_are_moved_to_a_table) {
  OWNED(abbe_material_table, t) = parse("materials:\n" GOOD_RECORD);
  for (int i = 0; i < 20; i++) {
    abbe_material m = {.name = strdup("y"), .published_n_d = i};
    OK(abbe_material_table_append(&t, &m, &error));
    assert_null(m.name);
  }
  assert_int_equal(t.count, 21);
  assert_near(t.material[20].published_n_d, 19, 0);
  assert_string_equal(t.material[0].name, "x");
}

TEST(aliases_may_share_a_record_part) {
  OWNED(abbe_material_table, t) =
      parse("materials:\n"
            "- {name: a, model: cauchy, coefficients: &c [1.5, 0.004], range_nm: &r [380, 780],\n"
            "   source: s}\n"
            "- {name: b, model: cauchy, coefficients: *c, range_nm: *r, source: s}\n");
  assert_near(t.material[1].dispersion.c[1], 0.004, 0);
}

static void refuses(const char *text, const char *part) {
  abbe_material_table t;
  abbe_error error = {0};
  abbe_result result = abbe_material_table_parse(text, strlen(text), "t.yaml", &t, &error);
  assert_int_not_equal(result, ABBE_OK);
  assert_contains(error.text, part);
  assert_contains(error.text, "t.yaml");
  assert_null(t.material);
}

#define GOOD "  name: x\n  model: constant\n  coefficients: [1.5]\n  source: s\n"

TEST(bad_tables_name_line_and_key) {
  refuses("", "empty");
  refuses("materials: []\n", "t.yaml:1: 'materials' wants a list");
  refuses("materials: 3\n", "wants a list");
  refuses("[1]\n", "must be a mapping");
  refuses("material: []\n",
          "t.yaml:1: a material table has no key 'material'; did you mean 'materials'?");
  refuses("description: d\n", "'materials' is missing");
  refuses("materials:\n- 3\n", "t.yaml:2: a material must be a mapping");
  refuses("materials:\n-\n" GOOD "  colour: red\n", "t.yaml:7: a material has no key 'colour'");
  refuses("materials:\n-\n" GOOD "  temprature_c: 20\n",
          "t.yaml:7: a material has no key 'temprature_c'; did you mean 'temperature_c'?");
  refuses("materials:\n-\n" GOOD "  temperature_c: hot\n", "t.yaml:7: 'temperature_c: hot'");
  refuses("materials:\n-\n" GOOD "  temperature_c: -300\n", "range from -273.15");
  refuses("materials:\n-\n" GOOD "  extrapolate: maybe\n", "true nor false");
  refuses("materials:\n-\n" GOOD "  name: y\n", "a second time; the first is on line 3");
  refuses("materials:\n-\n" GOOD "-\n  name: X\n  model: constant\n  coefficients: [1]\n"
          "  source: s\n",
          "t.yaml:8: the material 'X' stands here a second time; the first is on line 3");
  refuses("materials:\n-\n" GOOD "  points: [[1, 2]]\n", "has no use for 'points'");
  refuses("materials:\n-\n" GOOD "  interpolation: linear\n", "has no use for 'interpolation'");
  refuses("materials:\n- {model: constant, coefficients: [1.5], source: s}\n",
          "t.yaml:2: the key 'name' is missing");
  refuses("materials:\n- {name: x, coefficients: [1.5], source: s}\n", "'model' is missing");
  refuses("materials:\n- {name: x, model: constant, source: s}\n", "'coefficients' is missing");
  refuses("materials:\n- {name: x, model: constant, coefficients: [1.5]}\n", "'source' is missing");
  refuses("materials:\n- {name: ' x', model: constant, coefficients: [1.5], source: s}\n",
          "is not a name");
  refuses("materials:\n- {name: \"\\e[2J\", model: constant, coefficients: [1.5], source: s}\n",
          "is not a name");
}

TEST(a_density_is_the_records_own) {
#define DENSE "materials:\n- name: a\n  model: constant\n  coefficients: [1.5]\n  source: s\n"
  OWNED(abbe_material_table, t) = parse(DENSE "  density_g_cm3: 3.52\n");
  assert_near(t.material[0].catalogue.density_g_cm3, 3.52, 0);
  abbe_material_table_free(&t);
  t = parse("materials:\n" GOOD_RECORD);
  assert_near(t.material[0].catalogue.density_g_cm3, 0, 0);
  refuses(DENSE "  density_g_cm3: 3520\n", "t.yaml:6: 'density_g_cm3: 3520'");
  refuses(DENSE "  density_g_cm3: -1\n", "t.yaml:6: 'density_g_cm3: -1'");
  refuses(DENSE "  density_g_cm3: heavy\n", "t.yaml:6: 'density_g_cm3");
  refuses(DENSE "  density: 3.52\n", "'density'");
  refuses(DENSE "  density_g_cm3: 3.52\n  catalogue: {density_g_cm3: 2}\n",
          "t.yaml:7: 'density_g_cm3' stands in the record and in its catalogue");
#undef DENSE
}

static void refuses_model(const char *rest, const char *part) {
  refuses(printed("materials:\n- name: x\n  source: s\n%s", rest), part);
}

TEST(bad_dispersion_is_refused) {
  refuses_model("  model: selmeier\n",
                "t.yaml:4: 'model: selmeier' is not known; did you mean 'sellmeier'?");
  refuses_model("  model: cauchy\n  coefficients: [1.5, 0.004]\n", "'range_nm' is missing");
  refuses_model("  model: cauchy\n  coefficients: [1.5, nan]\n", "t.yaml:5: 'coefficients: nan'");
  refuses_model("  model: cauchy\n  coefficients: []\n", "1 or more");
  refuses_model("  model: cauchy\n  coefficients: 1.5\n", "list of numbers");
  refuses_model("  model: sellmeier\n  coefficients: [0, 1]\n",
                "t.yaml:5: 'coefficients': the model sellmeier wants an odd");
  refuses_model("  model: constant\n  coefficients: [-1.5]\n", "no real index");
  refuses_model("  model: cauchy\n  coefficients: [1.5]\n  range_nm: [780, 380]\n",
                "t.yaml:6: 'range_nm: [780, 380]' must name the smaller");
  refuses_model("  model: cauchy\n  coefficients: [1.5]\n  range_nm: [380]\n", "wants 2 numbers");
  refuses_model("  model: cauchy\n  coefficients: [1.5]\n  range_nm: [0, 780]\n", "range from 1");
  /* a resonance in nm instead of um puts a pole among the visible wavelengths */
  refuses_model("  model: sellmeier\n  coefficients: [0, 1, 0.5]\n  range_nm: [380, 780]\n",
                "no real index at 380 nm, inside its range");
  refuses_model("  model: tabulated\n", "'points' is missing");
  refuses_model("  model: tabulated\n  points: [[500, 1.5]]\n", "an index at a single wavelength");
  refuses_model("  model: tabulated\n  points: []\n", "list of 1 to 65536 pairs");
  refuses_model("  model: tabulated\n  points: [[400, 1.5], [390, 1.6]]\n", "must ascend");
  refuses_model("  model: tabulated\n  points: [[400, 1.5], [500]]\n", "pairs such as");
  refuses_model("  model: tabulated\n  points: [[400, -1]]\n", "range from 0.001");
  refuses_model("  model: tabulated\n  points: [[400, 1.5], [500, 1.4]]\n  range_nm: [380, 500]\n",
                "wider than the points");
  refuses_model("  model: tabulated\n  points: [[400, 1.5]]\n  interpolation: splin\n",
                "did you mean 'spline'?");
}

#define GLOWS_BY(rows)                                                                             \
  "  absorption: {attenuation_per_m: [[400, 1]]}\n  fluorescence: {matrix: [" rows "]}\n"

TEST(bad_absorption_and_fits_are_refused) {
  const char *const good = "materials:\n-\n" GOOD;
  const struct {
    const char *rest, *part;
  } cases[] = {
      {"  absorption: red\n", "t.yaml:7: 'absorption' wants"},
      {"  absorption: {}\n", "wants one of"},
      {"  absorption: {transmittance: [[400, 0.5]]}\n", "'thickness_m' is missing"},
      {"  absorption: {transmittance: [[400, 99]], thickness_m: 0.01}\n", "range from 0 to 1"},
      {"  absorption: {k: [[400, -1]]}\n", "range from 0"},
      {"  absorption: {color: [1, 1, 1], distance_m: 1}\n", "did you mean 'colour'?"},
      {"  absorption: {colour: [1, 1, 1]}\n", "'distance_m' is missing"},
      {"  absorption: {colour: [1, 1, 1], distance_m: 0}\n", "'distance_m: 0'"},
      {"  absorption: {colour: [0, 1, 1], distance_m: 1}\n", "range from 1e-06 to 1"},
      {"  absorption: {colour: [1, 1], distance_m: 1}\n", "wants 3 numbers"},
      {"  absorption: {colour: [1, 1, 2], distance_m: 1}\n", "'colour: 2'"},
      {"  absorption: {attenuation_per_m: [[400, -1]]}\n", "range from 0"},
      {"  fluorescence: 1\n", "t.yaml:7: 'fluorescence' wants 'yield' and 'emission'"},
      {"  fluorescence: {yield: 0.5}\n", "'fluorescence' wants an 'emission'"},
      {"  fluorescence: {yield: 1.5, emission: [[500, 1], [600, 0]]}\n", "range from 0 to 1"},
      {"  fluorescence: {emission: [[500, 1], [600, 0]]}\n", "wants a 'yield'"},
      {"  fluorescence: {yield: 0, emission: [[500, 1], [600, 0]]}\n", "above 0 and at most 1"},
      {"  fluorescence: {yield: 1, emission: [[500, -1], [600, 0]]}\n", "range from 0"},
      {"  fluorescence: {yield: 1, emission: [[500, 0], [600, 0]]}\n", "some above 0"},
      {"  fluorescence: {yield: 1, emission: [[500, 1], [600, 0]]}\n", "it absorbs nothing"},
      {"  fluorescence: {yield: 1, emission: [[500, 1], [600, 0]], excitation_per_m: [[400, 0], "
       "[490, 0]]}\n",
       "it absorbs nothing"},
      {"  fluorescence: {yield: 1, emission: [[500, 1], [600, 0]], excitation_per_m: [[400, 1], "
       "[510, 1]]}\n",
       "emits from 500 nm and is excited up to 510 nm"},
      {"  fluorescence: {matrix: []}\n", "'matrix' wants rows such as"},
      {"  fluorescence: {yield: 0.5, matrix: [{nm: 400, emission: [[500, 0], [600, 0.01]]}]}\n",
       "leave 'yield', 'emission' and 'excitation_per_m' out"},
      {"  fluorescence: {matrix: [{emission: [[500, 0], [600, 0.01]]}]}\n", "'nm' is missing"},
      {GLOWS_BY("{nm: 400, emission: [[500, 0], [600, 0.01]]}"), "one row"},
      {GLOWS_BY("{nm: 420, emission: [[500, 0], [600, 0.01]]}, {nm: 400, emission: [[500, 0], "
                "[600, 0.01]]}"),
       "ascend; 400 nm follows 420 nm"},
      {GLOWS_BY("{nm: 400, emission: [[500, 0], [600, 0.03]]}, {nm: 420, emission: [[500, 0], "
                "[600, 0.01]]}"),
       "of a photon of 400 nm its re-radiation matrix gives 1.5 back"},
      {GLOWS_BY("{nm: 400, emission: [[415, 0], [600, 0.001]]}, {nm: 420, emission: [[500, 0], "
                "[600, 0.01]]}"),
       "let it emit from 420 nm on"},
      {"  absorption: {attenuation_per_m: 3}\n", "pairs [nm, value]"},
      {"  absorption: {attenuation_per_m: [[400, 1]], distance_m: 2}\n", "no key 'distance_m'"},
      {"  absorption: {attenuation_per_m: [[400, 1]], colour: [1, 1, 1], distance_m: 2}\n",
       "wants one of"},
      {"  fit: 3\n", "'fit' must be a mapping"},
      {"  fit: {cauchy4: {}}\n", "did you mean 'cauchy2'?"},
      {"  fit: {cauchy2: {coefficients: [1], max_error: 0}}\n", "wants 2 numbers"},
      {"  fit: {cauchy2: {coefficients: [1, 2]}}\n", "'max_error' is missing"},
      {"  fit: {cauchy2: {coefficients: [1, 2], max_error: -1}}\n", "'max_error: -1'"},
      {"  fit: {cauchy2: {coefficients: [1, 2], max_error: 0, rnge_nm: [1, 2]}}\n",
       "did you mean 'range_nm'?"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
    refuses(printed("%s%s", good, cases[i].rest), cases[i].part);
}

/* What the documentation shows is read as it stands. */
TEST(the_documented_table_is_one) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/docs/materials.md", 1 << 20, &text, &size, &error));
  char *begin = strstr(text, "```yaml\n");
  assert_non_null(begin);
  begin += strlen("```yaml\n");
  char *end = strstr(begin, "```");
  assert_non_null(end);
  *end = '\0';
  OWNED(abbe_material_table, t) = parse(begin);
  assert_int_equal(t.count, 3);
  assert_near(exp(-0.01 * abbe_material_attenuation(find_material(&t, "liqueur"), 464.2)), 0.08,
              1e-12);
}

/* For an examination all that can be read is there, and the rest is told with its line. */
TEST(a_lenient_reading_keeps_what_can_be_read) {
  const char text[] = "materials:\n"
                      "- {name: a, model: cauchy, coefficients: [1.5, 0.004]}\n"
                      "- {name: b, model: cauchy, coefficients: [1.5, x], range_nm: [380, 780]}\n"
                      "- 3\n"
                      "- {name: A, model: sellmeier2, coefficients: [0, 1, 0.2],\n"
                      "   range_nm: [0.38, 780], source: s}\n";
  OWNED(abbe_material_table, t);
  REFUSED(ABBE_SCHEMA, "", abbe_material_table_parse(text, sizeof text - 1, "t.yaml", &t, &error));
  MADE(abbe_report, report,
       abbe_material_table_parse_lenient(text, sizeof text - 1, "t.yaml", &t, &report, &error));
  assert_int_equal(t.count, 2);
  assert_string_equal(t.material[0].name, "a");
  assert_null(t.material[0].source);
  assert_near(t.material[0].max_nm, 0, 0);
  assert_near(t.material[1].min_nm, 0.38, 0);
  assert_int_equal(t.material[1].line, 5);
  assert_int_equal(report.count, 2);
  assert_int_equal(report.note[0].line, 3);
  assert_string_equal(report.note[0].name, "b");
  assert_string_equal(report.note[0].text, "'coefficients: x' is not a finite number");
  assert_int_equal(report.note[1].line, 4);
  assert_contains(report.note[1].text, "must be a mapping");
  abbe_material_table_free(&t);
  REFUSED(ABBE_SCHEMA, "",
          abbe_material_table_parse_lenient("materials: 3\n", 13, "t.yaml", &t, NULL, &error));
  REFUSED(ABBE_IO, "", abbe_material_table_load_lenient("/no/such.yaml", &t, NULL, &error));
  OK(abbe_material_table_load_lenient("thesis", &t, NULL, &error));
  assert_int_equal(t.count, 5);
}

/* Any cut of a good file is either a smaller good file or a complaint; nothing leaks or crashes. */
static void cut_table_is_harmless(const char *path, size_t step) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &text, &size, &error));
  for (size_t cut = 0; cut < size; cut += step) {
    abbe_material_table t;
    abbe_error why = {0};
    if (abbe_material_table_parse(text, cut, "cut.yaml", &t, &why) == ABBE_OK)
      abbe_material_table_free(&t);
    else
      assert_contains(why.text, "cut.yaml");
  }
}

TEST(cut_tables_are_harmless) {
  cut_table_is_harmless(ABBE_SOURCE_DIR "/spectral/materials/thesis.yaml", 3);
  cut_table_is_harmless(ABBE_SOURCE_DIR "/spectral/materials/materials.yaml", 331);
}
