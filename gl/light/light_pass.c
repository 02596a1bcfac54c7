#include "gl/device/program.h"
#include "gl/plan/light_cube.h"
#include "gl/renderer_state.h"
#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double narrow_rad = 0.17; /* ten degrees */

/* Texels: few photons need no more than four a cell, whose shadows are as coarse. */
enum { MIN_LAYER_SIDE = 128, USUAL_LAYER_SIDE = 256, MAX_LAYER_SIDE = 2048 };

bool abbe_renderer_is_face(const abbe_renderer *r, size_t light) {
  return r->plan.light_view[light].face >= 0;
}

static void look_from_light(const abbe_renderer *r, size_t index, abbe_view *view) {
  static const double up[3] = {0, 1, 0};
  const abbe_light *light = &r->scene->light[index];
  if (abbe_renderer_is_face(r, index)) {
    abbe_light_cube_look(light->position, r->plan.light_view[index].face, view);
    return;
  }
  double origin[3], forward[3];
  for (int k = 0; k < 3; k++) {
    double centre = r->plan.refractor_count > 0 ? r->refractor_centre[k]
                                                : 0.5 * (r->scene_min[k] + r->scene_max[k]);
    bool directional = light->kind == ABBE_LIGHT_DIRECTIONAL;
    origin[k] = directional ? centre - light->direction[k] * r->scene_size : light->position[k];
    forward[k] = directional ? light->direction[k] : centre - light->position[k];
  }
  double length2 = 0;
  for (int k = 0; k < 3; k++) length2 += forward[k] * forward[k];
  if (length2 == 0) forward[2] = -1; /* the light stands in the middle of it all */
  abbe_view_look(origin, forward, up, light->kind == ABBE_LIGHT_DIRECTIONAL, view);
}

static void fit_objects(const abbe_renderer *r, const size_t *object, size_t count,
                        abbe_view *view) {
  for (size_t i = 0; i < count; i++) {
    const abbe_mesh *mesh = &r->scene->object[object[i]].mesh;
    abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count);
  }
}

/* The thesis's light sees through one frustum: its cone, or all there is. With the CIE's weights
 * also where the cone is narrow: a prism throws all of its light out of it. */
static void fit_thesis(abbe_renderer *r, const abbe_light *light, light_state *state) {
  abbe_view *view = &state->near_view;
  fit_objects(r, r->plan.refractor_object, r->plan.refractor_count, view);
  fit_objects(r, r->plan.receiver_object, r->plan.receiver_count, view);
  bool narrow = r->plan.desc.profile == ABBE_PROFILE_THESIS_CIE && light->cone_rad < narrow_rad;
  if (light->kind == ABBE_LIGHT_SPOT && !narrow) {
    double look[3];
    memcpy(look, light->direction, sizeof look);
    double near = view->near, far = view->far;
    abbe_view_look(light->position, look, view->up, false, view);
    double tangent = fmin(tan(light->cone_rad), ABBE_VIEW_MAX_TANGENT);
    double window[4] = {-tangent, tangent, -tangent, tangent};
    memcpy(view->window, window, sizeof window);
    view->near = fmax(0.25 * near, 1e-3 * far);
    view->far = 1.5 * far;
  } else {
    abbe_view_pad(view, 0.01);
  }
  double half = 0.5 * fmax(view->window[1] - view->window[0], view->window[3] - view->window[2]);
  for (int axis = 0; axis < 2; axis++) {
    double middle = 0.5 * (view->window[2 * axis] + view->window[2 * axis + 1]);
    view->window[2 * axis] = middle - half;
    view->window[2 * axis + 1] = middle + half;
  }
  abbe_map_layout_make(view, &state->map);
}

bool abbe_renderer_map_is_given(const abbe_renderer *r, size_t light) {
  return r->plan.desc.map_layout != NULL &&
         r->plan.desc.map_layout_light == r->plan.light_view[light].light;
}

/* All of it but the range, which must hold this scene's receivers. */
static void take_layout(const abbe_renderer *r, const abbe_map_layout *given,
                        abbe_map_layout *out) {
  *out = *given;
  out->view.near = INFINITY;
  out->view.far = -INFINITY;
  fit_objects(r, r->plan.receiver_object, r->plan.receiver_count, &out->view);
  abbe_view_pad(&out->view, 0.01);
  memcpy(out->view.window, given->view.window, sizeof out->view.window);
}

