#include "validation/trace/tracer/light_pass.h"

#include "base/maths.h"
#include "validation/trace/tracer/tracer_state.h"
#include "validation/trace/transport/random.h"
#include "validation/trace/walks/light_walk.h"

#include <omp.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { TEXEL_LANES = ABBE_MAP_TEXELS_LANES, STEPS = ABBE_MAP_LAYOUT_STEPS };

/* Window coordinates; below 0 where the map does not hold the place. */
SIDE_BY_SIDE static void project(const abbe_view *view, const abbe_map_texels *t,
                                 double window[2][TEXEL_LANES]) {
  const abbe_view v = *view;
  const double width = v.window[1] - v.window[0], height = v.window[3] - v.window[2];
  const int parallel = v.orthographic;
  for (int k = 0; k < TEXEL_LANES; k++) {
    const double x = t->p[0][k] - v.origin[0], y = t->p[1][k] - v.origin[1],
                 z = t->p[2][k] - v.origin[2];
    const double depth = x * v.forward[0] + y * v.forward[1] + z * v.forward[2];
    const double scale = parallel ? 1 : depth;
    const double right = (x * v.right[0] + y * v.right[1] + z * v.right[2]) / scale;
    const double up = (x * v.up[0] + y * v.up[1] + z * v.up[2]) / scale;
    const double a = (right - v.window[0]) / width, b = (up - v.window[2]) / height;
    const bool inside = (scale > 0) & (a >= 0) & (a <= 1) & (b >= 0) & (b <= 1);
    window[0][k] = inside ? a : -1;
    window[1][k] = b;
  }
}

/* The texel along an axis of so many, of a window coordinate in [0, 1]. */
static inline size_t texel_at(const double *knot, double window, size_t side) {
  const double s = window * STEPS;
  const int k = s < STEPS ? (int)s : STEPS - 1;
  const double at = (knot[k] + (s - k) * (knot[k + 1] - knot[k])) * (double)side;
  return at < (double)side ? (size_t)at : side - 1;
}

void abbe_map_texels_find(const abbe_map_layout *layout, size_t width, size_t height,
                          abbe_map_texels *t) {
  double window[2][TEXEL_LANES];
  project(&layout->view, t, window);
  for (int k = 0; k < TEXEL_LANES; k++) {
    t->at[k] = ABBE_MAP_TEXELS_NONE;
    if (!(window[0][k] >= 0)) continue;
    const size_t column = texel_at(layout->knot[0], window[0][k], width);
    const size_t row = height - 1 - texel_at(layout->knot[1], window[1][k], height);
    t->at[k] = row * width + column;
  }
}

enum { TASK = 16384, SPLIT_TRIALS = 16384 };

/* ---- where photons land ---- */

typedef struct sink {
  abbe_tracer *t;
  size_t thread, light;
} sink;

/* The number of a step of the light's, or of its glow's, colours. */
static size_t colour_of(const abbe_tracer *t, size_t light, bool glows, uint32_t step) {
  return (light + (glows ? t->sampling.lights : 0)) * t->sampling.steps + step;
}

static void add_to_texel(abbe_tracer *t, size_t thread, size_t light, const abbe_photon_hit *l,
                         size_t texel) {
  const size_t at = texel * t->map_channels, step = colour_of(t, light, l->glows, l->step);
  const float *xyz = t->sampling.xyz[step];
  for (size_t k = 0; k < 3; k++) abbe_accumulator_add(&t->map, thread, at + k, l->flux * xyz[k]);
  if (t->bands.count > 0)
    abbe_accumulator_add(&t->map, thread, at + 3 + t->bands.of_step[l->step],
                         l->flux * t->sampling.power[step] / (float)t->bands.width_nm);
}

