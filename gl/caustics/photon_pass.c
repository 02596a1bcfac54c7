#include "gl/device/program.h"
#include "gl/renderer_state.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LIST_HEADER = 16, SPLAT_BYTES = 48, MAX_SPLATS = 4 << 20 };
enum { MOST_LANDING_BYTES = 1 << 30, LEAST_LANES = 7 };
enum { PHOTON_DEFINES = 2560 };
enum { MAX_LANDING_BYTES = 96 << 20 };

/* What is taken back may come to a little more than what was entered, by what is known only between
 * two wavelengths. */
static double wide(const GLuint *lo_hi) {
  return ldexp((double)(GLint)lo_hi[1], 32) + lo_hi[0];
}

static double ledger_unit(const abbe_renderer *r, size_t light) {
  /* A group of 256 photons sums in 32 bits. */
  return ldexp(r->light[light].cell_flux, -22);
}

void abbe_renderer_clear_buffer(abbe_renderer *r, GLuint buffer) {
  static const GLuint zero = 0;
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  r->gl->ClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                         &zero);
}

static void clear_count(abbe_renderer *r, GLuint list) {
  static const GLuint zero = 0;
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, &zero);
}

static size_t read_count(abbe_renderer *r, GLuint list) {
  GLuint count = 0;
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
  return count;
}

/* So many threads an element of the list; `most` is its room. The program is set up by then. */
void abbe_renderer_dispatch_list(abbe_renderer *r, GLuint program, GLuint list, size_t most,
                                 size_t threads) {
  const abbe_gl *gl = r->gl;
  gl->UseProgram(r->list_groups);
  gl->Uniform1ui(gl->GetUniformLocation(r->list_groups, "group_size"), PHOTON_GROUP);
  gl->Uniform1ui(gl->GetUniformLocation(r->list_groups, "most"), (GLuint)most);
  gl->Uniform1ui(gl->GetUniformLocation(r->list_groups, "threads"), (GLuint)threads);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LIST, list);
  gl->DispatchCompute(1, 1, 1);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  gl->UseProgram(program);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LIST,
                     program == r->trace             ? r->pair_list
                     : program == r->refraction_fine ? r->refine_list
                                                     : r->splat_list);
  gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, list);
  gl->DispatchComputeIndirect(4);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void abbe_renderer_begin_trace(abbe_renderer *r, size_t light, trace_set set, size_t count) {
  const bool fine = set == TRACE_REFINED;
  abbe_renderer_bind_tables(r);
  r->gl->UseProgram(r->trace);
  abbe_renderer_set_lighting(r, r->trace);
  abbe_renderer_bind_texture(r, r->trace, "layer_owner", 4, r->light_owner);
  abbe_renderer_set_int(r, r->trace, "light", (int)light);
  abbe_renderer_set_grid(r, r->trace, light);
  abbe_renderer_set_int(r, r->trace, "set", (int)set);
  abbe_renderer_set_int(r, r->trace, "lane_first", 0);
  abbe_renderer_set_int(r, r->trace, "lane_count", (int)count);
  abbe_renderer_set_int(r, r->trace, "lane_stride", (int)(fine ? r->fine_nodes : r->lanes));
  abbe_renderer_set_int(r, r->trace, "ledger_first", 0);
  abbe_renderer_set_float(r, r->trace, "share_limit", r->plan.desc.energy_share);
  abbe_renderer_set_float(r, r->trace, "ledger_unit", ledger_unit(r, light));
  abbe_renderer_set_int(r, r->trace, "fits_pages", r->fits_pages ? 1 : 0);
  if (r->plan.lengths)
    abbe_renderer_bind_texels(r, r->trace, "band_attenuation", 5, GL_RGBA32F, r->band_attenuation);
  r->gl->Uniform1ui(r->gl->GetUniformLocation(r->trace, "most_pairs"), (GLuint)r->pair_room);
  const GLuint landings = fine ? r->fine_landings : r->buffer[BINDING_LANDINGS];
  const GLuint signatures = fine ? r->fine_signatures : r->buffer[BINDING_SIGNATURES];
  const GLuint marks = fine ? r->fine_marks : r->path_marks;
  abbe_renderer_clear_buffer(r, signatures);
  abbe_renderer_clear_buffer(r, marks);
  clear_count(r, fine ? r->fine_paths : r->path_list);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LANDINGS, landings);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_SIGNATURES, signatures);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS_IN, marks);
}

