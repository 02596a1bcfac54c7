#include "tests/check.h"

#include "base/file.h"
#include "spectral/dispersion/fit.h"
#include "spectral/formats/material_table_load.h"

#include <stdlib.h>

static abbe_material_table load(const char *path) {
  abbe_material_table table;
  abbe_error error = {0};
  if (abbe_material_table_load(path, &table, &error) != ABBE_OK) fail_msg("%s", error.text);
  return table;
}

static const abbe_material *find(const abbe_material_table *table, const char *name) {
  const abbe_material *m = NULL;
  abbe_error error = {0};
  if (abbe_material_table_find(table, name, &m, &error) != ABBE_OK) fail_msg("%s", error.text);
  return m;
}

/* ---- the shipped tables ---- */

/* As the catalogues print them; for papers that print none, from an evaluation of their formulas by
 * another hand. The tolerance is half of the last printed digit. */
static void shipped_indices_are_the_published_ones(void **state) {
  (void)state;
  const struct {
    const char *name;
    double n_d, n_d_within, v_d, v_d_within;
  } rows[] = {
      {"fused-silica", 1.458464, 5e-7, 67.821, 5e-4},
      {"n-bk7", 1.51680, 5e-6, 64.17, 5e-3},
      {"k5", 1.522490, 5e-7, 59.731, 5e-4},
      {"n-bak4", 1.56883, 5e-6, 55.98, 5e-3},
      {"n-baf10", 1.67003, 5e-6, 47.11, 5e-3},
      {"f2", 1.62004, 5e-6, 36.37, 5e-3},
      {"sf10", 1.72825, 5e-6, 28.41, 5e-3},
      {"sf11", 1.78472, 5e-6, 25.76, 5e-3},
      {"n-sf11", 1.78472, 5e-6, 25.68, 5e-3},
      {"water", 1.333403, 5e-7, 55.760, 5e-4},
      {"pmma", 1.490595, 5e-7, 58.005, 5e-4},
      {"sapphire", 1.768172, 5e-7, 72.309, 5e-4},
      {"diamond", 2.417486, 5e-7, 55.301, 5e-4},
      {"cubic-zirconia", 2.158769, 5e-7, 33.540, 5e-4},
      {"moissanite", 2.647990, 5e-7, 25.957, 5e-4},
      {"quartz", 1.544276, 5e-7, 69.689, 5e-4},
      {"rutile", 2.614265, 5e-7, 9.869, 5e-4},
      {"fluorite", 1.43385, 5e-6, 95.0, 5e-2},
      {"yag", 1.8328, 5e-5, 52.6, 5e-2},
  };
  abbe_material_table table = load("default");
  const size_t published = sizeof rows / sizeof rows[0];
  assert_int_equal(table.count, published + 1); /* and air */
  for (size_t i = 0; i < published; i++) {
    const abbe_material *m = find(&table, rows[i].name);
    abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
    assert_near(d.n_d, rows[i].n_d, rows[i].n_d_within);
    assert_near(d.v_d, rows[i].v_d, rows[i].v_d_within);
  }
  abbe_material_table_free(&table);
}

/* Both ends of the spectrum, from an evaluation of the same published formulas by another hand. */
static void shipped_indices_hold_at_the_ends(void **state) {
  (void)state;
  const struct {
    const char *name;
    double n_380, n_780;
  } rows[] = {
      {"n-bk7", 1.533745, 1.511183},          {"sf10", 1.790460, 1.712268},
      {"fused-silica", 1.472485, 1.453671},   {"diamond", 2.474068, 2.401104},
      {"sapphire", 1.790254, 1.760681},       {"water", 1.345619, 1.328961},
      {"cubic-zirconia", 2.237196, 2.136650}, {"k5", 1.541144, 1.516617},
      {"moissanite", 2.795213, 2.608101},     {"rutile", 3.117870, 2.524920},
      {"quartz", 1.560460, 1.538743},         {"pmma", 1.509101, 1.485111},
  };
  abbe_material_table table = load(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    const abbe_material *m = find(&table, rows[i].name);
    double n = 0;
    assert_int_equal(abbe_material_n(m, 380, &n, NULL), ABBE_OK);
    assert_near(n, rows[i].n_380, 5.1e-7);
    assert_int_equal(abbe_material_n(m, 780, &n, NULL), ABBE_OK);
    assert_near(n, rows[i].n_780, 5.1e-7);
  }
  abbe_material_table_free(&table);
}

