#include "cli/view/view_app.h"

#include "base/clock.h"
#include "cli/view/view_keep.h"
#include "colorimetry/screen/screen_png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOOK_S 0.5       /* how often files are looked at */
#define MOST_GAP_MS 25.0 /* between moving pictures that follow each other */
#define WAIT_S 0.1       /* for a moving picture, before the window is drawn with an older one */

/* ---- begin, end ---- */

abbe_result abbe_view_app_begin(abbe_view_session *app, const abbe_view_app_desc *desc,
                                abbe_context *context, abbe_error *error) {
  *app = (abbe_view_session){.gl = abbe_context_gl(context),
                             .screen = {.gl = abbe_context_gl(context)},
                             .keep = desc->keep,
                             .ocio = desc->ocio,
                             .materials = desc->materials,
                             .volume_path = desc->volume_path,
                             .volume = desc->volume,
                             .inspection = {.pictures = desc->pictures, .listener = desc->listener},
                             .judge = {.wake = desc->wake},
                             .seen_s = -1};
  if (desc->pictures != NULL) {
    const abbe_result shown = abbe_view_inspect_begin(app, error);
    if (shown != ABBE_OK) abbe_view_app_end(app);
    return shown;
  }
  abbe_view_keep_find_place(app);
  abbe_result result = abbe_view_state_begin(&app->state, desc->document, error);
  app->state.refine.last = desc->last;
  app->state.refine.single = desc->volume != NULL;
  if (result == ABBE_OK) result = abbe_display_list(desc->ocio, &app->views, error);
  if (result == ABBE_OK) result = abbe_view_session_choose_view(app, 0, error);
  if (result == ABBE_OK) result = abbe_ui_make(error);
  if (result == ABBE_OK) result = abbe_view_painter_make(desc->wake, &app->painter, error);
  for (size_t i = 0; i < ABBE_VIEW_WORKERS && result == ABBE_OK; i++) {
    app->desk[i].stopped_s = -1;
    result = abbe_view_worker_make(desc->materials, desc->volume, desc->wake, &app->desk[i].worker,
                                   error);
  }
  if (result == ABBE_OK) abbe_view_session_list_scenes(app, desc->document->path);
  if (result != ABBE_OK) abbe_view_app_end(app);
  return result;
}

void abbe_view_app_end(abbe_view_session *app) {
  abbe_view_inspect_end(app);
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++) { /* the second one ends while the first does */
    if (app->desk[i].worker != NULL) abbe_view_worker_cancel(app->desk[i].worker);
  }
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++) {
    abbe_view_worker_free(app->desk[i].worker);
    app->desk[i].worker = NULL;
  }
  abbe_view_judge_end(app);
  abbe_view_painter_free(app->painter);
  abbe_view_screen_free(&app->screen);
  abbe_ui_free();
  abbe_view_table_free(app->table);
  abbe_display_free(app->display);
  for (size_t i = 0; i < app->scene_count; i++) free(app->scene[i]);
  free(app->views);
  abbe_view_files_free(&app->files);
  free(app->feed);
  abbe_view_pictures_free(&app->pictures);
  abbe_view_result_free(&app->last);
  abbe_view_state_free(&app->state);
}

static void look_at_files(abbe_view_session *app, double now_s) {
  if (now_s - app->looked_s < LOOK_S) return;
  app->looked_s = now_s;
  if (!abbe_view_files_changed(&app->files)) return;
  app->edition++;
  abbe_view_state_reload(&app->state, now_s);
}

/* ---- results ---- */

static void replace(abbe_image *old, abbe_image *new) {
  abbe_image_free(old);
  *old = *new;
  *new = (abbe_image){0};
}

static void take_rendered(abbe_view_session *app, abbe_view_result *result) {
  const bool mean = result->job.stage == ABBE_VIEW_MEAN;
  app->stage = result->job.stage;
  abbe_image_free(&app->pictures.traced);
  abbe_image_free(&app->pictures.error);
  app->passes = 0;
  app->promised = result->promised;
  app->estimated = 0;
  if (mean) {
    replace(&app->pictures.rendered, &result->bars.mean);
    replace(&app->pictures.error, &result->bars.error);
    app->estimated = result->bars.caustic.pixels > 0 ? result->bars.caustic.ciede2000
                                                     : result->bars.whole.ciede2000;
    app->promised = app->last.promised;
    return;
  }
  replace(&app->pictures.rendered, &result->picture);
  if (!app->exposed) app->state.exposure = abbe_screen_png_exposure(&app->pictures.rendered);
  app->exposed = true;
  abbe_image_free(&app->pictures.layers);
  app->pictures.coarse = 0;
  if (result->job.stage == ABBE_VIEW_MOVING) {
    app->pictures.coarse = result->desc.upsample;
    app->pictures.beyond =
        result->desc.upsample * app->pictures.rendered.height - result->desc.height;
    app->moved = result->job;
    app->moving = result->desc;
    return;
  }
  /* what the mean takes the place of is kept for its layers */
  const abbe_image *from = &app->pictures.rendered;
  if (abbe_image_make(from->width, from->height, from->channels, (const char *const *)from->channel,
                      &app->pictures.layers, NULL) == ABBE_OK)
    memcpy(app->pictures.layers.data, from->data,
           from->width * from->height * from->channels * sizeof *from->data);
  abbe_view_result_free(&app->last);
  app->last = *result;
  *result = (abbe_view_result){.job = app->last.job};
}

