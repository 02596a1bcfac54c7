/* lost_context.c: put before a program by LD_PRELOAD, loses its contexts: as soon as the file that
 * ABBE_LOST names is there, no EGL context that was current before is made current again, as a
 * driver does after a reset. Contexts made from then on are good. It says on stderr that it did. */
#define _GNU_SOURCE

#include <EGL/egl.h>
#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST = 64 };
static EGLContext seen[MOST], lost[MOST];
static int seen_count, lost_count;
static bool happened;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static bool is_in(const EGLContext *list, int count, EGLContext context) {
  for (int i = 0; i < count; i++)
    if (list[i] == context) return true;
  return false;
}

/* Whether this one is lost; every one is noted. */
static bool loses(EGLContext context) {
  const char *file = getenv("ABBE_LOST");
  if (!happened && file != NULL && access(file, F_OK) == 0) {
    happened = true;
    for (int i = 0; i < seen_count; i++) lost[lost_count++] = seen[i];
  }
  if (is_in(lost, lost_count, context)) {
    fputs("lost_context: a context is lost\n", stderr);
    return true;
  }
  if (!is_in(seen, seen_count, context) && seen_count < MOST) seen[seen_count++] = context;
  return false;
}

/* The function that this library stands before; ISO C has no cast for it. */
static void find(const char *name, void *function, size_t size) {
  void *found = dlsym(RTLD_NEXT, name);
  memcpy(function, &found, size);
}

/* An address may be given to a new context. */
EGLBoolean eglDestroyContext(EGLDisplay display, EGLContext context) {
  EGLBoolean (*real)(EGLDisplay, EGLContext) = NULL;
  find("eglDestroyContext", &real, sizeof real);
  pthread_mutex_lock(&lock);
  for (int i = 0; i < lost_count; i++)
    if (lost[i] == context) lost[i] = EGL_NO_CONTEXT;
  pthread_mutex_unlock(&lock);
  return real(display, context);
}

EGLBoolean eglMakeCurrent(EGLDisplay display, EGLSurface draw, EGLSurface read,
                          EGLContext context) {
  EGLBoolean (*real)(EGLDisplay, EGLSurface, EGLSurface, EGLContext) = NULL;
  find("eglMakeCurrent", &real, sizeof real);
  pthread_mutex_lock(&lock);
  const bool is_lost = context != EGL_NO_CONTEXT && loses(context);
  pthread_mutex_unlock(&lock);
  return is_lost ? EGL_FALSE : real(display, draw, read, context);
}
