#include "gl/device/context_backend.h"

#ifdef ABBE_HAVE_EGL

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <string.h>

/* Binds nothing, then the context: EGL passes over a bind of what it takes for current, which an
 * OSMesa context of the same Mesa may have replaced without EGL's knowledge. The thread's API is
 * the caller's. */
static bool bind(EGLDisplay display, EGLContext context) {
  const EGLenum api = eglQueryAPI();
  eglBindAPI(EGL_OPENGL_API);
  bool bound = eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (bound && context != EGL_NO_CONTEXT)
    bound = eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
  eglBindAPI(api);
  return bound;
}

static bool make_current(abbe_context_native *native) {
  return bind(native->handle[0], (EGLContext)native->handle[1]);
}

/* A display is the process's, and EGL does not count who opened it: to terminate it would end the
 * contexts that others have on it. It stays open. */
static void destroy(abbe_context_native *native) {
  EGLDisplay display = native->handle[0];
  if (display == EGL_NO_DISPLAY || native->handle[1] == NULL) return;
  if (eglGetCurrentContext() == (EGLContext)native->handle[1]) bind(display, EGL_NO_CONTEXT);
  eglDestroyContext(display, (EGLContext)native->handle[1]);
}

/* A device's own display first (a GPU without a window system), then Mesa's surfaceless one, then
 * whatever the default is; the first that initialises is taken. */
static EGLDisplay open_display(void) {
  PFNEGLQUERYDEVICESEXTPROC query =
      (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
  PFNEGLGETPLATFORMDISPLAYEXTPROC platform =
      (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (platform != NULL && query != NULL && query(16, devices, &count))
    for (EGLint i = 0; i < count; i++) {
      EGLDisplay display = platform(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
      if (display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL)) return display;
    }
  if (platform != NULL) {
    EGLDisplay display = platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL)) return display;
  }
  EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL)) return display;
  return EGL_NO_DISPLAY;
}

abbe_result abbe_context_egl(abbe_context_native *out, abbe_error *error) {
  out->handle[0] = EGL_NO_DISPLAY;
  out->lookup = (abbe_gl_lookup)eglGetProcAddress;
  out->make_current = make_current;
  out->destroy = destroy;
  EGLDisplay display = open_display();
  if (display == EGL_NO_DISPLAY)
    return abbe_error_set(error, ABBE_GL,
                          "EGL finds no display; install a GL driver with EGL or "
                          "use --gl osmesa");
  out->handle[0] = display;
  const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  EGLConfig config = NULL;
  EGLContext context = EGL_NO_CONTEXT;
  EGLint found = 0;
  const EGLenum api = eglQueryAPI();
  eglBindAPI(EGL_OPENGL_API);
  if (eglChooseConfig(display, wanted, &config, 1, &found) && found > 0)
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  eglBindAPI(api);
  if (found == 0)
    return abbe_error_set(error, ABBE_GL, "EGL has no configuration for OpenGL; use --gl osmesa");
  if (context == EGL_NO_CONTEXT)
    return abbe_error_set(error, ABBE_GL, "EGL gives no OpenGL 4.5 core context; use --gl osmesa");
  out->handle[1] = context;
  if (!make_current(out))
    return abbe_error_set(error, ABBE_GL,
                          "EGL's context cannot be made current without a "
                          "surface; use --gl osmesa");
  return ABBE_OK;
}

#else

abbe_result abbe_context_egl(abbe_context_native *out, abbe_error *error) {
  (void)out;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "this build has no EGL; install libegl-dev and build again, or use "
                        "--gl osmesa");
}

#endif
