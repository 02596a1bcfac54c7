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

/* Regions: cells fill the space once, places and rays find them, interpolation is exact where it
 * must be. */

static const abbe_region_desc regions[] = {
    {.kind = ABBE_REGION_GRID, .side = 7, .outer = 3},
    {.kind = ABBE_REGION_GEODESIC, .levels = 2, .shells = 5, .inner = 0.9, .outer = 3},
    {.kind = ABBE_REGION_OCTAHEDRAL, .side = 8, .shells = 5, .inner = 0.9, .outer = 3}};
enum { REGIONS = sizeof regions / sizeof *regions };

static void make(size_t i, abbe_volume_region *out) {
  OK(abbe_volume_region_make(&regions[i], out, &error));
}

TEST(cells_fill_the_region) {
  for (size_t i = 0; i < REGIONS; i++) {
    FILLED(abbe_volume_region, r, make(i, &r));
    double sum = 0;
    for (size_t cell = 0; cell < r.cells; cell++) {
      double p[3];
      size_t found;
      sum += abbe_volume_region_volume(&r, cell);
      abbe_volume_region_middle(&r, cell, p);
      assert_true(abbe_volume_region_find(&r, p, &found));
      assert_int_equal(found, cell);
    }
    const double whole = i == 0 ? 216 : 4 * ABBE_PI / 3 * (27 - 0.729);
    assert_near(sum, whole, 1e-10 * whole);
  }
}

/* How much of a ray lies between two spheres, or in the cube. */
static double chord(size_t i, const double o[3], const double d[3], double limit) {
  double from = 0, to = limit, cut = 0;
  if (i == 0) {
    for (int k = 0; k < 3; k++) {
      const double a = (-3 - o[k]) / d[k], b = (3 - o[k]) / d[k];
      from = fmax(from, fmin(a, b));
      to = fmin(to, fmax(a, b));
    }
    return fmax(to - from, 0);
  }
  const double b = abbe_vector_dot(o, d), c = abbe_vector_dot(o, o);
  const double out = b * b - c + 9, in = b * b - c + 0.81;
  if (!(out > 0)) return 0;
  from = fmax(-b - sqrt(out), 0);
  to = fmin(-b + sqrt(out), limit);
  if (in > 0) cut = fmax(fmin(-b + sqrt(in), to) - fmax(-b - sqrt(in), from), 0);
  return fmax(to - from, 0) - cut;
}

TEST(rays_are_cut_at_the_cells) {
  static abbe_region_piece piece[ABBE_REGION_MOST_PIECES];
  uint64_t seed = 11;
  for (size_t i = 0; i < REGIONS; i++) {
    FILLED(abbe_volume_region, r, make(i, &r));
    for (int n = 0; n < 4000; n++) {
      double o[3], d[3], sum = 0;
      for (int k = 0; k < 3; k++) o[k] = random_between(&seed, -5, 5);
      random_unit(&seed, d);
      const double limit = n % 3 == 0 ? INFINITY : random_between(&seed, 0, 6);
      const size_t count = abbe_volume_region_walk(&r, o, d, limit, piece);
      for (size_t k = 0; k < count; k++) {
        assert_true(piece[k].length > 0);
        sum += piece[k].length;
      }
      assert_near(sum, chord(i, o, d, limit), 1e-9);
    }
  }
}

/* A ray from a place outside: the middle of each piece lies in its cell. */
TEST(pieces_lie_in_their_cells) {
  static abbe_region_piece piece[ABBE_REGION_MOST_PIECES];
  uint64_t seed = 12;
  for (size_t i = 0; i < REGIONS; i++) {
    FILLED(abbe_volume_region, r, make(i, &r));
    for (int n = 0; n < 2000; n++) {
      double o[3], d[3], p[3], t = 0;
      random_unit(&seed, d);
      do random_unit(&seed, o);
      while (!(abbe_vector_dot(o, d) < -0.5));
      for (int k = 0; k < 3; k++) o[k] *= i == 0 ? 0.99 : 2.999; /* within, near the rim */
      if (i != 0) { /* past the core, whose stretch no piece tells */
        const double b = abbe_vector_dot(o, d);
        if (b * b - abbe_vector_dot(o, o) + 0.81 > 0) continue;
      }
      const size_t count = abbe_volume_region_walk(&r, o, d, INFINITY, piece);
      for (size_t k = 0; k < count; t += piece[k++].length) {
        size_t cell;
        if (piece[k].length < 1e-9) continue;
        for (int c = 0; c < 3; c++) p[c] = o[c] + (t + 0.5 * piece[k].length) * d[c];
        assert_true(abbe_volume_region_find(&r, p, &cell));
        assert_int_equal(cell, piece[k].cell);
      }
    }
  }
}

