/* context.h: an off-screen OpenGL 4.5 core context, by OSMesa or by EGL.
 *
 * One context a thread at a time; making one makes it current. Nothing is drawn to a window:
 * every pass renders to textures. OSMesa draws on the CPU; EGL without a surface drives a GPU
 * where there is one.
 */
#ifndef ABBE_GL_DEVICE_CONTEXT_H
#define ABBE_GL_DEVICE_CONTEXT_H

#include "base/error.h"
#include "gl/device/api.h"

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
 * ABBE_UNSUPPORTED for EGL in a build without its headers. */
abbe_result abbe_context_make(abbe_context_backend backend, abbe_context **out, abbe_error *error);
void abbe_context_free(abbe_context *context);

const abbe_gl *abbe_context_gl(const abbe_context *context);
/* "osmesa: llvmpipe (LLVM 15…), OpenGL 4.5 …"; owned by the context. */
const char *abbe_context_description(const abbe_context *context);
const char *abbe_context_backend_name(abbe_context_backend backend);

#ifdef __cplusplus
}
#endif
#endif
