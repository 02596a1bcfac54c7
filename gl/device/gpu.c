#include "gl/device/gpu.h"

#include "base/clock.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_gpu_make(const abbe_gl *gl, abbe_gpu *out, abbe_error *error) {
  enum { MOST_GROUPS = 4096 }; /* a million threads, or two */
  out->gl = gl;
  out->most_groups = out->software ? SIZE_MAX : MOST_GROUPS;
  abbe_buffer_memory_begin(&out->memory, gl, out->software);
  gl->GenFramebuffers(1, &out->framebuffer);
  gl->GenVertexArrays(1, &out->empty_array);
  ABBE_TRY(abbe_gpu_compute(out, "list_groups.comp", NULL, &out->list_groups, error));
  if (!out->software) return ABBE_OK;
  return abbe_gpu_compute(out, "sampler_states.comp", NULL, &out->sampler_states, error);
}

void abbe_gpu_free(abbe_gpu *gpu) {
  if (gpu->gl == NULL) return;
  gpu->gl->DeleteTextures(ABBE_GPU_TEXEL_UNITS, gpu->texels);
  abbe_gpu_store_free(&gpu->store, gpu->gl);
  if (gpu->gl->Finish != NULL) { /* else the context may have its buffers still */
    gpu->gl->Finish();
    abbe_buffer_memory_free(&gpu->memory);
  }
  gpu->gl->DeleteFramebuffers(1, &gpu->framebuffer);
  gpu->gl->DeleteVertexArrays(1, &gpu->empty_array);
  *gpu = (abbe_gpu){0};
}

static abbe_result allocate_buffer(abbe_gpu *gpu, size_t size, GLuint *out, abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  gl->GenBuffers(1, out);
  const bool lent = abbe_buffer_memory_lend(&gpu->memory, gl, size, *out);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, *out);
  if (!lent) gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)size, NULL, GL_DYNAMIC_COPY);
  const abbe_result result = abbe_gl_check(gl, "the allocation of a buffer", error);
  if (result == ABBE_OK) return ABBE_OK;
  gl->DeleteBuffers(1, out);
  *out = 0;
  return result;
}

static abbe_result make_buffer(abbe_gpu *gpu, size_t size, const void *data, GLuint *out,
                               abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  const size_t room = abbe_gpu_store_room(size);
  const abbe_stored_key key = {.kind = ABBE_STORED_BUFFER, .bytes = room};
  abbe_result result = ABBE_OK;
  *out = abbe_gpu_store_take(&gpu->store, &key);
  if (*out != 0) {
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, *out);
  } else {
    ABBE_TRY(abbe_gl_check(gl, "what came before a buffer was allocated", error));
    if (room >= ABBE_MEMORY_LARGE) abbe_gpu_trim(gpu);
    result = allocate_buffer(gpu, room, out, error);
    if (result == ABBE_NO_MEMORY) {
      abbe_gpu_make_way(gpu);
      result = allocate_buffer(gpu, room, out, error);
    }
    if (result == ABBE_OK) result = abbe_gpu_store_add(&gpu->store, &key, *out, error);
  }
  if (result != ABBE_OK) {
    gl->DeleteBuffers(1, out);
    *out = 0;
  } else if (data != NULL && size > 0) {
    gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, data);
  }
  return result;
}

/* llvmpipe's limit is passed over: its shaders reach all of a buffer. */
abbe_result abbe_gpu_make_buffer(abbe_gpu *gpu, size_t size, const void *data, GLuint *out,
                                 abbe_error *error) {
  GLint most = 0;
  *out = 0;
  if (!gpu->software) gpu->gl->GetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
  if (most > 0 && size > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: shaders reach %d bytes of a buffer, and this one has %zu: use fewer "
                          "photons, a smaller picture, or --backend cpu",
                          gpu->gl->description, most, size);
  return make_buffer(gpu, size, data, out, error);
}

static size_t texel_bytes(GLenum format) {
  switch (format) {
  case GL_RGBA32F:
    return 16;
  case GL_RGBA16F:
    return 8;
  case GL_R16UI:
    return 2;
  default:
    return 4;
  }
}

