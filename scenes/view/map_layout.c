#include "scenes/view/map_layout.h"

#include "base/maths.h"
#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = ABBE_MAP_LAYOUT_STEPS, NUMBER = 26, WARP_TEXT = (STEPS + 1) * NUMBER };

static const char *const view_name = "abbe:map_view", *const light_name = "abbe:map_light";
static const char *const warp_name[2] = {"abbe:map_warp_x", "abbe:map_warp_y"};

void abbe_map_layout_make(const abbe_view *view, abbe_map_layout *out) {
  out->view = *view;
  for (int axis = 0; axis < 2; axis++)
    for (int k = 0; k <= STEPS; k++) out->knot[axis][k] = (double)k / STEPS;
}

/* --- checks --- */

static bool finite_all(const double *v, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(v[i])) return false;
  return true;
}

/* Unit and right-angled to what nine printed digits leave, and right x up = -forward. */
static bool is_frame(const abbe_view *v) {
  static const double tolerance = 1e-6;
  const double *axis[3] = {v->right, v->up, v->forward};
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++)
      if (!(fabs(abbe_vector_dot(axis[i], axis[j]) - (i == j)) <= tolerance)) return false;
  const double *r = v->right, *u = v->up;
  const double back[3] = {r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2],
                          r[0] * u[1] - r[1] * u[0]};
  return abbe_vector_dot(back, v->forward) < 0;
}

static const char *fault_of_view(const abbe_view *v) {
  const double range[2] = {v->near, v->far};
  if (!finite_all(v->origin, 3) || !finite_all(v->right, 3) || !finite_all(v->up, 3) ||
      !finite_all(v->forward, 3) || !finite_all(v->window, 4) || !finite_all(range, 2))
    return "has a number that is not finite";
  if (!is_frame(v)) return "has axes that are not unit, right-angled and right-handed";
  if (!(v->window[0] < v->window[1]) || !(v->window[2] < v->window[3]))
    return "has an empty window; it must be left < right and bottom < top";
  if (!(v->near < v->far) || (!v->orthographic && !(v->near > 0)))
    return "has an empty range; it must be 0 < near < far";
  return NULL;
}

static bool rises(const double knot[STEPS + 1]) {
  bool rising = knot[0] == 0 && knot[STEPS] == 1;
  for (int k = 0; k < STEPS; k++) rising = rising && knot[k] < knot[k + 1];
  return rising;
}