/* Axes and planes of the cells are met and passed. */
TEST(rays_along_edges_end) {
  static abbe_region_piece piece[ABBE_REGION_MOST_PIECES];
  static const double ways[][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6, 0.8, 0}};
  for (size_t i = 0; i < REGIONS; i++) {
    FILLED(abbe_volume_region, r, make(i, &r));
    for (size_t w = 0; w < 4; w++) {
      const double o[3] = {-4 * ways[w][0], -4 * ways[w][1], -4 * ways[w][2]};
      const size_t count = abbe_volume_region_walk(&r, o, ways[w], INFINITY, piece);
      double sum = 0;
      for (size_t k = 0; k < count; k++) sum += piece[k].length;
      const double whole = i == 0 ? (w < 3 ? 6 : 6 / 0.8) : 6 - 1.8;
      assert_near(sum, whole, 1e-9);
    }
  }
}

/* Of parallel lines, evenly spread, as many meet a cell as its area across them says. */
TEST(areas_across_a_beam) {
  enum { SIDE = 1200 };
  static abbe_region_piece piece[ABBE_REGION_MOST_PIECES];
  const double d[3] = {0.48, 0.6, 0.64}, x[3] = {0.8, 0, -0.6}, y[3] = {-0.36, 0.8, -0.48};
  for (size_t i = 0; i < REGIONS; i++) {
    FILLED(abbe_volume_region, r, make(i, &r));
    FREED unsigned *met = calloc(r.cells, sizeof *met), *last = calloc(r.cells, sizeof *last);
    for (unsigned n = 0; n < SIDE * SIDE; n++) {
      const double u = ((n % SIDE + 0.5) / SIDE - 0.5) * 11,
                   v = ((n / SIDE + 0.5) / SIDE - 0.5) * 11;
      double o[3];
      for (int k = 0; k < 3; k++) o[k] = u * x[k] + v * y[k] - 8 * d[k];
      const size_t count = abbe_volume_region_walk(&r, o, d, INFINITY, piece);
      for (size_t k = 0; k < count; k++) {
        met[piece[k].cell] += last[piece[k].cell] != n + 1;
        last[piece[k].cell] = n + 1;
      }
    }
    double worst = 0;
    for (size_t cell = 0; cell < r.cells; cell++) {
      const double area = met[cell] * (11.0 / SIDE) * (11.0 / SIDE);
      worst = fmax(worst, fabs(area / abbe_volume_region_across(&r, cell, d) - 1));
    }
    /* cubes are exact but for the lines' distance; faces of shells bulge */
    assert_true(worst < (i == 0 ? 0.01 : 0.12));
  }
}

/* How far off what is linear in space is between cells, at the most. */
static double linear_error(const abbe_volume_region *r) {
  uint64_t seed = 13;
  double worst = 0;
  for (int n = 0; n < 4000; n++) {
    double p[3], sum = 0, at[3] = {0}, weight[8], middle[3];
    size_t cell[8];
    do
      for (int k = 0; k < 3; k++) p[k] = random_between(&seed, -2.5, 2.5);
    while (abbe_vector_length(p) > 2.5 || abbe_vector_length(p) < 1.1);
    const size_t count = abbe_volume_region_between(r, p, cell, weight);
    for (size_t k = 0; k < count; k++) {
      assert_true(cell[k] < r->cells && weight[k] >= 0);
      sum += weight[k];
      abbe_volume_region_middle(r, cell[k], middle);
      for (int c = 0; c < 3; c++) at[c] += weight[k] * middle[c];
    }
    assert_near(sum, 1, 1e-12);
    for (int c = 0; c < 3; c++) worst = fmax(worst, fabs(at[c] - p[c]));
  }
  return worst;
}

/* On a grid it is kept; on shells as far as cells are flat: finer ones are nearer. */
TEST(weights_between_cells) {
  for (size_t i = 0; i < REGIONS; i++) {
    abbe_region_desc desc = regions[i];
    FILLED(abbe_volume_region, r, make(i, &r));
    desc.side *= 4;
    desc.levels += 2;
    desc.shells *= 4;
    MADE(abbe_volume_region, fine, abbe_volume_region_make(&desc, &fine, &error));
    if (i == 0) assert_near(linear_error(&r), 0, 1e-12);
    if (i > 0) assert_true(linear_error(&fine) < 0.35 * linear_error(&r));
  }
}

TEST(limits_are_told) {
  abbe_volume_region r;
  abbe_region_desc d = {.kind = ABBE_REGION_GRID, .side = 1, .outer = 1};
  REFUSED(ABBE_INVALID_ARGUMENT, "2 to 256", abbe_volume_region_make(&d, &r, &error));
  d = (abbe_region_desc){.kind = ABBE_REGION_GEODESIC, .shells = 2, .inner = 2, .outer = 1};
  REFUSED(ABBE_INVALID_ARGUMENT, "no space", abbe_volume_region_make(&d, &r, &error));
  d.outer = NAN;
  REFUSED(ABBE_INVALID_ARGUMENT, "to nan m holds no space",
          abbe_volume_region_make(&d, &r, &error));
  d = (abbe_region_desc){.kind = ABBE_REGION_GEODESIC, .inner = 1, .outer = 2};
  REFUSED(ABBE_INVALID_ARGUMENT, "shells", abbe_volume_region_make(&d, &r, &error));
}
