/* Which photons take which wavelengths: a few are traced for all, and between two of them all
 * wavelengths where the photon's landings ask for it. */
#include "colorimetry/weights.h"
#include "gl/device/program.h"
#include "gl/renderer_state.h"

#include <stdio.h>

enum { MOST_NODES = 9, LIST_HEADER = 16 };
enum { MAX_FINE_BYTES = 128 << 20, LEAST_PAIRS = 256 };

size_t abbe_renderer_coarse_node(size_t wavelengths, size_t nodes, size_t k) {
  return nodes > 1 ? (k * (wavelengths - 1) + (nodes - 1) / 2) / (nodes - 1) : 0;
}

bool abbe_renderer_refines(const abbe_renderer *r) {
  return r->nodes < r->plan.desc.wavelengths;
}

static size_t widest_interval(const abbe_renderer *r) {
  size_t most = 0, n = r->plan.desc.wavelengths;
  for (size_t k = 0; k + 1 < r->nodes; k++) {
    size_t steps =
        abbe_renderer_coarse_node(n, r->nodes, k + 1) - abbe_renderer_coarse_node(n, r->nodes, k);
    if (steps > most) most = steps;
  }
  return most;
}

abbe_result abbe_renderer_make_refinement(abbe_renderer *r, size_t most_photons,
                                          abbe_error *error) {
  abbe_result result = abbe_renderer_make_buffer(r, most_photons * 4, NULL, &r->wants, error);
  r->pair_chunks = 1;
  if (result == ABBE_OK) abbe_renderer_clear_buffer(r, r->wants);
  if (result != ABBE_OK || !abbe_renderer_refines(r)) return result;
  r->fine_nodes = widest_interval(r) + 1;
  size_t a_pair = r->plan.hit_slots * r->fine_nodes, most = most_photons * (r->nodes - 1);
  r->pair_room = MAX_FINE_BYTES / (LANDING_BYTES + abbe_renderer_signature_bytes(r)) / a_pair;
  if (r->pair_room < LEAST_PAIRS) r->pair_room = LEAST_PAIRS;
  if (r->pair_room > most) r->pair_room = most;
  const struct {
    GLuint *buffer;
    size_t size;
  } made[] = {{&r->pair_list, LIST_HEADER + r->pair_room * 4},
              {&r->fine_landings, r->pair_room * a_pair * LANDING_BYTES},
              {&r->fine_signatures, r->pair_room * a_pair * abbe_renderer_signature_bytes(r)},
              {&r->fine_marks, r->pair_room * r->plan.hit_slots * 4},
              {&r->fine_paths, LIST_HEADER + r->pair_room * r->plan.hit_slots * 4}};
  for (size_t i = 0; i < sizeof made / sizeof made[0] && result == ABBE_OK; i++)
    result = abbe_renderer_make_buffer(r, made[i].size, NULL, made[i].buffer, error);
  return result;
}

abbe_result abbe_renderer_make_refining_programs(abbe_renderer *r, const char *defines,
                                                 abbe_error *error) {
  if (!abbe_renderer_refines(r)) return ABBE_OK;
  char refined[2816];
  snprintf(refined, sizeof refined, "%s#define REFINED\n#define FINE_NODES %zu\n", defines,
           r->fine_nodes);
  abbe_result result =
      abbe_program_make_compute(r->gl, "photon_select.comp", defines, &r->select, error);
  if (result == ABBE_OK)
    result =
        abbe_program_make_compute(r->gl, "photon_deposit.comp", refined, &r->deposit_fine, error);
  return result;
}

void abbe_renderer_trace_coarse(abbe_renderer *r, size_t light) {
  abbe_renderer_clear_buffer(r, r->wants);
  abbe_renderer_begin_trace(r, light, TRACE_COARSE, r->nodes);
  size_t threads = r->light[light].photon_count * r->nodes;
  size_t groups = (threads + PHOTON_GROUP - 1) / PHOTON_GROUP, rows = (groups + 65534) / 65535;
  if (groups > 0) r->gl->DispatchCompute((GLuint)((groups + rows - 1) / rows), (GLuint)rows, 1);
  abbe_renderer_end_trace(r, TRACE_COARSE, r->light[light].photon_count);
}

