#include "cli/view/state/view_state.h"

#include "base/maths.h"
#include "cli/view/state/view_camera.h"
#include "scenes/import/scene_value.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TURN_RAD_PER_PICTURE 3.2 /* radians for a drag over the picture's height */
#define CLICK_PIXELS 3.0

abbe_result abbe_view_state_begin(abbe_view_state *state, const abbe_view_document *document,
                                  abbe_error *error) {
  abbe_view_refine_begin(&state->refine);
  return abbe_view_history_begin(&state->history, document, error);
}

void abbe_view_state_free(abbe_view_state *state) {
  abbe_view_history_free(&state->history);
  abbe_view_outline_free(&state->outline);
}

/* ---- changes ---- */

/* The scene's own camera, with what it was led to. */
static void find_camera(abbe_view_state *state) {
  const abbe_view_document *now = abbe_view_history_now(&state->history);
  state->camera = state->outline.camera;
  abbe_view_document_read(abbe_view_document_value(now, "camera.eye"), state->camera.eye);
  abbe_view_document_read(abbe_view_document_value(now, "camera.target"), state->camera.target);
}

/* Where the light or the object stands; NULL: there is none. */
static const double *place_of(const abbe_view_outline *o, const abbe_view_handle *handle) {
  const bool light = handle->kind == ABBE_VIEW_LIGHT_HANDLE;
  if (handle->index >= (light ? o->light_count : o->object_count)) return NULL;
  return light ? o->light[handle->index].position : o->object[handle->index].middle;
}

/* What is held is pulled from here. */
static void take_hold(abbe_view_state *state) {
  const double *place = place_of(&state->outline, &state->held);
  if (place == NULL) return;
  memcpy(state->held_point, place, sizeof state->held_point);
  memcpy(state->pulled, place, sizeof state->pulled);
}

void abbe_view_state_learn(abbe_view_state *state, abbe_view_outline *outline, bool newest) {
  const abbe_view_document *now = abbe_view_history_now(&state->history);
  const bool held = state->held.kind != ABBE_VIEW_NO_HANDLE;
  if (held && state->dragged) { /* what is held was there; it is seen here */
    const double *place = place_of(outline, &state->held);
    if (place != NULL) memcpy(state->pulled, place, sizeof state->pulled);
    abbe_view_outline_free(outline);
    return;
  }
  abbe_view_outline_own(outline, newest ? now : NULL, &state->outline);
  abbe_view_outline_free(&state->outline);
  state->outline = *outline;
  *outline = (abbe_view_outline){0};
  if (!newest) abbe_view_outline_stand(&state->outline, now);
  find_camera(state);
  if (held) take_hold(state);
}

void abbe_view_state_picture(abbe_view_state *state, const abbe_camera *camera) {
  state->pictured = *camera;
}

static void refuse(abbe_view_state *state, const abbe_error *error) {
  snprintf(state->refusal, sizeof state->refusal, "%.1000s", error->text);
}

static void changed(abbe_view_state *state, abbe_view_change change, double now_s) {
  state->refusal[0] = '\0';
  abbe_view_refine_change(&state->refine, change, now_s);
}

/* The document to be changed, or NULL. */
static abbe_view_document *edit(abbe_view_state *state, bool continued) {
  abbe_view_document *document = NULL;
  abbe_error error = {0};
  if (abbe_view_history_edit(&state->history, continued, &document, &error) == ABBE_OK)
    return document;
  refuse(state, &error);
  return NULL;
}

static bool set(abbe_view_state *state, abbe_view_document *document, const char *key,
                const char *value) {
  abbe_error error = {0};
  if (document == NULL) return false;
  if (abbe_view_document_set(document, key, value, &error) == ABBE_OK) return true;
  refuse(state, &error);
  return false;
}

/* Another stone or metal may be drawn by other programs; what only has moved, or is brighter, is
 * not. */
static abbe_view_change kind_of(const char *key) {
  const char *dot = strrchr(key, '.');
  if (strncmp(key, "camera.", 7) == 0) return ABBE_VIEW_MOVED_CAMERA;
  return dot != NULL && (strcmp(dot, ".material") == 0 || strcmp(dot, ".mirror") == 0)
             ? ABBE_VIEW_CHANGED_SCENE
             : ABBE_VIEW_CHANGED_LIGHT;
}

