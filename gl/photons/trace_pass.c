#include "gl/photons/trace_pass.h"

#include "gl/device/bindings.h"
#include "gl/photons/photon_paths.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_HIT_BYTES = 1 << 30, MAX_HIT_BYTES = 96 << 20, MOST_SAMPLES = 64 };

static const abbe_gpu_scene *scene_of(const abbe_trace_pass *pass) {
  return pass->spectra->scene;
}

/* That a buffer can hold and a shader can read as texels. */
static size_t most_hits(const abbe_trace_pass *pass) {
  GLint texels = 0;
  scene_of(pass)->gpu->gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  const size_t most =
      MOST_HIT_BYTES / (ABBE_HIT_BYTES + abbe_photon_signature_bytes(scene_of(pass)->plan));
  const size_t held = (size_t)texels * 16 / ABBE_HIT_BYTES; /* bytes: four floats a texel */
  return most < held ? most : held;
}

static size_t most_photons(const abbe_trace_pass *pass) {
  const abbe_plan *plan = scene_of(pass)->plan;
  size_t most = 1;
  for (size_t i = 0; i < plan->light_view_count; i++)
    if (pass->start->views->light[i].photon_count > most)
      most = pass->start->views->light[i].photon_count;
  return most;
}

/* Wavelengths of a batch. */
static size_t choose_samples(const abbe_trace_pass *pass, size_t room) {
  const abbe_plan *plan = scene_of(pass)->plan;
  const size_t a_sample = pass->most_photons * plan->hit_slots;
  /* A stone that keeps light inside has more slots, not fewer wavelengths at a time. */
  const size_t usual = ABBE_PLAN_EXITS + 1;
  const size_t slots =
      !plan->multi_refractor_paths && plan->hit_slots > usual ? usual : plan->hit_slots;
  const size_t a_hit = ABBE_HIT_BYTES + abbe_photon_signature_bytes(scene_of(pass)->plan);
  size_t samples = MAX_HIT_BYTES / a_hit / (pass->most_photons * slots);
  if (samples > room / a_sample) samples = room / a_sample;
  return samples < 2 ? 2 : samples > MOST_SAMPLES ? MOST_SAMPLES : samples;
}

abbe_result abbe_trace_pass_make(abbe_photon_start *start, abbe_photon_spectra *spectra,
                                 const abbe_receiver_atlas *atlas, abbe_photon_ledger *ledger,
                                 abbe_trace_pass *out, abbe_error *error) {
  *out = (abbe_trace_pass){.start = start, .spectra = spectra, .atlas = atlas, .ledger = ledger};
  const abbe_plan *plan = scene_of(out)->plan;
  out->most_photons = most_photons(out);
  const size_t a_sample = out->most_photons * plan->hit_slots, n = plan->desc.wavelengths;
  const size_t room = most_hits(out);
  if (a_sample * (n > 1 ? 2 : 1) > room)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%zu photons with %zu exits each are more than the device takes at a "
                          "time; use a grid below %zu or fewer exits",
                          out->most_photons, plan->desc.exits, plan->desc.photons);
  size_t samples = choose_samples(out, room);
  abbe_result result = ABBE_OK;
  /* No capacity to keep all of the coarse set: every photon takes all wavelengths, in batches. */
  if (a_sample * spectra->nodes > room) result = abbe_photon_spectra_take_all(spectra, error);
  out->hits.stride = abbe_photon_spectra_refines(spectra) ? spectra->nodes
                     : samples < n                        ? samples
                                                          : n;
  return result;
}

abbe_result abbe_trace_pass_make_room(abbe_trace_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t stride = pass->hits.stride;
  pass->most_photons = most_photons(pass);
  abbe_hits_free(gpu, &pass->hits);
  return abbe_hits_make(gpu, pass->most_photons, scene_of(pass)->plan->hit_slots, stride,
                        abbe_photon_signature_bytes(scene_of(pass)->plan), &pass->hits, error);
}

