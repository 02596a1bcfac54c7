#include "gl/device/context.h"

#include "gl/device/context_backend.h"

#include <stdio.h>
#include <stdlib.h>

struct abbe_context {
  abbe_context_native native;
  abbe_gl gl;
  char description[256];
};

static const char *const names[] = {
#define ABBE_CONTEXT_NAME(code, name) name,
    ABBE_CONTEXT_BACKENDS(ABBE_CONTEXT_NAME)
#undef ABBE_CONTEXT_NAME
};

const char *abbe_context_backend_name(abbe_context_backend backend) {
  return (int)backend >= 0 && backend < ABBE_CONTEXT_BACKEND_COUNT ? names[backend] : "unknown";
}

static const char *other_name(abbe_context_backend backend) {
  return names[backend == ABBE_CONTEXT_EGL ? ABBE_CONTEXT_OSMESA : ABBE_CONTEXT_EGL];
}

/* A name that a driver does not tell. */
static const char *told(const GLubyte *text) {
  return text != NULL ? (const char *)text : "unnamed";
}

static abbe_result check_version(abbe_context *context, abbe_context_backend backend,
                                 abbe_error *error) {
  GLint major = 0, minor = 0;
  context->gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  context->gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  snprintf(context->description, sizeof context->description, "%s: %s, OpenGL %s", names[backend],
           told(context->gl.GetString(GL_RENDERER)), told(context->gl.GetString(GL_VERSION)));
  if (major * 10 + minor >= 45) return ABBE_OK;
  return abbe_error_set(error, ABBE_GL,
                        "%s offers OpenGL %d.%d; Abbe needs 4.5: use --gl %s, or a newer driver",
                        names[backend], major, minor, other_name(backend));
}

/* What the passes take for granted beyond, or as much as, OpenGL 4.5 promises. */
static abbe_result check_limits(const abbe_context *context, abbe_context_backend backend,
                                abbe_error *error) {
  static const struct {
    GLenum limit;
    GLint least;
    const char *what;
  } limits[] = {
      {GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, 16, "storage buffers in a compute shader"},
      {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, 16, "places for storage buffers"},
      {GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, 512, "invocations in a compute group"},
      {GL_MAX_COLOR_ATTACHMENTS, 8, "colour attachments"},
      {GL_MAX_TEXTURE_SIZE, 4096, "texels a side of a texture"},
  };
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
    GLint there = 0;
    context->gl.GetIntegerv(limits[i].limit, &there);
    if (there < limits[i].least)
      return abbe_error_set(
          error, ABBE_GL, "%s has %d %s; Abbe needs %d: use --gl %s, or a newer driver",
          context->description, there, limits[i].what, limits[i].least, other_name(backend));
  }
  return ABBE_OK;
}

abbe_result abbe_context_make(abbe_context_backend backend, abbe_context **out, abbe_error *error) {
  ABBE_REQUIRE(out, error);
  *out = NULL;
  if ((int)backend < 0 || backend >= ABBE_CONTEXT_BACKEND_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no GL back end %d", (int)backend);
  abbe_context *context = calloc(1, sizeof *context);
  if (context == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a GL context");
  abbe_result result = backend == ABBE_CONTEXT_EGL ? abbe_context_egl(&context->native, error)
                                                   : abbe_context_osmesa(&context->native, error);
  if (result == ABBE_OK) result = abbe_gl_load(context->native.lookup, &context->gl, error);
  if (result == ABBE_OK) result = check_version(context, backend, error);
  if (result == ABBE_OK) result = check_limits(context, backend, error);
  if (result != ABBE_OK) {
    abbe_context_free(context);
    return result;
  }
  context->gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  context->gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  *out = context;
  return ABBE_OK;
}

void abbe_context_free(abbe_context *context) {
  if (context == NULL) return;
  if (context->native.destroy != NULL) context->native.destroy(&context->native);
  free(context);
}

const abbe_gl *abbe_context_gl(const abbe_context *context) {
  return &context->gl;
}
const char *abbe_context_description(const abbe_context *context) {
  return context->description;
}