static abbe_result allocate_storage(const abbe_gl *gl, GLenum target, const abbe_stored_key *key,
                                    GLuint *out, abbe_error *error) {
  const GLsizei levels = (GLsizei)key->levels, w = (GLsizei)key->width, h = (GLsizei)key->height;
  gl->GenTextures(1, out);
  gl->BindTexture(target, *out);
  if (key->layers > 0)
    gl->TexStorage3D(target, levels, key->format, w, h, (GLsizei)key->layers);
  else
    gl->TexStorage2D(target, levels, key->format, w, h);
  const abbe_result result = abbe_gl_check(gl, "the allocation of a texture", error);
  if (result == ABBE_OK) return ABBE_OK;
  gl->DeleteTextures(1, out);
  *out = 0;
  return result;
}

/* Takes up or makes the storage; it is bound then. */
static abbe_result make_storage(abbe_gpu *gpu, GLenum target, const abbe_stored_key *key,
                                GLuint *out, abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  *out = abbe_gpu_store_take(&gpu->store, key);
  if (*out != 0) {
    gl->BindTexture(target, *out);
    return ABBE_OK;
  }
  ABBE_TRY(abbe_gl_check(gl, "what came before a texture was allocated", error));
  abbe_result result = allocate_storage(gl, target, key, out, error);
  if (result == ABBE_NO_MEMORY) {
    abbe_gpu_make_way(gpu);
    result = allocate_storage(gl, target, key, out, error);
  }
  if (result == ABBE_OK) result = abbe_gpu_store_add(&gpu->store, key, *out, error);
  if (result == ABBE_OK) return ABBE_OK;
  gl->DeleteTextures(1, out);
  *out = 0;
  return result;
}

