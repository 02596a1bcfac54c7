#include "gl/device/api.h"

#include "gl/device/bindings.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

abbe_result abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error) {
  abbe_gl_function function;
  const char *missing = NULL;
  /* A pointer to a function travels as bytes: C has no cast between the two kinds that every
   * compiler accepts without a warning. */
#define ABBE_GL_LOAD(type, name)                                                                   \
  function = lookup("gl" #name);                                                                   \
  if (function == NULL && missing == NULL) missing = "gl" #name;                                   \
  memcpy(&out->name, &function, sizeof function);
  ABBE_GL_FUNCTIONS(ABBE_GL_LOAD)
#undef ABBE_GL_LOAD
  return missing == NULL ? ABBE_OK
                         : abbe_error_set(error, ABBE_GL,
                                          "this OpenGL has no %s; Abbe needs all of 4.5", missing);
}

static const char *error_name(GLenum code) {
  switch (code) {
  case GL_INVALID_ENUM:
    return "invalid enum";
  case GL_INVALID_VALUE:
    return "invalid value";
  case GL_INVALID_OPERATION:
    return "invalid operation";
  case GL_INVALID_FRAMEBUFFER_OPERATION:
    return "incomplete framebuffer";
  case GL_OUT_OF_MEMORY:
    return "out of memory";
  case GL_CONTEXT_LOST:
    return "context lost";
  default:
    return "unknown error";
  }
}

void abbe_gl_clear_errors(const abbe_gl *gl) {
  enum { FLAGS = 8 };
  for (int i = 0; i < FLAGS && gl->GetError() != GL_NO_ERROR; i++) continue;
}

abbe_result abbe_gl_check(const abbe_gl *gl, const char *where, abbe_error *error) {
  assert(gl->GetError);
  GLenum first = gl->GetError();
  if (first == GL_NO_ERROR) return ABBE_OK;
  abbe_gl_clear_errors(gl);
  if (first == GL_CONTEXT_LOST)
    return abbe_error_set(
        error, ABBE_GL,
        "OpenGL's device was lost in %s (%s): the driver reset it, or it is gone; "
        "draw again with less at once (a smaller --size, fewer --photons), or use "
        "--backend cpu",
        where, gl->description != NULL ? gl->description : "a driver unnamed");
  return abbe_error_set(error, first == GL_OUT_OF_MEMORY ? ABBE_NO_MEMORY : ABBE_GL,
                        "OpenGL reports '%s' in %s", error_name(first), where);
}

_Static_assert(UNIT_SHAFTS < ABBE_GL_STATE_UNITS, "the last unit keeps a caller's sampler");

static void set_enables(const abbe_gl *gl) {
  static const GLenum off[] = {
      GL_BLEND,
      GL_COLOR_LOGIC_OP,
      GL_CULL_FACE,
      GL_DEPTH_CLAMP,
      GL_DEPTH_TEST,
      GL_FRAMEBUFFER_SRGB,
      GL_LINE_SMOOTH,
      GL_POLYGON_OFFSET_FILL,
      GL_POLYGON_OFFSET_LINE,
      GL_POLYGON_OFFSET_POINT,
      GL_POLYGON_SMOOTH,
      GL_PRIMITIVE_RESTART,
      GL_PRIMITIVE_RESTART_FIXED_INDEX,
      GL_PROGRAM_POINT_SIZE,
      GL_RASTERIZER_DISCARD,
      GL_SAMPLE_ALPHA_TO_COVERAGE,
      GL_SAMPLE_ALPHA_TO_ONE,
      GL_SAMPLE_COVERAGE,
      GL_SAMPLE_MASK,
      GL_SAMPLE_SHADING,
      GL_SCISSOR_TEST,
      GL_STENCIL_TEST,
      GL_TEXTURE_CUBE_MAP_SEAMLESS,
  };
  for (size_t i = 0; i < sizeof off / sizeof *off; i++) gl->Disable(off[i]);
  for (GLenum i = 0; i < 8; i++) gl->Disable(GL_CLIP_DISTANCE0 + i); /* 8: every GL has these */
  gl->Enable(GL_DITHER);
  gl->Enable(GL_MULTISAMPLE);
}

/* What no enable switches off, or what an enable of the passes brings to bear. */
static void set_settings(const abbe_gl *gl) {
  gl->BlendEquation(GL_FUNC_ADD);
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->ClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl->CullFace(GL_BACK);
  gl->DepthFunc(GL_LESS);
  gl->DepthMask(GL_TRUE);
  gl->DepthRange(0, 1);
  gl->FrontFace(GL_CCW);
  gl->Hint(GL_FRAGMENT_SHADER_DERIVATIVE_HINT, GL_DONT_CARE);
  gl->PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl->ProvokingVertex(GL_LAST_VERTEX_CONVENTION);
}

static void set_pixels(const abbe_gl *gl, GLint alignment) {
  static const GLenum zero[] = {GL_PACK_SWAP_BYTES,    GL_PACK_LSB_FIRST,     GL_PACK_ROW_LENGTH,
                                GL_PACK_IMAGE_HEIGHT,  GL_PACK_SKIP_ROWS,     GL_PACK_SKIP_PIXELS,
                                GL_PACK_SKIP_IMAGES,   GL_UNPACK_SWAP_BYTES,  GL_UNPACK_LSB_FIRST,
                                GL_UNPACK_ROW_LENGTH,  GL_UNPACK_SKIP_ROWS,   GL_UNPACK_SKIP_PIXELS,
                                GL_UNPACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT};
  for (size_t i = 0; i < sizeof zero / sizeof *zero; i++) gl->PixelStorei(zero[i], 0);
  gl->PixelStorei(GL_PACK_ALIGNMENT, alignment);
  gl->PixelStorei(GL_UNPACK_ALIGNMENT, alignment);
  gl->BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  gl->BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

static void set_all(const abbe_gl *gl, GLint alignment) {
  set_enables(gl);
  set_settings(gl);
  set_pixels(gl, alignment);
  gl->BindSamplers(0, ABBE_GL_STATE_UNITS, NULL);
}

void abbe_gl_state_begin(const abbe_gl *gl) {
  abbe_gl_clear_errors(gl);
  set_all(gl, 1);
}

void abbe_gl_state_end(const abbe_gl *gl) {
  set_all(gl, 4);
  gl->BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl->UseProgram(0);
  gl->BindVertexArray(0);
  gl->ActiveTexture(GL_TEXTURE0);
}
