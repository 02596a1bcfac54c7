#include "gl/caustics/deposit_pass.h"

#include "gl/caustics/path_splats.h"
#include "gl/device/bindings.h"

enum { SPLAT_BYTES = 4 * ABBE_SPLAT_WORDS };
enum { LEAST_SPLATS = 1 << 12, FIRST_SPLATS = 1 << 20, MAX_SPLATS = 4 << 20 };
enum { PAIR_INTERVALS = 8 }; /* pair_list.glsl */
enum { SPLATS_A_HIT = 4 };   /* capacity at first; the first frame makes more */

static const abbe_gpu_scene *scene_of(const abbe_deposit_pass *pass) {
  return pass->trace->spectra->scene;
}

static abbe_result make_room(abbe_deposit_pass *pass, size_t splats, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_gpu_drop_buffers(gpu, 1, &pass->splats);
  pass->splat_room = splats;
  return abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + splats * SPLAT_BYTES, NULL, &pass->splats,
                              error);
}

/* The memory pages of a buffer are written before the first frame, so few photons have a small
 * one. */
static size_t first_room(const abbe_trace_pass *trace) {
  const size_t wavelengths = trace->spectra->scene->plan->desc.wavelengths;
  const size_t splats = trace->most_photons * wavelengths * SPLATS_A_HIT;
  return splats < LEAST_SPLATS ? LEAST_SPLATS : splats < FIRST_SPLATS ? splats : FIRST_SPLATS;
}

abbe_result abbe_deposit_pass_make(const abbe_trace_pass *trace, const abbe_refine_pass *refine,
                                   abbe_spectral_map *map, const abbe_shader_variant *photons,
                                   const abbe_shader_variant *scene, abbe_deposit_pass *out,
                                   abbe_error *error) {
  abbe_gpu *gpu = trace->spectra->scene->gpu;
  *out = (abbe_deposit_pass){
      .trace = trace, .refine = refine, .map = map, .chunks = 1, .most_splats = MAX_SPLATS};
  if (gpu->software) return ABBE_OK;
  ABBE_TRY(
      abbe_shader_variant_compute(photons, gpu, "photon_deposit.comp", NULL, &out->list, error));
  ABBE_TRY(abbe_shader_variant_compute(scene, gpu, "photon_splat.comp", NULL, &out->add, error));
  return make_room(out, first_room(trace), error);
}

void abbe_deposit_pass_free(abbe_deposit_pass *pass) {
  if (pass->trace == NULL || pass->trace->spectra == NULL) return;
  abbe_gpu_drop_buffers(scene_of(pass)->gpu, 1, &pass->splats);
}

static void set_batch(const abbe_deposit_pass *pass, GLuint program, size_t light,
                      const abbe_hit_batch *b, size_t chunk) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  const abbe_plan *plan = spectra->scene->plan;
  abbe_gpu *gpu = spectra->scene->gpu;
  const bool fine = b->set == ABBE_TRACE_REFINED;
  const size_t rows = plan->light_view_count * abbe_plan_surfaces(plan);
  abbe_gpu_set_int(gpu, program, "light", (int)light);
  abbe_photon_lights_set_grid(pass->map->views, program, light);
  abbe_gpu_set_int(gpu, program, "map_size", (int)plan->desc.map_size);
  abbe_gpu_set_int(gpu, program, "sample_first", (int)b->first);
  /* samples of the hits that photons have; a refined interval may have more of its own */
  abbe_gpu_set_int(gpu, program, "sample_count", (int)(fine ? spectra->nodes : b->count));
  abbe_gpu_set_int(gpu, program, "interval_first", (int)b->interval_first);
  abbe_gpu_set_int(gpu, program, "interval_end", (int)b->interval_end);
  abbe_gpu_set_int(gpu, program, "nodes", (int)(fine ? plan->desc.wavelengths : spectra->nodes));
  abbe_gpu_set_int(gpu, program, "table_first", fine ? (int)(rows * (spectra->nodes + 1)) : 0);
  abbe_photon_ledger_set(pass->trace->ledger, program, light);
  abbe_gpu_set_uint(gpu, program, "chunks", pass->chunks);
  abbe_gpu_set_uint(gpu, program, "chunk", chunk);
  abbe_gpu_set_uint(gpu, program, "most", pass->splat_room);
  if (plan->tints > 0)
    abbe_gpu_set_int(gpu, program, "tints_first",
                     fine ? (int)(spectra->nodes * abbe_plan_surfaces(plan) * ABBE_TINT_TEXELS)
                          : 0);
}

