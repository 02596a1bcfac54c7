/* The camera's programs, compiled beside the light's passes. Mesa's llvmpipe compiles a program
 * when it first runs, on the thread that runs it, and keeps it in the cache that all contexts
 * share. So a second renderer, in a context and on a thread of its own, draws a small picture of
 * the same scene without its caustics, and the first finds the programs when it comes to its own
 * picture. */
#include "gl/renderer_state.h"

#include <omp.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

struct abbe_renderer_ahead {
  pthread_t thread;
  abbe_renderer_draw_ahead *draw;
  const abbe_scene *scene;
  abbe_render_desc desc;
  atomic_bool stop, done;
};

static bool goes_on(void *user, double done) {
  abbe_renderer_ahead *ahead = user;
  (void)done;
  return !atomic_load(&ahead->stop);
}

static void *work(void *user) {
  abbe_renderer_ahead *ahead = user;
  ahead->draw(ahead->scene, &ahead->desc);
  atomic_store(&ahead->done, true);
  return NULL;
}

static bool is_power_of_two(size_t n) {
  return (n & (n - 1)) == 0;
}

/* An eighth, and a power of two where n is one: llvmpipe compiles for that. */
static size_t small_side(size_t n) {
  const size_t side = n / 8 > 16 ? n / 8 : 16;
  return is_power_of_two(side) == is_power_of_two(n) ? side : side + 1;
}

/* What the camera's passes read of others is there without photons. */
static bool serves(const abbe_renderer *r) {
  const abbe_plan *p = &r->plan;
  return r->ahead == NULL && r->gpu.software && omp_get_num_procs() > 1 && p->caustics &&
         !p->hazy && p->shaft_count == 0 && !abbe_renderer_has_method(r);
}

void abbe_renderer_thread_ahead(abbe_renderer *r, const abbe_scene *scene,
                                abbe_renderer_draw_ahead *draw) {
  abbe_renderer_ahead *ahead = serves(r) ? calloc(1, sizeof *ahead) : NULL;
  if (ahead == NULL) return;
  ahead->draw = draw;
  ahead->scene = scene;
  ahead->desc = r->plan.desc;
  ahead->desc.camera_alone = true;
  ahead->desc.camera_tiles = r->atlas.used;
  ahead->desc.compiles_beside = false;
  ahead->desc.compiling = NULL;
  ahead->desc.progress = goes_on;
  ahead->desc.progress_user = ahead;
  ahead->desc.width = small_side(r->plan.desc.width);
  ahead->desc.height = small_side(r->plan.desc.height);
  ahead->desc.map_size = small_side(r->plan.desc.map_size);
  if (pthread_create(&ahead->thread, NULL, work, ahead) == 0)
    r->ahead = ahead;
  else
    free(ahead);
}

void abbe_renderer_await_ahead(abbe_renderer *r) {
  const struct timespec wait = {.tv_nsec = 2000000};
  if (r->ahead == NULL) return;
  while (!atomic_load(&r->ahead->done) && abbe_gpu_ask(&r->gpu)) nanosleep(&wait, NULL);
  abbe_renderer_end_ahead(r);
}

void abbe_renderer_end_ahead(abbe_renderer *r) {
  if (r->ahead == NULL) return;
  atomic_store(&r->ahead->stop, true);
  pthread_join(r->ahead->thread, NULL);
  free(r->ahead);
  r->ahead = NULL;
}
