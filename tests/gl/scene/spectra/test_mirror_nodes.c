/* What mirrors reflect at the renderer's wavelengths, against sums over the metal's whole spectrum.
 */
#include "tests/check.h"

#include "gl/scene/spectra/mirror_nodes.h"
#include "spectral/formats/material_table_load.h"
#include "spectral/optics.h"

#include <math.h>

enum { NODES = 7, FINE = 4000 };

static abbe_material_table table;
static abbe_object gold;
static abbe_wavelengths w;
static abbe_mirror_node node[NODES];
static const abbe_illuminant white = {.kind = ABBE_ILLUMINANT_D65};
static abbe_weights_range range;

static int make(void **state) {
  (void)state;
  if (abbe_material_table_load(NULL, &table, NULL) != ABBE_OK) return -1;
  if (abbe_material_table_find(&table, "gold", &gold.conductor, NULL) != ABBE_OK) return -1;
  gold.mirror = true;
  if (abbe_wavelengths_make(NODES, 380, 780, &w, NULL) != ABBE_OK) return -1;
  abbe_weights_range_make(&white, 380, 780, &range);
  return abbe_mirror_nodes_fill(&gold, &w, &range, node, NULL) == ABBE_OK ? 0 : -1;
}

static int drop(void **state) {
  (void)state;
  abbe_wavelengths_free(&w);
  abbe_material_table_free(&table);
  return 0;
}

static double straight_at(double lambda_nm) {
  double n, k;
  assert_int_equal(abbe_material_nk(gold.conductor, lambda_nm, &n, &k, NULL), ABBE_OK);
  return abbe_optics_fresnel_conductor(1, n, k);
}

/* Y of what a white light has after so many reflections; polygon: by the nodes. */
static double reflected_y(bool polygon, int times) {
  double sum = 0, xyz[3];
  for (int i = 0; i < FINE; i++) {
    const double a = 380 + 400.0 * i / FINE, b = 380 + 400.0 * (i + 1) / FINE, at = 0.5 * (a + b);
    const double place = (at - 380) / 400 * (NODES - 1), t = place - floor(place);
    const size_t k = (size_t)place;
    abbe_weights_range_xyz(&range, a, b, xyz);
    sum += xyz[1] * (polygon ? (1 - t) * pow(abbe_mirror_node_straight(&node[k]), times) +
                                   t * pow(abbe_mirror_node_straight(&node[k + 1]), times)
                             : pow(straight_at(at), times));
  }
  return sum;
}

static void seven_nodes_tell_a_metals_light(void **state) {
  (void)state;
  const double once = reflected_y(true, 1) / reflected_y(false, 1);
  const double twice = reflected_y(true, 2) / reflected_y(false, 2);
  print_message("gold at seven nodes: %.5f of the light, %.5f of it reflected twice\n", once,
                twice);
  assert_near(once, 1, 2e-3);
  assert_near(twice, 1, 0.02); /* squares of what is straight between two nodes */
}

static void a_number_is_reflected_as_it_is(void **state) {
  (void)state;
  const abbe_object grey = {.mirror = true, .mirror_reflectance = 0.7};
  const double one[3] = {1, 1, 1};
  abbe_mirror_node at[NODES];
  abbe_mirror_band a, b, both;
  assert_int_equal(abbe_mirror_nodes_fill(&grey, &w, &range, at, NULL), ABBE_OK);
  for (int i = 0; i < NODES; i++) {
    assert_true(at[i].k < 0);
    assert_near(abbe_mirror_node_straight(&at[i]), 0.7, 1e-15);
  }
  assert_int_equal(abbe_mirror_band_make(&grey, &range, one, 500, 550, &at[0], &a, NULL), ABBE_OK);
  assert_int_equal(abbe_mirror_band_make(&grey, &range, one, 550, 600, &at[0], &b, NULL), ABBE_OK);
  abbe_mirror_band_join(&a, &b, &both);
  double xyz[3];
  abbe_weights_range_xyz(&range, 500, 600, xyz);
  for (int c = 0; c < 3; c++) assert_near(both.weight[c], xyz[c], 1e-9);
  assert_near(both.factor, 0.3, 1e-12);
  assert_near(both.straight, 0.7, 1e-12);
}

/* However few bands there are, at normal incidence each has the colour of all its wavelengths. */
static void bands_have_the_metals_colour(void **state) {
  (void)state;
  abbe_mirror_band band[NODES];
  double wanted[3] = {0}, seen[3] = {0}, joined[3], all[3] = {0}, xyz[3];
  for (int i = 0; i < FINE; i++) {
    const double a = 380 + 400.0 * i / FINE, b = 380 + 400.0 * (i + 1) / FINE;
    abbe_weights_range_xyz(&range, a, b, xyz);
    for (int c = 0; c < 3; c++) {
      all[c] += xyz[c];
      wanted[c] += xyz[c] * straight_at(0.5 * (a + b));
    }
  }
  for (int i = 0; i < NODES; i++) {
    assert_int_equal(abbe_mirror_band_make(&gold, &range, all, w.edge_nm[i], w.edge_nm[i + 1],
                                           &node[i], &band[i], NULL),
                     ABBE_OK);
    const double metal = abbe_optics_fresnel_conductor(1, band[i].n, band[i].k);
    assert_near(1 - band[i].factor * (1 - metal), band[i].straight, 1e-12);
    for (int c = 0; c < 3; c++) seen[c] += band[i].weight[c] * band[i].straight;
  }
  abbe_mirror_band sum = band[0];
  for (int i = 1; i < NODES; i++) {
    const abbe_mirror_band before = sum;
    abbe_mirror_band_join(&before, &band[i], &sum);
  }
  for (int c = 0; c < 3; c++) {
    joined[c] = sum.weight[c] * sum.straight;
    assert_near(seen[c], wanted[c] / all[c], 1e-5);
    assert_near(joined[c], seen[c], 1e-9);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(seven_nodes_tell_a_metals_light),
                                     cmocka_unit_test(a_number_is_reflected_as_it_is),
                                     cmocka_unit_test(bands_have_the_metals_colour)};
  return cmocka_run_group_tests(tests, make, drop);
}
