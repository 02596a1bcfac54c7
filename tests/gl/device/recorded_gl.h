/* recorded_gl.h: OpenGL's calls of a test, recorded with what each program declares: what a shader
 * has written and is used in another way without that way's barrier is printed and counted, and so
 * is a program of more blocks, samplers or images than OpenGL 4.5 promises. For a program that is
 * linked with --wrap=abbe_gl_load, and has one context at a time.
 */
#ifndef ABBE_TESTS_GL_DEVICE_RECORDED_GL_H
#define ABBE_TESTS_GL_DEVICE_RECORDED_GL_H

#include "tests/check.h"

#include "gl/device/api.h"

enum { NAMES = 1 << 14, UNITS = 96, TARGETS = 4, ATTACHMENTS = 8, SHADERS = 1 << 12 };

/* Of a buffer or texture: barriers that have not come since a shader wrote it, and which did. */
typedef struct written {
  GLbitfield pending;
  GLuint by;
} written;

static abbe_gl real;
static PFNGLGETPROGRAMINTERFACEIVPROC interface_count;
static PFNGLGETPROGRAMRESOURCEIVPROC resource;
static PFNGLGETPROGRAMRESOURCENAMEPROC resource_name;
static PFNGLGETUNIFORMIVPROC uniform_value;

static written buffer[NAMES], texture[NAMES];
static GLuint root[NAMES];                  /* of a view: the texture whose texels it shows */
static GLuint shown[NAMES];                 /* of a buffer texture: its buffer */
static GLuint storage[UNITS], block[UNITS]; /* buffers by binding */
static GLuint bound[UNITS][TARGETS];        /* textures by unit */
static struct {
  GLuint texture;
  GLenum access;
} image[UNITS];
static GLuint attached[NAMES][ATTACHMENTS + 1]; /* of framebuffers */
static GLuint program, unit, draw_framebuffer, read_framebuffer;
static GLuint of_target[8]; /* buffers that are bound for transfers */
static char *text[SHADERS];
static GLuint shaders[NAMES][4];
static size_t hazards;

static int target_index(GLenum target) {
  return target == GL_TEXTURE_2D         ? 0
         : target == GL_TEXTURE_2D_ARRAY ? 1
         : target == GL_TEXTURE_BUFFER   ? 2
                                         : 3;
}

static GLuint *buffer_of(GLenum target) {
  switch (target) {
  case GL_SHADER_STORAGE_BUFFER:
    return &of_target[0];
  case GL_UNIFORM_BUFFER:
    return &of_target[1];
  case GL_COPY_READ_BUFFER:
    return &of_target[2];
  case GL_COPY_WRITE_BUFFER:
    return &of_target[3];
  case GL_DISPATCH_INDIRECT_BUFFER:
    return &of_target[4];
  case GL_DRAW_INDIRECT_BUFFER:
    return &of_target[5];
  case GL_TEXTURE_BUFFER:
    return &of_target[6];
  default:
    return &of_target[7];
  }
}

static void need(written *w, GLbitfield barrier, const char *what, GLuint name) {
  if ((w->pending & barrier) == 0) return;
  print_error("%s %u, which program %u wrote, is used by program %u without barrier 0x%x\n", what,
              name, w->by, program, barrier);
  hazards++;
}

static void need_buffer(GLuint name, GLbitfield barrier) {
  assert_true(name < NAMES);
  if (name != 0) need(&buffer[name], barrier, "buffer", name);
}

/* What is declared is there, whether or not it is read. */
static void need_bound(GLuint name, const char *what) {
  if (name != 0) return;
  print_error("program %u declares %s, and nothing is bound there\n", program, what);
  hazards++;
}

/* most: what OpenGL 4.5 promises to one stage; the whole program has no more. */
static void need_promised(GLint count, GLint most, const char *what) {
  if (count <= most) return;
  print_error("program %u has %d %s, and %d are promised\n", program, count, what, most);
  hazards++;
}

static void need_texture(GLuint name, GLbitfield barrier) {
  assert_true(name < NAMES);
  need(&texture[root[name]], barrier, "texture", name);
}

/* Whether the program's own text declares the block so that it is never written. */
static bool is_read_only(GLuint of, const char *name) {
  const char *pattern = printed("buffer %s ", name);
  for (int i = 0; i < 4 && shaders[of][i] != 0; i++) {
    const char *source = text[shaders[of][i]];
    for (const char *at = source; (at = strstr(at, pattern)) != NULL; at++) {
      const char *line = at;
      while (line > source && line[-1] != '\n') line--;
      for (; line < at; line++)
        if (strncmp(line, "readonly", 8) == 0) return true;
    }
  }
  return false;
}

