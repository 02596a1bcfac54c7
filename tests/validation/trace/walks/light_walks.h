/* light_walks.h: light walks of small scenes, for tests: photons shot, flooded and counted. */
#ifndef ABBE_TESTS_VALIDATION_TRACE_WALKS_LIGHT_WALKS_H
#define ABBE_TESTS_VALIDATION_TRACE_WALKS_LIGHT_WALKS_H

#include "tests/scenes/scene_text.h"

#include "tests/random.h"
#include "validation/trace/walks/light_walk.h"

enum { BATCH = ABBE_LIGHT_WALK_BATCH, STEPS = 8 };

#define SLAB(material)                                                                             \
  "- {name: slab, shape: box, size: [0.4, 0.4, 0.1], transform: [{translate: [0, 0, 0.3]}], "      \
  "material: " material "}\n"
#define SHELL                                                                                      \
  "- {name: outer, shape: sphere, radius: 0.1, transform: [{translate: [0, 0, 0.3]}], "            \
  "material: flat}\n"                                                                              \
  "- {name: inner, shape: sphere, radius: 0.05, transform: [{translate: [0, 0, 0.3]}], "           \
  "material: crown}\n"
typedef struct fixture {
  abbe_scene scene;
  abbe_geometry geometry;
  abbe_media media;
  abbe_mirrors mirrors;
  abbe_light_walk *walk;
  abbe_light_ledger ledger;
  abbe_photon photon[BATCH];
  abbe_photon_hit hit[ABBE_LIGHT_WALK_HITS];
  size_t photons, hidden; /* hidden: hits of the last rays that the lamp does not see */
} fixture;

/* Over 500 to 600 nm. */
static inline void make(const char *text, const abbe_physics *physics, fixture *f) {
  static const abbe_physics full = {0};
  double lambda_nm[STEPS + 1];
  memset(f, 0, sizeof *f);
  f->scene = scene_of(text);
  OK(abbe_geometry_make(&f->scene, &f->geometry, &error));
  for (int k = 0; k <= STEPS; k++) lambda_nm[k] = 500 + 100.0 * k / STEPS;
  OK(abbe_media_make(&f->geometry, lambda_nm, STEPS, &f->media, &error));
  OK(abbe_mirrors_make(&f->geometry, lambda_nm, STEPS, &f->mirrors, &error));
  OK(abbe_light_walk_make(&f->geometry, &f->media, &f->mirrors, physics ? physics : &full, 3,
                          &f->walk, &error));
}

static inline void fixture_free(fixture *f) {
  abbe_light_walk_free(f->walk);
  abbe_media_free(&f->media);
  abbe_mirrors_free(&f->mirrors);
  abbe_geometry_free(&f->geometry);
  abbe_scene_free(&f->scene);
}

/* A photon of 1 W from `from` along d, world coordinates. */
static inline abbe_photon photon_of(const fixture *f, const double from[3], const double d[3],
                                    uint32_t id) {
  abbe_photon p = {.flux = 1, .y = 1, .step = id % STEPS, .within = 0.5f, .id = id};
  double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  abbe_geometry_to_frame(&f->geometry, from, p.o);
  for (int k = 0; k < 3; k++) p.d[k] = (float)(d[k] / length);
  return p;
}

/* `batches` of the same ray; returns how many landed. */
static inline size_t shoot(fixture *f, const double from[3], const double d[3], uint32_t batches) {
  size_t landed = 0;
  f->hidden = 0;
  for (uint32_t b = 0; b < batches; b++) {
    for (uint32_t i = 0; i < BATCH; i++) f->photon[i] = photon_of(f, from, d, i);
    size_t count =
        abbe_light_walk_run(f->walk, &f->scene.light[0], b, f->photon, BATCH, f->hit, &f->ledger);
    for (size_t i = 0; i < count; i++) f->hidden += f->hit[i].hidden ? 1 : 0;
    landed += count;
    f->photons += BATCH;
  }
  return landed;
}

/* Four standard deviations of a count with that probability. */
static inline void check_share(double count, double of, double probability) {
  assert_near(count / of, probability, 4 * sqrt(probability * (1 - probability) / of) + 1e-12);
}

/* Photons evenly over the side of a ball or brick that a point light sees. */
static inline void flood(fixture *f, uint32_t batches) {
  uint64_t random = 23;
  for (uint32_t b = 0; b < batches; b++) {
    for (uint32_t i = 0; i < BATCH; i++) {
      double d[3], to[3] = {0, 0, 0.2};
      for (int k = 0; k < 3; k++)
        d[k] = to[k] + random_between(&random, -0.1, 0.1) - f->scene.light[0].position[k];
      f->photon[i] = photon_of(f, f->scene.light[0].position, d, i);
    }
    abbe_light_walk_run(f->walk, &f->scene.light[0], b, f->photon, BATCH, f->hit, &f->ledger);
    f->photons += BATCH;
  }
}

#endif
