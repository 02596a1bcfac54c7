#include "gl/light/photon_start.h"

#include "gl/device/bindings.h"

abbe_result abbe_photon_cells_make(abbe_gpu *gpu, size_t side, abbe_photon_cells *out,
                                   abbe_error *error) {
  out->gpu = gpu;
  ABBE_TRY(abbe_gpu_compute(gpu, "photon_place.comp", NULL, &out->place, error));
  ABBE_TRY(abbe_gpu_compute(gpu, "photon_groups.comp", NULL, &out->groups, error));
  for (int level = 0; level < ABBE_CELL_LEVELS; level++) {
    /* The finer level's cells: four for each of this one's, rounded up at the rim. */
    const size_t across = (side >> (ABBE_CELL_LEVELS - 1 - level)) + 2;
    const size_t room = level == ABBE_CELL_LEVELS - 1 ? side * side : 4 * across * across;
    ABBE_TRY(
        abbe_gpu_make_buffer(gpu, ABBE_PHOTON_HEADER + room * 4, NULL, &out->list[level], error));
  }
  return ABBE_OK;
}

void abbe_photon_cells_free(abbe_photon_cells *cells) {
  if (cells->gpu == NULL) return;
  abbe_gpu_drop_buffers(cells->gpu, ABBE_CELL_LEVELS, cells->list);
}

static void clear_header(abbe_gpu *gpu, GLuint list) {
  static const GLuint zero[ABBE_PHOTON_HEADER / 4] = {0};
  gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof zero, zero);
}

static void count_groups(abbe_photon_cells *cells, GLuint list) {
  const abbe_gl *gl = cells->gpu->gl;
  if (cells->gpu->stopped) return;
  gl->UseProgram(cells->groups);
  abbe_gpu_set_uint(cells->gpu, cells->groups, "group_size", ABBE_GPU_GROUP);
  abbe_gpu_bind_storage(cells->gpu, BINDING_CELLS, list);
  gl->DispatchCompute(1, 1, 1);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

static void list_level(abbe_photon_cells *cells, const size_t grid[2], int level) {
  const abbe_gl *gl = cells->gpu->gl;
  const size_t part = (size_t)1 << (ABBE_CELL_LEVELS - 1 - level);
  const size_t across = (grid[0] + part - 1) / part, down = (grid[1] + part - 1) / part;
  clear_header(cells->gpu, cells->list[level]);
  if (level > 0) count_groups(cells, cells->list[level - 1]);
  gl->UseProgram(cells->place);
  abbe_gpu_set_int(cells->gpu, cells->place, "cell", (int)part);
  abbe_gpu_set_int(cells->gpu, cells->place, "first", level == 0);
  abbe_gpu_bind_storage(cells->gpu, BINDING_CELLS, cells->list[level]);
  abbe_gpu_bind_storage(cells->gpu, BINDING_COARSER_CELLS, cells->list[level > 0 ? level - 1 : 1]);
  if (level == 0) {
    const size_t groups = (across * down + ABBE_GPU_GROUP - 1) / ABBE_GPU_GROUP;
    abbe_gpu_dispatch(cells->gpu, cells->place, groups);
  } else {
    abbe_gpu_dispatch_counted(cells->gpu, cells->place, cells->list[level - 1], across * down);
  }
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                    GL_BUFFER_UPDATE_BARRIER_BIT);
}

abbe_result abbe_photon_cells_run(abbe_photon_cells *cells, const size_t grid[2], GLuint coverage,
                                  int layer, abbe_error *error) {
  const abbe_gl *gl = cells->gpu->gl;
  gl->UseProgram(cells->place);
  abbe_gpu_bind_array(cells->gpu, cells->place, "coverage", 0, coverage);
  abbe_gpu_set_int(cells->gpu, cells->place, "coverage_layer", layer);
  gl->Uniform2i(gl->GetUniformLocation(cells->place, "grid"), (GLint)grid[0], (GLint)grid[1]);
  for (int level = 0; level < ABBE_CELL_LEVELS; level++) list_level(cells, grid, level);
  count_groups(cells, cells->list[ABBE_CELL_LEVELS - 1]);
  return abbe_gl_check(gl, "the placement of photons", error);
}

abbe_result abbe_photon_start_make(const abbe_photon_lights *views, const abbe_light_layers *layers,
                                   const abbe_shader_variant *variant, abbe_photon_start *out,
                                   abbe_error *error) {
  abbe_gpu *gpu = views->scene->gpu;
  const size_t side = views->scene->plan->desc.photons, cells = side * side;
  out->views = views;
  out->layers = layers;
  ABBE_TRY(abbe_photon_cells_make(gpu, side, &out->cells, error));
  ABBE_TRY(abbe_gpu_make_buffer(gpu, cells * 4, NULL, &out->photon_of_cell, error));
  ABBE_TRY(abbe_gpu_make_buffer(gpu, ABBE_PHOTON_HEADER + cells * ABBE_PHOTON_BYTES, NULL,
                                &out->photons, error));
  return abbe_shader_variant_compute(variant, gpu, "photon_cover.comp", NULL, &out->cover, error);
}

void abbe_photon_start_free(abbe_photon_start *start) {
  if (start->views == NULL) return;
  GLuint buffers[] = {start->photons, start->photon_of_cell};
  abbe_photon_cells_free(&start->cells);
  abbe_gpu_drop_buffers(start->views->scene->gpu, 2, buffers);
}

static void use(const abbe_photon_lights *views, const abbe_light_layers *layers, GLuint program,
                size_t light) {
  abbe_gpu_scene_bind(views->scene);
  abbe_photon_lights_bind(views);
  abbe_gpu_forget_samplers(views->scene->gpu);
  views->scene->gpu->gl->UseProgram(program);
  abbe_gpu_scene_set(views->scene, program);
  abbe_light_layers_set(layers, program);
  abbe_gpu_set_int(views->scene->gpu, program, "light", (int)light);
}

void abbe_photon_start_bind(const abbe_photon_start *start) {
  abbe_gpu_bind_storage(start->cells.gpu, BINDING_PHOTONS, start->photons);
  abbe_gpu_bind_storage(start->cells.gpu, BINDING_PHOTON_OF_CELL, start->photon_of_cell);
}

size_t abbe_photon_start_count(const abbe_photon_start *start) {
  return abbe_gpu_read_count(start->cells.gpu, start->photons);
}

abbe_result abbe_photon_start_run(abbe_photon_start *start, size_t light, abbe_error *error) {
  abbe_gpu *gpu = start->cells.gpu;
  const GLuint lit = start->cells.list[ABBE_CELL_LEVELS - 1];
  ABBE_TRY(abbe_photon_cells_run(&start->cells, start->views->light[light].cells,
                                 start->layers->layers, 2 * (int)light, error));
  ABBE_TRY(abbe_gpu_tell(gpu, gpu->done, error));
  abbe_gpu_clear_buffer(gpu, start->photon_of_cell);
  clear_header(gpu, start->photons);
  use(start->views, start->layers, start->cover, light);
  abbe_photon_start_bind(start);
  abbe_photon_lights_set_grid(start->views, start->cover, light);
  abbe_gpu_bind_storage(gpu, BINDING_CELLS, lit);
  const size_t *cells = start->views->light[light].cells;
  abbe_gpu_dispatch_counted(gpu, start->cover, lit, cells[0] * cells[1]);
  gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  ABBE_TRY(abbe_gl_check(gpu->gl, "the start of photons", error));
  return abbe_gpu_tell(gpu, gpu->done, error);
}