abbe_result abbe_hits_make(abbe_gpu *gpu, size_t items, size_t slots, size_t stride,
                           size_t signature_bytes, abbe_hits *out, abbe_error *error) {
  const size_t paths = items * slots;
  out->stride = stride;
  const size_t hits = paths * stride;
  ABBE_TRY(abbe_gpu_make_buffer(gpu, hits * ABBE_HIT_BYTES, NULL, &out->hits, error));
  ABBE_TRY(abbe_gpu_make_buffer(gpu, hits * signature_bytes, NULL, &out->signatures, error));
  ABBE_TRY(abbe_gpu_make_buffer(gpu, paths * 4, NULL, &out->marks, error));
  return abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + paths * 4, NULL, &out->paths, error);
}

void abbe_hits_free(abbe_gpu *gpu, abbe_hits *hits) {
  GLuint buffers[] = {hits->hits, hits->signatures, hits->marks, hits->paths};
  abbe_gpu_drop_buffers(gpu, sizeof buffers / sizeof *buffers, buffers);
  *hits = (abbe_hits){0};
}

void abbe_trace_pass_free(abbe_trace_pass *pass) {
  if (pass->spectra == NULL) return;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_hits_free(gpu, &pass->hits);
}

abbe_result abbe_trace_pass_compile(abbe_trace_pass *pass, const abbe_shader_variant *variant,
                                    abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  pass->here = abbe_photon_paths_serve(pass, variant);
  if (!pass->here)
    ABBE_TRY(abbe_shader_variant_compute(variant, gpu, "photon_trace.comp",
                                         abbe_shader_variant_waves(scene_of(pass)->plan),
                                         &pass->program, error));
  return abbe_shader_variant_compute(variant, gpu, "photon_paths.comp", NULL, &pass->list_paths,
                                     error);
}

/* The program is in use, everything is bound and lists are cleared; what runs it then dispatches.
 */
static void begin(abbe_trace_pass *pass, size_t light, abbe_trace_set set, const abbe_hits *hits,
                  size_t count) {
  const abbe_gpu_scene *scene = scene_of(pass);
  abbe_gpu *gpu = scene->gpu;
  const GLuint program = pass->program;
  abbe_gpu_scene_bind(scene);
  abbe_photon_lights_bind(pass->start->views);
  abbe_receiver_atlas_bind(pass->atlas);
  abbe_photon_start_bind(pass->start);
  abbe_photon_ledger_bind(pass->ledger);
  abbe_gpu_forget_samplers(gpu);
  gpu->gl->UseProgram(program);
  abbe_gpu_scene_set(scene, program);
  abbe_light_layers_set(pass->start->layers, program);
  abbe_photon_lights_set_grid(pass->start->views, program, light);
  abbe_photon_ledger_set(pass->ledger, program, light);
  abbe_gpu_set_int(gpu, program, "light", (int)light);
  abbe_gpu_set_int(gpu, program, "set", (int)set);
  abbe_gpu_set_int(gpu, program, "sample_first", 0);
  abbe_gpu_set_int(gpu, program, "sample_count", (int)count);
  abbe_gpu_set_int(gpu, program, "hit_stride", (int)hits->stride);
  abbe_gpu_set_int(gpu, program, "ledger_first", 0);
  if (scene->plan->hazy) abbe_gpu_set_int(gpu, program, "ways", 0);
  abbe_gpu_set_float(gpu, program, "share_limit", scene->plan->desc.energy_share);
  abbe_gpu_set_int(gpu, program, "fits_tiles", pass->atlas->fits ? 1 : 0);
  if (scene->plan->tints > 0)
    abbe_gpu_bind_texels(gpu, program, "tints", 5, GL_RGBA32F, pass->spectra->tints);
  abbe_gpu_clear_buffer(gpu, hits->signatures);
  abbe_gpu_clear_buffer(gpu, hits->marks);
  abbe_gpu_clear_list(gpu, hits->paths);
  abbe_gpu_bind_storage(gpu, BINDING_SAMPLE_WEIGHTS, pass->spectra->sample_weights);
  abbe_gpu_bind_storage(gpu, BINDING_HITS, hits->hits);
  abbe_gpu_bind_storage(gpu, BINDING_SIGNATURES, hits->signatures);
  abbe_gpu_bind_storage(gpu, BINDING_PATH_MARKS, hits->marks);
  /* Declared, and read of refined photons alone, whose pass binds their list. */
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, hits->paths);
}

