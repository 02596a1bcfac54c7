#include "gl/device/context_backend.h"

#ifdef ABBE_HAVE_OSMESA

#include <GL/osmesa.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Rendering goes to textures; OSMesa still wants a colour buffer of its own. */
enum { BUFFER_SIDE = 16 };

/* Loaded when a context is first wanted: with it comes LLVM, more than half of the time that a
 * command that draws nothing takes to start. It stays for the process. */
static struct {
  OSMesaContext (*create)(const int *attributes, OSMesaContext shared);
  void (*destroy)(OSMesaContext context);
  GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width,
                            GLsizei height);
  OSMesaContext (*current)(void);
  OSMESAproc (*lookup)(const char *name);
  bool loaded;
  const char *lacks; /* where it is not */
} mesa;

static pthread_mutex_t loading = PTHREAD_MUTEX_INITIALIZER;

static bool find(void *library, const char *name, void *function) {
  void *found = dlsym(library, name);
  if (found == NULL) mesa.lacks = name;
  memcpy(function, &found, sizeof found);
  return found != NULL;
}

static void load(void) {
  void *library = dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) library = dlopen("libOSMesa.so", RTLD_NOW | RTLD_LOCAL);
  mesa.lacks = "libOSMesa.so.8";
  mesa.loaded = library != NULL && find(library, "OSMesaCreateContextAttribs", &mesa.create) &&
                find(library, "OSMesaDestroyContext", &mesa.destroy) &&
                find(library, "OSMesaMakeCurrent", &mesa.make_current) &&
                find(library, "OSMesaGetCurrentContext", &mesa.current) &&
                find(library, "OSMesaGetProcAddress", &mesa.lookup);
  if (library != NULL && !mesa.loaded) dlclose(library);
}

static abbe_result need_mesa(abbe_error *error) {
  pthread_mutex_lock(&loading);
  if (!mesa.loaded) load();
  const bool loaded = mesa.loaded;
  pthread_mutex_unlock(&loading);
  if (loaded) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED, "%s is not found", mesa.lacks);
}

static abbe_gl_function lookup(const char *name) {
  return (abbe_gl_function)mesa.lookup(name);
}

static bool is_current(const abbe_context_native *native) {
  return mesa.current() == (OSMesaContext)native->handle[0];
}

static bool make_current(abbe_context_native *native) {
  return is_current(native) ||
         mesa.make_current((OSMesaContext)native->handle[0], native->handle[1], GL_UNSIGNED_BYTE,
                           BUFFER_SIDE, BUFFER_SIDE);
}

static void destroy(abbe_context_native *native) {
  if (native->handle[0] != NULL) {
    if (is_current(native)) mesa.make_current(NULL, NULL, GL_UNSIGNED_BYTE, 0, 0);
    mesa.destroy((OSMesaContext)native->handle[0]);
  }
  free(native->handle[1]);
}

abbe_result abbe_context_osmesa(abbe_context_native *out, abbe_error *error) {
  enum { ANY_VERSION = 6 }; /* the attributes from there on */
  const int attributes[] = {OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            OSMESA_FORMAT,
                            OSMESA_RGBA,
                            0,
                            0};
  ABBE_TRY(need_mesa(error));
  out->lookup = lookup;
  out->make_current = make_current;
  out->destroy = destroy;
  out->handle[1] = malloc(BUFFER_SIDE * BUFFER_SIDE * 4);
  if (out->handle[1] == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for OSMesa");
  /* Where there is no 4.5, whatever there is says by itself what it lacks. */
  OSMesaContext context = mesa.create(attributes, NULL);
  if (context == NULL) context = mesa.create(attributes + ANY_VERSION, NULL);
  if (context == NULL) return abbe_error_set(error, ABBE_GL, "OSMesa gives no OpenGL context");
  out->handle[0] = context;
  if (!make_current(out))
    return abbe_error_set(error, ABBE_GL, "OSMesa's context cannot be made current");
  return ABBE_OK;
}

#else

abbe_result abbe_context_osmesa(abbe_context_native *out, abbe_error *error) {
  (void)out;
  return abbe_error_set(error, ABBE_UNSUPPORTED, "this build has no OSMesa");
}

#endif
