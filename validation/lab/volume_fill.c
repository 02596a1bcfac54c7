#include "validation/lab/volume_fill.h"

#include "base/clock.h"
#include "base/maths.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/weights.h"
#include "scenes/volume/half.h"
#include "spectral/wavelengths.h"
#include "validation/lab/exit_fill.h"
#include "validation/lab/volume_sums.h"
#include "validation/trace/transport/random.h"
#include "validation/trace/transport/spectral_sampling.h"
#include "validation/trace/walks/light_walk.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { TASK = 16384, LINES = 1 << 18, SALT = 0x766f6c, LEAST_PASSES = 2 };

/* A thread of the work in progress. */
typedef struct worker {
  struct fill *fill;
  size_t thread;
  abbe_light_walk *walk;
} worker;

/* All that follows light through the object alone. */
typedef struct fill {
  abbe_volume_fill_desc desc;
  abbe_lone_object lone;
  abbe_spectral_sampling sampling;
  abbe_media media;
  abbe_mirrors mirrors;
  float (*colour)[3]; /* [steps] of a watt: XYZ; printed: RGB of equal white */
  float *space;       /* [cells] that is empty */
  worker *worker;     /* [threads] */
  abbe_volume_sums sums;
  abbe_caustic_volume *volume;
  abbe_volume_fill_statistics *statistics;
} fill;

/* ---- the request ---- */

static abbe_result check_counts(const abbe_volume_fill_desc *d, abbe_error *error) {
  if (d->photons > ABBE_VOLUME_FILL_MOST_PHOTONS || d->passes > ABBE_VOLUME_FILL_MOST_PASSES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu photons a pass, %zu passes; at most %u and %d", d->photons,
                          d->passes, ABBE_VOLUME_FILL_MOST_PHOTONS, ABBE_VOLUME_FILL_MOST_PASSES);
  if (d->exits > 0 && d->kind == ABBE_VOLUME_PRINTED)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "exits are rays at nodes: they are not printed");
  return ABBE_OK;
}

static void resolve(const abbe_volume_body *body, double surface, abbe_volume_fill_desc *d) {
  abbe_region_desc *r = &d->region;
  if (d->nodes == 0) d->nodes = body->ball && d->exits == 0 ? 1 : 162;
  if (d->photons == 0) d->photons = 1u << 18;
  if (d->passes == 0) d->passes = 4;
  if (d->until_error > 0 && d->passes < LEAST_PASSES) d->passes = LEAST_PASSES;
  if (d->min_nm == 0) d->min_nm = ABBE_WAVELENGTH_MIN_NM;
  if (d->max_nm == 0) d->max_nm = ABBE_WAVELENGTH_MAX_NM;
  if (d->threads == 0) d->threads = (size_t)omp_get_num_procs();
  if (r->kind == ABBE_REGION_GRID && r->side == 0 && d->exits > 0) {
    r->kind = ABBE_REGION_OCTAHEDRAL;
    r->side = 48;
  } else if (r->kind == ABBE_REGION_GRID && r->side == 0) {
    r->kind = ABBE_REGION_GEODESIC;
    r->levels = 4;
  }
  if (r->kind != ABBE_REGION_GRID && r->shells == 0) r->shells = 24;
  if (r->outer == 0) r->outer = 3 * body->radius;
  if (r->kind != ABBE_REGION_GRID && r->inner == 0)
    r->inner = fmin(fmax(0.98 * surface, 0.05 * body->radius), 0.5 * r->outer);
}

static abbe_result begin(const abbe_scene *scene, fill *f, abbe_error *error) {
  abbe_volume_fill_desc *d = &f->desc;
  abbe_caustic_volume *v = f->volume;
  ABBE_TRY(abbe_lone_object_make(scene, d->object, d->light, &f->lone, error));
  ABBE_TRY(check_counts(d, error));
  v->body = f->lone.body;
  resolve(&v->body, abbe_lone_object_depth(&f->lone), d);
  v->kind = d->exits > 0 ? ABBE_VOLUME_EXITS : d->kind;
  v->min_nm = d->min_nm;
  v->max_nm = d->max_nm;
  ABBE_TRY(abbe_volume_region_make(&d->region, &v->region, error));
  ABBE_TRY(abbe_light_nodes_make(d->nodes, (const double[3]){0, 0, 1}, &v->nodes, error));
  if (d->exits > 0) return ABBE_OK;
  return abbe_caustic_volume_allocate(v, error);
}

/* ---- tables ---- */