/* What the indices are relative to has the index 1, exactly and everywhere. */
static void air_is_what_indices_are_relative_to(void **state) {
  (void)state;
  abbe_material_table table = load("default");
  const abbe_material *air = find(&table, "air");
  for (double l = 200; l <= 3000; l += 10) {
    double n = 0;
    assert_int_equal(abbe_material_n(air, l, &n, NULL), ABBE_OK);
    assert_true(n == 1);
    assert_true(abbe_material_attenuation(air, l) == 0);
    assert_false(abbe_material_extrapolates(air, l));
  }
  abbe_material_table_free(&table);
}

static bool varies(const abbe_material *m) {
  return m->dispersion.model != ABBE_DISPERSION_CONSTANT;
}

static void every_shipped_row_covers_the_spectrum_and_falls_with_wavelength(void **state) {
  (void)state;
  abbe_material_table table = load("default");
  for (size_t i = 0; i < table.count; i++) {
    const abbe_material *m = &table.material[i];
    double before = INFINITY;
    for (double l = 380; l <= 780; l += 2) {
      double n = 0;
      assert_int_equal(abbe_material_n(m, l, &n, NULL), ABBE_OK);
      assert_true(n < before || !varies(m));
      before = n;
      assert_true(abbe_material_attenuation(m, l) >= 0);
    }
    /* what is continued past its data says so, and nothing else claims to be */
    bool short_of = abbe_material_extrapolates(m, 380) || abbe_material_extrapolates(m, 780);
    assert_int_equal(m->extrapolate, short_of);
    if (short_of) assert_contains(m->warning, "continued");
  }
  abbe_material_table_free(&table);
}

static void every_recorded_fit_is_made_again(void **state) {
  (void)state;
  abbe_material_table table = load("default");
  for (size_t i = 0; i < table.count; i++) {
    const abbe_material *m = &table.material[i];
    if (!varies(m)) continue; /* it is its own fit */
    for (size_t k = 0; k < 2; k++) {
      const abbe_material_fit *fit = &m->fit[k];
      abbe_dispersion made;
      double worst = 0;
      assert_int_equal(fit->terms, k + 2);
      assert_near(fit->min_nm, 380, 0);
      assert_near(fit->max_nm, 780, 0);
      assert_int_equal(abbe_fit_dispersion(&m->dispersion, k + 2, 380, 780, &made, &worst, NULL),
                       ABBE_OK);
      for (size_t j = 0; j < k + 2; j++) assert_near(fit->c[j], made.c[j], 1e-8 * fabs(made.c[j]));
      assert_near(fit->max_error, worst, 0.006 * worst); /* printed to three digits */
      /* and the recorded coefficients do leave no more than the recorded error */
      for (int l = 380; l <= 780; l++) {
        double x = 1e6 / (double)(l * l), n = 0, form = 0;
        for (size_t j = k + 2; j-- > 0;) form = form * x + fit->c[j];
        assert_int_equal(abbe_material_n(m, l, &n, NULL), ABBE_OK);
        assert_true(fabs(form - n) <= fit->max_error * 1.006 + 1e-8);
      }
    }
    assert_true(m->fit[1].max_error < m->fit[0].max_error);
  }
  abbe_material_table_free(&table);
}

static void every_source_is_in_the_bibliography(void **state) {
  (void)state;
  char *text = NULL;
  size_t size = 0;
  assert_int_equal(abbe_file_read(ABBE_SOURCE_DIR "/BIBLIOGRAPHY.md", 1 << 20, &text, &size, NULL),
                   ABBE_OK);
  const char *const tables[] = {"default", "thesis"};
  for (int t = 0; t < 2; t++) {
    abbe_material_table table = load(tables[t]);
    for (size_t i = 0; i < table.count; i++) {
      const char *source = table.material[i].source;
      size_t length = strcspn(source, "]") + 1;
      char key[128];
      assert_int_equal(source[0], '[');
      snprintf(key, sizeof key, "- **%.*s**", (int)length, source);
      assert_contains(text, key);
    }
    abbe_material_table_free(&table);
  }
  free(text);
}