static void set_filter(const abbe_gl *gl, GLenum target, GLint small, GLint large) {
  gl->TexParameteri(target, GL_TEXTURE_MIN_FILTER, small);
  gl->TexParameteri(target, GL_TEXTURE_MAG_FILTER, large);
  gl->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

abbe_result abbe_gpu_make_texture(abbe_gpu *gpu, GLenum format, size_t width, size_t height,
                                  size_t layers, bool linear, GLuint *out, abbe_error *error) {
  const GLenum target = layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
  const abbe_stored_key key = {.kind = ABBE_STORED_TEXTURE,
                               .format = format,
                               .bytes =
                                   width * height * (layers > 0 ? layers : 1) * texel_bytes(format),
                               .width = width,
                               .height = height,
                               .layers = layers,
                               .levels = 1};
  ABBE_TRY(make_storage(gpu, target, &key, out, error));
  set_filter(gpu->gl, target, filter, filter);
  return ABBE_OK;
}

abbe_result abbe_gpu_make_levels(abbe_gpu *gpu, GLenum format, size_t side, size_t layers,
                                 size_t levels, GLuint *out, abbe_error *error) {
  size_t texels = 0;
  for (size_t i = 0; i < levels; i++) texels += (side >> i) * (side >> i);
  const abbe_stored_key key = {.kind = ABBE_STORED_TEXTURE,
                               .format = format,
                               .bytes = texels * layers * texel_bytes(format),
                               .width = side,
                               .height = side,
                               .layers = layers,
                               .levels = levels};
  ABBE_TRY(make_storage(gpu, GL_TEXTURE_2D_ARRAY, &key, out, error));
  set_filter(gpu->gl, GL_TEXTURE_2D_ARRAY, GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  return ABBE_OK;
}

void abbe_gpu_drop_buffers(abbe_gpu *gpu, size_t count, GLuint *buffer) {
  for (size_t i = 0; i < count; i++) {
    if (buffer[i] != 0) abbe_gpu_store_put_back(&gpu->store, ABBE_STORED_BUFFER, buffer[i]);
    buffer[i] = 0;
  }
}

void abbe_gpu_drop_textures(abbe_gpu *gpu, size_t count, GLuint *texture) {
  for (size_t i = 0; i < count; i++) {
    if (texture[i] != 0) abbe_gpu_store_put_back(&gpu->store, ABBE_STORED_TEXTURE, texture[i]);
    texture[i] = 0;
  }
}

void abbe_gpu_trim(abbe_gpu *gpu) {
  abbe_gpu_store_trim(&gpu->store, gpu->gl);
  abbe_buffer_memory_sweep(&gpu->memory, gpu->gl, &gpu->store);
}

/* Texels hold their buffers. (Elsewhere they stay: Mesa's llvmpipe compiles what finds other texels
 * at a unit, or none, once more.) */
void abbe_gpu_make_way(abbe_gpu *gpu) {
  gpu->gl->Finish();
  gpu->gl->DeleteTextures(ABBE_GPU_TEXEL_UNITS, gpu->texels);
  memset(gpu->texels, 0, sizeof gpu->texels);
  abbe_gpu_trim(gpu);
  abbe_buffer_memory_shrink(&gpu->memory);
}

size_t abbe_gpu_program_count(const abbe_gpu *gpu) {
  return abbe_gpu_store_count(&gpu->store, ABBE_STORED_PROGRAM);
}

void abbe_gpu_drop_programs(abbe_gpu *gpu) {
  for (size_t i = 0; i < gpu->store.count; i++) {
    abbe_stored *item = &gpu->store.item[i];
    const bool own = item->name == gpu->list_groups || item->name == gpu->sampler_states;
    if (item->key.kind == ABBE_STORED_PROGRAM && !own) item->used = false;
  }
  abbe_gpu_trim(gpu);
}

size_t abbe_gpu_bytes(const abbe_gpu *gpu) {
  return abbe_gpu_store_bytes(&gpu->store);
}

/* Files and definitions; malloc'd. */
static char *program_text(const abbe_program_stage *stages, size_t count, const char *defines) {
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  if (to == NULL) return NULL;
  for (size_t i = 0; i < count; i++) fprintf(to, "%s\n", stages[i].file);
  if (defines != NULL) fputs(defines, to);
  const bool failed = ferror(to) != 0;
  if (fclose(to) == 0 && !failed) return text;
  free(text);
  return NULL;
}

/* A driver that knows the program takes a millisecond or so of the processor's time, in which no
 * other program of the machine counts. The first one starts its compiler. */
static void tell_compiling(abbe_gpu *gpu, double ms) {
  static const double known_ms = 15;
  if (gpu->compiling == NULL || ms < known_ms || abbe_gpu_program_count(gpu) == 0) return;
  gpu->compiling(gpu->progress_user);
  gpu->compiling = NULL;
}

abbe_result abbe_gpu_program(abbe_gpu *gpu, const abbe_program_stage *stages, size_t count,
                             const char *defines, GLuint *out, abbe_error *error) {
  char *text = program_text(stages, count, defines);
  if (text == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a shader");
  const abbe_stored_key key = {.kind = ABBE_STORED_PROGRAM, .text = text};
  *out = abbe_gpu_store_take(&gpu->store, &key);
  abbe_result result = ABBE_OK;
  if (*out == 0 && !abbe_gpu_ask(gpu)) {
    result = abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
  } else if (*out == 0) {
    const double start_ms = 1e3 * abbe_clock_thread_seconds();
    result = abbe_program_make(gpu->gl, stages, count, defines, out, error);
    tell_compiling(gpu, 1e3 * abbe_clock_thread_seconds() - start_ms);
    if (result == ABBE_OK) result = abbe_gpu_store_add(&gpu->store, &key, *out, error);
    if (result != ABBE_OK) {
      gpu->gl->DeleteProgram(*out);
      *out = 0;
    }
  }
  free(text);
  return result;
}

abbe_result abbe_gpu_compute(abbe_gpu *gpu, const char *file, const char *defines, GLuint *out,
                             abbe_error *error) {
  const abbe_program_stage stage = {GL_COMPUTE_SHADER, file};
  return abbe_gpu_program(gpu, &stage, 1, defines, out, error);
}

/* A layer of -1 attaches the whole texture: a 2D one, or every layer of an array. */
abbe_result abbe_gpu_set_target(abbe_gpu *gpu, const GLuint *colour, const int *layer, size_t count,
                                GLuint depth, size_t width, size_t height, abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  GLenum attachments[4];
  gl->BindFramebuffer(GL_FRAMEBUFFER, gpu->framebuffer);
  for (size_t i = 0; i < 4; i++) {
    GLenum attachment = GL_COLOR_ATTACHMENT0 + (GLenum)i;
    GLuint texture = i < count ? colour[i] : 0;
    if (i < count && layer[i] >= 0)
      gl->FramebufferTextureLayer(GL_FRAMEBUFFER, attachment, texture, 0, layer[i]);
    else
      gl->FramebufferTexture(GL_FRAMEBUFFER, attachment, texture, 0);
    attachments[i] = attachment;
  }
  gl->FramebufferTexture(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, depth, 0);
  gl->DrawBuffers((GLsizei)count, attachments);
  gl->Viewport(0, 0, (GLsizei)width, (GLsizei)height);
  gpu->target[0] = width;
  gpu->target[1] = height;
  if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return ABBE_OK;
  return abbe_error_set(error, ABBE_GL, "this OpenGL cannot render to a %zu x %zu float texture",
                        width, height);
}

void abbe_gpu_begin_depths(abbe_gpu *gpu, bool clears) {
  static const GLfloat farthest = 0;
  gpu->gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gpu->gl->DepthFunc(GL_GREATER);
  gpu->gl->Enable(GL_DEPTH_TEST);
  if (clears) gpu->gl->ClearBufferfv(GL_DEPTH, 0, &farthest);
}

void abbe_gpu_end_depths(abbe_gpu *gpu) {
  gpu->gl->Disable(GL_DEPTH_TEST);
  gpu->gl->DepthFunc(GL_LESS);
  gpu->gl->ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
}

abbe_result abbe_gpu_make_texels(abbe_gpu *gpu, GLenum format, size_t size, const void *data,
                                 int unit, GLuint *buffer, GLuint *texture, abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  abbe_gpu_drop_buffers(gpu, 1, buffer);
  ABBE_TRY(make_buffer(gpu, size, data, buffer, error));
  if (*texture == 0) gl->GenTextures(1, texture);
  gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gl->BindTexture(GL_TEXTURE_BUFFER, *texture);
  gl->TexBuffer(GL_TEXTURE_BUFFER, format, *buffer);
  return abbe_gl_check(gl, "the upload of texels", error);
}

void abbe_gpu_bind_array(abbe_gpu *gpu, GLuint program, const char *name, int unit,
                         GLuint texture) {
  GLint location = gpu->gl->GetUniformLocation(program, name);
  if (location < 0) return;
  gpu->gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gpu->gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  gpu->gl->Uniform1i(location, unit);
}

void abbe_gpu_bind_texture(abbe_gpu *gpu, GLuint program, const char *name, int unit,
                           GLuint texture) {
  gpu->gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gpu->gl->BindTexture(GL_TEXTURE_2D, texture);
  gpu->gl->Uniform1i(gpu->gl->GetUniformLocation(program, name), unit);
}

void abbe_gpu_bind_texels(abbe_gpu *gpu, GLuint program, const char *name, int unit, GLenum format,
                          GLuint buffer) {
  const abbe_gl *gl = gpu->gl;
  if (gpu->texels[unit] == 0) gl->GenTextures(1, &gpu->texels[unit]);
  gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gl->BindTexture(GL_TEXTURE_BUFFER, gpu->texels[unit]);
  gl->TexBuffer(GL_TEXTURE_BUFFER, format, buffer);
  gl->Uniform1i(gl->GetUniformLocation(program, name), unit);
}

void abbe_gpu_set_int(abbe_gpu *gpu, GLuint program, const char *name, int value) {
  gpu->gl->Uniform1i(gpu->gl->GetUniformLocation(program, name), value);
}

void abbe_gpu_set_uint(abbe_gpu *gpu, GLuint program, const char *name, size_t value) {
  gpu->gl->Uniform1ui(gpu->gl->GetUniformLocation(program, name), (GLuint)value);
}

void abbe_gpu_set_float(abbe_gpu *gpu, GLuint program, const char *name, double value) {
  gpu->gl->Uniform1f(gpu->gl->GetUniformLocation(program, name), (float)value);
}

void abbe_gpu_bind_storage(abbe_gpu *gpu, GLuint binding, GLuint buffer) {
  gpu->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer);
}

void abbe_gpu_clear_buffer(abbe_gpu *gpu, GLuint buffer) {
  static const GLuint zero = 0;
  enum { PIECE = 8 << 20 }; /* as much as is cleared in some milliseconds */
  const abbe_gl *gl = gpu->gl;
  const size_t bytes =
      abbe_gpu_store_bytes_of(&gpu->store, ABBE_STORED_BUFFER, buffer) & ~(size_t)3;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  if (gpu->progress == NULL || bytes <= PIECE) {
    gl->ClearBufferData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
    return;
  }
  for (size_t at = 0; at < bytes && abbe_gpu_ask(gpu); at += PIECE) {
    const size_t size = bytes - at < PIECE ? bytes - at : PIECE;
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer); /* whoever was asked may have drawn */
    gl->ClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, (GLintptr)at, (GLsizeiptr)size,
                           GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
  }
}

void abbe_gpu_clear_list(abbe_gpu *gpu, GLuint list) {
  abbe_gpu_set_list(gpu, list, 0);
}

void abbe_gpu_set_list(abbe_gpu *gpu, GLuint list, size_t count) {
  const GLuint header[ABBE_GPU_LIST_HEADER / 4] = {(GLuint)count};
  gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  gpu->gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof header, header);
}