void abbe_view_state_set(abbe_view_state *state, const char *key, const char *value, bool continued,
                         double now_s) {
  if (set(state, edit(state, continued), key, value)) changed(state, kind_of(key), now_s);
}

void abbe_view_state_settings(abbe_view_state *state, size_t wavelengths, size_t photons,
                              size_t map_size, bool continued, double now_s) {
  abbe_view_document *document = edit(state, continued);
  if (document == NULL) return;
  document->wavelengths = wavelengths;
  document->photons = photons;
  document->map_size = map_size;
  changed(state, ABBE_VIEW_CHANGED_SCENE, now_s);
}

/* What was known of the scene file before is of no use. */
static void leave_scene(abbe_view_state *state) {
  abbe_view_outline_free(&state->outline);
  state->picked = false;
  state->was_held = (abbe_view_handle){0};
}

void abbe_view_state_open(abbe_view_state *state, const char *path, double now_s) {
  abbe_view_document *document = edit(state, false);
  abbe_error error = {0};
  if (document == NULL) return;
  if (abbe_view_document_open(document, path, &error) != ABBE_OK) {
    refuse(state, &error);
    return;
  }
  leave_scene(state);
  changed(state, ABBE_VIEW_CHANGED_SCENE, now_s);
}

void abbe_view_state_reload(abbe_view_state *state, double now_s) {
  changed(state, ABBE_VIEW_CHANGED_SCENE, now_s);
}

static bool step(abbe_view_state *state, bool (*go)(abbe_view_history *), double now_s) {
  const abbe_view_document *before = abbe_view_history_now(&state->history);
  if (!go(&state->history)) return false;
  const abbe_view_document *after = abbe_view_history_now(&state->history);
  const bool camera = abbe_view_document_compare(before, after) == ABBE_VIEW_CAMERA;
  if (strcmp(before->path, after->path) != 0) leave_scene(state);
  abbe_view_outline_stand(&state->outline, after);
  find_camera(state);
  changed(state, camera ? ABBE_VIEW_MOVED_CAMERA : ABBE_VIEW_CHANGED_SCENE, now_s);
  return true;
}

bool abbe_view_state_undo(abbe_view_state *state, double now_s) {
  return step(state, abbe_view_history_undo, now_s);
}

bool abbe_view_state_redo(abbe_view_state *state, double now_s) {
  return step(state, abbe_view_history_redo, now_s);
}

void abbe_view_state_resize(abbe_view_state *state, size_t width, size_t height, double now_s) {
  if (state->width == width && state->height == height) return;
  state->width = width;
  state->height = height;
  state->picked = false;
  abbe_view_refine_change(&state->refine, ABBE_VIEW_MOVED_CAMERA, now_s);
}

/* ---- camera ---- */

/* Where a scene may have its camera, so that what is kept can be opened; and it looks somewhere. */
static bool is_camera(const abbe_camera *c) {
  double to[3], most = 0;
  abbe_vector_subtract(c->target, c->eye, to);
  for (int k = 0; k < 3; k++) most = fmax(most, fmax(fabs(c->eye[k]), fabs(c->target[k])));
  return most <= ABBE_SCENE_FAR && abbe_vector_length(to) > 1e-6 * most;
}

/* The camera as it is led, with what can be written of it. */
static void take_camera(abbe_view_state *state, const abbe_camera *camera, double now_s) {
  abbe_camera c = *camera;
  char eye[96], target[96];
  abbe_view_document_point(c.eye, eye, sizeof eye);
  abbe_view_document_point(c.target, target, sizeof target);
  if (!is_camera(&c)) return;
  abbe_view_document *document = edit(state, state->continued);
  if (!set(state, document, "camera.eye", eye) || !set(state, document, "camera.target", target))
    return;
  state->camera = c;
  state->continued = true;
  changed(state, ABBE_VIEW_MOVED_CAMERA, now_s);
}

