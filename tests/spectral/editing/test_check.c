#include "tests/check.h"
#include "tests/random.h"
#include "tests/spectral/editing/checked_record.h"

#include "spectral/editing/check.h"
#include "spectral/editing/table_edit.h"
#include "spectral/formats/material_import.h"

static const abbe_finding *find(const abbe_findings *found, abbe_finding_kind kind) {
  for (size_t i = 0; i < found->count; i++)
    if (found->finding[i].kind == kind) return &found->finding[i];
  return NULL;
}

static size_t count_of(const abbe_findings *found, abbe_finding_weight at_least) {
  size_t count = 0;
  for (size_t i = 0; i < found->count; i++) count += found->finding[i].weight >= at_least;
  return count;
}

/* ---- the shipped tables ---- */

GROUP(shipped_load, shipped_free);

TEST(the_thesis_has_four_wrong_rows_and_bk7) {
  MADE(abbe_material_table, thesis, abbe_material_table_load("thesis", &thesis, &error));
  OWNED(abbe_findings, found) = checked_table(&thesis);
  const char *const wrong[] = {"fused-silica", "k5", "bak4", "baf10"};
  const double right_a[] = {1.44775, 1.50870, 1.55362, 1.64848};
  assert_int_equal(found.count, 4);
  for (size_t i = 0; i < 4; i++) {
    const abbe_finding *f = &found.finding[i];
    assert_string_equal(thesis.material[f->row].name, wrong[i]);
    assert_int_equal(f->kind, ABBE_FINDING_A_IS_ND);
    assert_int_equal(f->weight, ABBE_FINDING_WRONG);
    assert_true(f->certain);
    assert_string_equal(f->key, "coefficients");
    assert_near(strtod(f->value + 1, NULL), right_a[i], 5.1e-6);
  }
  assert_contains(found.finding[0].evidence, "fused-silica has 1.45846 and 67.82");
  abbe_findings_free(&found);
}

TEST(the_default_table_is_well) {
  OWNED(abbe_findings, found) = checked_table(&shipped);
  assert_int_equal(count_of(&found, ABBE_FINDING_DOUBTFUL), 0);
  for (size_t i = 0; i < found.count; i++) {
    const abbe_finding *f = &found.finding[i];
    /* a stone's colours differ in absorption alone, or it glows */
    const abbe_material *m = &shipped.material[f->row];
    const bool colours = f->kind == ABBE_FINDING_SAME && f->weight == ABBE_FINDING_NOTE &&
                         (m->attenuation != NULL || abbe_material_is_fluorescent(m));
    if (!colours) assert_int_equal(f->kind, ABBE_FINDING_EXTRAPOLATED);
  }
}

/* ---- one record at a time ---- */

#define POLES "1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653]"
#define ROOTS "1.03961212, 0.0774642, 0.231792344, 0.14148467, 1.01046945, 10.1764755]"

