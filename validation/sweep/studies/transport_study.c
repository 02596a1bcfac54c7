#include "validation/sweep/studies/transport_study.h"

#include "base/clock.h"
#include "base/maths.h"
#include "gl/accuracy/frame_times.h"
#include "scenes/volume/volume_file.h"
#include "validation/frames/frame_flicker.h"
#include "validation/sweep/studies/node_errors.h"
#include "validation/sweep/studies/pinhole_limits.h"
#include "validation/tradeoff/pareto_front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool abbe_transport_looks_up(const abbe_transport_contestant *c) {
  return c->fill.passes > 0;
}

/* ---- contestants ---- */

/* A light's way costs as many photons with many nodes as with few. */
static abbe_transport_contestant volume_of(size_t nodes, abbe_region_desc region,
                                           abbe_volume_lookup lookup) {
  return (abbe_transport_contestant){
      .render = {.transport = ABBE_TRANSPORT_VOLUME, .lookup = lookup},
      .fill = {.nodes = nodes, .region = region, .passes = 1, .photons = 162 * 20000 / nodes}};
}

/* Adds one of each kind that has nearly as many bytes as the method as printed, the last, has. */
static size_t add_volumes(abbe_transport_contestant *out) {
  static const abbe_region_desc texels = {.kind = ABBE_REGION_OCTAHEDRAL, .shells = 24, .side = 32},
                                few = {.kind = ABBE_REGION_OCTAHEDRAL, .shells = 19, .side = 32},
                                triangles = {.kind = ABBE_REGION_GEODESIC,
                                             .shells = 24,
                                             .levels = 3},
                                few_triangles = {.kind = ABBE_REGION_GEODESIC,
                                                 .shells = 15,
                                                 .levels = 3},
                                grid = {.kind = ABBE_REGION_GRID, .side = 27};
  const size_t printed = 162 * 24 * 1280 * 3, points[] = {16384, 32768};
  size_t n = 0;
  out[n++] = volume_of(42, grid, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(42, few_triangles, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(42, few, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_NEAREST);
  out[n++] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_TURN);
  for (size_t i = 0; i < 2; i++, n++) {
    out[n] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_BLEND);
    out[n].fill.joins = true;
    out[n].fill.tolerance = 0.02;
    if (i == 1) out[n].joined_bytes = printed;
  }
  for (size_t i = 0; i < 2; i++, n++) {
    out[n] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_AUTO);
    out[n].fill.exits = points[i];
  }
  out[n] = volume_of(162, triangles, ABBE_VOLUME_LOOKUP_AUTO);
  out[n].render.profile = ABBE_PROFILE_WYMAN2003;
  out[n++].fill.kind = ABBE_VOLUME_PRINTED;
  return n;
}

/* Rising numbers of samples, as published and by tiles of receivers. */
static size_t add_pinholes(abbe_transport_contestant *out) {
  static const size_t samples[] = {64, 256, 1024};
  size_t n = 0;
  for (int published = 0; published < 2; published++)
    for (size_t i = 0; i < 3; i++)
      out[n++].render =
          (abbe_render_desc){.profile = published ? ABBE_PROFILE_WAND2003 : ABBE_PROFILE_DEFAULT,
                             .transport = ABBE_TRANSPORT_PINHOLE,
                             .footprint = published ? ABBE_FOOTPRINT_OFF : ABBE_FOOTPRINT_ON,
                             .pinholes = samples[i]};
  return n;
}

size_t abbe_transport_study_contestants(const char *name, abbe_transport_contestant *out) {
  out[0] = (abbe_transport_contestant){.render = {.pinholes = 0}};
  if (strcmp(name, "volume") == 0) return 1 + add_volumes(out + 1);
  if (strcmp(name, "pinhole") == 0) return 1 + add_pinholes(out + 1);
  return 0;
}

/* ---- one contestant ---- */

typedef struct work {
  const abbe_sweep *sweep;
  const char *file;
  abbe_node_errors nodes;
  abbe_pinhole_limits limits;
  abbe_render_progress progress;
  void *user;
  double done, share; /* share of all: before this contestant, and its own */
} work;

static bool go_on(void *user, double done) {
  const work *w = user;
  return w->progress == NULL || w->progress(w->user, w->done + w->share * done);
}