static void bind_hits(const abbe_deposit_pass *pass, GLuint program, bool fine) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  abbe_gpu *gpu = spectra->scene->gpu;
  const abbe_plan *plan = spectra->scene->plan;
  const GLenum signature = abbe_photon_signature_format(plan);
  const abbe_hits *hits = &pass->trace->hits, *nodes = fine ? &pass->refine->hits : hits;
  abbe_gpu_bind_texels(gpu, program, "hits", 0, GL_RGBA32F, hits->hits);
  abbe_gpu_bind_texels(gpu, program, "signatures", 1, signature, hits->signatures);
  abbe_gpu_bind_texels(gpu, program, "interval_sums", 2, GL_RGBA32F, spectra->intervals);
  abbe_gpu_bind_texels(gpu, program, "node_hits", 3, GL_RGBA32F, nodes->hits);
  abbe_gpu_bind_texels(gpu, program, "node_signatures", 4, signature, nodes->signatures);
  abbe_gpu_set_int(gpu, program, "fine_nodes", fine ? (int)pass->refine->fine_nodes : 0);
  if (plan->tints > 0) abbe_gpu_bind_texels(gpu, program, "tints", 5, GL_RGBA32F, spectra->tints);
}

/* Lists the batch's splats, those of one chunk of the photons. */
static void list_splats(abbe_deposit_pass *pass, size_t light, const abbe_hit_batch *b,
                        size_t chunk) {
  const abbe_trace_pass *trace = pass->trace;
  const abbe_gpu_scene *scene = scene_of(pass);
  abbe_gpu *gpu = scene->gpu;
  const bool fine = b->set == ABBE_TRACE_REFINED;
  const GLuint program = pass->list;
  const GLuint paths = fine ? pass->refine->hits.paths : trace->hits.paths;
  const size_t items =
      fine ? pass->refine->pair_room : trace->start->views->light[light].photon_count;
  abbe_gpu_scene_bind(scene);
  abbe_photon_lights_bind(trace->start->views);
  abbe_receiver_atlas_bind(trace->atlas);
  abbe_photon_start_bind(trace->start);
  abbe_photon_ledger_bind(trace->ledger);
  abbe_gpu_forget_samplers(gpu);
  gpu->gl->UseProgram(program);
  set_batch(pass, program, light, b, chunk);
  abbe_gpu_clear_list(gpu, pass->splats);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, fine ? pass->refine->pairs : paths);
  abbe_gpu_bind_storage(gpu, BINDING_WANTS, pass->refine->wants);
  abbe_gpu_bind_storage(gpu, BINDING_SPLATS, pass->splats);
  abbe_gpu_bind_storage(gpu, BINDING_PATHS, paths);
  bind_hits(pass, program, fine);
  abbe_gpu_dispatch_list(gpu, program, paths, 0, items * scene->plan->hit_slots, 1);
}

/* More chunks, each a part of one that there was: what fitted a capacity before fits it still. They
 * are drawn by a hash of the cell; a quarter more capacity covers their unevenness. */
static void part_chunks(abbe_deposit_pass *pass, size_t splats) {
  pass->chunks *= splats / (pass->most_splats * 4 / 5) + 1;
}

/* Lists a chunk; again where it has more splats than the capacity, with more capacity, or in more
 * chunks as long as it is the first one. */
static abbe_result list_measured(abbe_deposit_pass *pass, size_t light, const abbe_hit_batch *batch,
                                 size_t chunk, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_photon_ledger_save(pass->trace->ledger);
  while (result == ABBE_OK) {
    list_splats(pass, light, batch, chunk);
    const size_t count = abbe_gpu_read_count(scene_of(pass)->gpu, pass->splats);
    if (count <= pass->splat_room || scene_of(pass)->gpu->stopped) return ABBE_OK;
    abbe_photon_ledger_restore(pass->trace->ledger); /* a batch is entered once */
    if (chunk == 0 && count > pass->most_splats) part_chunks(pass, count);
    const size_t more = count + count / 4;
    size_t room = chunk == 0 && more > pass->most_splats ? pass->most_splats : more;
    if (room < pass->splat_room) room = pass->splat_room; /* others may need what there is */
    result = make_room(pass, room, error);
  }
  return result;
}

static bool goes_on(void *gpu) {
  return abbe_gpu_ask(gpu);
}