static void make_colours(fill *f) {
  double matrix[9], white[3];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, f->sampling.white[0], white);
  for (size_t i = 0; i < f->sampling.steps; i++) {
    double xyz[3], rgb[3];
    for (int k = 0; k < 3; k++) xyz[k] = (double)f->sampling.xyz[i][k];
    abbe_rgb_space_apply(matrix, xyz, rgb);
    for (int k = 0; k < 3; k++)
      f->colour[i][k] =
          f->desc.kind == ABBE_VOLUME_PRINTED ? (float)(rgb[k] / white[k]) : f->sampling.xyz[i][k];
  }
}

static abbe_result make_tables(fill *f, abbe_error *error) {
  const abbe_volume_fill_desc *d = &f->desc;
  const abbe_physics full = {0};
  const abbe_spectral_sampling_desc sampled = {.observer = ABBE_OBSERVER_CIE_1931,
                                               .min_nm = d->min_nm,
                                               .max_nm = d->max_nm,
                                               .uniform = 0.15};
  const abbe_geometry *g = &f->lone.geometry;
  ABBE_TRY(abbe_spectral_sampling_make(&f->lone.scene, &sampled, &f->sampling, error));
  ABBE_TRY(abbe_media_make(g, f->sampling.lambda_nm, f->sampling.steps, &f->media, error));
  ABBE_TRY(abbe_mirrors_make(g, f->sampling.lambda_nm, f->sampling.steps, &f->mirrors, error));
  memcpy(f->volume->white, f->sampling.white[0], sizeof f->volume->white);
  f->colour = calloc(f->sampling.steps, sizeof *f->colour);
  f->space = calloc(f->volume->region.cells, sizeof *f->space);
  f->worker = calloc(d->threads, sizeof *f->worker);
  if (f->colour == NULL || f->space == NULL || f->worker == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a volume's tables");
  make_colours(f);
  for (size_t i = 0; i < d->threads; i++) {
    f->worker[i] = (worker){.fill = f, .thread = i};
    ABBE_TRY(
        abbe_light_walk_make(g, &f->media, &f->mirrors, &full, d->seed, &f->worker[i].walk, error));
  }
  if (d->kind == ABBE_VOLUME_VECTOR)
    ABBE_TRY(abbe_volume_space_measure(g, &f->volume->region, f->lone.place.centre,
                                       f->volume->body.radius, LINES, f->space, error));
  return ABBE_OK;
}

static void free_tables(fill *f) {
  for (size_t i = 0; f->worker != NULL && i < f->desc.threads; i++)
    abbe_light_walk_free(f->worker[i].walk);
  free(f->worker);
  free(f->colour);
  free(f->space);
  abbe_mirrors_free(&f->mirrors);
  abbe_media_free(&f->media);
  abbe_spectral_sampling_free(&f->sampling);
  abbe_lone_object_free(&f->lone);
}

/* ---- photons of a node ---- */

static void take_stretch(void *user, const abbe_light_stretch *s) {
  const worker *w = user;
  if (s->medium >= 0) return;
  const fill *f = w->fill;
  double from[3], along[3];
  float colour[3];
  abbe_geometry_to_world(&f->lone.geometry, s->o, from);
  for (int k = 0; k < 3; k++) {
    from[k] -= f->lone.place.centre[k];
    along[k] = (double)s->d[k];
    colour[k] = s->flux * f->colour[s->step][k];
  }
  abbe_volume_sums_add(&w->fill->sums, w->thread, from, along,
                       (double)s->length * f->lone.geometry.unit, colour);
}

/* The beam's disk around the object: its two axes. */
typedef struct beam {
  double way[3], x[3], y[3], radius;
  uint32_t shift[4], pass;
} beam;

static void make_beam(const fill *f, const double to_light[3], size_t node, size_t pass, beam *b) {
  b->radius = f->volume->body.radius;
  b->pass = (uint32_t)(node * ABBE_VOLUME_FILL_MOST_PASSES + pass);
  for (int k = 0; k < 3; k++) b->way[k] = -to_light[k];
  const double other[3] = {fabs(b->way[0]) < 0.6, fabs(b->way[0]) >= 0.6, 0};
  abbe_vector_cross(b->way, other, b->x);
  abbe_vector_normalise(b->x);
  abbe_vector_cross(b->way, b->x, b->y);
  abbe_random_bits(0, 1, b->pass, f->desc.seed ^ SALT, b->shift);
}

/* Photon j of the beam: place and wavelength are multiples of golden ratios, shifted at random in
 * every pass [Roberts2018]. */
static void start(const fill *f, const beam *b, uint32_t j, abbe_photon *p) {
  static const uint32_t golden[3] = {3915259345u, 3569120481u, 3253582939u};
  double u[2], world[3];
  for (int k = 0; k < 2; k++) u[k] = (double)(j * golden[k] + b->shift[k]) * 0x1p-32;
  const double r = b->radius * sqrt(u[0]), a = 2 * ABBE_PI * u[1];
  for (int k = 0; k < 3; k++)
    world[k] = f->lone.place.centre[k] + r * (cos(a) * b->x[k] + sin(a) * b->y[k]) -
               2 * b->radius * b->way[k];
  abbe_geometry_to_frame(&f->lone.geometry, world, p->o);
  for (int k = 0; k < 3; k++) p->d[k] = (float)b->way[k];
  p->step = abbe_spectral_sampling_step(j * golden[2] + b->shift[2], &p->within);
  p->flux = (float)(ABBE_PI * b->radius * b->radius / (double)f->desc.photons);
  p->y = f->sampling.xyz[p->step][1];
  p->id = j;
}

static void run_task(const fill *f, const beam *b, uint32_t from, worker *w,
                     abbe_light_ledger *ledger) {
  abbe_light_walk_room *room = abbe_light_walk_get_room(w->walk);
  const uint32_t left = (uint32_t)f->desc.photons - from, to = from + (left < TASK ? left : TASK);
  abbe_light_walk_for_map(w->walk, false);
  abbe_light_walk_watch(w->walk, take_stretch, w);
  for (uint32_t j = from; j < to; j += ABBE_LIGHT_WALK_BATCH) {
    const uint32_t count = to - j < ABBE_LIGHT_WALK_BATCH ? to - j : ABBE_LIGHT_WALK_BATCH;
    for (uint32_t i = 0; i < count; i++) start(f, b, j + i, &room->photon[i]);
    abbe_light_walk_run(w->walk, NULL, b->pass, room->photon, count, room->hit, ledger);
  }
}

static bool is_stopped(const fill *f) {
  return f->desc.stop != NULL && *f->desc.stop;
}

static void add_ledger(const abbe_light_ledger *from, double share, abbe_light_ledger *to) {
  const double *part = &from->reached;
  for (size_t i = 0; i < sizeof *from / sizeof *part; i++) (&to->reached)[i] += share * part[i];
}

static abbe_result run_pass(fill *f, const double to_light[3], size_t node, size_t pass,
                            abbe_light_ledger *ledger, abbe_error *error) {
  const size_t tasks = (f->desc.photons + TASK - 1) / TASK;
  abbe_light_ledger *part = calloc(tasks, sizeof *part);
  if (part == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu tasks", tasks);
  beam b;
  make_beam(f, to_light, node, pass, &b);
#pragma omp parallel for schedule(dynamic) num_threads((int)f->desc.threads)
  for (size_t i = 0; i < tasks; i++)
    if (!is_stopped(f))
      run_task(f, &b, (uint32_t)(i * TASK), &f->worker[omp_get_thread_num()], &part[i]);
  for (size_t i = 0; i < tasks; i++) add_ledger(&part[i], 1, ledger);
  free(part);
  abbe_accumulator_end_pass(&f->sums.sums);
  f->statistics->photons += f->desc.photons;
  f->statistics->passes++;
  return is_stopped(f) ? abbe_error_set(error, ABBE_CANCELLED, "stopped") : ABBE_OK;
}

/* ---- a node's values ---- */

static void note_outflow(fill *f, const abbe_light_ledger *ledger) {
  const abbe_volume_region *r = &f->volume->region;
  const double left = ledger->missed + ledger->deposited;
  if (r->desc.kind == ABBE_REGION_GRID || f->sums.printed || !(left > 0)) return;
  double *range = f->statistics->outflow;
  for (size_t shell = 0; shell < r->rows; shell++) {
    if (r->radius[shell] < f->volume->body.radius) continue;
    const double share = abbe_volume_sums_outflow(&f->sums, shell) / left;
    if (range[1] == 0) range[0] = range[1] = share;
    range[0] = fmin(range[0], share);
    range[1] = fmax(range[1], share);
  }
}

/* Printed: the byte whose 255 stands for the light that one lit cell in a thousand exceeds. */
static double find_byte(const fill *f, double *sorted, int (*order)(const void *, const void *)) {
  size_t lit = 0;
  for (size_t i = 0; i < f->sums.sums.values; i++) {
    const double x = abbe_accumulator_mean(&f->sums.sums, i);
    if (x > 0) sorted[lit++] = x;
  }
  qsort(sorted, lit, sizeof *sorted, order);
  return lit > 0 ? sorted[lit - 1 - lit / 1000] / 255 : 0;
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

static abbe_result store(fill *f, size_t node, abbe_error *error) {
  abbe_caustic_volume *v = f->volume;
  const size_t count = f->sums.sums.values;
  const bool printed = v->kind == ABBE_VOLUME_PRINTED;
  if (printed && node == 0) { /* one byte for all nodes */
    double *sorted = malloc(count * sizeof *sorted);
    if (sorted == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for bytes");
    v->byte = find_byte(f, sorted, by_size);
    if (!(v->byte > 0)) v->byte = 1.0 / 255;
    free(sorted);
  }
  for (size_t i = 0; i < count; i++) {
    const double x = abbe_accumulator_mean(&f->sums.sums, i);
    v->value[node * count + i] =
        abbe_half_of(printed ? fmin(fmax(nearbyint(x / v->byte), 0), 255) : x);
  }
  return ABBE_OK;
}

static abbe_result fill_node(fill *f, size_t node, abbe_error *error) {
  const abbe_volume_fill_desc *d = &f->desc;
  const double *to_light = f->volume->nodes.direction[node];
  const double beam_way[3] = {-to_light[0], -to_light[1], -to_light[2]};
  abbe_light_ledger ledger = {0};
  abbe_result result = abbe_volume_sums_make(&f->volume->region, d->kind == ABBE_VOLUME_PRINTED,
                                             f->space, beam_way, d->threads, &f->sums, error);
  size_t pass = 0;
  for (bool more = true; result == ABBE_OK && more; pass++) {
    result = run_pass(f, to_light, node, pass, &ledger, error);
    const size_t done = pass + 1;
    more = done < d->passes || (d->until_error > 0 && done < ABBE_VOLUME_FILL_MOST_PASSES &&
                                abbe_volume_sums_relative_error(&f->sums) > d->until_error);
    const double within = fmin((double)done / (double)d->passes, 1);
    if (result == ABBE_OK && d->progress != NULL &&
        !d->progress(d->user, ((double)node + within) / (double)f->volume->nodes.count))
      result = abbe_error_set(error, ABBE_CANCELLED, "stopped");
  }
  if (result == ABBE_OK) {
    abbe_light_ledger mean = {0};
    add_ledger(&ledger, 1 / (double)pass, &mean);
    add_ledger(&mean, 1 / (double)f->volume->nodes.count, &f->statistics->ledger);
    note_outflow(f, &mean);
    const double e = abbe_volume_sums_relative_error(&f->sums);
    f->statistics->error += isfinite(e) ? e * e : 0;
    result = store(f, node, error);
  }
  abbe_volume_sums_free(&f->sums);
  return result;
}

/* Rays in place of sums. */
static abbe_result fill_exits(fill *f, abbe_error *error) {
  const abbe_volume_fill_desc *d = &f->desc;
  const abbe_exit_fill_desc desc = {.points = d->exits,
                                    .asymmetric = d->asymmetric,
                                    .min_nm = d->min_nm,
                                    .max_nm = d->max_nm,
                                    .seed = d->seed,
                                    .threads = d->threads,
                                    .progress = d->progress,
                                    .user = d->user,
                                    .stop = d->stop,
                                    .checkpoint = d->checkpoint,
                                    .checkpoint_s = d->checkpoint_s,
                                    .resume = d->resume};
  abbe_exit_fill_statistics done;
  abbe_weights_white(ABBE_OBSERVER_CIE_1931, &f->lone.light.illuminant, d->min_nm, d->max_nm,
                     f->volume->white);
  ABBE_TRY(abbe_exit_fill(&f->lone, &desc, f->volume, &done, error));
  f->statistics->photons = done.rays;
  f->statistics->carried = done.carried;
  f->statistics->alone = done.alone;
  f->statistics->sequences = done.sequences;
  f->statistics->maps = done.maps;
  return ABBE_OK;
}

/* A key of all that decides what a node's values are. */
static uint64_t key_of(const fill *f) {
  const abbe_volume_fill_desc *d = &f->desc;
  const abbe_region_desc *r = &f->volume->region.desc;
  const double numbers[] = {(double)f->volume->kind,
                            (double)f->volume->nodes.count,
                            (double)d->photons,
                            (double)d->passes,
                            d->until_error,
                            (double)d->seed,
                            (double)r->kind,
                            (double)r->side,
                            (double)r->levels,
                            (double)r->shells,
                            r->inner,
                            r->outer,
                            d->min_nm,
                            d->max_nm};
  uint64_t h = abbe_lone_object_key(&f->lone, &f->media, &f->mirrors, ABBE_VOLUME_KEY);
  h = abbe_volume_key(h, numbers, sizeof numbers);
  return abbe_volume_key(h, f->colour, f->sampling.steps * sizeof *f->colour);
}

/* Whether so many nodes can have left that. What others left is made anew. */
static bool holds(const void *user, size_t nodes) {
  const fill *f = user;
  const abbe_caustic_volume *v = f->volume;
  const abbe_volume_fill_statistics *s = f->statistics;
  const bool printed = v->kind == ABBE_VOLUME_PRINTED;
  const size_t most = f->desc.until_error > 0 ? ABBE_VOLUME_FILL_MOST_PASSES : f->desc.passes;
  const size_t values = nodes * v->region.cells * abbe_caustic_volume_channels(v);
  double sum = s->error + s->outflow[0] + s->outflow[1] + v->byte;
  for (size_t i = 0; i < sizeof s->ledger / sizeof(double); i++) sum += (&s->ledger.reached)[i];
  if (!isfinite(sum) || s->error < 0 || v->byte < 0 || (printed && nodes > 0 && !(v->byte > 0)) ||
      s->passes < nodes * f->desc.passes || s->passes > nodes * most ||
      s->photons != s->passes * f->desc.photons)
    return false;
  for (size_t i = 0; i < values; i++) {
    const double x = abbe_half_value(v->value[i]);
    if (!abbe_half_is_finite(v->value[i]) || (printed && !(x >= 0 && x <= 255 && !(x > floor(x)))))
      return false;
  }
  return true;
}

static abbe_result fill_nodes(fill *f, abbe_error *error) {
  const abbe_volume_fill_desc *d = &f->desc;
  abbe_caustic_volume *v = f->volume;
  const size_t values = v->nodes.count * v->region.cells * abbe_caustic_volume_channels(v);
  size_t node = 0;
  abbe_volume_keeping keeping = {.path = d->checkpoint,
                                 .every_s = d->checkpoint_s,
                                 .resume = d->resume,
                                 .key = key_of(f),
                                 .part = {{v->value, values * sizeof *v->value},
                                          {&v->byte, sizeof v->byte},
                                          {f->statistics, sizeof *f->statistics}},
                                 .parts = 3,
                                 .nodes = v->nodes.count,
                                 .holds = holds,
                                 .user = f,
                                 .stop = d->stop};
  abbe_result result = abbe_volume_keeping_begin(&keeping, &node, error);
  for (; result == ABBE_OK && node < v->nodes.count; node++) {
    const abbe_volume_fill_statistics before = *f->statistics;
    result = fill_node(f, node, error);
    if (result == ABBE_OK) result = abbe_volume_keeping_end_node(&keeping, node + 1, false, error);
    if (result != ABBE_CANCELLED) continue;
    *f->statistics = before; /* the node that was stopped is begun anew */
    abbe_volume_keeping_end_node(&keeping, node, true, NULL);
  }
  return result;
}

/* Sums at all nodes, and what becomes of them. */
static abbe_result fill_values(fill *f, abbe_error *error) {
  abbe_volume_fill_statistics *s = f->statistics;
  abbe_caustic_volume *v = f->volume;
  abbe_result result = make_tables(f, error);
  if (result == ABBE_OK) result = fill_nodes(f, error);
  s->error = result == ABBE_OK && s->passes >= LEAST_PASSES * v->nodes.count
                 ? sqrt(s->error / (double)v->nodes.count)
                 : NAN;
  if (!isnan(s->error)) v->error = s->error;
  return result;
}

abbe_result abbe_volume_fill(const abbe_scene *scene, const abbe_volume_fill_desc *desc,
                             abbe_caustic_volume *out, abbe_volume_fill_statistics *statistics,
                             abbe_error *error) {
  *out = (abbe_caustic_volume){0};
  *statistics = (abbe_volume_fill_statistics){0};
  fill *f = calloc(1, sizeof *f);
  if (f == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a volume");
  f->desc = *desc;
  f->volume = out;
  f->statistics = statistics;
  abbe_result result = begin(scene, f, error);
  const double from = abbe_clock_seconds();
  if (result == ABBE_OK) result = desc->exits > 0 ? fill_exits(f, error) : fill_values(f, error);
  statistics->seconds = abbe_clock_seconds() - from;
  free_tables(f);
  free(f);
  if (result != ABBE_OK) abbe_caustic_volume_free(out);
  return result;
}
