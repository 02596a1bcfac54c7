#include "gl/caustics/caustics.h"

#include "base/clock.h"
#include "gl/caustics/map_fit.h"
#include "gl/light/light_layers.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const abbe_plan *plan_of(const abbe_caustics *c) {
  return c->views->scene->plan;
}

/* What is fitted is fitted to no more photons than this a side. */
enum { FIT_PHOTONS = 96, LEAST_FIT_PHOTONS = 48 };

static abbe_result count_photons(abbe_caustics *c, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t light = 0; light < plan_of(c)->light_view_count && result == ABBE_OK; light++) {
    if (!plan_of(c)->reaches[light]) continue;
    result = abbe_photon_start_run(&c->start, light, error);
    c->views->light[light].photon_count = abbe_photon_start_count(&c->start);
  }
  return result;
}

/* All wavelengths in batches that overlap by one node, so that every interval between nodes lies
 * in exactly one of them. (A single node has its light in the one before it.) False after the last.
 */
static bool next_batch(const abbe_caustics *c, abbe_hit_batch *b) {
  const size_t n = plan_of(c)->desc.wavelengths, most = c->trace.hits.stride;
  if (b->count > 0 && b->first + b->count == n) return false;
  b->first = b->count == 0 ? 0 : b->first + b->count - 1;
  b->count = n - b->first < most ? n - b->first : most;
  b->interval_first = n > 1 ? b->first + 1 : 0;
  b->interval_end = b->first + b->count;
  return true;
}

/* Fits of a light's map: to all receivers, and to the layout that the last frame had. */
typedef struct map_fits {
  abbe_map_fit *whole, *kept; /* NULL: there is none */
  abbe_map_layout layout;     /* layout of that */
  abbe_view lit;              /* the lit part of the whole, where its bins are too wide */
  abbe_tile_light **beside;
} map_fits;

static abbe_result make_fits(abbe_caustics *c, size_t light, bool given, map_fits *out,
                             abbe_error *error) {
  const abbe_map_layout *map = &c->views->light[light].map;
  const size_t sides = c->atlas->used ? 2 * c->views->scene->charts.count : 0;
  abbe_map_layout last;
  *out = (map_fits){.whole = calloc(1, sizeof *out->whole),
                    .beside = calloc(sides + 1, sizeof *out->beside)};
  const bool follows = !given && !abbe_photon_lights_is_face(c->views, light) &&
                       abbe_map_history_layout(c->map->history, light, &last);
  if (follows) {
    out->layout = *map;
    abbe_photon_lights_take_layout(c->views, &last, &out->layout);
    out->kept = calloc(1, sizeof *out->kept);
  }
  if (out->whole == NULL || out->beside == NULL || (follows && out->kept == NULL))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fit the map");
  return ABBE_OK;
}

static void free_fits(abbe_caustics *c, map_fits *fits) {
  const size_t sides = c->atlas->used ? 2 * c->views->scene->charts.count : 0;
  for (size_t i = 0; i < sides && fits->beside != NULL; i++) free(fits->beside[i]);
  free(fits->beside);
  free(fits->whole);
  free(fits->kept);
}

/* Hits of all wavelengths, each once, into the fits of the map, and of the tiles. */
static abbe_result sort_hits(abbe_caustics *c, size_t light, bool tiles, map_fits *fits,
                             abbe_error *error) {
  const size_t n = plan_of(c)->desc.wavelengths, most = c->trace.hits.stride;
  const size_t count = abbe_trace_pass_hit_count(&c->trace, light);
  abbe_map_fit *fit = fits->whole;
  abbe_result result = abbe_photon_start_run(&c->start, light, error);
  if (fits->kept != NULL) fits->kept->view = &fits->layout.view;
  for (size_t first = 0; first < n && result == ABBE_OK; first += most) {
    float *hit = NULL;
    GLuint *path = NULL;
    abbe_gpu *gpu = c->views->scene->gpu;
    abbe_trace_pass_batch(&c->trace, light, first, n - first < most ? n - first : most, n);
    result = abbe_gpu_tell(gpu, gpu->done, error); /* reading takes its time */
    if (result == ABBE_OK)
      result = abbe_trace_pass_read(&c->trace, light, first, &hit, &path, error);
    if (result == ABBE_OK) abbe_map_fit_add(fit, c->atlas, hit, path, count, most);
    if (result == ABBE_OK && fits->kept != NULL && tiles)
      abbe_map_fit_add(fits->kept, c->atlas, hit, path, count, most);
    if (result == ABBE_OK && fit->part > 0 && tiles)
      result = abbe_receiver_atlas_sort(c->atlas, hit, path, count, fit->part, fits->beside, error);
    free(hit);
    free(path);
  }
  return result;
}