abbe_result abbe_map_layout_check(const abbe_map_layout *layout, abbe_error *error) {
  const char *fault = fault_of_view(&layout->view);
  if (fault != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the map's view %s", fault);
  for (int axis = 0; axis < 2; axis++)
    if (!rises(layout->knot[axis]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the map's texels along %c do not follow one another; their %d knots "
                            "must rise from 0 to 1",
                            axis == 0 ? 'x' : 'y', STEPS + 1);
  return ABBE_OK;
}

static bool near_all(const double *a, const double *b, size_t count, double tolerance) {
  for (size_t i = 0; i < count; i++)
    if (!(fabs(a[i] - b[i]) <= tolerance)) return false;
  return true;
}

bool abbe_map_layout_same(const abbe_map_layout *a, const abbe_map_layout *b) {
  static const double share = 1e-9;
  const abbe_view *v = &a->view, *w = &b->view;
  double width = v->window[1] - v->window[0], height = v->window[3] - v->window[2];
  double size = fmin(width, height);
  /* A perspective window's tangents reach the places at their distance. */
  double length = v->orthographic ? size : fmax(size, 1e-3) * v->near;
  return v->orthographic == w->orthographic && near_all(v->origin, w->origin, 3, share * length) &&
         near_all(v->right, w->right, 3, share) && near_all(v->up, w->up, 3, share) &&
         near_all(v->forward, w->forward, 3, share) &&
         near_all(v->window, w->window, 4, share * size) &&
         near_all(a->knot[0], b->knot[0], STEPS + 1, share) &&
         near_all(a->knot[1], b->knot[1], STEPS + 1, share);
}

static double clamp(double x, double low, double high) {
  return fmin(fmax(x, low), high);
}

double abbe_map_layout_warp(const abbe_map_layout *layout, int axis, double window) {
  const double *knot = layout->knot[axis], s = clamp(window, 0, 1) * STEPS;
  const int k = s < STEPS ? (int)s : STEPS - 1;
  return knot[k] + (s - k) * (knot[k + 1] - knot[k]);
}

double abbe_map_layout_unwarp(const abbe_map_layout *layout, int axis, double texture) {
  const double *knot = layout->knot[axis];
  int low = 0, high = STEPS;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (knot[middle] < texture)
      low = middle;
    else
      high = middle;
  }
  return (low + clamp((texture - knot[low]) / (knot[high] - knot[low]), 0, 1)) / STEPS;
}

bool abbe_map_layout_project(const abbe_map_layout *layout, const double p[3], double uv[2]) {
  double uvz[3];
  if (!abbe_view_project(&layout->view, p, uvz)) return false;
  if (!(uvz[0] >= 0 && uvz[0] <= 1 && uvz[1] >= 0 && uvz[1] <= 1)) return false;
  for (int axis = 0; axis < 2; axis++) uv[axis] = abbe_map_layout_warp(layout, axis, uvz[axis]);
  return true;
}

static size_t index_at(double texture, size_t side) {
  const double at = texture * (double)side;
  return at < (double)side ? (size_t)at : side - 1;
}

bool abbe_map_layout_texel(const abbe_map_layout *layout, size_t width, size_t height,
                           const double p[3], size_t *column, size_t *row) {
  double uv[2];
  if (!abbe_map_layout_project(layout, p, uv)) return false;
  *column = index_at(uv[0], width);
  *row = height - 1 - index_at(uv[1], height);
  return true;
}

void abbe_map_layout_ray(const abbe_map_layout *layout, const double uv[2], double origin[3],
                         double direction[3]) {
  double window[2];
  for (int axis = 0; axis < 2; axis++)
    window[axis] = abbe_map_layout_unwarp(layout, axis, uv[axis]);
  abbe_view_ray(&layout->view, window, origin, direction);
}

double abbe_map_layout_texel_size(const abbe_map_layout *layout, int axis, size_t side,
                                  size_t index) {
  const double *window = layout->view.window + 2 * axis;
  const double share = abbe_map_layout_unwarp(layout, axis, (double)(index + 1) / (double)side) -
                       abbe_map_layout_unwarp(layout, axis, (double)index / (double)side);
  return share * (window[1] - window[0]);
}

/* --- attributes --- */

/* The places of abbe:map_view: a word, and the numbers that follow it. */
typedef struct entry {
  const char *word;
  double *value;
  int count;
} entry;

enum { ENTRIES = 6 };

static void list_entries(abbe_view *v, double range[2], entry out[ENTRIES]) {
  const entry list[ENTRIES] = {{"origin", v->origin, 3}, {"right", v->right, 3},
                               {"up", v->up, 3},         {"forward", v->forward, 3},
                               {"window", v->window, 4}, {"range", range, 2}};
  memcpy(out, list, sizeof list);
}

/* Appends " x" with as few digits as give x back. */
static size_t append_number(char *text, size_t used, double x) {
  int length = 0;
  for (int digits = 9; digits <= 17; digits++) {
    const char *end;
    double back;
    length = abbe_number_format(text + used, NUMBER, " %.*g", digits, x);
    if (abbe_number_read(text + used, &end, &back) && back == x) break;
  }
  return used + (size_t)length;
}

static abbe_result write_all(abbe_map_layout *layout, abbe_image *image, abbe_error *error) {
  char text[WARP_TEXT];
  double range[2] = {layout->view.near, layout->view.far};
  entry list[ENTRIES];
  list_entries(&layout->view, range, list);
  size_t used = (size_t)snprintf(text, sizeof text, "%s",
                                 layout->view.orthographic ? "orthographic" : "perspective");
  for (int i = 0; i < ENTRIES; i++) {
    used += (size_t)snprintf(text + used, sizeof text - used, " %s", list[i].word);
    for (int k = 0; k < list[i].count; k++) used = append_number(text, used, list[i].value[k]);
  }
  ABBE_TRY(abbe_image_set_attribute(image, view_name, text, error));
  for (int axis = 0; axis < 2; axis++) {
    used = 0;
    for (int k = 0; k <= STEPS; k++) used = append_number(text, used, layout->knot[axis][k]);
    ABBE_TRY(abbe_image_set_attribute(image, warp_name[axis], text + 1, error));
  }
  return ABBE_OK;
}

/* Reads count numbers from *at on; false where one is missing. */
static bool take_numbers(const char **at, double *out, int count) {
  for (int i = 0; i < count; i++)
    if (!abbe_number_read(*at, at, &out[i])) return false;
  return true;
}

static bool take_word(const char **at, const char *word) {
  const size_t length = strlen(word);
  while (**at == ' ') ++*at;
  if (strncmp(*at, word, length) != 0) return false;
  *at += length;
  return **at == ' ';
}

static bool parse_view(const char *text, abbe_view *out) {
  double range[2];
  entry list[ENTRIES];
  list_entries(out, range, list);
  out->orthographic = take_word(&text, "orthographic");
  if (!out->orthographic && !take_word(&text, "perspective")) return false;
  for (int i = 0; i < ENTRIES; i++)
    if (!take_word(&text, list[i].word) || !take_numbers(&text, list[i].value, list[i].count))
      return false;
  out->near = range[0];
  out->far = range[1];
  return *text == '\0';
}

static abbe_result read_all(const abbe_image *image, const char *name, abbe_map_layout *out,
                            abbe_error *error) {
  const char *view = abbe_image_attribute_text(image, view_name);
  if (view == NULL)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "%s: there is no attribute %s, so it is no receiver map; 'abbe render "
                          "--save-map' writes one",
                          name, view_name);
  if (!parse_view(view, &out->view))
    return abbe_error_set(error, ABBE_PARSE,
                          "%s: the attribute %s, '%.60s', is not a view; it reads perspective or "
                          "orthographic, then origin, right, up and forward with 3 numbers each, "
                          "window with 4 and range with 2",
                          name, view_name, view);
  for (int axis = 0; axis < 2; axis++) {
    const char *text = abbe_image_attribute_text(image, warp_name[axis]), *at = text;
    if (text == NULL || !take_numbers(&at, out->knot[axis], STEPS + 1) || *at != '\0')
      return abbe_error_set(error, ABBE_PARSE, "%s: the attribute %s is %s; it holds %d numbers",
                            name, warp_name[axis], text == NULL ? "missing" : "broken", STEPS + 1);
  }
  abbe_error why = {0};
  if (abbe_map_layout_check(out, &why) == ABBE_OK) return ABBE_OK;
  return abbe_error_set(error, ABBE_PARSE, "%s: %s", name, why.text);
}

