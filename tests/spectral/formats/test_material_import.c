#include "tests/check.h"

#include "base/file.h"
#include "spectral/dispersion/fit.h"
#include "spectral/formats/material_import.h"
#include "tests/spectral/shipped_table.h"

#define AGF "CC maker\nNM A 2 0 1.5168 64.17\nCD 1.03961212 0.00600069867 0 0 0 0\nLD 0.3 2.5\n"
#define RII                                                                                        \
  "REFERENCES: r\nDATA:\n- {type: formula 5, wavelength_range: 0.4 0.7, coefficients: 1.5}\n"
#define CSV "# mine\nwavelength_nm,n,k\n400,1.5,1e-6\n500,1.49,0\n600,1.48,0\n"
#define YAML "# a table\nmaterials:\n- {name: Y, model: constant, coefficients: [1.5], source: s}\n"

TEST(the_text_says_what_it_is) {
  const struct {
    const char *text;
    abbe_import_format format;
  } rows[] = {{AGF, ABBE_IMPORT_AGF},
              {RII, ABBE_IMPORT_RII},
              {CSV, ABBE_IMPORT_CSV},
              {YAML, ABBE_IMPORT_YAML},
              {"", ABBE_IMPORT_AUTO},
              {"hello\nworld\n", ABBE_IMPORT_AUTO},
              {"12\n", ABBE_IMPORT_AUTO},
              {"  500\t1.5\n", ABBE_IMPORT_CSV},
              {"\"500\";\"1,5\"\n", ABBE_IMPORT_CSV},
              {"20 C\nhello\n", ABBE_IMPORT_AUTO},
              {"20 C, prism\n500,1.5\n", ABBE_IMPORT_CSV},
              {"NM\tA 2\n", ABBE_IMPORT_AGF},
              {"<?xml version", ABBE_IMPORT_AUTO},
              {"<?xml version=\"1.0\"?><materialx>", ABBE_IMPORT_MTLX},
              {"   \n500 1.5                                                                       "
               "                                       and a remark\n",
               ABBE_IMPORT_CSV},
              {"SQLite format 4 is none", ABBE_IMPORT_AUTO},
              {"  DATA:\n", ABBE_IMPORT_RII}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
    assert_int_equal(abbe_import_detect(rows[i].text, strlen(rows[i].text)), rows[i].format);
  static const char store[20] = "SQLite format 3";
  assert_int_equal(abbe_import_detect(store, sizeof store), ABBE_IMPORT_STORE);
  OWNED(abbe_material_table, none) = {0};
  REFUSED(ABBE_UNSUPPORTED, "a store is read from its file",
          abbe_import_parse(store, sizeof store, "x", NULL, &none, NULL, &error));
  static const char wide[] = "\xff\xfeN\0M\0 \0A\0\n\0";
  assert_int_equal(abbe_import_detect(wide, sizeof wide - 1), ABBE_IMPORT_AGF);
}

/* What a remark says is not what the file is. */
TEST(remarks_decide_nothing) {
  const char *const remarks[] = {"20 \xc2\xb0"
                                 "C",
                                 "500 1.5", "materials: one", "NM is the unit", "0.5, 1.5, 0.1"};
  for (size_t i = 0; i < sizeof remarks / sizeof remarks[0]; i++) {
    const char *text = printed("COMMENTS: |\n  %s\n%s", remarks[i], RII);
    assert_int_equal(abbe_import_detect(text, strlen(text)), ABBE_IMPORT_RII);
    MADE(abbe_material_table, table,
         abbe_import_parse(text, strlen(text), "A/nk/B.yml", NULL, &table, NULL, &error));
    assert_string_equal(table.material[0].comment, remarks[i]);
  }
  static const char dated[] = "2012 11 30, the maker's own\n" AGF;
  assert_int_equal(abbe_import_detect(dated, strlen(dated)), ABBE_IMPORT_AGF);
}

TEST(all_kinds_go_into_one_table) {
  const struct {
    const char *text, *path;
  } files[] = {
      {AGF, "maker.agf"}, {RII, "a/SiO2/nk/Me.yml"}, {CSV, "dir/my glass.csv"}, {YAML, "t.yaml"}};
  const char *const names[] = {"A", "SiO2-Me", "my glass", "Y"};
  OWNED(abbe_material_table, table) = {0};
  OWNED(abbe_report, report) = {0};
  for (int i = 0; i < 4; i++)
    OK(abbe_import_parse(files[i].text, strlen(files[i].text), files[i].path, NULL, &table, &report,
                         &error));
  assert_int_equal(table.count, 4);
  for (int i = 0; i < 4; i++) {
    assert_string_equal(table.material[i].name, names[i]);
    OK(abbe_material_check(&table.material[i], &error));
  }
  assert_string_equal(table.description, "maker");
  const abbe_material *points = &table.material[2];
  assert_string_equal(points->source, "measured points in my glass.csv");
  assert_near(points->min_nm, 400, 0);
  assert_near(abbe_material_attenuation(points, 400), 4 * acos(-1) * 1e-6 / 400e-9, 1e-9);
  /* the same again is dropped */
  OK(abbe_import_parse(YAML, strlen(YAML), "t.yaml", NULL, &table, &report, &error));
  OK(abbe_material_table_unique(&table, &report, &error));
  assert_int_equal(table.count, 4);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
}

TEST(options_name_what_the_file_does_not) {
  const abbe_import_options options = {.format = ABBE_IMPORT_CSV,
                                       .name = "prism",
                                       .source = "own measurement",
                                       .csv = {.unit_nm = 1000, .third = ABBE_CSV_K}};
  const char text[] = "0.4 1.5 1e-6\n0.5 1.49 0\n";
  MADE(abbe_material_table, table,
       abbe_import_parse(text, strlen(text), "x", &options, &table, NULL, &error));
  assert_string_equal(table.material[0].name, "prism");
  assert_string_equal(table.material[0].source, "own measurement");
  assert_near(table.material[0].max_nm, 500, 0);
  assert_non_null(table.material[0].attenuation);
}

/* A file without an ending is called by all of its name; a metal by its points is a conductor. */
TEST(points_of_odd_files) {
  static const char metal[] = "nm,n,k\n400,0.2,3\n500,0.2,3\n600,0.2,3\n700,0.2,3\n";
  static const char *const paths[] = {"d.x/gold", ".gold", "gold.csv"};
  static const char *const named[] = {"gold", ".gold", "gold"};
  for (int i = 0; i < 3; i++) {
    MADE(abbe_material_table, table,
         abbe_import_parse(metal, strlen(metal), paths[i], NULL, &table, NULL, &error));
    assert_string_equal(table.material[0].name, named[i]);
    assert_true(abbe_material_is_conductor(&table.material[0]));
  }
}

TEST(clear_points_have_no_absorption) {
  static const char clear[] = "nm,n,k\n400,1.5,0\n500,1.5,0\n";
  MADE(abbe_material_table, table,
       abbe_import_parse(clear, strlen(clear), "c.csv", NULL, &table, NULL, &error));
  assert_null(table.material[0].attenuation);
}

static void refuses(const char *text, const abbe_import_options *options, abbe_result code,
                    const char *part) {
  OWNED(abbe_material_table, table) = {0};
  REFUSED(code, part, abbe_import_parse(text, strlen(text), "x", options, &table, NULL, &error));
  assert_int_equal(table.count, 0);
}

TEST(what_cannot_be_read_is_named) {
  refuses("hello", NULL, ABBE_PARSE, "x: is none of what can be read: a Zemax catalogue has NM");
  refuses("nm,k\n400,1\n", NULL, ABBE_SCHEMA, "holds k but no n");
  refuses(AGF, &(abbe_import_options){.format = ABBE_IMPORT_RII}, ABBE_SCHEMA, "no list 'DATA'");
  refuses(RII, &(abbe_import_options){.format = ABBE_IMPORT_AGF}, ABBE_PARSE, "no NM line");
  refuses("NM A 77\n", NULL, ABBE_SCHEMA, "none of its 1 glasses");
  abbe_material_table table = {0};
  assert_int_equal(abbe_import_load("/nowhere", NULL, &table, NULL, NULL), ABBE_IO);
}

/* ---- the shipped tables ---- */

/* As the catalogues print them; for papers that print none, from an evaluation of their formulas by
 * another hand. The tolerance is half of the last printed digit. */
TEST(shipped_indices_are_the_published_ones) {
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
      {"calcite", 1.658461, 5e-7, 49.914, 5e-4},
      {"fluorite", 1.43385, 5e-6, 95.0, 5e-2},
      {"yag", 1.8328, 5e-5, 52.6, 5e-2},
  };
  OWNED(abbe_material_table, table) = load_table("default");
  const size_t published = sizeof rows / sizeof rows[0];
  size_t metals = 0;
  const size_t stones =
      (size_t)(find_material(&table, "air") - find_material(&table, "ruby")); /* test_stones.c */
  for (size_t i = 0; i < table.count; i++) metals += abbe_material_is_conductor(&table.material[i]);
  assert_int_equal(table.count, published + stones + 1 + metals); /* and air */
  for (size_t i = 0; i < published; i++) {
    const abbe_material *m = find_material(&table, rows[i].name);
    abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
    assert_near(d.n_d, rows[i].n_d, rows[i].n_d_within);
    assert_near(d.v_d, rows[i].v_d, rows[i].v_d_within);
  }
}

