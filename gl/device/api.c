#include "gl/device/api.h"

#include <stdio.h>
#include <string.h>

abbe_result abbe_gl_load(abbe_gl_lookup lookup, abbe_gl *out, abbe_error *error) {
  ABBE_REQUIRE(lookup && out, error);
  abbe_gl_function function;
  /* A pointer to a function travels as bytes: C has no cast between the two kinds that every
   * compiler accepts without a warning. */
#define ABBE_GL_LOAD(type, name)                                                                   \
  function = lookup("gl" #name);                                                                   \
  if (function == NULL)                                                                            \
    return abbe_error_set(error, ABBE_GL,                                                          \
                          "this OpenGL has no gl" #name "; Abbe needs OpenGL 4.5: use a newer "    \
                          "driver, or another --backend");                                         \
  memcpy(&out->name, &function, sizeof function);
  ABBE_GL_FUNCTIONS(ABBE_GL_LOAD)
#undef ABBE_GL_LOAD
  return ABBE_OK;
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
  default:
    return "unknown error";
  }
}

abbe_result abbe_gl_check(const abbe_gl *gl, const char *where, abbe_error *error) {
  ABBE_REQUIRE(gl && gl->GetError && where, error);
  GLenum first = gl->GetError();
  if (first == GL_NO_ERROR) return ABBE_OK;
  while (gl->GetError() != GL_NO_ERROR) continue;
  return abbe_error_set(error, first == GL_OUT_OF_MEMORY ? ABBE_NO_MEMORY : ABBE_GL,
                        "OpenGL reports '%s' in %s", error_name(first), where);
}
