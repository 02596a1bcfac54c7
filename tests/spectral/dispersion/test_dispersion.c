#include "tests/check.h"

#include "spectral/dispersion/dispersion.h"

static const abbe_dispersion bk7 = {
    .model = ABBE_DISPERSION_SELLMEIER2,
    .count = 7,
    .c = {0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}};

static double n_of(abbe_dispersion_model model, const double *c, size_t count, double lambda_nm) {
  abbe_dispersion d = {.model = model, .count = count};
  memcpy(d.c, c, count * sizeof *c);
  OK(abbe_dispersion_check(&d, &error));
  return abbe_dispersion_n(&d, lambda_nm);
}
#define N_OF(model, lambda_nm, ...)                                                                \
  n_of(model, (double[]){__VA_ARGS__}, sizeof((double[]){__VA_ARGS__}) / sizeof(double), lambda_nm)

/* Published indices, one model each. */
TEST(every_model_gives_its_published_index) {
  assert_near(N_OF(ABBE_DISPERSION_CONSTANT, 587.5618, 1.5), 1.5, 0);
  assert_near(N_OF(ABBE_DISPERSION_CAUCHY, 500, 1.5, 0.004, 0.0001), 1.5 + 0.016 + 0.0016, 1e-15);
  /* fused silica [Malitson1965]: 1.45846 at d */
  assert_near(N_OF(ABBE_DISPERSION_SELLMEIER, 587.5618, 0, 0.6961663, 0.0684043, 0.4079426,
                   0.1162414, 0.8974794, 9.896161),
              1.45846, 5e-6);
  assert_near(abbe_dispersion_n(&bk7, 587.5618), 1.51680, 5e-6);
  assert_near(abbe_dispersion_n(&bk7, 1060), 1.50669, 5e-6); /* Schott's data sheet */
  /* Hikari K5: 1.522490 */
  assert_near(N_OF(ABBE_DISPERSION_POLYNOMIAL, 587.5618, 2.259379, 0.009090504, 2, 0.02633942, -2,
                   -0.003777418, -4, 0.0005228702, -6, -2.629182e-05, -8),
              1.522490, 5e-7);
  /* moissanite [Wang2013] and rutile [DeVore1951], ordinary rays */
  assert_near(
      N_OF(ABBE_DISPERSION_RII4, 587.5618, 6.57232, 0.1401, 0, 0.03178, 1, 0, 0, 0, 1, -0.02153, 2),
      2.647990, 5e-7);
  assert_near(N_OF(ABBE_DISPERSION_RII4, 587.5618, 5.913, 0.2441, 0, 0.0803, 1, 0, 0, 0, 1),
              2.614265, 5e-7);
}

/* Other people's numbers: catalogue n_d of BASF5 (Conrady), silver bromide measured
 * at the D line (2.253), standard air, silicon at 5 um, urea at 1064 nm (1.59). */
TEST(rarer_formulas_give_their_published_index) {
  assert_near(N_OF(ABBE_DISPERSION_POWERS, ABBE_LINE_D_NM, 1.57410327, 0.0139786149, -1,
                   8.3004511e-4, -3.5),
              1.603233, 5e-7);
  assert_near(N_OF(ABBE_DISPERSION_RII8, 589.3, 0.452505, 0.09939, 0.070537, -0.00015), 2.253,
              5e-3);
  assert_near(N_OF(ABBE_DISPERSION_RII6, 589.3, 0, 0.05792105, 238.0185, 0.00167917, 57.362),
              1.000277, 5e-7);
  assert_near(N_OF(ABBE_DISPERSION_HERZBERGER, 5000, 3.41983, 0.159906, -0.123109, 1.26878e-6,
                   -1.95104e-9, 0),
              3.4261, 5e-5);
  assert_near(N_OF(ABBE_DISPERSION_RII9, 1064, 2.51527, 0.0240, 0.0300, 0.0202, 1.52, 0.8771), 1.59,
              1e-2);
}

TEST(shorter_forms_drop_their_terms) {
  assert_near(N_OF(ABBE_DISPERSION_CAUCHY, 500, 1.5), 1.5, 0);
  assert_near(N_OF(ABBE_DISPERSION_SELLMEIER, 500, 1.25), 1.5, 1e-15);
  assert_near(N_OF(ABBE_DISPERSION_POLYNOMIAL, 500, 2.25), 1.5, 1e-15);
  assert_near(N_OF(ABBE_DISPERSION_RII4, 500, 2.25), 1.5, 1e-15);
  assert_near(N_OF(ABBE_DISPERSION_RII4, 500, 2, 0.01, 2, 0, 1), sqrt(2.01), 1e-15);
}