/* Both ends of the spectrum, from an evaluation of the same published formulas by another hand. */
TEST(shipped_indices_hold_at_the_ends) {
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
  OWNED(abbe_material_table, table) = load_table(NULL);
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    const abbe_material *m = find_material(&table, rows[i].name);
    double n = 0;
    OK(abbe_material_n(m, 380, &n, &error));
    assert_near(n, rows[i].n_380, 5.1e-7);
    OK(abbe_material_n(m, 780, &n, &error));
    assert_near(n, rows[i].n_780, 5.1e-7);
  }
}

/* The extraordinary index at d, from an evaluation of the same formulas by another hand; of stones
 * whose birefringence alone is known, that. Metals, glasses and cubic or biaxial stones have none.
 */
TEST(shipped_extraordinary_indices_are_the_published_ones) {
  const struct {
    const char *name;
    double n, less; /* less: from the ordinary one */
  } rows[] = {
      {"sapphire", 1.760096, 0},    {"ruby", 1.760096, 0},        {"moissanite", 2.689581, 0},
      {"quartz", 1.553379, 0},      {"amethyst", 1.553379, 0},    {"rutile", 2.910351, 0},
      {"calcite", 1.486185, 0},     {"emerald", 0, 0.006},        {"aquamarine", 0, 0.006},
      {"tourmaline-pink", 0, 0.02}, {"tourmaline-blue", 0, 0.02}, {"zircon", 0, -0.059},
      {"zircon-blue", 0, -0.059},
  };
  OWNED(abbe_material_table, table) = load_table("default");
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    const abbe_material *m = find_material(&table, rows[i].name);
    double n_o = 0, n_e = 0;
    assert_true(abbe_material_is_uniaxial(m));
    OK(abbe_material_n(m, ABBE_LINE_D_NM, &n_o, &error));
    OK(abbe_material_n_extraordinary(m, ABBE_LINE_D_NM, &n_e, &error));
    if (rows[i].n > 0) assert_near(n_e, rows[i].n, 5.1e-7);
    if (rows[i].less != 0) assert_near(n_o - n_e, rows[i].less, 1e-12);
  }
  const char *const others[] = {"diamond", "spinel", "topaz", "peridot", "n-bk7", "gold", "air"};
  for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
    assert_false(abbe_material_is_uniaxial(find_material(&table, others[i])));
}