void abbe_renderer_whole_map(const abbe_renderer *r, size_t light, abbe_map_layout *out) {
  abbe_view view;
  look_from_light(r, light, &view);
  fit_objects(r, r->plan.receiver_object, r->plan.receiver_count, &view);
  if (abbe_renderer_is_face(r, light)) /* receivers lie all around it, as the refractors do */
    for (int k = 0; k < 4; k++)
      view.window[k] = k % 2 != 0 ? ABBE_VIEW_MAX_TANGENT : -ABBE_VIEW_MAX_TANGENT;
  abbe_view_pad(&view, 0.01);
  abbe_map_layout_make(&view, out);
}

/* Around what the face shows of the refractors. The shaders' profile of the light keeps photons in
 * the face; the window ends there too, unless layers are read beyond it. */
static void fit_face(const abbe_renderer *r, size_t light, abbe_view *view) {
  const abbe_plan *plan = &r->plan;
  const abbe_light *from = &r->scene->light[light];
  double near = INFINITY, far = 0;
  for (size_t i = 0; i < plan->refractor_count; i++) {
    const abbe_object *object = &r->scene->object[plan->refractor_object[i]];
    const abbe_mesh *mesh = &object->mesh;
    if ((abbe_light_cube_reached(from, object) >> plan->light_view[light].face & 1) == 0) continue;
    abbe_light_cube_fit(view, object);
    if (plan->model[i] == ABBE_REFRACTOR_LAYERS)
      abbe_view_fit(view, (const double(*)[3])mesh->position, mesh->vertex_count);
    near = fmin(near, 0.5 * abbe_object_distance(object, from->position));
    for (size_t k = 0; k < mesh->vertex_count; k++) {
      double to[3];
      abbe_vector_subtract(mesh->position[k], from->position, to);
      far = fmax(far, 1.01 * abbe_vector_length(to));
    }
  }
  for (int k = 0; k < 4; k++) /* a seam's rounding may leave it empty */
    if (!isfinite(view->window[k])) view->window[k] = 0;
  abbe_view_pad(view, 0.01);
  for (int k = 0; k < 4 && !plan->layers && !plan->bvh; k++)
    view->window[k] = fmin(fmax(view->window[k], -1), 1);
  view->far = far > 0 ? far : 1;
  view->near = fmax(fmin(near, 0.5 * view->far), 1e-4 * view->far);
}

/* Tight around the refractors for the photons; around all receivers for the map, which is fitted
 * to the photons' landings later where the request does not give it. */
static void fit_views(abbe_renderer *r) {
  for (size_t i = 0; i < r->plan.light_view_count; i++) {
    const abbe_light *light = &r->scene->light[i];
    light_state *state = &r->light[i];
    state->cells[0] = state->cells[1] = r->plan.desc.photons;
    look_from_light(r, i, &state->near_view);
    if (abbe_profile_is_thesis(r->plan.desc.profile)) {
      fit_thesis(r, light, state);
      continue;
    }
    if (r->plan.refractor_count > 0)
      fit_objects(r, r->plan.refractor_object, r->plan.refractor_count, &state->near_view);
    else
      fit_objects(r, r->plan.receiver_object, r->plan.receiver_count, &state->near_view);
    abbe_view_pad(&state->near_view, 0.01);
    if (abbe_renderer_is_face(r, i)) {
      look_from_light(r, i, &state->near_view);
      fit_face(r, i, &state->near_view);
    }
    abbe_renderer_whole_map(r, i, &state->map);
    if (abbe_renderer_map_is_given(r, i)) take_layout(r, r->plan.desc.map_layout, &state->map);
  }
}

