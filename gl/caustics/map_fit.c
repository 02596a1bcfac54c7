/* Where a light's map looks: by where its light lands. */
#include "gl/renderer_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Share of the light that may fall outside the fitted map, on each of its four sides. */
static const double map_tail = 2e-4;

/* Flux by window coordinate, and the range that leaves map_tail on each side. */

static void tighten(const double *histogram, double total, double *low, double *high) {
  double from = *low, width = (*high - *low) / FIT_BINS, sum = 0;
  int first = 0, last = FIT_BINS - 1;
  while (first < last && (sum += histogram[first]) <= map_tail * total) first++;
  sum = 0;
  while (last > first && (sum += histogram[last]) <= map_tail * total) last--;
  *low = from + width * first;
  *high = from + width * (last + 1);
}

/* The brightest landing in 2^24 parts: flux is counted in whole ones, whose sums do not depend on
 * the order in which photons land. */
double abbe_renderer_part_of(const float *landing, size_t count) {
  float most = 0;
  for (size_t i = 0; i < count; i++)
    if (landing[4 * i + 3] > most) most = landing[4 * i + 3];
  return (double)most / (1 << 24);
}

/* Adds landings in the map to the histograms of x and y; returns the flux of all, in parts. */
double abbe_renderer_sort_landings(const abbe_renderer *r, size_t light, const float *landing,
                                   const GLuint *path, size_t count, double part,
                                   double *histogram) {
  const abbe_view *view = &r->light[light].map.view;
  double total = 0;
  for (size_t i = 0; i < count; i++) {
    const float *at = landing + 4 * i;
    double p[3] = {at[0], at[1], at[2]}, uvz[3];
    if (!(at[3] > 0) || abbe_renderer_is_on_page(r, path[i]) || !abbe_view_project(view, p, uvz))
      continue;
    double parts = rint(at[3] / part);
    total += parts;
    for (int axis = 0; axis < 2; axis++) {
      double bin = fmin(fmax(floor(uvz[axis] * FIT_BINS), 0), FIT_BINS - 1);
      histogram[axis * FIT_BINS + (int)bin] += parts;
    }
  }
  return total;
}

/* The histogram of a window's range [low, high], sorted again into the steps of [from, to]. */
static void resort(const double *histogram, double low, double high, double from, double to,
                   double share[WARP_STEPS]) {
  memset(share, 0, WARP_STEPS * sizeof *share);
  for (int i = 0; i < FIT_BINS; i++) {
    double at = low + (high - low) * (i + 0.5) / FIT_BINS;
    double step = floor((at - from) / (to - from) * WARP_STEPS);
    share[(int)fmin(fmax(step, 0), WARP_STEPS - 1)] += histogram[i];
  }
}

/* A share of the texels goes evenly, the rest to where light lands; smooth, so that neighbouring
 * texels are alike. */
enum { WARP_BLUR = 8 };

static void make_warp(const double share[WARP_STEPS], double total, double knot[WARP_STEPS + 1]) {
  static const double even = 0.4;
  double sum = 0;
  knot[0] = 0;
  for (int k = 0; k < WARP_STEPS; k++) {
    double near = 0, weight = 0;
    for (int j = k - WARP_BLUR; j <= k + WARP_BLUR; j++) {
      double w = WARP_BLUR + 1 - abs(j - k);
      weight += w;
      if (j >= 0 && j < WARP_STEPS) near += w * share[j];
    }
    sum += even / WARP_STEPS + (1 - even) * near / (weight * total);
    knot[k + 1] = sum;
  }
  for (int k = 1; k <= WARP_STEPS; k++) knot[k] /= sum;
}

void abbe_renderer_fit_axes(light_state *state, const double *histogram, double total) {
  abbe_view *view = &state->map.view;
  double old[4], near = view->near, far = view->far, share[WARP_STEPS];
  memcpy(old, view->window, sizeof old);
  for (int axis = 0; axis < 2; axis++)
    tighten(histogram + axis * FIT_BINS, total, &view->window[2 * axis],
            &view->window[2 * axis + 1]);
  abbe_view_pad(view, 0.02);
  view->near = near;
  view->far = far;
  for (int axis = 0; axis < 2; axis++) {
    resort(histogram + axis * FIT_BINS, old[2 * axis], old[2 * axis + 1], view->window[2 * axis],
           view->window[2 * axis + 1], share);
    make_warp(share, total, state->map.knot[axis]);
  }
}
