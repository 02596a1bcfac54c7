/* glsl.h: evaluates a GLSL function over an input array, for comparison with its double twin.
 *
 * The text defines `vec4 f(vec4 a, vec4 b)` and may include the renderer's files. It is called for
 * every pair of input vectors. Buffer bindings 30 and 31 are the harness's own.
 */
#ifndef ABBE_TESTS_GL_GLSL_H
#define ABBE_TESTS_GL_GLSL_H

#include "tests/gl/gl_context.h"

#include "gl/device/bindings.h"
#include "gl/device/program.h"
#include "gl/scene/gpu_scene.h"

#include <time.h>

/* A bound buffer of that target: GL_SHADER_STORAGE_BUFFER or GL_UNIFORM_BUFFER. */
static inline GLuint glsl_bind(const abbe_gl *gl, GLenum target, GLuint binding, size_t size,
                               const void *data) {
  GLuint buffer = 0;
  gl->GenBuffers(1, &buffer);
  gl->BindBuffer(target, buffer);
  gl->BufferData(target, (GLsizeiptr)size, data, GL_STATIC_DRAW);
  gl->BindBufferBase(target, binding, buffer);
  return buffer;
}

static inline GLuint glsl_buffer(const abbe_gl *gl, GLuint binding, size_t size, const void *data) {
  return glsl_bind(gl, GL_SHADER_STORAGE_BUFFER, binding, size, data);
}

static inline GLuint glsl_block(const abbe_gl *gl, GLuint binding, size_t size, const void *data) {
  return glsl_bind(gl, GL_UNIFORM_BUFFER, binding, size, data);
}

/* As the shaders read nodes and triangles, at that texture unit. */
static inline void glsl_texels(const abbe_gl *gl, GLenum unit, GLenum format, size_t size,
                               const void *data) {
  GLuint buffer = 0, texture = 0;
  gl->GenBuffers(1, &buffer);
  gl->BindBuffer(GL_TEXTURE_BUFFER, buffer);
  gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)size, data, GL_STATIC_DRAW);
  gl->GenTextures(1, &texture);
  gl->ActiveTexture(GL_TEXTURE0 + unit);
  gl->BindTexture(GL_TEXTURE_BUFFER, texture);
  gl->TexBuffer(GL_TEXTURE_BUFFER, format, buffer);
}

/* A tree's nodes where the shaders read them. */
static inline void glsl_hierarchy(const abbe_gl *gl, const abbe_bvh *h,
                                  const double (*triangle)[9]) {
  const size_t count = abbe_bvh_nodes_count(h);
  uint32_t(*texel)[4] = calloc(count, sizeof *texel);
  OK(abbe_bvh_nodes_pack(h, triangle, 0, 0, texel, &error));
  glsl_texels(gl, 7, GL_RGBA32UI, count * sizeof *texel, texel);
  free(texel);
}

/* The program of a function's text; the caller sets its uniforms and deletes it. */
static inline GLuint glsl_make(const abbe_gl *gl, const char *text) {
  static const char harness[] =
      "layout(local_size_x = 64) in;\n"
      "layout(std430, binding = 38) readonly buffer HarnessIn { vec4 harness_in[]; };\n"
      "layout(std430, binding = 39) writeonly buffer HarnessOut { vec4 harness_out[]; };\n"
      "uniform uint harness_count;\n"
      "void main() {\n"
      "  uint i = gl_GlobalInvocationID.x;\n"
      "  if (i < harness_count) harness_out[i] = f(harness_in[2u * i], harness_in[2u * i + 1u]);\n"
      "}\n";
  GLuint program = 0;
  OK(abbe_program_make_compute_text(gl, printed("%s%s", text, harness), NULL, &program, &error));
  gl->UseProgram(program);
  return program;
}

/* Runs the program in use over count inputs. */
static inline void glsl_run(const abbe_gl *gl, GLuint program, const float (*in)[8], size_t count,
                            float (*out)[4]) {
  GLuint inputs = glsl_buffer(gl, 38, count * sizeof *in, in);
  GLuint outputs = glsl_buffer(gl, 39, count * sizeof *out, NULL);
  gl->Uniform1ui(gl->GetUniformLocation(program, "harness_count"), (GLuint)count);
  gl->DispatchCompute((GLuint)((count + 63) / 64), 1, 1);
  gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, outputs);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(count * sizeof *out), out);
  gl->DeleteBuffers(1, &inputs);
  gl->DeleteBuffers(1, &outputs);
  OK(abbe_gl_check(gl, "the harness", &error));
}

/* Of all threads, whatever else the machine does. */
static inline double glsl_processor_ns(void) {
  return 1e9 * (double)clock() / CLOCKS_PER_SEC;
}

/* As glsl_run: ns of processor for each input, with the way there and back, once the program is at
 * work. */
static inline double glsl_time(const abbe_gl *gl, GLuint program, const float (*in)[8],
                               size_t count, float (*out)[4]) {
  glsl_run(gl, program, in, count, out);
  const double from = glsl_processor_ns();
  glsl_run(gl, program, in, count, out);
  return (glsl_processor_ns() - from) / (double)count;
}

static inline void glsl_evaluate(const abbe_gl *gl, const char *text, const float (*in)[8],
                                 size_t count, float (*out)[4]) {
  GLuint program = glsl_make(gl, text);
  glsl_run(gl, program, in, count, out);
  gl->DeleteProgram(program);
}

#endif