TEST(each_fault_is_found_with_its_fix) {
  const struct {
    const char *record;
    abbe_finding_kind kind;
    abbe_finding_weight weight;
    const char *evidence, *key, *value; /* a key only where the fix is certain */
  } cases[] = {
      {"- {name: a, model: cauchy, coefficients: [1.5046, 4200], range_nm: [380, 780], source: s1}",
       ABBE_FINDING_B_IN_NM2, ABBE_FINDING_WRONG, "1.5168 and 64.43", "coefficients",
       "[1.5046, 0.0042]"},
      {"- {name: a, model: cauchy, coefficients: [1.5, 4200, 2.0e+7], range_nm: [380, 780], "
       "source: s1}",
       ABBE_FINDING_B_IN_NM2, ABBE_FINDING_WRONG, "no transparent material", "coefficients",
       "[1.5, 0.0042, 2e-05]"},
      {"- {name: a, model: cauchy, coefficients: [0.0042, 1.5046], range_nm: [380, 780], source: "
       "s1}",
       ABBE_FINDING_SWAPPED, ABBE_FINDING_WRONG, "n_d is 4.36", "coefficients", "[1.5046, 0.0042]"},
      {"- {name: a, model: cauchy, coefficients: [4200, 1.5046], range_nm: [380, 780], source: s1}",
       ABBE_FINDING_SWAPPED, ABBE_FINDING_WRONG, "B is in nm^2", "coefficients",
       "[1.5046, 0.0042]"},
      {"- {name: bak4, model: cauchy, coefficients: [1.5690, 0.00531], range_nm: [380, 780], "
       "source: s1}",
       ABBE_FINDING_A_IS_ND, ABBE_FINDING_WRONG, "n-bak4 has 1.56883 and 55.98", "coefficients",
       "[1.553619, 0.00531]"},
      {"- {name: a, model: cauchy, coefficients: [1.5690, 0.00531], range_nm: [380, 780], source: "
       "s1, n_d: 1.56883}",
       ABBE_FINDING_A_IS_ND, ABBE_FINDING_WRONG, "its own source has n_d 1.56883", "coefficients",
       "[1.553619, 0.00531]"},
      /* no namesake: the known glass next to it makes it doubtful, not certain */
      {"- {name: a, model: cauchy, coefficients: [1.5690, 0.00531], range_nm: [380, 780], source: "
       "s1}",
       ABBE_FINDING_A_IS_ND, ABBE_FINDING_DOUBTFUL, "n-bak4", NULL, "[1.553619, 0.00531]"},
      {"- {name: BK7, model: sellmeier, coefficients: [0, " POLES
       ", range_nm: [300, 2500], source: s1}",
       ABBE_FINDING_POLES, ABBE_FINDING_WRONG, "squares already", "model", "sellmeier2"},
      /* nothing but an unusual V_d speaks against it, and some materials have one */
      {"- {name: a, model: sellmeier, coefficients: [0, " POLES
       ", range_nm: [300, 2500], source: s1}",
       ABBE_FINDING_POLES, ABBE_FINDING_DOUBTFUL, "read so they are 1.5168 and 64.17", NULL,
       "sellmeier2"},
      {"- {name: a, model: sellmeier2, coefficients: [0, " ROOTS
       ", range_nm: [300, 2500], source: 's1; n_d 1.5168, V_d 64.17'}",
       ABBE_FINDING_POLES, ABBE_FINDING_WRONG, "not squared", "model", "sellmeier"},
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.03961212, 0.00600069867, 0.231792344, "
       "0.14148467, 1.01046945, 103.560653], range_nm: [400, 2500], source: 's1; n_d 1.5168, V_d "
       "64.17'}",
       ABBE_FINDING_POLES, ABBE_FINDING_WRONG, "the pole c4 = 0.141485 is not squared",
       "coefficients", NULL},
      /* a pole and the next strength have changed places, as two columns of a table do */
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.15, 0, 0.0155, 0, 0, 0], range_nm: "
       "[380, 1000], source: s1, n_d: 1.48462, v_d: 38.15}",
       ABBE_FINDING_ORDER, ABBE_FINDING_WRONG, "c2 and c3 have changed places", "coefficients",
       "[0, 1.15, 0.0155, 0, 0, 0, 0]"},
      {"- {name: a, model: sellmeier2, coefficients: [0, 0.231792344, 0.00600069867, 1.03961212, "
       "0.0200179144, 1.01046945, 103.560653], range_nm: [300, 2500], source: 's1; n_d 1.5168, V_d "
       "64.17'}",
       ABBE_FINDING_ORDER, ABBE_FINDING_WRONG, "c1 and c3 have changed places", "coefficients",
       "[0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653]"},
      {"- {name: BK7, model: sellmeier2, coefficients: [0, 0.231792344, 0.00600069867, 1.03961212, "
       "0.0200179144, 1.01046945, 103.560653], range_nm: [300, 2500], source: s1}",
       ABBE_FINDING_ORDER, ABBE_FINDING_WRONG, "the known n-bk7", "coefficients", NULL},
      {"- {name: a, model: polynomial, coefficients: [2.25, -10, -2], range_nm: [380, 780], "
       "source: s1}",
       ABBE_FINDING_NO_INDEX, ABBE_FINDING_WRONG, "no real index at 380 nm", NULL, NULL},
      {"- {name: a, model: constant, coefficients: [1.6], biaxial: {alpha: {model: constant, "
       "coefficients: [1.7]}, gamma: {model: constant, coefficients: [1.65]}}, source: s1}",
       ABBE_FINDING_BIREFRINGENCE, ABBE_FINDING_WRONG, "are 1.7, 1.6 and 1.65", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [0.99, 0.001], range_nm: [380, 780], source: s1}",
       ABBE_FINDING_BELOW_ONE, ABBE_FINDING_WRONG, "0.991644 at 780 nm", NULL, NULL},
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.1, 0.01, 0.9, 60], range_nm: [380, "
       "5800], source: s1}",
       ABBE_FINDING_BELOW_ONE, ABBE_FINDING_DOUBTFUL, "at", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, -0.001], range_nm: [380, 780], source: s1}",
       ABBE_FINDING_RISING, ABBE_FINDING_DOUBTFUL, "from 380 to 780 nm", NULL, NULL},
      {"- {name: a, model: tabulated, interpolation: linear, points: [[380, 1.53], [500, 1.52], "
       "[550, 1.5205], [780, 1.51]], source: s1}",
       ABBE_FINDING_RISING, ABBE_FINDING_DOUBTFUL, "rises by 0.0005 from 500 to 550 nm", NULL,
       NULL},
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.03961212, 0.00600069867, 0.231972344, "
       "0.0200179144, 1.01046945, 103.560653], range_nm: [300, 2500], source: s1, n_d: 1.5168}",
       ABBE_FINDING_OFF_ND, ABBE_FINDING_DOUBTFUL, "1.516863: 6.3e-05 more", NULL, NULL},
      {"- {name: a, model: sellmeier2, coefficients: [0, " POLES
       ", range_nm: [300, 2500], source: s1, n_d: 1.5168, v_d: 61.47}",
       ABBE_FINDING_OFF_VD, ABBE_FINDING_WRONG, "V_d 61.47, its coefficients give 64.167", NULL,
       NULL},
      {"- {name: diamond, model: sellmeier2, coefficients: [0, " POLES
       ", range_nm: [300, 2500], source: s1}",
       ABBE_FINDING_UNLIKE, ABBE_FINDING_DOUBTFUL, "2.41749", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [450, 800], extrapolate: "
       "true, source: s1}",
       ABBE_FINDING_EXTRAPOLATED, ABBE_FINDING_DOUBTFUL, "end at 450 nm", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [350, 700], extrapolate: "
       "true, source: s1, warning: w}",
       ABBE_FINDING_EXTRAPOLATED, ABBE_FINDING_NOTE, "end at 700 nm", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [450, 800], source: s1}",
       ABBE_FINDING_DARK, ABBE_FINDING_NOTE, "from 450 to 800 nm", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [380, 780], source: '?'}",
       ABBE_FINDING_NO_SOURCE, ABBE_FINDING_DOUBTFUL, "'?'", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [380, 780]}",
       ABBE_FINDING_NO_SOURCE, ABBE_FINDING_DOUBTFUL, "no source", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], source: s1}", ABBE_FINDING_UNITS,
       ABBE_FINDING_WRONG, "does not say for which", NULL, NULL},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [0.38, 0.78], source: s1}",
       ABBE_FINDING_UNITS, ABBE_FINDING_WRONG, "0.38 to 0.78", "range_nm", "[380, 780]"},
      {"- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [380, 780], source: s1, "
       "fit: {cauchy2: {coefficients: [1.5, 0.005], max_error: 1.0e-5}}}",
       ABBE_FINDING_FIT, ABBE_FINDING_WRONG, "it errs by 0.00693 at 380 nm", "fit.cauchy2", NULL},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED(abbe_material_table, table) = checked_parse(cases[i].record);
    OWNED(abbe_findings, found) = checked_table(&table);
    const abbe_finding *f = find(&found, cases[i].kind);
    if (f == NULL)
      fail_msg("%s: %s is not found", cases[i].record, abbe_finding_kind_name(cases[i].kind));
    assert_int_equal(count_of(&found, ABBE_FINDING_DOUBTFUL),
                     cases[i].weight >= ABBE_FINDING_DOUBTFUL);
    assert_int_equal(f->weight, cases[i].weight);
    assert_contains(f->evidence, cases[i].evidence);
    assert_true(strlen(f->fix) > 5);
    assert_int_equal(f->certain, cases[i].key != NULL);
    if (cases[i].key != NULL) assert_string_equal(f->key, cases[i].key);
    if (cases[i].value != NULL) assert_string_equal(f->value, cases[i].value);
    assert_int_equal(f->other, ABBE_FINDING_NO_ROW);
  }
}

