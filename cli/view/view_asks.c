#include "cli/view/view_app.h"

#include "base/maths.h"
#include "cli/view/state/view_camera.h"
#include "cli/view/view_keep.h"
#include "colorimetry/screen/screen_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define FEED_PIXELS 2.0 /* photons so near to a pixel feed it */

/* Where the picked pixel's light has come in is requested once for each picture at rest. */
static bool wants_feed(const abbe_view_session *app, abbe_view_request *out) {
  const abbe_view_state *s = &app->state;
  const abbe_image *layers = &app->pictures.layers;
  const size_t z = layers->data != NULL ? abbe_image_find_channel(layers, "Z") : (size_t)-1;
  const bool was_asked = app->fed_serial == s->refine.serial && app->fed_pixel[0] == s->pixel[0] &&
                         app->fed_pixel[1] == s->pixel[1];
  if (!s->picked || was_asked || s->refine.stage < ABBE_VIEW_BALANCED || z == (size_t)-1 ||
      layers->width != s->width || layers->height != s->height || s->pixel[0] >= s->width ||
      s->pixel[1] >= s->height)
    return false;
  const float *pixel =
      layers->data + layers->channels * (s->pixel[1] * layers->width + s->pixel[0]);
  const double distance = (double)pixel[z];
  out->lit = abbe_view_probe_shows_caustic(layers, pixel);
  const double xy[2] = {(double)s->pixel[0] + 0.5, (double)s->pixel[1] + 0.5};
  abbe_view_camera_point(&s->camera, s->width, s->height, xy, distance, out->point);
  abbe_view_probe probe;
  abbe_view_probe_make(&app->pictures, s->pixel, &probe);
  out->nm = probe.dominant_nm > 0 ? probe.dominant_nm : 550;
  /* as wide as some pixels */
  out->radius = FEED_PIXELS * distance * 2 * tan(0.5 * s->camera.fov_y_rad) / (double)s->height;
  return distance > 0;
}

bool abbe_view_asks_has_spot(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  return s->picked && app->spot_serial == s->refine.serial && app->spot_pixel[0] == s->pixel[0] &&
         app->spot_pixel[1] == s->pixel[1];
}

/* The picked pixel's spectrum, before a whole picture is traced. */
static bool wants_spot(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  const bool traces = s->refine.last == ABBE_VIEW_NONE || s->refine.last == ABBE_VIEW_TRACED;
  return s->picked && traces && !abbe_view_asks_has_spot(app) &&
         s->refine.stage >= ABBE_VIEW_BALANCED && app->pictures.traced.data == NULL;
}

/* The stage whose light is drawn. */
static abbe_view_stage lit_stage(const abbe_view_refine *r) {
  return r->stage > ABBE_VIEW_ACCURATE ? ABBE_VIEW_ACCURATE : r->stage;
}

/* The map is requested while it is looked at, once for each stage. */
static bool wants_map(const abbe_view_session *app) {
  const abbe_view_refine *r = &app->state.refine;
  return app->state.shown == ABBE_VIEW_MAP_PICTURE && r->stage >= ABBE_VIEW_BALANCED &&
         (app->mapped_serial != r->serial || app->mapped != lit_stage(r));
}

bool abbe_view_asks_want(const abbe_view_session *app, abbe_view_request *out) {
  out->maps = wants_map(app);
  out->asks = !out->maps && wants_feed(app, out);
  out->tells = !out->maps && !out->asks && wants_spot(app);
  return out->maps || out->asks || out->tells;
}

void abbe_view_asks_note(abbe_view_session *app, const abbe_view_request *request) {
  const abbe_view_state *s = &app->state;
  if (request->asks) {
    app->fed_serial = s->refine.serial;
    memcpy(app->fed_pixel, s->pixel, sizeof app->fed_pixel);
    free(app->feed);
    app->feed = NULL;
  } else if (request->tells) {
    app->spot_serial = s->refine.serial;
    memcpy(app->spot_pixel, s->pixel, sizeof app->spot_pixel);
    app->spot.bands = 0;
  } else if (request->maps) {
    app->mapped_serial = s->refine.serial;
    app->mapped = lit_stage(&s->refine);
  }
}

/* What was noted last. If it was cancelled it may be requested again. */
static bool is_answer(const abbe_view_result *result, uint64_t *serial, const size_t pixel[2]) {
  if (result->job.serial != *serial || result->pixel[0] != pixel[0] || result->pixel[1] != pixel[1])
    return false;
  if (result->outcome == ABBE_VIEW_CANCELLED || result->outcome == ABBE_VIEW_LOST)
    *serial = UINT64_MAX;
  return result->outcome == ABBE_VIEW_DONE;
}

void abbe_view_asks_take(abbe_view_session *app, abbe_view_result *result) {
  if (result->map.data != NULL) {
    abbe_view_painter_stop(app->painter);
    abbe_image_free(&app->pictures.map);
    app->pictures.map = result->map;
    result->map = (abbe_image){0};
    app->stale = true;
  }
  if (result->tells && is_answer(result, &app->spot_serial, app->spot_pixel))
    app->spot = result->spot;
  if (!result->asks || !is_answer(result, &app->fed_serial, app->fed_pixel)) return;
  free(app->feed);
  app->feed = result->feed;
  result->feed = NULL;
}

