#include "validation/trace/tracer/tracer_state.h"

#include "base/maths.h"
#include "validation/trace/transport/random.h"

#include <stdlib.h>
#include <string.h>

enum { SALT = 0x6c6967 };

static bool is_environment(const abbe_tracer *t, size_t light) {
  return light == t->environment.light && t->environment.ball_count > 0;
}

abbe_result abbe_emission_make(const abbe_tracer *t, size_t light, size_t count, uint32_t pass,
                               uint32_t seed, abbe_emission *e, abbe_error *error) {
  const abbe_projection_map *map = &t->projection[light];
  *e = (abbe_emission){.t = t,
                       .light = light,
                       .count = map->count > 0 || is_environment(t, light) ? count : 0,
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
static inline uint32_t even_bits(uint32_t z) {
  z &= 0x55555555u;
  z = (z | z >> 1) & 0x33333333u;
  z = (z | z >> 2) & 0x0f0f0f0fu;
  z = (z | z >> 4) & 0x00ff00ffu;
  return (z | z >> 8) & 0x0000ffffu;
}

enum { LANES = ABBE_PROJECTION_MAP_LANES };

/* Photons that follow each other, an array of a lane each. */
typedef struct block {
  abbe_projection_map_rays rays;
  const abbe_projection_map_cell *cell[LANES];
  uint32_t first;        /* photon of the first lane */
  uint32_t place[LANES]; /* cells of its photons */
  double part[LANES];    /* 2^32 over their number */
  float share[LANES]; /* share of the light's photons that go to the cell, and their number: product
                       */
  float within[LANES], disk[2][LANES];
  uint32_t step[LANES];
} block;

/* Where in its cell each photon starts, and its wavelength. The q-th of n has its own of n parts of
 * a Z-order curve through the cell, a place at random in it: photons that follow each other are
 * neighbours, and every part of the cell has its share. Along the curve the wavelengths are the
 * fractional parts of multiples of the golden ratio, shifted at random: every patch of neighbours
 * has them all. */
SIDE_BY_SIDE static void place(uint32_t light, uint32_t pass, uint32_t seed, uint32_t shift,
                               block *b) {
  const uint32_t golden = 2654435769u;
  float random[LANES];
  uint32_t z[LANES];
  for (uint32_t k = 0; k < LANES; k++) {
    uint32_t bits[4];
    abbe_random_bits(b->first + k, light, pass, seed, bits);
    random[k] = abbe_random_float(bits[0]);
    b->disk[0][k] = abbe_random_float(bits[1]);
    b->disk[1][k] = abbe_random_float(bits[2]);
  }
  for (uint32_t k = 0; k < LANES; k++)
    z[k] = (uint32_t)((b->place[k] + (double)random[k]) * b->part[k]);
  for (uint32_t k = 0; k < LANES; k++) {
    b->rays.x[k] += (float)even_bits(z[k]) * 0x1p-16f;
    b->rays.y[k] += (float)even_bits(z[k] >> 1) * 0x1p-16f;
    b->step[k] = abbe_spectral_sampling_step((b->first + k) * golden + shift, &b->within[k]);
  }
}

/* From a light with a size, one by one. */
static void start_on_disk(const abbe_projection_map *map, block *b) {
  abbe_projection_map_rays *r = &b->rays;
  for (size_t k = 0; k < LANES; k++) {
    float uv[2] = {r->x[k] - (float)b->cell[k]->x, r->y[k] - (float)b->cell[k]->y}, o[3], d[3];
    float disk[2] = {b->disk[0][k], b->disk[1][k]};
    r->flux[k] = abbe_projection_map_ray(map, b->cell[k], uv, disk, o, d);
    for (int i = 0; i < 3; i++) {
      r->o[i][k] = o[i];
      r->d[i][k] = d[i];
    }
  }
}

static void write(const abbe_emission *e, const block *b, size_t count, abbe_photon *photon) {
  const abbe_projection_map_rays *r = &b->rays;
  const size_t steps = e->t->sampling.steps;
  const float(*xyz)[3] = (const float(*)[3])e->t->sampling.xyz + e->light * steps;
  for (size_t k = 0; k < count; k++) {
    abbe_photon *p = &photon[k];
    for (int i = 0; i < 3; i++) {
      p->o[i] = r->o[i][k];
      p->d[i] = r->d[i][k];
    }
    p->flux = r->flux[k] / b->share[k];
    p->step = b->step[k];
    p->within = b->within[k];
    p->y = xyz[p->step][1];
    p->id = (b->first + (uint32_t)k) | (uint32_t)e->light << 27;
  }
}

static size_t emit(const abbe_emission *e, uint32_t from, uint32_t to, abbe_photon *photon) {
  const abbe_projection_map *map = &e->t->projection[e->light];
  const uint32_t light = (uint32_t)e->light + 1;
  uint32_t shift[4];
  size_t cell = cell_of(e, from);
  abbe_random_bits(0, light, e->pass, e->seed, shift);
  for (uint32_t j = from; j < to; j += LANES) {
    const uint32_t count = to - j < LANES ? to - j : LANES;
    block b;
    b.first = j;
    for (uint32_t k = 0; k < LANES; cell++) {
      /* those of the cell; lanes beyond the last photon are copies of it */
      const uint32_t first = e->first[cell], end = e->first[cell + 1];
      const abbe_projection_map_cell *c = &map->cell[cell];
      const double part = 4294967296.0 / (double)(end - first);
      const float share = (float)e->count * c->share, x = (float)c->x, y = (float)c->y;
      for (; k < LANES && (j + k < end || k >= count); k++) {
        b.cell[k] = c;
        b.place[k] = k < count ? j + k - first : 0;
        b.part[k] = part;
        b.share[k] = share;
        b.rays.x[k] = x;
        b.rays.y[k] = y;
      }
      if (k == LANES) break;
    }
    place(light, e->pass, e->seed, shift[0], &b);
    if (map->radius > 0)
      start_on_disk(map, &b);
    else
      abbe_projection_map_aim(map, &b.rays);
    write(e, &b, count, &photon[j - from]);
  }
  return to - from;
}

/* Photon j of the environment's. Texels, places in them and on the disks, and wavelengths are
 * multiples of golden ratios of seven dimensions, shifted at random in every pass [Roberts2018]:
 * texels in turn would be faster to read, and a lattice's even spread over all of it be lost. */
static void start_outside(const abbe_emission *e, uint32_t j, const uint32_t shift[8],
                          abbe_photon *p) {
  static const uint32_t golden[7] = {3915259345u, 3569120481u, 3253582939u, 2965941329u,
                                     2703729436u, 2464699080u, 2246800835u};
  const abbe_environment_light *light = &e->t->environment;
  double u[6];
  float rgb[3];
  for (int k = 0; k < 6; k++)
    u[k] = k % 3 == 0 ? abbe_random_double(j * golden[k] + shift[k], shift[7])
                      : (double)abbe_random_float(j * golden[k] + shift[k]);
  p->step = abbe_spectral_sampling_step(j * golden[6] + shift[6], &p->within);
  abbe_environment_light_ray(light, u, p->o, p->d, rgb);
  const float *lift = light->lift[p->step];
  p->flux = (lift[0] * rgb[0] + lift[1] * rgb[1] + lift[2] * rgb[2]) / (float)e->count;
  p->y = e->t->sampling.xyz[e->light * e->t->sampling.steps + p->step][1];
  p->id = j | (uint32_t)e->light << 27;
}

static size_t surround(const abbe_emission *e, uint32_t from, uint32_t to, abbe_photon *photon) {
  uint32_t shift[8];
  abbe_random_bits(0, (uint32_t)e->light + 1, e->pass, e->seed, shift);
  abbe_random_bits(1, (uint32_t)e->light + 1, e->pass, e->seed, shift + 4);
  for (uint32_t j = from; j < to; j++) start_outside(e, j, shift, &photon[j - from]);
  return to - from;
}

size_t abbe_emission_batch(const abbe_emission *e, uint32_t from, uint32_t to,
                           abbe_photon *photon) {
  const uint32_t end = to - from < ABBE_LIGHT_WALK_BATCH ? to : from + ABBE_LIGHT_WALK_BATCH;
  return is_environment(e->t, e->light) ? surround(e, from, end, photon)
                                        : emit(e, from, end, photon);
}

void abbe_emission_free(abbe_emission *e) {
  free(e->first);
  e->first = NULL;
}

abbe_result abbe_tracer_polarise(abbe_tracer *t, abbe_error *error) {
  const abbe_scene *s = t->scene;
  const bool sheets = abbe_scene_is_polarised(s),
             on = t->desc.polarisation == ABBE_TRACE_POLARISATION_ON;
  abbe_physics *physics = &t->desc.physics;
  if (on && physics->matched)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "matched physics is the renderer's, which has no polarised light: take "
                          "full physics");
  const bool chooses = !physics->matched && t->desc.polarisation == ABBE_TRACE_POLARISATION_AUTO;
  physics->polarised = on || (chooses && (sheets || abbe_scene_crystal_in_line(s) != NULL));
  t->passes = 1;
  for (size_t i = 0; physics->polarised && i < s->object_count; i++) {
    const abbe_coatings *c = s->object[i].coatings;
    for (size_t k = 0; c != NULL && k < c->count; k++)
      if (c->coating[k].layer[0].table != NULL)
        return abbe_error_set(error, ABBE_UNSUPPORTED,
                              "the coating of '%s' is a table of reflectances, which has no phases "
                              "for polarised light: take --polarisation off, or give its layers",
                              s->object[i].name);
  }
  if (!physics->polarised || !sheets) return ABBE_OK;
  if (s->camera.polariser.kind != ABBE_POLARISER_NONE) t->passes = 0.5f;
  t->dimmed = *s;
  t->dimmed.light = malloc((s->light_count + 1) * sizeof *s->light);
  if (t->dimmed.light == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for lights");
  memcpy(t->dimmed.light, s->light, s->light_count * sizeof *s->light);
  for (size_t i = 0; i < s->light_count; i++)
    if (s->light[i].polariser.kind != ABBE_POLARISER_NONE) t->dimmed.light[i].power *= 0.5;
  t->scene = &t->dimmed;
  return ABBE_OK;
}
