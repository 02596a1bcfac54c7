/* context.h: an OpenGL 4.5 context: one of Abbe's own off screen, on the CPU or on a GPU, or one
 * that the caller owns.
 *
 * A process may have many. OpenGL knows one current context a thread, and a context is current on
 * one thread at a time: what draws makes its own current first (abbe_context_make_current) and
 * leaves it so. Nothing is drawn to a window: every pass renders to textures. Abbe's own contexts
 * are EGL's without a surface: EGL lists its devices, of which one is Mesa's rasteriser on the CPU.
 * Where EGL has no such device, OSMesa is the CPU's.
 */
#ifndef ABBE_GL_DEVICE_CONTEXT_H
#define ABBE_GL_DEVICE_CONTEXT_H

#include "base/error.h"
#include "gl/device/api.h"

#include <stdbool.h>

/* X(code, name on the command line) */
#define ABBE_CONTEXT_BACKENDS(X) X(AUTO, "auto") X(CPU, "cpu") X(GPU, "gpu")

/* AUTO is the GPU where one gives a context that suffices, and else the CPU. */
typedef enum abbe_context_backend {
#define ABBE_CONTEXT_ENUM(code, name) ABBE_CONTEXT_##code,
  ABBE_CONTEXT_BACKENDS(ABBE_CONTEXT_ENUM)
#undef ABBE_CONTEXT_ENUM
      ABBE_CONTEXT_BACKEND_COUNT
} abbe_context_backend;

typedef struct abbe_context abbe_context;

/* Makes a context and makes it current. Every device of the kind that is asked for is tried in
 * EGL's order, GPUs from number ABBE_GPU of the environment on. ABBE_GL names the last driver that was tried, what it lacks and what to do. EGL's
 * display stays open until the process ends: contexts of others may live on it. */
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

/* Nothing of an adopted context is destroyed or unbound. An own one is destroyed, and none is
 * current then if it was; another that is current stays so. */
void abbe_context_free(abbe_context *context);

/* Makes the context current on this thread, where it is not. ABBE_GL where it cannot be, as when it
 * is current on another thread. */
abbe_result abbe_context_make_current(abbe_context *context, abbe_error *error);

const abbe_gl *abbe_context_gl(const abbe_context *context);
/* "cpu: llvmpipe (LLVM 15…), OpenGL 4.5 …", also "gpu: …" and "adopted: …"; owned by the
 * context. */
const char *abbe_context_description(const abbe_context *context);
/* Why AUTO took the CPU although a GPU is there: "EGL's device (…) …", without a full stop; ""
 * where there is no GPU or none was asked for. Owned by the context. */
const char *abbe_context_refused_gpu(const abbe_context *context);

#endif
