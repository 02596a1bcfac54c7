#include "tests/check.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/dispersion/conditions.h"
#include "spectral/materials/material_numbers.h"

#include <math.h>

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
