#include "validation/sweep/studies/transport_study.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/number.h"
#include "gl/accuracy/frame_times.h"
#include "scenes/volume/volume_file.h"
#include "validation/frames/frame_flicker.h"
#include "validation/tradeoff/pareto_front.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define RAD (3.14159265358979323846 / 180)

static const char *const columns[] = {
#define NAME(code, column) column,
    ABBE_TRANSPORT_NUMBERS(NAME)
#undef NAME
};

/* ---- contestants ---- */

static bool looks_up(const abbe_transport_contestant *c) {
  return c->fill.passes > 0;
}

/* A light's way costs as many photons with many nodes as with few. */
static abbe_transport_contestant volume_of(size_t nodes, abbe_region_desc region,
                                           abbe_volume_lookup lookup) {
  return (abbe_transport_contestant){
      .render = {.transport = ABBE_TRANSPORT_VOLUME, .lookup = lookup},
      .fill = {.nodes = nodes, .region = region, .passes = 1, .photons = 162 * 20000 / nodes}};
}

static size_t add_volumes(abbe_transport_contestant *out) {
  static const abbe_region_desc texels = {.kind = ABBE_REGION_OCTAHEDRAL, .shells = 24, .side = 32},
                                triangles = {.kind = ABBE_REGION_GEODESIC,
                                             .shells = 24,
                                             .levels = 3},
                                grid = {.kind = ABBE_REGION_GRID, .side = 32};
  size_t n = 0;
  out[n++] = volume_of(42, grid, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(42, triangles, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(42, texels, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_NEAREST);
  out[n++] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_BLEND);
  out[n++] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_TURN);
  const size_t modes[] = {8, 36, 81};
  const double tolerances[] = {0.02, 0.2};
  for (size_t i = 0; i < 2; i++, n++) {
    out[n] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_BLEND);
    out[n].fill.joins = true;
    out[n].fill.tolerance = tolerances[i];
  }
  out[n] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_AUTO);
  out[n++].fill.degree = 5;
  for (size_t i = 0; i < 3; i++, n++) {
    out[n] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_AUTO);
    out[n].fill.rank = modes[i];
  }
  out[n] = volume_of(162, texels, ABBE_VOLUME_LOOKUP_AUTO);
  out[n++].fill.exits = 16384;
  out[n] = volume_of(162, triangles, ABBE_VOLUME_LOOKUP_AUTO);
  out[n].render.profile = ABBE_PROFILE_WYMAN2003;
  out[n++].fill.kind = ABBE_VOLUME_PRINTED;
  return n;
}

