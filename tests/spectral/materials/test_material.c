#include "tests/check.h"

#include "spectral/materials/absorption.h"
#include "spectral/materials/material.h"

static abbe_material glass(char *name) {
  return (abbe_material){
      .name = name,
      .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5, 0.004}},
      .min_nm = 400,
      .max_nm = 700};
}

TEST(the_range_is_kept) {
  abbe_material m = glass("glass");
  double n = 7;
  OK(abbe_material_n(&m, 500, &n, &error));
  assert_near(n, 1.516, 1e-15);
  OK(abbe_material_n(&m, 400, &n, &error));
  OK(abbe_material_n(&m, 700, &n, &error));
  n = 7;
  REFUSED(ABBE_OUT_OF_RANGE, "glass has no index at 399.9 nm",
          abbe_material_n(&m, 399.9, &n, &error));
  assert_contains(last_error.text, "from 400 to 700 nm");
  assert_int_equal(abbe_material_n(&m, 700.1, &n, NULL), ABBE_OUT_OF_RANGE);
  assert_near(n, 7, 0);
}

TEST(extrapolation_is_allowed_and_told) {
  abbe_material m = glass("glass");
  double n = 0;
  m.extrapolate = true;
  OK(abbe_material_n(&m, 250, &n, &error));
  assert_near(n, 1.564, 1e-15);
  assert_true(abbe_material_extrapolates(&m, 250));
  assert_false(abbe_material_extrapolates(&m, 400));
  assert_false(abbe_material_extrapolates(&m, 700));
  assert_true(abbe_material_extrapolates(&m, 700.0001));
}

TEST(no_real_index_is_an_error) {
  abbe_material m = glass("glass");
  double n = 7;
  m.extrapolate = true;
  m.dispersion.c[1] = -1;
  REFUSED(ABBE_INVALID_ARGUMENT, "no real index at 500 nm", abbe_material_n(&m, 500, &n, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_material_n(&m, NAN, &n, &error));
  assert_near(n, 7, 0);
}

TEST(attenuation_is_zero_or_more) {
  OWNED(abbe_material, m) = glass(NULL);
  assert_near(abbe_material_attenuation(&m, 500), 0, 0);
  OK(abbe_spectrum_make((double[]){400, 500, 600, 700}, (double[]){9, 0, 0, 9}, 4,
                        ABBE_INTERPOLATION_SPLINE, &m.attenuation, &error));
  assert_near(abbe_material_attenuation(&m, 400), 9, 0);
  assert_near(abbe_material_attenuation(&m, 300), 9, 0);
  assert_true(abbe_spectrum_at(m.attenuation, 550) < 0);
  assert_near(abbe_material_attenuation(&m, 550), 0, 0);
  abbe_material_free(&m);
  assert_null(m.attenuation);
}

TEST(only_what_can_be_read_again_may_stand_in_a_table) {
  abbe_material m = glass("glass");
  m.source = (char[]){"a paper"};
  OK(abbe_material_check(&m, &error));
  const struct {
    abbe_material m;
    const char *part;
  } wrong[] = {
      {{.name = m.name, .source = NULL, .dispersion = m.dispersion, .min_nm = 400, .max_nm = 700},
       "names no source"},
      {{.name = (char[]){" x"}, .source = m.source, .dispersion = m.dispersion}, "is not a name"},
      {{.name = NULL, .source = m.source}, "is not a name"},
      {FIELDS(.name = m.name, .source = m.source, .dispersion = m.dispersion, .min_nm = 700,
              .max_nm = 400),
       "does not ascend"},
      {FIELDS(.name = m.name, .source = m.source, .dispersion = m.dispersion, .min_nm = 0.5,
              .max_nm = 400),
       "does not ascend"},
      {FIELDS(.name = m.name, .source = m.source, .min_nm = 400, .max_nm = 700,
              .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {-1}}),
       "no real index at 400 nm"},
      {FIELDS(.name = m.name, .source = m.source, .min_nm = 400, .max_nm = 700,
              .dispersion = {.model = ABBE_DISPERSION_SELLMEIER, .count = 2}),
       "odd number"},
  };
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, wrong[i].part, abbe_material_check(&wrong[i].m, &error));
  }
}

/* k of 0.0796 is a wavelength to 1/e. */
TEST(metals_are_opaque) {
  static const struct {
    double k[4]; /* at 380, 580, 581 and 780 nm */
    bool opaque;
  } rows[] = {{{1.7, 2.9, 2.9, 4.9}, true},
              {{0.081, 0.081, 0.081, 0.081}, true},
              {{0.078, 0.078, 0.078, 0.078}, false},
              {{2, 0.2, 0, 0}, true},
              {{2, 0, 0, 0}, false},
              {{1e-6, 1e-6, 1e-6, 1e-6}, false}};
  static const double nm[4] = {380, 580, 581, 780};
  OWNED(abbe_material, m) = glass(NULL);
  assert_false(abbe_material_is_opaque(&m, 380, 780));
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    double a[4];
    for (int k = 0; k < 4; k++) a[k] = abbe_absorption_from_k(rows[i].k[k], nm[k]);
    OK(abbe_spectrum_make(nm, a, 4, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
    assert_int_equal(abbe_material_is_opaque(&m, 380, 780), rows[i].opaque);
    abbe_spectrum_free(m.attenuation);
    m.attenuation = NULL;
  }
}
