/* Looking light up: at a node and cell it is what is stored, turns are exact for a ball, weights
 * sum to one. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/volume/caustic_volume.h"
#include "tests/random.h"
#include "tests/scenes/volume/volume_lookup.h"
#include "tests/scenes/volume/volumes.h"

static const abbe_region_desc
    grid = {.kind = ABBE_REGION_GRID, .side = 24, .outer = 3},
    shells = {.kind = ABBE_REGION_OCTAHEDRAL, .side = 32, .shells = 24, .inner = 0.9, .outer = 3},
    triangles = {.kind = ABBE_REGION_GEODESIC, .levels = 3, .shells = 12, .inner = 0.9, .outer = 3};

TEST(halves) {
  static const double exact[] = {
      0, 1, -2.5, 65504, 6.103515625e-5, 5.9604644775390625e-8, 0.333251953125};
  for (size_t i = 0; i < sizeof exact / sizeof *exact; i++)
    assert_near(abbe_half_value(abbe_half_of(exact[i])), exact[i], 0);
  assert_int_equal(abbe_half_of(1), 0x3c00); /* IEEE 754's own bits */
  assert_int_equal(abbe_half_of(-2), 0xc000);
  assert_int_equal(abbe_half_of(1e9), 0x7bff);
  assert_int_equal(abbe_half_of(2.98e-8), 0); /* half a step, to the even one */
  uint64_t seed = 2;
  for (int i = 0; i < 10000; i++) {
    const double x = random_between(&seed, 0, 1) * exp(random_between(&seed, -9, 9));
    assert_near(abbe_half_value(abbe_half_of(x)), x, fmax(x * 0x1p-11, 0x1p-25));
  }
}

/* Under a node's own light, in a cell's middle of a grid. */
TEST(a_node_and_a_cell_are_what_is_stored) {
  for (int lookup = ABBE_VOLUME_LOOKUP_NEAREST; lookup < ABBE_VOLUME_LOOKUP_COUNT; lookup++) {
    FILLED(abbe_caustic_volume, v, make_volume(ABBE_VOLUME_VECTOR, grid, 42, false, &v));
    for (size_t node = 0; node < 42; node += 5)
      for (size_t cell = 0; cell < v.region.cells; cell += 777) {
        abbe_volume_sight sight;
        double p[3], f[3][3];
        abbe_volume_region_middle(&v.region, cell, p);
        abbe_caustic_volume_look(&v, (abbe_volume_lookup)lookup, v.nodes.direction[node], &sight);
        abbe_caustic_volume_flux(&v, &sight, p, f);
        for (size_t c = 0; c < 9; c++)
          assert_near(f[c / 3][c % 3],
                      abbe_half_value(v.value[(node * v.region.cells + cell) * 9 + c]), 1e-6);
      }
  }
}

/* The largest error of lookups of a ball's field, relative to the largest value; of light from
 * anywhere, or from the nodes alone: then it is the cells'. */
static double ball_error(const abbe_caustic_volume *v, abbe_volume_lookup lookup, bool at_nodes) {
  uint64_t seed = 21;
  double worst = 0, most = 0;
  for (int i = 0; i < 20000; i++) {
    double l[3], p[3], f[3][3], truth[9];
    abbe_volume_sight sight;
    random_unit(&seed, l);
    if (at_nodes) memcpy(l, v->nodes.direction[(size_t)i % v->nodes.count], sizeof l);
    random_unit(&seed, p);
    const double radius = random_between(&seed, 1.1, 2.4);
    for (int k = 0; k < 3; k++) p[k] *= radius;
    abbe_caustic_volume_look(v, lookup, l, &sight);
    abbe_caustic_volume_flux(v, &sight, p, f);
    ball_field(l, p, truth);
    for (int c = 0; c < 9; c++) {
      worst = fmax(worst, fabs(f[c / 3][c % 3] - truth[c]));
      most = fmax(most, fabs(truth[c]));
    }
  }
  return worst / most;
}

