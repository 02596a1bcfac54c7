#include "gl/device/state.h"

#include "gl/device/bindings.h"

#include <stddef.h>

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
