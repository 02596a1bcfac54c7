#include "cli/view/picture/view_painter.h"

#include "base/thread/watch.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

struct abbe_view_painter {
  pthread_t thread;
  pthread_mutex_t lock;
  pthread_cond_t signal;
  void (*wake)(void);
  atomic_bool stops;
  bool quits, given, done;
  abbe_view_painting painting;
  unsigned char *pixels;
  abbe_result result;
  abbe_error error;
};

static bool is_wanted(void *user) {
  const abbe_view_painter *p = user;
  return !atomic_load(&p->stops);
}

/* The painter's thread, which holds the lock. */
static void paint(abbe_view_painter *p) {
  const abbe_view_painting *g = &p->painting;
  abbe_error error = {0};
  unsigned char *pixels = NULL;
  pthread_mutex_unlock(&p->lock);
  const abbe_result result =
      abbe_view_show(g->pictures, g->shown, g->exposure, g->display, NULL, &pixels, &error);
  pthread_mutex_lock(&p->lock);
  p->pixels = pixels;
  p->result = result;
  p->error = error;
  p->done = true;
  pthread_cond_broadcast(&p->signal);
  if (p->wake != NULL && !atomic_load(&p->stops)) p->wake();
}

static void *run(void *user) {
  abbe_view_painter *p = user;
  abbe_watch watch = {.goes_on = is_wanted, .user = p};
  pthread_mutex_lock(&p->lock);
  while (!p->quits) {
    if (!p->given || p->done) {
      pthread_cond_wait(&p->signal, &p->lock);
      continue;
    }
    watch.over = false;
    abbe_watch_set(&watch);
    paint(p);
  }
  pthread_mutex_unlock(&p->lock);
  return NULL;
}

abbe_result abbe_view_painter_make(void (*wake)(void), abbe_view_painter **out, abbe_error *error) {
  abbe_view_painter *p = calloc(1, sizeof *p);
  *out = NULL;
  if (p == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the viewer");
  p->wake = wake;
  pthread_mutex_init(&p->lock, NULL);
  pthread_cond_init(&p->signal, NULL);
  if (pthread_create(&p->thread, NULL, run, p) == 0) {
    *out = p;
    return ABBE_OK;
  }
  pthread_cond_destroy(&p->signal);
  pthread_mutex_destroy(&p->lock);
  free(p);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no thread for the viewer's screen");
}

void abbe_view_painter_free(abbe_view_painter *p) {
  if (p == NULL) return;
  abbe_view_painter_stop(p);
  pthread_mutex_lock(&p->lock);
  p->quits = true;
  pthread_cond_broadcast(&p->signal);
  pthread_mutex_unlock(&p->lock);
  pthread_join(p->thread, NULL);
  pthread_cond_destroy(&p->signal);
  pthread_mutex_destroy(&p->lock);
  free(p);
}

void abbe_view_painter_give(abbe_view_painter *p, const abbe_view_painting *painting) {
  pthread_mutex_lock(&p->lock);
  p->painting = *painting;
  p->given = true;
  p->done = false;
  atomic_store(&p->stops, false);
  pthread_cond_broadcast(&p->signal);
  pthread_mutex_unlock(&p->lock);
}

/* The one who gives and takes alone changes that. */
const abbe_view_painting *abbe_view_painter_has(const abbe_view_painter *p) {
  return p->given ? &p->painting : NULL;
}

void abbe_view_painter_stop(abbe_view_painter *p) {
  if (p == NULL || !p->given) return;
  atomic_store(&p->stops, true);
  pthread_mutex_lock(&p->lock);
  while (!p->done) pthread_cond_wait(&p->signal, &p->lock);
  free(p->pixels);
  p->pixels = NULL;
  p->given = p->done = false;
  pthread_mutex_unlock(&p->lock);
}

bool abbe_view_painter_take(abbe_view_painter *p, unsigned char **pixels, abbe_result *result,
                            abbe_error *error) {
  pthread_mutex_lock(&p->lock);
  const bool there = p->given && p->done;
  if (there) {
    *pixels = p->pixels;
    *result = p->result;
    if (error != NULL) *error = p->error;
    p->pixels = NULL;
    p->given = p->done = false;
  }
  pthread_mutex_unlock(&p->lock);
  return there;
}
