#include "gl/device/api.h"

#include <assert.h>
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