static void use_storage(GLuint i) {
  static const GLenum property[] = {GL_BUFFER_BINDING};
  char name[96] = "";
  GLint binding = 0;
  resource(program, GL_SHADER_STORAGE_BLOCK, i, 1, property, 1, NULL, &binding);
  resource_name(program, GL_SHADER_STORAGE_BLOCK, i, sizeof name, NULL, name);
  written *w = &buffer[storage[binding]];
  need_bound(storage[binding], name);
  /* parts of one dispatch add to one another */
  if (w->by != program) need_buffer(storage[binding], GL_SHADER_STORAGE_BARRIER_BIT);
  if (!is_read_only(program, name)) *w = (written){GL_ALL_BARRIER_BITS, program};
}

static void use_image(GLint at) {
  written *w = &texture[root[image[at].texture]];
  if (w->by != program) need_texture(image[at].texture, GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  if (image[at].access != GL_READ_ONLY) *w = (written){GL_ALL_BARRIER_BITS, program};
}

static void use_sampler(GLint at, int target) {
  const GLuint name = bound[at][target];
  if (target == target_index(GL_TEXTURE_BUFFER))
    need_buffer(shown[name], GL_TEXTURE_FETCH_BARRIER_BIT);
  else
    need_texture(name, GL_TEXTURE_FETCH_BARRIER_BIT);
}

/* Where a sampler of that type looks; -1: it is no sampler. */
static int sampler_target(GLenum type) {
  static const GLenum samplers[][2] = {{GL_SAMPLER_2D, GL_TEXTURE_2D},
                                       {GL_INT_SAMPLER_2D, GL_TEXTURE_2D},
                                       {GL_UNSIGNED_INT_SAMPLER_2D, GL_TEXTURE_2D},
                                       {GL_SAMPLER_2D_ARRAY, GL_TEXTURE_2D_ARRAY},
                                       {GL_SAMPLER_2D_ARRAY_SHADOW, GL_TEXTURE_2D_ARRAY},
                                       {GL_UNSIGNED_INT_SAMPLER_2D_ARRAY, GL_TEXTURE_2D_ARRAY},
                                       {GL_SAMPLER_BUFFER, GL_TEXTURE_BUFFER},
                                       {GL_INT_SAMPLER_BUFFER, GL_TEXTURE_BUFFER},
                                       {GL_UNSIGNED_INT_SAMPLER_BUFFER, GL_TEXTURE_BUFFER},
                                       {GL_SAMPLER_CUBE, GL_TEXTURE_CUBE_MAP}};
  for (size_t i = 0; i < sizeof samplers / sizeof *samplers; i++)
    if (samplers[i][0] == type) return target_index(samplers[i][1]);
  return -1;
}

/* Returns how many images, or samplers, it is. */
static GLint use_uniform(GLuint i, bool images) {
  static const GLenum properties[] = {GL_TYPE, GL_LOCATION, GL_ARRAY_SIZE};
  GLint value[3] = {0, -1, 1};
  resource(program, GL_UNIFORM, i, 3, properties, 3, NULL, value);
  const int target = sampler_target((GLenum)value[0]);
  const bool is_image =
      value[0] >= GL_IMAGE_1D && value[0] <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
  if (images ? !is_image : target < 0) return 0;
  for (GLint k = 0; value[1] >= 0 && k < value[2]; k++) {
    GLint at = 0;
    uniform_value(program, value[1] + k, &at);
    assert_true(at >= 0 && at < UNITS);
    if (images)
      use_image(at);
    else
      use_sampler(at, target);
  }
  return value[2];
}

/* What the program in use reads, then what it writes. One does neither, and is llvmpipe's alone
 * (abbe_gpu_forget_samplers). */
static void use_all(void) {
  static const GLenum property[] = {GL_BUFFER_BINDING};
  GLint count = 0, uniforms = 0, samplers = 0, images = 0;
  if (strstr(text[shaders[program][0]], "uniform bool never;") != NULL) return;
  interface_count(program, GL_UNIFORM, GL_ACTIVE_RESOURCES, &uniforms);
  for (GLint i = 0; i < uniforms; i++) samplers += use_uniform((GLuint)i, false);
  need_promised(samplers, 16, "samplers");
  interface_count(program, GL_UNIFORM_BLOCK, GL_ACTIVE_RESOURCES, &count);
  need_promised(count, 14, "uniform blocks");
  for (GLint i = 0; i < count; i++) {
    GLint binding = 0;
    resource(program, GL_UNIFORM_BLOCK, (GLuint)i, 1, property, 1, NULL, &binding);
    char name[96] = "";
    resource_name(program, GL_UNIFORM_BLOCK, (GLuint)i, sizeof name, NULL, name);
    need_bound(block[binding], name);
    need_buffer(block[binding], GL_UNIFORM_BARRIER_BIT);
  }
  interface_count(program, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
  need_promised(count, 8, "storage blocks");
  for (GLint i = 0; i < count; i++) use_storage((GLuint)i);
  for (GLint i = 0; i < uniforms; i++) images += use_uniform((GLuint)i, true);
  need_promised(images, 8, "images");
}

static void use_framebuffer(GLuint name) {
  for (size_t i = 0; i <= ATTACHMENTS; i++)
    need_texture(attached[name][i], GL_FRAMEBUFFER_BARRIER_BIT);
}

static void use_for_drawing(void) {
  use_framebuffer(draw_framebuffer);
  use_all();
}

/* ---- the calls ---- */

static void APIENTRY bind_buffer(GLenum target, GLuint name) {
  *buffer_of(target) = name;
  real.BindBuffer(target, name);
}

static void APIENTRY bind_buffer_base(GLenum target, GLuint at, GLuint name) {
  assert_true(at < UNITS);
  if (target == GL_SHADER_STORAGE_BUFFER) storage[at] = name;
  if (target == GL_UNIFORM_BUFFER) block[at] = name;
  *buffer_of(target) = name;
  real.BindBufferBase(target, at, name);
}

static void APIENTRY active_texture(GLenum at) {
  unit = at - GL_TEXTURE0;
  real.ActiveTexture(at);
}

static void APIENTRY bind_texture(GLenum target, GLuint name) {
  assert_true(unit < UNITS && name < NAMES);
  bound[unit][target_index(target)] = name;
  if (root[name] == 0) root[name] = name;
  real.BindTexture(target, name);
}

static void APIENTRY texture_view(GLuint name, GLenum target, GLuint of, GLenum format,
                                  GLuint level, GLuint levels, GLuint layer, GLuint layers) {
  root[name] = root[of];
  real.TextureView(name, target, of, format, level, levels, layer, layers);
}

static void APIENTRY tex_buffer(GLenum target, GLenum format, GLuint name) {
  shown[bound[unit][target_index(target)]] = name;
  real.TexBuffer(target, format, name);
}

static void APIENTRY bind_image(GLuint at, GLuint name, GLint level, GLboolean layered, GLint layer,
                                GLenum access, GLenum format) {
  assert_true(at < UNITS);
  image[at].texture = name;
  image[at].access = access;
  real.BindImageTexture(at, name, level, layered, layer, access, format);
}

static void APIENTRY delete_buffers(GLsizei count, const GLuint *name) {
  for (GLsizei i = 0; i < count; i++) buffer[name[i]] = (written){0};
  real.DeleteBuffers(count, name);
}

static void APIENTRY delete_textures(GLsizei count, const GLuint *name) {
  for (GLsizei i = 0; i < count; i++) {
    texture[name[i]] = (written){0};
    root[name[i]] = shown[name[i]] = 0;
  }
  real.DeleteTextures(count, name);
}

static void APIENTRY buffer_data(GLenum target, GLsizeiptr size, const void *data, GLenum usage) {
  buffer[*buffer_of(target)] = (written){0};
  real.BufferData(target, size, data, usage);
}

static void APIENTRY buffer_sub_data(GLenum target, GLintptr from, GLsizeiptr size,
                                     const void *data) {
  need_buffer(*buffer_of(target), GL_BUFFER_UPDATE_BARRIER_BIT);
  real.BufferSubData(target, from, size, data);
}

static void APIENTRY get_buffer(GLenum target, GLintptr from, GLsizeiptr size, void *data) {
  need_buffer(*buffer_of(target), GL_BUFFER_UPDATE_BARRIER_BIT);
  real.GetBufferSubData(target, from, size, data);
}

static void APIENTRY clear_buffer(GLenum target, GLenum inner, GLenum format, GLenum type,
                                  const void *data) {
  need_buffer(*buffer_of(target), GL_BUFFER_UPDATE_BARRIER_BIT);
  real.ClearBufferData(target, inner, format, type, data);
}

static void APIENTRY clear_buffer_part(GLenum target, GLenum inner, GLintptr from, GLsizeiptr size,
                                       GLenum format, GLenum type, const void *data) {
  need_buffer(*buffer_of(target), GL_BUFFER_UPDATE_BARRIER_BIT);
  real.ClearBufferSubData(target, inner, from, size, format, type, data);
}

static void APIENTRY copy_buffer(GLenum from, GLenum to, GLintptr at, GLintptr put,
                                 GLsizeiptr size) {
  need_buffer(*buffer_of(from), GL_BUFFER_UPDATE_BARRIER_BIT);
  need_buffer(*buffer_of(to), GL_BUFFER_UPDATE_BARRIER_BIT);
  real.CopyBufferSubData(from, to, at, put, size);
}

static void APIENTRY get_texture(GLenum target, GLint level, GLenum format, GLenum type,
                                 void *data) {
  need_texture(bound[unit][target_index(target)], GL_TEXTURE_UPDATE_BARRIER_BIT);
  real.GetTexImage(target, level, format, type, data);
}

static void APIENTRY copy_texture(GLuint from, GLenum target, GLint level, GLint x, GLint y,
                                  GLint z, GLuint to, GLenum to_target, GLint to_level, GLint to_x,
                                  GLint to_y, GLint to_z, GLsizei w, GLsizei h, GLsizei d) {
  need_texture(from, GL_TEXTURE_UPDATE_BARRIER_BIT);
  need_texture(to, GL_TEXTURE_UPDATE_BARRIER_BIT);
  real.CopyImageSubData(from, target, level, x, y, z, to, to_target, to_level, to_x, to_y, to_z, w,
                        h, d);
}

static void APIENTRY bind_framebuffer(GLenum target, GLuint name) {
  if (target != GL_READ_FRAMEBUFFER) draw_framebuffer = name;
  if (target != GL_DRAW_FRAMEBUFFER) read_framebuffer = name;
  real.BindFramebuffer(target, name);
}

static void attach(GLenum target, GLenum at, GLuint name) {
  const GLuint to = target == GL_READ_FRAMEBUFFER ? read_framebuffer : draw_framebuffer;
  const GLuint place = at == GL_DEPTH_ATTACHMENT ? ATTACHMENTS : at - GL_COLOR_ATTACHMENT0;
  assert_true(to < NAMES && place <= ATTACHMENTS);
  attached[to][place] = name;
}

static void APIENTRY attach_texture(GLenum target, GLenum at, GLuint name, GLint level) {
  attach(target, at, name);
  real.FramebufferTexture(target, at, name, level);
}

static void APIENTRY attach_layer(GLenum target, GLenum at, GLuint name, GLint level, GLint layer) {
  attach(target, at, name);
  real.FramebufferTextureLayer(target, at, name, level, layer);
}

static void APIENTRY blit(GLint x0, GLint y0, GLint x1, GLint y1, GLint u0, GLint v0, GLint u1,
                          GLint v1, GLbitfield mask, GLenum filter) {
  use_framebuffer(read_framebuffer);
  use_framebuffer(draw_framebuffer);
  real.BlitFramebuffer(x0, y0, x1, y1, u0, v0, u1, v1, mask, filter);
}

static void APIENTRY shader_source(GLuint shader, GLsizei count, const GLchar *const *part,
                                   const GLint *length) {
  assert_true(shader < SHADERS);
  size_t size = 1;
  for (GLsizei i = 0; i < count; i++)
    size += length != NULL && length[i] >= 0 ? (size_t)length[i] : strlen(part[i]);
  free(text[shader]);
  text[shader] = calloc(1, size);
  for (GLsizei i = 0; i < count; i++)
    strncat(text[shader], part[i],
            length != NULL && length[i] >= 0 ? (size_t)length[i] : strlen(part[i]));
  real.ShaderSource(shader, count, part, length);
}

static void APIENTRY attach_shader(GLuint to, GLuint shader) {
  int i = 0;
  while (i < 3 && shaders[to][i] != 0) i++;
  shaders[to][i] = shader;
  real.AttachShader(to, shader);
}

static GLuint APIENTRY create_program(void) {
  const GLuint made = real.CreateProgram();
  assert_true(made < NAMES);
  memset(shaders[made], 0, sizeof shaders[made]);
  return made;
}

static void APIENTRY use_program(GLuint name) {
  program = name;
  real.UseProgram(name);
}

static void APIENTRY memory_barrier(GLbitfield bits) {
  for (size_t i = 0; i < NAMES; i++) {
    buffer[i].pending &= ~bits;
    texture[i].pending &= ~bits;
  }
  real.MemoryBarrier(bits);
}

static void APIENTRY dispatch(GLuint x, GLuint y, GLuint z) {
  use_all();
  real.DispatchCompute(x, y, z);
}

static void APIENTRY dispatch_indirect(GLintptr at) {
  need_buffer(*buffer_of(GL_DISPATCH_INDIRECT_BUFFER), GL_COMMAND_BARRIER_BIT);
  use_all();
  real.DispatchComputeIndirect(at);
}

static void APIENTRY draw_arrays(GLenum mode, GLint first, GLsizei count) {
  use_for_drawing();
  real.DrawArrays(mode, first, count);
}

static void APIENTRY draw_indirect(GLenum mode, const void *at) {
  need_buffer(*buffer_of(GL_DRAW_INDIRECT_BUFFER), GL_COMMAND_BARRIER_BIT);
  use_for_drawing();
  real.DrawArraysIndirect(mode, at);
}

static void APIENTRY draw_elements(GLenum mode, GLsizei count, GLenum type, const void *at) {
  use_for_drawing();
  real.DrawElements(mode, count, type, at);
}

static bool as_gpu;

static const GLubyte *APIENTRY get_string(GLenum name) {
  return name == GL_RENDERER && as_gpu ? (const GLubyte *)"as a GPU" : real.GetString(name);
}

static void find(abbe_gl_lookup lookup, const char *name, void *function) {
  const abbe_gl_function found = lookup(name);
  assert_non_null(found);
  memcpy(function, &found, sizeof found);
}

abbe_result __real_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);
abbe_result __wrap_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error);
abbe_result __wrap_abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error) {
  const abbe_result result = __real_abbe_gl_load(lookup, out, error);
  if (result != ABBE_OK) return result;
  real = *out;
  find(lookup, "glGetProgramInterfaceiv", &interface_count);
  find(lookup, "glGetProgramResourceiv", &resource);
  find(lookup, "glGetProgramResourceName", &resource_name);
  find(lookup, "glGetUniformiv", &uniform_value);
  out->BindBuffer = bind_buffer;
  out->BindBufferBase = bind_buffer_base;
  out->ActiveTexture = active_texture;
  out->BindTexture = bind_texture;
  out->TextureView = texture_view;
  out->TexBuffer = tex_buffer;
  out->BindImageTexture = bind_image;
  out->DeleteBuffers = delete_buffers;
  out->DeleteTextures = delete_textures;
  out->BufferData = buffer_data;
  out->BufferSubData = buffer_sub_data;
  out->GetBufferSubData = get_buffer;
  out->ClearBufferData = clear_buffer;
  out->ClearBufferSubData = clear_buffer_part;
  out->CopyBufferSubData = copy_buffer;
  out->GetTexImage = get_texture;
  out->CopyImageSubData = copy_texture;
  out->BindFramebuffer = bind_framebuffer;
  out->FramebufferTexture = attach_texture;
  out->FramebufferTextureLayer = attach_layer;
  out->BlitFramebuffer = blit;
  out->ShaderSource = shader_source;
  out->AttachShader = attach_shader;
  out->CreateProgram = create_program;
  out->UseProgram = use_program;
  out->MemoryBarrier = memory_barrier;
  out->DispatchCompute = dispatch;
  out->DispatchComputeIndirect = dispatch_indirect;
  out->DrawArrays = draw_arrays;
  out->DrawArraysIndirect = draw_indirect;
  out->DrawElements = draw_elements;
  out->GetString = get_string;
  return result;
}

/* Each context has names of its own. */
static void forget(void) {
  memset(buffer, 0, sizeof buffer);
  memset(texture, 0, sizeof texture);
  memset(root, 0, sizeof root);
  memset(shown, 0, sizeof shown);
  memset(attached, 0, sizeof attached);
  memset(bound, 0, sizeof bound);
  memset(storage, 0, sizeof storage);
  memset(block, 0, sizeof block);
}

#endif
