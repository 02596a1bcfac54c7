#include "validation/tracer/emission.h"

#include "validation/transport/random.h"

#include <stdlib.h>

enum { SALT = 0x6c6967 };

abbe_result abbe_emission_make(const abbe_tracer *t, size_t light, size_t count, uint32_t pass,
                               uint32_t seed, abbe_emission *e, abbe_error *error) {
  const abbe_projection_map *map = &t->projection[light];
  *e = (abbe_emission){.t = t,
                       .light = light,
                       .count = map->count > 0 ? count : 0,
                       .pass = pass,
                       .seed = seed ^ SALT};
  e->first = malloc((map->count + 1) * sizeof *e->first);
  if (e->first == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for photons");
  float random[4];
  abbe_random4((uint32_t)light, 0, pass, e->seed, random);
  /* every cell gets its share, rounded up or down so that the mean is right */
  double sum = 0, shift = (double)random[0];
  for (size_t i = 0; i < map->count; i++) {
    e->first[i] = (uint32_t)floor(sum * (double)e->count + shift);
    sum += (double)map->cell[i].share;
  }
  e->first[map->count] = (uint32_t)e->count;
  e->first[0] = 0;
  for (size_t i = map->count; i > 0 && e->first[i - 1] > e->first[i]; i--)
    e->first[i - 1] = e->first[i];
  return ABBE_OK;
}

static size_t cell_of(const abbe_emission *e, uint32_t photon) {
  size_t low = 0, high = e->t->projection[e->light].count;
  while (high - low > 1) {
    size_t middle = low + (high - low) / 2;
    if (e->first[middle] <= photon)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Every other bit, from the lowest on. */
static uint32_t even_bits(uint32_t z) {
  z &= 0x55555555u;
  z = (z | z >> 1) & 0x33333333u;
  z = (z | z >> 2) & 0x0f0f0f0fu;
  z = (z | z >> 4) & 0x00ff00ffu;
  return (z | z >> 8) & 0x0000ffffu;
}

/* The q-th of n places in a cell: n parts of a Z-order curve through it, one place at random in
 * each. Photons that follow each other are neighbours, and every part of the cell has its share. */
static void place_in_cell(uint32_t q, uint32_t n, float random, float uv[2]) {
  uint32_t z = (uint32_t)(((double)q + (double)random) / (double)n * 4294967296.0);
  uv[0] = (float)even_bits(z) * 0x1p-16f;
  uv[1] = (float)even_bits(z >> 1) * 0x1p-16f;
}

/* Along the curve the wavelengths are the fractional parts of
 * multiples of the golden ratio, shifted at random: every patch of neighbours has them all. */
static size_t emit(const abbe_emission *e, uint32_t from, uint32_t to, abbe_photon *photon) {
  const abbe_projection_map *map = &e->t->projection[e->light];
  const uint32_t golden = 2654435769u;
  const float(*xyz)[3] = (const float(*)[3])e->t->sampling.xyz + e->light * e->t->sampling.steps;
  uint32_t shift[4], light = (uint32_t)e->light + 1, seed = e->seed;
  size_t cell = cell_of(e, from);
  abbe_random_bits(0, light, e->pass, seed, shift);
  for (uint32_t j = from; j < to; j++) {
    while (cell + 1 < map->count && e->first[cell + 1] <= j) cell++;
    float random[4], at[2];
    abbe_random4(j, light, e->pass, seed, random);
    place_in_cell(j - e->first[cell], e->first[cell + 1] - e->first[cell], random[0], at);
    abbe_photon *p = photon++;
    float flux = abbe_projection_map_ray(map, &map->cell[cell], at, random + 1, p->o, p->d);
    p->flux = flux / ((float)e->count * map->cell[cell].share);
    p->step = abbe_spectral_sampling_step(abbe_random_float(j * golden + shift[0]), &p->within);
    p->y = xyz[p->step][1];
    p->id = j | (uint32_t)e->light << 27;
  }
  return to - from;
}

size_t abbe_emission_batch(const abbe_emission *e, uint32_t from, uint32_t to,
                           abbe_photon *photon) {
  return emit(e, from, to - from < ABBE_LIGHT_WALK_BATCH ? to : from + ABBE_LIGHT_WALK_BATCH,
              photon);
}

void abbe_emission_free(abbe_emission *e) {
  free(e->first);
  e->first = NULL;
}