static abbe_result make_layers(abbe_renderer *r, abbe_error *error) {
  const size_t photons = r->plan.desc.photons, lights = r->plan.light_view_count;
  size_t side = 4 * photons < USUAL_LAYER_SIDE ? 4 * photons
                : photons < USUAL_LAYER_SIDE   ? USUAL_LAYER_SIDE
                                               : photons;
  side = side < MIN_LAYER_SIDE ? MIN_LAYER_SIDE : side > MAX_LAYER_SIDE ? MAX_LAYER_SIDE : side;
  r->layer_side = side;
  abbe_result result = abbe_renderer_make_texture(r, GL_RGBA32F, side, side, 2 * lights, false,
                                                  &r->light_layers, error);
  if (result == ABBE_OK)
    result =
        abbe_renderer_make_texture(r, GL_R16UI, side, side, lights, false, &r->light_owner, error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_texture(r, GL_DEPTH_COMPONENT32F, side, side, 0, false,
                                        &r->light_depth, error);
  return result;
}

static abbe_result make_lists(abbe_renderer *r, abbe_error *error) {
  size_t cells = r->plan.desc.photons * r->plan.desc.photons;
  abbe_result result = ABBE_OK;
  for (int level = 0; level < LEVELS && result == ABBE_OK; level++) {
    /* The finer level's cells: four for each of this one's, rounded up at the rim. */
    size_t side = (r->plan.desc.photons >> (LEVELS - 1 - level)) + 2;
    size_t room = level == LEVELS - 1 ? cells : 4 * side * side;
    result = abbe_renderer_make_buffer(r, PHOTON_HEADER + room * 4, NULL, &r->list[level], error);
  }
  if (result != ABBE_OK || r->plan.desc.profile == ABBE_PROFILE_THESIS) return result;
  result = abbe_renderer_make_buffer(r, cells * 4, NULL, &r->buffer[BINDING_SLOTS], error);
  if (result == ABBE_OK)
    result = abbe_renderer_make_buffer(r, PHOTON_HEADER + cells * PHOTON_BYTES, NULL,
                                       &r->buffer[BINDING_PHOTONS], error);
  return result;
}

void abbe_renderer_shift_cells(abbe_renderer *r, size_t light) {
  const double *shift = r->plan.desc.photon_shift;
  light_state *state = &r->light[light];
  if (fmax(fabs(shift[0]), fabs(shift[1])) == 0) return;
  for (int axis = 0; axis < 2; axis++) {
    double *low = &state->near_view.window[2 * axis], *high = low + 1;
    double cell = (*high - *low) / (double)state->cells[axis];
    *low += (shift[axis] - 0.5) * cell;
    *high += (shift[axis] + 0.5) * cell;
  }
}

static void set_start(abbe_renderer *r, GLuint program, size_t light) {
  r->gl->UseProgram(program);
  abbe_renderer_set_lighting(r, program);
  abbe_renderer_bind_texture(r, program, "layer_owner", 4, r->light_owner);
  abbe_renderer_set_int(r, program, "light", (int)light);
}

/* A mesh's inside is what the near view sees of it: there the view stays. */
static bool fits_to_light(const abbe_renderer *r) {
  return !r->plan.layers;
}

static void set_layer_view(abbe_renderer *r, const abbe_view *view) {
  double matrix[16];
  float clip[16];
  abbe_view_matrix(view, matrix);
  for (int k = 0; k < 16; k++) clip[k] = (float)matrix[k];
  const abbe_gl *gl = r->gl;
  gl->UseProgram(r->layer);
  gl->UniformMatrix4fv(gl->GetUniformLocation(r->layer, "view_projection"), 1, GL_FALSE, clip);
  gl->Uniform4f(gl->GetUniformLocation(r->layer, "view_origin"), (float)view->origin[0],
                (float)view->origin[1], (float)view->origin[2], view->orthographic ? 0.0f : 1.0f);
  gl->Uniform3f(gl->GetUniformLocation(r->layer, "view_forward"), (float)view->forward[0],
                (float)view->forward[1], (float)view->forward[2]);
}

static void clear_target(const abbe_gl *gl, GLfloat distance, bool owner) {
  static const GLfloat far = 1;
  static const GLuint nobody[4] = {0, 0, 0, 0};
  const GLfloat nothing[4] = {0, 0, 0, distance};
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  if (owner) gl->ClearBufferuiv(GL_COLOR, 1, nobody);
  gl->ClearBufferfv(GL_DEPTH, 0, &far);
}

static void draw_refractors(abbe_renderer *r) {
  for (size_t i = 0; i < r->plan.refractor_count; i++) {
    r->gl->Uniform1ui(r->gl->GetUniformLocation(r->layer, "owner"), (GLuint)i + 1);
    abbe_renderer_draw_refractor(r, i);
  }
}

static abbe_result front_and_back(abbe_renderer *r, size_t light, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  set_layer_view(r, &r->light[light].near_view);
  gl->Enable(GL_DEPTH_TEST);
  gl->Enable(GL_CULL_FACE);
  for (int back = 0; back <= (r->plan.draw_back ? 1 : 0); back++) {
    abbe_renderer_begin_pass(r);
    GLuint target[2] = {r->light_layers, r->light_owner};
    int layer[2] = {2 * (int)light + back, (int)light};
    abbe_result result = abbe_renderer_set_target(r, target, layer, back ? 1 : 2, r->light_depth,
                                                  r->layer_side, r->layer_side, error);
    if (result != ABBE_OK) return result;
    /* So near to exact surfaces their triangles tell too little of what they cover. */
    const bool all = abbe_renderer_is_face(r, light) && !r->plan.layers && !r->plan.bvh;
    clear_target(gl, all ? 1 : 0, !back);
    gl->CullFace(back ? GL_FRONT : GL_BACK);
    if (!all) draw_refractors(r);
    abbe_renderer_end_pass(r, back ? ABBE_PASS_LIGHT_BACK : ABBE_PASS_LIGHT_FRONT);
  }
  gl->Disable(GL_CULL_FACE);
  return ABBE_OK;
}

abbe_result abbe_renderer_light_layers(abbe_renderer *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->plan.light_view_count && result == ABBE_OK; i++)
    if (r->plan.reaches[i]) result = front_and_back(r, i, error);
  return result;
}