/* Lists the paths of so many photons or refined intervals. */
void abbe_renderer_end_trace(abbe_renderer *r, trace_set set, size_t items) {
  const bool fine = set == TRACE_REFINED;
  const size_t groups = (items * r->plan.hit_slots + PHOTON_GROUP - 1) / PHOTON_GROUP;
  const size_t rows = (groups + 65534) / 65535;
  if (groups == 0) return;
  r->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  r->gl->UseProgram(r->paths);
  r->gl->Uniform1ui(r->gl->GetUniformLocation(r->paths, "items"), (GLuint)items);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_SHARED,
                        fine ? r->fine_paths : r->path_list);
  r->gl->DispatchCompute((GLuint)((groups + rows - 1) / rows), (GLuint)rows, 1);
  r->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

/* Wavelengths first .. first + count - 1; those below ledger_first are in the ledger already. */
void abbe_renderer_trace_batch(abbe_renderer *r, size_t light, size_t first, size_t count,
                               size_t ledger_first) {
  abbe_renderer_begin_trace(r, light, TRACE_ALL, count);
  abbe_renderer_set_int(r, r->trace, "lane_first", (int)first);
  abbe_renderer_set_int(r, r->trace, "ledger_first", (int)ledger_first);
  size_t groups = (r->light[light].photon_count + PHOTON_GROUP - 1) / PHOTON_GROUP;
  if (groups > 0) r->gl->DispatchCompute((GLuint)groups, (GLuint)count, 1);
  abbe_renderer_end_trace(r, TRACE_ALL, r->light[light].photon_count);
}

/* A batch of wavelengths of all photons, the coarse set, or a chunk of the refined intervals. */
typedef struct batch {
  trace_set set;
  size_t first, count; /* wavelengths */
  size_t interval_first, interval_end;
  size_t pair_chunk;
} batch;

/* Lists the batch's pieces of light, those of one chunk of the photons. */
static void list_pieces(abbe_renderer *r, size_t light, const batch *b, size_t chunk) {
  const abbe_gl *gl = r->gl;
  const bool fine = b->set == TRACE_REFINED;
  const GLuint deposit = fine ? r->deposit_fine : r->deposit;
  const size_t coarse_rows = r->plan.light_view_count * r->plan.refractor_count * (r->nodes + 1);
  const GLuint paths = fine ? r->fine_paths : r->path_list;
  abbe_renderer_bind_tables(r);
  gl->UseProgram(deposit);
  abbe_renderer_set_int(r, deposit, "light", (int)light);
  abbe_renderer_set_grid(r, deposit, light);
  abbe_renderer_set_int(r, deposit, "map_size", (int)r->plan.desc.map_size);
  abbe_renderer_set_int(r, deposit, "lane_first", (int)b->first);
  /* of the landings that photons have; a refined interval may have more of its own */
  abbe_renderer_set_int(r, deposit, "lane_count", (int)(fine ? r->nodes : b->count));
  abbe_renderer_set_int(r, deposit, "interval_first", (int)b->interval_first);
  abbe_renderer_set_int(r, deposit, "interval_end", (int)b->interval_end);
  abbe_renderer_set_int(r, deposit, "nodes", (int)(fine ? r->plan.desc.wavelengths : r->nodes));
  abbe_renderer_set_int(r, deposit, "table_first", fine ? (int)coarse_rows : 0);
  abbe_renderer_set_float(r, deposit, "ledger_unit", ledger_unit(r, light));
  gl->Uniform1ui(gl->GetUniformLocation(deposit, "chunks"), (GLuint)r->chunks);
  gl->Uniform1ui(gl->GetUniformLocation(deposit, "chunk"), (GLuint)chunk);
  gl->Uniform1ui(gl->GetUniformLocation(deposit, "most"), (GLuint)r->splat_room);
  clear_count(r, r->splat_list);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS_IN, fine ? r->pair_list : r->wants);
  abbe_renderer_bind_texels(r, deposit, "landings", 0, GL_RGBA32F, r->buffer[BINDING_LANDINGS]);
  const GLenum signature = r->plan.lengths ? GL_RG32UI : GL_R32UI;
  abbe_renderer_bind_texels(r, deposit, "signatures", 1, signature, r->buffer[BINDING_SIGNATURES]);
  abbe_renderer_bind_texels(r, deposit, "interval_sums", 2, GL_RGBA32F,
                            r->buffer[BINDING_INTERVALS]);
  if (fine) {
    abbe_renderer_bind_texels(r, deposit, "fine_landings", 3, GL_RGBA32F, r->fine_landings);
    abbe_renderer_bind_texels(r, deposit, "fine_signatures", 4, signature, r->fine_signatures);
  }
  if (r->plan.lengths) {
    const size_t rows = r->plan.light_view_count * r->plan.refractor_count;
    abbe_renderer_bind_texels(r, deposit, "band_attenuation", 5, GL_RGBA32F, r->band_attenuation);
    abbe_renderer_set_int(r, deposit, "band_first", (int)(fine ? rows * r->nodes : 0));
  }
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_SHARED, paths);
  const size_t items = fine ? r->pair_room : r->light[light].photon_count;
  abbe_renderer_dispatch_list(r, deposit, paths, items * r->plan.hit_slots, 1);
}

