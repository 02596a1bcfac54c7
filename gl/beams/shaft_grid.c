#include "gl/beams/shaft_grid.h"

#include "gl/device/bindings.h"
#include "scenes/view/view.h"

#include <math.h>

enum { MOST_CELLS = 1 << 19, CELLS_A_PHOTON = 8, MOST_A_SIDE = 256 };
static const double SUMS_AT_MOST = 1 << 29; /* of a cell that all light passes */

static const abbe_plan *plan_of(const abbe_shaft_grid *grid) {
  return grid->scene->plan;
}

/* Nearly cubes, no more than photons fill. */
static void lay_out(abbe_shaft_grid *grid) {
  const abbe_plan *plan = plan_of(grid);
  const abbe_object *object =
      &grid->scene->local->object[plan->refractor_object[plan->shaft_refractor]];
  const double photons = (double)plan->desc.photons * (double)plan->desc.photons;
  const double cells = fmin(CELLS_A_PHOTON * photons, MOST_CELLS);
  double volume = 1;
  for (int k = 0; k < 3; k++) {
    grid->low[k] = object->min[k];
    grid->high[k] = object->max[k];
    volume *= object->max[k] - object->min[k];
  }
  for (int k = 0; k < 3; k++) {
    const double side = (grid->high[k] - grid->low[k]) / cbrt(volume / cells);
    grid->cells[k] = (size_t)fmin(fmax(ceil(side), 2), MOST_A_SIDE);
  }
}

static double cell_of(const abbe_shaft_grid *grid, int k) {
  return (grid->high[k] - grid->low[k]) / (double)grid->cells[k];
}

static double widest_cell(const abbe_shaft_grid *grid) {
  return fmax(cell_of(grid, 0), fmax(cell_of(grid, 1), cell_of(grid, 2)));
}

/* What a cell's length scatters of all the lights' power within their views. */
static double most_of_a_cell(const abbe_shaft_grid *grid) {
  const abbe_photon_lights *views = grid->beams.caustics->views;
  double power = 0, scatters = 0;
  for (int k = 0; k < ABBE_PLAN_HAZE_BANDS; k++)
    scatters = fmax(scatters, plan_of(grid)->shaft_haze.scatters[k]);
  for (size_t i = 0; i < plan_of(grid)->light_view_count; i++)
    power += grid->scene->local->light[plan_of(grid)->light_view[i].light].power *
             abbe_view_area(&views->light[i].near_view);
  return power * scatters * widest_cell(grid);
}