abbe_result abbe_map_layout_write(const abbe_map_layout *layout, const char *light,
                                  abbe_image *image, abbe_error *error) {
  abbe_map_layout copy = *layout;
  ABBE_TRY(abbe_map_layout_check(layout, error));
  ABBE_TRY(write_all(&copy, image, error));
  if (light != NULL) ABBE_TRY(abbe_image_set_attribute(image, light_name, light, error));
  return ABBE_OK;
}

abbe_result abbe_map_layout_read(const abbe_image *image, const char *name, abbe_map_layout *out,
                                 abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_result result = read_all(image, name, out, error);
  if (result != ABBE_OK) memset(out, 0, sizeof *out);
  return result;
}

/* Views of one light: from one place, or along one direction. */
static bool same_light(const abbe_view *a, const abbe_view *b) {
  if (a->orthographic != b->orthographic) return false;
  double apart[3];
  abbe_vector_subtract(a->orthographic ? a->forward : a->origin,
                       a->orthographic ? b->forward : b->origin, apart);
  return abbe_vector_length(apart) <= 1e-6 * (a->orthographic ? 1 : a->near);
}

/* A place on the ray through uv that both views have in front of them. */
static void place_of(const abbe_map_layout *layout, const double uv[2], double p[3]) {
  double direction[3];
  abbe_map_layout_ray(layout, uv, p, direction);
  for (int k = 0; k < 3; k++) p[k] += layout->view.near * direction[k];
}

