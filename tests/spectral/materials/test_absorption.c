#include "tests/check.h"

#include "spectral/editing/check.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/absorption.h"
#include "spectral/materials/material_query.h"
#include "spectral/materials/partners.h"
#include "spectral/store/material_store.h"
#include "tests/spectral/same_material.h"

#include <unistd.h>

/* F2 at 400 nm: an internal transmittance of 0.985 at 25 mm in the catalogue, and k = 1.9245e-8 by
 * the rule k = -ln(T) lambda / (4 pi d). */
TEST(transmittance_and_k_agree) {
  double a = abbe_absorption_from_transmittance(0.985, 0.025);
  assert_near(a, 0.604546, 5e-7);
  assert_near(abbe_absorption_k(a, 400), 1.92433e-8, 5e-13);
  assert_near(abbe_absorption_from_k(1.92432e-8, 400), a, 1e-5);
  assert_near(abbe_absorption_transmittance(a, 0.025), 0.985, 1e-15);
}

TEST(each_way_is_undone_by_its_inverse) {
  for (double t = 1e-6; t <= 1; t *= 1.7) {
    double a = abbe_absorption_from_transmittance(t, 0.01);
    assert_true(a >= 0);
    assert_near(abbe_absorption_transmittance(a, 0.01), t, 1e-12 * t);
    assert_near(abbe_absorption_from_k(abbe_absorption_k(a, 550), 550), a, 1e-12 * a);
  }
  assert_near(abbe_absorption_from_transmittance(1, 0.01), 0, 0);
  assert_false(signbit(abbe_absorption_from_transmittance(1, 0.01)));
  assert_near(abbe_absorption_from_transmittance(1.001, 0.01), 0, 0);
  /* too dark to measure is as dark as the least that is told apart */
  assert_near(abbe_absorption_from_transmittance(0, 0.01), -log(1e-6) / 0.01, 1e-9);
}

TEST(tables_become_spectra_over_their_range) {
  abbe_point list[] = {{400, 0.5, 0}, {500, 1, 0}, {600, 0, 0}};
  const abbe_points points = {.count = 3, .point = list};
  abbe_spectrum *a = NULL;
  OK(abbe_absorption_spectrum_of_transmittance(&points, 0.01, &a, &error));
  assert_near(abbe_spectrum_at(a, 400), log(2) / 0.01, 1e-12);
  assert_near(abbe_spectrum_at(a, 450), log(2) / 0.02, 1e-12);
  assert_near(abbe_spectrum_at(a, 300), log(2) / 0.01, 1e-12);
  assert_int_equal(abbe_spectrum_count(a), 3);
  abbe_spectrum_free(a);
  OK(abbe_absorption_spectrum_of_k(&points, &a, &error));
  assert_near(abbe_spectrum_at(a, 500), 4 * acos(-1) / 500e-9, 1e-6);
  abbe_spectrum_free(a);
}

TEST(a_colour_comes_back_at_its_distance) {
  const double ruby[3] = {0.8, 0.05, 0.1};
  double back[3];
  abbe_spectrum *a = NULL;
  OK(abbe_absorption_spectrum_of_colour(ruby, 0.004, &a, &error));
  abbe_absorption_colour(a, 0.004, back);
  for (int i = 0; i < 3; i++) assert_near(back[i], ruby[i], 1e-15);
  abbe_absorption_colour(a, 0.008, back); /* twice the way, the square */
  for (int i = 0; i < 3; i++) assert_near(back[i], ruby[i] * ruby[i], 1e-15);
  abbe_spectrum_free(a);
}

