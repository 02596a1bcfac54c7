#include "gl/beams/beam_list.h"

#include "gl/device/bindings.h"
#include "gl/device/float4.h"
#include "scenes/view/view.h"

#include <math.h>

enum { MOST_CELLS = 1 << 19, CELLS_A_PHOTON = 8, MOST_A_SIDE = 256 };
static const double SUMS_AT_MOST = 1 << 29; /* for a cell that all light passes */

static const abbe_plan *plan_of(const abbe_shaft_grid *grid) {
  return grid->scene->plan;
}

/* ---- make ---- */

/* Nearly cubes, no more than photons fill. */
static void lay_out(abbe_shaft_grid *grid, size_t i) {
  const abbe_plan *plan = plan_of(grid);
  const abbe_scene *scene = grid->scene->local;
  const int refractor = plan->shaft[i].refractor;
  const abbe_object *object =
      refractor < 0 ? NULL : &scene->object[plan->refractor_object[refractor]];
  const double photons = (double)plan->desc.photons * (double)plan->desc.photons;
  const double cells = fmin(CELLS_A_PHOTON * photons, MOST_CELLS / (double)plan->shaft_count);
  abbe_shaft_volume *v = &grid->volume[i];
  double volume = 1;
  for (int k = 0; k < 3; k++) {
    v->low[k] = object != NULL ? object->min[k] : scene->medium->min[k];
    v->high[k] = object != NULL ? object->max[k] : scene->medium->max[k];
    volume *= v->high[k] - v->low[k];
  }
  for (int k = 0; k < 3; k++) {
    const double side = (v->high[k] - v->low[k]) / cbrt(volume / cells);
    v->cells[k] = (size_t)fmin(fmax(ceil(side), 2), MOST_A_SIDE);
    if (k < 2 && v->cells[k] > grid->size[k]) grid->size[k] = v->cells[k];
  }
  v->first_layer = grid->layers;
  grid->layers += 2 * v->cells[2];
}

static double cell_of(const abbe_shaft_volume *v, int k) {
  return (v->high[k] - v->low[k]) / (double)v->cells[k];
}

static double widest_cell(const abbe_shaft_volume *v) {
  return fmax(cell_of(v, 0), fmax(cell_of(v, 1), cell_of(v, 2)));
}

/* What a cell's length scatters of all the lights' power within their views. */
static double most_of_a_cell(const abbe_shaft_grid *grid, size_t i) {
  const abbe_photon_lights *views = grid->volume[i].beams.caustics->views;
  double power = 0;
  for (size_t l = 0; l < plan_of(grid)->light_view_count; l++)
    power += grid->scene->local->light[plan_of(grid)->light_view[l].light].power *
             abbe_view_area(&views->light[l].near_view);
  return power * plan_of(grid)->shaft[i].scattering * widest_cell(&grid->volume[i]);
}

static abbe_result make_volume(abbe_shaft_grid *grid, size_t i, abbe_caustics *caustics,
                               const abbe_shader_variant *variant, abbe_error *error) {
  abbe_shaft_volume *v = &grid->volume[i];
  const size_t cells = v->cells[0] * v->cells[1] * v->cells[2];
  v->grid = grid;
  v->beams = (abbe_beam_list){
      .caustics = caustics, .medium = plan_of(grid)->shaft[i].refractor, .cell_m = widest_cell(v)};
  ABBE_TRY(abbe_beam_list_make(variant, &v->beams, error));
  return abbe_gpu_make_buffer(grid->scene->gpu, cells * 6 * sizeof(GLint), NULL, &v->sums, error);
}

abbe_result abbe_shaft_grid_make(abbe_caustics *caustics, const abbe_shader_variant *variant,
                                 abbe_shaft_grid *out, abbe_error *error) {
  const abbe_gpu_scene *scene = caustics->views->scene;
  *out = (abbe_shaft_grid){.scene = scene};
  const size_t count = scene->plan->shaft_count;
  for (size_t i = 0; i < count; i++) lay_out(out, i);
  ABBE_TRY(abbe_gpu_compute(scene->gpu, "shaft_add.comp", NULL, &out->add, error));
  ABBE_TRY(abbe_gpu_compute(scene->gpu, "shaft_resolve.comp", NULL, &out->resolve, error));
  for (size_t i = 0; i < count; i++) ABBE_TRY(make_volume(out, i, caustics, variant, error));
  return abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, out->size[0], out->size[1], out->layers,
                               true, &out->texture, error);
}

void abbe_shaft_grid_free(abbe_shaft_grid *grid) {
  if (grid->scene == NULL) return;
  abbe_gpu *gpu = grid->scene->gpu;
  for (size_t i = 0; i < ABBE_PLAN_MOST_SHAFTS; i++) {
    abbe_beam_list_free(&grid->volume[i].beams);
    abbe_gpu_drop_buffers(gpu, 1, &grid->volume[i].sums);
  }
  abbe_gpu_drop_textures(gpu, 1, &grid->texture);
  *grid = (abbe_shaft_grid){0};
}

/* ---- run ---- */