/* Whether bins of the window are so wide that they would resolve nothing of light as wide as the
 * refractors. */
static bool is_too_wide(const abbe_caustics *c, size_t light, const abbe_view *view) {
  const double *near = c->views->light[light].near_view.window, *w = view->window;
  bool wide = false;
  for (int k = 0; k < 4; k += 2)
    wide = wide || (w[k + 1] - w[k]) / ABBE_FIT_BINS > (near[k + 1] - near[k]) / ABBE_WARP_STEPS;
  return wide;
}

/* Receivers may reach so far that the window has to be found by parts of parts. */
static abbe_result sort_closer(abbe_caustics *c, size_t light, map_fits *fits, abbe_map_layout *map,
                               abbe_error *error) {
  enum { MOST_TURNS = 3 };
  for (int turn = 0; turn < MOST_TURNS && is_too_wide(c, light, &map->view); turn++) {
    if (!(fits->whole->total > 0)) break;
    abbe_map_fit_layout(fits->whole, 0.02, map);
    fits->lit = map->view;
    *fits->whole = (abbe_map_fit){.view = &fits->lit};
    ABBE_TRY(sort_hits(c, light, false, fits, error));
  }
  return ABBE_OK;
}

/* Where frames follow one another, maps leave a margin for what moves. */
static double room_around(const abbe_caustics *c) {
  return plan_of(c)->desc.history > 1 ? 0.15 : 0.02;
}

static abbe_result fit_map(abbe_caustics *c, size_t light, abbe_error *error) {
  abbe_map_layout *map = &c->views->light[light].map;
  /* Tiles are for what no map of the light could hold, whichever window is given. */
  const bool given = abbe_photon_lights_map_is_given(c->views, light);
  const abbe_map_layout layout = *map;
  map_fits fits;
  abbe_result result = make_fits(c, light, given, &fits, error);
  if (result == ABBE_OK && given) {
    abbe_photon_lights_whole_map(c->views, light, map);
    abbe_photon_lights_upload(c->views);
  }
  if (result == ABBE_OK) {
    fits.whole->view = &map->view;
    result = sort_hits(c, light, true, &fits, error);
  }
  const double total = result == ABBE_OK ? fits.whole->total : 0;
  if (result == ABBE_OK && !given) result = sort_closer(c, light, &fits, map, error);
  if (given)
    *map = layout;
  else if (result == ABBE_OK && fits.kept != NULL && abbe_map_fit_serves(fits.kept))
    *map = fits.layout;
  else if (result == ABBE_OK)
    abbe_map_fit_layout(fits.whole, room_around(c), map);
  if (result == ABBE_OK)
    result = abbe_receiver_atlas_choose(c->atlas, light, fits.beside, total, error);
  free_fits(c, &fits);
  return result;
}

/* The definitions of the trace's shaders beside the scene's. */
static abbe_shader_variant photon_variant(const abbe_caustics *c,
                                          const abbe_shader_variant *scene) {
  const abbe_plan *plan = plan_of(c);
  abbe_shader_variant v = *scene;
  v.hit_stride = c->trace.hits.stride;
  v.steps = c->views->scene->tables.steps;
  v.nodes = c->spectra.nodes;
  v.map_levels = c->views->map_levels;
  v.bridge = plan->fills;
  v.doubts_bridges = plan->layers || plan->bvh;
  return v;
}

static abbe_result compile_trace(abbe_caustics *c, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  const abbe_shader_variant photons = photon_variant(c, variant);
  return abbe_trace_pass_compile(&c->trace, &photons, error);
}

/* A few photons are traced to see where light falls: maps and tiles are fitted to that. */
static abbe_result fit_maps(abbe_caustics *c, abbe_shader_variant *variant, abbe_error *error) {
  abbe_result result = compile_trace(c, variant, error);
  for (size_t light = 0; light < plan_of(c)->light_view_count && result == ABBE_OK; light++) {
    if (plan_of(c)->reaches[light] &&
        (c->atlas->used || !abbe_photon_lights_map_is_given(c->views, light)))
      result = fit_map(c, light, error);
    const double done = (double)(light + 1) / (double)plan_of(c)->light_view_count;
    if (result == ABBE_OK) result = abbe_gpu_tell(c->views->scene->gpu, done, error);
  }
  if (result != ABBE_OK || !c->atlas->used) return result;
  result = abbe_receiver_atlas_keep(c->atlas, variant, error);
  /* where tiles are kept, what is compiled is the same */
  return result == ABBE_OK && !c->atlas->used ? compile_trace(c, variant, error) : result;
}