/* Shrinks the near view to the rays that reach a refractor. Each turn sees as finely as the last
 * one left it, and leaves a ray's width on every side. */
static abbe_result fit_near_view(abbe_renderer *r, GLuint program, GLuint found_box, size_t light,
                                 abbe_error *error) {
  enum { SIDE = 1024, TURNS = 4 };
  const abbe_gl *gl = r->gl;
  double *window = r->light[light].near_view.window;
  for (int turn = 0; turn < TURNS; turn++) {
    static const GLuint none[4] = {SIDE, 0, SIDE, 0};
    GLuint found[4] = {0};
    /* What rays meet of meshes is told by the front layer of the view as it is now. */
    abbe_result result = r->plan.bvh ? front_and_back(r, light, error) : ABBE_OK;
    if (result != ABBE_OK) return result;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, found_box);
    gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof none, none);
    abbe_renderer_bind_tables(r);
    set_start(r, program, light);
    abbe_renderer_set_int(r, program, "side", SIDE);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_LIST, found_box);
    abbe_renderer_dispatch_2d(r, SIDE, SIDE);
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof found, found);
    if (found[0] > found[1]) break; /* nothing is lit */
    bool shrinks = false;
    double box[4];
    for (int axis = 0; axis < 2; axis++)
      shrinks = shrinks || found[2 * axis + 1] - found[2 * axis] < 9 * SIDE / 10;
    for (int axis = 0; axis < 2; axis++) {
      double low = window[2 * axis], ray = (window[2 * axis + 1] - low) / SIDE;
      /* The edge lies half a ray to either side of where the last lit ray's place begins. */
      double room = shrinks ? 0.5 : 0;
      box[2 * axis] = low + ray * fmax((double)found[2 * axis] - room, 0);
      box[2 * axis + 1] = low + ray * fmin((double)found[2 * axis + 1] + 1 + room, SIDE);
    }
    if (turn == 0 && !shrinks) break; /* nothing to speak of is cut off */
    memcpy(window, box, sizeof box);
    abbe_renderer_upload_lights(r);
    if (!shrinks) break;
  }
  return ABBE_OK;
}

static abbe_result fit_to_light(abbe_renderer *r, abbe_error *error) {
  GLuint program = 0, box = 0;
  abbe_result result =
      abbe_program_make_compute(r->gl, "light_fit.comp", r->defines, &program, error);
  if (result == ABBE_OK) result = abbe_renderer_make_buffer(r, 4 * 4, NULL, &box, error);
  for (size_t i = 0; i < r->plan.light_view_count && result == ABBE_OK; i++)
    if (r->plan.reaches[i]) result = fit_near_view(r, program, box, i, error);
  r->gl->DeleteBuffers(1, &box);
  r->gl->DeleteProgram(program);
  return result != ABBE_OK ? result : abbe_gl_check(r->gl, "the fit of the light's view", error);
}