static void take(abbe_view_session *app, size_t worker, abbe_view_result *result) {
  abbe_view_refine *refine = &app->state.refine;
  const bool moved = result->job.stage == ABBE_VIEW_MOVING;
  /* what counts is how often they come: with the wait until the next one was requested */
  const double waited_ms = moved ? app->desk[worker].waited_ms : 0;
  const bool newest = result->job.serial == refine->serial;
  const bool shown =
      abbe_view_refine_end(refine, worker, result->outcome, result->ms + waited_ms, result->own_ms);
  app->desk[worker].ended_s = moved ? result->ended_s : -1;
  if (result->news.outlined) abbe_view_files_take(&app->files, &result->news);
  if (result->news.outlined) abbe_view_state_learn(&app->state, &result->news.outline, newest);
  if (result->outcome == ABBE_VIEW_REFUSED && newest)
    snprintf(app->state.refusal, sizeof app->state.refusal, "%s", result->sentence);
  if (!shown) return;
  const abbe_camera *led = &app->desk[worker].camera; /* unknown before the first picture */
  abbe_view_state_picture(&app->state, newest || led->fov_y_rad == 0 ? &app->state.camera : led);
  const double pictured_s = abbe_clock_seconds();
  if (moved && app->seen_s < 0) { /* after a rest */
    app->frame_count = 0;
    app->own_ms = 0;
  }
  if (moved && app->first_s > 0) app->own_ms = fmax(app->own_ms, result->own_ms);
  if (app->first_s == 0) app->first_s = abbe_clock_process_seconds();
  if (moved && app->seen_s > 0 && pictured_s - app->seen_s < 1)
    app->frames_ms[app->frame_count++ % 32] = 1e3 * (pictured_s - app->seen_s);
  app->seen_s = moved ? pictured_s : -1;
  if (result->job.stage == ABBE_VIEW_TRACED) {
    app->stage = ABBE_VIEW_TRACED;
    if (result->traced.data == NULL) return;
    app->passes = result->passes;
    abbe_view_painter_stop(app->painter); /* stops the picture that is drawn now */
    replace(&app->pictures.traced, &result->traced);
  } else {
    abbe_view_painter_stop(app->painter);
    take_rendered(app, result);
  }
  abbe_view_session_compare(app);
  app->stale = true;
}

/* What a busy worker does is for an older state or of another pixel, and it was not cancelled. */
static bool is_obsolete(const abbe_view_session *app, size_t worker) {
  const abbe_view_state *s = &app->state;
  const abbe_view_desk *desk = &app->desk[worker];
  if (desk->stopped_s >= 0) return false;
  if (!desk->other) return abbe_view_refine_cancels(&s->refine, worker);
  return desk->serial != s->refine.serial ||
         (desk->asked && (desk->pixel[0] != s->pixel[0] || desk->pixel[1] != s->pixel[1]));
}

static void cancel_obsolete(abbe_view_session *app, size_t worker) {
  abbe_view_desk *desk = &app->desk[worker];
  if (!is_obsolete(app, worker)) return;
  desk->stopped_s = abbe_clock_seconds();
  abbe_view_worker_cancel(desk->worker);
}

/* What a worker does beside all jobs; false: nothing. Asked is whoever has drawn the last picture
 * at rest; the turntable is never the one's that shows. */
static bool wants_other(const abbe_view_session *app, size_t worker, abbe_view_request *out) {
  const abbe_view_refine *refine = &app->state.refine;
  return (worker == refine->made && abbe_view_asks_want(app, out)) ||
         (worker != refine->made && worker != refine->shows && abbe_view_turn_wants(app, out));
}

