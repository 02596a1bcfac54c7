/* context_backend.h: what a back end gives to context.c. Internal to gl/. */
#ifndef ABBE_GL_DEVICE_CONTEXT_BACKEND_H
#define ABBE_GL_DEVICE_CONTEXT_BACKEND_H

#include "gl/device/api.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_context_native {
  void *handle[4]; /* the back end's own */
  abbe_gl_lookup lookup;
  bool (*make_current)(struct abbe_context_native *native); /* on this thread */
  /* Leaves the thread's current context alone where that is another. */
  void (*destroy)(struct abbe_context_native *native);
} abbe_context_native;

/* ABBE_UNSUPPORTED where the library is not there. */
abbe_result abbe_context_osmesa(abbe_context_native *out, abbe_error *error);
/* The device of that number among EGL's of this kind, software or not; ABBE_UNSUPPORTED beyond the
 * last. */
abbe_result abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                             abbe_error *error);

#endif
