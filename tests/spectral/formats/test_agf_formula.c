#include "tests/check.h"

#include "spectral/formats/agf_formula.h"

/* n_d as real catalogues print it beside the coefficients; what no catalogue prints is evaluated by
 * hand from the formula as Zemax's manual has it. */
TEST(every_formula_gives_its_catalogues_index) {
  const struct {
    abbe_agf_formula f;
    double lambda_nm, n, within;
  } rows[] = {
      /* acrylic and zinc-crown of a catalogue of the first formula */
      {{1, {2.16330492, 1.36580764e-2, 2.56700975e-2, -2.80976174e-3, 2.842279e-4, -9.02124935e-6}},
       587.5618,
       1.491668,
       5e-7},
      {{1,
        {2.29204125, -9.69577254e-3, 9.93599131e-3, 1.29959077e-3, -1.70602096e-4, 1.01977907e-5}},
       587.5618,
       1.524779,
       5e-7},
      {{2, {1.03961212, 6.00069867e-3, 0.231792344, 2.00179144e-2, 1.01046945, 103.560653}},
       587.5618,
       1.5168,
       5e-6},
      {{2, {0.5675888, 2.52643e-3, 0.4710914, 1.0078333e-2, 3.8484723, 1200.556}},
       587.5618,
       1.433849,
       5e-7},
      {{3, {3.41983, 0.159906, -0.123109, 1.26878e-6, -1.95104e-9, 0}}, 5000, 3.4261, 5e-5},
      {{4, {1, 1.2, 0.1, 0.02, 0.2}},
       500, /* 1 + 1 + 1.2/0.96 + 0.02/0.21 */
       1.8289992,
       5e-7},
      {{5, {1.57410327, 1.39786149e-2, 8.3004511e-4}}, 587.5618, 1.603233, 5e-7},
      {{6,
        {1.03961212, 6.00069867e-3, 0.231792344, 2.00179144e-2, 1.01046945, 103.560653, 0.25, 0}},
       587.5618,
       1.5970856,
       5e-7}, /* sqrt(1.5168000^2 + 0.25) */
      {{7, {2.7405, 1.84e-2, 1.79e-2, 1.55e-2}}, 587.5618, 1.670737, 5e-7},
      {{8, {2, 0.5, 0.01, 0.02}}, 500, /* 2 + 0.5*0.25/0.24 - 0.005 */ 1.5861379, 5e-7},
      {{9, {3.1399, 1.3786, 2.941e-2, 3.861, 225.9009}}, 587.5618, 2.154291, 5e-7},
      {{10, {2, 0, 0, 0, 0, 0, 1e-4, 1e-5}}, 500, /* 2 + 0.1024 + 0.04096 */ 1.4640219, 5e-7},
      {{11,
        {1.03961212, 6.00069867e-3, 0.231792344, 2.00179144e-2, 0.5, 103.560653, 0.5, 103.560653,
         0.01046945, 103.560653}},
       587.5618,
       1.5168,
       5e-6},
      {{12, {2, 0, 0, 0, 0, 0, 0.16, 0.64}}, 500, /* 2 + 0.01 + 0.01 */ 1.4212670, 5e-7},
      {{13,
        {2.18826855, -9.19044724e-3, -1.11621071e-4, 9.26372815e-3, 7.34900733e-5, 4.19724242e-6,
         -1.15412203e-7}},
       587.5618,
       1.48749,
       5e-7},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_dispersion d;
    assert_int_equal(abbe_agf_formula_read(&rows[i].f, &d, NULL), ABBE_OK);
    assert_int_equal(abbe_dispersion_check(&d, NULL), ABBE_OK);
    assert_near(abbe_dispersion_n(&d, rows[i].lambda_nm), rows[i].n, rows[i].within);
    /* and back, to the same n */
    abbe_agf_formula again;
    abbe_agf_fidelity fidelity;
    double error = 1;
    abbe_dispersion twice;
    assert_int_equal(abbe_agf_formula_write(&d, 400, 700, &again, &fidelity, &error, NULL),
                     ABBE_OK);
    assert_int_not_equal(fidelity, ABBE_AGF_FITTED);
    assert_int_equal(abbe_agf_formula_read(&again, &twice, NULL), ABBE_OK);
    assert_near(abbe_dispersion_n(&twice, rows[i].lambda_nm),
                abbe_dispersion_n(&d, rows[i].lambda_nm), 1e-15);
    assert_near(error, 0, 0);
    assert_non_null(abbe_agf_formula_name(rows[i].f.number));
  }
}

static double uniform(double low, double high) {
  return low + (high - low) * rand() / RAND_MAX;
}

/* Random coefficients of every formula come back as the same formula with the same coefficients,
 * and where they were given zeros, as one that computes the same. */