static bool has_light(const float *texel, size_t channels) {
  for (size_t c = 0; c < channels; c++)
    if (texel[c] != 0) return true;
  return false;
}

typedef struct work {
  const abbe_image *from;
  abbe_map_layout layout; /* layout of from */
  const abbe_map_layout *to;
  size_t width, height, parts;
  double *sum; /* [height][width][channels] */
} work;

static void spread(const work *w, size_t x, size_t y) {
  size_t channels = w->from->channels;
  const float *texel = w->from->data + (y * w->from->width + x) * channels;
  if (!has_light(texel, channels)) return;
  double share = 1 / ((double)w->parts * (double)w->parts);
  for (size_t k = 0; k < w->parts * w->parts; k++) {
    double dx = ((double)(k % w->parts) + 0.5) / (double)w->parts;
    double dy = ((double)(k / w->parts) + 0.5) / (double)w->parts;
    double uv[2] = {((double)x + dx) / (double)w->from->width,
                    1 - ((double)y + dy) / (double)w->from->height};
    double p[3];
    size_t column, row;
    place_of(&w->layout, uv, p);
    if (!abbe_map_layout_texel(w->to, w->width, w->height, p, &column, &row)) continue;
    double *sum = w->sum + (row * w->width + column) * channels;
    for (size_t c = 0; c < channels; c++) sum[c] += share * (double)texel[c];
  }
}

static abbe_result fill(work *w, abbe_image *out, abbe_error *error) {
  size_t count = w->width * w->height * w->from->channels;
  w->sum = calloc(count, sizeof *w->sum);
  if (w->sum == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a map of %zu x %zu texels",
                          w->width, w->height);
  for (size_t y = 0; y < w->from->height; y++)
    for (size_t x = 0; x < w->from->width; x++) spread(w, x, y);
  for (size_t i = 0; i < count; i++) out->data[i] = (float)w->sum[i];
  free(w->sum);
  for (int i = 0; i < 8; i++) out->xy[i] = w->from->xy[i];
  const char *light = abbe_image_attribute_text(w->from, "abbe:map_light");
  return abbe_map_layout_write(w->to, light, out, error);
}

abbe_result abbe_map_resample(const abbe_image *from, const char *name, const abbe_map_layout *to,
                              size_t width, size_t height, size_t parts, abbe_image *out,
                              abbe_error *error) {
  work w = {.from = from, .to = to, .width = width, .height = height, .parts = parts};
  *out = (abbe_image){0};
  if (parts < 1 || parts > ABBE_MAP_RESAMPLE_MAX_PARTS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a texel cannot be cut into %zu parts a side; it may be 1 to %d", parts,
                          ABBE_MAP_RESAMPLE_MAX_PARTS);
  ABBE_TRY(abbe_map_layout_read(from, name, &w.layout, error));
  if (!same_light(&w.layout.view, &to->view))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s is the map of a light in another place than the layout's", name);
  abbe_result result = abbe_image_make(width, height, from->channels,
                                       (const char *const *)from->channel, out, error);
  if (result == ABBE_OK) result = fill(&w, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