/* Verbatim: the digits that the thesis prints, and what is wrong with them. */
static void the_thesis_is_kept_as_printed(void **state) {
  (void)state;
  const struct {
    const char *name;
    double a, b, high_by;
  } rows[] = {{"fused-silica", 1.4580, 0.00354, 0.0098},
              {"bk7", 1.5046, 0.00420, 0},
              {"k5", 1.5220, 0.00459, 0.0128},
              {"bak4", 1.5690, 0.00531, 0.0156},
              {"baf10", 1.6700, 0.00743, 0.0215}};
  const char *const now[] = {"fused-silica", "n-bk7", "k5", "n-bak4", "n-baf10"};
  abbe_material_table thesis = load("thesis"), table = load("default");
  assert_int_equal(thesis.count, 5);
  for (size_t i = 0; i < 5; i++) {
    const abbe_material *m = find(&thesis, rows[i].name);
    assert_int_equal(m->dispersion.model, ABBE_DISPERSION_CAUCHY);
    assert_int_equal(m->dispersion.count, 2);
    assert_near(m->dispersion.c[0], rows[i].a, 0);
    assert_near(m->dispersion.c[1], rows[i].b, 0);
    assert_contains(m->warning, "Historical");
    double old = abbe_dispersion_describe(&m->dispersion).n_d;
    double good = abbe_dispersion_describe(&find(&table, now[i])->dispersion).n_d;
    assert_near(old - good, rows[i].high_by, 1e-4);
  }
  abbe_material_table_free(&thesis);
  abbe_material_table_free(&table);
}

static void names_are_found_in_any_case_or_suggested(void **state) {
  (void)state;
  abbe_material_table table = load("default");
  const abbe_material *m = NULL;
  abbe_error error;
  assert_string_equal(find(&table, "DIAMOND")->name, "diamond");
  assert_int_equal(abbe_material_table_find(&table, "diamnod", &m, &error), ABBE_NOT_FOUND);
  assert_contains(error.text, "'default' has no material 'diamnod'; did you mean 'diamond'?");
  assert_int_equal(abbe_material_table_find(&table, "kryptonite-glass", &m, &error),
                   ABBE_NOT_FOUND);
  assert_contains(error.text, "it has fused-silica, n-bk7");
  assert_null(m);
  abbe_material_table_free(&table);
  abbe_material_table_free(&table);
}

static void of_a_long_list_whole_names_are_told(void **state) {
  (void)state;
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
  abbe_error error = {0};
  if (abbe_material_table_parse(text, strlen(text), "t.yaml", &table, &error) != ABBE_OK)
    fail_msg("%s", error.text);
  return table;
}

static void a_record_may_be_short(void **state) {
  (void)state;
  abbe_material_table t = parse("materials:\n  - {name: x, model: constant, coefficients: [1.5],"
                                " source: made up}\n");
  assert_int_equal(t.count, 1);
  assert_string_equal(t.path, "t.yaml");
  assert_int_equal(t.material[0].line, 2);
  assert_true(isnan(t.material[0].temperature_c));
  assert_null(t.material[0].attenuation);
  assert_int_equal(t.material[0].fit[0].terms, 0);
  assert_false(t.material[0].extrapolate);
  double n = 0;
  assert_int_equal(abbe_material_n(&t.material[0], 500, &n, NULL), ABBE_OK);
  assert_near(n, 1.5, 0);
  abbe_material_table_free(&t);
}

static void points_make_an_index(void **state) {
  (void)state;
  abbe_material_table t =
      parse("materials:\n- name: x\n  model: tabulated\n  interpolation: linear\n"
            "  points: [[400, 1.6], [600, 1.5], [800, 1.45]]\n  source: made up\n"
            "  temperature_c: -5\n");
  const abbe_material *m = &t.material[0];
  double n = 0;
  assert_near(m->min_nm, 400, 0);
  assert_near(m->max_nm, 800, 0);
  assert_near(m->temperature_c, -5, 0);
  assert_int_equal(abbe_material_n(m, 500, &n, NULL), ABBE_OK);
  assert_near(n, 1.55, 1e-15);
  assert_int_equal(abbe_material_n(m, 399, &n, NULL), ABBE_OUT_OF_RANGE);
  abbe_material_table_free(&t);
}