TEST(formulas_survive_a_round_trip) {
  static const int used[] = {0, 6, 6, 6, 5, 3, 8, 4, 4, 5, 8, 10, 8, 9};
  srand(7);
  for (int i = 0; i < 2600; i++) {
    abbe_agf_formula f = {.number = 1 + i % 13}, back;
    for (int k = 0; k < used[f.number]; k++) f.c[k] = uniform(0.1, 2);
    abbe_dispersion d, twice;
    abbe_agf_fidelity fidelity;
    double error;
    assert_int_equal(abbe_agf_formula_read(&f, &d, NULL), ABBE_OK);
    assert_int_equal(abbe_agf_formula_write(&d, 400, 700, &back, &fidelity, &error, NULL), ABBE_OK);
    assert_int_equal(back.number, f.number);
    for (int k = 0; k < ABBE_AGF_COEFFICIENTS; k++) assert_near(back.c[k], f.c[k], 1e-14);
    assert_int_equal(abbe_agf_formula_read(&back, &twice, NULL), ABBE_OK);
    double n = abbe_dispersion_n(&d, 550), m = abbe_dispersion_n(&twice, 550);
    assert_true((isnan(n) && isnan(m)) || fabs(n - m) < 1e-12 * n);
  }
}

/* Cauchy forms are squared, squared poles are multiplied out, a constant term is a pole at 0. */
TEST(other_forms_keep_their_index) {
  const abbe_dispersion forms[] = {
      {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {1.5}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5046, 0.0042}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 3, .c = {1.5040873, 0.0044473, -2.7078e-5}},
      {.model = ABBE_DISPERSION_CAUCHY, .count = 4, .c = {1.5, 0.004, 1e-5, -1e-6}},
      {.model = ABBE_DISPERSION_SELLMEIER, .count = 5, .c = {0, 0.3306, 0.175, 4.3356, 0.106}},
      {.model = ABBE_DISPERSION_SELLMEIER2,
       .count = 5,
       .c = {0.28604141, 1.07044083, 0.0100585997, 1.10202242, 100}},
      {.model = ABBE_DISPERSION_RII4, .count = 9, .c = {5.913, 0.2441, 0, 0.0803, 1, 0, 0, 0, 1}},
  };
  for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
    abbe_agf_formula f;
    abbe_agf_fidelity fidelity;
    abbe_dispersion d;
    double error;
    assert_int_equal(abbe_agf_formula_write(&forms[i], 400, 700, &f, &fidelity, &error, NULL),
                     ABBE_OK);
    assert_int_not_equal(fidelity, ABBE_AGF_FITTED);
    assert_int_equal(abbe_agf_formula_read(&f, &d, NULL), ABBE_OK);
    for (double l = 380; l < 780; l += 7)
      assert_near(abbe_dispersion_n(&d, l), abbe_dispersion_n(&forms[i], l), 1e-14);
  }
}

/* The error that is stated is the error that is made. */
TEST(what_has_no_formula_is_fitted_with_its_error) {
  const abbe_dispersion moissanite = {
      .model = ABBE_DISPERSION_RII4,
      .count = 11,
      .c = {6.57232, 0.1401, 0, 0.03178, 1, 0.01, 2, 0.2, 1, -0.02153, 2}};
  abbe_agf_formula f;
  abbe_agf_fidelity fidelity;
  abbe_dispersion d;
  double error = 0, worst = 0;
  assert_int_equal(abbe_agf_formula_write(&moissanite, 500, 700, &f, &fidelity, &error, NULL),
                   ABBE_OK);
  assert_int_equal(fidelity, ABBE_AGF_FITTED);
  assert_int_equal(f.number, 10);
  assert_int_equal(abbe_agf_formula_read(&f, &d, NULL), ABBE_OK);
  for (double l = 500; l <= 700; l += 1)
    worst = fmax(worst, fabs(abbe_dispersion_n(&d, l) - abbe_dispersion_n(&moissanite, l)));
  assert_near(worst, error, 1e-12);
  assert_true(error > 0 && error < 1e-3);
  assert_int_equal(abbe_agf_formula_write(&moissanite, 700, 500, &f, &fidelity, &error, NULL),
                   ABBE_INVALID_ARGUMENT);
}

TEST(wrong_formulas_are_named) {
  abbe_dispersion d;
  const abbe_agf_formula none = {14, {1}}, zero = {2, {0}}, infinite = {1, {1, INFINITY}};
  REFUSED(ABBE_INVALID_ARGUMENT, "no formula 14; a catalogue's are 1 to 13",
          abbe_agf_formula_read(&none, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "are 0", abbe_agf_formula_read(&zero, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "coefficient 1 is inf",
          abbe_agf_formula_read(&infinite, &d, &error));
  assert_null(abbe_agf_formula_name(0));
  assert_string_equal(abbe_agf_formula_name(13), "Extended 3");
}