void abbe_tracer_add_to_map(abbe_tracer *t, size_t thread, size_t light, const abbe_photon_hit *hit,
                            size_t count) {
  enum { LANES = ABBE_MAP_TEXELS_LANES };
  abbe_map_texels texels;
  if (!abbe_tracer_maps(t, light)) return;
  for (size_t first = 0; first < count; first += LANES) {
    const size_t used = count - first < LANES ? count - first : LANES;
    for (size_t k = 0; k < LANES; k++) {
      double p[3];
      abbe_geometry_to_world(&t->geometry, hit[first + (k < used ? k : 0)].p, p);
      for (int i = 0; i < 3; i++) texels.p[i][k] = p[i];
    }
    abbe_map_texels_find(&t->layout, t->desc.map_width, t->desc.map_height, &texels);
    for (size_t k = 0; k < used; k++) {
      const abbe_photon_hit *l = &hit[first + k];
      if (!l->hidden && texels.at[k] != ABBE_MAP_TEXELS_NONE)
        add_to_texel(t, thread, light, l, texels.at[k]);
    }
  }
}

/* What a photon adds to the pixel that sees it straight. */
typedef struct splat {
  const abbe_photon_hit *hit;
  size_t pixel;
  float value; /* radiance of the pixel, for a reflectance of pi */
  float eye[3];
} splat;

/* As seen from a place on the lens, which the photon's own place chooses. */
static const abbe_trace_camera *camera_for(const abbe_tracer *t, const abbe_photon_hit *l,
                                           abbe_trace_camera *on_lens) {
  uint32_t of[3], bits[4];
  if (!(t->camera.lens > 0)) return &t->camera;
  memcpy(of, l->p, sizeof of);
  abbe_random_bits(of[0], of[1], of[2], t->desc.seed ^ (0x6c656e73u + l->step), bits);
  *on_lens =
      abbe_trace_camera_at(&t->camera, abbe_random_float(bits[0]), abbe_random_float(bits[1]));
  return on_lens;
}

/* The ray from the photon to the camera in lane k of the packet; false where it cannot be seen. */
static bool prepare_splat(const abbe_tracer *t, const abbe_photon_hit *l, struct RTCRay16 *packet,
                          size_t k, splat *out) {
  float d[3], distance, per_pixel, o[3];
  size_t pixel;
  abbe_trace_camera on_lens;
  const abbe_trace_camera *camera = camera_for(t, l, &on_lens);
  if (!abbe_trace_camera_pixel(camera, l->p, &pixel, &distance, d, &per_pixel)) return false;
  abbe_hit hit;
  for (int i = 0; i < 3; i++) d[i] = -d[i];
  abbe_geometry_place(&t->geometry.surface[l->surface], l->face, l->u, l->v, l->p, d, 0, &hit);
  float facing = d[0] * hit.ng[0] + d[1] * hit.ng[1] + d[2] * hit.ng[2];
  if (facing * l->side <= 0) return false;
  float metres = distance * (float)t->geometry.unit;
  *out = (splat){
      .hit = l, .pixel = pixel, .value = l->flux * fabsf(facing) * per_pixel / (metres * metres)};
  memcpy(out->eye, camera->eye, sizeof out->eye);
  abbe_geometry_leave(&hit, d, o);
  packet->org_x[k] = o[0];
  packet->org_y[k] = o[1];
  packet->org_z[k] = o[2];
  packet->dir_x[k] = d[0];
  packet->dir_y[k] = d[1];
  packet->dir_z[k] = d[2];
  packet->tnear[k] = 0;
  packet->tfar[k] = distance;
  packet->mask[k] = ABBE_GEOMETRY_ALL;
  packet->flags[k] = 0;
  return true;
}

