#include "gl/device/context_backend.h"

#ifdef ABBE_HAVE_EGL

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <string.h>

static void destroy(abbe_context_native *native) {
  EGLDisplay display = native->handle[0];
  if (display == EGL_NO_DISPLAY) return;
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (native->handle[1] != NULL) eglDestroyContext(display, (EGLContext)native->handle[1]);
  eglTerminate(display);
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
  EGLint found = 0;
  eglBindAPI(EGL_OPENGL_API);
  if (!eglChooseConfig(display, wanted, &config, 1, &found) || found == 0)
    return abbe_error_set(error, ABBE_GL, "EGL has no configuration for OpenGL; use --gl osmesa");
  EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT)
    return abbe_error_set(error, ABBE_GL, "EGL gives no OpenGL 4.5 core context; use --gl osmesa");
  out->handle[1] = context;
  if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
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