static bool show_line(const abbe_view_state *s, const double a[3], const double b[3],
                      abbe_ui_colour colour, double wide) {
  double p[2], q[2];
  if (!abbe_view_camera_project(&s->pictured, s->width, s->height, a, p) ||
      !abbe_view_camera_project(&s->pictured, s->width, s->height, b, q))
    return false;
  abbe_ui_line(p[0], p[1], q[0], q[1], colour, wide);
  return true;
}

/* The facets through which the pixel's light has come in, the cells of these, and the straight ends
 * of some paths: from the light, and from where they entered to the pixel. */
static void draw_feed(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  const abbe_view_feed *feed = abbe_view_session_feed(app);
  if (feed == NULL) return;
  const size_t every = feed->ray_count / 12 + 1;
  for (size_t i = 0; i + 1 < feed->sight.count; i++)
    show_line(s, feed->sight.place[i], feed->sight.place[i + 1], 0x30e0a0ff, 1.5);
  for (size_t i = 0; i < feed->ray_count; i += every) {
    show_line(s, feed->ray[i].light, feed->ray[i].entry, 0xa0ffe9b0, 1);
    show_line(s, feed->ray[i].entry, feed->point, 0xc0ffffff, 1);
  }
  for (size_t i = 0; i < feed->edge_count; i++)
    show_line(s, feed->edge[i][0], feed->edge[i][1], 0x307fe3b0, 1.5);
  for (size_t i = 0; i < feed->ray_count; i++) {
    double p[2];
    if (abbe_view_camera_project(&s->pictured, s->width, s->height, feed->ray[i].entry, p))
      abbe_ui_box(p[0] - 1, p[1] - 1, p[0] + 1, p[1] + 1, 0x20ffe08a);
  }
}

/* What hands and keys do, over the picture. */
static void draw_keys(void) {
  static const char *const lines[][2] = {
      {"left drag", "turns the view; with shift, sideways"},
      {"wheel", "nearer and farther"},
      {"right drag", "looks around; w a s d q e fly"},
      {"drag a ring", "moves it; shift: up and down; control: tilts"},
      {"g", "drops what was dragged last on the table"},
      {"click", "a pixel's spectrum"},
      {"b, v", "checked by tracing; the difference"},
      {"+ -", "brighter, darker"},
      {"control z, y", "undo, redo"},
      {"control s", "keeps picture and scene"},
      {"t", "turntable"},
      {"h, ?, F1", "these keys"},
  };
  const size_t count = sizeof lines / sizeof *lines;
  abbe_ui_box(12, 12, 440, 32 + 20 * (double)count, 0x1816181c);
  for (size_t i = 0; i < count; i++) {
    abbe_ui_label(24, 22 + 20 * (double)i, 0xffd98a, lines[i][0]);
    abbe_ui_label(130, 22 + 20 * (double)i, 0xe8eaee, lines[i][1]);
  }
}

/* At the picture's edge, to each light that is not in it. */
static void draw_arrows(const abbe_view_state *s) {
  for (size_t i = 0; s->pictured.fov_y_rad > 0 && i < s->outline.light_count; i++) {
    const abbe_view_light *light = &s->outline.light[i];
    double p[2], w[2];
    if (!light->placed ||
        !abbe_view_camera_beyond(&s->pictured, s->width, s->height, light->position, 10, p, w))
      continue;
    for (int side = -1; side <= 1; side++)
      abbe_ui_line(p[0], p[1], p[0] - 12 * w[0] + 7 * side * w[1],
                   p[1] - 12 * w[1] - 7 * side * w[0], 0x30ffd98a, 2);
    const double x = p[0] - 20 * w[0], right = (double)s->width - 8 * (double)strlen(light->name);
    abbe_ui_label(fmax(4, fmin(x + 4, right)), p[1] - 20 * w[1] - 8, 0x30ffd98a, light->name);
  }
}

/* While a slider is pointed at: the stone from above, where a degree more returns more light,
 * green, and less, red. */
static void draw_hint(const abbe_view_session *app) {
  enum { SIDE = ABBE_VIEW_FACE, PIXEL = 5 };
  if (app->hinted == NULL) return;
  const float *change = app->hinted->change[app->hinted_side];
  const double left = app->area[0] - PIXEL * SIDE - 12, top = 30;
  abbe_ui_box(left - 6, top - 22, left + PIXEL * SIDE + 6, top + PIXEL * SIDE + 6, 0x2016181c);
  abbe_ui_label(left, top - 19, 0xe8eaee, "a degree more");
  for (size_t i = 0; i < SIDE * SIDE; i++) {
    const double x = left + PIXEL * (double)(i % SIDE), y = top + PIXEL * (double)(i / SIDE);
    const unsigned level = (unsigned)fmin(255, 600 * fabs((double)change[i]));
    if (level > 4)
      abbe_ui_box(x, y, x + PIXEL, y + PIXEL, change[i] > 0 ? level << 8 | level / 3 : level << 16);
  }
}