static void lead(abbe_view_state *state, double dx, double dy, double now_s) {
  abbe_camera c = state->camera;
  const double x = dx / (double)state->height, y = dy / (double)state->height;
  const bool pans = state->down[ABBE_VIEW_LEFT] && (state->modifiers & ABBE_VIEW_SHIFT) != 0;
  if (state->down[ABBE_VIEW_LEFT] && !pans)
    abbe_view_camera_orbit(&c, -TURN_RAD_PER_PICTURE * x, TURN_RAD_PER_PICTURE * y);
  else if (state->down[ABBE_VIEW_MIDDLE] || pans)
    abbe_view_camera_pan(&c, -x, y);
  else
    abbe_view_camera_look(&c, c.fov_y_rad * x, -c.fov_y_rad * y);
  take_camera(state, &c, now_s);
}

void abbe_view_state_wheel(abbe_view_state *state, double clicks, double now_s) {
  abbe_camera c = state->camera;
  if (state->outline.light_count + state->outline.object_count == 0 || clicks == 0) return;
  abbe_view_camera_zoom(&c, pow(0.9, fmax(-20, fmin(20, clicks))));
  /* turns of the wheel that follow each other are one step */
  state->continued = now_s - state->refine.changed_s < 0.5 && state->refine.serial == state->turned;
  take_camera(state, &c, now_s);
  state->continued = false;
  state->turned = state->refine.serial;
}

void abbe_view_state_tick(abbe_view_state *state, double seconds, double now_s) {
  const double *fly = state->fly;
  if (fly[0] == 0 && fly[1] == 0 && fly[2] == 0) return;
  abbe_camera c = state->camera;
  double to[3], way[3];
  abbe_vector_subtract(c.target, c.eye, to);
  const double pace = 0.7 * abbe_vector_length(to) * fmin(seconds, 0.2);
  for (int k = 0; k < 3; k++) way[k] = pace * fly[k];
  abbe_view_camera_fly(&c, way);
  take_camera(state, &c, now_s);
}

/* ---- handles ---- */

bool abbe_view_state_handle(const abbe_view_state *state, size_t i, abbe_view_handle *out) {
  const abbe_view_outline *o = &state->outline;
  const abbe_view_handle *held = &state->held;
  size_t k = 0;
  if (!(state->pictured.fov_y_rad > 0)) return false; /* there is no picture */
  for (size_t n = 0; n < o->light_count + o->object_count; n++) {
    const bool light = n < o->light_count;
    const size_t at = light ? n : n - o->light_count;
    if (light ? !o->light[at].placed : !o->object[at].thick) continue;
    *out = (abbe_view_handle){light ? ABBE_VIEW_LIGHT_HANDLE : ABBE_VIEW_OBJECT_HANDLE, at, {0, 0}};
    const bool pulled = state->dragged && held->kind == out->kind && held->index == at;
    if (!abbe_view_camera_project(&state->pictured, state->width, state->height,
                                  pulled ? state->pulled : place_of(o, out), out->xy))
      continue;
    if (out->xy[0] < 0 || out->xy[1] < 0 || out->xy[0] > (double)state->width ||
        out->xy[1] > (double)state->height)
      continue;
    if (k++ == i) return true;
  }
  return false;
}

abbe_view_handle abbe_view_state_handle_at(const abbe_view_state *state, double x, double y) {
  abbe_view_handle handle, nearest = {0};
  double best = ABBE_VIEW_HANDLE_PIXELS;
  for (size_t i = 0; state->height > 0 && abbe_view_state_handle(state, i, &handle); i++) {
    const double away = hypot(handle.xy[0] - x, handle.xy[1] - y);
    if (!(away <= best)) continue;
    best = away;
    nearest = handle;
  }
  return nearest;
}

static void set_object(abbe_view_state *state, const abbe_view_object *object, double tilt_rad,
                       const double axis[3], const double translate[3], double now_s) {
  char key[ABBE_VIEW_KEY + 16], value[2048];
  snprintf(key, sizeof key, "%s.transform", object->key);
  if (!abbe_view_outline_transform(object, tilt_rad, axis, translate, value, sizeof value)) return;
  abbe_view_document *document = edit(state, state->continued);
  if (!set(state, document, key, value)) return;
  const struct {
    bool there;
    const char *name;
  } others[] = {{object->fitted, "fit"},
                {object->sized, "width"},
                {object->centred, "centre"},
                {object->stands, "stand"}};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    snprintf(key, sizeof key, "%s.%s", object->key, others[i].name);
    if (others[i].there && !set(state, document, key, "")) return;
  }
  state->continued = true;
  changed(state, ABBE_VIEW_CHANGED_LIGHT, now_s);
}

