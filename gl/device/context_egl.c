#include "gl/device/context_backend.h"

#ifdef ABBE_HAVE_EGL

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <string.h>

static bool has(const char *extensions, const char *name) {
  return extensions != NULL && strstr(extensions, name) != NULL;
}

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

/* EGL's device of that number among the software ones or the others; NULL beyond the last. *name is
 * for messages: the file of a device that has one. */
static EGLDeviceEXT find_device(bool software, size_t number, const char **name) {
  PFNEGLQUERYDEVICESEXTPROC query =
      (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
  PFNEGLQUERYDEVICESTRINGEXTPROC describe =
      (PFNEGLQUERYDEVICESTRINGEXTPROC)eglGetProcAddress("eglQueryDeviceStringEXT");
  enum { MOST = 64 };
  EGLDeviceEXT devices[MOST];
  EGLint count = 0;
  if (query == NULL || describe == NULL || !query(MOST, devices, &count)) return NULL;
  for (EGLint i = 0; i < count; i++) {
    const char *extensions = describe(devices[i], EGL_EXTENSIONS);
    if (has(extensions, "EGL_MESA_device_software") != software || number-- > 0) continue;
    if (has(extensions, "EGL_EXT_device_drm"))
      *name = describe(devices[i], EGL_DRM_DEVICE_FILE_EXT);
    if (*name == NULL) *name = software ? "software" : "a GPU without a name";
    return devices[i];
  }
  return NULL;
}

static EGLDisplay open_display(EGLDeviceEXT device) {
  PFNEGLGETPLATFORMDISPLAYEXTPROC platform =
      (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
  if (platform == NULL) return EGL_NO_DISPLAY;
  EGLDisplay display = platform(EGL_PLATFORM_DEVICE_EXT, device, NULL);
  const bool opened = display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL);
  return opened ? display : EGL_NO_DISPLAY;
}

/* A context of 4.5 that reports a lost device instead of ending the process, else one that does
 * not, else whatever the driver offers, which lacks what its version shows. */
static EGLContext create(EGLDisplay display, EGLConfig config) {
  static const EGLint attributes[] = {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                      EGL_LOSE_CONTEXT_ON_RESET,
                                      EGL_CONTEXT_MAJOR_VERSION,
                                      4,
                                      EGL_CONTEXT_MINOR_VERSION,
                                      5,
                                      EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                      EGL_NONE};
  static const EGLint skipped[] = {0, 2, 8}; /* attributes left out */
  EGLContext context = EGL_NO_CONTEXT;
  for (size_t i = 0; i < 3 && context == EGL_NO_CONTEXT; i++)
    context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes + skipped[i]);
  return context;
}

abbe_result abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                             abbe_error *error) {
  static const EGLint wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                  EGL_NONE};
  const char *name = NULL;
  out->handle[0] = EGL_NO_DISPLAY;
  out->lookup = (abbe_gl_lookup)eglGetProcAddress;
  out->make_current = make_current;
  out->destroy = destroy;
  const EGLDeviceEXT found = find_device(software, device, &name);
  if (found == NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "EGL has no %s device",
                          software ? "software" : "other");
  EGLDisplay display = open_display(found);
  if (display == EGL_NO_DISPLAY)
    return abbe_error_set(error, ABBE_GL, "EGL's device (%s) does not open (EGL error 0x%x)", name,
                          (unsigned)eglGetError());
  out->handle[0] = display;
  EGLConfig config = NULL;
  EGLContext context = EGL_NO_CONTEXT;
  EGLint configs = 0;
  const EGLenum api = eglQueryAPI();
  eglBindAPI(EGL_OPENGL_API);
  if (eglChooseConfig(display, wanted, &config, 1, &configs) && configs > 0)
    context = create(display, config);
  eglBindAPI(api);
  const char *driver = eglQueryString(display, EGL_VENDOR);
  if (driver == NULL) driver = "unnamed";
  if (context == EGL_NO_CONTEXT)
    return abbe_error_set(error, ABBE_GL, "EGL's device (%s, driver %s) gives no OpenGL context",
                          name, driver);
  out->handle[1] = context;
  if (!make_current(out))
    return abbe_error_set(error, ABBE_GL,
                          "the context of EGL's device (%s, driver %s) cannot be made current "
                          "without a surface",
                          name, driver);
  return ABBE_OK;
}

#else

abbe_result abbe_context_egl(bool software, size_t device, abbe_context_native *out,
                             abbe_error *error) {
  (void)software, (void)device, (void)out;
  return abbe_error_set(error, ABBE_UNSUPPORTED, "this build has no EGL");
}

#endif
