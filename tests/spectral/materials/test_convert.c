#include "tests/check.h"
#include "tests/random.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/dispersion/index_points.h"
#include "spectral/materials/convert.h"

static abbe_dispersion made(abbe_given given, abbe_fit_form form) {
  abbe_dispersion d;
  OK(abbe_convert_make(&given, form, &d, &error));
  OK(abbe_dispersion_check(&d, &error));
  return d;
}

GROUP(shipped_load, shipped_free);

/* Whatever the numbers, both forms have exactly them. */
TEST(both_forms_have_the_numbers_given) {
  uint64_t random = 1;
  for (int i = 0; i < 300; i++) {
    abbe_fit_form form = i % 2 ? ABBE_FIT_SELLMEIER : ABBE_FIT_CAUCHY;
    double n_d = random_between(&random, 1.2, 2.8), v_d = random_between(&random, 15, 100);
    abbe_dispersion d = made((abbe_given){.kind = ABBE_GIVEN_ND_VD, n_d, v_d}, form);
    abbe_dispersion_numbers numbers = abbe_dispersion_describe(&d);
    assert_near(numbers.n_d, n_d, 1e-12);
    assert_near(numbers.v_d, v_d, 1e-8 * v_d);

    double gltf = 20 / v_d;
    abbe_dispersion same = made((abbe_given){.kind = ABBE_GIVEN_GLTF, n_d, gltf}, form);
    assert_near(same.c[1], d.c[1], 1e-9 * d.c[1]);

    double b_g = random_between(&random, 0.002, 0.3) * (n_d - 1);
    d = made((abbe_given){.kind = ABBE_GIVEN_ND_BG, n_d, b_g}, form);
    numbers = abbe_dispersion_describe(&d);
    assert_near(numbers.n_d, n_d, 1e-12);
    assert_near(numbers.b_g, b_g, 1e-10);

    double A = random_between(&random, 1.2, 2.5), B = random_between(&random, 0.001, 0.03);
    d = made((abbe_given){.kind = ABBE_GIVEN_A_B, A, B}, ABBE_FIT_CAUCHY);
    assert_near(d.c[0], A, 0);
    assert_near(d.c[1], B, 0);
    same = made((abbe_given){.kind = ABBE_GIVEN_A_B, A, B}, ABBE_FIT_SELLMEIER);
    numbers = abbe_dispersion_describe(&d);
    assert_near(abbe_dispersion_describe(&same).n_d, numbers.n_d, 1e-12);
    assert_near(abbe_dispersion_describe(&same).v_d, numbers.v_d, 1e-8 * numbers.v_d);
  }
}

/* The curve that glTF's extension prints, with its rounded constants. */
TEST(gltf_is_the_curve_of_its_extension) {
  abbe_dispersion d = made((abbe_given){.kind = ABBE_GIVEN_GLTF, 2.42, 0.36}, ABBE_FIT_CAUCHY);
  for (double l = 380; l <= 780; l += 50) {
    double printed = 2.42 + 1.42 / (20 / 0.36) * (523655 / (l * l) - 1.5168);
    assert_near(abbe_dispersion_n(&d, l), printed, 1e-5);
  }
  d = made((abbe_given){.kind = ABBE_GIVEN_GLTF, 1.5, 0}, ABBE_FIT_SELLMEIER);
  assert_near(abbe_dispersion_n(&d, 400), 1.5, 1e-12);
  assert_near(abbe_dispersion_n(&d, 700), 1.5, 1e-12);
}

/* What is told of the error is what the known glass itself shows, where it is the only one. */
TEST(the_error_is_that_of_known_glasses) {
  const abbe_material_table one = {.count = 1, .material = &shipped.material[1]};
  abbe_dispersion_numbers own = abbe_dispersion_describe(&one.material->dispersion);
  for (int form = 0; form < 2; form++) {
    abbe_given given = {.kind = ABBE_GIVEN_ND_VD, .first = own.n_d, .second = own.v_d};
    abbe_convert_error e;
    OK(abbe_convert_judge(&given, (abbe_fit_form)form, &one, 380, 780, &e, &error));
    abbe_dispersion d = made(given, (abbe_fit_form)form);
    abbe_index_difference direct;
    OK(abbe_index_difference_of_curves(&d, &one.material->dispersion, 380, 780, &direct, &error));
    assert_int_equal(e.compared, 1);
    assert_near(e.largest, direct.max, 1e-12);
    assert_near(e.typical, direct.rms, 1e-12);
    assert_near(e.at_nm, direct.max_nm, 0);
    assert_near(e.rounding, 0, 1e-12);
  }
}

