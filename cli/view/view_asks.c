#include "cli/view/view_app.h"

#include "cli/view/state/view_camera.h"

#include <math.h>
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