/* What photon_deposit.comp would be told of the batch. */
static void tell_batch(const abbe_deposit_pass *pass, size_t light, const abbe_hit_batch *b,
                       abbe_path_splats *p) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  const abbe_photon_light *state = &pass->map->views->light[light];
  const abbe_receiver_tiles *tiles = &pass->trace->atlas->tiles[light];
  const abbe_plan *plan = spectra->scene->plan;
  const bool fine = b->set == ABBE_TRACE_REFINED;
  *p = (abbe_path_splats){
      .light = light,
      .refractors = abbe_plan_surfaces(plan),
      .slots = plan->hit_slots,
      .stride = pass->trace->hits.stride,
      .signature_words = abbe_photon_signature_bytes(plan) / sizeof *p->signatures,
      .tint_count = plan->tints,
      .interval_texels = plan->tints > 0 ? 3 : 2,
      .table_first =
          fine ? plan->light_view_count * abbe_plan_surfaces(plan) * (spectra->nodes + 1) : 0,
      .grid = {(int)state->cells[0], (int)state->cells[1]},
      .map_size = (int)plan->desc.map_size,
      .map_levels = (int)pass->map->views->map_levels,
      .warp_steps = ABBE_WARP_STEPS,
      .steps = (int)spectra->scene->tables.steps,
      .sample_first = (int)b->first,
      .sample_count = (int)(fine ? spectra->nodes : b->count),
      .interval_first = (int)b->interval_first,
      .interval_end = (int)b->interval_end,
      .nodes = (int)(fine ? plan->desc.wavelengths : spectra->nodes),
      .fine_nodes = fine ? (int)pass->refine->fine_nodes : 0,
      .unit = (float)abbe_photon_lights_map_unit(pass->map->views, light),
      .ledger_unit = (float)abbe_photon_ledger_unit(pass->trace->ledger, light),
      .bridges = plan->fills,
      .doubts = plan->layers || plan->bvh};
  abbe_view_pack(&state->map.view, p->view);
  for (int i = 0; i < 3; i++) p->depth[i] = p->view[3] > 0.5f ? p->view[12 + i] : 0;
  p->depth[3] = p->view[3] > 0.5f ? 0 : 1;
  for (size_t k = 0; k < tiles->count; k++)
    abbe_receiver_tile_pack(&tiles->tile[k],
                            spectra->scene->charts.parallelogram[tiles->tile[k].chart_side / 2],
                            p->tile[k]);
}

/* And what it would read. */
static void map_paths(const abbe_deposit_pass *pass, bool fine, abbe_gpu_maps *m,
                      abbe_path_splats *p) {
  const abbe_trace_pass *trace = pass->trace;
  const abbe_hits *nodes = fine ? &pass->refine->hits : &trace->hits;
  const size_t tints = fine ? trace->spectra->nodes * p->refractors * ABBE_TINT_TEXELS : 0;
  const char *photons = abbe_gpu_map(m, trace->start->photons, GL_MAP_READ_BIT);
  p->hits = abbe_gpu_map(m, trace->hits.hits, GL_MAP_READ_BIT);
  p->signatures = abbe_gpu_map(m, trace->hits.signatures, GL_MAP_READ_BIT);
  p->node_hits = p->hits;
  p->node_signatures = p->signatures;
  if (fine) {
    p->node_hits = abbe_gpu_map(m, nodes->hits, GL_MAP_READ_BIT);
    p->node_signatures = abbe_gpu_map(m, nodes->signatures, GL_MAP_READ_BIT);
    p->pairs = abbe_gpu_map(m, pass->refine->pairs, GL_MAP_READ_BIT);
  }
  p->intervals = abbe_gpu_map(m, trace->spectra->intervals, GL_MAP_READ_BIT);
  p->photon_of_cell = abbe_gpu_map(m, trace->start->photon_of_cell, GL_MAP_READ_BIT);
  p->wants = abbe_gpu_map(m, pass->refine->wants, GL_MAP_READ_BIT);
  p->paths = abbe_gpu_map(m, nodes->paths, GL_MAP_READ_BIT);
  p->warp = abbe_gpu_map(m, pass->map->views->warps, GL_MAP_READ_BIT);
  if (p->tint_count > 0) p->tints = abbe_gpu_map(m, trace->spectra->tints, GL_MAP_READ_BIT);
  if (!m->whole) return;
  p->photons = (const abbe_photon *)(const void *)(photons + ABBE_PHOTON_HEADER);
  p->warp += p->light * ABBE_WARP_STEPS;
  if (p->tint_count > 0) p->tints += tints;
  if (fine) p->pairs += ABBE_GPU_LIST_HEADER / sizeof *p->pairs;
  p->paths += ABBE_GPU_LIST_HEADER / sizeof *p->paths;
  p->count = p->paths[-(ptrdiff_t)(ABBE_GPU_LIST_HEADER / sizeof *p->paths)];
}