static abbe_result deposit_batch(abbe_renderer *r, size_t light, const batch *b,
                                 abbe_error *error) {
  for (size_t chunk = 0; chunk < r->chunks; chunk++) {
    list_pieces(r, light, b, chunk);
    abbe_renderer_end_pass(r, r->plan.fills ? ABBE_PASS_GAP_FILL : ABBE_PASS_SPECTRAL_MAP);
    bool look = r->chunks > 1 || r->statistics != NULL;
    if (look && read_count(r, r->splat_list) > r->splat_room)
      return abbe_error_set(error, ABBE_GL,
                            "the photons' light falls into more than %zu pieces; "
                            "use fewer photons or wavelengths",
                            r->splat_room * r->chunks);
    r->gl->UseProgram(r->splat);
    abbe_renderer_set_int(r, r->splat, "map_size", (int)r->plan.desc.map_size);
    r->gl->Uniform1ui(r->gl->GetUniformLocation(r->splat, "most"), (GLuint)r->splat_room);
    abbe_renderer_set_int(r, r->splat, "light", (int)light);
    r->gl->Uniform1ui(r->gl->GetUniformLocation(r->splat, "map_texels"), (GLuint)r->map_texels);
    r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_SHARED, r->map_sums);
    abbe_renderer_dispatch_list(r, r->splat, r->splat_list, r->splat_room, 1);
    abbe_renderer_end_pass(r, ABBE_PASS_SPECTRAL_MAP);
  }
  return ABBE_OK;
}

/* Coarse to fine: each level takes over what the coarser ones hold; so many rows of a layer. */
static void resolve_layer(abbe_renderer *r, size_t light, size_t layer, size_t rows) {
  r->gl->UseProgram(r->resolve);
  abbe_renderer_set_int(r, r->resolve, "light", (int)light);
  abbe_renderer_set_int(r, r->resolve, "layer", (int)layer);
  r->gl->Uniform1ui(r->gl->GetUniformLocation(r->resolve, "map_texels"), (GLuint)r->map_texels);
  abbe_renderer_set_int(r, r->resolve, "map_size", (int)r->plan.desc.map_size);
  abbe_renderer_set_int(r, r->resolve, "levels", (int)r->map_levels);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_SHARED, r->map_sums);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LANDINGS, r->texel_sizes);
  abbe_renderer_bind_texture(r, r->resolve, "coarser_map", 0, r->map);
  for (int level = (int)r->map_levels - 1; level >= 0; level--) {
    GLuint side = (GLuint)(r->plan.desc.map_size >> level);
    abbe_renderer_set_int(r, r->resolve, "level", level);
    r->gl->BindImageTexture(0, r->map, level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    abbe_renderer_dispatch_2d(r, side, rows >> level);
    r->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  }
}

/* What the eye sees of the map where its samples are farther apart than texels. */
static void make_mips(abbe_renderer *r, size_t light, size_t layer, size_t rows) {
  r->gl->UseProgram(r->mip);
  abbe_renderer_set_int(r, r->mip, "light", (int)light);
  abbe_renderer_set_int(r, r->mip, "layer", (int)layer);
  abbe_renderer_set_int(r, r->mip, "map_size", (int)r->plan.desc.map_size);
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LANDINGS, r->texel_sizes);
  abbe_renderer_bind_texture(r, r->mip, "map_levels", 0, r->map);
  for (size_t level = 1; level < r->map_levels; level++) {
    size_t side = r->plan.desc.map_size >> level;
    abbe_renderer_set_int(r, r->mip, "level", (int)level);
    r->gl->BindImageTexture(0, r->map, (GLint)level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
    abbe_renderer_dispatch_2d(r, side, rows >> level);
    r->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
  }
}