static double file_bytes(const char *path) {
  FILE *file = fopen(path, "rb");
  const double size = file != NULL && fseek(file, 0, SEEK_END) == 0 ? (double)ftell(file) : NAN;
  if (file != NULL) fclose(file);
  return size;
}

/* A copy of the volume, joined within a tolerance; *bytes of it. */
static abbe_result join_copy(const abbe_caustic_volume *volume, double tolerance, uint16_t *value,
                             size_t *bytes, abbe_error *error) {
  abbe_caustic_volume copy = *volume;
  copy.value = value;
  memcpy(value, volume->value, abbe_caustic_volume_bytes(volume));
  return abbe_caustic_volume_join(&copy, tolerance, bytes, error);
}

/* The tolerance is found by halving its logarithm. */
static abbe_result join_within(abbe_caustic_volume *volume, size_t most, double *tolerance,
                               size_t *bytes, abbe_error *error) {
  enum { HALVINGS = 8 };
  double low = log(1e-3), high = log(10);
  uint16_t *value = malloc(abbe_caustic_volume_bytes(volume));
  if (value == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a joined volume");
  abbe_result result = ABBE_OK;
  for (int i = 0; i < HALVINGS && result == ABBE_OK; i++) {
    const double middle = 0.5 * (low + high);
    result = join_copy(volume, exp(middle), value, bytes, error);
    *(*bytes > most ? &low : &high) = middle;
  }
  *tolerance = exp(high);
  if (result == ABBE_OK) result = abbe_caustic_volume_join(volume, *tolerance, bytes, error);
  free(value);
  return result;
}

static abbe_result fill(work *w, abbe_transport_row *row, abbe_caustic_volume *out,
                        abbe_error *error) {
  abbe_volume_fill_desc *d = &row->contestant.fill;
  const size_t most = row->contestant.joined_bytes;
  abbe_volume_fill_statistics done;
  double *n = row->number;
  const abbe_scene *scene = w->sweep->scene;
  for (d->object = 0; d->object < scene->object_count &&
                      abbe_object_kind_of(&scene->object[d->object]) == ABBE_OBJECT_RECEIVER;)
    d->object++;
  d->progress = go_on;
  d->user = w;
  d->joins = d->joins && most == 0;
  abbe_result result = abbe_volume_fill(scene, d, out, &done, error);
  if (result == ABBE_OK && most > 0)
    result = join_within(out, most, &d->tolerance, &done.joint_bytes, error);
  d->joins = d->joins || most > 0;
  if (result == ABBE_OK) result = abbe_volume_file_write(w->file, out, error);
  if (result != ABBE_OK) return result;
  n[ABBE_TRANSPORT_NODES_NUMBER] = (double)out->nodes.count;
  n[ABBE_TRANSPORT_CELLS_NUMBER] = (double)out->region.cells;
  n[ABBE_TRANSPORT_PHOTONS_NODE_NUMBER] = (double)done.photons / (double)out->nodes.count;
  n[ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER] = done.seconds;
  n[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER] =
      done.joint_bytes > 0 ? (double)done.joint_bytes : (double)abbe_caustic_volume_bytes(out);
  n[ABBE_TRANSPORT_BYTES_DISK_NUMBER] = file_bytes(w->file);
  if (done.outflow[1] > 0) n[ABBE_TRANSPORT_FLUX_DRIFT_NUMBER] = done.outflow[1] - done.outflow[0];
  unlink(w->file);
  return ABBE_OK;
}

static abbe_result time_still(const work *w, abbe_renderer *renderer, double *n,
                              abbe_error *error) {
  abbe_frame_times times;
  double alone = NAN;
  const abbe_frame_times_desc desc = {.frames = w->sweep->frames, .enough_ms = 3000};
  abbe_result result = abbe_frame_times_measure(renderer, &desc, &times, error);
  if (result == ABBE_OK && !abbe_method_of(abbe_renderer_plan(renderer)->desc.profile)->own_passes)
    result = abbe_frame_times_baseline(renderer, 3, &alone, error);
  if (result != ABBE_OK) return result;
  n[ABBE_TRANSPORT_FRAME_MS_NUMBER] = times.median.frame_ms;
  n[ABBE_TRANSPORT_LOOKUP_MS_NUMBER] = times.median.frame_ms - alone;
  n[ABBE_TRANSPORT_BYTES_GPU_NUMBER] = (double)times.median.device_bytes;
  return ABBE_OK;
}

/* A frame without caustics: lights are spots that shine up from far above, where no object is;
 * receivers have one sample where those of volumes have. As published there are caustics whatever a
 * light's cone meets. */
static abbe_result time_without(const work *w, const abbe_render_desc *desc, double *n,
                                abbe_error *error) {
  const abbe_scene *scene = w->sweep->scene;
  const abbe_render_desc without = {
      .width = desc->width, .height = desc->height, .receiver_samples = desc->volume != NULL};
  abbe_scene dark = *scene;
  double min[3], max[3];
  abbe_renderer *renderer = NULL;
  abbe_frame_times times;
  const abbe_frame_times_desc how = {.frames = w->sweep->frames, .enough_ms = 3000};
  if (abbe_method_of(desc->profile)->own_passes || scene->light_count == 0) return ABBE_OK;
  dark.light = malloc(scene->light_count * sizeof *dark.light);
  if (dark.light == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for lights");
  abbe_scene_bounds(scene, true, true, min, max);
  for (size_t i = 0; i < scene->light_count; i++) {
    dark.light[i] = scene->light[i];
    dark.light[i].kind = ABBE_LIGHT_SPOT;
    dark.light[i].cone_rad = 10 * ABBE_DEGREE;
    dark.light[i].soft_rad = 0;
    for (int k = 0; k < 3; k++) {
      dark.light[i].position[k] = max[k] + 10 * (max[k] - min[k]);
      dark.light[i].direction[k] = k == 2;
    }
  }
  abbe_result result = abbe_renderer_make(w->sweep->context, &dark, &without, &renderer, error);
  if (result == ABBE_OK) result = abbe_frame_times_measure(renderer, &how, &times, error);
  if (result == ABBE_OK) n[ABBE_TRANSPORT_NONE_MS_NUMBER] = times.median.frame_ms;
  abbe_renderer_free(renderer);
  free(dark.light);
  return result;
}

static abbe_result compare(const work *w, abbe_renderer *renderer, double *n, abbe_error *error) {
  abbe_image picture = {0};
  abbe_sweep_row row;
  const bool printed = abbe_method_of(abbe_renderer_plan(renderer)->desc.profile)->printed;
  abbe_result result = abbe_renderer_read(renderer, false, &picture, error);
  if (result == ABBE_OK)
    result = abbe_sweep_compare_picture(w->sweep, &picture, printed, &row, error);
  abbe_image_free(&picture);
  if (result != ABBE_OK) return result;
  n[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER] = row.number[ABBE_SWEEP_CAUSTIC_DE];
  n[ABBE_TRANSPORT_CAUSTIC_DE_NOISE_NUMBER] = row.number[ABBE_SWEEP_CAUSTIC_DE_NOISE];
  n[ABBE_TRANSPORT_CAUSTIC_RMSE_NUMBER] = row.number[ABBE_SWEEP_CAUSTIC_RMSE];
  n[ABBE_TRANSPORT_CAUSTIC_RMSE_NOISE_NUMBER] = row.number[ABBE_SWEEP_CAUSTIC_RMSE_NOISE];
  return ABBE_OK;
}

/* Around the upright axis through the middle of what it lights. */
static bool turn_light(const abbe_light *from, const double middle[3], double rad,
                       abbe_light *out) {
  const double c = cos(rad), s = sin(rad);
  const bool sun = from->kind == ABBE_LIGHT_DIRECTIONAL;
  const double *v = sun ? from->direction : from->position;
  const double x = v[0] - (sun ? 0 : middle[0]), y = v[1] - (sun ? 0 : middle[1]);
  double *to = sun ? out->direction : out->position;
  if (!sun && from->kind != ABBE_LIGHT_POINT) return false;
  to[0] = c * x - s * y + (sun ? 0 : middle[0]);
  to[1] = s * x + c * y + (sun ? 0 : middle[1]);
  return true;
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static abbe_result move_light(const work *w, const abbe_render_desc *desc, abbe_renderer *renderer,
                              double *n, abbe_error *error) {
  enum { MOVES = ABBE_TRANSPORT_STUDY_MOVES };
  const abbe_scene *scene = w->sweep->scene;
  const abbe_object *object = &scene->object[abbe_renderer_plan(renderer)->refractor_object[0]];
  double ms[MOVES], middle[3];
  abbe_frame_error change[MOVES], most;
  abbe_frame_flicker flicker = {0};
  abbe_scene moved = *scene;
  if (scene->light_count == 0 || abbe_renderer_plan(renderer)->refractor_count == 0) return ABBE_OK;
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (object->min[k] + object->max[k]);
  moved.light = malloc(scene->light_count * sizeof *moved.light);
  if (moved.light == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for lights");
  memcpy(moved.light, scene->light, scene->light_count * sizeof *moved.light);
  abbe_result result = ABBE_OK;
  size_t count = 0;
  for (; count < MOVES && result == ABBE_OK; count++) {
    abbe_image picture = {0};
    if (!turn_light(&scene->light[0], middle, (double)(count + 1) * ABBE_DEGREE, &moved.light[0]))
      break;
    const double start = abbe_clock_seconds();
    result = abbe_renderer_change(renderer, &moved, desc, error);
    if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
    if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, &picture, error);
    ms[count] = 1e3 * (abbe_clock_seconds() - start);
    if (result == ABBE_OK)
      result = abbe_frame_flicker_add(&flicker, &picture, NULL, &change[count], error);
    abbe_image_free(&picture);
  }
  if (result == ABBE_OK && count == MOVES) {
    abbe_frame_flicker_largest(change, MOVES, &most);
    qsort(ms, MOVES, sizeof *ms, by_size);
    n[ABBE_TRANSPORT_MOVED_MS_NUMBER] = ms[MOVES / 2];
    n[ABBE_TRANSPORT_POP_NUMBER] = most.change;
  }
  /* the renderer is not to look at lights that are gone */
  if (result == ABBE_OK) result = abbe_renderer_change(renderer, scene, desc, error);
  abbe_frame_flicker_free(&flicker);
  free(moved.light);
  return result;
}

static abbe_result measure(work *w, abbe_transport_row *row, abbe_error *error) {
  abbe_render_desc desc = row->contestant.render;
  abbe_caustic_volume volume = {0};
  abbe_renderer *renderer = NULL;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < ABBE_TRANSPORT_NUMBER_COUNT; i++) row->number[i] = NAN;
  desc.width = w->sweep->picture->width;
  desc.height = w->sweep->picture->height;
  if (desc.pinholes > 0) row->number[ABBE_TRANSPORT_SAMPLES_NUMBER] = (double)desc.pinholes;
  if (abbe_transport_looks_up(&row->contestant)) result = fill(w, row, &volume, error);
  if (volume.region.cells > 0) desc.volume = &volume;
  if (result == ABBE_OK)
    result = abbe_renderer_make(w->sweep->context, w->sweep->scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = time_still(w, renderer, row->number, error);
  if (result == ABBE_OK) result = compare(w, renderer, row->number, error);
  if (result == ABBE_OK) result = move_light(w, &desc, renderer, row->number, error);
  if (result == ABBE_OK && abbe_transport_looks_up(&row->contestant))
    result = abbe_node_errors_measure(&w->nodes, w->sweep, &volume.nodes, &desc, renderer,
                                      &row->number[ABBE_TRANSPORT_NODE_ERROR_NUMBER],
                                      &row->number[ABBE_TRANSPORT_MID_ERROR_NUMBER], error);
  abbe_renderer_free(renderer);
  if (result == ABBE_OK) result = time_without(w, &desc, row->number, error);
  if (result == ABBE_OK && desc.pinholes > 0)
    result = abbe_pinhole_limits_measure(&w->limits, w->sweep->context, w->sweep->scene, &desc,
                                         &row->number[ABBE_TRANSPORT_LIMIT_RMSE_NUMBER], error);
  abbe_caustic_volume_free(&volume);
  return result;
}

/* ---- all ---- */

/* One more row, or one that is refused. */
static abbe_result measure_next(work *w, const abbe_transport_contestant *contestant,
                                abbe_transport_study *out, size_t *refused, abbe_error *first,
                                abbe_error *error) {
  abbe_transport_row *row = &out->row[out->count];
  abbe_error own = {0};
  if (!go_on(w, 0)) return abbe_error_set(error, ABBE_CANCELLED, "stopped");
  *row = (abbe_transport_row){.contestant = *contestant};
  const abbe_result result = measure(w, row, &own);
  if (result == ABBE_OK) out->count++;
  if (result == ABBE_CANCELLED || result == ABBE_NO_MEMORY || result == ABBE_IO)
    return abbe_error_set(error, result, "%s", own.text);
  if (result != ABBE_OK && (*refused)++ == 0) *first = own;
  return ABBE_OK;
}

abbe_result abbe_transport_study_measure(const abbe_sweep *sweep,
                                         const abbe_transport_contestant *contestant, size_t count,
                                         const char *file, abbe_render_progress progress,
                                         void *user, abbe_transport_study *out, size_t *refused,
                                         abbe_error *why, abbe_error *error) {
  work w = {.sweep = sweep, .file = file, .progress = progress, .user = user};
  abbe_error first = {0};
  *out = (abbe_transport_study){.count = 0};
  *refused = 0;
  if (sweep->picture == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "ways of light are compared with a traced picture, and there is none");
  snprintf(out->scene, sizeof out->scene, "%.255s", sweep->scene->path);
  w.share = 1 / (double)(count > 0 ? count : 1);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && out->count < ABBE_TRANSPORT_STUDY_MOST && result == ABBE_OK;
       i++) {
    w.done = (double)i * w.share;
    result = measure_next(&w, &contestant[i], out, refused, &first, error);
  }
  abbe_node_errors_free(&w.nodes);
  abbe_pinhole_limits_free(&w.limits);
  if (result != ABBE_OK) return result;
  if (why != NULL) *why = first;
  if (out->count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "none of the ways can light this scene: %.600s", first.text);
  abbe_transport_study_judge(out);
  return ABBE_OK;
}

void abbe_transport_study_judge(abbe_transport_study *s) {
  double time[ABBE_TRANSPORT_STUDY_MOST], bytes[ABBE_TRANSPORT_STUDY_MOST],
      off[ABBE_TRANSPORT_STUDY_MOST];
  bool on[ABBE_TRANSPORT_STUDY_MOST] = {false};
  for (size_t i = 0; i < s->count; i++) {
    double *n = s->row[i].number;
    time[i] = n[ABBE_TRANSPORT_MOVED_MS_NUMBER];
    if (isnan(time[i])) time[i] = n[ABBE_TRANSPORT_FRAME_MS_NUMBER];
    bytes[i] = n[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER];
    off[i] = n[ABBE_TRANSPORT_CAUSTIC_DE_NUMBER];
    const abbe_transport_contestant *first = &s->row[0].contestant;
    const double saved =
        abbe_transport_looks_up(first) || first->render.pinholes > 0 ? 0 : time[0] - time[i];
    n[ABBE_TRANSPORT_PAYS_AFTER_NUMBER] =
        saved > 0 ? ceil(1e3 * n[ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER] / saved) : NAN;
    n[ABBE_TRANSPORT_OVER_NONE_NUMBER] =
        n[ABBE_TRANSPORT_FRAME_MS_NUMBER] / n[ABBE_TRANSPORT_NONE_MS_NUMBER] - 1;
  }
  abbe_pareto_front_mark(time, off, s->count, on);
  for (size_t i = 0; i < s->count; i++) s->row[i].on_time = on[i];
  abbe_pareto_front_mark(bytes, off, s->count, on);
  for (size_t i = 0; i < s->count; i++) s->row[i].on_bytes = on[i];
}

bool abbe_transport_same_but_samples(const abbe_render_desc *a, const abbe_render_desc *b) {
  return a->profile == b->profile && a->transport == b->transport && a->footprint == b->footprint;
}

double abbe_transport_study_slope(const abbe_transport_study *s, size_t row) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (size_t i = 0; i < s->count; i++) {
    const double a = log(s->row[i].number[ABBE_TRANSPORT_SAMPLES_NUMBER]),
                 b = log(s->row[i].number[ABBE_TRANSPORT_LIMIT_RMSE_NUMBER]);
    if (!abbe_transport_same_but_samples(&s->row[i].contestant.render,
                                         &s->row[row].contestant.render) ||
        !isfinite(a) || !isfinite(b))
      continue;
    n++;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const double spread = n * xx - x * x;
  return n >= 2 && spread > 1e-12 ? (n * xy - x * y) / spread : NAN;
}