/* The grids that lights have now: their photons, and capacity for them. */
static abbe_result use_grids(abbe_caustics *c, abbe_error *error) {
  abbe_result result = count_photons(c, error);
  abbe_photon_lights_upload(c->views); /* the unit of sums goes by photons */
  if (result == ABBE_OK) result = abbe_trace_pass_make_room(&c->trace, error);
  return result == ABBE_OK ? abbe_refine_pass_make_room(&c->refine, error) : result;
}

/* Lights share the photons of a frame, and so those of its fit. */
static size_t fit_side(size_t lights) {
  const size_t side = (size_t)lround(FIT_PHOTONS / sqrt((double)lights));
  return side > LEAST_FIT_PHOTONS ? side : LEAST_FIT_PHOTONS;
}

static abbe_result start_fit(abbe_caustics *c, abbe_error *error) {
  const size_t most = plan_of(c)->desc.photons, shared = fit_side(plan_of(c)->light_view_count);
  const size_t side = most < shared ? most : shared;
  for (size_t light = 0; light < plan_of(c)->light_view_count; light++)
    c->views->light[light].cells[0] = c->views->light[light].cells[1] = side;
  abbe_photon_lights_upload(c->views);
  return use_grids(c, error);
}

/* Where this frame's photons start in their cells. */
static abbe_result place_grids(abbe_caustics *c, abbe_error *error) {
  double shift[2];
  abbe_map_history_shift(c->map->history, plan_of(c)->desc.photon_shift, shift);
  for (size_t light = 0; light < plan_of(c)->light_view_count; light++)
    abbe_photon_lights_shift_cells(c->views, light, shift);
  c->placed = c->map->history->frame;
  abbe_photon_lights_upload(c->views);
  ABBE_TRY(abbe_light_layers_run(c->layers, error));
  return use_grids(c, error);
}

static abbe_result fit_grids(abbe_caustics *c, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_photon_lights_upload(c->views); /* the maps that were fitted */
  for (size_t light = 0; light < plan_of(c)->light_view_count && result == ABBE_OK; light++)
    if (plan_of(c)->reaches[light]) result = abbe_cell_fit_run(&c->trace, c->views, light, error);
  for (size_t light = 0; light < plan_of(c)->light_view_count; light++)
    memcpy(c->views->light[light].unshifted, c->views->light[light].near_view.window,
           sizeof c->views->light[light].unshifted);
  if (result == ABBE_OK) result = place_grids(c, error);
  return result == ABBE_OK ? abbe_gpu_tell(c->views->scene->gpu, 1, error) : result;
}

static abbe_result make_passes(abbe_caustics *c, const abbe_shader_variant *variant,
                               abbe_error *error) {
  const abbe_shader_variant photons = photon_variant(c, variant);
  abbe_result result = abbe_refine_pass_compile(&c->refine, &photons, error);
  if (result == ABBE_OK)
    result = abbe_spectral_map_make(c->views, c->atlas, variant, c->map, error);
  for (size_t light = 0; light < plan_of(c)->light_view_count; light++)
    abbe_map_history_lay_out(c->map->history, light, &c->views->light[light].map,
                             &c->atlas->tiles[light]);
  if (result == ABBE_OK)
    result = abbe_deposit_pass_make(&c->trace, &c->refine, c->map, &photons, variant, &c->deposit,
                                    error);
  return result;
}

abbe_result abbe_caustics_make(abbe_photon_lights *views, abbe_light_layers *layers,
                               abbe_receiver_atlas *atlas, abbe_spectral_map *map,
                               abbe_shader_variant *variant, abbe_caustics *out,
                               abbe_error *error) {
  abbe_caustics *c = out;
  *c = (abbe_caustics){.views = views, .layers = layers, .atlas = atlas, .map = map};
  ABBE_TRY(abbe_photon_start_make(views, layers, variant, &c->start, error));
  ABBE_TRY(abbe_light_fit_run(views, layers, variant, error));
  ABBE_TRY(abbe_gpu_tell(views->scene->gpu, 0, error));
  ABBE_TRY(abbe_light_layers_run(layers, error));
  ABBE_TRY(count_photons(c, error));
  ABBE_TRY(abbe_photon_spectra_make(views->scene, &c->spectra, error));
  ABBE_TRY(abbe_photon_ledger_make(views, &c->ledger, error));
  ABBE_TRY(abbe_trace_pass_make(&c->start, &c->spectra, atlas, &c->ledger, &c->trace, error));
  abbe_refine_pass_make(&c->trace, &c->refine);
  ABBE_TRY(abbe_receiver_atlas_make(views, variant, atlas, error));
  ABBE_TRY(start_fit(c, error));
  ABBE_TRY(fit_maps(c, variant, error));
  ABBE_TRY(fit_grids(c, error));
  return make_passes(c, variant, error);
}