/* Tilts about the view's own axes: what is dragged up turns away. `before` stays what it was when
 * the drag began, for the outline is learnt anew only when it is over. */
static void tilt(abbe_view_state *state, const abbe_view_object *object, double now_s) {
  const double dx = state->at[0] - state->from[0], dy = state->at[1] - state->from[1];
  double forward[3], right[3], axis[3], up[3];
  abbe_vector_subtract(state->camera.target, state->camera.eye, forward);
  abbe_vector_cross(forward, state->camera.up, right);
  memcpy(up, state->camera.up, sizeof up);
  if (!abbe_vector_normalise(right) || !abbe_vector_normalise(up)) return;
  for (int k = 0; k < 3; k++) axis[k] = dx * up[k] + dy * right[k];
  if (!abbe_vector_normalise(axis)) return;
  set_object(state, object, hypot(dx, dy) * TURN_RAD_PER_PICTURE / (double)state->height, axis,
             object->translate, now_s);
}

static void pull(abbe_view_state *state, double now_s) {
  const abbe_view_outline *o = &state->outline;
  const bool upright = (state->modifiers & ABBE_VIEW_SHIFT) != 0;
  double point[3];
  const bool light = state->held.kind == ABBE_VIEW_LIGHT_HANDLE;
  if (state->held.index >= (light ? o->light_count : o->object_count)) return;
  if (!light && (state->modifiers & ABBE_VIEW_CONTROL) != 0) {
    tilt(state, &o->object[state->held.index], now_s);
    return;
  }
  if (!abbe_view_camera_drag(&state->camera, state->width, state->height,
                             upright ? ABBE_VIEW_DRAG_UPRIGHT : ABBE_VIEW_DRAG_LEVEL,
                             state->held_point, state->from, state->at, point))
    return;
  if (light) {
    char key[ABBE_VIEW_KEY + 16], value[96];
    const abbe_view_light *held = &o->light[state->held.index];
    const bool sun = held->kind == ABBE_LIGHT_DIRECTIONAL;
    snprintf(key, sizeof key, "%s.%s", held->key, sun ? "direction" : "position");
    for (int k = 0; k < 3 && sun; k++) point[k] = held->aim[k] - point[k];
    abbe_view_document_point(point, value, sizeof value);
    abbe_view_state_set(state, key, value, state->continued, now_s);
    state->continued = true;
    return;
  }
  const abbe_view_object *object = &o->object[state->held.index];
  for (int k = 0; k < 3; k++) point[k] += object->translate[k] - state->held_point[k];
  set_object(state, object, 0, point, point, now_s);
}

static bool any_down(const abbe_view_state *state) {
  return state->down[0] || state->down[1] || state->down[2];
}

/* Lets an object of the outline down, or lifts it, onto the flat receiver below it, as a step;
 * where there is none, or it was tilted just now, the refusal says so. */
static void view_state_set_down(abbe_view_state *state, size_t index, double now_s) {
  const abbe_view_object *object = &state->outline.object[index];
  double to[3];
  if (index >= state->outline.object_count || any_down(state)) return;
  if (!isfinite(object->above)) {
    snprintf(state->refusal, sizeof state->refusal,
             "'%.70s' is not dropped: nothing flat that receives light is known below it",
             object->name);
    return;
  }
  memcpy(to, object->translate, sizeof to);
  to[2] -= object->above;
  state->continued = false;
  set_object(state, object, 0, to, to, now_s);
  state->continued = false;
  abbe_view_outline_stand(&state->outline, abbe_view_history_now(&state->history));
}

/* ---- pointer and keys ---- */

void abbe_view_state_press(abbe_view_state *state, abbe_view_button button, double x, double y,
                           int modifiers, double now_s) {
  if (state->width == 0 || state->height == 0) return;
  const double xy[2] = {x, y};
  memcpy(state->from, xy, sizeof xy);
  memcpy(state->at, xy, sizeof xy);
  state->down[button] = true;
  state->dragged = state->continued = false;
  state->modifiers = modifiers;
  state->held = (abbe_view_handle){0};
  if (button == ABBE_VIEW_LEFT) state->held = abbe_view_state_handle_at(state, x, y);
  if (state->held.kind != ABBE_VIEW_NO_HANDLE) take_hold(state);
  abbe_view_refine_hold(&state->refine, true, now_s);
}