static void add_to_pixel(const sink *s, size_t pixel, size_t colour, float value, bool caustic) {
  abbe_tracer *t = s->t;
  const size_t at = pixel * t->picture_channels;
  float rgb[3], seen[3];
  for (size_t k = 0; k < 3; k++) rgb[k] = value * t->colour[colour][k];
  abbe_tracer_finish(t, rgb, seen);
  for (size_t k = 0; k < 3; k++) {
    abbe_accumulator_add(&t->picture, s->thread, at + ABBE_TRACER_RGB + k, seen[k]);
    if (caustic)
      abbe_accumulator_add(&t->picture, s->thread, at + ABBE_TRACER_CAUSTIC + k, seen[k]);
  }
  if (t->bands.count == 0) return;
  size_t band = t->bands.of_step[colour % t->sampling.steps];
  abbe_accumulator_add(&t->picture, s->thread, at + ABBE_TRACER_BANDS + band,
                       t->passes * value * t->sampling.power[colour] / (float)t->bands.width_nm);
}

static void add_splat(const sink *s, const splat *p) {
  const abbe_tracer *t = s->t;
  const abbe_photon_hit *l = p->hit;
  abbe_reflected reflected;
  abbe_reflectance_find(&t->reflectance, l->surface, l->face, l->u, l->v, &reflected);
  const float kept = abbe_reflectance_at_step(&t->reflectance, &reflected, l->step);
  /* along the light's path to the camera */
  float o[3], d[3], left = 1, square = 0;
  for (int k = 0; k < 3; k++) {
    o[k] = l->p[k];
    d[k] = p->eye[k] - l->p[k];
    square += d[k] * d[k];
  }
  if (abbe_haze_is(&t->media.haze)) {
    for (int k = 0; k < 3; k++) d[k] /= sqrtf(square);
    left = abbe_haze_left(&t->media.haze, abbe_media_of(t->eye.inside), o, d, 0, sqrtf(square),
                          l->step, 0.5f);
  }
  add_to_pixel(s, p->pixel, colour_of(t, s->light, l->glows, l->step),
               p->value * 0.318309886f * kept * left, true);
}

static void add_shaft(void *user, const abbe_shaft_splat *p) {
  const sink *s = user;
  add_to_pixel(s, p->pixel, colour_of(s->t, s->light, p->glows, p->step), p->value, false);
}

static uint64_t flush_splats(const sink *s, struct RTCRay16 *packet, const splat *splats,
                             size_t count) {
  if (count == 0) return 0;
  abbe_embree_occluded_16(s->t->geometry.embree, packet, count);
  for (size_t k = 0; k < count; k++)
    if (!(packet->tfar[k] < 0)) add_splat(s, &splats[k]);
  return count;
}

