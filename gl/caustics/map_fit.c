#include "gl/caustics/map_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A light's photon cells no finer than its map resolves: where the images of nearly all cells are
 * thinner than this, a coarser grid lays the same light with fewer splats. In texels, and the
 * share of the light whose cells count. */
static const double least_image = 2, counted_share = 0.95;
enum { LEAST_CELLS = 16, STEP_BINS = 256 };

typedef struct batch_view {
  const abbe_receiver_atlas *atlas;
  const abbe_map_layout *map;
  double texels;
  const float *hit;               /* [photons][orders][stride][4] */
  const GLuint *path;             /* the same without the last */
  const GLuint *photon;           /* [photons][ABBE_PHOTON_BYTES / 4] */
  size_t photons, orders, stride; /* the first of these is traced */
  const GLuint *slot;             /* [cells], photon + 1 */
  size_t cells[2];
} batch_view;

static double warped(const double knot[ABBE_WARP_STEPS + 1], double u) {
  double s = fmin(fmax(u, 0), 1) * ABBE_WARP_STEPS;
  int k = (int)fmin(s, ABBE_WARP_STEPS - 1);
  return knot[k] + (knot[k + 1] - knot[k]) * (s - k);
}

static bool texel_of(const batch_view *b, const float *at, GLuint path, double out[2]) {
  double p[3] = {at[0], at[1], at[2]}, uvz[3];
  if (abbe_receiver_atlas_holds(b->atlas, path)) {
    memcpy(out, p, 2 * sizeof *out);
    return true;
  }
  if (!abbe_view_project(&b->map->view, p, uvz)) return false;
  for (int axis = 0; axis < 2; axis++)
    out[axis] = b->texels * warped(b->map->knot[axis], uvz[axis]);
  return true;
}

/* Bins of a sixteenth of an octave, from 2^-8 texels. */
static int step_bin(double texels) {
  double bin = 16 * (log2(fmax(texels, 1e-9)) + 8);
  return (int)fmin(fmax(bin, 0), STEP_BINS - 1);
}

/* The brightest hit in 2^24 parts: flux is counted in whole ones, whose sums do not depend on
 * the order in which photons are listed. */
static double batch_part(const batch_view *b) {
  float most = 0;
  for (size_t i = 0; i < b->photons * b->orders * b->stride; i++)
    most = fmaxf(most, b->hit[4 * i + 3]);
  return most > 0 ? (double)most / (1 << 24) : 1;
}

/* Light by how far, in texels, the next cell's hit on the same path lies from this one's. */
static void sort_steps(const batch_view *b, int axis, double histogram[STEP_BINS]) {
  double part = batch_part(b);
  for (size_t i = 0; i < b->photons; i++) {
    GLuint cell = b->photon[i * (ABBE_PHOTON_BYTES / 4)];
    size_t at[2] = {cell & 0xffffu, cell >> 16};
    at[axis]++;
    if (at[axis] >= b->cells[axis]) continue;
    GLuint next = b->slot[at[1] * b->cells[0] + at[0]];
    if (next == 0) continue;
    for (size_t order = 0; order < b->orders; order++) {
      size_t here = (i * b->orders + order) * b->stride;
      size_t there = ((next - 1) * b->orders + order) * b->stride;
      double from[2], to[2];
      if (b->path[here] == 0 || b->path[here] != b->path[there] ||
          !texel_of(b, b->hit + 4 * here, b->path[here], from) ||
          !texel_of(b, b->hit + 4 * there, b->path[there], to))
        continue;
      double step = hypot(to[0] - from[0], to[1] - from[1]);
      histogram[step_bin(step)] += rint((double)b->hit[4 * here + 3] / part);
    }
  }
}

/* The step that all but the rest of the light stays under; 0 where there is no light. */
static double common_step(const double histogram[STEP_BINS]) {
  double total = 0, sum = 0;
  for (int i = 0; i < STEP_BINS; i++) total += histogram[i];
  int bin = 0;
  while (bin < STEP_BINS - 1 && (sum += histogram[bin]) < counted_share * total) bin++;
  return total > 0 ? exp2((bin + 1) / 16.0 - 8) : 0;
}

static void choose_cells(const batch_view *b, size_t most, size_t out[2]) {
  for (int axis = 0; axis < 2; axis++) {
    double histogram[STEP_BINS] = {0};
    sort_steps(b, axis, histogram);
    double step = common_step(histogram), cells = ceil((double)b->cells[axis] * step / least_image);
    size_t least = most < LEAST_CELLS ? most : LEAST_CELLS;
    out[axis] = most;
    if (step > 0 && cells < (double)most) out[axis] = cells < (double)least ? least : (size_t)cells;
  }
}