/* On the processor's own threads, which need no list and no atomics. */
static abbe_result deposit_here(abbe_deposit_pass *pass, size_t light, const abbe_hit_batch *b,
                                abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const abbe_photon_lights *views = pass->map->views;
  const abbe_receiver_tiles *tiles = &pass->trace->atlas->tiles[light];
  const size_t nodes = pass->trace->spectra->nodes;
  abbe_splat_sums sums = {.side = scene_of(pass)->plan->desc.map_size,
                          .texels = views->map_texels,
                          .wide = views->wide,
                          .edges = scene_of(pass)->plan->edges,
                          .tiles = tiles->count > 0 ? tiles : NULL};
  abbe_gpu_maps m = {.gl = gpu->gl, .whole = true};
  abbe_path_splats paths;
  int coarse_node[PAIR_INTERVALS + 1] = {0};
  int64_t entry[3] = {0, 0, 0};
  tell_batch(pass, light, b, &paths);
  for (size_t k = 0; k < nodes && k <= PAIR_INTERVALS; k++)
    coarse_node[k] =
        (int)abbe_spectral_tables_node(scene_of(pass)->plan->desc.wavelengths, nodes, k);
  paths.coarse_node = coarse_node;
  sums.word = abbe_gpu_map(&m, pass->map->sums, GL_MAP_READ_BIT | GL_MAP_WRITE_BIT);
  map_paths(pass, b->set == ABBE_TRACE_REFINED, &m, &paths);
  const abbe_splat_source source = {.list = abbe_path_splats_list,
                                    .from = &paths,
                                    .count = paths.count,
                                    .step = ABBE_PATHS,
                                    .most = abbe_path_splats_most(&paths)};
  abbe_result result = ABBE_OK;
  if (m.whole) result = abbe_splat_sums_add(&sums, &source, entry, goes_on, gpu, error);
  abbe_gpu_unmap(&m);
  const int64_t entries[ABBE_LEDGER_ENTRIES] = {[ABBE_LEDGER_INTERPOLATED] = entry[0],
                                                [ABBE_LEDGER_ABSORBED] = entry[1],
                                                [ABBE_LEDGER_MISSED] = entry[2]};
  abbe_photon_ledger_enter(pass->trace->ledger, entries);
  return result == ABBE_OK ? abbe_gl_check(gpu->gl, "the deposit of photons", error) : result;
}

static void add_splats(abbe_deposit_pass *pass, size_t light) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  gpu->gl->UseProgram(pass->add);
  abbe_gpu_set_int(gpu, pass->add, "light", (int)light);
  abbe_gpu_set_int(gpu, pass->add, "map_size", (int)scene_of(pass)->plan->desc.map_size);
  abbe_gpu_set_uint(gpu, pass->add, "most", pass->splat_room);
  abbe_gpu_set_int(gpu, pass->add, "has_edges", scene_of(pass)->plan->edges ? 1 : 0);
  abbe_gpu_set_uint(gpu, pass->add, "map_texels", pass->map->views->map_texels);
  abbe_gpu_bind_storage(gpu, BINDING_MAP_SUMS, pass->map->sums);
  abbe_gpu_dispatch_list(gpu, pass->add, pass->splats, 0, pass->splat_room, 1);
}

abbe_result abbe_deposit_pass_run(abbe_deposit_pass *pass, size_t light,
                                  const abbe_hit_batch *batch, bool measures, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const bool fills = scene_of(pass)->plan->fills;
  abbe_result result = ABBE_OK;
  if (gpu->software) {
    result = deposit_here(pass, light, batch, error);
    abbe_gpu_book_lap(gpu, fills ? ABBE_PASS_GAP_FILL : ABBE_PASS_SPECTRAL_MAP);
    return result;
  }
  for (size_t chunk = 0; chunk < pass->chunks && result == ABBE_OK; chunk++) {
    if (measures)
      result = list_measured(pass, light, batch, chunk, error);
    else
      list_splats(pass, light, batch, chunk);
    abbe_gpu_book_lap(gpu, fills ? ABBE_PASS_GAP_FILL : ABBE_PASS_SPECTRAL_MAP);
    if (result == ABBE_OK) add_splats(pass, light);
    abbe_gpu_book_lap(gpu, ABBE_PASS_SPECTRAL_MAP);
  }
  return result;
}