static void finish_map(abbe_renderer *r, size_t light) {
  const size_t side = r->plan.desc.map_size;
  const light_state *state = &r->light[light];
  resolve_layer(r, light, light, side);
  make_mips(r, light, light, side);
  if (state->pages.count == 0) return;
  resolve_layer(r, light, state->page_layer, state->pages.rows);
  make_mips(r, light, state->page_layer, state->pages.rows);
}

/* All wavelengths in batches that overlap by one node, so that every interval between nodes lies
 * in exactly one of them. (A single node has its light in the one before it.) False after the last.
 */
static bool next_batch(const abbe_renderer *r, batch *b) {
  size_t n = r->plan.desc.wavelengths;
  if (b->count > 0 && b->first + b->count == n) return false;
  b->first = b->count == 0 ? 0 : b->first + b->count - 1;
  b->count = n - b->first < r->lanes ? n - b->first : r->lanes;
  b->interval_first = n > 1 ? b->first + 1 : 0;
  b->interval_end = b->first + b->count;
  return true;
}

/* Traces what next_batch() would, or the coarse set and then its refined intervals; deposited in
 * another order: the coarse set last, when it is known what is refined. Returns false after the
 * last. */
static bool trace_next(abbe_renderer *r, size_t light, batch *b) {
  if (!abbe_renderer_refines(r)) {
    size_t done = b->first + b->count;
    if (!next_batch(r, b)) return false;
    abbe_renderer_trace_batch(r, light, b->first, b->count, done);
    return true;
  }
  if (b->set == TRACE_COARSE) return false;
  size_t chunk = b->set == TRACE_ALL ? 0 : b->pair_chunk + 1;
  if (b->set == TRACE_ALL) abbe_renderer_trace_coarse(r, light);
  *b = (batch){.set = TRACE_REFINED, .pair_chunk = chunk, .count = r->fine_nodes};
  if (chunk < r->pair_chunks) {
    abbe_renderer_trace_refined(r, light, chunk);
    return true;
  }
  *b = (batch){
      .set = TRACE_COARSE, .count = r->nodes, .interval_first = 1, .interval_end = r->nodes};
  return true;
}

static double share_done(const abbe_renderer *r, const batch *b) {
  if (b->set == TRACE_ALL) return (double)(b->first + b->count) / (double)r->plan.desc.wavelengths;
  return b->set == TRACE_COARSE ? 1 : (double)(b->pair_chunk + 1) / (double)(r->pair_chunks + 1);
}

static abbe_result trace_and_deposit(abbe_renderer *r, size_t light, abbe_render_progress progress,
                                     void *user, abbe_error *error) {
  batch b = {0};
  abbe_result result = ABBE_OK;
  abbe_renderer_begin_pass(r);
  while (result == ABBE_OK && trace_next(r, light, &b)) {
    abbe_renderer_end_pass(r, ABBE_PASS_PHOTONS);
    result = deposit_batch(r, light, &b, error);
    double share = ((double)light + share_done(r, &b)) / (double)r->plan.light_view_count;
    if (result == ABBE_OK && progress != NULL && !progress(user, 0.5 * share))
      result = abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
    abbe_renderer_begin_pass(r);
  }
  return result;
}

/* Making the renderer traces every light's wavelengths twice: `pass` 0 fits the maps, 1 counts. */
static abbe_result show_making(abbe_renderer *r, int pass, size_t light, const batch *b,
                               abbe_error *error) {
  const abbe_render_desc *d = &r->plan.desc;
  if (d->progress == NULL) return ABBE_OK;
  double share =
      0.5 * pass + 0.5 * ((double)light + share_done(r, b)) / (double)r->plan.light_view_count;
  if (d->progress(d->progress_user, share)) return ABBE_OK;
  return abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
}

/* Chunks are drawn by a hash of the cell; a quarter more room covers their unevenness. */
static size_t chunks_for(size_t count, size_t room) {
  return count > room ? count / (room * 4 / 5) + 1 : 1;
}