static GLuint *read_words(const abbe_gl *gl, GLuint buffer, size_t offset, size_t words) {
  GLuint *data = malloc(words * 4 + 4);
  if (data == NULL) return NULL;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, (GLintptr)offset, (GLsizeiptr)(words * 4), data);
  return data;
}

abbe_result abbe_cell_fit_run(abbe_trace_pass *trace, abbe_photon_lights *views, size_t light,
                              abbe_error *error) {
  const abbe_plan *plan = views->scene->plan;
  const abbe_gl *gl = views->scene->gpu->gl;
  abbe_photon_light *view = &views->light[light];
  const size_t middle = plan->desc.wavelengths / 2;
  float *hit = NULL;
  GLuint *path = NULL;
  ABBE_TRY(abbe_photon_start_run(trace->start, light, error));
  abbe_trace_pass_batch(trace, light, middle, 1, plan->desc.wavelengths);
  abbe_result result = abbe_trace_pass_read(trace, light, middle, &hit, &path, error);
  GLuint *photon = read_words(gl, trace->start->photons, ABBE_PHOTON_HEADER,
                              view->photon_count * (ABBE_PHOTON_BYTES / 4));
  GLuint *slot = read_words(gl, trace->start->photon_of_cell, 0, view->cells[0] * view->cells[1]);
  if (result == ABBE_OK && (photon == NULL || slot == NULL))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fit the photons' cells");
  if (result == ABBE_OK) {
    batch_view b = {.atlas = trace->atlas,
                    .map = &view->map,
                    .texels = (double)plan->desc.map_size,
                    .hit = hit,
                    .path = path,
                    .photon = photon,
                    .photons = view->photon_count,
                    .orders = plan->hit_slots,
                    .stride = trace->hits.stride,
                    .slot = slot,
                    .cells = {view->cells[0], view->cells[1]}};
    choose_cells(&b, abbe_photon_lights_photons(views->scene, light), view->cells);
  }
  free(hit);
  free(path);
  free(photon);
  free(slot);
  return result;
}

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

/* Where a hit lies in the fit's window, if the view holds it at all. */
static bool place_of(const abbe_map_fit *fit, const float hit[4], double out[3]) {
  const double p[3] = {hit[0], hit[1], hit[2]};
  return abbe_view_project(fit->view, p, out);
}

static void add_light(abbe_map_fit *fit, const double at[2], double parts) {
  if (fmin(at[0], at[1]) < 0 || fmax(at[0], at[1]) > 1) fit->outside += parts;
  fit->total += parts;
  for (int axis = 0; axis < 2; axis++) {
    const double bin = fmin(fmax(floor(at[axis] * ABBE_FIT_BINS), 0), ABBE_FIT_BINS - 1);
    fit->bin[axis][(int)bin] += parts;
  }
}

/* Evenly from a place to halfway to another, which the path's next wavelength reaches. */
static void add_spectrum(abbe_map_fit *fit, const double from[2], const double to[2],
                         double parts) {
  enum { STEP = 16, MOST = 16 };
  const double apart = 0.5 * fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1])) * ABBE_FIT_BINS;
  const int count = (int)fmin(fmax(ceil(apart / STEP), 1), MOST);
  double given = 0;
  for (int i = 0; i < count; i++) {
    const double t = 0.5 * (i + 0.5) / count, upto = rint(parts * (i + 1) / count);
    const double at[2] = {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
    add_light(fit, at, upto - given);
    given = upto;
  }
}

void abbe_map_fit_add(abbe_map_fit *fit, const abbe_receiver_atlas *atlas, const float *hit,
                      const GLuint *path, size_t count, size_t stride) {
  if (fit->part == 0) fit->part = part_of(hit, count);
  if (!(fit->part > 0)) return;
  for (size_t i = 0; i < count; i++) {
    double at[3];
    if (!(hit[4 * i + 3] > 0) || abbe_receiver_atlas_holds(atlas, path[i])) continue;
    const double parts = rint(hit[4 * i + 3] / fit->part), half = floor(0.5 * parts);
    if (!place_of(fit, hit + 4 * i, at)) {
      fit->outside += parts;
      continue;
    }
    for (int side = 0; side < 2; side++) {
      const bool ends = side == 0 ? i % stride == 0 : (i + 1) % stride == 0;
      const size_t next = ends ? i : side == 0 ? i - 1 : i + 1;
      double to[3];
      if (path[next] != path[i] || !(hit[4 * next + 3] > 0) || !place_of(fit, hit + 4 * next, to))
        memcpy(to, at, sizeof to);
      add_spectrum(fit, at, to, side == 0 ? half : parts - half);
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

/* The light in a step by few photons. Where steps differ no more than by chance they are
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
