#include "gl/device/gpu.h"

#include "base/clock.h"
#include "gl/device/bindings.h"

#include <math.h>
#include <stdint.h>

/* What a part of the work takes where somebody watches, and how many groups, or rows of groups, the
 * first has. */
static const double part_ms = 6;
enum { FIRST_PART = 4, MOST_GROUPS = 65535 };

size_t abbe_gpu_next_part(size_t units, double ms) {
  return (size_t)fmax((double)units * fmin(fmax(part_ms / fmax(ms, 1e-3), 0.25), 2), 1);
}

/* The next part's size, after one of so many units of all took so long. By software one may take
 * far longer than those before it, so that a part has few; but no dispatch has more than some
 * hundred parts. A GPU runs a few units no faster than many. */
static size_t next_part(const abbe_gpu *gpu, size_t units, size_t all, double ms) {
  enum { FEW = 8, MOST_PARTS = 512 };
  const double most = gpu->software ? fmax(FEW, (double)all / MOST_PARTS) : MOST_GROUPS;
  return (size_t)fmin((double)abbe_gpu_next_part(units, ms), fmin(most, MOST_GROUPS));
}

/* width: groups of a row, of which there are so many; 0: they are groups one after another. Where
 * nobody watches, parts have as many as a dispatch may. */
static void dispatch_parts(abbe_gpu *gpu, GLuint program, size_t units, size_t width) {
  const char *first = width > 0 ? "first_row" : "first_group";
  const size_t step = width > 0 ? 16 : 1, most = gpu->most_groups / (width > 0 ? width : 1);
  const bool watched = gpu->progress != NULL;
  size_t part = watched ? FIRST_PART : most > 0 ? most : 1, at = 0;
  gpu->gl->UseProgram(program);
  while (at < units && abbe_gpu_ask(gpu)) {
    const double start_ms = 1e3 * abbe_clock_seconds();
    const size_t count = units - at < part ? units - at : part;
    gpu->gl->UseProgram(program); /* whoever was asked may have drawn */
    abbe_gpu_set_uint(gpu, program, first, at * step);
    if (width > 0)
      gpu->gl->DispatchCompute((GLuint)width, (GLuint)count, 1);
    else
      gpu->gl->DispatchCompute((GLuint)count, 1, 1);
    at += count;
    if (watched) {
      gpu->gl->Finish();
      part = next_part(gpu, count, units, 1e3 * abbe_clock_seconds() - start_ms);
    } else {
      gpu->gl->Flush();
    }
  }
  abbe_gpu_set_uint(gpu, program, first, 0);
}

void abbe_gpu_dispatch(abbe_gpu *gpu, GLuint program, size_t groups) {
  const size_t rows = (groups + MOST_GROUPS - 1) / MOST_GROUPS;
  if (gpu->progress != NULL || groups > gpu->most_groups)
    dispatch_parts(gpu, program, groups, 0);
  else if (groups > 0)
    gpu->gl->DispatchCompute((GLuint)((groups + rows - 1) / rows), (GLuint)rows, 1);
}

/* One thread a texel; the shaders' groups are 32 x 16, large because a software rasteriser pays
 * for each. */
void abbe_gpu_dispatch_2d(abbe_gpu *gpu, GLuint program, size_t width, size_t height) {
  const size_t across = (width + 31) / 32, down = (height + 15) / 16;
  if (gpu->progress != NULL || across * down > gpu->most_groups)
    dispatch_parts(gpu, program, down, across);
  else
    gpu->gl->DispatchCompute((GLuint)across, (GLuint)down, 1);
}

/* As many groups as the device counts by itself. */
static void dispatch_listed(abbe_gpu *gpu, GLuint program, GLuint list, size_t first, size_t most,
                            size_t threads) {
  const abbe_gl *gl = gpu->gl;
  gl->UseProgram(gpu->list_groups);
  abbe_gpu_set_uint(gpu, gpu->list_groups, "group_size", ABBE_GPU_GROUP);
  abbe_gpu_set_uint(gpu, gpu->list_groups, "first", first);
  abbe_gpu_set_uint(gpu, gpu->list_groups, "most", most);
  abbe_gpu_set_uint(gpu, gpu->list_groups, "threads", threads);
  abbe_gpu_bind_storage(gpu, BINDING_DISPATCH, list);
  gl->DispatchCompute(1, 1, 1);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  gl->UseProgram(program);
  gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, list);
  gl->DispatchComputeIndirect(4);
}