TEST(tabulated_indices_are_interpolated) {
  abbe_dispersion d = {.model = ABBE_DISPERSION_TABULATED};
  OK(abbe_spectrum_make((double[]){400, 600}, (double[]){1.6, 1.5}, 2, ABBE_INTERPOLATION_LINEAR,
                        &d.table, &error));
  OK(abbe_dispersion_check(&d, &error));
  assert_near(abbe_dispersion_n(&d, 500), 1.55, 1e-15);
  assert_near(abbe_dispersion_n(&d, 300), 1.6, 1e-15);
  abbe_dispersion_free(&d);
  assert_null(d.table);
  abbe_dispersion_free(&d);
  d.model = ABBE_DISPERSION_TABULATED;
  assert_true(isnan(abbe_dispersion_n(&d, 500)));
  assert_int_equal(abbe_dispersion_check(&d, NULL), ABBE_INVALID_ARGUMENT);
}

TEST(no_real_index_is_nan) {
  assert_true(isnan(abbe_dispersion_n(&bk7, 0)));
  assert_true(isnan(abbe_dispersion_n(&bk7, -500)));
  assert_true(isnan(abbe_dispersion_n(&bk7, NAN)));
  assert_true(isnan(abbe_dispersion_n(&bk7, INFINITY)));
  assert_true(isnan(N_OF(ABBE_DISPERSION_SELLMEIER, 500, 0, 1, 0.5))); /* on the pole */
  assert_true(isnan(N_OF(ABBE_DISPERSION_SELLMEIER, 499, 0, 1, 0.5))); /* n^2 < 0 below it */
  assert_true(isnan(N_OF(ABBE_DISPERSION_CAUCHY, 500, -1)));
  assert_true(isnan(N_OF(ABBE_DISPERSION_CONSTANT, 500, 0)));
  assert_true(isnan(N_OF(ABBE_DISPERSION_POLYNOMIAL, 500, 1, 1e300, 1e3)) == 0);
  assert_true(isnan(N_OF(ABBE_DISPERSION_POLYNOMIAL, 5e5, 1, 1e300, 1e3))); /* overflow */
  abbe_dispersion none = {.model = ABBE_DISPERSION_MODEL_COUNT};
  assert_true(isnan(abbe_dispersion_n(&none, 500)));
}

/* Schott's data sheets. */
TEST(fraunhofer_numbers_are_the_catalogues) {
  abbe_dispersion_numbers d = abbe_dispersion_describe(&bk7);
  assert_near(d.n_d, 1.51680, 5e-6);
  assert_near(d.n_F, 1.52238, 5e-6);
  assert_near(d.n_C, 1.51432, 5e-6);
  assert_near(d.v_d, 64.17, 5e-3);
  /* the gem trade gives diamond 0.044 */
  const abbe_dispersion diamond = {
      .model = ABBE_DISPERSION_SELLMEIER, .count = 5, .c = {0, 0.3306, 0.175, 4.3356, 0.106}};
  d = abbe_dispersion_describe(&diamond);
  assert_near(d.b_g, 0.044, 5e-4);
  assert_near(d.n_d, 2.417, 6e-4);
  const abbe_dispersion flat = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}};
  d = abbe_dispersion_describe(&flat);
  assert_true(isinf(d.v_d) && d.v_d > 0);
  assert_near(d.b_g, 0, 0);
}

TEST(models_have_names_and_formulas) {
  assert_string_equal(abbe_dispersion_model_name(ABBE_DISPERSION_SELLMEIER2), "sellmeier2");
  assert_string_equal(abbe_dispersion_model_formula(ABBE_DISPERSION_CONSTANT), "n = c0");
  assert_string_equal(abbe_dispersion_model_name((abbe_dispersion_model)99), "unknown");
  assert_string_equal(abbe_dispersion_model_formula((abbe_dispersion_model)-1), "unknown");
}

static void refuses(abbe_dispersion_model model, size_t count, const char *part) {
  abbe_dispersion d = {.model = model, .count = count};
  REFUSED(ABBE_INVALID_ARGUMENT, part, abbe_dispersion_check(&d, &error));
}

TEST(wrong_coefficients_are_refused) {
  refuses(ABBE_DISPERSION_CONSTANT, 2, "the model constant wants 1");
  refuses(ABBE_DISPERSION_CAUCHY, 0, "1 or more");
  refuses(ABBE_DISPERSION_SELLMEIER, 6, "odd");
  refuses(ABBE_DISPERSION_SELLMEIER2, 0, "odd");
  refuses(ABBE_DISPERSION_POLYNOMIAL, 2, "odd");
  refuses(ABBE_DISPERSION_RII4, 7, "1, 5, 9");
  refuses(ABBE_DISPERSION_RII4, 10, "1, 5, 9");
  refuses(ABBE_DISPERSION_TABULATED, 1, "none");
  refuses(ABBE_DISPERSION_CONDUCTOR, 1, "none");
  refuses(ABBE_DISPERSION_CONDUCTOR, 0, "points of n and of k");
  refuses(ABBE_DISPERSION_CAUCHY, ABBE_DISPERSION_MAX_COEFFICIENTS + 1, "at most 32");
  refuses((abbe_dispersion_model)77, 1, "77");
  abbe_dispersion d = bk7;
  d.c[3] = NAN;
  assert_int_equal(abbe_dispersion_check(&d, NULL), ABBE_INVALID_ARGUMENT);
}
