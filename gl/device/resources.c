#include "gl/renderer_state.h"

#include <math.h>
#include <time.h>

double abbe_renderer_now_ms(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

abbe_result abbe_renderer_make_buffer(abbe_renderer *r, size_t size, const void *data, GLuint *out,
                                      abbe_error *error) {
  const abbe_gl *gl = r->gl;
  if (size == 0) size = 16; /* a bound buffer may not be empty */
  gl->GenBuffers(1, out);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, *out);
  gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)size, data, GL_DYNAMIC_COPY);
  r->device_bytes += size;
  return abbe_gl_check(gl, "the allocation of a buffer", error);
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

abbe_result abbe_renderer_make_texture(abbe_renderer *r, GLenum format, size_t width, size_t height,
                                       size_t layers, bool linear, GLuint *out, abbe_error *error) {
  const abbe_gl *gl = r->gl;
  GLenum target = layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  gl->GenTextures(1, out);
  gl->BindTexture(target, *out);
  if (layers > 0)
    gl->TexStorage3D(target, 1, format, (GLsizei)width, (GLsizei)height, (GLsizei)layers);
  else
    gl->TexStorage2D(target, 1, format, (GLsizei)width, (GLsizei)height);
  gl->TexParameteri(target, GL_TEXTURE_MIN_FILTER, linear ? GL_LINEAR : GL_NEAREST);
  gl->TexParameteri(target, GL_TEXTURE_MAG_FILTER, linear ? GL_LINEAR : GL_NEAREST);
  gl->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  r->device_bytes += width * height * (layers > 0 ? layers : 1) * texel_bytes(format);
  return abbe_gl_check(gl, "the allocation of a texture", error);
}

/* A layer of -1 attaches the whole texture: a 2D one, or every layer of an array. */
abbe_result abbe_renderer_set_target(abbe_renderer *r, const GLuint *colour, const int *layer,
                                     size_t count, GLuint depth, size_t width, size_t height,
                                     abbe_error *error) {
  const abbe_gl *gl = r->gl;
  GLenum attachments[4];
  gl->BindFramebuffer(GL_FRAMEBUFFER, r->framebuffer);
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
  if (gl->CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return ABBE_OK;
  return abbe_error_set(error, ABBE_GL, "this OpenGL cannot render to a %zu x %zu float texture",
                        width, height);
}

abbe_result abbe_renderer_make_texels(abbe_renderer *r, GLenum format, size_t size,
                                      const void *data, int unit, GLuint *buffer, GLuint *texture,
                                      abbe_error *error) {
  const abbe_gl *gl = r->gl;
  gl->DeleteBuffers(1, buffer);
  *buffer = 0;
  abbe_result result = abbe_renderer_make_buffer(r, size, data, buffer, error);
  if (result != ABBE_OK) return result;
  if (*texture == 0) gl->GenTextures(1, texture);
  gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gl->BindTexture(GL_TEXTURE_BUFFER, *texture);
  gl->TexBuffer(GL_TEXTURE_BUFFER, format, *buffer);
  return abbe_gl_check(gl, "the upload of texels", error);
}

void abbe_renderer_bind_texture(abbe_renderer *r, GLuint program, const char *name, int unit,
                                GLuint texture) {
  GLint location = r->gl->GetUniformLocation(program, name);
  if (location < 0) return;
  r->gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  r->gl->BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  r->gl->Uniform1i(location, unit);
}

void abbe_renderer_bind_texture_2d(abbe_renderer *r, GLuint program, const char *name, int unit,
                                   GLuint texture) {
  r->gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  r->gl->BindTexture(GL_TEXTURE_2D, texture);
  r->gl->Uniform1i(r->gl->GetUniformLocation(program, name), unit);
}

void abbe_renderer_bind_texels(abbe_renderer *r, GLuint program, const char *name, int unit,
                               GLenum format, GLuint buffer) {
  const abbe_gl *gl = r->gl;
  if (r->texels[unit] == 0) gl->GenTextures(1, &r->texels[unit]);
  gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gl->BindTexture(GL_TEXTURE_BUFFER, r->texels[unit]);
  gl->TexBuffer(GL_TEXTURE_BUFFER, format, buffer);
  gl->Uniform1i(gl->GetUniformLocation(program, name), unit);
}

void abbe_renderer_set_int(abbe_renderer *r, GLuint program, const char *name, int value) {
  r->gl->Uniform1i(r->gl->GetUniformLocation(program, name), value);
}

void abbe_renderer_set_float(abbe_renderer *r, GLuint program, const char *name, double value) {
  r->gl->Uniform1f(r->gl->GetUniformLocation(program, name), (float)value);
}

/* The scene's tables, as uniform blocks and as storage: the shaders choose by size. */
void abbe_renderer_bind_tables(abbe_renderer *r) {
  for (GLuint i = 0; i < BINDING_COUNT; i++) {
    if (r->buffer[i] == 0) continue;
    if (i <= BINDING_SPECTRA) r->gl->BindBufferBase(GL_UNIFORM_BUFFER, i, r->buffer[i]);
    r->gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, i, r->buffer[i]);
  }
  for (GLenum k = 0; k < 3; k++) {
    if (r->hierarchy_texture[k] == 0) continue;
    r->gl->ActiveTexture(GL_TEXTURE0 + HIERARCHY_UNIT + k);
    r->gl->BindTexture(GL_TEXTURE_BUFFER, r->hierarchy_texture[k]);
  }
  for (GLenum k = 0; k < PAGE_TABLES; k++) {
    if (r->page_texture[k] == 0) continue;
    r->gl->ActiveTexture(GL_TEXTURE0 + PAGE_UNIT + k);
    r->gl->BindTexture(GL_TEXTURE_BUFFER, r->page_texture[k]);
  }
  if (r->table_warps != 0)
    r->gl->BindBufferBase(GL_UNIFORM_BUFFER, BINDING_SPECTRA + 2, r->table_warps);
  if (r->table_shadows != 0)
    r->gl->BindBufferBase(GL_UNIFORM_BUFFER, BINDING_SPECTRA + 4, r->table_shadows);
  if (r->table_bands != 0)
    r->gl->BindBufferBase(GL_UNIFORM_BUFFER, BINDING_SPECTRA + 1, r->table_bands);
}

/* One thread a texel; the shaders' groups are 32 x 16, large because a software rasteriser pays
 * for each. */
void abbe_renderer_dispatch_2d(abbe_renderer *r, size_t width, size_t height) {
  r->gl->DispatchCompute((GLuint)((width + 31) / 32), (GLuint)((height + 15) / 16), 1);
}

void abbe_renderer_draw(abbe_renderer *r, size_t object) {
  const mesh_buffers *mesh = &r->mesh[object];
  r->gl->BindVertexArray(mesh->array);
  r->gl->DrawElements(GL_TRIANGLES, mesh->index_count, GL_UNSIGNED_INT, NULL);
}

void abbe_renderer_begin_pass(abbe_renderer *r) {
  if (r->statistics == NULL) return;
  r->gl->Finish();
  r->pass_start_ms = abbe_renderer_now_ms();
}

void abbe_renderer_end_pass(abbe_renderer *r, abbe_pass pass) {
  if (r->statistics == NULL) return;
  r->gl->Finish();
  const double now_ms = abbe_renderer_now_ms();
  abbe_statistics_add_ms(r->statistics, pass, now_ms - r->pass_start_ms);
  r->pass_start_ms = now_ms;
}
