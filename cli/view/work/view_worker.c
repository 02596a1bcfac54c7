#include "cli/view/work/view_worker.h"

#include "base/clock.h"
#include "base/thread/watch.h"
#include "cli/options/own_context.h"
#include "cli/view/picture/view_feed.h"
#include "cli/view/work/view_scene.h"
#include "gl/renderer.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

const abbe_preset_point *abbe_view_settings_point(const abbe_preset_front *front,
                                                  abbe_view_stage stage) {
  const abbe_preset_name name = stage <= ABBE_VIEW_MOVING     ? ABBE_PRESET_DRAFT
                                : stage == ABBE_VIEW_BALANCED ? ABBE_PRESET_BALANCED
                                                              : ABBE_PRESET_ACCURATE;
  const size_t at = front->count > 0 ? front->named[name] : 0;
  return at < front->count ? &front->point[at] : NULL;
}

static double diagonal(const double min[3], const double max[3]) {
  return hypot(hypot(max[0] - min[0], max[1] - min[1]), max[2] - min[2]);
}

/* A refractor in or beside a larger one has as many photons and texels as alone, up to these. */
static void look_closer(const abbe_scene *scene, abbe_render_desc *desc) {
  enum { PHOTONS = 256, TEXELS = 1024 };
  double least = INFINITY, min[3], max[3];
  if (scene == NULL || !abbe_scene_bounds(scene, true, false, min, max)) return;
  for (size_t i = 0; i < scene->object_count; i++)
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR && !scene->object[i].cloud)
      least = fmin(least, diagonal(scene->object[i].min, scene->object[i].max));
  const double times = fmax(diagonal(min, max) / least, 1);
  if (desc->photons < PHOTONS) desc->photons = (size_t)fmin(times * (double)desc->photons, PHOTONS);
  if (desc->map_size < TEXELS)
    desc->map_size = (size_t)fmin(times * (double)desc->map_size, TEXELS);
}

/* A stage's settings; where no sweep has measured such scenes, the plan's own and what is coarser
 * and finer than these. */
static abbe_render_desc of_stage(const abbe_preset_front *front, const abbe_scene *scene,
                                 abbe_view_stage stage) {
  const abbe_preset_point *point = abbe_view_settings_point(front, stage);
  abbe_render_desc desc = {0};
  if (point != NULL) {
    abbe_preset_apply(point, scene, &desc);
  } else if (stage <= ABBE_VIEW_MOVING) {
    desc = (abbe_render_desc){.wavelengths = 5, .photons = 64, .map_size = 256, .supersample = 1};
  } else if (stage >= ABBE_VIEW_ACCURATE) {
    desc = (abbe_render_desc){.wavelengths = 21, .photons = 512, .supersample = 2};
  }
  look_closer(scene, &desc);
  return desc;
}

abbe_render_desc abbe_view_settings_of(const abbe_preset_front *front, const abbe_scene *scene,
                                       const abbe_view_job *job, const abbe_view_document *document,
                                       const abbe_caustic_volume *volume) {
  static const double fewer[ABBE_VIEW_LIGHT_STEPS] = {1, 0.7, 0.5, 0.35};
  const bool moving = job->stage == ABBE_VIEW_MOVING;
  const bool light_moves = moving && job->light == ABBE_VIEW_MOVING;
  abbe_render_desc desc = of_stage(front, scene, job->light);
  desc.supersample = moving ? 1 : of_stage(front, scene, job->stage).supersample;
  desc.upsample = moving ? job->eye_step + 1 : 0;
  if (moving) desc.coarse = light_moves ? ABBE_COARSE_ALL : ABBE_COARSE_EYE;
  desc.adaptive = moving ? 1 : 0;
  /* light that moves is blended with the last frames'; what is better is of one frame */
  desc.volume = volume;
  desc.history = light_moves && volume == NULL ? ABBE_RENDER_MAX_HISTORY : 0;
  desc.history_of_changes = true; /* the first turn of a camera does not follow photons again */
  desc.aovs = true; /* in motion too: without them other programs would have to be compiled */
  if (light_moves && desc.photons > 0)
    desc.photons = (size_t)fmax(8, (double)desc.photons * fewer[job->light_step]);
  /* so that what keeps up with a hand does not wait for a slider */
  if (!light_moves) {
    if (document->wavelengths > 0) desc.wavelengths = document->wavelengths;
    if (document->photons > 0) desc.photons = document->photons;
    if (document->map_size > 0) desc.map_size = document->map_size;
  }
  return desc;
}