TEST(wrong_values_are_named) {
  abbe_point high = {450, 99.5, 0}, negative = {450, -1, 0};
  const abbe_points percent = {.count = 1, .point = &high}, none = {0};
  const abbe_points below = {.count = 1, .point = &negative};
  const double colour[3] = {0.5, 0, 0.5};
  abbe_spectrum *a = NULL;
  REFUSED(ABBE_INVALID_ARGUMENT, "at 450 nm is 99.5; it is a share from 0 to 1",
          abbe_absorption_spectrum_of_transmittance(&percent, 0.01, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "thickness",
          abbe_absorption_spectrum_of_transmittance(&none, 0, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "k at 450 nm is -1",
          abbe_absorption_spectrum_of_k(&below, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_absorption_spectrum_of_k(&none, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_absorption_spectrum_of_colour(colour, 0.1, &a, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_absorption_spectrum_of_colour(colour, -1, &a, &error));
  assert_null(a);
}

/* Gold [JohnsonChristy1972]. */
static const double gold_nm[] = {471.4, 495.9, 520.9, 548.6, 582.1, 616.8, 659.5};
static const double gold_n[] = {1.31, 1.04, 0.62, 0.43, 0.29, 0.21, 0.14};
static const double gold_k[] = {1.849, 1.833, 2.081, 2.455, 2.863, 3.272, 3.697};
enum { COUNT = 7 };

static abbe_material gold(void) {
  abbe_material m =
      FIELDS(.name = strdup("gold"), .source = strdup("[JohnsonChristy1972]"), .min_nm = gold_nm[0],
             .max_nm = gold_nm[COUNT - 1], .temperature_c = NAN);
  OK(abbe_conductor_make(gold_nm, gold_n, gold_k, COUNT, &m.dispersion, &error));
  OK(abbe_material_check(&m, &error));
  return m;
}

/* ---- n and k ---- */

TEST(n_and_k_run_straight_between_the_points) {
  OWNED(abbe_material, m) = gold();
  double n = 0, k = 0;
  assert_true(abbe_material_is_conductor(&m));
  for (int i = 0; i < COUNT; i++) {
    OK(abbe_material_nk(&m, gold_nm[i], &n, &k, &error));
    assert_near(n, gold_n[i], 1e-15);
    assert_near(k, gold_k[i], 1e-15);
  }
  OK(abbe_material_nk(&m, (520.9 + 548.6) / 2, &n, &k, &error));
  assert_near(n, (0.62 + 0.43) / 2, 1e-13);
  assert_near(k, (2.081 + 2.455) / 2, 1e-13);
}

TEST(the_range_is_that_of_the_points) {
  OWNED(abbe_material, m) = gold();
  double n = 7, k = 8;
  REFUSED(ABBE_OUT_OF_RANGE, "gold has no n and k at 471 nm",
          abbe_material_nk(&m, 471, &n, &k, &error));
  assert_contains(last_error.text, "from 471.4 to 659.5 nm");
  assert_int_equal(abbe_material_nk(&m, 660, &n, &k, NULL), ABBE_OUT_OF_RANGE);
  assert_int_equal(abbe_material_nk(&m, NAN, &n, &k, NULL), ABBE_OUT_OF_RANGE);
  assert_near(n, 7, 0);
  assert_near(k, 8, 0);
}

TEST(glasses_and_metals_are_not_mistaken) {
  OWNED(abbe_material, m) = gold();
  double n = 7, k = 8;
  REFUSED(ABBE_UNSUPPORTED, "gold is a conductor", abbe_material_n(&m, 550, &n, &error));
  assert_true(isnan(abbe_dispersion_n(&m.dispersion, 550)));
  assert_true(abbe_material_is_opaque(&m, 380, 780));
  abbe_material_numbers numbers;
  abbe_material_numbers_make(&m, &numbers);
  assert_true(isnan(numbers.n_d) && isnan(numbers.v_d) && isnan(numbers.b_g));
  abbe_material glass =
      FIELDS(.name = "glass",
             .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}},
             .min_nm = 400, .max_nm = 700);
  assert_false(abbe_material_is_conductor(&glass));
  REFUSED(ABBE_UNSUPPORTED, "glass is no conductor", abbe_material_nk(&glass, 550, &n, &k, &error));
  assert_false(abbe_dispersion_nk(&glass.dispersion, 550, &n, &k));
  assert_near(n, 7, 0);
}

TEST(points_that_are_none_are_refused) {
  const double nm[] = {400, 500, 500}, n[] = {1, 0, 1e3}, k[] = {2, 2, -1}, bad[] = {1, NAN, 1};
  const double most[] = {1001, 1, 1};
  abbe_dispersion d;
  OK(abbe_conductor_make(nm, n, k, 2, &d, &error));
  abbe_dispersion_free(&d);
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_conductor_make(nm, n, n, 3, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_conductor_make(nm, bad, k, 2, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_conductor_make(nm, n, bad, 2, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "from 0 to 1000",
          abbe_conductor_make(nm, n, k + 1, 2, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_conductor_make(nm, most, k, 2, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_conductor_make(nm, n, k, 0, &d, &error));
  assert_null(d.table);
  d = (abbe_dispersion){.model = ABBE_DISPERSION_CONDUCTOR};
  REFUSED(ABBE_INVALID_ARGUMENT, "wants points of n and of k", abbe_dispersion_check(&d, &error));
}

TEST(a_conductor_has_nothing_of_a_glass) {
  OWNED(abbe_material, m) = gold();
  m.extrapolate = true;
  REFUSED(ABBE_INVALID_ARGUMENT, "gold: the model conductor has no use for 'extrapolate'",
          abbe_material_check(&m, &error));
  m.extrapolate = false;
  m.published_n_d = 0.3;
  REFUSED(ABBE_INVALID_ARGUMENT, "'n_d'", abbe_material_check(&m, &error));
  m.published_n_d = 0;
  m.fit[1].terms = 3;
  REFUSED(ABBE_INVALID_ARGUMENT, "'fit'", abbe_material_check(&m, &error));
  m.fit[1].terms = 0;
  m.max_nm = 700;
  REFUSED(ABBE_INVALID_ARGUMENT, "wider than its points", abbe_material_check(&m, &error));
}

/* ---- in a table ---- */

static void refuses(const char *rest, const char *part) {
  abbe_material_table t;
  const char *text = printed("materials:\n- name: x\n  source: s\n  model: conductor\n%s", rest);
  REFUSED(ABBE_SCHEMA, part, abbe_material_table_parse(text, strlen(text), "t.yaml", &t, &error));
}

TEST(bad_records_are_refused) {
  refuses("", "'points' is missing");
  refuses("  points: []\n", "t.yaml:5: 'points' wants a list of 1 to 65536 points [nm, n, k]");
  refuses("  points: gold\n", "points [nm, n, k]");
  refuses("  points: [[400, 1, 2]]\n", "give it two points or more");
  refuses("  points:\n  - [400, 1, 2]\n  - [500, 1]\n",
          "t.yaml:7: 'points' of a conductor wants [nm, n, k] such as [550, 0.06, 3.6]; this one "
          "has no k");
  refuses("  points: [[400, 1, 2], [500, 1, 2, 3]]\n", "wants [nm, n, k]");
  refuses("  points: [[400, 1, 2], [500, 1, nan]]\n", "t.yaml:5: 'points: nan'");
  refuses("  points: [[400, 1, 2], [500, inf, 1]]\n", "'points: inf'");
  refuses("  points: [[400, 1, 2], [500, -0.1, 1]]\n", "'points: -0.1'");
  refuses("  points: [[400, 1, 2], [500, 0.1, -1]]\n", "'points: -1'");
  refuses("  points: [[400, 1, 2], [500, 0.1, 2000]]\n", "range from 0 to 1000");
  refuses("  points:\n  - [500, 1, 2]\n  - [400, 1, 2]\n",
          "t.yaml:7: 'points': 400 nm follows 500 nm; wavelengths must ascend");
  refuses("  points: [[400, 1, 2], [500, 1, 2]]\n  range_nm: [380, 500]\n", "wider than the");
  refuses("  points: [[400, 1, 2], [500, 1, 2]]\n  extrapolate: true\n",
          "t.yaml:6: the model conductor has no use for 'extrapolate'");
  refuses("  points: [[400, 1, 2], [500, 1, 2]]\n  absorption: {k: [[400, 1]]}\n",
          "no use for 'absorption'");
  refuses("  points: [[400, 1, 2], [500, 1, 2]]\n  interpolation: spline\n",
          "no use for 'interpolation'");
  refuses("  coefficients: [1]\n  points: [[400, 1, 2]]\n", "no use for 'coefficients'");
  refuses("  points: [[400, 1, 2], [500, 1, 2]]\n  n_d: 1.5\n", "no use for 'n_d'");
}

static abbe_material_table table_of(abbe_material *m) {
  abbe_material_table t = {0};
  OK(abbe_material_table_append(&t, m, &error));
  return t;
}

static void same_conductor(const abbe_material *a, const abbe_material *b) {
  assert_same_record(a, b);
  assert_true(same_spectrum(a->dispersion.k, b->dispersion.k, 0));
}

TEST(yaml_and_stores_keep_a_conductor) {
  FREED char *text = NULL;
  char path[] = "/tmp/abbe-conductor-XXXXXX";
  size_t size = 0;
  abbe_material m = gold();
  m.min_nm = 480; /* its range may be narrower */
  OWNED(abbe_material_table, t) = table_of(&m);
  FILE *to = open_memstream(&text, &size);
  OK(abbe_material_table_write(&t, to, &error));
  fclose(to);
  assert_contains(text, "    model: conductor\n    points: [\n      [471.4, 1.31, 1.849], [495.9,");
  MADE(abbe_material_table, back, abbe_material_table_parse(text, size, "t", &back, &error));
  same_conductor(&t.material[0], &back.material[0]);
  abbe_material_table_free(&back);
  to = fdopen(mkstemp(path), "w");
  OK(abbe_material_store_write(&t, to, &error));
  fclose(to);
  OK(abbe_material_store_read(path, NULL, 0, NULL, &back, &error));
  same_conductor(&t.material[0], &back.material[0]);
  unlink(path);
}

/* ---- in other forms ---- */

TEST(refractiveindex_info_keeps_a_conductor) {
  FREED char *text = NULL;
  size_t size = 0;
  OWNED(abbe_material, m) = gold();
  abbe_material back;
  FILE *to = open_memstream(&text, &size);
  MADE(abbe_report, report, abbe_rii_write(&m, to, &report, &error));
  fclose(to);
  assert_int_equal(report.count, 0);
  assert_contains(text, "  - type: tabulated nk\n    data: |\n        0.4714 1.31 1.849\n");
  OK(abbe_rii_parse(text, size, "gold.yml", "gold", &back, &report, &error));
  same_conductor(&m, &back);
  assert_int_equal(report.kinds[ABBE_NOTE_CHANGED], 1);
  abbe_material_free(&back);
}

/* Where light gets through most of the visible, k stays absorption; so it does beyond the visible,
 * and where n and k stand at different wavelengths. */
TEST(what_is_no_metal_stays_transparent) {
  static const char *const texts[] = {
      "DATA:\n  - type: tabulated nk\n    data: |\n      0.4 1.5 0.5\n      0.45 1.5 0\n"
      "      0.7 1.5 0\n",
      "DATA:\n  - type: tabulated nk\n    data: |\n      1.4 1.5 5\n      2.45 1.5 5\n",
      "DATA:\n  - type: tabulated n\n    data: |\n      0.4 1.5\n      0.7 1.4\n"
      "  - type: tabulated k\n    data: |\n      0.4 1.5\n      0.5 1.5\n      0.7 1.4\n"};
  for (int i = 0; i < 3; i++) {
    MADE(abbe_material, m,
         abbe_rii_parse(texts[i], strlen(texts[i]), "a.yml", "a", &m, NULL, &error));
    assert_false(abbe_material_is_conductor(&m));
    assert_non_null(m.attenuation);
  }
}

TEST(csv_keeps_a_conductor) {
  char path[] = "/tmp/abbe-conductor-XXXXXX";
  abbe_material m = gold();
  OWNED(abbe_report, report) = {0};
  FILE *to = fdopen(mkstemp(path), "w");
  OK(abbe_csv_write(&m, NULL, to, NULL, &error));
  fclose(to);
  abbe_import_options options = {
      .format = ABBE_IMPORT_CSV, .name = "gold", .source = "[JohnsonChristy1972]"};
  MADE(abbe_material_table, back, abbe_import_load(path, &options, &back, &report, &error));
  same_conductor(&m, &back.material[0]);
  abbe_material_free(&m);
  unlink(path);
}

TEST(catalogues_of_glass_leave_a_conductor_out) {
  abbe_material m = gold();
  OWNED(abbe_material_table, t) = table_of(&m);
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  MADE(abbe_report, report, abbe_agf_write(&t, to, &report, &error));
  fclose(to);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
  assert_contains(text, "CC");
  assert_null(strstr(text, "nan"));
}

/* ---- among glasses ---- */

TEST(no_glass_is_near_a_conductor) {
  abbe_material m = gold();
  OWNED(abbe_material_table, t) = table_of(&m);
  MADE(abbe_glass_distances, d, abbe_glass_distance_to_numbers(&t, 1.5, 60, 0, &d, &error));
  assert_int_equal(d.count, 0);
  assert_int_equal(d.skipped, 0);
}

TEST(the_check_knows_a_conductor) {
  OWNED(abbe_material, m) = gold();
  MADE(abbe_findings, found, abbe_check_material(&m, NULL, &found, &error));
  assert_int_equal(found.count, 1);
  assert_int_equal(found.finding[0].kind, ABBE_FINDING_DARK);
  assert_contains(found.finding[0].fix, "points that reach further");
}
