/* Stretches of light added up over cells: what one leaves, what leaves through shells, what a beam
 * alone leaves as the method was printed. */
#include "tests/check.h"
#include "tests/random.h"

#include "base/maths.h"
#include "validation/lab/volume_sums.h"

static void make_region(abbe_region_desc desc, abbe_volume_region *out) {
  OK(abbe_volume_region_make(&desc, out, &error));
}

/* Along x through a row of a grid: flux times length by the cell's volume, and by its space. */
TEST(one_stretch) {
  OWNED(abbe_volume_region, r);
  float space[64];
  make_region((abbe_region_desc){.kind = ABBE_REGION_GRID, .side = 4, .outer = 2}, &r);
  for (int i = 0; i < 64; i++) space[i] = i == 2 ? 0.5f : i == 3 ? 0.01f : 1;
  MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, false, space, NULL, 1, &s, &error));
  const double o[3] = {-1.25, -1.5, -1.5}, d[3] = {1, 0, 0};
  const float flux[3] = {1, 2, 3};
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i <= pass; i++) abbe_volume_sums_add(&s, 0, o, d, 3, flux);
    abbe_accumulator_end_pass(&s.sums);
  }
  /* once and twice: a mean of 1.5 with a standard error of 0.5 */
  static const double length[4] = {0.25, 1, 2, 0};
  for (size_t cell = 0; cell < 64; cell++)
    for (size_t c = 0; c < 9; c++) {
      const double one = cell < 4 && c % 3 == 0 ? length[cell] * (double)(c / 3 + 1) : 0;
      assert_near(abbe_volume_sums_mean(&s, cell, c), 1.5 * one, 1e-6);
      assert_near(abbe_volume_sums_error(&s, cell, c), 0.5 * one, 1e-6);
    }
  assert_near(abbe_volume_sums_relative_error(&s), 1.0 / 3, 1e-6);
}

/* Whatever starts within and goes out passes every shell: all have the same flux. */
TEST(every_shell_has_the_flux_that_leaves) {
  static const abbe_region_desc regions[] = {
      {.kind = ABBE_REGION_GEODESIC, .levels = 4, .shells = 6, .inner = 1, .outer = 3},
      {.kind = ABBE_REGION_OCTAHEDRAL, .side = 64, .shells = 6, .inner = 1, .outer = 3}};
  for (int i = 0; i < 2; i++) {
    uint64_t seed = 9;
    FILLED(abbe_volume_region, r, make_region(regions[i], &r));
    MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, false, NULL, NULL, 1, &s, &error));
    for (int n = 0; n < 40000; n++) {
      double o[3], d[3];
      const float flux[3] = {0, 0.25f, 0};
      random_unit(&seed, o);
      for (int k = 0; k < 3; k++) o[k] *= 0.9 * random_between(&seed, 0, 1);
      random_unit(&seed, d);
      abbe_volume_sums_add(&s, 0, o, d, INFINITY, flux);
    }
    abbe_accumulator_end_pass(&s.sums);
    /* radial parts are taken in the cells' middles */
    for (size_t shell = 0; shell < r.rows; shell++)
      assert_near(abbe_volume_sums_outflow(&s, shell) / 10000, 1, 0.003);
  }
}

/* Nothing ends or begins in a shell that light crosses both ways: what comes in goes out. */
TEST(what_comes_in_goes_out) {
  OWNED(abbe_volume_region, r);
  uint64_t seed = 10;
  make_region(
      (abbe_region_desc){
          .kind = ABBE_REGION_GEODESIC, .levels = 4, .shells = 4, .inner = 1, .outer = 3},
      &r);
  MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, false, NULL, NULL, 1, &s, &error));
  for (int n = 0; n < 40000; n++) {
    double o[3], d[3];
    const float flux[3] = {0, 0.25f, 0};
    random_unit(&seed, d);
    for (int k = 0; k < 3; k++) o[k] = random_between(&seed, -0.8, 0.8) - 5 * d[k];
    abbe_volume_sums_add(&s, 0, o, d, INFINITY, flux);
  }
  abbe_accumulator_end_pass(&s.sums);
  for (size_t shell = 0; shell < r.rows; shell++)
    assert_near(abbe_volume_sums_outflow(&s, shell) / 10000, 0, 0.003);
}

/* A beam with nothing in it brings every cell the cosine to where it lies, behind the middle. */
TEST(a_printed_beam) {
  enum { SIDE = 2000 };
  static const double d[3] = {0.48, 0.6, 0.64}, x[3] = {0.8, 0, -0.6}, y[3] = {-0.36, 0.8, -0.48};
  OWNED(abbe_volume_region, r);
  make_region((abbe_region_desc){.kind = ABBE_REGION_GRID, .side = 6, .outer = 3}, &r);
  MADE(abbe_volume_sums, s, abbe_volume_sums_make(&r, true, NULL, d, 1, &s, &error));
  const float each = (float)(144.0 / SIDE / SIDE), flux[3] = {each, each, 2 * each};
  for (int n = 0; n < SIDE * SIDE; n++) {
    const double u = ((n % SIDE + 0.5) / SIDE - 0.5) * 12, v = ((n / SIDE + 0.5) / SIDE - 0.5) * 12;
    double o[3];
    for (int k = 0; k < 3; k++) o[k] = u * x[k] + v * y[k] - 8 * d[k];
    abbe_volume_sums_add(&s, 0, o, d, INFINITY, flux);
  }
  abbe_accumulator_end_pass(&s.sums);
  for (size_t cell = 0; cell < r.cells; cell++) {
    double p[3];
    abbe_volume_region_middle(&r, cell, p);
    const double cosine = fmax(abbe_vector_dot(p, d) / abbe_vector_length(p), 0);
    assert_near(abbe_volume_sums_mean(&s, cell, 1), cosine, 0.003);
    assert_near(abbe_volume_sums_mean(&s, cell, 2), 2 * cosine, 0.006);
  }
}