static abbe_result make_store(abbe_shaft_grid *grid, abbe_error *error) {
  abbe_gpu *gpu = grid->scene->gpu;
  const size_t cells = grid->cells[0] * grid->cells[1] * grid->cells[2];
  abbe_result result =
      abbe_gpu_make_buffer(gpu, cells * 6 * sizeof(GLint), NULL, &grid->sums, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(gpu, GL_RGBA32F, grid->cells[0], grid->cells[1],
                                   2 * grid->cells[2], true, &grid->texture, error);
  return result;
}

abbe_result abbe_shaft_grid_make(abbe_caustics *caustics, const abbe_shader_variant *variant,
                                 abbe_shaft_grid *out, abbe_error *error) {
  const abbe_gpu_scene *scene = caustics->views->scene;
  *out = (abbe_shaft_grid){.scene = scene};
  lay_out(out);
  out->beams = (abbe_beam_list){.caustics = caustics,
                                .medium = (int)scene->plan->shaft_refractor,
                                .cell_m = widest_cell(out)};
  abbe_result result = abbe_beam_list_make(variant, &out->beams, error);
  if (result == ABBE_OK)
    result = abbe_gpu_compute(scene->gpu, "shaft_add.comp", NULL, &out->add, error);
  if (result == ABBE_OK)
    result = abbe_gpu_compute(scene->gpu, "shaft_resolve.comp", NULL, &out->resolve, error);
  return result == ABBE_OK ? make_store(out, error) : result;
}

void abbe_shaft_grid_free(abbe_shaft_grid *grid) {
  if (grid->scene == NULL) return;
  abbe_gpu *gpu = grid->scene->gpu;
  abbe_beam_list_free(&grid->beams);
  abbe_gpu_drop_buffers(gpu, 1, &grid->sums);
  abbe_gpu_drop_textures(gpu, 1, &grid->texture);
  *grid = (abbe_shaft_grid){0};
}

static void set_vector(const abbe_gpu *gpu, GLuint program, const char *name, const double v[3]) {
  gpu->gl->Uniform3f(gpu->gl->GetUniformLocation(program, name), (GLfloat)v[0], (GLfloat)v[1],
                     (GLfloat)v[2]);
}

static void set_cells(const abbe_shaft_grid *grid, GLuint program) {
  const double cells[3] = {(double)grid->cells[0], (double)grid->cells[1], (double)grid->cells[2]};
  set_vector(grid->scene->gpu, program, "cells", cells);
}

static abbe_result add_listed(void *user, size_t beams, abbe_error *error) {
  abbe_shaft_grid *grid = user;
  abbe_gpu *gpu = grid->scene->gpu;
  const double cell[3] = {cell_of(grid, 0), cell_of(grid, 1), cell_of(grid, 2)};
  size_t layers = 0;
  for (int k = 0; k < 3; k++) layers = grid->cells[k] > layers ? grid->cells[k] : layers;
  gpu->gl->UseProgram(grid->add);
  set_cells(grid, grid->add);
  set_vector(gpu, grid->add, "low", grid->low);
  set_vector(gpu, grid->add, "cell", cell);
  abbe_gpu_set_float(gpu, grid->add, "unit", grid->unit);
  abbe_gpu_set_uint(gpu, grid->add, "most", grid->beams.room);
  abbe_gpu_set_int(gpu, grid->add, "layers", (int)layers);
  abbe_gpu_bind_storage(gpu, BINDING_SPLATS, grid->beams.beams);
  abbe_gpu_bind_storage(gpu, BINDING_MAP_SUMS, grid->sums);
  abbe_gpu_dispatch_list(gpu, grid->add, grid->beams.beams, 0, beams, layers);
  return abbe_gl_check(gpu->gl, "the light of shafts", error);
}

static void resolve(abbe_shaft_grid *grid) {
  abbe_gpu *gpu = grid->scene->gpu;
  const double volume = cell_of(grid, 0) * cell_of(grid, 1) * cell_of(grid, 2);
  gpu->gl->UseProgram(grid->resolve);
  set_cells(grid, grid->resolve);
  abbe_gpu_set_float(gpu, grid->resolve, "unit", grid->unit / volume);
  abbe_gpu_bind_storage(gpu, BINDING_MAP_SUMS, grid->sums);
  gpu->gl->BindImageTexture(0, grid->texture, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  abbe_gpu_dispatch_2d(gpu, grid->resolve, grid->cells[0], grid->cells[1]);
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

abbe_result abbe_shaft_grid_run(abbe_shaft_grid *grid, abbe_error *error) {
  if (grid->scene == NULL) return ABBE_OK;
  abbe_gpu *gpu = grid->scene->gpu;
  abbe_gpu_start_lap(gpu);
  grid->unit = most_of_a_cell(grid) / SUMS_AT_MOST;
  abbe_gpu_clear_buffer(gpu, grid->sums);
  const abbe_result result = abbe_beam_list_run(&grid->beams, add_listed, grid, error);
  if (result == ABBE_OK && !gpu->stopped) resolve(grid);
  abbe_gpu_book_lap(gpu, ABBE_PASS_SHAFTS);
  return result;
}

void abbe_shaft_grid_set(const abbe_shaft_grid *grid, GLuint program) {
  if (grid->scene == NULL) return;
  abbe_gpu *gpu = grid->scene->gpu;
  const abbe_plan_haze *haze = &plan_of(grid)->shaft_haze;
  abbe_gpu_bind_array(gpu, program, "shaft_light", UNIT_SHAFTS, grid->texture);
  set_vector(gpu, program, "shaft_low", grid->low);
  set_vector(gpu, program, "shaft_high", grid->high);
  abbe_gpu_set_float(gpu, program, "shaft_g", haze->g);
  abbe_gpu_set_int(gpu, program, "shaft_layers", (int)grid->cells[2]);
  abbe_gpu_set_int(gpu, program, "shaft_refractor", (int)plan_of(grid)->shaft_refractor);
}