/* Counts the refined intervals, the same in every frame. */
static abbe_result count_pairs(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  size_t most = 0;
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++) {
    if (!r->plan.reaches[light] || !abbe_renderer_refines(r)) continue;
    result = abbe_renderer_start_photons(r, light, error);
    abbe_renderer_trace_coarse(r, light);
    size_t count = abbe_renderer_count_pairs(r, light);
    if (count > most) most = count;
  }
  r->pair_chunks = chunks_for(most, r->pair_room);
  return result;
}

/* Counts the pieces of light, the same in every frame, and makes room for them. */
static abbe_result make_splats(abbe_renderer *r, abbe_error *error) {
  size_t most = 1;
  r->chunks = 1;
  abbe_result result =
      abbe_renderer_make_buffer(r, LIST_HEADER + SPLAT_BYTES, NULL, &r->splat_list, error);
  if (result == ABBE_OK) result = count_pairs(r, error);
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++) {
    batch b = {0};
    if (!r->plan.reaches[light]) continue;
    result = abbe_renderer_start_photons(r, light, error);
    abbe_renderer_bind_tables(r);
    abbe_renderer_clear_buffer(r, r->buffer[BINDING_LEDGER]);
    while (result == ABBE_OK && trace_next(r, light, &b)) {
      list_pieces(r, light, &b, 0);
      size_t count = read_count(r, r->splat_list);
      if (count > most) most = count;
      result = show_making(r, 1, light, &b, error);
    }
    GLuint reached[2] = {0, 0};
    r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_LEDGER]);
    r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof reached, reached);
    r->light[light].reached_flux = wide(reached) * ledger_unit(r, light);
  }
  abbe_renderer_upload_lights(r);
  if (result != ABBE_OK) return result;
  r->chunks = chunks_for(most, MAX_SPLATS);
  r->splat_room = most > MAX_SPLATS ? MAX_SPLATS : most;
  r->gl->DeleteBuffers(1, &r->splat_list);
  return abbe_renderer_make_buffer(r, LIST_HEADER + (r->splat_room + 1) * SPLAT_BYTES, NULL,
                                   &r->splat_list, error);
}

abbe_result abbe_renderer_photons(abbe_renderer *r, abbe_render_progress progress, void *user,
                                  abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++) {
    if (!r->plan.reaches[light]) continue;
    abbe_renderer_begin_pass(r);
    result = abbe_renderer_start_photons(r, light, error);
    abbe_renderer_end_pass(r, ABBE_PASS_PHOTON_PLACEMENT);
    abbe_renderer_bind_tables(r);
    abbe_renderer_clear_buffer(r, r->map_sums);
    abbe_renderer_clear_buffer(r, r->buffer[BINDING_LEDGER]);
    abbe_renderer_end_pass(r, ABBE_PASS_SPECTRAL_MAP);
    if (result == ABBE_OK) result = trace_and_deposit(r, light, progress, user, error);
    if (result != ABBE_OK) return result;
    abbe_renderer_begin_pass(r);
    finish_map(r, light);
    abbe_renderer_end_pass(r, ABBE_PASS_SPECTRAL_MAP);
    if (r->statistics == NULL) continue;
    double start_ms = abbe_renderer_now_ms();
    result = abbe_renderer_read_ledger(r, light, &r->statistics->energy, error);
    r->untimed_ms += abbe_renderer_now_ms() - start_ms;
  }
  return result != ABBE_OK ? result : abbe_gl_check(r->gl, "the photon passes", error);
}

/* Adds the light's entries; what was deposited is summed from the map's and the pages' own Y. */
abbe_result abbe_renderer_read_ledger(abbe_renderer *r, size_t light, abbe_ledger *ledger,
                                      abbe_error *error) {
  GLuint word[LEDGER_WORDS];
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_LEDGER]);
  r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof word, word);
  double unit = ledger_unit(r, light);
  ledger->reached += wide(word) * unit;
  ledger->reflected += wide(word + 2) * unit;
  ledger->absorbed += wide(word + 4) * unit;
  ledger->trapped += wide(word + 6) * unit;
  ledger->missed += wide(word + 8) * unit;
  ledger->interpolated += wide(word + 10) * unit;
  const size_t texels = r->map_texels * (r->pages ? 2 : 1);
  size_t words = abbe_renderer_map_words(r), size = texels * words * sizeof(GLuint);
  GLuint *sum = malloc(size);
  if (sum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the map");
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->map_sums);
  r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, sum);
  double deposited[2] = {0, 0};
  for (size_t i = 0; i < texels; i++)
    deposited[i / r->map_texels] += r->wide ? wide(sum + 6 * i + 2) : sum[3 * i + 1];
  free(sum);
  const double map_unit = abbe_renderer_map_unit(r, light);
  ledger->deposited += (deposited[0] + deposited[1]) * map_unit;
  ledger->on_pages += deposited[1] * map_unit;
  return abbe_gl_check(r->gl, "the reading of the ledger", error);
}

