#include "tests/check.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/materials/material_query.h"

GROUP(shipped_load, shipped_free);

/* Schott's data sheets print P_gF 0.5349 and 0.6046, and their distance from the normal line. */
TEST(numbers_are_those_of_the_data_sheets) {
  abbe_material_numbers m;
  abbe_material_numbers_make(shipped_material("n-bk7"), &m);
  assert_near(m.n_d, 1.51680, 5e-6);
  assert_near(m.n_e, 1.51872, 5e-6);
  assert_near(m.n_g, 1.52668, 5e-6);
  assert_near(m.n_F, 1.52238, 5e-6);
  assert_near(m.n_C, 1.51432, 5e-6);
  assert_near(m.v_d, 64.17, 5e-3);
  assert_near(m.p_gF, 0.5349, 5e-5);
  assert_near(m.dp_gF, -0.0009, 5e-5);
  abbe_material_numbers_make(shipped_material("sf10"), &m);
  assert_near(m.p_gF, 0.6046, 5e-5);
  assert_near(m.dp_gF, 0.0085, 1.1e-4);
  abbe_material_numbers_make(shipped_material("diamond"), &m);
  assert_near(m.b_g, 0.044, 5e-4); /* as gem tables print it */
}

TEST(what_the_record_does_not_vouch_for_is_not_a_number) {
  abbe_material m = {.dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5, 0.004}},
                     .min_nm = 480,
                     .max_nm = 700};
  abbe_material_numbers numbers;
  abbe_material_numbers_make(&m, &numbers);
  assert_true(isfinite(numbers.v_d) && isfinite(numbers.n_e));
  assert_true(isnan(numbers.n_g) && isnan(numbers.p_gF) && isnan(numbers.dp_gF));
  assert_true(isnan(numbers.b_g));
  m.extrapolate = true;
  abbe_material_numbers_make(&m, &numbers);
  assert_true(isfinite(numbers.p_gF) && isfinite(numbers.b_g));
  m.dispersion.c[1] = 0;
  abbe_material_numbers_make(&m, &numbers);
  assert_true(isinf(numbers.v_d));
  assert_near(numbers.b_g, 0, 0);
}

TEST(published_numbers_are_read_with_their_digits) {
  const struct {
    const char *source;
    double key_n_d, n_d, n_d_half, v_d, v_d_half;
  } cases[] = {
      {"[Schott2017] N-BK7; n_d 1.5168, V_d 64.17", 0, 1.5168, 5e-5, 64.17, 5e-3},
      {"n_d = 1.522490. V_d: 60", 0, 1.522490, 5e-7, 60, 0.5},
      {"index n_d unknown, then n_d 1.5", 0, 1.5, 0.05, NAN, NAN},
      {"mean_n_d 1.4, cn_d 1.3", 0, NAN, NAN, NAN, NAN},
      {"nothing", 1.4875, 1.4875, 5e-5, NAN, NAN},
      {"n_d 1.5168", 1.51680999, 1.51680999, 5e-9, NAN, NAN},
      {"n_d", 0, NAN, NAN, NAN, NAN},
      {NULL, 0, NAN, NAN, NAN, NAN},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char source[100];
    if (cases[i].source != NULL) snprintf(source, sizeof source, "%s", cases[i].source);
    abbe_material m = {.source = cases[i].source ? source : NULL,
                       .published_n_d = cases[i].key_n_d};
    abbe_material_published p;
    abbe_material_published_make(&m, &p);
    const double got[] = {p.n_d, p.n_d_half, p.v_d, p.v_d_half};
    const double want[] = {cases[i].n_d, cases[i].n_d_half, cases[i].v_d, cases[i].v_d_half};
    for (int k = 0; k < 4; k++) {
      assert_int_equal(isnan(got[k]), isnan(want[k]));
      if (!isnan(want[k])) assert_near(got[k], want[k], 1e-9 * want[k]);
    }
  }
}

/* Every shipped row gives the n_d and V_d that its own source prints, to the last digit printed. */
TEST(shipped_rows_give_what_their_sources_print) {
  size_t checked = 0;
  for (size_t i = 0; i < shipped.count; i++) {
    abbe_material_numbers m;
    abbe_material_published p;
    abbe_material_numbers_make(&shipped.material[i], &m);
    abbe_material_published_make(&shipped.material[i], &p);
    if (!isnan(p.n_d)) assert_near(m.n_d, p.n_d, p.n_d_half), checked++;
    if (!isnan(p.v_d)) assert_near(m.v_d, p.v_d, p.v_d_half), checked++;
  }
  assert_true(checked == 16);
}

TEST(recorded_fits_are_held_against_the_formula) {
  for (size_t i = 0; i < shipped.count; i++)
    for (int k = 0; k < 2; k++) {
      const abbe_material *m = &shipped.material[i];
      abbe_index_difference d;
      if (m->fit[k].terms == 0) continue; /* air */
      OK(abbe_material_fit_residual(m, &m->fit[k], &d, &error));
      assert_near(d.max, m->fit[k].max_error, 0.006 * d.max); /* printed to three digits */
      assert_true(d.rms > 0 && d.rms < d.max);
    }
  abbe_index_difference d;
  const abbe_material_fit none = {0}, wrong = {.terms = 9};
  REFUSED(ABBE_INVALID_ARGUMENT, shipped.material[0].name,
          abbe_material_fit_residual(&shipped.material[0], &none, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_material_fit_residual(&shipped.material[0], &wrong, &d, &error));
}
