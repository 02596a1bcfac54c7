#include "validation/tracer/map_texels.h"

#include "validation/transport/side_by_side.h"

#include <stdbool.h>

enum { LANES = ABBE_MAP_TEXELS_LANES, STEPS = ABBE_MAP_LAYOUT_STEPS };

/* Window coordinates; below 0 where the map does not hold the place. */
SIDE_BY_SIDE static void project(const abbe_view *view, const abbe_map_texels *t,
                                 double window[2][LANES]) {
  const abbe_view v = *view;
  const double width = v.window[1] - v.window[0], height = v.window[3] - v.window[2];
  const int parallel = v.orthographic;
  for (int k = 0; k < LANES; k++) {
    const double x = t->p[0][k] - v.origin[0], y = t->p[1][k] - v.origin[1],
                 z = t->p[2][k] - v.origin[2];
    const double depth = x * v.forward[0] + y * v.forward[1] + z * v.forward[2];
    const double scale = parallel ? 1 : depth;
    const double right = (x * v.right[0] + y * v.right[1] + z * v.right[2]) / scale;
    const double up = (x * v.up[0] + y * v.up[1] + z * v.up[2]) / scale;
    const double a = (right - v.window[0]) / width, b = (up - v.window[2]) / height;
    const bool inside = (scale > 0) & (a >= 0) & (a <= 1) & (b >= 0) & (b <= 1);
    window[0][k] = inside ? a : -1;
    window[1][k] = b;
  }
}

/* The texel along an axis of so many, of a window coordinate in [0, 1]. */
static inline size_t texel_at(const double *knot, double window, size_t side) {
  const double s = window * STEPS;
  const int k = s < STEPS ? (int)s : STEPS - 1;
  const double at = (knot[k] + (s - k) * (knot[k + 1] - knot[k])) * (double)side;
  return at < (double)side ? (size_t)at : side - 1;
}

void abbe_map_texels_find(const abbe_map_layout *layout, size_t width, size_t height,
                          abbe_map_texels *t) {
  double window[2][LANES];
  project(&layout->view, t, window);
  for (int k = 0; k < LANES; k++) {
    t->at[k] = ABBE_MAP_TEXELS_NONE;
    if (!(window[0][k] >= 0)) continue;
    const size_t column = texel_at(layout->knot[0], window[0][k], width);
    const size_t row = height - 1 - texel_at(layout->knot[1], window[1][k], height);
    t->at[k] = row * width + column;
  }
}