static size_t groups_of(size_t threads) {
  return (threads + ABBE_GPU_GROUP - 1) / ABBE_GPU_GROUP;
}

/* Lists the paths of so many photons or intervals that hit anywhere. */
static void list_paths(abbe_trace_pass *pass, const abbe_hits *hits, size_t items) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t paths = items * scene_of(pass)->plan->hit_slots;
  if (paths == 0) return;
  gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  gpu->gl->UseProgram(pass->list_paths);
  abbe_gpu_set_uint(gpu, pass->list_paths, "items", items);
  abbe_gpu_bind_storage(gpu, BINDING_PATH_MARKS, hits->marks);
  abbe_gpu_bind_storage(gpu, BINDING_PATHS, hits->paths);
  abbe_gpu_dispatch(gpu, pass->list_paths, groups_of(paths));
  gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                         GL_TEXTURE_FETCH_BARRIER_BIT);
}

static bool follow_here(abbe_trace_pass *pass, const abbe_photon_batch *batch,
                        const abbe_hits *hits, size_t items) {
  if (!pass->here) return false;
  abbe_photon_paths_follow(pass, batch, hits);
  abbe_gpu_clear_list(scene_of(pass)->gpu, hits->paths);
  list_paths(pass, hits, items);
  return true;
}

static void trace_batch(abbe_trace_pass *pass, size_t light, size_t first, size_t count,
                        size_t ledger_first, bool ways) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t photons = pass->start->views->light[light].photon_count;
  const abbe_photon_batch batch = {.light = light,
                                   .set = ABBE_TRACE_ALL,
                                   .sample_first = first,
                                   .sample_count = count,
                                   .ledger_first = ledger_first};
  if (follow_here(pass, &batch, &pass->hits, photons)) return;
  begin(pass, light, ABBE_TRACE_ALL, &pass->hits, count);
  if (ways) abbe_gpu_set_int(gpu, pass->program, "ways", 1);
  abbe_gpu_set_int(gpu, pass->program, "sample_first", (int)first);
  abbe_gpu_set_int(gpu, pass->program, "ledger_first", (int)ledger_first);
  abbe_gpu_dispatch(gpu, pass->program, groups_of(photons * count));
  list_paths(pass, &pass->hits, photons);
}

void abbe_trace_pass_batch(abbe_trace_pass *pass, size_t light, size_t first, size_t count,
                           size_t ledger_first) {
  trace_batch(pass, light, first, count, ledger_first, false);
}

void abbe_trace_pass_ways(abbe_trace_pass *pass, size_t light, size_t first, size_t count) {
  trace_batch(pass, light, first, count, scene_of(pass)->plan->desc.wavelengths, true);
}

void abbe_trace_pass_coarse(abbe_trace_pass *pass, size_t light) {
  const size_t photons = pass->start->views->light[light].photon_count;
  const abbe_photon_batch batch = {
      .light = light, .set = ABBE_TRACE_COARSE, .sample_count = pass->spectra->nodes};
  if (follow_here(pass, &batch, &pass->hits, photons)) return;
  begin(pass, light, ABBE_TRACE_COARSE, &pass->hits, pass->spectra->nodes);
  abbe_gpu_dispatch(scene_of(pass)->gpu, pass->program, groups_of(photons * pass->spectra->nodes));
  list_paths(pass, &pass->hits, photons);
}