static void give_one(abbe_view_session *app, size_t worker, double now_s) {
  abbe_view_state *s = &app->state;
  abbe_view_desk *desk = &app->desk[worker];
  abbe_view_request request = {.width = s->width,
                               .height = s->height,
                               .edition = app->edition,
                               .pixel = {s->pixel[0], s->pixel[1]}};
  if (!abbe_view_worker_idle(desk->worker)) {
    cancel_obsolete(app, worker);
    return;
  }
  request.job.serial = s->refine.serial;
  const bool other = wants_other(app, worker, &request);
  if (!other && !abbe_view_refine_next(&s->refine, worker, now_s, &request.job)) return;
  if (abbe_view_document_copy(abbe_view_history_now(&s->history), &request.document, NULL) !=
      ABBE_OK)
    return;
  desk->serial = s->refine.serial;
  desk->other = other;
  desk->asked = request.asks || request.tells;
  memcpy(desk->pixel, s->pixel, sizeof desk->pixel);
  desk->camera = s->camera;
  if (!other) abbe_view_refine_take(&s->refine, worker, &request.job);
  if (request.turns) abbe_view_refine_forget(&s->refine, worker);
  desk->waited_ms = 1e3 * (abbe_clock_seconds() - desk->ended_s);
  if (!(desk->ended_s > 0 && desk->waited_ms < MOST_GAP_MS)) desk->waited_ms = 0;
  abbe_view_asks_note(app, &request);
  abbe_view_worker_give(desk->worker, &request);
}

static void give(abbe_view_session *app, double now_s) {
  if (app->state.width == 0 || app->state.height == 0) return;
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++) give_one(app, i, now_s);
}

/* What the workers have made. */
static void take_results(abbe_view_session *app) {
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++) {
    abbe_view_desk *desk = &app->desk[i];
    if (!abbe_view_worker_take(desk->worker, &app->taken)) continue;
    if (desk->stopped_s >= 0) app->stop_ms = 1e3 * fmax(0, app->taken.ended_s - desk->stopped_s);
    desk->stopped_s = -1;
    if (app->taken.turned)
      abbe_view_turn_take(app, &app->taken);
    else if (app->taken.looked)
      abbe_view_asks_take(app, &app->taken);
    else
      take(app, i, &app->taken);
    abbe_view_result_free(&app->taken);
  }
}

/* Whoever shows draws what moves, or ends what it did to do so. */
static bool is_moving(const abbe_view_session *app) {
  const size_t shows = app->state.refine.shows;
  const abbe_view_hand *hand = &app->state.refine.hand[shows];
  return app->first_s > 0 &&
         (app->desk[shows].stopped_s >= 0 ||
          (hand->busy && hand->job.stage == ABBE_VIEW_MOVING && !hand->job.warms));
}

/* A moving picture is there that the screen does not show. */
static bool has_moved(const abbe_view_session *app) {
  return app->stale && app->stage == ABBE_VIEW_MOVING;
}

/* A moving picture that is nearly there is waited for: drawing the window meanwhile would only take
 * the processor from it. */
static void await_moving(abbe_view_session *app, double now_s) {
  const double until_s = abbe_clock_seconds() + WAIT_S;
  if (is_moving(app)) abbe_view_painter_stop(app->painter);
  while (!has_moved(app) && is_moving(app) && abbe_clock_seconds() < until_s) {
    abbe_view_worker_wait(app->desk[app->state.refine.shows].worker,
                          until_s - abbe_clock_seconds());
    take_results(app);
    if (!has_moved(app)) give(app, now_s);
  }
}

/* How long the oldest event that the picture in the window shows, and none before it, has waited
 * for it; and so a change that ended a rest. */
static void time_events(abbe_view_session *app) {
  const uint64_t shown = app->state.refine.shown;
  if (shown <= app->pictured) return;
  app->gl->Finish();
  const double now_s = abbe_clock_seconds();
  const double event_s = app->event_s[(app->pictured + 1) % ABBE_VIEW_TIMED];
  if (shown - app->pictured < ABBE_VIEW_TIMED && event_s > 0)
    app->latency_ms = 1e3 * (now_s - event_s);
  while (app->pictured < shown) app->event_s[++app->pictured % ABBE_VIEW_TIMED] = 0;
  if (app->obsolete == 0 || shown < app->obsolete) return;
  app->cancel_ms = 1e3 * (now_s - app->obsolete_s);
  app->obsolete = 0;
}

/* ---- the picture in the window ---- */

/* What the screen does not show yet of that which it is to show. */
static bool is_stale(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  return app->pictures.rendered.data != NULL &&
         (app->stale || app->drawn_exposure != s->exposure ||
          app->drawn != abbe_view_shown_of(&app->pictures, s->shown));
}