static void bind_storage(abbe_renderer *r, GLuint place, GLuint buffer) {
  r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, place, buffer);
}

/* The intervals' shares of the light, of X, Y and Z alike, by their mean. */
static void set_weights(abbe_renderer *r, size_t light) {
  const double min = r->plan.desc.min_nm, max = r->plan.desc.max_nm;
  const size_t n = r->plan.desc.wavelengths, intervals = r->nodes - 1;
  double xyz[3], total = 0;
  GLfloat weight[MOST_NODES] = {0};
  for (size_t k = 0; k < intervals; k++) {
    abbe_weights_band_xyz(&r->scene->light[light].illuminant, min, max,
                          r->lambda_nm[abbe_renderer_coarse_node(n, r->nodes, k)],
                          r->lambda_nm[abbe_renderer_coarse_node(n, r->nodes, k + 1)], xyz);
    weight[k] = (GLfloat)(xyz[0] + xyz[1] + xyz[2]);
    total += (double)weight[k];
  }
  for (size_t k = 0; k < intervals; k++)
    weight[k] = total > 0 ? (GLfloat)((double)weight[k] * (double)intervals / total) : 1;
  r->gl->Uniform1fv(r->gl->GetUniformLocation(r->select, "interval_weight"), (GLsizei)r->nodes,
                    weight);
}

static void select_pairs(abbe_renderer *r, size_t light, size_t chunk) {
  static const GLuint zero = 0;
  abbe_renderer_bind_tables(r);
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->pair_list);
  r->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, &zero);
  r->gl->UseProgram(r->select);
  abbe_renderer_set_int(r, r->select, "light", (int)light);
  abbe_renderer_set_grid(r, r->select, light);
  abbe_renderer_set_int(r, r->select, "map_size", (int)r->plan.desc.map_size);
  set_weights(r, light);
  r->gl->Uniform1ui(r->gl->GetUniformLocation(r->select, "chunks"), (GLuint)r->pair_chunks);
  r->gl->Uniform1ui(r->gl->GetUniformLocation(r->select, "chunk"), (GLuint)chunk);
  r->gl->Uniform1ui(r->gl->GetUniformLocation(r->select, "most_pairs"), (GLuint)r->pair_room);
  bind_storage(r, BINDING_PHOTONS_IN, r->wants);
  bind_storage(r, BINDING_SAMPLE_WEIGHTS, r->pair_list);
  bind_storage(r, BINDING_SHARED, r->path_list);
  abbe_renderer_dispatch_list(r, r->select, r->path_list,
                              r->light[light].photon_count * r->plan.hit_slots, 1);
}

size_t abbe_renderer_count_pairs(abbe_renderer *r, size_t light) {
  GLuint count = 0;
  select_pairs(r, light, 0);
  r->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->pair_list);
  r->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
  return count;
}

void abbe_renderer_trace_refined(abbe_renderer *r, size_t light, size_t chunk) {
  select_pairs(r, light, chunk);
  abbe_renderer_begin_trace(r, light, TRACE_REFINED, r->fine_nodes);
  abbe_renderer_dispatch_list(r, r->trace, r->pair_list, r->pair_room, r->fine_nodes);
  abbe_renderer_end_trace(r, TRACE_REFINED, r->pair_room);
}

void abbe_renderer_free_refinement(abbe_renderer *r) {
  const GLuint buffer[] = {r->wants,           r->pair_list,  r->fine_landings,
                           r->fine_signatures, r->fine_marks, r->fine_paths};
  r->gl->DeleteBuffers(sizeof buffer / sizeof buffer[0], buffer);
  r->gl->DeleteProgram(r->select);
  r->gl->DeleteProgram(r->deposit_fine);
}
