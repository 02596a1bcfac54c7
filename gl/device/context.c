#include "gl/device/context.h"

#include "gl/device/bindings.h"
#include "gl/device/context_backend.h"

#include <stdio.h>
#include <stdlib.h>

struct abbe_context {
  abbe_context_native native; /* of an own one; zero of an adopted one */
  abbe_context_host host;     /* of an adopted one */
  const char *name, *remedy;
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

static const char *const remedies[] = {
    [ABBE_CONTEXT_CPU] = "use a newer Mesa, or --backend gpu",
    [ABBE_CONTEXT_GPU] = "use a newer driver, or --backend cpu",
};
static const char adopted_remedy[] = "have a context of 4.5 or later current when it is adopted";

/* A name that a driver does not tell. */
static const char *told(const GLubyte *text) {
  return text != NULL ? (const char *)text : "unnamed";
}

static abbe_result check_version(abbe_context *context, abbe_error *error) {
  GLint major = 0, minor = 0;
  context->gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  context->gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  snprintf(context->description, sizeof context->description, "%s: %s, OpenGL %s", context->name,
           told(context->gl.GetString(GL_RENDERER)), told(context->gl.GetString(GL_VERSION)));
  if (major * 10 + minor >= 45) return ABBE_OK;
  return abbe_error_set(error, ABBE_GL, "%s offers OpenGL %d.%d; Abbe needs 4.5: %s", context->name,
                        major, minor, context->remedy);
}

/* What the passes take for granted beyond, or as much as, OpenGL 4.5 promises. */
static abbe_result check_limits(const abbe_context *context, abbe_error *error) {
  static const struct {
    GLenum limit;
    GLint least;
    const char *what;
  } limits[] = {
      {GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, 16, "storage buffers in a compute shader"},
      {GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, BINDING_COUNT, "places for storage buffers"},
      {GL_MAX_UNIFORM_BUFFER_BINDINGS, BINDING_COUNT, "places for uniform buffers"},
      {GL_MAX_UNIFORM_BLOCK_SIZE, 1 << 16, "bytes in a uniform buffer"},
      {GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, 512, "invocations in a compute group"},
      {GL_MAX_COLOR_ATTACHMENTS, 8, "colour attachments"},
      {GL_MAX_TEXTURE_SIZE, 4096, "texels a side of a texture"},
  };
  for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
    GLint there = 0;
    context->gl.GetIntegerv(limits[i].limit, &there);
    if (there < limits[i].least)
      return abbe_error_set(error, ABBE_GL, "%s has %d %s; Abbe needs %d: %s", context->description,
                            there, limits[i].what, limits[i].least, context->remedy);
  }
  return ABBE_OK;
}

/* Loads and checks the context, which is current where the result says so; *out is it, or nothing.
 */
static abbe_result finish(abbe_context *context, abbe_gl_lookup lookup, abbe_result result,
                          abbe_context **out, abbe_error *error) {
  if (result == ABBE_OK) result = abbe_gl_load(lookup, &context->gl, error);
  if (result == ABBE_OK) result = check_version(context, error);
  if (result == ABBE_OK) result = check_limits(context, error);
  if (result == ABBE_OK)
    *out = context;
  else
    abbe_context_free(context);
  return result;
}

/* One context of CPU or GPU: EGL's device of that number, or OSMesa's. */
static abbe_result make_one(abbe_context_backend kind, bool osmesa, size_t device,
                            abbe_context **out, abbe_error *error) {
  abbe_context *context = calloc(1, sizeof *context);
  if (context == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a GL context");
  context->name = names[kind];
  context->remedy = remedies[kind];
  const abbe_result result =
      osmesa ? abbe_context_osmesa(&context->native, error)
             : abbe_context_egl(kind == ABBE_CONTEXT_CPU, device, &context->native, error);
  return finish(context, context->native.lookup, result, out, error);
}

/* EGL's devices in turn, then OSMesa for the CPU; the error is of the last that is there. */
static abbe_result make_of_kind(abbe_context_backend kind, abbe_context **out, abbe_error *error) {
  abbe_error last = {0};
  abbe_result result = ABBE_UNSUPPORTED;
  bool osmesa = false, more = true;
  for (size_t device = 0; more; device++) {
    const abbe_result one = make_one(kind, osmesa, device, out, &last);
    if (one == ABBE_OK) return ABBE_OK;
    if (one != ABBE_UNSUPPORTED) {
      result = one;
      if (error != NULL) *error = last;
    }
    more = !osmesa && (one != ABBE_UNSUPPORTED || kind == ABBE_CONTEXT_CPU);
    osmesa = one == ABBE_UNSUPPORTED;
  }
  if (result != ABBE_UNSUPPORTED) return result;
  if (kind == ABBE_CONTEXT_GPU)
    return abbe_error_set(error, ABBE_GL,
                          "there is no GPU with an EGL driver; install its driver, or use "
                          "--backend cpu");
  return abbe_error_set(error, ABBE_GL,
                        "there is no OpenGL for the CPU: neither EGL's software device nor OSMesa "
                        "is found; install Mesa's EGL (Debian's libegl-mesa0), or use --backend "
                        "gpu");
}

abbe_result abbe_context_make(abbe_context_backend backend, abbe_context **out, abbe_error *error) {
  ABBE_REQUIRE(out, error);
  *out = NULL;
  if ((int)backend < 0 || backend >= ABBE_CONTEXT_BACKEND_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no GL back end %d", (int)backend);
  if (backend == ABBE_CONTEXT_AUTO && make_of_kind(ABBE_CONTEXT_GPU, out, NULL) == ABBE_OK)
    return ABBE_OK;
  return make_of_kind(backend == ABBE_CONTEXT_AUTO ? ABBE_CONTEXT_CPU : backend, out, error);
}

abbe_result abbe_context_adopt(const abbe_context_host *host, abbe_context **out,
                               abbe_error *error) {
  ABBE_REQUIRE(host && out, error);
  *out = NULL;
  if (host->lookup == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a context is adopted with a lookup of its functions; it has none");
  abbe_context *context = calloc(1, sizeof *context);
  if (context == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a GL context");
  context->host = *host;
  context->name = "adopted";
  context->remedy = adopted_remedy;
  const abbe_result result = abbe_context_make_current(context, error);
  return finish(context, host->lookup, result, out, error);
}

void abbe_context_free(abbe_context *context) {
  if (context == NULL) return;
  if (context->native.destroy != NULL) context->native.destroy(&context->native);
  free(context);
}

abbe_result abbe_context_make_current(abbe_context *context, abbe_error *error) {
  ABBE_REQUIRE(context, error);
  bool current = true;
  if (context->native.make_current != NULL)
    current = context->native.make_current(&context->native);
  else if (context->host.make_current != NULL)
    current = context->host.make_current(context->host.user);
  if (current) return ABBE_OK;
  return abbe_error_set(error, ABBE_GL,
                        "the context '%s' cannot be made current; is it current on another thread?",
                        context->description[0] != '\0' ? context->description : context->name);
}

const abbe_gl *abbe_context_gl(const abbe_context *context) {
  return &context->gl;
}
const char *abbe_context_description(const abbe_context *context) {
  return context->description;
}
