#include "tests/check.h"

#include "spectral/dispersion/dispersion.h"
#include "spectral/materials/material_query.h"
#include "tests/spectral/shipped_table.h"

#include <math.h>

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

GROUP(shipped_load, shipped_free);

static double index_at(const char *name, double nm, double temperature_c, double pressure_atm,
                       bool absolute) {
  abbe_material m = *shipped_material(name); /* what it points to stays the table's */
  double n = 0;
  const abbe_conditions at = {temperature_c, pressure_atm};
  OK(abbe_material_place(&m, &at, &error));
  if (absolute)
    OK(abbe_material_n_absolute(&m, nm, &n, &error));
  else
    OK(abbe_material_n(&m, nm, &n, &error));
  return n;
}

/* As Ansys prints it, and by the formula's own numbers at 15 C. */
TEST(air_has_its_published_index) {
  assert_near(abbe_air_n(550, 20, 1), 1.00027308, 5e-9);
  assert_near(abbe_air_n(550, 20, 0), 1, 0);
  assert_near(abbe_air_n(550, 20, 0.5) - 1, 0.00027308 / 2, 5e-9);
}

/* Schott's data sheet of N-BK7, in 1e-6/K, to its printed digits: 1060 nm, e, g; relative, then
 * absolute. */
TEST(mean_temperature_coefficients_are_those_of_the_data_sheet) {
  const double nm[3] = {1060, ABBE_LINE_E_NM, ABBE_LINE_SMALL_G_NM};
  const struct {
    double from_c, relative[3], absolute[3];
  } row[] = {{-40, {2.4, 2.9, 3.3}, {0.3, 0.8, 1.2}},
             {20, {2.4, 3.0, 3.5}, {1.1, 1.6, 2.1}},
             {60, {2.5, 3.1, 3.7}, {1.5, 2.1, 2.7}}};
  for (size_t i = 0; i < 3; i++)
    for (size_t k = 0; k < 6; k++) {
      const bool absolute = k > 2;
      const double gained = index_at("n-bk7", nm[k % 3], row[i].from_c + 20, 1, absolute) -
                            index_at("n-bk7", nm[k % 3], row[i].from_c, 1, absolute);
      const double printed = (absolute ? row[i].absolute : row[i].relative)[k % 3];
      assert_near(round(gained / 20 * 1e7) / 10, printed, 1e-9);
    }
}

TEST(index_at_temperature_and_pressure_is_the_models) {
  const struct {
    double nm, temperature_c, pressure_atm, relative, absolute;
  } row[] = {{587.5618, 20, 1, 1.5168000, 1.5172132},  {587.5618, 40, 1, 1.5168567, 1.5172435},
             {587.5618, -40, 1, 1.5166348, 1.5171546}, {587.5618, 80, 1, 1.5169756, 1.5173185},
             {435.8343, 40, 1, 1.5267542, 1.5271490},  {656.2725, 0, 1, 1.5142696, 1.5147109},
             {587.5618, 20, 0, 1.5172132, 1.5172132},  {587.5618, 20, 0.5, 1.5170066, 1.5172132}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    assert_near(index_at("n-bk7", row[i].nm, row[i].temperature_c, row[i].pressure_atm, false),
                row[i].relative, 5e-8);
    assert_near(index_at("n-bk7", row[i].nm, row[i].temperature_c, row[i].pressure_atm, true),
                row[i].absolute, 5e-8);
  }
}

TEST(pressure_alone_needs_no_coefficients) {
  double n = 0;
  OK(abbe_material_n(shipped_material("diamond"), 550, &n, &error));
  assert_near(index_at("diamond", 550, NAN, 0, false), n * abbe_air_n(550, 20, 1), 1e-12);
  assert_near(index_at("air", 550, 80, 0, false), 1, 0);
  assert_near(index_at("air", 550, NAN, 0, true), 1, 0);
  assert_near(index_at("n-bk7", 550, 20, 1, false), index_at("n-bk7", 550, NAN, NAN, false), 0);
}

/* Measurements below air's boiling point are in vacuum, and above 200 C in thin air. */
TEST(a_pressure_alone_is_for_records_of_any_temperature) {
  const double own_c[2] = {-269.15, 1000}, air[2] = {1, abbe_air_n(550, 1000, 1)};
  for (int i = 0; i < 2; i++) {
    abbe_material m = *shipped_material("diamond");
    double n[3];
    m.temperature_c = own_c[i];
    const abbe_conditions thin = {NAN, 0}, wrong = {own_c[i], NAN};
    OK(abbe_material_n(&m, 550, &n[0], &error));
    OK(abbe_material_n_absolute(&m, 550, &n[1], &error));
    assert_near(n[1], n[0] * air[i], 1e-12);
    OK(abbe_material_place(&m, &thin, &error));
    OK(abbe_material_n(&m, 550, &n[2], &error));
    assert_near(n[2], n[1], 1e-12);
    REFUSED(ABBE_INVALID_ARGUMENT, "no conditions", abbe_material_place(&m, &wrong, &error));
  }
  assert_near(abbe_air_n(550, 1000, 1) - 1, 0.000278 / (1 + 3.4785e-3 * 985), 1e-6);
}

/* Near the ends of what conditions reach the mean is over fewer than 20 degrees. */
TEST(dn_dt_is_known_as_far_as_conditions_reach) {
  const abbe_material *m = shipped_material("n-bk7");
  const double ends[2][2] = {{195, 189}, {-245, -239}};
  for (int i = 0; i < 2; i++) {
    double end[2], beside[2];
    abbe_material_dn_dt(m, ABBE_LINE_E_NM, ends[i][0], end);
    abbe_material_dn_dt(m, ABBE_LINE_E_NM, ends[i][1], beside);
    for (int k = 0; k < 2; k++) assert_near(end[k], beside[k], 0.5e-6);
    assert_true(end[1] != 0 && beside[1] != 0);
  }
  double beyond[2];
  abbe_material_dn_dt(m, ABBE_LINE_E_NM, 220, beyond);
  assert_true(isnan(beyond[0]) && isnan(beyond[1]));
}

TEST(what_no_source_gives_is_refused_and_not_taken_for_0) {
  const struct {
    const char *name, *words;
    double negative, temperature_c;
  } refused[] = {{"water", "gives no dn/dT", 0, 40},
                 {"zircon", "does not say at what temperature", 0, 20},
                 {"gold", "is a conductor", 0, 20},
                 {"n-bk7", "lambda_tk is negative", -0.17, 40},
                 {"water", "no conditions", 0, 293}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    abbe_material m = *shipped_material(refused[i].name);
    const abbe_conditions at = {refused[i].temperature_c, NAN};
    m.catalogue.thermal[5] = refused[i].negative;
    abbe_error error;
    assert_int_not_equal(abbe_material_place(&m, &at, &error), ABBE_OK);
    assert_contains(error.text, refused[i].words);
    assert_false(m.dispersion.shift.on);
  }
  abbe_material quartz = *shipped_material("calcite");
  quartz.temperature_c = 20;
  quartz.catalogue.thermal[0] = 1e-6;
  const abbe_conditions warm = {40, NAN}, vacuum = {NAN, 0};
  REFUSED(ABBE_UNSUPPORTED, "several indices", abbe_material_place(&quartz, &warm, &error));
  OK(abbe_material_place(&quartz, &vacuum, &error));
  double n[2];
  OK(abbe_material_n_extraordinary(&quartz, 550, &n[0], &error));
  OK(abbe_material_n_extraordinary(shipped_material("calcite"), 550, &n[1], &error));
  assert_near(n[0], n[1] * abbe_air_n(550, 20, 1), 1e-12);
}
