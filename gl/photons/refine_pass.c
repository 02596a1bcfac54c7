#include "gl/photons/refine_pass.h"

#include "gl/device/bindings.h"

enum { MAX_FINE_BYTES = 128 << 20, LEAST_PAIRS = 256, PAIR_BYTES = 4 };

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

void abbe_refine_pass_make(abbe_trace_pass *trace, abbe_refine_pass *out) {
  out->trace = trace;
  if (!abbe_photon_spectra_refines(trace->spectra)) return;
  out->fine_nodes = widest_interval(trace->spectra) + 1;
  const size_t hit_bytes =
      ABBE_HIT_BYTES + abbe_photon_signature_bytes(trace->spectra->scene->plan);
  const size_t hits = trace->spectra->scene->plan->hit_slots * out->fine_nodes;
  out->most_pairs = MAX_FINE_BYTES / hit_bytes / hits;
  if (out->most_pairs < LEAST_PAIRS) out->most_pairs = LEAST_PAIRS;
}

static abbe_result make_list(abbe_gpu *gpu, size_t pairs, GLuint *list, abbe_error *error) {
  abbe_gpu_drop_buffers(gpu, 1, list);
  return abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + pairs * PAIR_BYTES, NULL, list, error);
}

abbe_result abbe_refine_pass_make_room(abbe_refine_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  abbe_gpu_drop_buffers(gpu, 1, &pass->wants);
  ABBE_TRY(abbe_gpu_make_buffer(gpu, pass->trace->most_photons * 4, NULL, &pass->wants, error));
  abbe_gpu_clear_buffer(gpu, pass->wants);
  return ABBE_OK;
}

/* For all that a light's photons need. */
static abbe_result make_asked(abbe_refine_pass *pass, size_t pairs, abbe_error *error) {
  if (pass->asked != 0 && pairs <= pass->asked_room) return ABBE_OK;
  pass->asked_room = pairs;
  return make_list(pass->trace->spectra->scene->gpu, pairs, &pass->asked, error);
}

/* For a chunk of so many. */
static abbe_result make_pairs(abbe_refine_pass *pass, size_t pairs, abbe_error *error) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  const size_t room = pairs < pass->most_pairs ? pairs : pass->most_pairs;
  if (room <= pass->pair_room) return ABBE_OK;
  abbe_hits_free(spectra->scene->gpu, &pass->hits);
  pass->pair_room = room;
  ABBE_TRY(make_list(spectra->scene->gpu, room, &pass->pairs, error));
  return abbe_hits_make(spectra->scene->gpu, room, spectra->scene->plan->hit_slots,
                        pass->fine_nodes, abbe_photon_signature_bytes(spectra->scene->plan),
                        &pass->hits, error);
}

void abbe_refine_pass_free(abbe_refine_pass *pass) {
  if (pass->trace == NULL || pass->trace->spectra == NULL) return;
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  GLuint buffers[] = {pass->wants, pass->asked, pass->pairs};
  abbe_gpu_drop_buffers(gpu, sizeof buffers / sizeof *buffers, buffers);
  abbe_hits_free(gpu, &pass->hits);
}

abbe_result abbe_refine_pass_compile(abbe_refine_pass *pass, const abbe_shader_variant *variant,
                                     abbe_error *error) {
  const abbe_photon_spectra *spectra = pass->trace->spectra;
  if (!abbe_photon_spectra_refines(spectra)) return ABBE_OK;
  return abbe_shader_variant_compute(variant, spectra->scene->gpu, "photon_select.comp", NULL,
                                     &pass->select, error);
}

/* All intervals of the light's coarse set that need more wavelengths. */
static void select_pairs(abbe_refine_pass *pass, size_t light) {
  const abbe_trace_pass *trace = pass->trace;
  const abbe_gpu_scene *scene = trace->spectra->scene;
  abbe_gpu *gpu = scene->gpu;
  const size_t intervals = trace->spectra->nodes - 1;
  const GLuint program = pass->select;
  abbe_gpu_scene_bind(scene);
  abbe_photon_lights_bind(trace->start->views);
  abbe_receiver_atlas_bind(trace->atlas);
  abbe_photon_start_bind(trace->start);
  abbe_gpu_clear_buffer(gpu, pass->wants);
  abbe_gpu_clear_list(gpu, pass->asked);
  gpu->gl->UseProgram(program);
  abbe_gpu_set_int(gpu, program, "light", (int)light);
  abbe_photon_lights_set_grid(trace->start->views, program, light);
  abbe_gpu_set_int(gpu, program, "map_size", (int)scene->plan->desc.map_size);
  gpu->gl->Uniform1fv(gpu->gl->GetUniformLocation(program, "interval_weight"), (GLsizei)intervals,
                      scene->tables.interval_weight + light * intervals);
  abbe_gpu_set_uint(gpu, program, "most_pairs", pass->asked_room);
  abbe_gpu_bind_storage(gpu, BINDING_HITS, trace->hits.hits);
  abbe_gpu_bind_storage(gpu, BINDING_SIGNATURES, trace->hits.signatures);
  if (scene->plan->tints > 0)
    abbe_gpu_bind_texels(gpu, program, "tints", 5, GL_RGBA32F, trace->spectra->tints);
  abbe_gpu_bind_storage(gpu, BINDING_WANTS, pass->wants);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, pass->asked);
  abbe_gpu_bind_storage(gpu, BINDING_PATHS, trace->hits.paths);
  abbe_gpu_dispatch_list(gpu, program, trace->hits.paths, 0,
                         trace->start->views->light[light].photon_count * scene->plan->hit_slots,
                         1);
}

abbe_result abbe_refine_pass_list(abbe_refine_pass *pass, size_t light, bool measures,
                                  abbe_error *error) {
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  abbe_trace_pass_coarse(pass->trace, light);
  abbe_result result = make_asked(pass, LEAST_PAIRS, error);
  if (result != ABBE_OK) return result;
  select_pairs(pass, light);
  if (!measures) return ABBE_OK;
  const size_t count = abbe_gpu_read_count(gpu, pass->asked);
  if (gpu->stopped) return ABBE_OK; /* and not all were asked */
  if (count > pass->asked_room) {
    result = make_asked(pass, count, error);
    if (result == ABBE_OK) select_pairs(pass, light);
  }
  if (result == ABBE_OK) result = make_pairs(pass, count, error);
  pass->count[light] = result == ABBE_OK ? count : 0;
  return result;
}

size_t abbe_refine_pass_chunks(const abbe_refine_pass *pass, size_t light) {
  const size_t count = pass->count[light];
  return count > 0 ? (count + pass->pair_room - 1) / pass->pair_room : 0;
}

/* A chunk is a range of the list. */
static void take_chunk(abbe_refine_pass *pass, size_t light, size_t chunk) {
  abbe_gpu *gpu = pass->trace->spectra->scene->gpu;
  const size_t first = chunk * pass->pair_room, left = pass->count[light] - first;
  const size_t count = left < pass->pair_room ? left : pass->pair_room;
  abbe_gpu_set_list(gpu, pass->pairs, count);
  abbe_gpu_copy(gpu, pass->asked, ABBE_GPU_LIST_HEADER + first * PAIR_BYTES, pass->pairs,
                ABBE_GPU_LIST_HEADER, count * PAIR_BYTES);
}

void abbe_refine_pass_run(abbe_refine_pass *pass, size_t light, size_t chunk) {
  take_chunk(pass, light, chunk);
  abbe_trace_pass_pairs(pass->trace, light, pass->pairs, pass->pair_room, &pass->hits,
                        pass->fine_nodes);
}