static uint64_t add_to_picture(const sink *s, const abbe_photon_hit *hit, size_t count) {
  if (s->t->desc.no_picture) return 0;
  struct RTCRay16 packet;
  memset(&packet, 0, sizeof packet);
  splat splats[16];
  size_t waiting = 0;
  uint64_t rays = 0;
  for (size_t i = 0; i < count; i++) {
    waiting += prepare_splat(s->t, &hit[i], &packet, waiting, &splats[waiting]);
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
  size_t kept; /* photons for the camera's gathers, from the task's first photon on */
  abbe_shaft_photons *shafts; /* NULL: nothing scatters */
} task_result;

/* Whether paths of the camera meet the light by themselves. */
static bool is_found(const abbe_tracer *t, size_t light) {
  return light >= t->scene->light_count || abbe_light_has_size(&t->scene->light[light]);
}

/* For a task whose photons a medium may scatter in view of the camera. */
static abbe_shaft_photons *watch_shafts(const abbe_emission *e, sink *s) {
  abbe_tracer *t = s->t;
  if (t->desc.no_picture || !abbe_haze_is(&t->media.haze)) return NULL;
  abbe_shaft_photons *shafts = aligned_alloc(64, (sizeof *shafts + 63) / 64 * 64);
  if (shafts == NULL) return NULL;
  memset(shafts, 0, sizeof *shafts);
  shafts->geometry = &t->geometry;
  shafts->media = &t->media;
  shafts->found = is_found(t, e->light);
  shafts->camera = &t->camera;
  shafts->eye_medium = abbe_media_of(t->eye.inside);
  shafts->near = t->eye.shaft_near;
  shafts->radius = t->eye.shaft_radius;
  shafts->pass = e->pass;
  shafts->seed = t->desc.seed;
  shafts->colour = (uint32_t)colour_of(t, e->light, false, 0);
  shafts->glow = (uint32_t)colour_of(t, e->light, true, 0);
  shafts->add = add_shaft;
  shafts->user = s;
  abbe_light_walk_watch(t->walk[s->thread], abbe_shaft_photons_take, shafts);
  return shafts;
}

static void run_task(const abbe_emission *e, uint32_t from, uint32_t to, const volatile int *stop,
                     size_t thread, abbe_grid_photon *keep, task_result *out) {
  abbe_tracer *t = (abbe_tracer *)e->t;
  abbe_light_walk_room *room = abbe_light_walk_get_room(t->walk[thread]);
  abbe_photon *photon = room->photon;
  abbe_photon_hit *hit = room->hit;
  sink s = {.t = t, .thread = thread, .light = e->light};
  *out = (task_result){.shafts = watch_shafts(e, &s)};
  abbe_light_walk_split(t->walk[thread], t->splits[e->light]);
  abbe_light_walk_for_map(t->walk[thread], abbe_tracer_maps(t, e->light));
  for (uint32_t j = from; j < to && (stop == NULL || !*stop); j += ABBE_LIGHT_WALK_BATCH) {
    size_t count = abbe_emission_batch(e, j, to, photon);
    size_t landed = abbe_light_walk_run(t->walk[thread], abbe_tracer_light(t, e->light), e->pass,
                                        photon, count, hit, &out->ledger);
    abbe_tracer_add_to_map(t, thread, e->light, hit, landed);
    out->splat_rays += add_to_picture(&s, hit, landed);
    for (size_t i = 0; keep != NULL && i < landed; i++) {
      const abbe_photon_hit *l = &hit[i];
      abbe_grid_photon *g = &keep[out->kept++];
      *g = (abbe_grid_photon){.flux = l->side * l->flux,
                              .surface = l->surface,
                              .colour = (uint32_t)colour_of(t, e->light, l->glows, l->step)};
      memcpy(g->p, l->p, sizeof g->p);
    }
  }
  abbe_light_walk_watch(t->walk[thread], NULL, NULL);
  if (out->shafts == NULL) return;
  abbe_shaft_photons_flush(out->shafts);
  out->splat_rays += out->shafts->rays;
}

/* Those of a task behind those of the tasks before. */
static abbe_result join_shafts(abbe_tracer *t, task_result *task, abbe_error *error) {
  const abbe_shaft_photons *s = task->shafts;
  abbe_result result = ABBE_OK;
  if (abbe_haze_is(&t->media.haze) && !t->desc.no_picture && (s == NULL || s->full))
    result = abbe_error_set(error, ABBE_NO_MEMORY,
                            "no memory for what a medium scatters: ask for fewer photons a pass");
  if (result == ABBE_OK && s != NULL && s->count > 0) {
    abbe_haze_photon *all = realloc(t->shaft, (t->shaft_count + s->count) * sizeof *all);
    if (all == NULL)
      result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu photons in a medium",
                              t->shaft_count + s->count);
    else
      memcpy(all + t->shaft_count, s->photon, s->count * sizeof *all);
    if (all != NULL) t->shaft = all;
    if (all != NULL) t->shaft_count += s->count;
  }
  abbe_shaft_photons_free(task->shafts);
  free(task->shafts);
  return result;
}

static void add_ledger(abbe_light_ledger *to, const abbe_light_ledger *from) {
  to->reached += from->reached;
  to->deposited += from->deposited;
  to->contact += from->contact;
  to->hidden += from->hidden;
  to->absorbed += from->absorbed;
  to->missed += from->missed;
  to->trapped += from->trapped;
  to->lost += from->lost;
  to->scattered += from->scattered;
  to->turned += from->turned;
  to->frosted += from->frosted;
  to->excited += from->excited;
  to->glowing += from->glowing;
  for (int i = 0; i < 2; i++) to->quanta[i] += from->quanta[i];
}

