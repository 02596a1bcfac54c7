/* Photons found along rays: those that lie there, each once, as looking at all of them finds. */
#include "tests/check.h"
#include "tests/random.h"

#include "validation/trace/medium/haze_grid.h"

enum { COUNT = 20000, RAYS = 300 };

typedef struct found {
  size_t count;
  double sum; /* of fluxes, which tell photons apart */
  uint32_t last;
} found;

static void take(void *user, const abbe_haze_photon *photon, float t) {
  found *f = user;
  f->count++;
  f->sum += (double)photon->flux;
  assert_true(isfinite(t));
}

static void fill(abbe_haze_photon *photon, const double size[3]) {
  uint64_t random = 17;
  for (size_t i = 0; i < COUNT; i++) {
    photon[i] = (abbe_haze_photon){.flux = (float)i, .medium = i % 3 == 0 ? -1 : 0};
    for (int k = 0; k < 3; k++) photon[i].p[k] = (float)random_between(&random, -size[k], size[k]);
  }
}

static void search(const abbe_haze_photon *photon, const float o[3], const float d[3], float from,
                   float to, float radius, found *f) {
  for (size_t i = 0; i < COUNT; i++) {
    float v[3], t = 0, square = 0;
    for (int k = 0; k < 3; k++) {
      v[k] = photon[i].p[k] - o[k];
      t += v[k] * d[k];
    }
    for (int k = 0; k < 3; k++) square += (v[k] - t * d[k]) * (v[k] - t * d[k]);
    if (square <= radius * radius && t >= from && t <= to && photon[i].medium == 0)
      take(f, &photon[i], t);
  }
}

static void check_rays(const abbe_haze_grid *g, const abbe_haze_photon *photon, float radius) {
  uint64_t random = 3;
  size_t all = 0;
  for (int i = 0; i < RAYS; i++) {
    float o[3], d[3], length = 0;
    for (int k = 0; k < 3; k++) {
      o[k] = (float)random_between(&random, -1.5, 1.5);
      d[k] = i % 5 == k ? 0 : (float)random_between(&random, -1, 1);
      length += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) d[k] /= sqrtf(length);
    const float from = (float)random_between(&random, -1, 1), to = from + 2;
    found grid = {0}, plain = {0};
    abbe_haze_grid_gather(g, o, d, from, to, radius, 0, take, &grid);
    search(photon, o, d, from, to, radius, &plain);
    assert_int_equal(grid.count, plain.count);
    assert_near(grid.sum, plain.sum, 1e-9 * fabs(plain.sum));
    all += plain.count;
  }
  assert_true(all > 500);
}

TEST(a_gather_finds_what_is_there) {
  static const double sizes[][3] = {{1, 1, 1}, {1, 0.02, 0.4}, {0.7, 0, 0.7}};
  static const float radii[] = {0.05f, 0.004f, 0.2f};
  FREED abbe_haze_photon *photon = malloc(COUNT * sizeof *photon);
  assert_non_null(photon);
  OWNED(abbe_haze_grid, grid) = {0};
  for (size_t i = 0; i < 3; i++) {
    fill(photon, sizes[i]);
    OK(abbe_haze_grid_fill(&grid, photon, COUNT, radii[i], &error));
    check_rays(&grid, photon, i == 1 ? 0.03f : radii[i]); /* wider than it was made for, too */
  }
}

TEST(none_and_all_in_one_place) {
  const float o[3] = {0}, d[3] = {0, 0, 1};
  found f = {0};
  FILLED(abbe_haze_grid, grid, abbe_haze_grid_gather(&grid, o, d, 0, 1, 0.1f, 0, take, &f));
  OK(abbe_haze_grid_fill(&grid, NULL, 0, 0.1f, &error));
  abbe_haze_grid_gather(&grid, o, d, 0, 1, 0.1f, 0, take, &f);
  assert_int_equal(f.count, 0);
  abbe_haze_photon photon[100];
  for (size_t i = 0; i < 100; i++) photon[i] = (abbe_haze_photon){.p = {0.01f, 0, 0.5f}, .flux = 1};
  OK(abbe_haze_grid_fill(&grid, photon, 100, 0, &error));
  abbe_haze_grid_gather(&grid, o, d, 0, 1, 0.1f, 0, take, &f);
  assert_int_equal(f.count, 100);
  f = (found){0};
  abbe_haze_grid_gather(&grid, o, d, 0.6f, 1, 0.1f, 0, take, &f);
  abbe_haze_grid_gather(&grid, o, d, 0, 1, 0.001f, 0, take, &f);
  abbe_haze_grid_gather(&grid, o, d, 0, 1, 0.1f, -1, take, &f);
  assert_int_equal(f.count, 0);
}