static abbe_result count_photons(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++) {
    GLuint count = 0;
    if (!r->plan.reaches[light]) continue;
    result = abbe_renderer_start_photons(r, light, error);
    r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_PHOTONS]);
    r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
    r->light[light].photon_count = count;
  }
  return result;
}

/* That a buffer can hold and a shader can read as texels. */
static size_t most_landings(const abbe_renderer *r) {
  GLint texels = 0;
  r->gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
  const size_t most = MOST_LANDING_BYTES / (LANDING_BYTES + abbe_renderer_signature_bytes(r));
  const size_t held = (size_t)texels * 16 / LANDING_BYTES; /* of four floats a texel */
  return most < held ? most : held;
}

static abbe_result make_landings(abbe_renderer *r, abbe_error *error) {
  size_t most = 1;
  for (size_t i = 0; i < r->plan.light_view_count; i++)
    if (r->light[i].photon_count > most) most = r->light[i].photon_count;
  /* A grid that is moved or made coarser may show a little more: a rim of cells. */
  size_t cells = r->plan.desc.photons * r->plan.desc.photons, rim = 8 * r->plan.desc.photons;
  most = most + rim < cells ? most + rim : cells;
  size_t a_lane = most * r->plan.hit_slots, n = r->plan.desc.wavelengths;
  /* A stone that keeps light inside has more slots, not fewer wavelengths at a time. */
  const size_t usual = ABBE_PLAN_EXITS + 1;
  const size_t slots = !r->plan.multi_refractor_paths && r->plan.hit_slots > usual ? usual : r->plan.hit_slots;
  const size_t a_landing = LANDING_BYTES + abbe_renderer_signature_bytes(r);
  size_t lanes = MAX_LANDING_BYTES / a_landing / (most * slots), room = most_landings(r);
  if (a_lane * (n > 1 ? 2 : 1) > room)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%zu photons with %zu exits each are more than the device takes at a "
                          "time; use a grid below %zu or fewer exits",
                          most, r->plan.desc.exits, r->plan.desc.photons);
  if (lanes > room / a_lane) lanes = room / a_lane;
  r->lanes = lanes < 2 ? 2 : lanes > 64 ? 64 : lanes;
  abbe_result result = ABBE_OK;
  if (a_lane * r->nodes > room) {
    /* No room to keep all of the coarse set: every photon takes all wavelengths, in batches. */
    r->nodes = n;
    result = abbe_renderer_weigh_bands(r, 0, 0, error);
  }
  const size_t enough = abbe_renderer_refines(r) ? LEAST_LANES : n;
  if (r->lanes > enough) r->lanes = enough < n ? enough : n;
  if (r->lanes < r->nodes && abbe_renderer_refines(r)) r->lanes = r->nodes;
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, a_lane * r->lanes * LANDING_BYTES, NULL,
                                       &r->buffer[BINDING_LANDINGS], error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, a_lane * r->lanes * abbe_renderer_signature_bytes(r),
                                       NULL, &r->buffer[BINDING_SIGNATURES], error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, a_lane * 4, NULL, &r->path_marks, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, LIST_HEADER + a_lane * 4, NULL, &r->path_list, error);
  if (result == ABBE_OK) result = abbe_renderer_make_refinement(r, most, error);
  return result;
}

static void write_photon_defines(const abbe_renderer *r, char defines[PHOTON_DEFINES]) {
  snprintf(defines, PHOTON_DEFINES,
           "%s#define LANES %zu\n#define STEPS %zu\n#define MAP_LEVELS %zu\n"
           "#define NODES %zu\n%s%s%s",
           r->defines, r->lanes, r->steps, r->map_levels, r->nodes,
           r->plan.fills ? "#define BRIDGE\n" : "",
           r->plan.layers || r->plan.bvh ? "#define DOUBTS_BRIDGES\n" : "",
           r->plan.lengths ? "#define TINTING\n" : "");
}