/* What the indices are relative to has the index 1, exactly and everywhere. */
TEST(air_is_what_indices_are_relative_to) {
  OWNED(abbe_material_table, table) = load_table("default");
  const abbe_material *air = find_material(&table, "air");
  for (double l = 200; l <= 3000; l += 10) {
    double n = 0;
    OK(abbe_material_n(air, l, &n, &error));
    assert_true(n == 1);
    assert_true(abbe_material_attenuation(air, l) == 0);
    assert_false(abbe_material_extrapolates(air, l));
  }
}

/* The shares that are reflected head on, of the printed n and k at or near 582 nm, and the points
 * themselves: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2). */
TEST(shipped_metals_reflect_what_their_sources_say) {
  const struct {
    const char *name;
    double nm, n, k, reflected;
  } rows[] = {
      {"silver", 582.1, 0.05, 3.858, 0.9875},       {"gold", 582.1, 0.29, 2.863, 0.8824},
      {"copper", 582.1, 0.70, 2.704, 0.7255},       {"aluminium", 563.57, 1.0728, 6.7839, 0.9147},
      {"chromium", 582, 3.22, 3.30, 0.5512},        {"iron", 582, 2.94, 2.99, 0.5193},
      {"nickel", 582, 1.96, 3.80, 0.6621},          {"titanium", 582, 2.60, 3.58, 0.5965},
      {"palladium", 582, 1.68, 4.02, 0.7121},       {"platinum", 582.29, 2.1751, 3.8852, 0.6544},
      {"rhodium", 590.4, 2.05, 5.30, 0.7807},       {"green-gold", 580, 0.31411, 3.34981, 0.9030},
      {"mercury", 563.56, 1.62088, 4.7505, 0.7797},
  };
  /* alloys: percent of gold, silver and copper by mass */
  static const struct {
    const char *name;
    double mass[3];
  } alloys[] = {{"gold-22k", {91.7, 5.5, 2.8}},     {"gold-18k", {75, 16, 9}},
                {"gold-14k", {58.5, 25, 16.5}},     {"gold-9k", {37.5, 42.5, 20}},
                {"rose-gold-22k", {91.7, 0, 8.3}},  {"rose-gold-18k", {75, 2.75, 22.25}},
                {"rose-gold-14k", {58.5, 9.5, 32}}, {"rose-gold-9k", {37.5, 20, 42.5}}};
  static const char *const pure[] = {"gold", "silver", "copper"};
  static const double atom[] = {196.967, 107.868, 63.546};
  OWNED(abbe_material_table, table) = load_table("default");
  size_t metals = 0;
  for (size_t i = 0; i < table.count; i++) {
    const abbe_material *m = &table.material[i];
    metals += abbe_material_is_conductor(m);
    for (double l = 360; l <= 830 && abbe_material_is_conductor(m); l++) {
      double n = 0, k = 0;
      OK(abbe_material_nk(m, l, &n, &k, &error));
      assert_true(n > 0.01 && n < 4 && k > 1 && k < 9);
    }
  }
  const size_t published = sizeof rows / sizeof rows[0], mixed = sizeof alloys / sizeof alloys[0];
  assert_int_equal(metals, published + mixed);
  for (size_t i = 0; i < 3 * mixed; i++) {
    const double l[] = {450.9, 548.6, 659.5}, *mass = alloys[i / 3].mass;
    double n = 0, k = 0, real = 0, imaginary = 0, atoms = 0;
    for (int m = 0; m < 3; m++) {
      OK(abbe_material_nk(find_material(&table, pure[m]), l[i % 3], &n, &k, &error));
      real += mass[m] / atom[m] * (n * n - k * k);
      imaginary += mass[m] / atom[m] * 2 * n * k;
      atoms += mass[m] / atom[m];
    }
    OK(abbe_material_nk(find_material(&table, alloys[i / 3].name), l[i % 3], &n, &k, &error));
    assert_near(n * n - k * k, real / atoms, 0.01);
    assert_near(2 * n * k, imaginary / atoms, 0.01);
  }
  for (size_t i = 0; i < published; i++) {
    double n = 0, k = 0;
    OK(abbe_material_nk(find_material(&table, rows[i].name), rows[i].nm, &n, &k, &error));
    assert_near(n, rows[i].n, 1e-12);
    assert_near(k, rows[i].k, 1e-12);
    assert_near(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), rows[i].reflected, 5e-5);
  }
}

