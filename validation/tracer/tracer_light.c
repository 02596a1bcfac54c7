#include "validation/tracer/tracer_state.h"

#include "scenes/geometry/vector.h"
#include "validation/transport/random.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TASK = 16384, TRIALS = 65536, PART_TRIALS = 16384, SALT = 0x6c6967 };

/* The photons of one light in one pass, cell after cell: cell i has those from first[i] on. */
typedef struct emission {
  const abbe_tracer *t;
  size_t light, count;
  uint32_t *first; /* [cells + 1] */
  uint32_t pass, seed;
} emission;

static abbe_result share_over_cells(const abbe_tracer *t, size_t light, size_t count, uint32_t pass,
                                    uint32_t seed, emission *e, abbe_error *error) {
  const abbe_aim *aim = &t->aim[light];
  *e = (emission){.t = t,
                  .light = light,
                  .count = aim->count > 0 ? count : 0,
                  .pass = pass,
                  .seed = seed ^ SALT};
  e->first = malloc((aim->count + 1) * sizeof *e->first);
  if (e->first == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for photons");
  float random[4];
  abbe_random4((uint32_t)light, 0, pass, e->seed, random);
  /* every cell gets its share, rounded up or down so that the mean is right */
  double sum = 0, shift = (double)random[0];
  for (size_t i = 0; i < aim->count; i++) {
    e->first[i] = (uint32_t)floor(sum * (double)e->count + shift);
    sum += (double)aim->cell[i].share;
  }
  e->first[aim->count] = (uint32_t)e->count;
  e->first[0] = 0;
  for (size_t i = aim->count; i > 0 && e->first[i - 1] > e->first[i]; i--)
    e->first[i - 1] = e->first[i];
  return ABBE_OK;
}

static size_t cell_of(const emission *e, uint32_t photon) {
  size_t low = 0, high = e->t->aim[e->light].count;
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

/* Photons [from, to) of the light. Along the curve the wavelengths are the fractional parts of
 * multiples of the golden ratio, shifted at random: every patch of neighbours has them all. */
static size_t emit(const emission *e, uint32_t from, uint32_t to, abbe_photon *photon) {
  const abbe_aim *aim = &e->t->aim[e->light];
  const uint32_t golden = 2654435769u;
  const float(*xyz)[3] = (const float(*)[3])e->t->sampling.xyz + e->light * e->t->sampling.steps;
  uint32_t shift[4], light = (uint32_t)e->light + 1, seed = e->seed;
  size_t cell = cell_of(e, from);
  abbe_random_bits(0, light, e->pass, seed, shift);
  for (uint32_t j = from; j < to; j++) {
    while (cell + 1 < aim->count && e->first[cell + 1] <= j) cell++;
    float random[4], at[2];
    abbe_random4(j, light, e->pass, seed, random);
    place_in_cell(j - e->first[cell], e->first[cell + 1] - e->first[cell], random[0], at);
    abbe_photon *p = photon++;
    float flux = abbe_aim_ray(aim, &aim->cell[cell], at, random + 1, p->o, p->d);
    p->flux = flux / ((float)e->count * aim->cell[cell].share);
    p->step = abbe_spectral_sampling_step(abbe_random_float(j * golden + shift[0]), &p->within);
    p->y = xyz[p->step][1];
    p->id = j | (uint32_t)e->light << 27;
  }
  return to - from;
}

/* ---- landings ---- */

typedef struct sink {
  abbe_tracer *t;
  size_t thread, light;
} sink;

static void add_to_map(const sink *s, const abbe_landing *l) {
  abbe_tracer *t = s->t;
  if (t->desc.no_map || s->light != t->desc.map_light || l->hidden) return;
  double p[3];
  size_t column, row;
  abbe_geometry_to_world(&t->geometry, l->p, p);
  if (!abbe_map_layout_texel(&t->layout, t->desc.map_width, t->desc.map_height, p, &column, &row))
    return;
  size_t at = (row * t->desc.map_width + column) * t->map_channels;
  const float *xyz = t->sampling.xyz[s->light * t->sampling.steps + l->step];
  for (size_t k = 0; k < 3; k++) abbe_accumulator_add(&t->map, s->thread, at + k, l->flux * xyz[k]);
  if (t->bands.count > 0)
    abbe_accumulator_add(&t->map, s->thread, at + 3 + t->bands.of_step[l->step],
                         l->flux * t->sampling.power[s->light * t->sampling.steps + l->step] /
                             (float)t->bands.width_nm);
}

/* What a landing adds to the pixel that sees it straight. */
typedef struct splat {
  const abbe_landing *landing;
  size_t pixel;
  float value; /* radiance of the pixel, for a reflectance of pi */
} splat;

/* The ray from the landing to the eye in lane k of the packet; false where it cannot be seen. */
static bool prepare_splat(const abbe_tracer *t, const abbe_landing *l, struct RTCRay16 *packet,
                          size_t k, splat *out) {
  float d[3], distance, per_pixel, o[3];
  size_t pixel;
  if (!abbe_trace_camera_pixel(&t->camera, l->p, &pixel, &distance, d, &per_pixel)) return false;
  abbe_hit hit;
  for (int i = 0; i < 3; i++) d[i] = -d[i];
  abbe_geometry_place(&t->geometry.surface[l->surface], l->face, l->u, l->v, l->p, d, 0, &hit);
  float facing = d[0] * hit.ng[0] + d[1] * hit.ng[1] + d[2] * hit.ng[2];
  if (facing * l->side <= 0) return false;
  float metres = distance * (float)t->geometry.unit;
  *out = (splat){.landing = l,
                 .pixel = pixel,
                 .value = l->flux * fabsf(facing) * per_pixel / (metres * metres)};
  abbe_geometry_leave(&hit, d, o);
  packet->org_x[k] = o[0];
  packet->org_y[k] = o[1];
  packet->org_z[k] = o[2];
  packet->dir_x[k] = d[0];
  packet->dir_y[k] = d[1];
  packet->dir_z[k] = d[2];
  packet->tnear[k] = 0;
  packet->tfar[k] = distance;
  packet->mask[k] = ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS;
  packet->flags[k] = 0;
  return true;
}

static void add_splat(const sink *s, const splat *p) {
  abbe_tracer *t = s->t;
  const abbe_landing *l = p->landing;
  float rgb[3];
  abbe_reflectance_at(&t->reflectance, l->surface, l->face, l->u, l->v, rgb);
  size_t colour = s->light * t->sampling.steps + l->step, at = p->pixel * t->picture_channels;
  float value = p->value * 0.318309886f, seen[3];
  for (size_t k = 0; k < 3; k++) rgb[k] *= value * t->colour[colour][k];
  abbe_tracer_finish(t, rgb, seen);
  for (size_t k = 0; k < 3; k++) {
    abbe_accumulator_add(&t->picture, s->thread, at + ABBE_TRACER_RGB + k, seen[k]);
    abbe_accumulator_add(&t->picture, s->thread, at + ABBE_TRACER_CAUSTIC + k, seen[k]);
  }
  if (t->bands.count == 0) return;
  abbe_reflectance_rec709(&t->reflectance, l->surface, l->face, l->u, l->v, rgb);
  size_t band = t->bands.of_step[l->step];
  float kept = abbe_reflectance_band(rgb, t->bands.middle_nm[band]);
  abbe_accumulator_add(&t->picture, s->thread, at + ABBE_TRACER_BANDS + band,
                       value * kept * t->sampling.power[colour] / (float)t->bands.width_nm);
}

static uint64_t flush_splats(const sink *s, struct RTCRay16 *packet, const splat *splats,
                             size_t count) {
  if (count == 0) return 0;
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  _Alignas(64) int valid[16];
  for (size_t k = 0; k < 16; k++) valid[k] = k < count ? -1 : 0;
  rtcOccluded16(valid, s->t->geometry.embree, &context, packet);
  for (size_t k = 0; k < count; k++)
    if (!(packet->tfar[k] < 0)) add_splat(s, &splats[k]);
  return count;
}

static uint64_t add_to_picture(const sink *s, const abbe_landing *landing, size_t count) {
  if (s->t->desc.no_picture) return 0;
  struct RTCRay16 packet;
  memset(&packet, 0, sizeof packet);
  splat splats[16];
  size_t waiting = 0;
  uint64_t rays = 0;
  for (size_t i = 0; i < count; i++) {
    waiting += prepare_splat(s->t, &landing[i], &packet, waiting, &splats[waiting]);
    if (waiting < 16) continue;
    rays += flush_splats(s, &packet, splats, waiting);
    waiting = 0;
  }
  return rays + flush_splats(s, &packet, splats, waiting);
}

/* ---- tasks ---- */

typedef struct task_result {
  abbe_light_ledger ledger;
  uint64_t splat_rays;
  size_t kept; /* landings for the eye's gathers, from the task's first photon on */
} task_result;

static void run_task(const emission *e, uint32_t from, uint32_t to, size_t thread,
                     abbe_grid_photon *keep, task_result *out) {
  abbe_tracer *t = (abbe_tracer *)e->t;
  abbe_light_walk_room *room = abbe_light_walk_get_room(t->walk[thread]);
  abbe_photon *photon = room->photon;
  abbe_landing *landing = room->landing;
  sink s = {.t = t, .thread = thread, .light = e->light};
  *out = (task_result){0};
  abbe_light_walk_part(t->walk[thread], t->parts[e->light]);
  for (uint32_t j = from; j < to; j += ABBE_LIGHT_WALK_BATCH) {
    uint32_t end = to - j < ABBE_LIGHT_WALK_BATCH ? to : j + ABBE_LIGHT_WALK_BATCH;
    size_t count = emit(e, j, end, photon);
    size_t landed = abbe_light_walk_run(t->walk[thread], &t->scene->light[e->light], e->pass,
                                        photon, count, landing, &out->ledger);
    for (size_t i = 0; i < landed; i++) add_to_map(&s, &landing[i]);
    out->splat_rays += add_to_picture(&s, landing, landed);
    for (size_t i = 0; keep != NULL && i < landed; i++) {
      const abbe_landing *l = &landing[i];
      abbe_grid_photon *g = &keep[out->kept++];
      *g = (abbe_grid_photon){.flux = l->side * l->flux,
                              .surface = l->surface,
                              .colour = (uint32_t)(e->light * t->sampling.steps) + l->step};
      memcpy(g->p, l->p, sizeof g->p);
    }
  }
}

static void add_ledger(abbe_light_ledger *to, const abbe_light_ledger *from) {
  to->reached += from->reached;
  to->landed += from->landed;
  to->contact += from->contact;
  to->hidden += from->hidden;
  to->absorbed += from->absorbed;
  to->escaped += from->escaped;
  to->dropped += from->dropped;
  to->lost += from->lost;
}

/* The tasks of one light; results are joined in the order of the tasks, whoever did them. */
static abbe_result run_light(abbe_tracer *t, const emission *e, const volatile int *stop,
                             size_t *landed, abbe_error *error) {
  size_t tasks = (e->count + TASK - 1) / TASK;
  task_result *result = calloc(tasks + 1, sizeof *result);
  if (result == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu tasks", tasks);
  size_t base = *landed;
  bool keeps = t->eye_gathers;
#pragma omp parallel for schedule(dynamic) num_threads((int)t->desc.threads)
  for (size_t i = 0; i < tasks; i++) {
    if (stop != NULL && *stop) continue;
    uint32_t from = (uint32_t)(i * TASK);
    uint32_t to = (uint32_t)(e->count - from < TASK ? e->count : from + TASK);
    run_task(e, from, to, (size_t)omp_get_thread_num(),
             keeps ? t->landed + base + abbe_tracer_most_landings(t, e->light, from) : NULL,
             &result[i]);
  }
  for (size_t i = 0; i < tasks; i++) {
    add_ledger(&t->statistics.ledger, &result[i].ledger);
    t->statistics.light_rays += result[i].splat_rays;
    if (keeps && result[i].kept > 0)
      memmove(t->landed + *landed,
              t->landed + base + abbe_tracer_most_landings(t, e->light, i * TASK),
              result[i].kept * sizeof *t->landed);
    *landed += result[i].kept;
  }
  t->statistics.photons += e->count;
  free(result);
  return stop != NULL && *stop ? abbe_error_set(error, ABBE_CANCELLED, "stopped") : ABBE_OK;
}

abbe_result abbe_tracer_light_pass(abbe_tracer *t, const volatile int *stop, size_t *landed_count,
                                   abbe_error *error) {
  *landed_count = 0;
  abbe_result result = ABBE_OK;
  for (size_t l = 0; l < t->scene->light_count && result == ABBE_OK; l++) {
    if (t->photons[l] == 0) continue;
    emission e;
    result = share_over_cells(t, l, t->photons[l], (uint32_t)t->pass, t->desc.seed, &e, error);
    if (result == ABBE_OK) result = run_light(t, &e, stop, landed_count, error);
    free(e.first);
  }
  return result;
}

abbe_result abbe_tracer_share_photons(abbe_tracer *t, abbe_error *error) {
  double total = 0;
  for (size_t l = 0; l < t->scene->light_count; l++) {
    bool wanted = !t->desc.no_picture || l == t->desc.map_light;
    abbe_result result = wanted ? abbe_aim_make(&t->geometry, l, &t->aim[l], error) : ABBE_OK;
    if (result != ABBE_OK) return result;
    total += t->aim[l].reach;
  }
  for (size_t l = 0; l < t->scene->light_count && total > 0; l++) {
    if (t->aim[l].count == 0 || !(t->aim[l].reach > 0)) continue;
    t->photons[l] = (size_t)((double)t->desc.photons * t->aim[l].reach / total);
    /* a faint light still needs enough of them to show where it goes */
    if (t->photons[l] < t->desc.photons / 16) t->photons[l] = t->desc.photons / 16;
    if (t->photons[l] < 64) t->photons[l] = 64;
  }
  return ABBE_OK;
}

/* The trial's photons, followed without parting. */
static size_t land_trial(const abbe_tracer *t, const emission *e, abbe_landing *landing) {
  abbe_photon *photon = abbe_light_walk_get_room(t->walk[0])->photon;
  abbe_light_ledger ledger = {0};
  size_t landed = 0;
  abbe_light_walk_part(t->walk[0], 0);
  for (uint32_t j = 0; j < e->count; j += ABBE_LIGHT_WALK_BATCH) {
    uint32_t end =
        e->count - j < ABBE_LIGHT_WALK_BATCH ? (uint32_t)e->count : j + ABBE_LIGHT_WALK_BATCH;
    size_t count = emit(e, j, end, photon);
    landed += abbe_light_walk_run(t->walk[0], &t->scene->light[e->light], e->pass, photon, count,
                                  landing + landed, &ledger);
  }
  return landed;
}

abbe_result abbe_tracer_choose_parts(abbe_tracer *t, abbe_error *error) {
  abbe_landing *landing = malloc(PART_TRIALS * sizeof *landing);
  abbe_result result =
      landing != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a trial");
  for (size_t l = 0; l < t->scene->light_count && result == ABBE_OK; l++) {
    if (t->photons[l] == 0) continue;
    emission e;
    result = share_over_cells(t, l, PART_TRIALS, 0, t->desc.seed, &e, error);
    if (result == ABBE_OK)
      t->parts[l] = abbe_light_walk_best_parts(landing, land_trial(t, &e, landing));
    free(e.first);
  }
  free(landing);
  return result;
}

/* ---- rates ---- */

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Photons emitted, followed, and sorted into texels, by one thread. */
static double walk_seconds(abbe_tracer *t, const emission *e) {
  abbe_light_walk_room *room = abbe_light_walk_get_room(t->walk[0]);
  abbe_photon *photon = room->photon;
  abbe_landing *landing = room->landing;
  abbe_light_ledger ledger = {0};
  sink s = {.t = t, .light = e->light};
  double start = now();
  for (uint32_t j = 0; j < e->count; j += ABBE_LIGHT_WALK_BATCH) {
    uint32_t end =
        e->count - j < ABBE_LIGHT_WALK_BATCH ? (uint32_t)e->count : j + ABBE_LIGHT_WALK_BATCH;
    size_t count = emit(e, j, end, photon);
    size_t landed = abbe_light_walk_run(t->walk[0], &t->scene->light[e->light], e->pass, photon,
                                        count, landing, &ledger);
    for (size_t i = 0; i < landed; i++) add_to_map(&s, &landing[i]);
  }
  double end = now();
  if (!t->desc.no_map) abbe_accumulator_drop_pass(&t->map);
  return end - start;
}

/* The best of a few turns of each, in turn, so that a busy machine harms neither more. */
abbe_result abbe_tracer_rates(abbe_tracer *t, double *walk, double *embree, abbe_error *error) {
  ABBE_REQUIRE(t && walk && embree, error);
  enum { TURNS = 5, PHOTONS = 131072, PACKETS = 65536 };
  *walk = *embree = 0;
  size_t light = 0;
  while (light < t->scene->light_count && t->aim[light].count == 0) light++;
  if (light == t->scene->light_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no light reaches a refractor, so there is no walk to time");
  emission e = {0};
  abbe_result result = share_over_cells(t, light, PHOTONS, 0, t->desc.seed, &e, error);
  for (int i = 0; i < TURNS && result == ABBE_OK; i++) {
    uint64_t rays = abbe_light_walk_rays(t->walk[0]), replayed;
    double seconds = walk_seconds(t, &e), alone;
    *walk = fmax(*walk, (double)(abbe_light_walk_rays(t->walk[0]) - rays) / seconds);
    abbe_light_walk_keep(t->walk[0], PACKETS);
    walk_seconds(t, &e);
    if (abbe_light_walk_replay(t->walk[0], &alone, &replayed))
      *embree = fmax(*embree, (double)replayed / alone);
    abbe_light_walk_keep(t->walk[0], 0);
  }
  t->other_rays = abbe_tracer_walk_rays(t);
  free(e.first);
  return result;
}

/* ---- the map's layout ---- */

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Window coordinates of trial landings, along right (0) and up (1); their number. */
static size_t try_landings(const abbe_tracer *t, abbe_light_walk *walk, const abbe_view *view,
                           const emission *e, double *at[2], double *near, double *far) {
  abbe_light_walk_room *room = abbe_light_walk_get_room(walk);
  abbe_photon *photon = room->photon;
  abbe_landing *landing = room->landing;
  abbe_light_ledger ledger = {0};
  size_t found = 0;
  for (uint32_t j = 0; j < e->count; j += ABBE_LIGHT_WALK_BATCH) {
    uint32_t end =
        j + ABBE_LIGHT_WALK_BATCH < e->count ? j + ABBE_LIGHT_WALK_BATCH : (uint32_t)e->count;
    size_t count = emit(e, j, end, photon);
    size_t landed = abbe_light_walk_run(walk, &t->scene->light[e->light], e->pass, photon, count,
                                        landing, &ledger);
    for (size_t i = 0; i < landed; i++) {
      double p[3], from[3], z;
      if (landing[i].hidden) continue;
      abbe_geometry_to_world(&t->geometry, landing[i].p, p);
      abbe_vector_subtract(p, view->origin, from);
      z = abbe_vector_dot(from, view->forward);
      double scale = view->orthographic ? 1 : z;
      if (!(z > 0)) continue;
      double x = abbe_vector_dot(from, view->right) / scale;
      double y = abbe_vector_dot(from, view->up) / scale;
      if (!view->orthographic && fmax(fabs(x), fabs(y)) > ABBE_VIEW_MAX_TANGENT) continue;
      at[0][found] = x;
      at[1][found++] = y;
      *near = fmin(*near, z);
      *far = fmax(*far, z);
    }
  }
  return found;
}

abbe_result abbe_tracer_fit_layout(abbe_tracer *t, abbe_error *error) {
  const abbe_light *light = &t->scene->light[t->desc.map_light];
  const abbe_aim *aim = &t->aim[t->desc.map_light];
  bool parallel = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double origin[3], way[3], up[3] = {0, 0, 1};
  abbe_geometry_to_world(&t->geometry, aim->origin, origin);
  for (int k = 0; k < 3; k++) way[k] = (double)aim->way[k];
  /* From the very place of the light: the renderer takes a map of no other. */
  memcpy(parallel ? way : origin, parallel ? light->direction : light->position, sizeof way);
  abbe_view view;
  abbe_view_look(origin, way, up, parallel, &view);
  double middle[3];
  memcpy(middle, t->geometry.origin, sizeof middle);
  abbe_view_fit(&view, (const double(*)[3]) & middle, 1);
  double *at[2] = {malloc(TRIALS * sizeof **at), malloc(TRIALS * sizeof **at)};
  emission e = {0};
  abbe_light_walk *walk = NULL;
  /* no seed but this one: maps of other seeds are to have the same layout */
  abbe_result result = share_over_cells(t, t->desc.map_light, TRIALS, 0, 0, &e, error);
  if (result == ABBE_OK)
    result = abbe_light_walk_make(&t->geometry, &t->media, &t->desc.physics, 0, &walk, error);
  if (result == ABBE_OK && (at[0] == NULL || at[1] == NULL))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for trial photons");
  if (result == ABBE_OK) {
    double near = view.near, far = view.far;
    size_t found = try_landings(t, walk, &view, &e, at, &near, &far);
    for (int k = 0; k < 2 && found > 0; k++) {
      qsort(at[k], found, sizeof *at[k], by_value);
      view.window[2 * k] = at[k][found / 1000];
      view.window[2 * k + 1] = at[k][found - 1 - found / 1000];
    }
    view.near = near;
    view.far = far;
    abbe_view_pad(&view, 0.05);
    abbe_map_layout_make(&view, &t->layout);
    result = abbe_map_layout_check(&t->layout, error);
  }
  abbe_light_walk_free(walk);
  free(e.first);
  free(at[0]);
  free(at[1]);
  return result;
}