abbe_result abbe_renderer_make_light(abbe_renderer *r, abbe_error *error) {
  static const abbe_program_stage layer_stages[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                                    {GL_FRAGMENT_SHADER, "layer.frag"}};
  fit_views(r);
  abbe_renderer_fit_eye(r);
  abbe_renderer_upload_lights(r);
  abbe_result result = abbe_renderer_make_layer_faces(r, error);
  if (result == ABBE_OK) result = abbe_program_make(r->gl, layer_stages, 2, NULL, &r->layer, error);
  if (result == ABBE_OK)
    result = abbe_program_make_compute(r->gl, "photon_place.comp", NULL, &r->place, error);
  if (result == ABBE_OK)
    result = abbe_program_make_compute(r->gl, "photon_groups.comp", NULL, &r->groups, error);
  if (result == ABBE_OK)
    result = abbe_program_make_compute(r->gl, "list_groups.comp", NULL, &r->list_groups, error);
  if (result == ABBE_OK && !abbe_profile_is_thesis(r->plan.desc.profile))
    result = make_layers(r, error);
  if (result == ABBE_OK) result = make_lists(r, error);
  if (result == ABBE_OK && r->plan.caustics && r->plan.desc.profile != ABBE_PROFILE_THESIS)
    result = abbe_program_make_compute(r->gl, "photon_cover.comp", r->defines, &r->cover, error);
  if (result == ABBE_OK && r->cover != 0 && fits_to_light(r)) result = fit_to_light(r, error);
  return result;
}

static void count_groups(abbe_renderer *r, GLuint list, GLuint rows) {
  const abbe_gl *gl = r->gl;
  gl->UseProgram(r->groups);
  gl->Uniform1ui(gl->GetUniformLocation(r->groups, "group_size"), PHOTON_GROUP);
  gl->Uniform1ui(gl->GetUniformLocation(r->groups, "rows"), rows);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS, list);
  gl->DispatchCompute(1, 1, 1);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

void abbe_renderer_set_grid(abbe_renderer *r, GLuint program, size_t light) {
  const size_t *cells = r->light[light].cells;
  r->gl->Uniform2i(r->gl->GetUniformLocation(program, "grid"), (GLint)cells[0], (GLint)cells[1]);
}

abbe_result abbe_renderer_place_photons(abbe_renderer *r, size_t light, GLuint coverage,
                                        int coverage_layer, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  static const GLuint zero[PHOTON_HEADER / 4] = {0};
  const size_t *cells = r->light[light].cells;
  for (int level = 0; level < LEVELS; level++) {
    int cell = 1 << (LEVELS - 1 - level);
    size_t part = (size_t)cell, across = (cells[0] + part - 1) / part,
           down = (cells[1] + part - 1) / part;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->list[level]);
    gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, zero);
    if (level > 0) count_groups(r, r->list[level - 1], 1);
    gl->UseProgram(r->place);
    abbe_renderer_bind_texture(r, r->place, "coverage", 0, coverage);
    abbe_renderer_set_int(r, r->place, "coverage_layer", coverage_layer);
    abbe_renderer_set_grid(r, r->place, light);
    abbe_renderer_set_int(r, r->place, "cell", cell);
    abbe_renderer_set_int(r, r->place, "first", level == 0);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS, r->list[level]);
    gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS_IN,
                       r->list[level > 0 ? level - 1 : 1]);
    if (level == 0) {
      gl->DispatchCompute((GLuint)((across * down + PHOTON_GROUP - 1) / PHOTON_GROUP), 1, 1);
    } else {
      gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, r->list[level - 1]);
      gl->DispatchComputeIndirect(4);
    }
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                      GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  count_groups(r, r->list[LEVELS - 1], 1);
  return abbe_gl_check(gl, "the placement of photons", error);
}

abbe_result abbe_renderer_start_photons(abbe_renderer *r, size_t light, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  static const GLuint zero[PHOTON_HEADER / 4] = {0};
  abbe_result result =
      abbe_renderer_place_photons(r, light, r->light_layers, 2 * (int)light, error);
  if (result != ABBE_OK) return result;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_SLOTS]);
  gl->ClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, zero);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, r->buffer[BINDING_PHOTONS]);
  gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, zero);
  abbe_renderer_bind_tables(r);
  set_start(r, r->cover, light);
  abbe_renderer_set_grid(r, r->cover, light);
  gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, BINDING_PHOTONS_IN, r->list[LEVELS - 1]);
  gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, r->list[LEVELS - 1]);
  gl->DispatchComputeIndirect(4);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  return abbe_gl_check(gl, "the start of photons", error);
}