static abbe_view_painting painting_of(const abbe_view_session *app) {
  return (abbe_view_painting){.pictures = &app->pictures,
                              .shown = abbe_view_shown_of(&app->pictures, app->state.shown),
                              .exposure = app->state.exposure,
                              .display = app->display};
}

/* To the screen, or why there is nothing; pixels are freed. */
static void put(abbe_view_session *app, const abbe_view_painting *what, unsigned char *pixels,
                abbe_result result, const abbe_error *error) {
  const abbe_image *image = &app->pictures.rendered;
  const bool coarse = app->pictures.coarse > 1;
  const size_t seen[2] = {coarse ? app->moving.width : image->width,
                          coarse ? app->moving.height : image->height};
  app->drawn = what->shown;
  app->drawn_exposure = what->exposure;
  app->stale = false;
  if (result == ABBE_OK)
    abbe_view_screen_take(&app->screen, pixels, image->width, image->height,
                          coarse ? app->pictures.coarse : 1, seen);
  else
    snprintf(app->note, sizeof app->note, "%s", error->text);
  free(pixels);
  /* the first picture is not kept waiting, and no other one */
  if (app->table == NULL) app->table = abbe_view_table_begin(app->display);
}

/* What moves is brought to the screen at once. */
static void show_moving(abbe_view_session *app) {
  const abbe_view_painting what = painting_of(app);
  unsigned char *pixels = NULL;
  abbe_error error = {0};
  const abbe_result result = abbe_view_show(what.pictures, what.shown, what.exposure, what.display,
                                            abbe_view_table_get(app->table), &pixels, &error);
  put(app, &what, pixels, result, &error);
}

/* What rests is painted meanwhile, unless a change has come. */
static void show_rest(abbe_view_session *app) {
  const abbe_view_painting now = painting_of(app);
  const abbe_view_painting *has = abbe_view_painter_has(app->painter);
  const bool other = has != NULL && (has->shown != now.shown || has->exposure != now.exposure);
  unsigned char *pixels = NULL;
  abbe_result result = ABBE_OK;
  abbe_error error = {0};
  if (other || is_moving(app)) abbe_view_painter_stop(app->painter);
  has = abbe_view_painter_has(app->painter);
  if (has == NULL && !is_moving(app))
    abbe_view_painter_give(app->painter, &now);
  else if (has != NULL && abbe_view_painter_take(app->painter, &pixels, &result, &error))
    put(app, &now, pixels, result, &error);
}

/* Changes up to now, by the pointer, from this one on. */
static void note_events(abbe_view_session *app, uint64_t first) {
  const abbe_view_refine *refine = &app->state.refine;
  const double now_s = abbe_clock_seconds();
  bool rested = app->stage > ABBE_VIEW_MOVING;
  for (uint64_t k = first; k <= refine->serial; k++) app->event_s[k % ABBE_VIEW_TIMED] = now_s;
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++)
    rested = rested || (refine->hand[i].busy && i != refine->shows);
  if (first > refine->serial || app->obsolete != 0 || !rested) return;
  app->obsolete = first;
  app->obsolete_s = now_s;
}

static void feed(abbe_view_session *app, const abbe_ui_input *input, double now_s) {
  abbe_view_state *s = &app->state;
  const abbe_ui_input *before = &app->input;
  const uint64_t serial = s->refine.serial;
  static const abbe_view_button buttons[] = {ABBE_VIEW_LEFT, ABBE_VIEW_RIGHT, ABBE_VIEW_MIDDLE};
  const int modifiers =
      (input->shift ? ABBE_VIEW_SHIFT : 0) | (input->control ? ABBE_VIEW_CONTROL : 0);
  const double x = input->mouse[0], y = input->mouse[1];
  for (int i = 0; i < 3; i++) {
    const bool inside = x < app->area[0] && y < app->area[1];
    if (input->button[i] && !before->button[i] && inside && !abbe_ui_has_pointer())
      abbe_view_state_press(s, buttons[i], x, y, modifiers, now_s);
  }
  if (x != before->mouse[0] || y != before->mouse[1]) abbe_view_state_move(s, x, y, now_s);
  for (int i = 0; i < 3; i++)
    if (!input->button[i] && before->button[i]) abbe_view_state_release(s, buttons[i], now_s);
  if (input->wheel != 0 && x < app->area[0] && !abbe_ui_has_pointer())
    abbe_view_state_wheel(s, input->wheel, now_s);
  abbe_view_state_tick(s, input->seconds, now_s);
  note_events(app, serial + 1);
}