void abbe_caustics_free(abbe_caustics *c) {
  abbe_deposit_pass_free(&c->deposit);
  abbe_refine_pass_free(&c->refine);
  abbe_trace_pass_free(&c->trace);
  abbe_photon_ledger_free(&c->ledger);
  abbe_photon_spectra_free(&c->spectra);
  abbe_photon_start_free(&c->start);
}

/* What was traced, and how much of the light's work is done by then, 0 to 1. */
static abbe_result deposit(abbe_caustics *c, size_t light, const abbe_hit_batch *b, bool measures,
                           double done, abbe_error *error) {
  abbe_gpu *gpu = c->views->scene->gpu;
  abbe_gpu_book_lap(gpu, ABBE_PASS_PHOTONS);
  abbe_result result = abbe_deposit_pass_run(&c->deposit, light, b, measures, error);
  const double share = ((double)light + done) / (double)plan_of(c)->light_view_count;
  if (result == ABBE_OK) result = abbe_gpu_tell(gpu, 0.5 * share, error);
  abbe_gpu_start_lap(gpu);
  return result;
}

/* Every photon takes all wavelengths, batch by batch. */
static abbe_result trace_all(abbe_caustics *c, size_t light, abbe_error *error) {
  const size_t n = plan_of(c)->desc.wavelengths;
  abbe_hit_batch b = {0};
  for (size_t done = 0; next_batch(c, &b); done = b.first + b.count) {
    abbe_trace_pass_batch(&c->trace, light, b.first, b.count, done);
    ABBE_TRY(
        deposit(c, light, &b, !c->measured[light], (double)(b.first + b.count) / (double)n, error));
  }
  return ABBE_OK;
}

/* A coarse set of wavelengths, and all those of the intervals that need them. The coarse set is
 * deposited last, when it is known which of its intervals are refined. */
static abbe_result trace_refined(abbe_caustics *c, size_t light, abbe_error *error) {
  const bool measures = !c->measured[light];
  ABBE_TRY(abbe_refine_pass_list(&c->refine, light, measures, error));
  const size_t chunks = abbe_refine_pass_chunks(&c->refine, light);
  for (size_t chunk = 0; chunk < chunks; chunk++) {
    const abbe_hit_batch b = {.set = ABBE_TRACE_REFINED, .count = c->refine.fine_nodes};
    abbe_refine_pass_run(&c->refine, light, chunk);
    ABBE_TRY(deposit(c, light, &b, measures || chunks > 1,
                     (double)(chunk + 1) / (double)(chunks + 1), error));
  }
  const abbe_hit_batch b = {.set = ABBE_TRACE_COARSE,
                            .count = c->spectra.nodes,
                            .interval_first = 1,
                            .interval_end = c->spectra.nodes};
  return deposit(c, light, &b, measures, 1, error);
}

static abbe_result trace_and_deposit(abbe_caustics *c, size_t light, abbe_error *error) {
  abbe_gpu_start_lap(c->views->scene->gpu);
  return abbe_photon_spectra_refines(&c->spectra) ? trace_refined(c, light, error)
                                                  : trace_all(c, light, error);
}

static abbe_result run_light(abbe_caustics *c, size_t light, abbe_error *error) {
  abbe_gpu *gpu = c->views->scene->gpu;
  abbe_gpu_start_lap(gpu);
  abbe_result result = abbe_photon_start_run(&c->start, light, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_PHOTON_PLACEMENT);
  abbe_spectral_map_clear(c->map);
  abbe_photon_ledger_clear(&c->ledger);
  abbe_gpu_book_lap(gpu, ABBE_PASS_SPECTRAL_MAP);
  if (result == ABBE_OK) result = trace_and_deposit(c, light, error);
  if (result != ABBE_OK) return result;
  c->measured[light] = true;
  abbe_gpu_start_lap(gpu);
  result = abbe_spectral_map_resolve(c->map, light, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_SPECTRAL_MAP);
  return result;
}

/* To the grids of the next frame in the sequence. */
static abbe_result move_on(abbe_caustics *c, abbe_error *error) {
  memset(c->measured, 0, sizeof c->measured);
  return place_grids(c, error);
}