static abbe_result make_trace(abbe_renderer *r, abbe_error *error) {
  char defines[PHOTON_DEFINES];
  write_photon_defines(r, defines);
  r->gl->DeleteProgram(r->trace);
  r->gl->DeleteProgram(r->paths);
  r->paths = 0;
  abbe_result result =
      abbe_program_make_compute(r->gl, "photon_trace.comp", defines, &r->trace, error);
  return result != ABBE_OK
             ? result
             : abbe_program_make_compute(r->gl, "photon_paths.comp", defines, &r->paths, error);
}

/* All that follow the trace. */
static abbe_result make_programs(abbe_renderer *r, abbe_error *error) {
  char defines[PHOTON_DEFINES];
  write_photon_defines(r, defines);
  abbe_result result =
      abbe_program_make_compute(r->gl, "photon_deposit.comp", defines, &r->deposit, error);
  if (result == ABBE_OK) result = abbe_renderer_make_refining_programs(r, defines, error);
  if (result == ABBE_OK)
    result = abbe_program_make_compute(r->gl, "photon_splat.comp", r->defines, &r->splat, error);
  if (result == ABBE_OK)
    result = abbe_program_make_compute(r->gl, "map_resolve.comp", r->defines, &r->resolve, error);
  if (result == ABBE_OK)
    result = abbe_program_make_compute(r->gl, "map_mip.comp", NULL, &r->mip, error);
  return result;
}

/* The batch's landings, zero where there is none; malloc'd. */
abbe_result abbe_renderer_read_batch(abbe_renderer *r, size_t light, size_t first, float **data,
                                     GLuint **paths, abbe_error *error) {
  size_t count = r->light[light].photon_count * r->plan.hit_slots * r->lanes;
  float *landing = malloc(count * LANDING_BYTES + 1);
  const size_t signature_bytes = abbe_renderer_signature_bytes(r);
  GLuint *path = malloc(count * signature_bytes + 1);
  if (landing == NULL || path == NULL) {
    free(landing);
    free(path);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu landings", count);
  }
  const abbe_gl *gl = r->gl;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_LANDINGS]);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(count * LANDING_BYTES), landing);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_SIGNATURES]);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(count * signature_bytes), path);
  abbe_renderer_place_landings(r, light, landing, path, signature_bytes / sizeof *path, count);
  abbe_renderer_attenuate(r, first, count, landing, path);
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < 4 && path[i] == 0; k++) landing[4 * i + k] = 0;
  *data = landing;
  if (paths != NULL)
    *paths = path;
  else
    free(path);
  return abbe_gl_check(gl, "the reading of landings", error);
}

static abbe_result fit_map(abbe_renderer *r, size_t light, abbe_error *error) {
  double *histogram = calloc(2 * FIT_BINS, sizeof *histogram), total = 0, part = 0;
  const size_t sides = r->pages ? 2 * r->charts.count : 0;
  abbe_page_light **aside = calloc(sides + 1, sizeof *aside);
  if (histogram == NULL || aside == NULL) {
    free(histogram);
    free(aside);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fit the map");
  }
  /* Pages are for what no map of the light could hold, whichever window is given. */
  const bool given = abbe_renderer_map_is_given(r, light);
  const abbe_map_layout layout = r->light[light].map;
  if (given) {
    abbe_renderer_whole_map(r, light, &r->light[light].map);
    abbe_renderer_upload_lights(r);
  }
  abbe_result result = abbe_renderer_start_photons(r, light, error);
  abbe_renderer_bind_tables(r);
  batch b = {0};
  while (result == ABBE_OK && next_batch(r, &b)) {
    float *landing = NULL;
    GLuint *path = NULL;
    abbe_renderer_trace_batch(r, light, b.first, b.count, r->plan.desc.wavelengths);
    result = abbe_renderer_read_batch(r, light, b.first, &landing, &path, error);
    size_t count = r->light[light].photon_count * r->plan.hit_slots * r->lanes;
    if (result == ABBE_OK && part == 0) part = abbe_renderer_part_of(landing, count);
    if (result == ABBE_OK && part > 0) {
      total += abbe_renderer_sort_landings(r, light, landing, path, count, part, histogram);
      result = abbe_renderer_sort_pages(r, landing, path, count, part, aside, error);
    }
    free(landing);
    free(path);
  }
  if (given) r->light[light].map = layout;
  if (result == ABBE_OK && total > 0 && !given)
    abbe_renderer_fit_axes(&r->light[light], histogram, total);
  if (result == ABBE_OK) result = abbe_renderer_choose_pages(r, light, aside, total, error);
  for (size_t i = 0; i < sides; i++) free(aside[i]);
  free(histogram);
  free(aside);
  return result;
}