static bool varies(const abbe_material *m) {
  return m->dispersion.model != ABBE_DISPERSION_CONSTANT;
}

TEST(every_shipped_row_covers_the_spectrum_and_falls_with_wavelength) {
  OWNED(abbe_material_table, table) = load_table("default");
  for (size_t i = 0; i < table.count; i++) {
    const abbe_material *m = &table.material[i];
    double before = INFINITY;
    if (abbe_material_is_conductor(m)) continue;
    for (double l = 380; l <= 780; l += 2) {
      double n = 0;
      OK(abbe_material_n(m, l, &n, &error));
      assert_true(n < before || !varies(m));
      before = n;
      assert_true(abbe_material_attenuation(m, l) >= 0);
    }
    /* what is continued past its data says so, and nothing else claims to be */
    bool short_of = abbe_material_extrapolates(m, 380) || abbe_material_extrapolates(m, 780);
    assert_int_equal(m->extrapolate, short_of);
    if (short_of) assert_contains(m->warning, "continued");
  }
}

TEST(every_recorded_fit_is_made_again) {
  OWNED(abbe_material_table, table) = load_table("default");
  for (size_t i = 0; i < table.count; i++) {
    const abbe_material *m = &table.material[i];
    if (!varies(m) || abbe_material_is_conductor(m)) continue; /* it is its own fit */
    if (m->dispersion.model == ABBE_DISPERSION_CAUCHY) continue;
    for (size_t k = 0; k < 2; k++) {
      const abbe_material_fit *fit = &m->fit[k];
      abbe_dispersion made;
      double worst = 0;
      assert_int_equal(fit->terms, k + 2);
      assert_near(fit->min_nm, 380, 0);
      assert_near(fit->max_nm, 780, 0);
      OK(abbe_fit_dispersion(&m->dispersion, k + 2, 380, 780, &made, &worst, &error));
      for (size_t j = 0; j < k + 2; j++) assert_near(fit->c[j], made.c[j], 1e-8 * fabs(made.c[j]));
      assert_near(fit->max_error, worst, 0.006 * worst); /* printed to three digits */
      /* and the recorded coefficients do leave no more than the recorded error */
      for (int l = 380; l <= 780; l++) {
        double x = 1e6 / (double)(l * l), n = 0, form = 0;
        for (size_t j = k + 2; j-- > 0;) form = form * x + fit->c[j];
        OK(abbe_material_n(m, l, &n, &error));
        assert_true(fabs(form - n) <= fit->max_error * 1.006 + 1e-8);
      }
    }
    assert_true(m->fit[1].max_error < m->fit[0].max_error);
  }
}