void abbe_view_state_move(abbe_view_state *state, double x, double y, double now_s) {
  const double dx = x - state->at[0], dy = y - state->at[1];
  const bool known = state->outline.light_count + state->outline.object_count > 0;
  if (!any_down(state) || !known) return;
  if (!state->dragged && hypot(x - state->from[0], y - state->from[1]) < CLICK_PIXELS) return;
  state->dragged = true;
  state->at[0] = x;
  state->at[1] = y;
  if (state->held.kind != ABBE_VIEW_NO_HANDLE)
    pull(state, now_s);
  else
    lead(state, dx, dy, now_s);
}

void abbe_view_state_release(abbe_view_state *state, abbe_view_button button, double now_s) {
  const bool clicked = state->down[button] && !state->dragged && button == ABBE_VIEW_LEFT;
  state->down[button] = false;
  if (any_down(state)) return;
  /* what was pulled stands where it was left also before a job has reported it */
  if (state->dragged)
    abbe_view_outline_stand(&state->outline, abbe_view_history_now(&state->history));
  state->continued = false;
  if (state->held.kind == ABBE_VIEW_OBJECT_HANDLE) state->was_held = state->held;
  state->held = (abbe_view_handle){0};
  memset(state->fly, 0, sizeof state->fly);
  abbe_view_refine_hold(&state->refine, false, now_s);
  if (!clicked || state->from[0] < 0 || state->from[1] < 0 ||
      state->from[0] >= (double)state->width || state->from[1] >= (double)state->height)
    return;
  state->picked = true;
  state->pixel[0] = (size_t)state->from[0];
  state->pixel[1] = (size_t)state->from[1];
  state->refine.spectrum = true;
}

bool abbe_view_state_key(abbe_view_state *state, int key, bool down, int modifiers, double now_s) {
  static const char flying[] = "adqewsADQEWS"; /* right, up, forward: back and forth */
  static const int axis[] = {0, 0, 1, 1, 2, 2}, sign[] = {-1, 1, -1, 1, 1, -1};
  const char *found = key != '\0' ? strchr(flying, key) : NULL;
  if ((modifiers & ABBE_VIEW_CONTROL) != 0) {
    if (!down) return false;
    if (key == 'z' && (modifiers & ABBE_VIEW_SHIFT) == 0) return abbe_view_state_undo(state, now_s);
    return (key == 'y' || key == 'z') && abbe_view_state_redo(state, now_s);
  }
  if (found != NULL && (state->down[ABBE_VIEW_RIGHT] || !down)) {
    const int i = (int)(found - flying) % 6;
    state->fly[axis[i]] = down ? sign[i] : 0;
    return true;
  }
  if (!down) return false;
  switch (key) {
  case 'b': /* A and B */
    state->shown = state->shown == ABBE_VIEW_TRACED_PICTURE ? ABBE_VIEW_RENDERED_PICTURE
                                                            : ABBE_VIEW_TRACED_PICTURE;
    return true;
  case 'v':
    state->shown = state->shown == ABBE_VIEW_DIFFERENCE_PICTURE ? ABBE_VIEW_RENDERED_PICTURE
                                                                : ABBE_VIEW_DIFFERENCE_PICTURE;
    return true;
  case 'g': /* what was held last, else the first that has a ring */
    for (size_t i = 0; state->was_held.kind == ABBE_VIEW_NO_HANDLE; i++) {
      if (i >= state->outline.object_count) return false;
      if (state->outline.object[i].thick)
        state->was_held = (abbe_view_handle){ABBE_VIEW_OBJECT_HANDLE, i, {0, 0}};
    }
    view_state_set_down(state, state->was_held.index, now_s);
    return true;
  case '+':
    state->exposure = fmin(state->exposure + 0.5, 20);
    return true;
  case '-':
    state->exposure = fmax(state->exposure - 0.5, -20);
    return true;
  default:
    return false;
  }
}