/* Elements of a list whose threads are whole groups, as many as a dispatch may have; at most all.
 */
static size_t elements_of_part(const abbe_gpu *gpu, size_t most, size_t threads) {
  const size_t blocks = gpu->most_groups / threads;
  return blocks > most / ABBE_GPU_GROUP ? most : (blocks > 0 ? blocks : 1) * ABBE_GPU_GROUP;
}

void abbe_gpu_dispatch_list(abbe_gpu *gpu, GLuint program, GLuint list, size_t first, size_t most,
                            size_t threads) {
  const abbe_gl *gl = gpu->gl;
  if (gpu->progress != NULL) {
    const size_t count = abbe_gpu_read_count(gpu, list), left = count > first ? count - first : 0;
    const size_t elements = left < most ? left : most;
    dispatch_parts(gpu, program, (elements * threads + ABBE_GPU_GROUP - 1) / ABBE_GPU_GROUP, 0);
  } else {
    const size_t step = elements_of_part(gpu, most, threads);
    for (size_t at = 0; at < most; at += step) {
      const size_t count = most - at < step ? most - at : step;
      if (at > 0) {
        gl->Flush();
        gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        abbe_gpu_set_uint(gpu, program, "first_group", at * threads / ABBE_GPU_GROUP);
      }
      dispatch_listed(gpu, program, list, first + at, count, threads);
    }
    if (step < most) abbe_gpu_set_uint(gpu, program, "first_group", 0);
  }
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void abbe_gpu_dispatch_counted(abbe_gpu *gpu, GLuint program, GLuint list, size_t most) {
  GLuint groups[2] = {0, 0};
  if (gpu->progress == NULL && most / ABBE_GPU_GROUP < gpu->most_groups) {
    gpu->gl->BindBuffer(GL_DISPATCH_INDIRECT_BUFFER, list);
    gpu->gl->DispatchComputeIndirect(4);
    return;
  }
  gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  gpu->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 4, sizeof groups, groups);
  dispatch_parts(gpu, program, (size_t)groups[0] * groups[1], 0);
}

size_t abbe_gpu_most_threads(const abbe_gpu *gpu) {
  return gpu->most_groups > SIZE_MAX / ABBE_GPU_GROUP ? SIZE_MAX
                                                      : gpu->most_groups * ABBE_GPU_GROUP;
}

/* A band has an even count of rows: the four fragments whose differences are taken stay together.
 */
void abbe_gpu_draw_screen(abbe_gpu *gpu) {
  const abbe_gl *gl = gpu->gl;
  const size_t width = gpu->target[0], height = gpu->target[1];
  const size_t rows = abbe_gpu_most_threads(gpu) / (2 * width) * 2;
  gl->BindVertexArray(gpu->empty_array);
  if (rows >= height) {
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    return;
  }
  gl->Enable(GL_SCISSOR_TEST);
  for (size_t at = 0, count; at < height; at += count) {
    count = rows > 0 ? rows : 2;
    gl->Scissor(0, (GLint)at, (GLsizei)width, (GLsizei)count);
    gl->DrawArrays(GL_TRIANGLES, 0, 3);
    gl->Flush();
  }
  gl->Disable(GL_SCISSOR_TEST);
}

void abbe_gpu_draw_things(abbe_gpu *gpu, GLenum mode, size_t count, size_t vertices) {
  const size_t most = abbe_gpu_most_threads(gpu) / vertices, part = most > 0 ? most : 1;
  gpu->gl->BindVertexArray(gpu->empty_array);
  for (size_t at = 0; at < count; at += part) {
    const size_t here = count - at < part ? count - at : part;
    if (at > 0) gpu->gl->Flush();
    gpu->gl->DrawArrays(mode, (GLint)(vertices * at), (GLsizei)(vertices * here));
  }
}

void abbe_gpu_forget_samplers(abbe_gpu *gpu) {
  if (gpu->sampler_states == 0) return;
  gpu->gl->UseProgram(gpu->sampler_states);
  gpu->gl->ActiveTexture(GL_TEXTURE0);
  gpu->gl->BindTexture(GL_TEXTURE_2D, 0);
  gpu->gl->DispatchCompute(1, 1, 1);
}