TEST(rows_that_are_alike_are_found) {
  OWNED(abbe_material_table, table) = checked_parse(
      "- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [380, 780], source: s1}\n"
      "- {name: b, model: cauchy, coefficients: [1.6, 0.009], range_nm: [380, 780], source: s1}\n"
      "- {name: c, model: cauchy, coefficients: [1.5, 0.004], range_nm: [380, 780], source: s1}\n"
      "- {name: B, model: cauchy, coefficients: [1.600004, 0.009], range_nm: [380, 780], source: "
      "s1}\n"
      "- {name: f, model: cauchy, coefficients: [1.70001, 0.01], range_nm: [380, 780], source: "
      "s1}\n"
      "- {name: g, model: cauchy, coefficients: [1.7, 0.01], range_nm: [380, 780], source: s1}\n"
      "- {name: h, model: cauchy, coefficients: [1.70003, 0.01], range_nm: [380, 780], source: "
      "s1}\n"
      "- {name: d, model: constant, coefficients: [1.5], source: s1}\n"
      "- {name: e, model: constant, coefficients: [1.5], source: s1}\n");
  OWNED(abbe_findings, found) = checked_table(&table);
  assert_int_equal(found.count, 4);
  assert_int_equal(found.finding[0].kind, ABBE_FINDING_SAME);
  assert_int_equal(found.finding[0].row, 2);
  assert_int_equal(found.finding[0].other, 0);
  assert_contains(found.finding[0].evidence, "that of a (line 2)");
  assert_int_equal(found.finding[1].kind, ABBE_FINDING_SAME_NAME);
  assert_int_equal(found.finding[1].row, 3);
  assert_int_equal(found.finding[1].other, 1);
  assert_contains(found.finding[1].evidence, "lines 3 and 5");
  assert_int_equal(found.finding[2].kind, ABBE_FINDING_NEAR);
  assert_contains(found.finding[2].evidence, "by 4e-06");
  assert_int_equal(found.finding[3].kind, ABBE_FINDING_NEAR); /* a slip in the last digit */
  assert_contains(found.finding[3].evidence, "that of f (line 6) by 1e-05");
}