abbe_result abbe_caustics_run(abbe_caustics *c, double *untimed_ms, abbe_error *error) {
  abbe_gpu *gpu = c->views->scene->gpu;
  abbe_result result = c->placed != c->map->history->frame ? move_on(c, error) : ABBE_OK;
  c->energy_known = gpu->statistics != NULL;
  memset(c->energy, 0, sizeof c->energy);
  for (size_t light = 0; light < plan_of(c)->light_view_count && result == ABBE_OK; light++) {
    if (!plan_of(c)->reaches[light]) continue;
    result = run_light(c, light, error);
    if (result != ABBE_OK || gpu->statistics == NULL || gpu->stopped) continue;
    const double start_ms = 1e3 * abbe_clock_seconds();
    abbe_photon_ledger_read(&c->ledger, light, &c->energy[light]);
    result = abbe_spectral_map_read_ledger(c->map, light, &c->energy[light], error);
    *untimed_ms += 1e3 * abbe_clock_seconds() - start_ms;
  }
  if (result == ABBE_OK) result = abbe_gl_check(gpu->gl, "the photon passes", error);
  if (result == ABBE_OK && !gpu->stopped) abbe_map_history_next(c->map->history);
  if (result != ABBE_OK) c->energy_known = false;
  return result;
}

void abbe_caustics_rest(abbe_caustics *c) {
  if (c->views == NULL) return;
  const abbe_hits *hits[] = {&c->trace.hits, &c->refine.hits};
  for (size_t i = 0; i < sizeof hits / sizeof *hits; i++) {
    abbe_buffer_memory_forget(&c->views->scene->gpu->memory, hits[i]->hits);
    abbe_buffer_memory_forget(&c->views->scene->gpu->memory, hits[i]->signatures);
  }
}

bool abbe_caustics_know_energy(const abbe_caustics *c) {
  return c->energy_known;
}

void abbe_caustics_energy(const abbe_caustics *c, abbe_ledger *out) {
  enum { ENTRIES = sizeof(abbe_ledger) / sizeof(double) };
  double sum[ENTRIES] = {0}, entry[ENTRIES];
  for (size_t light = 0; light < plan_of(c)->light_view_count; light++) {
    memcpy(entry, &c->energy[light], sizeof entry);
    for (size_t i = 0; i < ENTRIES; i++)
      sum[i] += entry[i] * c->views->scene->local->light[light].power;
  }
  memcpy(out, sum, sizeof sum);
}

/* x | y << 16 of each photon that there is now. */
static abbe_result read_cells(const abbe_caustics *c, size_t count, unsigned **cells,
                              abbe_error *error) {
  const abbe_gl *gl = c->views->scene->gpu->gl;
  unsigned *cell = malloc(count * ABBE_PHOTON_BYTES + ABBE_PHOTON_BYTES);
  if (cell == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu cells", count);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, c->start.photons);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, ABBE_PHOTON_HEADER,
                       (GLsizeiptr)(count * ABBE_PHOTON_BYTES), cell);
  for (size_t i = 0; i < count; i++) cell[i] = cell[i * (ABBE_PHOTON_BYTES / sizeof *cell)];
  *cells = cell;
  return abbe_gl_check(gl, "the reading of photons", error);
}

/* To world places, and W of the light as it is. */
static void place_hits(const abbe_caustics *c, size_t light, const double origin[3], float *data,
                       const unsigned *path) {
  const double power = c->views->scene->local->light[light].power;
  const size_t hits = abbe_trace_pass_hit_count(&c->trace, light);
  for (size_t i = 0; i < hits; i++) {
    float *at = data + 4 * i;
    double place[3] = {at[0], at[1], at[2]};
    if (!(at[3] > 0)) continue;
    at[3] = (float)(at[3] * power);
    if (abbe_receiver_atlas_holds(c->atlas, path[i]))
      abbe_receiver_atlas_world(c->atlas, light, at, place);
    for (size_t k = 0; k < 3; k++) at[k] = (float)(place[k] + origin[k]);
  }
}

abbe_result abbe_caustics_read_hits(abbe_caustics *c, size_t light, size_t first,
                                    const double origin[3], float **at, unsigned **path,
                                    unsigned **cell, size_t *count, abbe_error *error) {
  const size_t n = plan_of(c)->desc.wavelengths, most = c->trace.hits.stride;
  ABBE_TRY(abbe_light_layers_run(c->layers, error));
  ABBE_TRY(abbe_photon_start_run(&c->start, light, error));
  *count = c->views->light[light].photon_count;
  abbe_trace_pass_batch(&c->trace, light, first, n - first < most ? n - first : most, n);
  ABBE_TRY(abbe_trace_pass_read(&c->trace, light, first, at, path, error));
  place_hits(c, light, origin, *at, *path);
  return read_cells(c, *count, cell, error);
}
