#include "gl/plan/examine/light_views.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

/* A parallelogram's corners, one more for each side of the light's window and one for the
 * camera. */
enum { MAX_CORNERS = 12 };

/* Share of a window's width: shaders round where they look up what it holds. */
static const double rounding = 1e-4;

static const int margin = 2;

typedef struct polygon {
  double at[MAX_CORNERS][3];
  size_t count;
} polygon;

/* Keeps what has n . (x - origin) >= d, by Sutherland and Hodgman. */
static void clip(const double n[3], const double origin[3], double d, polygon *p) {
  polygon kept = {.count = 0};
  for (size_t i = 0; i < p->count; i++) {
    const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
    double from[3], to[3];
    abbe_vector_subtract(a, origin, from);
    abbe_vector_subtract(b, origin, to);
    const double before = abbe_vector_dot(n, from) - d, after = abbe_vector_dot(n, to) - d;
    if (before >= 0 && kept.count < MAX_CORNERS) memcpy(kept.at[kept.count++], a, sizeof from);
    if ((before >= 0) == (after >= 0) || kept.count == MAX_CORNERS) continue;
    const double t = before / (before - after);
    for (int k = 0; k < 3; k++) kept.at[kept.count][k] = a[k] + t * (b[k] - a[k]);
    kept.count++;
  }
  *p = kept;
}

/* One side of a view's window: sign 1 keeps what is above the bound, -1 below. */
static void clip_side(const abbe_view *view, const double axis[3], double bound, double sign,
                      polygon *p) {
  double n[3];
  for (int k = 0; k < 3; k++)
    n[k] = sign * (axis[k] - (view->orthographic ? 0 : bound * view->forward[k]));
  clip(n, view->origin, view->orthographic ? sign * bound : 0, p);
}

bool abbe_lit_window_cone(const abbe_light *light, abbe_view *out) {
  static const double up[3] = {0, 0, 1};
  if (light->kind != ABBE_LIGHT_SPOT || !(light->cone_rad < ABBE_LIT_WINDOW_MAX_CONE)) return false;
  const double t = tan(light->cone_rad), window[4] = {-t, t, -t, t};
  abbe_view_look(light->position, light->direction, up, false, out);
  memcpy(out->window, window, sizeof window);
  return true;
}

bool abbe_lit_window(const abbe_view *light, const abbe_view *eye, const double parallelogram[9],
                     size_t width, size_t height, int out[4]) {
  polygon p = {.count = 4};
  for (int c = 0; c < 4; c++) /* around */
    for (int k = 0; k < 3; k++)
      p.at[c][k] = parallelogram[k] + (c == 1 || c == 2 ? parallelogram[3 + k] : 0) +
                   (c >= 2 ? parallelogram[6 + k] : 0);
  for (int axis = 0; axis < 2; axis++) {
    const double *side = axis == 0 ? light->right : light->up, *bound = light->window + 2 * axis;
    const double room = rounding * (bound[1] - bound[0]);
    clip_side(light, side, bound[0] - room, 1, &p);
    clip_side(light, side, bound[1] + room, -1, &p);
  }
  clip(eye->forward, eye->origin, eye->orthographic ? -INFINITY : 0.5 * eye->near, &p);
  const double size[2] = {(double)width, (double)height};
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (size_t i = 0; i < p.count; i++) {
    double uvz[3];
    abbe_view_project(eye, p.at[i], uvz);
    for (int axis = 0; axis < 2; axis++) {
      low[axis] = fmin(low[axis], uvz[axis] * size[axis]);
      high[axis] = fmax(high[axis], uvz[axis] * size[axis]);
    }
  }
  for (int axis = 0; axis < 2; axis++) {
    out[axis] = (int)fmin(fmax(floor(low[axis]) - margin, 0), size[axis]);
    out[2 + axis] = (int)fmin(fmax(ceil(high[axis]) + margin, 0), size[axis]);
  }
  return p.count > 0 && out[0] < out[2] && out[1] < out[3];
}