struct abbe_view_worker {
  pthread_t thread;
  pthread_mutex_t lock;
  pthread_cond_t signal;
  void (*wake)(void);
  volatile int stop, quit;
  volatile float share;              /* done of what it draws */
  const abbe_caustic_volume *volume; /* or NULL */
  bool busy, done;
  abbe_view_request request;
  abbe_view_result result;
  abbe_view_result made; /* in the making */
  /* the thread's own */
  abbe_context *context;
  abbe_renderer *renderer;
  abbe_tracer *tracer;
  uint64_t traced; /* the serial that the tracer is of */
  abbe_presets presets;
  abbe_preset_front front;
  bool fronted;
  abbe_view_scene scene;
  abbe_scene *drawn; /* the renderer looks at what it has drawn until it has the other */
  size_t edition;    /* that the scene is read from */
  bool lost;         /* the renderer has given up what it had, and nothing has come of it */
};

void abbe_view_result_free(abbe_view_result *result) {
  abbe_image_free(&result->picture);
  abbe_image_free(&result->traced);
  abbe_view_scene_news_free(&result->news);
  free(result->line);
  free(result->feed);
  abbe_image_free(&result->map);
  abbe_error_bars_free(&result->bars);
  *result = (abbe_view_result){0};
}

static const double spot_s = 4; /* for a pixel's spectrum */

static bool goes_on(void *user, double done) {
  abbe_view_worker *w = user;
  w->share = (float)done;
  return !w->stop;
}

/* By the thread's watch. */
static bool is_wanted(void *user) {
  const abbe_view_worker *w = user;
  return !w->stop;
}

/* ---- settings ---- */

/* What the presets have for such a scene, once for each scene. ABBE_CANCELLED. */
static abbe_result find_front(abbe_view_worker *w, abbe_error *error) {
  abbe_plan plan;
  const abbe_preset_front *front;
  if (w->fronted) return ABBE_OK;
  w->front.count = 0;
  const abbe_result result = abbe_plan_make(w->scene.now, NULL, &plan, error);
  if (result == ABBE_CANCELLED) return result;
  w->fronted = true;
  if (result != ABBE_OK) return ABBE_OK; /* what draws it says why */
  if (abbe_presets_find(&w->presets, &plan, &front, NULL) == ABBE_OK) w->front = *front;
  abbe_plan_free(&plan);
  return ABBE_OK;
}

static abbe_render_desc request_of(const abbe_view_worker *w, const abbe_view_request *q) {
  abbe_render_desc desc =
      abbe_view_settings_of(&w->front, w->scene.now, &q->job, &q->document, w->volume);
  desc.width = q->width;
  desc.height = q->height;
  return desc;
}

/* ---- what is drawn ---- */

static void list_plan(const abbe_plan *plan, const abbe_statistics *s, abbe_view_result *out) {
  out->line = calloc(plan->entry_count + plan->note_count + 1, sizeof *out->line);
  if (out->line == NULL) return;
  for (size_t i = 0; i < plan->entry_count; i++) {
    const abbe_plan_entry *e = &plan->entry[i];
    abbe_view_line *line = &out->line[out->line_count++];
    *line = (abbe_view_line){.runs = e->runs, .ms = -1};
    snprintf(line->name, sizeof line->name, "%s", e->name);
    snprintf(line->reason, sizeof line->reason, "%s", e->reason);
    if (e->item >= ABBE_PASS_COUNT) continue;
    line->kept = s->kept[e->item];
    for (size_t k = 0; k < s->pass_count; k++)
      if (s->pass[k].pass == e->item) line->ms = s->pass[k].ms;
  }
  for (size_t i = 0; i < plan->note_count; i++) {
    abbe_view_line *line = &out->line[out->line_count++];
    *line = (abbe_view_line){.runs = true, .ms = -1};
    snprintf(line->name, sizeof line->name, "note");
    snprintf(line->reason, sizeof line->reason, "%.223s", plan->note[i]);
  }
}

static abbe_result change(abbe_view_worker *w, const abbe_render_desc *desc,
                          abbe_render_progress progress, abbe_error *error) {
  abbe_render_desc watched = *desc;
  watched.progress = progress;
  watched.progress_user = w;
  const abbe_result result =
      w->renderer == NULL
          ? abbe_renderer_make(w->context, w->scene.now, &watched, &w->renderer, error)
          : abbe_renderer_change(w->renderer, w->scene.now, &watched, error);
  w->lost = result != ABBE_OK && !(w->renderer != NULL && abbe_renderer_is_lit(w->renderer));
  if (result != ABBE_OK) return result;
  if (w->drawn != w->scene.now) abbe_view_scene_drop(w->drawn);
  w->drawn = w->scene.now;
  w->scene.relit = false;
  return ABBE_OK;
}

