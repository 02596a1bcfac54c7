#include "gl/device/context.h"

#include "base/number.h"
#include "gl/device/bindings.h"
#include "gl/device/context_backend.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct abbe_context {
  abbe_context_native native; /* handles of Abbe's own context; zero of an adopted one */
  abbe_context_host host;     /* host of an adopted one */
  const char *name;
  abbe_gl gl;
  char description[256];
  abbe_error refused_gpu; /* zero: there is none */
};

static const char *const names[] = {
#define ABBE_CONTEXT_NAME(code, name) name,
    ABBE_CONTEXT_BACKENDS(ABBE_CONTEXT_NAME)
#undef ABBE_CONTEXT_NAME
};

static const char *const remedies[] = {
    [ABBE_CONTEXT_AUTO] = "--backend cpu needs Mesa's llvmpipe, 20.3 or later (Debian's "
                          "libegl-mesa0; GALLIUM_DRIVER unset)",
    [ABBE_CONTEXT_CPU] = "--backend cpu needs Mesa's llvmpipe, 20.3 or later (Debian's "
                         "libegl-mesa0; GALLIUM_DRIVER unset)",
    [ABBE_CONTEXT_GPU] = "install its newest driver, or use --backend cpu",
};

/* Takes down what the driver says of itself; a context so bare that it cannot is not judged here.
 */
static abbe_result check_version(abbe_context *context, abbe_error *error) {
  GLint major = 0, minor = 0;
  const char *driver = NULL, *version = NULL;
  const abbe_gl *gl = &context->gl;
  if (gl->GetString != NULL) {
    driver = (const char *)gl->GetString(GL_RENDERER);
    version = (const char *)gl->GetString(GL_VERSION);
  }
  if (driver == NULL) driver = "unnamed";
  snprintf(context->description, sizeof context->description, "%s: %s, OpenGL %s", context->name,
           driver, version != NULL ? version : "unnamed");
  context->gl.description = context->description;
  if (gl->GetIntegerv == NULL) return ABBE_OK;
  gl->GetIntegerv(GL_MAJOR_VERSION, &major);
  gl->GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major == 0 && version != NULL) sscanf(version, "%d.%d", &major, &minor); /* before 3.0 */
  if (major * 10 + minor >= 45) return ABBE_OK;
  return abbe_error_set(error, ABBE_GL, "%s: %s offers OpenGL %d.%d; Abbe needs 4.5", context->name,
                        driver, major, minor);
}

/* What the passes take for granted beyond, or as much as, OpenGL 4.5 promises. */
static abbe_result check_limits(const abbe_context *context, abbe_error *error) {
  static const struct {
    GLenum limit;
    GLint least;
    const char *what;
  } limits[] = {
      {GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, 8, "storage buffers in a compute shader"},
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
      return abbe_error_set(error, ABBE_GL, "%s has %d %s; Abbe needs %d", context->description,
                            there, limits[i].what, limits[i].least);
  }
  return ABBE_OK;
}

static abbe_result check(abbe_context *context, abbe_gl_lookup lookup, abbe_error *error) {
  abbe_error missing = {0};
  const abbe_result loaded = abbe_gl_load(lookup, &context->gl, &missing);
  ABBE_TRY(check_version(context, error));
  if (loaded == ABBE_OK) return check_limits(context, error);
  return abbe_error_set(error, loaded, "%s: %s", context->description, missing.text);
}

/* Checks the context, which is current where the result says so; *out is it, or nothing. */
static abbe_result finish(abbe_context *context, abbe_gl_lookup lookup, abbe_result result,
                          abbe_context **out, abbe_error *error) {
  if (result == ABBE_OK) result = check(context, lookup, error);
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
  const abbe_result result =
      osmesa ? abbe_context_osmesa(&context->native, error)
             : abbe_context_egl(kind == ABBE_CONTEXT_CPU, device, &context->native, error);
  return finish(context, context->native.lookup, result, out, error);
}