/* ---- fixes ---- */

/* Certain fixes put into the text leave nothing certain to fix, and no new fault. */
TEST(certain_fixes_fix) {
  const char text[] =
      "materials:\n"
      "- {name: bak4, model: cauchy, coefficients: [1.5690, 0.00531], range_nm: [380, 780], "
      "source: s1}\n"
      "- {name: nm, model: cauchy, coefficients: [1.7, 9200], range_nm: [380, 780], source: s1}\n"
      "- {name: swap, model: cauchy, coefficients: [0.0142, 1.69], range_nm: [380, 780], source: "
      "s1}\n"
      "- name: poles\n  model: sellmeier\n  coefficients: [0, " POLES "\n  range_nm: [0.3, 2.5]\n"
      "  source: s1; n_d 1.5168, V_d 64.17\n"
      "- {name: one, model: sellmeier2, coefficients: [0, 1.03961212, 0.00600069867, 0.231792344, "
      "0.14148467, 1.01046945, 103.560653], range_nm: [400, 2500], source: 's1; n_d 1.5168, V_d "
      "64.17'}\n"
      "- name: fitted\n  model: cauchy\n  coefficients: [1.52, 0.005, 0.0001]\n"
      "  range_nm: [380, 780]\n  source: s1\n  fit:\n"
      "    cauchy2: {coefficients: [1.5, 0.005], max_error: 1.0e-5}\n";
  abbe_table_edit *edit = NULL;
  abbe_error why = {0};
  OK(abbe_table_edit_parse(text, sizeof text - 1, "t.yaml", &edit, &error));
  size_t fixed = 0, certain = 1;
  for (int pass = 0; pass < 3 && certain > 0; pass++) {
    size_t size = 0;
    const char *now = abbe_table_edit_text(edit, &size);
    abbe_report report = {0};
    MADE(abbe_material_table, table,
         abbe_material_table_parse_lenient(now, size, "t.yaml", &table, &report, &error));
    assert_int_equal(report.count, 0);
    OWNED(abbe_findings, found) = checked_table(&table);
    certain = 0;
    for (size_t i = 0; i < found.count; i++) {
      const abbe_finding *f = &found.finding[i];
      if (!f->certain) continue;
      certain++;
      if (abbe_table_edit_set(edit, table.material[f->row].name, f->key, f->value, &why) != ABBE_OK)
        fail_msg("%s: %s", f->value, why.text);
    }
    fixed += certain;
    if (certain == 0) assert_int_equal(count_of(&found, ABBE_FINDING_DOUBTFUL), 0);
  }
  assert_int_equal(certain, 0);
  assert_int_equal(fixed, 7);
  OK(abbe_table_edit_check(edit, &error));
  abbe_table_edit_free(edit);
}

