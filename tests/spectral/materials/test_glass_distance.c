#include "tests/check.h"
#include "tests/random.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/dispersion/index_points.h"
#include "spectral/materials/partners.h"

static const char *name_of(const abbe_glass_distances *d, size_t i) {
  return shipped.material[d->nearest[i].index].name;
}

GROUP(shipped_load, shipped_free);

TEST(numbers_find_their_own_glass) {
  for (size_t i = 0; i < shipped.count; i++) {
    abbe_dispersion_numbers own = abbe_dispersion_describe(&shipped.material[i].dispersion);
    if (!(own.n_d > 1)) continue; /* air, metals */
    MADE(abbe_glass_distances, d,
         abbe_glass_distance_to_numbers(&shipped, own.n_d, own.v_d, 3, &d, &error));
    assert_int_equal(d.count, 3);
    const abbe_dispersion_numbers first =
        abbe_dispersion_describe(&shipped.material[d.nearest[0].index].dispersion);
    assert_true(d.nearest[0].index <= i); /* its own, or a stone's whose colour it varies */
    assert_true(first.n_d == own.n_d && first.v_d == own.v_d);
    assert_true(d.nearest[0].rms < 1e-9);
    assert_near(d.nearest[0].n_d, own.n_d, 0);
    for (size_t k = 1; k < d.count; k++) assert_true(d.nearest[k].rms >= d.nearest[k - 1].rms);
    abbe_glass_distances_free(&d);
  }
}

/* The distance is that of two Cauchy curves written out. */
TEST(the_distance_is_a_difference_of_index) {
  abbe_dispersion bk7 = shipped.material[1].dispersion, pair[2];
  abbe_dispersion_numbers own = abbe_dispersion_describe(&bk7);
  const double n_d[] = {1.52, own.n_d}, v_d[] = {60, own.v_d};
  for (int i = 0; i < 2; i++) {
    double x_d = 1e6 / (ABBE_LINE_D_NM * ABBE_LINE_D_NM);
    double unit = 1e6 / (ABBE_LINE_F_NM * ABBE_LINE_F_NM) - 1e6 / (ABBE_LINE_C_NM * ABBE_LINE_C_NM);
    double B = (n_d[i] - 1) / v_d[i] / unit;
    pair[i] =
        (abbe_dispersion){.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {n_d[i] - B * x_d, B}};
  }
  abbe_index_difference direct;
  OK(abbe_index_difference_of_curves(&pair[0], &pair[1], 380, 780, &direct, &error));
  MADE(abbe_glass_distances, d, abbe_glass_distance_to_numbers(&shipped, 1.52, 60, 0, &d, &error));
  assert_int_equal(d.count + d.skipped, shipped_glasses());
  for (size_t i = 0; i < d.count; i++)
    if (d.nearest[i].index == 1) assert_near(d.nearest[i].rms, direct.rms, 1e-9);
}

/* SF11 and N-SF11 have the same n_d; the curve tells them apart, and so do a few exact points. */
TEST(curves_and_points_find_their_own_glass) {
  const char *const names[] = {"sf11", "n-sf11", "n-bk7", "cubic-zirconia"};
  for (int i = 0; i < 4; i++) {
    const abbe_material *m = NULL;
    OK(abbe_material_table_find(&shipped, names[i], &m, &error));
    MADE(abbe_glass_distances, d,
         abbe_glass_distance_to_curve(&shipped, &m->dispersion, 400, 700, 2, &d, &error));
    assert_string_equal(name_of(&d, 0), names[i]);
    assert_near(d.nearest[0].max, 0, 0);
    assert_true(d.nearest[1].rms > 1e-6);
    assert_true(d.nearest[1].max >= d.nearest[1].rms);
    abbe_glass_distances_free(&d);

    double lambda_nm[] = {435.8, 546.1, 656.3}, n[3];
    for (int k = 0; k < 3; k++)
      n[k] = round(abbe_dispersion_n(&m->dispersion, lambda_nm[k]) * 1e5) / 1e5;
    const abbe_index_points points = {.count = 3, .lambda_nm = lambda_nm, .n = n};
    OK(abbe_glass_distance_to_points(&shipped, &points, 1, &d, &error));
    assert_string_equal(name_of(&d, 0), names[i]);
    assert_true(d.nearest[0].rms < 5.1e-6);
  }
}

TEST(materials_without_data_there_are_skipped) {
  /* beyond 1129 nm water has no data and does not extrapolate */
  MADE(abbe_glass_distances, d,
       abbe_glass_distance_to_curve(&shipped, &shipped.material[1].dispersion, 500, 2000, 0, &d,
                                    &error));
  assert_true(d.skipped > 0);
  assert_int_equal(d.count + d.skipped, shipped_glasses());
  for (size_t i = 0; i < d.count; i++) assert_string_not_equal(name_of(&d, i), "water");
  abbe_glass_distances_free(&d);
  const abbe_material_table empty = {0};
  OK(abbe_glass_distance_to_numbers(&empty, 1.5, 60, 0, &d, &error));
  assert_int_equal(d.count, 0);
}

TEST(what_is_no_glass_is_refused) {
  const double cases[][2] = {{1, 60},   {0.5, 60},  {NAN, 60},     {1.5, 0},
                             {1.5, -3}, {1.5, NAN}, {INFINITY, 60}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    abbe_glass_distances d;
    REFUSED(ABBE_INVALID_ARGUMENT, "such as 1.5168 and 64.17",
            abbe_glass_distance_to_numbers(&shipped, cases[i][0], cases[i][1], 0, &d, &error));
    assert_null(d.nearest);
  }
  abbe_glass_distances d;
  const abbe_index_points none = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_glass_distance_to_points(&shipped, &none, 0, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_glass_distance_to_curve(&shipped, &shipped.material[0].dispersion, 780, 380, 0, &d,
                                       &error));
  assert_null(d.nearest);
}
