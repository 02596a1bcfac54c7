#include "tests/check.h"

#include "tests/random.h"
#include "validation/trace/walks/eye_walk.h"

enum { PHOTONS = 3000 };

typedef struct gathered {
  size_t count, times[PHOTONS]; /* by colour, which numbers the photons here */
} gathered;

static void take(void *user, const abbe_grid_photon *photon) {
  gathered *g = user;
  assert_true(photon->colour < PHOTONS);
  g->count++;
  g->times[photon->colour]++;
}

/* Every photon within the radius once, on that surface and side, and no other. */
static void check_gather(const abbe_photon_grid *grid, const abbe_grid_photon *photon, size_t count,
                         const float p[3], float radius, uint32_t surface, float side) {
  gathered g = {0};
  abbe_photon_grid_gather(grid, p, radius, surface, side, take, &g);
  for (size_t i = 0; i < count; i++) {
    float square = 0;
    for (int k = 0; k < 3; k++) square += (photon[i].p[k] - p[k]) * (photon[i].p[k] - p[k]);
    bool wanted = square <= radius * radius && photon[i].surface == surface &&
                  (photon[i].flux > 0) == (side > 0);
    assert_int_equal(g.times[photon[i].colour], wanted);
  }
}

static void scatter(abbe_grid_photon *photon, size_t count, const double centre[3], double size,
                    bool flat, uint64_t *random) {
  for (size_t i = 0; i < count; i++) {
    photon[i] = (abbe_grid_photon){.surface = (uint32_t)random_bits(random) % 3,
                                   .flux = random_bits(random) % 4 ? 1 : -1,
                                   .colour = (uint32_t)i};
    for (int k = 0; k < 3; k++)
      photon[i].p[k] =
          (float)(centre[k] + (flat && k == 2 ? 0 : random_between(random, -size, size)));
  }
}

/* Around the origin, so on both sides of 0; far from it, where single precision is coarse against
 * the radius; on a plane along the cubes' faces; and with more cubes than cells. */
TEST(finds_what_a_search_through_all_finds) {
  static const struct {
    double centre[3], size, radius;
    bool flat;
  } cases[] = {{{0, 0, 0}, 1, 0.2, false},
               {{0, 0, 0}, 1, 0.2, true},
               {{0, 0, 0}, 1e3, 60, false},
               {{-3000, 2000, -1000}, 0.02, 0.004, false},
               {{-3000, 2000, -1000}, 0.004, 0.0008, false},
               {{1e6, -1e6, 0}, 3, 0.6, true},
               {{0, 0, 0}, 1e-6, 2e-7, false},
               {{5, 5, 5}, 1, 1e-3, false}};
  static abbe_grid_photon photon[PHOTONS];
  uint64_t random = 3;
  OWNED(abbe_photon_grid, grid) = {0};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    float radius = (float)cases[c].radius;
    scatter(photon, PHOTONS, cases[c].centre, cases[c].size, cases[c].flat, &random);
    OK(abbe_photon_grid_fill(&grid, photon, PHOTONS, radius, 2, &error));
    for (int i = 0; i < 100; i++) {
      /* half of the places are photons themselves, the others anywhere */
      float p[3];
      const abbe_grid_photon *q = &photon[random_bits(&random) % PHOTONS];
      for (int k = 0; k < 3; k++)
        p[k] = i % 2 ? q->p[k] : q->p[k] + (float)random_between(&random, -0.7, 0.7) * radius;
      float share = i % 3 == 0 ? 0.3f : 1;
      check_gather(&grid, photon, PHOTONS, p, share * radius, q->surface, q->flux);
    }
  }
}

/* Many photons in one place: all of them, once each. */
TEST(photons_in_one_place) {
  static abbe_grid_photon photon[PHOTONS];
  for (uint32_t i = 0; i < PHOTONS; i++)
    photon[i] = (abbe_grid_photon){.p = {-0.5f, 0.25f, 0}, .flux = 1, .colour = i};
  MADE(abbe_photon_grid, grid, abbe_photon_grid_fill(&grid, photon, PHOTONS, 0.5f, 2, &error));
  check_gather(&grid, photon, PHOTONS, (float[3]){-0.5f, 0.25f, 0}, 0.5f, 0, 1);
  check_gather(&grid, photon, PHOTONS, (float[3]){0, 0.25f, 0}, 0.5f, 0, 1); /* on the rim */
  check_gather(&grid, photon, PHOTONS, (float[3]){0.01f, 0.25f, 0}, 0.5f, 0, 1);
}

static void gather_order(void *user, const abbe_grid_photon *photon) {
  uint32_t *last = user;
  assert_true(photon->colour >= *last);
  *last = photon->colour;
}

/* Within a cell they stay in their order, so that sums do not depend on how the sort went. */
TEST(order_is_kept_within_a_cell) {
  static abbe_grid_photon photon[PHOTONS];
  for (uint32_t i = 0; i < PHOTONS; i++)
    photon[i] = (abbe_grid_photon){.p = {0.2f, 0.2f, 0.2f}, .flux = 1, .colour = i};
  MADE(abbe_photon_grid, grid, abbe_photon_grid_fill(&grid, photon, PHOTONS, 0.1f, 2, &error));
  uint32_t last = 0;
  abbe_photon_grid_gather(&grid, photon[0].p, 0.1f, 0, 1, gather_order, &last);
  assert_int_equal(last, PHOTONS - 1);
}

/* Filled again with fewer, more and none: what was there before is gone. */
TEST(a_grid_can_be_filled_again) {
  static abbe_grid_photon photon[PHOTONS];
  uint64_t random = 9;
  scatter(photon, PHOTONS, (double[3]){0, 0, 0}, 1, false, &random);
  OWNED(abbe_photon_grid, grid) = {0};
  const size_t counts[] = {10, PHOTONS, 1, 0, 1500};
  for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
    OK(abbe_photon_grid_fill(&grid, photon, counts[c], 0.3f, 2, &error));
    for (uint32_t surface = 0; surface < 3; surface++)
      check_gather(&grid, photon, counts[c], photon[0].p, 0.3f, surface, 1);
    gathered g = {0};
    abbe_photon_grid_gather(&grid, photon[0].p, 0.3f, 99, 1, take, &g);
    assert_int_equal(g.count, 0);
  }
  abbe_photon_grid_free(NULL);
}