void abbe_gpu_copy(abbe_gpu *gpu, GLuint from, size_t from_byte, GLuint to, size_t to_byte,
                   size_t bytes) {
  const abbe_gl *gl = gpu->gl;
  gl->BindBuffer(GL_COPY_READ_BUFFER, from);
  gl->BindBuffer(GL_COPY_WRITE_BUFFER, to);
  gl->CopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, (GLintptr)from_byte,
                        (GLintptr)to_byte, (GLsizeiptr)bytes);
}

size_t abbe_gpu_read_count(abbe_gpu *gpu, GLuint list) {
  GLuint count = 0;
  gpu->gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, list);
  gpu->gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
  return count;
}

void abbe_gpu_watch(abbe_gpu *gpu, abbe_render_progress progress, void *user) {
  gpu->progress = progress;
  gpu->progress_user = user;
  gpu->done = 0;
  gpu->stopped = false;
}

bool abbe_gpu_ask(abbe_gpu *gpu) {
  if (gpu->progress != NULL && !gpu->stopped)
    gpu->stopped = !gpu->progress(gpu->progress_user, gpu->done);
  return !gpu->stopped;
}

abbe_result abbe_gpu_tell(abbe_gpu *gpu, double done, abbe_error *error) {
  gpu->done = done;
  if (abbe_gpu_ask(gpu)) return ABBE_OK;
  return abbe_error_set(error, ABBE_CANCELLED, "the render was cancelled");
}

void abbe_gpu_start_lap(abbe_gpu *gpu) {
  if (gpu->statistics == NULL) return;
  gpu->gl->Finish();
  gpu->lap_start_ms = 1e3 * abbe_clock_seconds();
}

void abbe_gpu_book_lap(abbe_gpu *gpu, abbe_pass pass) {
  if (gpu->statistics == NULL) return;
  gpu->gl->Finish();
  const double now_ms = 1e3 * abbe_clock_seconds();
  abbe_statistics_add_ms(gpu->statistics, pass, now_ms - gpu->lap_start_ms);
  gpu->lap_start_ms = now_ms;
}
