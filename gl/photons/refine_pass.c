#include "gl/photons/refine_pass.h"

#include "gl/device/bindings.h"

enum { MAX_FINE_BYTES = 128 << 20, LEAST_PAIRS = 256 };

static size_t widest_interval(const abbe_photon_spectra *spectra) {
  const size_t n = spectra->scene->plan->desc.wavelengths, nodes = spectra->nodes;
  size_t most = 0;
  for (size_t k = 0; k + 1 < nodes; k++) {
    const size_t steps =
        abbe_spectral_tables_node(n, nodes, k + 1) - abbe_spectral_tables_node(n, nodes, k);
    if (steps > most) most = steps;
  }
  return most;
}

abbe_result abbe_refine_pass_make(abbe_trace_pass *trace, abbe_refine_pass *out,
                                  abbe_error *error) {
  ABBE_REQUIRE(trace && out, error);
  out->trace = trace;
  out->chunks = 1;
  if (abbe_photon_spectra_refines(trace->spectra))
    out->fine_nodes = widest_interval(trace->spectra) + 1;
  return ABBE_OK;
}

abbe_result abbe_refine_pass_make_room(abbe_refine_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  abbe_gpu_drop_buffers(gpu, 1, &pass->wants);
  abbe_result result =
      abbe_gpu_make_buffer(gpu, pass->trace->most_photons * 4, NULL, &pass->wants, error);
  if (result == ABBE_OK) abbe_gpu_clear_buffer(gpu, pass->wants);
  return result == ABBE_OK ? abbe_refine_pass_make_pairs(pass, 1, error) : result;
}

/* Chunks are drawn by a hash of the cell; a quarter more room covers their unevenness. */
size_t abbe_refine_pass_chunks(size_t count, size_t room) {
  return count > room ? count / (room * 4 / 5) + 1 : 1;
}

abbe_result abbe_refine_pass_make_pairs(abbe_refine_pass *pass, size_t pairs, abbe_error *error) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  abbe_gpu *gpu = spectra->scene->gpu;
  const size_t slots = spectra->scene->plan->hit_slots;
  const size_t signature_bytes = abbe_photon_signature_bytes(spectra);
  if (!abbe_photon_spectra_refines(spectra)) return ABBE_OK;
  size_t most = MAX_FINE_BYTES / (ABBE_HIT_BYTES + signature_bytes) / (slots * pass->fine_nodes);
  if (most < LEAST_PAIRS) most = LEAST_PAIRS;
  const size_t room = pairs < most ? pairs : most, chunks = abbe_refine_pass_chunks(pairs, room);
  if (chunks > pass->chunks) pass->chunks = chunks;
  if (pass->pair_room >= room) return ABBE_OK;
  abbe_gpu_drop_buffers(gpu, 1, &pass->pairs);
  abbe_hits_free(gpu, &pass->hits);
  pass->pair_room = room;
  abbe_result result =
      abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + room * 4, NULL, &pass->pairs, error);
  if (result == ABBE_OK)
    result = abbe_hits_make(gpu, room, slots, pass->fine_nodes, signature_bytes, &pass->hits, error);
  return result;
}

void abbe_refine_pass_free(abbe_refine_pass *pass) {
  if (pass->trace == NULL || pass->trace->spectra == NULL) return;
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  GLuint buffers[] = {pass->wants, pass->pairs};
  abbe_gpu_drop_buffers(gpu, 2, buffers);
  abbe_hits_free(gpu, &pass->hits);
}

abbe_result abbe_refine_pass_compile(abbe_refine_pass *pass, const abbe_shader_variant *variant,
                                     abbe_error *error) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  if (!abbe_photon_spectra_refines(spectra)) return ABBE_OK;
  return abbe_shader_variant_compute(variant, spectra->scene->gpu, "photon_select.comp", NULL,
                                     &pass->select, error);
}

void abbe_refine_pass_coarse(abbe_refine_pass *pass, size_t light) {
  abbe_gpu_clear_buffer(pass->trace->spectra->scene->gpu, pass->wants);
  abbe_trace_pass_coarse(pass->trace, light);
}

static void select_pairs(abbe_refine_pass *pass, size_t light, size_t chunk, size_t chunks) {
  const abbe_trace_pass *trace = pass->trace;
  const abbe_gpu_scene *scene = trace->spectra->scene;
  abbe_gpu *gpu = scene->gpu;
  const size_t intervals = trace->spectra->nodes - 1;
  const GLuint program = pass->select;
  abbe_gpu_scene_bind(scene);
  abbe_photon_lights_bind(trace->start->views);
  abbe_receiver_atlas_bind(trace->atlas);
  abbe_photon_start_bind(trace->start);
  abbe_gpu_clear_list(gpu, pass->pairs);
  gpu->gl->UseProgram(program);
  abbe_gpu_set_int(gpu, program, "light", (int)light);
  abbe_photon_lights_set_grid(trace->start->views, program, light);
  abbe_gpu_set_int(gpu, program, "map_size", (int)scene->plan->desc.map_size);
  gpu->gl->Uniform1fv(gpu->gl->GetUniformLocation(program, "interval_weight"), (GLsizei)intervals,
                      scene->tables.interval_weight + light * intervals);
  abbe_gpu_set_uint(gpu, program, "chunks", chunks);
  abbe_gpu_set_uint(gpu, program, "chunk", chunk);
  abbe_gpu_set_uint(gpu, program, "most_pairs", pass->pair_room);
  abbe_gpu_bind_storage(gpu, BINDING_HITS, trace->hits.hits);
  abbe_gpu_bind_storage(gpu, BINDING_SIGNATURES, trace->hits.signatures);
  abbe_gpu_bind_storage(gpu, BINDING_WANTS, pass->wants);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, pass->pairs);
  abbe_gpu_bind_storage(gpu, BINDING_PATHS, trace->hits.paths);
  abbe_gpu_dispatch_list(gpu, program, trace->hits.paths, 0,
                         trace->start->views->light[light].photon_count * scene->plan->hit_slots,
                         1);
}

size_t abbe_refine_pass_count(abbe_refine_pass *pass, size_t light) {
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  select_pairs(pass, light, 0, 1);
  abbe_gpu_clear_buffer(gpu, pass->wants);
  return abbe_gpu_read_count(gpu, pass->pairs);
}

void abbe_refine_pass_run(abbe_refine_pass *pass, size_t light, size_t chunk) {
  abbe_trace_pass *trace = pass->trace;
  abbe_gpu *gpu = trace->spectra->scene->gpu;
  select_pairs(pass, light, chunk, pass->chunks);
  abbe_trace_pass_begin(trace, light, ABBE_TRACE_REFINED, &pass->hits, pass->fine_nodes);
  abbe_gpu_set_uint(gpu, trace->program, "most_pairs", pass->pair_room);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, pass->pairs);
  abbe_gpu_dispatch_list(gpu, trace->program, pass->pairs, 0, pass->pair_room, pass->fine_nodes);
  abbe_trace_pass_end(trace, &pass->hits, pass->pair_room);
}