/* A colour at a distance: its transmittances come back at that distance. */
static void absorption_is_a_spectrum_or_a_colour(void **state) {
  (void)state;
  abbe_material_table t = parse("materials:\n"
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
  abbe_material_table_free(&t);
}

static void absorption_is_also_a_transmittance_or_k(void **state) {
  (void)state;
  abbe_material_table t = parse("materials:\n"
                                "- {name: a, model: constant, coefficients: [1.5], source: s,\n"
                                "   absorption: {transmittance: [[400, 0.5], [500, 1]],\n"
                                "     thickness_m: 0.01}}\n"
                                "- {name: b, model: constant, coefficients: [1.5], source: s,\n"
                                "   absorption: {k: [[400, 1e-7], [500, 2e-7]]}}\n");
  assert_near(exp(-0.01 * abbe_material_attenuation(&t.material[0], 400)), 0.5, 1e-14);
  assert_near(abbe_material_attenuation(&t.material[1], 400), 4 * acos(-1) * 0.25, 1e-12);
  abbe_material_table_free(&t);
}

static void what_the_catalogue_prints_is_kept(void **state) {
  (void)state;
  abbe_material_table t =
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
  abbe_material_table_free(&t);
}

static void materials_are_moved_to_a_table(void **state) {
  (void)state;
  abbe_material_table t = parse("materials:\n" GOOD_RECORD);
  for (int i = 0; i < 20; i++) {
    abbe_material m = {.name = strdup("y"), .published_n_d = i};
    assert_int_equal(abbe_material_table_append(&t, &m, NULL), ABBE_OK);
    assert_null(m.name);
  }
  assert_int_equal(t.count, 21);
  assert_near(t.material[20].published_n_d, 19, 0);
  assert_string_equal(t.material[0].name, "x");
  abbe_material_table_free(&t);
}

static void aliases_may_share_a_record_part(void **state) {
  (void)state;
  abbe_material_table t =
      parse("materials:\n"
            "- {name: a, model: cauchy, coefficients: &c [1.5, 0.004], range_nm: &r [380, 780],\n"
            "   source: s}\n"
            "- {name: b, model: cauchy, coefficients: *c, range_nm: *r, source: s}\n");
  assert_near(t.material[1].dispersion.c[1], 0.004, 0);
  abbe_material_table_free(&t);
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

static void bad_tables_name_line_and_key(void **state) {
  (void)state;
  refuses("", "empty");
  refuses("materials: []\n", "t.yaml:1: 'materials' wants a list");
  refuses("materials: 3\n", "wants a list");
  refuses("[1]\n", "must be a mapping");
  refuses("material: []\n", "t.yaml:1: a material table has no key 'material'; did you mean "
                            "'materials'?");
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

static void refuses_model(const char *rest, const char *part) {
  char text[1024];
  snprintf(text, sizeof text, "materials:\n- name: x\n  source: s\n%s", rest);
  refuses(text, part);
}

static void bad_dispersion_is_refused(void **state) {
  (void)state;
  refuses_model("  model: selmeier\n", "t.yaml:4: 'model: selmeier' is not known; did you mean "
                                       "'sellmeier'?");
  refuses_model("  model: cauchy\n  coefficients: [1.5, 0.004]\n", "'range_nm' is missing");
  refuses_model("  model: cauchy\n  coefficients: [1.5, nan]\n", "t.yaml:5: 'coefficients: nan'");
  refuses_model("  model: cauchy\n  coefficients: []\n", "1 or more");
  refuses_model("  model: cauchy\n  coefficients: 1.5\n", "list of numbers");
  refuses_model("  model: sellmeier\n  coefficients: [0, 1]\n", "t.yaml:5: 'coefficients': the "
                                                                "model sellmeier wants an odd");
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

static void bad_absorption_and_fits_are_refused(void **state) {
  (void)state;
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
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[1024];
    snprintf(text, sizeof text, "%s%s", good, cases[i].rest);
    refuses(text, cases[i].part);
  }
}

static void missing_files_are_named(void **state) {
  (void)state;
  abbe_material_table t;
  abbe_error error;
  assert_int_equal(abbe_material_table_load("/no/such/table.yaml", &t, &error), ABBE_IO);
  assert_contains(error.text, "/no/such/table.yaml");
  assert_int_equal(t.count, 0);
  assert_int_equal(abbe_material_table_load(ABBE_SOURCE_DIR, &t, &error), ABBE_IO);
}

/* What the documentation shows is read as it stands. */
static void the_documented_table_is_one(void **state) {
  (void)state;
  char *text = NULL;
  size_t size = 0;
  assert_int_equal(
      abbe_file_read(ABBE_SOURCE_DIR "/docs/materials.md", 1 << 20, &text, &size, NULL), ABBE_OK);
  char *begin = strstr(text, "```yaml\n");
  assert_non_null(begin);
  begin += strlen("```yaml\n");
  char *end = strstr(begin, "```");
  assert_non_null(end);
  *end = '\0';
  abbe_material_table t = parse(begin);
  assert_int_equal(t.count, 3);
  assert_near(exp(-0.01 * abbe_material_attenuation(find(&t, "liqueur"), 464.2)), 0.08, 1e-12);
  abbe_material_table_free(&t);
  free(text);
}

/* For an examination all that can be read is there, and the rest is told with its line. */
static void a_lenient_reading_keeps_what_can_be_read(void **state) {
  (void)state;
  const char text[] = "materials:\n"
                      "- {name: a, model: cauchy, coefficients: [1.5, 0.004]}\n"
                      "- {name: b, model: cauchy, coefficients: [1.5, x], range_nm: [380, 780]}\n"
                      "- 3\n"
                      "- {name: A, model: sellmeier2, coefficients: [0, 1, 0.2],\n"
                      "   range_nm: [0.38, 780], source: s}\n";
  abbe_material_table t;
  abbe_report report = {0};
  abbe_error error = {0};
  assert_int_equal(abbe_material_table_parse(text, sizeof text - 1, "t.yaml", &t, &error),
                   ABBE_SCHEMA);
  assert_int_equal(
      abbe_material_table_parse_lenient(text, sizeof text - 1, "t.yaml", &t, &report, &error),
      ABBE_OK);
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
  abbe_report_free(&report);
  assert_int_equal(abbe_material_table_parse_lenient("materials: 3\n", 13, "t.yaml", &t, NULL,
                                                     &error),
                   ABBE_SCHEMA);
  assert_int_equal(abbe_material_table_load_lenient("/no/such.yaml", &t, NULL, &error), ABBE_IO);
  assert_int_equal(abbe_material_table_load_lenient("thesis", &t, NULL, &error), ABBE_OK);
  assert_int_equal(t.count, 5);
  abbe_material_table_free(&t);
}

/* Any cut of a good file is either a smaller good file or a complaint; nothing leaks or crashes. */
static void cut_tables_are_harmless(void **state) {
  (void)state;
  char *text = NULL;
  size_t size = 0;
  assert_int_equal(
      abbe_file_read(ABBE_SOURCE_DIR "/spectral/materials/materials.yaml", 1 << 20, &text, &size, NULL),
      ABBE_OK);
  for (size_t cut = 0; cut < size; cut += 37) {
    abbe_material_table t;
    abbe_error error = {0};
    if (abbe_material_table_parse(text, cut, "cut.yaml", &t, &error) == ABBE_OK)
      abbe_material_table_free(&t);
    else
      assert_contains(error.text, "cut.yaml");
  }
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shipped_indices_are_the_published_ones),
      cmocka_unit_test(shipped_indices_hold_at_the_ends),
      cmocka_unit_test(air_is_what_indices_are_relative_to),
      cmocka_unit_test(every_shipped_row_covers_the_spectrum_and_falls_with_wavelength),
      cmocka_unit_test(every_recorded_fit_is_made_again),
      cmocka_unit_test(every_source_is_in_the_bibliography),
      cmocka_unit_test(the_thesis_is_kept_as_printed),
      cmocka_unit_test(names_are_found_in_any_case_or_suggested),
      cmocka_unit_test(of_a_long_list_whole_names_are_told),
      cmocka_unit_test(a_record_may_be_short),
      cmocka_unit_test(points_make_an_index),
      cmocka_unit_test(absorption_is_a_spectrum_or_a_colour),
      cmocka_unit_test(absorption_is_also_a_transmittance_or_k),
      cmocka_unit_test(what_the_catalogue_prints_is_kept),
      cmocka_unit_test(materials_are_moved_to_a_table),
      cmocka_unit_test(aliases_may_share_a_record_part),
      cmocka_unit_test(bad_tables_name_line_and_key),
      cmocka_unit_test(bad_dispersion_is_refused),
      cmocka_unit_test(bad_absorption_and_fits_are_refused),
      cmocka_unit_test(missing_files_are_named),
      cmocka_unit_test(the_documented_table_is_one),
      cmocka_unit_test(a_lenient_reading_keeps_what_can_be_read),
      cmocka_unit_test(cut_tables_are_harmless),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