abbe_result abbe_renderer_make_photons(abbe_renderer *r, abbe_error *error) {
  abbe_result result = abbe_renderer_light_layers(r, error);
  if (result == ABBE_OK) result = count_photons(r, error);
  if (result == ABBE_OK) result = make_landings(r, error);
  if (result == ABBE_OK && r->plan.pages) result = abbe_renderer_expect_pages(r, error);
  if (result == ABBE_OK) result = make_trace(r, error);
  if (result == ABBE_OK)
    result =
        abbe_renderer_make_buffer(r, LEDGER_WORDS * 4, NULL, &r->buffer[BINDING_LEDGER], error);
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++)
    if (r->plan.reaches[light] && (r->pages || !abbe_renderer_map_is_given(r, light)))
      result = fit_map(r, light, error);
  if (result == ABBE_OK && r->pages) {
    result = abbe_renderer_keep_pages(r, error);
    if (result == ABBE_OK) result = make_trace(r, error);
  }
  if (result == ABBE_OK) result = make_programs(r, error);
  if (result == ABBE_OK) result = abbe_renderer_make_map(r, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(
        r, (r->pages ? 2 : 1) * r->map_texels * abbe_renderer_map_words(r) * 4, NULL, &r->map_sums,
        error);
  for (size_t light = 0; light < r->plan.light_view_count && result == ABBE_OK; light++)
    if (r->plan.reaches[light]) result = abbe_renderer_fit_cells(r, light, error);
  for (size_t light = 0; light < r->plan.light_view_count; light++) abbe_renderer_shift_cells(r, light);
  if (result == ABBE_OK) abbe_renderer_upload_lights(r);
  if (result == ABBE_OK) result = abbe_renderer_light_layers(r, error);
  if (result == ABBE_OK) result = count_photons(r, error);
  if (result == ABBE_OK) result = make_splats(r, error);
  return result;
}

abbe_result abbe_renderer_read_landings(abbe_renderer *r, size_t light, float **data,
                                        unsigned **cells, size_t *count, size_t *orders,
                                        size_t *lanes, abbe_error *error) {
  ABBE_REQUIRE(r && data && count && orders && lanes, error);
  *data = NULL;
  if (light >= r->plan.light_view_count || !r->plan.reaches[light] || r->trace == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no photons start from light %zu", light);
  abbe_result result = abbe_renderer_light_layers(r, error);
  if (result == ABBE_OK) result = abbe_renderer_start_photons(r, light, error);
  if (result != ABBE_OK) return result;
  *count = r->light[light].photon_count;
  *orders = r->plan.hit_slots;
  *lanes = r->lanes;
  abbe_renderer_bind_tables(r);
  abbe_renderer_trace_batch(r, light, 0, r->lanes, r->plan.desc.wavelengths);
  GLuint *path = NULL;
  result = abbe_renderer_read_batch(r, light, 0, data, &path, error);
  for (size_t i = 0; result == ABBE_OK && i < *count * *orders * *lanes; i++) {
    float *at = *data + 4 * i;
    double place[3] = {at[0], at[1], at[2]};
    if (!(at[3] > 0)) continue;
    if (abbe_renderer_is_on_page(r, path[i])) abbe_renderer_page_place(r, light, at, place);
    for (size_t k = 0; k < 3; k++) at[k] = (float)(place[k] + r->local.origin[k]);
  }
  free(path);
  if (result != ABBE_OK || cells == NULL) return result;
  *cells = malloc(*count * PHOTON_BYTES + PHOTON_BYTES);
  if (*cells == NULL) {
    free(*data);
    *data = NULL;
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu cells", *count);
  }
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_PHOTONS]);
  r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, PHOTON_HEADER,
                          (GLsizeiptr)(*count * PHOTON_BYTES), *cells);
  for (size_t i = 0; i < *count; i++) (*cells)[i] = (*cells)[i * (PHOTON_BYTES / sizeof **cells)];
  return abbe_gl_check(r->gl, "the reading of photons", error);
}
