#include "gl/caustics/cell_fit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A light's photon cells no finer than its map can tell: where the images of nearly all cells are
 * thinner than this, a coarser grid lays the same light with fewer splats. In texels, and the
 * share of the light whose cells count. */
static const double least_image = 2, counted_share = 0.95;
enum { LEAST_CELLS = 16, STEP_BINS = 256 };

typedef struct batch_view {
  const abbe_receiver_atlas *atlas;
  const abbe_map_layout *map;
  double texels;
  const float *hit;     /* [photons][orders][stride][4] */
  const GLuint *path;   /* the same without the last */
  const GLuint *photon; /* [photons][ABBE_PHOTON_BYTES / 4] */
  size_t photons, orders, stride; /* of which the first is traced */
  const GLuint *slot; /* [cells], photon + 1 */
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
static double part_of(const batch_view *b) {
  float most = 0;
  for (size_t i = 0; i < b->photons * b->orders * b->stride; i++)
    most = fmaxf(most, b->hit[4 * i + 3]);
  return most > 0 ? (double)most / (1 << 24) : 1;
}

/* Light by how far, in texels, the next cell's hit on the same path lies from this one's. */
static void sort_steps(const batch_view *b, int axis, double histogram[STEP_BINS]) {
  double part = part_of(b);
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
    if (step > 0 && cells < (double)most)
      out[axis] = cells < (double)least ? least : (size_t)cells;
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
  abbe_result result = abbe_photon_start_run(trace->start, light, error);
  if (result != ABBE_OK) return result;
  abbe_trace_pass_batch(trace, light, middle, 1, plan->desc.wavelengths);
  result = abbe_trace_pass_read(trace, light, middle, &hit, &path, error);
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
