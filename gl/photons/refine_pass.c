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
  const abbe_photon_spectra *spectra = trace->spectra;
  abbe_gpu *gpu = spectra->scene->gpu;
  const size_t slots = spectra->scene->plan->hit_slots;
  const size_t signature_bytes = abbe_photon_signature_bytes(spectra);
  out->trace = trace;
  out->chunks = 1;
  abbe_result result = abbe_gpu_make_buffer(gpu, trace->most_photons * 4, NULL, &out->wants, error);
  if (result == ABBE_OK) abbe_gpu_clear_buffer(gpu, out->wants);
  if (result != ABBE_OK || !abbe_photon_spectra_refines(spectra)) return result;
  out->fine_nodes = widest_interval(spectra) + 1;
  const size_t a_pair = slots * out->fine_nodes;
  const size_t most = trace->most_photons * (spectra->nodes - 1);
  out->pair_room = MAX_FINE_BYTES / (ABBE_HIT_BYTES + signature_bytes) / a_pair;
  if (out->pair_room < LEAST_PAIRS) out->pair_room = LEAST_PAIRS;
  if (out->pair_room > most) out->pair_room = most;
  result = abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + out->pair_room * 4, NULL, &out->pairs,
                                error);
  if (result == ABBE_OK)
    result = abbe_hits_make(gpu, out->pair_room, slots, out->fine_nodes, signature_bytes,
                            &out->hits, error);
  return result;
}

void abbe_refine_pass_free(abbe_refine_pass *pass) {
  if (pass->trace == NULL || pass->trace->spectra == NULL) return;
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  const GLuint buffers[] = {pass->wants, pass->pairs};
  gpu->gl->DeleteBuffers(2, buffers);
  gpu->gl->DeleteProgram(pass->select);
  abbe_hits_free(gpu, &pass->hits);
}

abbe_result abbe_refine_pass_compile(abbe_refine_pass *pass, const abbe_shader_variant *variant,
                                     abbe_error *error) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  if (!abbe_photon_spectra_refines(spectra)) return ABBE_OK;
  return abbe_shader_variant_compute(variant, spectra->scene->gpu->gl, "photon_select.comp", NULL,
                                     &pass->select, error);
}

void abbe_refine_pass_coarse(abbe_refine_pass *pass, size_t light) {
  abbe_gpu_clear_buffer(pass->trace->spectra->scene->gpu, pass->wants);
  abbe_trace_pass_coarse(pass->trace, light);
}

static void select_pairs(abbe_refine_pass *pass, size_t light, size_t chunk) {
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
  abbe_gpu_set_uint(gpu, program, "chunks", pass->chunks);
  abbe_gpu_set_uint(gpu, program, "chunk", chunk);
  abbe_gpu_set_uint(gpu, program, "most_pairs", pass->pair_room);
  abbe_gpu_bind_storage(gpu, BINDING_HITS, trace->hits.hits);
  abbe_gpu_bind_storage(gpu, BINDING_SIGNATURES, trace->hits.signatures);
  abbe_gpu_bind_storage(gpu, BINDING_WANTS, pass->wants);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, pass->pairs);
  abbe_gpu_bind_storage(gpu, BINDING_PATHS, trace->hits.paths);
  abbe_gpu_dispatch_list(gpu, program, trace->hits.paths,
                         trace->start->views->light[light].photon_count * scene->plan->hit_slots,
                         1);
}

size_t abbe_refine_pass_count(abbe_refine_pass *pass, size_t light) {
  select_pairs(pass, light, 0);
  return abbe_gpu_read_count(pass->trace->spectra->scene->gpu, pass->pairs);
}

void abbe_refine_pass_run(abbe_refine_pass *pass, size_t light, size_t chunk) {
  abbe_trace_pass *trace = pass->trace;
  abbe_gpu *gpu = trace->spectra->scene->gpu;
  select_pairs(pass, light, chunk);
  abbe_trace_pass_begin(trace, light, ABBE_TRACE_REFINED, &pass->hits, pass->fine_nodes);
  abbe_gpu_set_uint(gpu, trace->program, "most_pairs", pass->pair_room);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, pass->pairs);
  abbe_gpu_dispatch_list(gpu, trace->program, pass->pairs, pass->pair_room, pass->fine_nodes);
  abbe_trace_pass_end(trace, &pass->hits, pass->pair_room);
}