/* ---- random records ---- */

static abbe_material row(const abbe_dispersion *d) {
  static char name[] = "glass of the day", source[] = "random";
  return (abbe_material){.name = name,
                         .source = source,
                         .dispersion = *d,
                         .min_nm = 380,
                         .max_nm = 780,
                         .temperature_c = NAN};
}

/* The finding of that kind, or none where the kind is ABBE_FINDING_KIND_COUNT, and nothing else. */
static void expect(const abbe_material *m, abbe_finding_kind kind, const abbe_dispersion *right) {
  MADE(abbe_findings, found, abbe_check_material(m, NULL, &found, &error));
  bool good = kind == ABBE_FINDING_KIND_COUNT ? found.count == 0
                                              : found.count == 1 && found.finding[0].kind == kind;
  if (!good) {
    for (size_t i = 0; i < found.count; i++) print_error("%s\n", found.finding[i].evidence);
    fail_msg("%s wanted for %s %g %g %g", abbe_finding_kind_name(kind),
             abbe_dispersion_model_name(m->dispersion.model), m->dispersion.c[0],
             m->dispersion.c[1], m->dispersion.c[2]);
  }
  if (right != NULL) assert_near(strtod(found.finding[0].value + 1, NULL), right->c[0], 2e-6);
}

TEST(densities_in_another_unit_are_found) {
  static const struct {
    double n, density;
    abbe_finding_kind kind;
  } rows[] = {{2.4, 0, ABBE_FINDING_KIND_COUNT},    {2.4, 3.52, ABBE_FINDING_KIND_COUNT},
              {1.5, 22.6, ABBE_FINDING_KIND_COUNT}, {1.5, 23.5, ABBE_FINDING_UNITS},
              {1.5, 0.0025, ABBE_FINDING_UNITS},    {1.0003, 0.0012, ABBE_FINDING_KIND_COUNT},
              {1.03, 0.1, ABBE_FINDING_KIND_COUNT}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_dispersion d = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {rows[i].n}};
    abbe_material m = row(&d);
    m.catalogue.density_g_cm3 = rows[i].density;
    expect(&m, rows[i].kind, NULL);
  }
}

/* Whatever the glass: as it is, it passes; with one fault, that fault is found. */
TEST(any_glass_is_well_or_has_its_own_fault) {
  uint64_t random = 2;
  for (int i = 0; i < 500; i++) {
    double uv = random_between(&random, 0.09, 0.15), ir = random_between(&random, 8, 14);
    const abbe_dispersion good = {
        .model = ABBE_DISPERSION_SELLMEIER,
        .count = 5,
        .c = {0, random_between(&random, 0.9, 2.5), uv, random_between(&random, 0.3, 1.2), ir}};
    abbe_material m = row(&good);
    expect(&m, ABBE_FINDING_KIND_COUNT, NULL);
    m.dispersion.model = ABBE_DISPERSION_SELLMEIER2;
    /* where the unsquared poles still give a usual V_d, nothing but the source tells */
    abbe_dispersion_numbers own = abbe_dispersion_describe(&good);
    m.published_n_d = round(own.n_d * 1e5) / 1e5;
    m.published_v_d = round(own.v_d * 100) / 100;
    MADE(abbe_findings, found, abbe_check_material(&m, NULL, &found, &error));
    assert_int_equal(found.count, 1);
    assert_int_equal(found.finding[0].kind, ABBE_FINDING_POLES);
    assert_string_equal(found.finding[0].value, "sellmeier");

    abbe_dispersion cauchy = {.model = ABBE_DISPERSION_CAUCHY, .count = 2};
    cauchy.c[1] = (own.n_d - 1) / own.v_d / 1.9097;
    cauchy.c[0] = own.n_d - cauchy.c[1] * 2.8966;
    m = row(&cauchy);
    expect(&m, ABBE_FINDING_KIND_COUNT, NULL);
    m.dispersion.c[1] *= 1e6;
    expect(&m, ABBE_FINDING_B_IN_NM2, &cauchy);
    m.dispersion.c[0] = cauchy.c[1];
    m.dispersion.c[1] = cauchy.c[0];
    expect(&m, ABBE_FINDING_SWAPPED, &cauchy);
    m = row(&cauchy);
    m.published_n_d = m.dispersion.c[0] = round(own.n_d * 1e4) / 1e4;
    cauchy.c[0] = m.published_n_d - cauchy.c[1] * 2.89665;
    expect(&m, ABBE_FINDING_A_IS_ND, &cauchy);
  }
}