static void set_vector(const abbe_gpu *gpu, GLuint program, const char *name, const double v[3]) {
  gpu->gl->Uniform3f(gpu->gl->GetUniformLocation(program, name), (GLfloat)v[0], (GLfloat)v[1],
                     (GLfloat)v[2]);
}

static void set_cells(const abbe_shaft_volume *v, GLuint program) {
  const double cells[3] = {(double)v->cells[0], (double)v->cells[1], (double)v->cells[2]};
  set_vector(v->grid->scene->gpu, program, "cells", cells);
}

static abbe_result add_listed(void *user, size_t beams, abbe_error *error) {
  const abbe_shaft_volume *v = user;
  abbe_gpu *gpu = v->grid->scene->gpu;
  const GLuint add = v->grid->add;
  const double cell[3] = {cell_of(v, 0), cell_of(v, 1), cell_of(v, 2)};
  gpu->gl->UseProgram(add);
  set_cells(v, add);
  set_vector(gpu, add, "low", v->low);
  set_vector(gpu, add, "cell", cell);
  abbe_gpu_set_float(gpu, add, "unit", v->unit);
  abbe_gpu_set_uint(gpu, add, "most", v->beams.room);
  abbe_gpu_bind_storage(gpu, BINDING_SPLATS, v->beams.beams);
  abbe_gpu_bind_storage(gpu, BINDING_MAP_SUMS, v->sums);
  abbe_gpu_dispatch_list(gpu, add, v->beams.beams, 0, beams, 1);
  return abbe_gl_check(gpu->gl, "the light of shafts", error);
}

static void resolve(const abbe_shaft_volume *v) {
  const abbe_shaft_grid *grid = v->grid;
  abbe_gpu *gpu = grid->scene->gpu;
  const double volume = cell_of(v, 0) * cell_of(v, 1) * cell_of(v, 2);
  gpu->gl->UseProgram(grid->resolve);
  set_cells(v, grid->resolve);
  abbe_gpu_set_float(gpu, grid->resolve, "unit", v->unit / volume);
  abbe_gpu_set_int(gpu, grid->resolve, "first_layer", (int)v->first_layer);
  abbe_gpu_bind_storage(gpu, BINDING_MAP_SUMS, v->sums);
  gpu->gl->BindImageTexture(0, grid->texture, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  abbe_gpu_dispatch_2d(gpu, grid->resolve, v->cells[0], v->cells[1]);
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

abbe_result abbe_shaft_grid_run(abbe_shaft_grid *grid, const abbe_beam_use *with,
                                abbe_error *error) {
  if (grid->scene == NULL) return ABBE_OK;
  abbe_gpu *gpu = grid->scene->gpu;
  const size_t count = plan_of(grid)->shaft_count;
  abbe_beam_use to[ABBE_PLAN_MOST_SHAFTS + 1];
  abbe_gpu_start_lap(gpu);
  for (size_t i = 0; i < count; i++) {
    abbe_shaft_volume *v = &grid->volume[i];
    v->unit = most_of_a_cell(grid, i) / SUMS_AT_MOST;
    abbe_gpu_clear_buffer(gpu, v->sums);
    to[i] = (abbe_beam_use){&v->beams, add_listed, v};
  }
  if (with != NULL) to[count] = *with;
  const abbe_result result = abbe_beam_list_run(to, count + (with != NULL ? 1 : 0), error);
  for (size_t i = 0; i < count && result == ABBE_OK && !gpu->stopped; i++)
    resolve(&grid->volume[i]);
  abbe_gpu_book_lap(gpu, ABBE_PASS_SHAFTS);
  return result;
}

void abbe_shaft_grid_set(const abbe_shaft_grid *grid, GLuint program) {
  enum { MOST = ABBE_PLAN_MOST_SHAFTS };
  if (grid->scene == NULL) return;
  abbe_gpu *gpu = grid->scene->gpu;
  const abbe_gl *gl = gpu->gl;
  const GLsizei count = (GLsizei)plan_of(grid)->shaft_count;
  float low[MOST][3], high[MOST][3], place[MOST][4], medium[MOST][4];
  for (GLsizei i = 0; i < count; i++) {
    const abbe_shaft_volume *v = &grid->volume[i];
    for (int k = 0; k < 3; k++) {
      low[i][k] = (float)v->low[k];
      high[i][k] = (float)v->high[k];
    }
    for (int k = 0; k < 2; k++) place[i][k] = (float)v->cells[k] / (float)grid->size[k];
    place[i][2] = (float)v->first_layer;
    place[i][3] = (float)v->cells[2];
    abbe_float4_store(
        (const double[3]){plan_of(grid)->shaft[i].refractor, plan_of(grid)->shaft[i].g}, 0,
        medium[i]);
  }
  abbe_gpu_bind_array(gpu, program, "shaft_light", UNIT_SHAFTS, grid->texture);
  gl->Uniform3fv(gl->GetUniformLocation(program, "shaft_low"), count, low[0]);
  gl->Uniform3fv(gl->GetUniformLocation(program, "shaft_high"), count, high[0]);
  gl->Uniform4fv(gl->GetUniformLocation(program, "shaft_place"), count, place[0]);
  gl->Uniform4fv(gl->GetUniformLocation(program, "shaft_medium"), count, medium[0]);
}