/* Turned lookups see a ball's field from any direction as from a node: what is left is the cells'.
 * Blends of three nodes are off by what the light turns, which more nodes make less. */
TEST(turns_are_exact_for_a_ball) {
  double blended[2];
  static const size_t counts[] = {12, 162, 1};
  for (int i = 0; i < 3; i++) {
    FILLED(abbe_caustic_volume, v, make_volume(ABBE_VOLUME_VECTOR, shells, counts[i], true, &v));
    const double cells = ball_error(&v, ABBE_VOLUME_LOOKUP_TURN, true);
    const double turned = ball_error(&v, ABBE_VOLUME_LOOKUP_TURN, false);
    assert_true(turned < 1.25 * cells);
    if (i < 2) blended[i] = ball_error(&v, ABBE_VOLUME_LOOKUP_BLEND, false);
    if (i == 0) assert_true(blended[0] > 5 * cells);
  }
  assert_true(blended[1] < 0.4 * blended[0]);
}

TEST(a_ball_is_turned_by_itself) {
  FILLED(abbe_caustic_volume, v, make_volume(ABBE_VOLUME_VECTOR, triangles, 12, true, &v));
  assert_int_equal(abbe_caustic_volume_resolve(&v, ABBE_VOLUME_LOOKUP_AUTO),
                   ABBE_VOLUME_LOOKUP_TURN);
  v.body.ball = false;
  assert_int_equal(abbe_caustic_volume_resolve(&v, ABBE_VOLUME_LOOKUP_AUTO),
                   ABBE_VOLUME_LOOKUP_BLEND);
}

/* Beyond the rim light thins by the square of the distance; printed it does not. */
TEST(beyond_the_region) {
  const abbe_region_desc all[] = {grid, shells, triangles};
  for (int i = 0; i < 3; i++) {
    OWNED(abbe_caustic_volume, printed);
    FILLED(abbe_caustic_volume, v, make_volume(ABBE_VOLUME_VECTOR, all[i], 12, false, &v));
    make_volume(ABBE_VOLUME_PRINTED, all[i], 12, false, &printed);
    abbe_volume_sight sight;
    const double l[3] = {0.6, 0, 0.8}, rim[3] = {1.2, 0.9, -2.999999},
                 far[3] = {3.6, 2.7, -8.999997};
    double a[3][3], b[3][3], x[3], y[3];
    const double *at_rim = rim;
    double near[3];
    for (int k = 0; k < 3; k++)
      near[k] = i == 0 ? rim[k] : rim[k] * 2.99999 / abbe_vector_length(rim);
    at_rim = near;
    const double stretch = abbe_vector_length(far) / abbe_vector_length(at_rim);
    abbe_caustic_volume_look(&v, ABBE_VOLUME_LOOKUP_BLEND, l, &sight);
    abbe_caustic_volume_flux(&v, &sight, at_rim, a);
    abbe_caustic_volume_flux(&v, &sight, far, b);
    for (int c = 0; c < 9; c++)
      assert_near(b[c / 3][c % 3] * stretch * stretch, a[c / 3][c % 3], 1e-4 * fabs(a[2][2]));
    abbe_caustic_volume_ratio(&printed, &sight, at_rim, x);
    abbe_caustic_volume_ratio(&printed, &sight, far, y);
    for (int c = 0; c < 3; c++) assert_near(x[c], y[c], 1e-12);
    assert_true(x[0] > 0);
  }
}

TEST(too_many_values_are_refused) {
  const abbe_region_desc large = {.kind = ABBE_REGION_GRID, .side = 256, .outer = 1};
  MADE(abbe_caustic_volume, v, abbe_volume_region_make(&large, &v.region, &error));
  OK(abbe_light_nodes_make(162, (const double[3]){0, 0, 1}, &v.nodes, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "fewer", abbe_caustic_volume_allocate(&v, &error));
}