/* Numbers without any sense are judged without a crash, a hang or a number that is not one. */
TEST(senseless_records_are_survived) {
  uint64_t random = 9;
  for (int i = 0; i < 3000; i++) {
    abbe_dispersion d = {
        .model = (abbe_dispersion_model)(random_bits(&random) % ABBE_DISPERSION_TABULATED)};
    d.count = 1 + random_bits(&random) % ABBE_DISPERSION_MAX_COEFFICIENTS;
    for (size_t k = 0; k < d.count; k++)
      d.c[k] = (random_bits(&random) % 2 ? 1 : -1) * pow(10, random_between(&random, -12, 12));
    abbe_material m = row(&d);
    m.min_nm = pow(10, random_between(&random, 0, 5));
    m.max_nm = m.min_nm * random_between(&random, 1.001, 30);
    m.extrapolate = random_bits(&random) % 2;
    m.published_n_d = random_between(&random, -1, 3);
    m.published_v_d = random_between(&random, -1, 100);
    m.fit[0] = (abbe_material_fit){2, {1.5, 0.004}, 1e-4, 380, 780};
    const abbe_material_table one = {.count = 1, .material = &m};
    MADE(abbe_findings, found, abbe_check_table(&one, &shipped, &found, &error));
    for (size_t k = 0; k < found.count; k++) {
      assert_non_null(found.finding[k].evidence);
      assert_non_null(found.finding[k].fix);
      if (found.finding[k].certain) assert_null(strstr(found.finding[k].value, "nan"));
    }
  }
}

TEST(namesakes_are_found_in_any_spelling) {
  const struct {
    const char *name, *known;
  } cases[] = {{"BK7", "n-bk7"},     {"N-BK7", "n-bk7"}, {"nbk7", NULL},
               {"N-SF11", "n-sf11"}, {"SF 11", "sf11"},  {"Fused Silica", "fused-silica"},
               {"kryptonite", NULL}, {"", NULL},         {"---", NULL}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    const abbe_material *m = abbe_check_namesake(&shipped, cases[i].name);
    assert_int_equal(m != NULL, cases[i].known != NULL);
    if (m != NULL) assert_string_equal(m->name, cases[i].known);
  }
  assert_null(abbe_check_namesake(NULL, "n-bk7"));
}

TEST(words_are_there_for_all) {
  for (int i = 0; i < ABBE_FINDING_KIND_COUNT; i++)
    assert_true(strlen(abbe_finding_kind_meaning((abbe_finding_kind)i)) > 10);
  assert_string_equal(abbe_finding_kind_name((abbe_finding_kind)-1), "unknown");
  assert_string_equal(abbe_finding_kind_meaning(ABBE_FINDING_KIND_COUNT), "unknown");
  assert_string_equal(abbe_finding_weight_name(ABBE_FINDING_WRONG), "wrong");
}

/* Calcite's and calomel's indices go together; those of a copied digit or unit do not. */
TEST(crystals_have_indices_that_go_together) {
  const struct {
    const char *extraordinary;
    size_t findings;
  } rows[] = {{"{model: constant, coefficients: [1.486]}", 0},
              {"{model: constant, coefficients: [2.35]}", 0},
              {"{model: constant, coefficients: [2.4]}", 1},
              {"{model: constant, coefficients: [0.99]}", 1},
              {"{model: cauchy, coefficients: [1.48, 4000]}", 1},
              {"{model: sellmeier2, coefficients: [0, -2, 0.01]}", 1}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    OWNED(abbe_material_table, t) = checked_parse(
        printed("- {name: spar, model: cauchy, coefficients: [1.64, 0.007], range_nm: [350, 900],\n"
                "   source: a book, extraordinary: %s}\n",
                rows[i].extraordinary));
    OWNED(abbe_findings, found) = checked_table(&t);
    size_t count = 0;
    for (size_t k = 0; k < found.count; k++)
      count += found.finding[k].kind == ABBE_FINDING_BIREFRINGENCE;
    assert_int_equal(count, rows[i].findings);
  }
}