TEST(every_source_is_in_the_bibliography) {
  FREED char *text = NULL;
  size_t size = 0;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/BIBLIOGRAPHY.md", 1 << 20, &text, &size, &error));
  const char *const tables[] = {"default", "thesis"};
  for (int t = 0; t < 2; t++) {
    OWNED(abbe_material_table, table) = load_table(tables[t]);
    for (size_t i = 0; i < table.count; i++) {
      const char *source = table.material[i].source;
      size_t length = strcspn(source, "]") + 1;
      assert_int_equal(source[0], '[');
      assert_contains(text, printed("- **%.*s**", (int)length, source));
    }
  }
}

/* Verbatim: the digits that the thesis prints, and what is wrong with them. */
TEST(the_thesis_is_kept_as_printed) {
  const struct {
    const char *name;
    double a, b, high_by;
  } rows[] = {{"fused-silica", 1.4580, 0.00354, 0.0098},
              {"bk7", 1.5046, 0.00420, 0},
              {"k5", 1.5220, 0.00459, 0.0128},
              {"bak4", 1.5690, 0.00531, 0.0156},
              {"baf10", 1.6700, 0.00743, 0.0215}};
  const char *const now[] = {"fused-silica", "n-bk7", "k5", "n-bak4", "n-baf10"};
  OWNED(abbe_material_table, thesis) = load_table("thesis"), table = load_table("default");
  assert_int_equal(thesis.count, 5);
  for (size_t i = 0; i < 5; i++) {
    const abbe_material *m = find_material(&thesis, rows[i].name);
    assert_int_equal(m->dispersion.model, ABBE_DISPERSION_CAUCHY);
    assert_int_equal(m->dispersion.count, 2);
    assert_near(m->dispersion.c[0], rows[i].a, 0);
    assert_near(m->dispersion.c[1], rows[i].b, 0);
    assert_contains(m->warning, "Historical");
    double old = abbe_dispersion_describe(&m->dispersion).n_d;
    double good = abbe_dispersion_describe(&find_material(&table, now[i])->dispersion).n_d;
    assert_near(old - good, rows[i].high_by, 1e-4);
  }
}

TEST(missing_files_are_named) {
  abbe_material_table t;
  REFUSED(ABBE_IO, "/no/such/table.yaml",
          abbe_material_table_load("/no/such/table.yaml", &t, &error));
  assert_int_equal(t.count, 0);
  REFUSED(ABBE_IO, "", abbe_material_table_load(ABBE_SOURCE_DIR, &t, &error));
}