void abbe_view_app_key(abbe_view_session *app, int key, bool down, int modifiers, double now_s) {
  abbe_error error = {0};
  if (app->inspection.pictures != NULL) {
    if (down && modifiers == 0) abbe_view_inspect_key(app, key);
    return;
  }
  if (down && key == 's' && (modifiers & ABBE_VIEW_CONTROL) != 0) {
    if (abbe_view_keep(app, &error) != ABBE_OK)
      snprintf(app->note, sizeof app->note, "%s", error.text);
    return;
  }
  if (down && key == 't' && modifiers == 0) {
    if (abbe_view_turn_begin(app, &error) != ABBE_OK)
      snprintf(app->note, sizeof app->note, "%s", error.text);
    return;
  }
  if (down && (key == 'h' || key == '?') && modifiers != ABBE_VIEW_CONTROL) {
    app->keys = !app->keys;
    return;
  }
  abbe_view_state_key(&app->state, key, down, modifiers, now_s);
}

void abbe_view_app_frame(abbe_view_session *app, const abbe_ui_input *input, double now_s) {
  if (app->inspection.pictures != NULL) {
    abbe_view_inspect_frame(app, input);
    return;
  }
  abbe_view_state *s = &app->state;
  static const float dark[4] = {0.086F, 0.094F, 0.11F, 1};
  const double panel = fmin(ABBE_VIEW_PANEL_WIDTH, input->width);
  const double width = floor(input->width - panel), height = floor(input->height);
  const bool room = width >= 16 && height >= 16; /* else there is no picture to be drawn */
  app->area[0] = width;
  app->area[1] = height;
  abbe_view_state_resize(s, room ? (size_t)width : 0, room ? (size_t)height : 0, now_s);
  feed(app, input, now_s);
  look_at_files(app, now_s);
  take_results(app);
  give(app, now_s);
  abbe_view_judge_frame(app);
  abbe_view_report_frame(app);
  await_moving(app, now_s);
  if (s->picked) abbe_view_probe_make(&app->pictures, s->pixel, &app->probe);
  if (abbe_view_asks_has_spot(app)) abbe_view_probe_take_spot(&app->probe, app->passes, &app->spot);
  if (is_stale(app) && app->stage == ABBE_VIEW_MOVING) show_moving(app);
  if (is_stale(app)) show_rest(app);
  app->input = *input;
  app->gl->ClearBufferfv(GL_COLOR, 0, dark);
  if (room) abbe_view_screen_draw(&app->screen, (size_t)width, (size_t)height);
  abbe_ui_begin(input);
  if (room) abbe_view_marks_draw(app);
  abbe_ui_panel_begin("Abbe", width, 0, panel, input->height);
  abbe_view_panel_draw(app, now_s);
  abbe_ui_panel_end();
  abbe_ui_end();
  time_events(app);
}

double abbe_view_app_wait(abbe_view_session *app, double now_s) {
  const abbe_view_state *s = &app->state;
  abbe_view_job job;
  abbe_view_request request;
  if (app->inspection.pictures != NULL) return abbe_view_app_painted(app) ? LOOK_S : 0;
  if (s->width == 0 || s->height == 0) return LOOK_S;
  if (s->fly[0] != 0 || s->fly[1] != 0 || s->fly[2] != 0) return 0;
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++)
    if (abbe_view_worker_idle(app->desk[i].worker)
            ? abbe_view_refine_next(&s->refine, i, now_s, &job) || wants_other(app, i, &request)
            : is_obsolete(app, i))
      return 0;
  const double wait = abbe_view_refine_wait(&s->refine, now_s);
  return wait <= 0 ? LOOK_S : fmin(LOOK_S, wait);
}

bool abbe_view_app_stopped(const abbe_view_session *app) {
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++)
    if (app->desk[i].stopped_s >= 0) return false;
  return true;
}

bool abbe_view_app_painted(const abbe_view_session *app) {
  if (app->inspection.pictures != NULL)
    return app->inspection.whole && !app->inspection.stale && !app->inspection.more &&
           !app->inspection.reading;
  return !is_stale(app);
}

bool abbe_view_app_rests(abbe_view_session *app, double now_s) {
  abbe_view_request request;
  if (app->inspection.pictures != NULL) return abbe_view_app_painted(app);
  if (is_stale(app) || app->reports || !abbe_view_judge_rests(app)) return false;
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++)
    if (!abbe_view_worker_idle(app->desk[i].worker)) return false;
  return !abbe_view_asks_want(app, &request) && !abbe_view_turn_wants(app, &request) &&
         abbe_view_refine_wait(&app->state.refine, now_s) < 0;
}