/* Each strategy with rising numbers of samples, as published and by pages of receivers. */
static size_t add_pinholes(abbe_transport_contestant *out) {
  static const size_t samples[] = {64, 256, 1024};
  size_t n = 0;
  for (int published = 0; published < 2; published++)
    for (int s = ABBE_SAMPLE_STRATEGY_AUTO + 1; s < ABBE_SAMPLE_STRATEGY_COUNT; s++)
      for (size_t i = 0; i < 3; i++)
        out[n++].render =
            (abbe_render_desc){.profile = published ? ABBE_PROFILE_WAND2003 : ABBE_PROFILE_DEFAULT,
                               .transport = ABBE_TRANSPORT_PINHOLE,
                               .strategy = (abbe_sample_strategy)s,
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
  abbe_render_progress progress;
  void *user;
  double done, share; /* of all: before this contestant, and its own */
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

static abbe_result fill(work *w, abbe_transport_row *row, abbe_caustic_volume *out,
                        abbe_error *error) {
  abbe_volume_fill_desc *d = &row->contestant.fill;
  abbe_volume_fill_statistics done;
  double *n = row->number;
  const abbe_scene *scene = w->sweep->scene;
  for (d->object = 0; d->object < scene->object_count &&
                      abbe_object_kind_of(&scene->object[d->object]) == ABBE_OBJECT_RECEIVER;)
    d->object++;
  d->progress = go_on;
  d->user = w;
  abbe_result result = abbe_volume_fill(scene, d, out, &done, error);
  if (result == ABBE_OK) result = abbe_volume_file_write(w->file, out, error);
  if (result != ABBE_OK) return result;
  n[ABBE_TRANSPORT_NODES_NUMBER] = (double)out->nodes.count;
  n[ABBE_TRANSPORT_CELLS_NUMBER] = (double)out->region.cells;
  n[ABBE_TRANSPORT_PHOTONS_NODE_NUMBER] = (double)done.photons / (double)out->nodes.count;
  n[ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER] = done.seconds;
  n[ABBE_TRANSPORT_BYTES_MEMORY_NUMBER] =
      done.joint_bytes > 0 ? (double)done.joint_bytes : (double)abbe_caustic_volume_bytes(out);
  n[ABBE_TRANSPORT_BYTES_DISK_NUMBER] = file_bytes(w->file);
  if (out->degree > 0) n[ABBE_TRANSPORT_ORDER_NUMBER] = (double)out->degree;
  if (out->rank > 0) n[ABBE_TRANSPORT_RANK_NUMBER] = (double)out->rank;
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
  if (result == ABBE_OK && !abbe_profile_is_published(abbe_renderer_plan(renderer)->desc.profile))
    result = abbe_frame_times_baseline(renderer, 3, &alone, error);
  if (result != ABBE_OK) return result;
  n[ABBE_TRANSPORT_FRAME_MS_NUMBER] = times.median.frame_ms;
  n[ABBE_TRANSPORT_LOOKUP_MS_NUMBER] = times.median.frame_ms - alone;
  n[ABBE_TRANSPORT_BYTES_GPU_NUMBER] = (double)times.median.device_bytes;
  return ABBE_OK;
}

static abbe_result compare(const work *w, abbe_renderer *renderer, double *n, abbe_error *error) {
  abbe_image picture = {0};
  abbe_sweep_row row;
  const bool printed = abbe_profile_is_printed(abbe_renderer_plan(renderer)->desc.profile);
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
    if (!turn_light(&scene->light[0], middle, (double)(count + 1) * RAD, &moved.light[0])) break;
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
  if (looks_up(&row->contestant)) result = fill(w, row, &volume, error);
  if (volume.region.cells > 0) desc.volume = &volume;
  if (result == ABBE_OK)
    result = abbe_renderer_make(w->sweep->context, w->sweep->scene, &desc, &renderer, error);
  if (result == ABBE_OK) result = time_still(w, renderer, row->number, error);
  if (result == ABBE_OK) result = compare(w, renderer, row->number, error);
  if (result == ABBE_OK) result = move_light(w, &desc, renderer, row->number, error);
  abbe_renderer_free(renderer);
  abbe_caustic_volume_free(&volume);
  return result;
}

/* ---- all ---- */

abbe_result abbe_transport_study_measure(const abbe_sweep *sweep,
                                         const abbe_transport_contestant *contestant, size_t count,
                                         const char *file, abbe_render_progress progress,
                                         void *user, abbe_transport_study *out, size_t *refused,
                                         abbe_error *why, abbe_error *error) {
  ABBE_REQUIRE(sweep && contestant && file && out && refused, error);
  work w = {.sweep = sweep, .file = file, .progress = progress, .user = user};
  abbe_error first = {0};
  *out = (abbe_transport_study){.count = 0};
  *refused = 0;
  if (sweep->picture == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "ways of light are compared with a traced picture, and there is none");
  snprintf(out->scene, sizeof out->scene, "%.255s", sweep->scene->path);
  w.share = 1 / (double)(count > 0 ? count : 1);
  for (size_t i = 0; i < count && out->count < ABBE_TRANSPORT_STUDY_MOST; i++) {
    abbe_transport_row *row = &out->row[out->count];
    abbe_error own = {0};
    w.done = (double)i * w.share;
    if (!go_on(&w, 0)) return abbe_error_set(error, ABBE_CANCELLED, "stopped");
    *row = (abbe_transport_row){.contestant = contestant[i]};
    const abbe_result result = measure(&w, row, &own);
    if (result == ABBE_OK) out->count++;
    if (result == ABBE_CANCELLED || result == ABBE_NO_MEMORY || result == ABBE_IO)
      return abbe_error_set(error, result, "%s", own.text);
    if (result != ABBE_OK && (*refused)++ == 0) first = own;
  }
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
    const double saved = looks_up(first) || first->render.pinholes > 0 ? 0 : time[0] - time[i];
    n[ABBE_TRANSPORT_PAYS_AFTER_NUMBER] =
        saved > 0 ? ceil(1e3 * n[ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER] / saved) : NAN;
  }
  abbe_pareto_front_mark(time, off, s->count, on);
  for (size_t i = 0; i < s->count; i++) s->row[i].on_time = on[i];
  abbe_pareto_front_mark(bytes, off, s->count, on);
  for (size_t i = 0; i < s->count; i++) s->row[i].on_bytes = on[i];
}

static bool same_but_samples(const abbe_render_desc *a, const abbe_render_desc *b) {
  return a->profile == b->profile && a->transport == b->transport && a->strategy == b->strategy &&
         a->footprint == b->footprint;
}

double abbe_transport_study_slope(const abbe_transport_study *s, size_t row) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (size_t i = 0; i < s->count; i++) {
    const double a = log(s->row[i].number[ABBE_TRANSPORT_SAMPLES_NUMBER]),
                 b = log(s->row[i].number[ABBE_TRANSPORT_CAUSTIC_RMSE_NUMBER]);
    if (!same_but_samples(&s->row[i].contestant.render, &s->row[row].contestant.render) ||
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

/* ---- as text ---- */

static const char *transport_of(const abbe_render_desc *d) {
  if (d->profile != ABBE_PROFILE_DEFAULT) return abbe_profile_name(d->profile);
  return abbe_transport_name(d->transport == ABBE_TRANSPORT_AUTO ? ABBE_TRANSPORT_PHOTONS
                                                                 : d->transport);
}

static void region_of(const abbe_transport_contestant *c, char *out, size_t size) {
  const abbe_region_desc *r = &c->fill.region;
  *out = '\0';
  if (!looks_up(c)) return;
  if (c->fill.exits > 0)
    snprintf(out, size, "rays %zu", c->fill.exits);
  else if (r->kind == ABBE_REGION_GRID)
    snprintf(out, size, "grid %zu", r->side);
  else if (r->kind == ABBE_REGION_GEODESIC)
    snprintf(out, size, "shells %zux%zu", r->shells, (size_t)20 << 2 * r->levels);
  else
    snprintf(out, size, "shells %zux%zux%zu", r->shells, r->side, r->side);
  if (c->fill.joins)
    abbe_number_format(out + strlen(out), size - strlen(out), " joined %g", c->fill.tolerance);
}

static const char *const lookups[] = {
#define NAME(code, name) name,
    ABBE_VOLUME_LOOKUPS(NAME)
#undef NAME
};
static const char *const footprints[] = {
#define NAME(code, name) name,
    ABBE_FOOTPRINTS(NAME)
#undef NAME
};

abbe_result abbe_transport_study_save(const abbe_transport_study *s, const char *path,
                                      abbe_error *error) {
  ABBE_REQUIRE(s && path, error);
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  FILE *to = writer.stream;
  fprintf(to, "# scene: %s\ntransport,strategy,footprint,region,lookup", s->scene);
  for (int k = 0; k < ABBE_TRANSPORT_NUMBER_COUNT; k++) fprintf(to, ",%s", columns[k]);
  fprintf(to, ",front_time,front_bytes\n");
  for (size_t i = 0; i < s->count; i++) {
    const abbe_transport_row *row = &s->row[i];
    const abbe_render_desc *d = &row->contestant.render;
    char text[ABBE_NUMBER_TEXT_SIZE], region[64];
    region_of(&row->contestant, region, sizeof region);
    fprintf(to, "%s,%s,%s,%s,%s", transport_of(d),
            d->pinholes > 0 ? abbe_sample_strategy_name(d->strategy) : "",
            d->pinholes > 0 ? footprints[d->footprint] : "", region,
            looks_up(&row->contestant) ? lookups[d->lookup] : "");
    for (int k = 0; k < ABBE_TRANSPORT_NUMBER_COUNT; k++)
      fprintf(to, ",%s", isfinite(row->number[k]) ? abbe_number_text(row->number[k], text) : "");
    fprintf(to, ",%s,%s\n", row->on_time ? "yes" : "", row->on_bytes ? "yes" : "");
  }
  return abbe_file_writer_commit(&writer, error);
}

static void print_name(const abbe_transport_row *row, FILE *out) {
  const abbe_transport_contestant *c = &row->contestant;
  char region[64];
  region_of(c, region, sizeof region);
  fprintf(out, "| %s", transport_of(&c->render));
  if (c->render.pinholes > 0)
    fprintf(out, " %zu %s, footprint %s", c->render.pinholes,
            abbe_sample_strategy_name(c->render.strategy), footprints[c->render.footprint]);
  if (!looks_up(c)) return;
  abbe_number_write(out, ", %g nodes, %s", row->number[ABBE_TRANSPORT_NODES_NUMBER], region);
  if (c->fill.degree > 0) fprintf(out, ", harmonics to degree %zu", c->fill.degree);
  if (c->fill.rank > 0) fprintf(out, ", %zu modes", c->fill.rank);
  if (c->render.lookup != ABBE_VOLUME_LOOKUP_AUTO) fprintf(out, ", %s", lookups[c->render.lookup]);
}

void abbe_transport_study_print(const abbe_transport_study *s, FILE *out) {
  static const abbe_transport_number shown[] = {
      ABBE_TRANSPORT_PRECOMPUTE_S_NUMBER, ABBE_TRANSPORT_BYTES_MEMORY_NUMBER,
      ABBE_TRANSPORT_BYTES_DISK_NUMBER,   ABBE_TRANSPORT_BYTES_GPU_NUMBER,
      ABBE_TRANSPORT_MOVED_MS_NUMBER,     ABBE_TRANSPORT_CAUSTIC_DE_NUMBER,
      ABBE_TRANSPORT_CAUSTIC_RMSE_NUMBER, ABBE_TRANSPORT_POP_NUMBER,
      ABBE_TRANSPORT_PAYS_AFTER_NUMBER};
  fprintf(out,
          "| %s | precompute, s | bytes | on disk | on the device | moved light, ms | CIEDE2000 "
          "| relative RMSE | pop | pays after | front of |\n"
          "|---|---|---|---|---|---|---|---|---|---|---|\n",
          s->scene);
  for (size_t i = 0; i < s->count; i++) {
    const abbe_transport_row *row = &s->row[i];
    char text[ABBE_SWEEP_SHORT];
    print_name(row, out);
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++)
      fprintf(out, " | %s", abbe_sweep_number_short(row->number[shown[k]], text));
    fprintf(out, " |%s%s |\n", row->on_time ? " time" : "", row->on_bytes ? " bytes" : "");
  }
  for (size_t i = 0; i < s->count; i++) {
    const double slope = abbe_transport_study_slope(s, i);
    const abbe_render_desc *d = &s->row[i].contestant.render;
    const bool first = i == 0 || !same_but_samples(d, &s->row[i - 1].contestant.render);
    if (first && isfinite(slope))
      abbe_number_write(out, "%s, %s, footprint %s: slope %.2f\n", transport_of(d),
                        abbe_sample_strategy_name(d->strategy), footprints[d->footprint], slope);
  }
}