static abbe_result draw(abbe_view_worker *w, const abbe_view_request *q, abbe_view_result *out,
                        abbe_error *error) {
  const bool moving = q->job.stage == ABBE_VIEW_MOVING;
  ABBE_TRY(find_front(w, error));
  const abbe_render_desc desc = request_of(w, q);
  /* What moves is drawn in one go, for no change cancels it, and parts that are waited for take
   * longer, and other code of the driver's; so also for programs' sake. But whoever closes the
   * window does not wait for the compiler. */
  const bool made = w->renderer != NULL && !q->job.warms;
  ABBE_TRY(change(w, &desc, moving && made ? NULL : goes_on, error));
  ABBE_TRY(abbe_renderer_frame(w->renderer, moving ? NULL : goes_on, w,
                               moving ? NULL : &out->statistics, error));
  ABBE_TRY(abbe_renderer_read(w->renderer, !moving, &out->picture, error));
  if (q->job.stage == ABBE_VIEW_ACCURATE) abbe_renderer_rest(w->renderer);
  const abbe_plan *plan = abbe_renderer_plan(w->renderer);
  const abbe_preset_point *point = abbe_view_settings_point(&w->front, q->job.stage);
  out->desc = plan->desc;
  if (!plan->caustics) out->desc.photons = out->desc.map_size = 0;
  out->asked = desc;
  out->counted = !moving;
  if (!moving) list_plan(plan, &out->statistics, out);
  const abbe_view_document *d = &q->document;
  if (point != NULL && d->wavelengths + d->photons + d->map_size == 0) out->promised = point->error;
  return ABBE_OK;
}

/* The mean of the accurate picture and of others that it could have been. */
static abbe_result draw_mean(abbe_view_worker *w, const abbe_view_request *q, abbe_view_result *out,
                             abbe_error *error) {
  const abbe_error_bars_desc desc = {.of_mean = true, .aovs = true, .progress = goes_on, .user = w};
  abbe_view_request before = *q;
  before.job.stage = ABBE_VIEW_ACCURATE;
  ABBE_TRY(draw(w, &before, out, error));
  return abbe_error_bars_make(w->context, w->scene.now, w->renderer, &desc, &out->bars, error);
}

/* Whether the passes' picture is worth its reading: its error falls with their root. */
static bool is_read(size_t passes) {
  return passes == 2 || passes == 3 || (passes >= 4 && (passes & (passes - 1)) == 0) ||
         passes % 16 == 0 || passes == ABBE_VIEW_TRACED_PASSES;
}

static abbe_result trace(abbe_view_worker *w, const abbe_view_request *q, abbe_view_result *out,
                         abbe_error *error) {
  const size_t pixels = q->width * q->height;
  const abbe_trace_desc desc = {
      .no_map = true,
      .width = q->width,
      .height = q->height,
      .bands = pixels <= ABBE_VIEW_BANDS_PIXELS
                   ? ABBE_VIEW_BANDS
                   : (size_t)fmax(1, (double)(ABBE_VIEW_BANDS * ABBE_VIEW_BANDS_PIXELS) /
                                         (double)pixels),
      .stop = &w->stop};
  abbe_result result = ABBE_OK;
  if (w->tracer == NULL || w->traced != q->job.serial) {
    abbe_tracer_free(w->tracer);
    w->tracer = NULL;
    result = abbe_tracer_make(w->scene.now, &desc, &w->tracer, error);
    w->traced = q->job.serial;
  }
  if (result == ABBE_OK) result = abbe_tracer_pass(w->tracer, &w->stop, error);
  if (result != ABBE_OK) return result;
  out->passes = abbe_tracer_passes(w->tracer);
  return is_read(out->passes) ? abbe_tracer_picture(w->tracer, &out->traced, error) : ABBE_OK;
}