void abbe_trace_pass_pairs(abbe_trace_pass *pass, size_t light, GLuint pairs, size_t most_pairs,
                           const abbe_hits *hits, size_t count) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const abbe_photon_batch batch = {.light = light,
                                   .set = ABBE_TRACE_REFINED,
                                   .sample_count = count,
                                   .pairs = pairs,
                                   .most_pairs = most_pairs};
  if (follow_here(pass, &batch, hits, most_pairs)) return;
  begin(pass, light, ABBE_TRACE_REFINED, hits, count);
  abbe_gpu_set_uint(gpu, pass->program, "most_pairs", most_pairs);
  abbe_gpu_bind_storage(gpu, BINDING_PAIRS, pairs);
  abbe_gpu_dispatch_list(gpu, pass->program, pairs, 0, most_pairs, count);
  list_paths(pass, hits, most_pairs);
}

size_t abbe_trace_pass_hit_count(const abbe_trace_pass *pass, size_t light) {
  return pass->start->views->light[light].photon_count * scene_of(pass)->plan->hit_slots *
         pass->hits.stride;
}

/* Hits as the device has them, and what is read of them. */
typedef struct reading {
  float *raw, *hit;
  GLuint *signature, *path;
} reading;

static void read_some(const abbe_trace_pass *pass, size_t light, size_t first, size_t at,
                      size_t count, const reading *r) {
  const abbe_gl *gl = scene_of(pass)->gpu->gl;
  const size_t bytes = abbe_photon_signature_bytes(scene_of(pass)->plan);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, pass->hits.hits);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(at * ABBE_HIT_BYTES),
                       (GLsizeiptr)(count * ABBE_HIT_BYTES), r->raw);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, pass->hits.signatures);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)(at * bytes),
                       (GLsizeiptr)(count * bytes), r->signature);
  abbe_receiver_atlas_place(pass->atlas, light, r->raw, r->signature, bytes / sizeof *r->signature,
                            count);
  abbe_photon_attenuate(pass->spectra, first, pass->hits.stride, count, r->raw, r->signature);
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < 4 && r->signature[i] == 0; k++) r->raw[4 * i + k] = 0;
  memcpy(r->hit + 4 * at, r->raw, 4 * count * sizeof *r->hit);
  memcpy(r->path + at, r->signature, count * sizeof *r->path);
}

abbe_result abbe_trace_pass_read(abbe_trace_pass *pass, size_t light, size_t first, float **hits,
                                 GLuint **paths, abbe_error *error) {
  enum { AT_ONCE = 1 << 16 };
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t count = abbe_trace_pass_hit_count(pass, light);
  const size_t step = AT_ONCE / pass->hits.stride * pass->hits.stride;
  const reading r = {.raw = malloc(step * ABBE_HIT_BYTES),
                     .hit = malloc(4 * count * sizeof *r.hit + 1),
                     .signature = malloc(step * abbe_photon_signature_bytes(scene_of(pass)->plan)),
                     .path = malloc(count * sizeof *r.path + 1)};
  const bool whole = r.raw != NULL && r.hit != NULL && r.signature != NULL && r.path != NULL;
  abbe_result result =
      whole ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu hits", count);
  for (size_t at = 0; at < count && result == ABBE_OK; at += step) {
    read_some(pass, light, first, at, count - at < step ? count - at : step, &r);
    result = abbe_gpu_tell(gpu, gpu->done, error);
  }
  if (result == ABBE_OK) result = abbe_gl_check(gpu->gl, "the reading of hits", error);
  free(r.raw);
  free(r.signature);
  if (result != ABBE_OK) free(r.hit);
  if (result != ABBE_OK || paths == NULL) free(r.path);
  if (result != ABBE_OK) return result;
  *hits = r.hit;
  if (paths != NULL) *paths = r.path;
  return ABBE_OK;
}