/* For every shipped material, left out of the known ones, its true error is of the order told. */
TEST(the_error_told_is_near_the_true_one) {
  size_t covered = 0, tried = 0;
  for (size_t i = 0; i < shipped.count; i++) {
    const abbe_material *m = &shipped.material[i];
    if (abbe_material_extrapolates(m, 380) || abbe_material_extrapolates(m, 780)) continue;
    abbe_material others[256];
    size_t count = 0;
    assert_in_range(shipped.count, 1, 256);
    for (size_t k = 0; k < shipped.count; k++)
      if (k != i) others[count++] = shipped.material[k];
    const abbe_material_table rest = {.count = count, .material = others};
    abbe_dispersion_numbers own = abbe_dispersion_describe(&m->dispersion);
    if (!isfinite(own.v_d)) continue; /* air */
    abbe_given given = {.kind = ABBE_GIVEN_ND_VD, .first = own.n_d, .second = own.v_d};
    abbe_convert_error e;
    OK(abbe_convert_judge(&given, ABBE_FIT_CAUCHY, &rest, 380, 780, &e, &error));
    assert_int_equal(e.compared, ABBE_CONVERT_COMPARED);
    abbe_dispersion d = made(given, ABBE_FIT_CAUCHY);
    abbe_index_difference direct;
    OK(abbe_index_difference_of_curves(&d, &m->dispersion, 380, 780, &direct, &error));
    assert_true(direct.max < 5 * e.largest);
    covered += direct.max <= e.largest;
    tried++;
  }
  assert_true(tried >= 10);
  assert_true(2 * covered > tried); /* most lie within what was told */
}

/* Half a last digit of n_d moves the whole curve by as much, and more where V_d is coarse. */
TEST(digits_left_open_move_the_curve) {
  abbe_given given = {ABBE_GIVEN_ND_VD, 1.5168, 64.17, 5e-5, 0};
  abbe_convert_error e;
  OK(abbe_convert_judge(&given, ABBE_FIT_CAUCHY, &shipped, 380, 780, &e, &error));
  assert_near(e.rounding, 5e-5 * (1 + 2.11 / 64.17), 1e-7);
  given.second_half = 5;
  OK(abbe_convert_judge(&given, ABBE_FIT_CAUCHY, &shipped, 380, 780, &e, &error));
  /* (n_d - 1) (1 / 59.17 - 1 / 64.17) times the Cauchy shape at 380 nm, 2.11 */
  assert_near(e.rounding, 0.5168 * (1 / 59.17 - 1 / 64.17) * 2.11 + 5e-5, 3e-5);
}

TEST(nothing_known_leaves_the_error_open) {
  const abbe_material_table none = {0};
  abbe_given given = {.kind = ABBE_GIVEN_ND_BG, .first = 2.417, .second = 0.044};
  abbe_convert_error e;
  OK(abbe_convert_judge(&given, ABBE_FIT_CAUCHY, &none, 380, 780, &e, &error));
  assert_int_equal(e.compared, 0);
  assert_true(isnan(e.largest) && isnan(e.typical));
}

TEST(impossible_numbers_are_refused) {
  const struct {
    abbe_given given;
    int form;
    const char *part;
  } cases[] = {
      {{.kind = ABBE_GIVEN_ND_VD, 1, 60}, 0, "n_d 1 is not an index"},
      {{.kind = ABBE_GIVEN_ND_VD, 64.17, 1.5168}, 0, "n_d 64.17 is not an index"},
      {{.kind = ABBE_GIVEN_ND_VD, 1.5, 1e-9}, 1, "no one-term Sellmeier form"},
      {{.kind = ABBE_GIVEN_ND_VD, NAN, 60}, 0, "n_d nan"},
      {{.kind = ABBE_GIVEN_ND_VD, 1.5, 0}, 0, "V_d 0 is not possible; it is above 0, such as 64"},
      {{.kind = ABBE_GIVEN_ND_VD, 1.5, INFINITY}, 0, "V_d inf"},
      {{.kind = ABBE_GIVEN_ND_BG, 2.4, -1}, 0, "B-G dispersion -1 is not possible"},
      {{.kind = ABBE_GIVEN_GLTF, 0.5, 0.3}, 0, "ior 0.5"},
      {{.kind = ABBE_GIVEN_GLTF, 1.5, -0.1}, 0, "dispersion -0.1 is not possible; it is at least"},
      {{.kind = ABBE_GIVEN_A_B, 0, 0.004}, 0, "A 0"},
      {{.kind = ABBE_GIVEN_A_B, 0.5, 0.004}, 1, "n_d would be 0.51"},
      {{.kind = (abbe_given_kind)9, 1.5, 60}, 0, "no conversion 9"},
      {{.kind = ABBE_GIVEN_ND_VD, 1.5, 60}, 7, "no form 7"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    abbe_dispersion d;
    abbe_convert_error e;
    abbe_fit_form form = (abbe_fit_form)cases[i].form;
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].part,
            abbe_convert_make(&cases[i].given, form, &d, &error));
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_convert_judge(&cases[i].given, form, &shipped, 380, 780, &e, &error));
  }
  abbe_given given = {.kind = ABBE_GIVEN_ND_VD, .first = 1.5, .second = 60};
  abbe_convert_error e;
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_convert_judge(&given, ABBE_FIT_CAUCHY, &shipped, 780, 380, &e, &error));
  assert_string_equal(abbe_given_first_name((abbe_given_kind)-1), "unknown");
  assert_string_equal(abbe_given_second_name(ABBE_GIVEN_ND_VD), "V_d");
}
