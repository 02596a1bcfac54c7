/* context.h: an OpenGL 4.5 context: one of Abbe's own off screen, by OSMesa or by EGL, or one that
 * the caller owns.
 *
 * A process may have many. OpenGL knows one current context a thread, and a context is current on
 * one thread at a time: what draws makes its own current first (abbe_context_make_current) and
 * leaves it so. Nothing is drawn to a window: every pass renders to textures. OSMesa draws on the
 * CPU; EGL without a surface drives a GPU where there is one.
 */
#ifndef ABBE_GL_DEVICE_CONTEXT_H
#define ABBE_GL_DEVICE_CONTEXT_H

#include "base/error.h"
#include "gl/device/api.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* X(code, name on the command line) */
#define ABBE_CONTEXT_BACKENDS(X) X(OSMESA, "osmesa") X(EGL, "egl")

/* Zero is OSMesa, which every machine has. */
typedef enum abbe_context_backend {
#define ABBE_CONTEXT_ENUM(code, name) ABBE_CONTEXT_##code,
  ABBE_CONTEXT_BACKENDS(ABBE_CONTEXT_ENUM)
#undef ABBE_CONTEXT_ENUM
      ABBE_CONTEXT_BACKEND_COUNT
} abbe_context_backend;

typedef struct abbe_context abbe_context;

/* Makes a context and makes it current. ABBE_GL says what is missing and what to do;
 * ABBE_UNSUPPORTED for EGL in a build without its headers. EGL's display stays open until the
 * process ends: contexts of others may live on it. */
abbe_result abbe_context_make(abbe_context_backend backend, abbe_context **out, abbe_error *error);

/* A context of the caller's. */
typedef struct abbe_context_host {
  /* The address of an OpenGL function by its name, "glFinish", or NULL: what glfwGetProcAddress,
   * SDL_GL_GetProcAddress or eglGetProcAddress say while the context is current. */
  abbe_gl_lookup lookup;
  /* Makes the context current on the calling thread; false where it cannot. It may be NULL: then
   * the caller has it current at every call that takes the context or something made with it. */
  bool (*make_current)(void *user);
  void *user;
} abbe_context_host;

/* Takes a context that the caller owns, OpenGL 4.5 or later of the core profile, which outlives
 * *out; makes it current first. It is checked as Abbe's own are: ABBE_GL names the version,
 * function or limit that is missing. ABBE_INVALID_ARGUMENT without a lookup. */
abbe_result abbe_context_adopt(const abbe_context_host *host, abbe_context **out,
                               abbe_error *error);

/* Of an adopted context nothing is destroyed or unbound. An own one is destroyed, and none is
 * current then if it was; another that is current stays so. */
void abbe_context_free(abbe_context *context);

/* Makes the context current on this thread, where it is not. ABBE_GL where it cannot be, as when it
 * is current on another thread. */
abbe_result abbe_context_make_current(abbe_context *context, abbe_error *error);

const abbe_gl *abbe_context_gl(const abbe_context *context);
/* "osmesa: llvmpipe (LLVM 15…), OpenGL 4.5 …", also "egl: …" and "adopted: …"; owned by the
 * context. */
const char *abbe_context_description(const abbe_context *context);
const char *abbe_context_backend_name(abbe_context_backend backend);

#ifdef __cplusplus
}
#endif
#endif
