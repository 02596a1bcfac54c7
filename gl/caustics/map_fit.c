#include "gl/caustics/map_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Share of the light that may fall outside the fitted map, on each of its four sides. */
static const double map_tail = 2e-4;

/* The range that leaves map_tail on each side. */
static void tighten(const double *histogram, double total, double *low, double *high) {
  double from = *low, width = (*high - *low) / ABBE_FIT_BINS, sum = 0;
  int first = 0, last = ABBE_FIT_BINS - 1;
  while (first < last && (sum += histogram[first]) <= map_tail * total) first++;
  sum = 0;
  while (last > first && (sum += histogram[last]) <= map_tail * total) last--;
  *low = from + width * first;
  *high = from + width * (last + 1);
}

/* The brightest hit in 2^24 parts. */
static double part_of(const float *hit, size_t count) {
  float most = 0;
  for (size_t i = 0; i < count; i++)
    if (hit[4 * i + 3] > most) most = hit[4 * i + 3];
  return (double)most / (1 << 24);
}

void abbe_map_fit_add(abbe_map_fit *fit, const abbe_receiver_atlas *atlas, const float *hit,
                      const GLuint *path, size_t count) {
  if (fit->part == 0) fit->part = part_of(hit, count);
  if (!(fit->part > 0)) return;
  for (size_t i = 0; i < count; i++) {
    const float *at = hit + 4 * i;
    double p[3] = {at[0], at[1], at[2]}, uvz[3];
    if (!(at[3] > 0) || abbe_receiver_atlas_holds(atlas, path[i])) continue;
    const double parts = rint(at[3] / fit->part);
    const bool before = abbe_view_project(fit->view, p, uvz);
    if (!before || uvz[0] < 0 || uvz[0] > 1 || uvz[1] < 0 || uvz[1] > 1) fit->outside += parts;
    if (!before) continue;
    fit->total += parts;
    for (int axis = 0; axis < 2; axis++) {
      double bin = fmin(fmax(floor(uvz[axis] * ABBE_FIT_BINS), 0), ABBE_FIT_BINS - 1);
      fit->bin[axis][(int)bin] += parts;
    }
  }
}

/* The histogram of a window's range [low, high], sorted again into the steps of [from, to]. */
static void resort(const double *histogram, double low, double high, double from, double to,
                   double share[ABBE_WARP_STEPS]) {
  memset(share, 0, ABBE_WARP_STEPS * sizeof *share);
  for (int i = 0; i < ABBE_FIT_BINS; i++) {
    double at = low + (high - low) * (i + 0.5) / ABBE_FIT_BINS;
    double step = floor((at - from) / (to - from) * ABBE_WARP_STEPS);
    share[(int)fmin(fmax(step, 0), ABBE_WARP_STEPS - 1)] += histogram[i];
  }
}

enum { NARROW_BLUR = 2, WIDE_BLUR = 8 };

static double blurred(const double share[ABBE_WARP_STEPS], int k, int width) {
  double near = 0, weight = 0;
  for (int j = k - width; j <= k + width; j++) {
    const double w = width + 1 - abs(j - k);
    weight += w;
    if (j >= 0 && j < ABBE_WARP_STEPS) near += w * share[j];
  }
  return near / weight;
}

/* What few photons tell of the light in a step. Where steps differ no more than by chance they are
 * made alike, for at every change of texels' size light is a little off. */
static double light_of(const double share[ABBE_WARP_STEPS], int k) {
  static const double chance = 0.02, sure = 0.05;
  const double narrow = blurred(share, k, NARROW_BLUR), wide = blurred(share, k, WIDE_BLUR);
  const double apart = narrow + wide > 0 ? fabs(narrow - wide) / (narrow + wide) : 0;
  return wide + (narrow - wide) * fmin(fmax((apart - chance) / (sure - chance), 0), 1);
}

/* A share of the texels goes evenly, the rest to where light lands; smooth, so that neighbouring
 * texels are alike. */
static void make_warp(const double share[ABBE_WARP_STEPS], double total,
                      double knot[ABBE_WARP_STEPS + 1]) {
  static const double even = 0.4;
  knot[0] = 0;
  for (int k = 0; k < ABBE_WARP_STEPS; k++)
    knot[k + 1] = knot[k] + even / ABBE_WARP_STEPS + (1 - even) * light_of(share, k) / total;
  const double sum = knot[ABBE_WARP_STEPS];
  for (int k = 1; k <= ABBE_WARP_STEPS; k++) knot[k] /= sum;
}

void abbe_map_fit_layout(const abbe_map_fit *fit, double wider, abbe_map_layout *layout) {
  abbe_view *view = &layout->view;
  double old[4], near = view->near, far = view->far, share[ABBE_WARP_STEPS];
  if (!(fit->total > 0)) return;
  memcpy(old, view->window, sizeof old);
  for (int axis = 0; axis < 2; axis++)
    tighten(fit->bin[axis], fit->total, &view->window[2 * axis], &view->window[2 * axis + 1]);
  abbe_view_pad(view, wider);
  view->near = near;
  view->far = far;
  for (int axis = 0; axis < 2; axis++) {
    resort(fit->bin[axis], old[2 * axis], old[2 * axis + 1], view->window[2 * axis],
           view->window[2 * axis + 1], share);
    make_warp(share, fit->total, layout->knot[axis]);
  }
}

bool abbe_map_fit_serves(const abbe_map_fit *fit) {
  static const double filled = 0.4;
  if (!(fit->total > 0) || fit->outside > 4 * map_tail * fit->total) return false;
  for (int axis = 0; axis < 2; axis++) {
    double low = 0, high = 1;
    tighten(fit->bin[axis], fit->total, &low, &high);
    if (high - low < filled) return false;
  }
  return true;
}