/* The tasks of one light; results are joined in the order of the tasks, whoever did them. */
static abbe_result run_light(abbe_tracer *t, const abbe_emission *e, const volatile int *stop,
                             size_t *landed, abbe_error *error) {
  size_t tasks = (e->count + TASK - 1) / TASK;
  task_result *result = calloc(tasks + 1, sizeof *result);
  if (result == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu tasks", tasks);
  size_t base = *landed;
  abbe_result joined = ABBE_OK;
  bool keeps = t->eye_gathers;
#pragma omp parallel for schedule(dynamic) num_threads((int)t->desc.threads)
  for (size_t i = 0; i < tasks; i++) {
    if (stop != NULL && *stop) continue;
    uint32_t from = (uint32_t)(i * TASK);
    uint32_t to = (uint32_t)(e->count - from < TASK ? e->count : from + TASK);
    run_task(e, from, to, stop, (size_t)omp_get_thread_num(),
             keeps ? t->landed + base + abbe_tracer_most_hits(t, e->light, from) : NULL,
             &result[i]);
  }
  for (size_t i = 0; i < tasks; i++) {
    add_ledger(&t->statistics.ledger, &result[i].ledger);
    t->statistics.light_rays += result[i].splat_rays;
    if (keeps && result[i].kept > 0)
      memmove(t->landed + *landed, t->landed + base + abbe_tracer_most_hits(t, e->light, i * TASK),
              result[i].kept * sizeof *t->landed);
    *landed += result[i].kept;
    if (stop != NULL && *stop && result[i].shafts == NULL) continue;
    const abbe_result one = join_shafts(t, &result[i], joined == ABBE_OK ? error : NULL);
    if (joined == ABBE_OK) joined = one;
  }
  t->statistics.photons += e->count;
  free(result);
  return stop != NULL && *stop ? abbe_error_set(error, ABBE_CANCELLED, "stopped") : joined;
}

uint64_t abbe_tracer_walk_rays(const abbe_tracer *t) {
  uint64_t rays = 0;
  for (size_t i = 0; i < t->desc.threads; i++) rays += abbe_light_walk_rays(t->walk[i]);
  return rays;
}

abbe_result abbe_tracer_light_pass(abbe_tracer *t, const volatile int *stop, size_t *landed_count,
                                   abbe_error *error) {
  *landed_count = 0;
  t->shaft_count = 0;
  abbe_result result = ABBE_OK;
  for (size_t l = 0; l < t->sampling.lights && result == ABBE_OK; l++) {
    if (t->photons[l] == 0) continue;
    abbe_emission e;
    result = abbe_emission_make(t, l, t->photons[l], (uint32_t)t->pass, t->desc.seed, &e, error);
    if (result == ABBE_OK) result = run_light(t, &e, stop, landed_count, error);
    abbe_emission_free(&e);
  }
  return result;
}

static bool reflects(const abbe_object *o) {
  const double *r = o->reflectance;
  return o->spectrum != NULL || r[0] > 0 || r[1] > 0 || r[2] > 0;
}

/* Whether photons of the light can show: in a map what they fall on, in a picture what reflects or
 * scatters them; in refractors that scatter more than once paths of the camera find some lights. */
static bool asks_for(const abbe_tracer *t, size_t light) {
  const abbe_geometry *g = &t->geometry;
  const abbe_haze *haze = &t->media.haze;
  const bool gathered = haze->once || abbe_haze_scatters(haze, -1) || !is_found(t, light);
  if (!t->desc.no_picture && abbe_haze_is(haze) && gathered) return true;
  for (size_t i = 0; i < g->scene->object_count; i++)
    if (g->surface[i].kind == ABBE_GEOMETRY_RECEIVERS &&
        (abbe_tracer_maps(t, light) || (!t->desc.no_picture && reflects(&g->scene->object[i]))))
      return true;
  return false;
}

/* W of the light that its photons stand for, before anything is met. */
static double reach_of(const abbe_tracer *t, size_t light) {
  if (!asks_for(t, light)) return 0;
  if (light < t->scene->light_count)
    return t->projection[light].count > 0 ? t->projection[light].reach : 0;
  const abbe_environment *environment = t->environment.environment;
  return environment->luminance * t->environment.area;
}

abbe_result abbe_tracer_share_photons(abbe_tracer *t, abbe_error *error) {
  double total = 0;
  for (size_t l = 0; l < t->sampling.lights; l++) {
    bool wanted = !t->desc.no_picture || l == t->desc.map_light;
    abbe_result result = wanted && l < t->scene->light_count
                             ? abbe_projection_map_make(&t->geometry, l, &t->projection[l], error)
                             : ABBE_OK;
    if (result == ABBE_OK) result = abbe_tracer_check_wanted(t, error);
    if (result != ABBE_OK) return result;
    total += reach_of(t, l);
  }
  t->reach = total;
  for (size_t l = 0; l < t->sampling.lights && total > 0; l++) {
    const double reach = reach_of(t, l);
    if (!(reach > 0)) continue;
    t->photons[l] = (size_t)((double)t->desc.photons * reach / total);
    /* a faint light still needs enough of them to show where it goes */
    if (t->photons[l] < t->desc.photons / 16) t->photons[l] = t->desc.photons / 16;
    if (t->photons[l] < 64) t->photons[l] = 64;
  }
  return ABBE_OK;
}

/* The trial's photons, followed without splitting. */
static size_t land_trial(const abbe_tracer *t, const abbe_emission *e, abbe_photon_hit *hit) {
  abbe_photon *photon = abbe_light_walk_get_room(t->walk[0])->photon;
  abbe_light_ledger ledger = {0};
  size_t landed = 0;
  abbe_light_walk_split(t->walk[0], 0);
  abbe_light_walk_for_map(t->walk[0], false);
  for (uint32_t j = 0; j < e->count && abbe_tracer_is_wanted(t); j += ABBE_LIGHT_WALK_BATCH) {
    size_t count = abbe_emission_batch(e, j, (uint32_t)e->count, photon);
    landed += abbe_light_walk_run(t->walk[0], abbe_tracer_light(t, e->light), e->pass, photon,
                                  count, hit + landed, &ledger);
  }
  return landed;
}

/* Photons to follow, by how many of the trial's photons hit a receiver: fewer where hardly any
 * does. */
static size_t asked_for(size_t photons, size_t landed) {
  enum { ENOUGH = 16 };
  if (landed >= ENOUGH || photons <= SPLIT_TRIALS) return photons;
  const size_t share = photons / ENOUGH * landed;
  return share > SPLIT_TRIALS ? share : SPLIT_TRIALS;
}

abbe_result abbe_tracer_choose_splits(abbe_tracer *t, abbe_error *error) {
  abbe_photon_hit *hit = malloc(SPLIT_TRIALS * sizeof *hit);
  abbe_result result =
      hit != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a trial");
  for (size_t l = 0; l < t->sampling.lights && result == ABBE_OK; l++) {
    if (t->photons[l] == 0) continue;
    abbe_emission e;
    result = abbe_emission_make(t, l, SPLIT_TRIALS, 0, t->desc.seed, &e, error);
    uint64_t before = abbe_tracer_walk_rays(t);
    const size_t landed = result == ABBE_OK ? land_trial(t, &e, hit) : 0;
    t->splits[l] = abbe_path_splitting_best(hit, landed);
    if (!abbe_tracer_maps(t, l) && !abbe_haze_is(&t->media.haze))
      t->photons[l] = asked_for(t->photons[l], landed);
    t->photon_rays +=
        (double)t->photons[l] * (double)(abbe_tracer_walk_rays(t) - before) / SPLIT_TRIALS;
    abbe_emission_free(&e);
    if (result == ABBE_OK) result = abbe_tracer_check_wanted(t, error);
  }
  free(hit);
  return result;
}
