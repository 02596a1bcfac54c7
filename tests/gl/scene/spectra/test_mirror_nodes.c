/* What mirrors reflect at the renderer's wavelengths, against sums over the metal's whole spectrum.
 */
#include "tests/check.h"

#include "gl/scene/spectra/spectral_tables.h"
#include "spectral/formats/material_table_load.h"
#include "spectral/optics.h"

enum { NODES = 7, FINE = 4000 };

static abbe_material_table table;
static abbe_object gold;
static abbe_wavelengths w;
static abbe_mirror_node node[NODES];
static const abbe_illuminant white = {.kind = ABBE_ILLUMINANT_D65};
static abbe_weights_range range;

static void make(void) {
  OK(abbe_material_table_load(NULL, &table, &error));
  OK(abbe_material_table_find(&table, "gold", &gold.conductor, &error));
  gold.mirror = true;
  OK(abbe_wavelengths_make(NODES, 380, 780, &w, &error));
  abbe_weights_range_make(&white, 380, 780, &range);
  OK(abbe_mirror_nodes_fill(&gold, &w, &range, node, &error));
}

static void drop(void) {
  abbe_wavelengths_free(&w);
  abbe_material_table_free(&table);
}

/* At normal incidence. */
static double node_reflects(const abbe_mirror_node *at) {
  return abbe_mirror_reflected(at->n, at->k, at->factor);
}

static double straight_at(double lambda_nm) {
  double n, k;
  OK(abbe_material_nk(gold.conductor, lambda_nm, &n, &k, &error));
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
    sum += xyz[1] * (polygon ? (1 - t) * pow(node_reflects(&node[k]), times) +
                                   t * pow(node_reflects(&node[k + 1]), times)
                             : pow(straight_at(at), times));
  }
  return sum;
}

GROUP(make, drop);

TEST(seven_nodes_tell_a_metals_light) {
  const double once = reflected_y(true, 1) / reflected_y(false, 1);
  const double twice = reflected_y(true, 2) / reflected_y(false, 2);
  print_message("gold at seven nodes: %.5f of the light, %.5f of it reflected twice\n", once,
                twice);
  assert_near(once, 1, 2e-3);
  assert_near(twice, 1, 0.02); /* squares of what is straight between two nodes */
}

TEST(a_number_is_reflected_as_it_is) {
  const abbe_object grey = {.mirror = true, .mirror_reflectance = 0.7};
  abbe_mirror_node at[NODES];
  OK(abbe_mirror_nodes_fill(&grey, &w, &range, at, &error));
  for (int i = 0; i < NODES; i++) {
    assert_true(at[i].k < 0);
    assert_near(node_reflects(&at[i]), 0.7, 1e-15);
  }
  assert_near(abbe_mirror_reflected(0, -1, abbe_mirror_factor(0, -1, 0.7)), 0.7, 1e-15);
}
