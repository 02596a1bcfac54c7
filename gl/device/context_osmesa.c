#include "gl/device/context_backend.h"

#include <GL/osmesa.h>
#include <stdlib.h>

/* Rendering goes to textures; OSMesa still wants a colour buffer of its own. */
enum { BUFFER_SIDE = 16 };

static abbe_gl_function lookup(const char *name) {
  return (abbe_gl_function)OSMesaGetProcAddress(name);
}

static bool is_current(const abbe_context_native *native) {
  return OSMesaGetCurrentContext() == (OSMesaContext)native->handle[0];
}

static bool make_current(abbe_context_native *native) {
  return is_current(native) ||
         OSMesaMakeCurrent((OSMesaContext)native->handle[0], native->handle[1], GL_UNSIGNED_BYTE,
                           BUFFER_SIDE, BUFFER_SIDE);
}

static void destroy(abbe_context_native *native) {
  if (native->handle[0] != NULL) {
    if (is_current(native)) OSMesaMakeCurrent(NULL, NULL, GL_UNSIGNED_BYTE, 0, 0);
    OSMesaDestroyContext((OSMesaContext)native->handle[0]);
  }
  free(native->handle[1]);
}

abbe_result abbe_context_osmesa(abbe_context_native *out, abbe_error *error) {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0,
                            0};
  out->lookup = lookup;
  out->make_current = make_current;
  out->destroy = destroy;
  out->handle[1] = malloc(BUFFER_SIDE * BUFFER_SIDE * 4);
  if (out->handle[1] == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for OSMesa");
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, NULL);
  if (context == NULL)
    return abbe_error_set(error, ABBE_GL,
                          "OSMesa gives no OpenGL 4.5 core context; use Mesa 22 "
                          "or try --gl egl");
  out->handle[0] = context;
  if (!make_current(out))
    return abbe_error_set(error, ABBE_GL, "OSMesa's context cannot be made current; try --gl egl");
  return ABBE_OK;
}