/* What was drawn last is looked into, if it is of this scene still. */
static abbe_result look(abbe_view_worker *w, const abbe_view_request *q, abbe_view_result *out,
                        abbe_error *error) {
  if (w->volume != NULL) return ABBE_OK; /* a volume has no photons */
  if (w->renderer == NULL || w->drawn != w->scene.now || w->scene.relit ||
      abbe_view_document_compare(&w->scene.document, &q->document) >= ABBE_VIEW_SETTINGS)
    return ABBE_OK;
  if (q->maps) return abbe_view_look_map(w->renderer, &out->map, error);
  out->feed = malloc(sizeof *out->feed);
  if (out->feed == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for photons");
  abbe_view_feed *feed = out->feed;
  ABBE_TRY(abbe_view_look_feed(w->renderer, w->scene.now, q->point, q->radius, q->nm, &w->stop,
                               feed, error));
  const bool may = feed->on_refractor ? feed->sight.lands : q->lit; /* a caustic be there */
  if (feed->photons > 0 || !may) return ABBE_OK;
  return abbe_view_look_closer(w->context, w->renderer, w->scene.now, q->point, q->radius, q->nm,
                               &w->stop, feed, error);
}

/* Whether no picture is requested. */
static bool looks(const abbe_view_request *q) {
  return q->asks || q->maps || q->tells;
}

/* What the request is of; a tracer and a front are of one scene. */
static abbe_result take_scene(abbe_view_worker *w, const abbe_view_request *q,
                              abbe_view_result *out, abbe_error *error) {
  abbe_view_scene *s = &w->scene;
  abbe_scene *before = s->now;
  const abbe_view_document *d = &q->document;
  if (s->now == NULL || strcmp(s->document.path, d->path) != 0) w->fronted = false;
  const abbe_result result = abbe_view_scene_take(s, d, q->edition != w->edition,
                                                  q->turns ? q->turn_rad : 0, &out->news, error);
  w->edition = q->edition;
  if (s->now == before) return result;
  abbe_tracer_free(w->tracer);
  w->tracer = NULL;
  if (before != w->drawn) abbe_view_scene_drop(before);
  return result;
}

/* Begins the result of a request of which nothing is made yet. */
static void begin_result(const abbe_view_request *q, abbe_view_result *out) {
  memset(out, 0, sizeof *out);
  out->job = q->job;
  out->width = q->width;
  out->height = q->height;
  out->turned = q->turns;
  out->looked = looks(q);
  out->asks = q->asks;
  out->tells = q->tells;
  memcpy(out->pixel, q->pixel, sizeof out->pixel);
}

static abbe_result make(abbe_view_worker *w, const abbe_view_request *q, abbe_view_result *out,
                        abbe_error *error) {
  if (q->asks || q->maps) return look(w, q, out, error);
  ABBE_TRY(take_scene(w, q, out, error));
  if (q->tells)
    return abbe_view_spot_trace(w->scene.now, q->width, q->height, q->pixel, spot_s, &w->stop,
                                &out->spot, error);
  return q->job.stage == ABBE_VIEW_TRACED ? trace(w, q, out, error)
         : q->job.stage == ABBE_VIEW_MEAN ? draw_mean(w, q, out, error)
                                          : draw(w, q, out, error);
}

/* A context instead of one that is lost, as after a reset of the device; what was in it is made
 * again. */
static abbe_result renew(abbe_view_worker *w, abbe_error *error) {
  abbe_renderer_free(w->renderer);
  abbe_context_free(w->context);
  if (w->drawn != w->scene.now) abbe_view_scene_drop(w->drawn);
  w->renderer = NULL;
  w->context = NULL;
  w->drawn = NULL;
  return abbe_own_context_make(ABBE_CONTEXT_AUTO, false, &w->context, error);
}

static void work(abbe_view_worker *w, const abbe_view_request *q, abbe_view_result *out) {
  const double start = abbe_clock_seconds(), own_s = abbe_clock_thread_seconds();
  abbe_error error = {0};
  abbe_watch watch = {.goes_on = is_wanted, .user = w};
  abbe_watch_set(&watch);
  w->lost = false;
  abbe_result result = w->context != NULL ? ABBE_OK : renew(w, &error);
  begin_result(q, out);
  if (result == ABBE_OK) result = make(w, q, out, &error);
  if (result == ABBE_GL && w->context != NULL) { /* once */
    abbe_view_result_free(out);
    result = renew(w, &error);
    begin_result(q, out);
    if (result == ABBE_OK) result = make(w, q, out, &error);
  }
  abbe_watch_set(NULL);
  if (watch.over) result = ABBE_CANCELLED; /* whatever came of it */
  out->ended_s = abbe_clock_seconds();
  out->ms = 1e3 * (out->ended_s - start);
  out->own_ms = 1e3 * (abbe_clock_thread_seconds() - own_s);
  out->outcome = result == ABBE_OK                     ? ABBE_VIEW_DONE
                 : result == ABBE_CANCELLED && w->lost ? ABBE_VIEW_LOST
                 : result == ABBE_CANCELLED            ? ABBE_VIEW_CANCELLED
                                                       : ABBE_VIEW_REFUSED;
  if (out->outcome == ABBE_VIEW_REFUSED)
    snprintf(out->sentence, sizeof out->sentence, "%.1000s",
             error.text[0] != '\0' ? error.text : abbe_result_text(result));
}

/* ---- the thread ---- */

static void run(abbe_view_worker *w) {
  pthread_mutex_lock(&w->lock);
  while (!w->quit) {
    if (!w->busy || w->done) {
      pthread_cond_wait(&w->signal, &w->lock);
      continue;
    }
    pthread_mutex_unlock(&w->lock);
    work(w, &w->request, &w->made);
    pthread_mutex_lock(&w->lock);
    abbe_view_document_free(&w->request.document);
    w->result = w->made;
    w->done = true;
    pthread_cond_broadcast(&w->signal);
    if (w->wake != NULL) w->wake();
  }
  pthread_mutex_unlock(&w->lock);
}

static void *begin(void *user) {
  abbe_view_worker *w = user;
  run(w);
  abbe_tracer_free(w->tracer);
  abbe_renderer_free(w->renderer);
  abbe_context_free(w->context);
  return NULL;
}

abbe_result abbe_view_worker_make(const char *materials, const abbe_caustic_volume *volume,
                                  void (*wake)(void), abbe_view_worker **out, abbe_error *error) {
  abbe_view_worker *w = calloc(1, sizeof *w);
  *out = NULL;
  if (w == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the viewer");
  w->wake = wake;
  w->volume = volume;
  w->scene.materials = materials;
  abbe_result result = abbe_presets_load(NULL, &w->presets, error);
  pthread_mutex_init(&w->lock, NULL);
  pthread_cond_init(&w->signal, NULL);
  if (result == ABBE_OK && pthread_create(&w->thread, NULL, begin, w) != 0)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no thread for the viewer's pictures");
  if (result == ABBE_OK) {
    *out = w;
    return ABBE_OK;
  }
  abbe_presets_free(&w->presets);
  free(w);
  return result;
}

void abbe_view_worker_free(abbe_view_worker *w) {
  if (w == NULL) return;
  pthread_mutex_lock(&w->lock);
  w->stop = w->quit = 1;
  pthread_cond_broadcast(&w->signal);
  pthread_mutex_unlock(&w->lock);
  pthread_join(w->thread, NULL);
  abbe_view_result_free(&w->result);
  abbe_view_document_free(&w->request.document);
  if (w->drawn != w->scene.now) abbe_view_scene_drop(w->drawn);
  abbe_view_scene_free(&w->scene);
  abbe_presets_free(&w->presets);
  pthread_cond_destroy(&w->signal);
  pthread_mutex_destroy(&w->lock);
  free(w);
}

bool abbe_view_worker_idle(abbe_view_worker *w) {
  pthread_mutex_lock(&w->lock);
  const bool idle = !w->busy;
  pthread_mutex_unlock(&w->lock);
  return idle;
}

void abbe_view_worker_give(abbe_view_worker *w, abbe_view_request *request) {
  pthread_mutex_lock(&w->lock);
  w->request = *request;
  *request = (abbe_view_request){0};
  w->busy = true;
  w->stop = 0;
  w->share = 0;
  pthread_cond_broadcast(&w->signal);
  pthread_mutex_unlock(&w->lock);
}

double abbe_view_worker_done(const abbe_view_worker *w) {
  return (double)w->share;
}

void abbe_view_worker_cancel(abbe_view_worker *w) {
  w->stop = 1;
}

void abbe_view_worker_wait(abbe_view_worker *w, double seconds) {
  struct timespec until;
  clock_gettime(CLOCK_REALTIME, &until);
  const double nanoseconds = (double)until.tv_nsec + 1e9 * seconds;
  until.tv_sec += (time_t)(nanoseconds / 1e9);
  until.tv_nsec = (long)fmod(nanoseconds, 1e9);
  pthread_mutex_lock(&w->lock);
  while (w->busy && !w->done && pthread_cond_timedwait(&w->signal, &w->lock, &until) == 0) continue;
  pthread_mutex_unlock(&w->lock);
}

bool abbe_view_worker_take(abbe_view_worker *w, abbe_view_result *out) {
  pthread_mutex_lock(&w->lock);
  const bool there = w->busy && w->done;
  if (there) {
    *out = w->result;
    w->result = (abbe_view_result){0};
    w->busy = w->done = false;
  }
  pthread_mutex_unlock(&w->lock);
  return there;
}
