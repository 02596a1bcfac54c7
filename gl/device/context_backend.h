/* context_backend.h: what a back end gives to context.c. Internal to gl/. */
#ifndef ABBE_GL_DEVICE_CONTEXT_BACKEND_H
#define ABBE_GL_DEVICE_CONTEXT_BACKEND_H

#include "gl/device/api.h"

#include <stdbool.h>

typedef struct abbe_context_native {
  void *handle[4]; /* the back end's own */
  abbe_gl_lookup lookup;
  bool (*make_current)(struct abbe_context_native *native); /* on this thread */
  /* Leaves the thread's current context alone where that is another. */
  void (*destroy)(struct abbe_context_native *native);
} abbe_context_native;

abbe_result abbe_context_osmesa(abbe_context_native *out, abbe_error *error);
abbe_result abbe_context_egl(abbe_context_native *out, abbe_error *error);

#endif