void abbe_view_marks_draw(const abbe_view_session *app) {
  const abbe_view_state *s = &app->state;
  abbe_view_handle handle;
  abbe_ui_clip(app->area[0], app->area[1]);
  for (size_t i = 0; abbe_view_state_handle(s, i, &handle); i++) {
    const bool light = handle.kind == ABBE_VIEW_LIGHT_HANDLE;
    const bool near = hypot(handle.xy[0] - app->input.mouse[0],
                            handle.xy[1] - app->input.mouse[1]) < ABBE_VIEW_HANDLE_PIXELS;
    const abbe_ui_colour colour = light ? 0x30ffd98a : 0x509fc4ff;
    abbe_ui_circle(handle.xy[0], handle.xy[1], near ? 8 : 6, colour, near ? 2.5 : 1.5);
    if (near)
      abbe_ui_label(handle.xy[0] + 13, handle.xy[1] - 8, colour,
                    light ? s->outline.light[handle.index].name
                          : s->outline.object[handle.index].name);
  }
  draw_arrows(s);
  draw_hint(app);
  if (s->picked) {
    draw_feed(app);
    const double x = (double)s->pixel[0] + 0.5, y = (double)s->pixel[1] + 0.5;
    abbe_ui_circle(x, y, 5, 0x00ffffff, 1.5);
    abbe_ui_circle(x, y, 6.5, 0x40000000, 1);
  }
  if (app->keys) draw_keys();
}

enum { LONGEST = 1100 };

static void name_of(const abbe_view_session *session, size_t frame, char out[LONGEST]) {
  char ending[48] = "-turn.png";
  if (frame > 0) snprintf(ending, sizeof ending, "-turn-%04zu.png", frame);
  abbe_view_keep_name(session, ending, out, LONGEST);
}

abbe_result abbe_view_turn_begin(abbe_view_session *session, abbe_error *error) {
  char name[LONGEST];
  name_of(session, 0, name);
  ABBE_TRY(abbe_view_keep_rests(session, error));
  ABBE_TRY(abbe_view_keep_check(session, name, error));
  session->turn_frame = 1;
  session->turn_serial = session->state.refine.serial;
  session->turned = false;
  return ABBE_OK;
}

bool abbe_view_turn_wants(const abbe_view_session *session, abbe_view_request *out) {
  if (session->turn_frame == 0 || session->turn_serial != session->state.refine.serial)
    return false;
  out->turns = true;
  out->turn_rad = 2 * ABBE_PI * (double)(session->turn_frame - 1) / ABBE_VIEW_TURN_FRAMES;
  out->job = (abbe_view_job){
      .stage = ABBE_VIEW_ACCURATE, .light = ABBE_VIEW_ACCURATE, .serial = session->turn_serial};
  return true;
}

/* All frames as one. */
static abbe_result write_moving(const abbe_view_session *session, abbe_error *error) {
  char name[LONGEST], frame[ABBE_VIEW_TURN_FRAMES][LONGEST];
  const char *list[ABBE_VIEW_TURN_FRAMES];
  for (size_t i = 0; i < ABBE_VIEW_TURN_FRAMES; i++) {
    name_of(session, i + 1, frame[i]);
    list[i] = frame[i];
  }
  name_of(session, 0, name);
  return abbe_screen_file_move(name, list, ABBE_VIEW_TURN_FRAMES, ABBE_VIEW_TURN_PER_SECOND, error);
}

void abbe_view_turn_take(abbe_view_session *session, const abbe_view_result *result) {
  char name[LONGEST];
  abbe_error error = {0};
  const size_t frame = session->turn_frame;
  if (result->outcome != ABBE_VIEW_DONE || session->turn_serial != session->state.refine.serial) {
    snprintf(session->note, sizeof session->note,
             "the turntable has ended after %zu frames%s%.900s", frame - 1,
             result->sentence[0] != '\0' ? ": " : "", result->sentence);
    session->turn_frame = 0;
    return;
  }
  name_of(session, frame, name);
  abbe_result written = abbe_view_keep_png(session, &result->picture, name, &error);
  if (written == ABBE_OK && frame < ABBE_VIEW_TURN_FRAMES) {
    snprintf(session->note, sizeof session->note, "turntable: %zu of %d", frame,
             ABBE_VIEW_TURN_FRAMES);
    session->turn_frame++;
    return;
  }
  if (written == ABBE_OK) written = write_moving(session, &error);
  session->turned = written == ABBE_OK;
  name_of(session, 0, name);
  if (session->turned)
    snprintf(session->note, sizeof session->note, "kept %.500s and its %d frames", name,
             ABBE_VIEW_TURN_FRAMES);
  else
    snprintf(session->note, sizeof session->note, "%s", error.text);
  session->turn_frame = 0;
}