/* Which of EGL's GPUs is tried first, by the environment. */
static abbe_result first_gpu(size_t *out, abbe_error *error) {
  const char *text = getenv("ABBE_GPU"), *end;
  double number = 0;
  if (text != NULL && (!abbe_number_read(text, &end, &number) || *end != '\0' || number < 0 ||
                       number > 63 || number != floor(number)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "ABBE_GPU is '%.40s'; it is the number of a GPU, from 0 to 63", text);
  *out = (size_t)number;
  return ABBE_OK;
}

/* EGL's devices in turn, then OSMesa for the CPU; the error is of the last that is there, without
 * what to do, and ABBE_UNSUPPORTED where none is. */
static abbe_result make_of_kind(abbe_context_backend kind, abbe_context **out, abbe_error *error) {
  abbe_error last = {0};
  abbe_result result =
      abbe_error_set(error, ABBE_UNSUPPORTED,
                     kind == ABBE_CONTEXT_GPU ? "there is no GPU with an EGL driver"
                                              : "there is no OpenGL for the CPU, neither EGL's "
                                                "software device nor OSMesa");
  size_t device = 0;
  if (kind == ABBE_CONTEXT_GPU) ABBE_TRY(first_gpu(&device, error));
  bool osmesa = false;
  for (bool more = true; more; device++) {
    const abbe_result one = make_one(kind, osmesa, device, out, &last);
    if (one == ABBE_OK) return ABBE_OK;
    if (one != ABBE_UNSUPPORTED) {
      result = one;
      *error = last;
    }
    more = !osmesa && (one != ABBE_UNSUPPORTED || kind == ABBE_CONTEXT_CPU);
    osmesa = one == ABBE_UNSUPPORTED;
  }
  return result;
}

abbe_result abbe_context_make(abbe_context_backend backend, abbe_context **out, abbe_error *error) {
  *out = NULL;
  if ((int)backend < 0 || backend >= ABBE_CONTEXT_BACKEND_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no GL back end %d", (int)backend);
  abbe_error gpu = {0}, cpu = {0};
  abbe_result result = ABBE_UNSUPPORTED;
  if (backend != ABBE_CONTEXT_CPU) result = make_of_kind(ABBE_CONTEXT_GPU, out, &gpu);
  const bool tell_gpu = backend == ABBE_CONTEXT_GPU || result != ABBE_UNSUPPORTED;
  if (result != ABBE_OK && backend != ABBE_CONTEXT_GPU)
    result = make_of_kind(ABBE_CONTEXT_CPU, out, &cpu);
  if (result == ABBE_OK) {
    if (tell_gpu) (*out)->refused_gpu = gpu;
    return ABBE_OK;
  }
  return abbe_error_set(error, result == ABBE_UNSUPPORTED ? ABBE_GL : result, "%s%s%s; %s",
                        tell_gpu ? gpu.text : "", tell_gpu && cpu.text[0] != '\0' ? "; " : "",
                        cpu.text, remedies[backend]);
}

abbe_result abbe_context_adopt(const abbe_context_host *host, abbe_context **out,
                               abbe_error *error) {
  *out = NULL;
  if (host->lookup == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a context is adopted with a lookup of its functions; it has none");
  abbe_context *context = calloc(1, sizeof *context);
  if (context == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a GL context");
  context->host = *host;
  context->name = "adopted";
  abbe_error cause = {0};
  abbe_result result = abbe_context_make_current(context, error);
  if (result != ABBE_OK) return finish(context, NULL, result, out, error);
  result = finish(context, host->lookup, ABBE_OK, out, &cause);
  return result == ABBE_OK ? ABBE_OK
                           : abbe_error_set(error, result,
                                            "%s: have a context of 4.5 or later "
                                            "current when it is adopted",
                                            cause.text);
}

void abbe_context_free(abbe_context *context) {
  if (context == NULL) return;
  if (context->native.destroy != NULL) context->native.destroy(&context->native);
  free(context);
}

abbe_result abbe_context_make_current(abbe_context *context, abbe_error *error) {
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
const char *abbe_context_refused_gpu(const abbe_context *context) {
  return context->refused_gpu.text;
}
