#include "gl/scene/receiver_tiles.h"

#include "base/maths.h"
#include "gl/scene/gpu_scene.h"
#include "scenes/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Shares of the light: on each side of a window, and of what may be left without a tile. */
static const double tail = 2e-4, least_rest = 1e-3;
/* Shares of the array layer: a tile gets four times the share that its light is of all, within
 * these; of many tiles the least is half of an equal part. */
static const double least_area = 1.0 / 16, most_area = 1;
/* Below it all rectangles are as small as they may be. */
static const double least_scale = 1e-8;

void abbe_tile_light_add(abbe_tile_light *light, double u, double v, double flux) {
  const double at[2] = {u, v};
  if (!(flux > 0)) return;
  light->flux += flux;
  for (int axis = 0; axis < 2; axis++) {
    double bin = fmin(fmax(floor(at[axis] * ABBE_TILE_BINS), 0), ABBE_TILE_BINS - 1);
    light->bin[axis][(size_t)bin] += flux;
  }
}

/* The range that leaves `tail` on each side and 2 % more, within the parallelogram. */
static void fit_window(const double bin[ABBE_TILE_BINS], double flux, double out[2]) {
  int first = 0, last = ABBE_TILE_BINS - 1;
  double sum = 0;
  while (first < last && (sum += bin[first]) <= tail * flux) first++;
  sum = 0;
  while (last > first && (sum += bin[last]) <= tail * flux) last--;
  const double low = first, high = last + 1, pad = 0.02 * (high - low) + 1;
  out[0] = fmax(low - pad, 0) / ABBE_TILE_BINS;
  out[1] = fmin(high + pad, ABBE_TILE_BINS) / ABBE_TILE_BINS;
}

static size_t align_to(double texels, size_t side, size_t align) {
  const double steps = fmax(rint(texels / (double)align), 1);
  return (size_t)fmin(steps * (double)align, (double)side);
}

/* A rectangle of so many texels that are nearly squares on the receiver. */
static void size_tile(const double p[9], double texels, size_t side, size_t align,
                      abbe_receiver_tile *tile, size_t out[2]) {
  const double width = abbe_vector_length(p + 3) * (tile->window[1] - tile->window[0]);
  const double height = abbe_vector_length(p + 6) * (tile->window[3] - tile->window[2]);
  out[0] = align_to(sqrt(texels * width / height), side, align);
  out[1] = align_to(sqrt(texels * height / width), side, align);
}

/* In rows from below, each as high as its highest tile. False where they do not fit. */
static bool place_tiles(const size_t (*size)[2], size_t side, abbe_receiver_tiles *tiles) {
  size_t x = 0, y = 0, high = 0;
  for (size_t i = 0; i < tiles->count; i++) {
    if (x + size[i][0] > side) {
      x = 0;
      y += high;
      high = 0;
    }
    if (size[i][1] > high) high = size[i][1];
    if (y + high > side) return false;
    const size_t rect[4] = {x, x + size[i][0], y, y + size[i][1]};
    memcpy(tiles->tile[i].rect, rect, sizeof rect);
    x += size[i][0];
  }
  tiles->rows = y + high;
  return true;
}

static void place(abbe_tile_light *const *light, const double (*parallelogram)[9], double total,
                  size_t side, size_t align, abbe_receiver_tiles *tiles) {
  const double layer = (double)side * (double)side;
  for (; tiles->count > 0;
       tiles->count--) { /* the faintest goes where the least sizes do not fit */
    const double least = fmin(least_area, 0.5 / (double)tiles->count);
    for (double scale = 1; scale > least_scale; scale *= 0.9) {
      size_t size[ABBE_RECEIVER_TILES][2];
      for (size_t i = 0; i < tiles->count; i++) {
        abbe_receiver_tile *tile = &tiles->tile[i];
        const double share = 4 * light[tile->chart_side]->flux / total;
        const double area = layer * fmin(fmax(share, least), most_area);
        size_tile(parallelogram[tile->chart_side / 2], scale * area, side, align, tile, size[i]);
      }
      if (place_tiles((const size_t(*)[2])size, side, tiles)) return;
    }
  }
}

void abbe_receiver_tiles_lay_out(abbe_tile_light *const *light, const double (*parallelogram)[9],
                                 size_t count, double total, size_t side, size_t align,
                                 abbe_receiver_tiles *out) {
  double rest = 0;
  memset(out, 0, sizeof *out);
  for (size_t i = 0; i < count; i++) rest += light[i] != NULL ? light[i]->flux : 0;
  if (!(rest > 0)) return;
  for (size_t i = 0; i < count; i++) {
    if (light[i] == NULL) continue;
    size_t at = out->count;
    while (at > 0 && light[out->tile[at - 1].chart_side]->flux < light[i]->flux) at--;
    if (at == ABBE_RECEIVER_TILES) continue;
    if (out->count < ABBE_RECEIVER_TILES) out->count++;
    memmove(&out->tile[at + 1], &out->tile[at], (out->count - 1 - at) * sizeof *out->tile);
    out->tile[at] = (abbe_receiver_tile){.chart_side = i};
  }
  size_t wanted = 0;
  for (; wanted < out->count && rest >= least_rest * total; wanted++) {
    abbe_receiver_tile *tile = &out->tile[wanted];
    const abbe_tile_light *on = light[tile->chart_side];
    for (int axis = 0; axis < 2; axis++)
      fit_window(on->bin[axis], on->flux, tile->window + 2 * axis);
    rest -= on->flux;
  }
  out->count = wanted;
  place(light, parallelogram, total, side, align, out);
}

double abbe_receiver_tile_texel(const abbe_receiver_tile *tile, const double p[9]) {
  double normal[3];
  abbe_vector_cross(p + 3, p + 6, normal);
  return abbe_vector_length(normal) * (tile->window[1] - tile->window[0]) *
         (tile->window[3] - tile->window[2]) /
         ((double)(tile->rect[1] - tile->rect[0]) * (double)(tile->rect[3] - tile->rect[2]));
}

void abbe_receiver_tile_place(const abbe_receiver_tile *tile, const double p[9], double x, double y,
                              double out[3]) {
  const double at[2] = {x, y};
  double uv[2];
  for (int axis = 0; axis < 2; axis++) {
    const double *window = tile->window + 2 * axis;
    const double low = (double)tile->rect[2 * axis], high = (double)tile->rect[2 * axis + 1];
    uv[axis] = window[0] + (window[1] - window[0]) * (at[axis] - low) / (high - low);
  }
  for (int k = 0; k < 3; k++) out[k] = p[k] + uv[0] * p[3 + k] + uv[1] * p[6 + k];
}

void abbe_receiver_tile_pack(const abbe_receiver_tile *tile, const double p[9],
                             float out[ABBE_TILE_FLOATS]) {
  double n[3], dual[2][3], length;
  abbe_vector_cross(p + 3, p + 6, n);
  length = abbe_vector_length(n);
  for (int k = 0; k < 3; k++) n[k] /= length;
  abbe_vector_cross(p + 6, n, dual[0]);
  abbe_vector_cross(n, p + 3, dual[1]);
  for (int axis = 0; axis < 2; axis++) {
    const double low = (double)tile->rect[2 * axis], high = (double)tile->rect[2 * axis + 1];
    const double *window = tile->window + 2 * axis;
    const double scale = (high - low) / (window[1] - window[0]) / length;
    for (int k = 0; k < 3; k++) out[4 * axis + k] = (float)(scale * dual[axis][k]);
    out[4 * axis + 3] =
        (float)(low - scale * (abbe_vector_dot(dual[axis], p) + length * window[0]));
    out[8 + axis] = (float)low;
    out[10 + axis] = (float)high;
  }
  for (int k = 0; k < 3; k++) out[12 + k] = (float)n[k];
  out[15] = (float)abbe_receiver_tile_texel(tile, p);
}

/* The numbers of hits are floats, which count so far. */
enum { MOST_CHARTS = 1 << 22 };

static bool add_charts(abbe_receiver_charts *c, const double (*parallelogram)[9], size_t count,
                       size_t object) {
  void *corners = realloc(c->parallelogram, (c->count + count + 1) * sizeof *c->parallelogram);
  if (corners != NULL) c->parallelogram = corners;
  void *objects = realloc(c->object, (c->count + count + 1) * sizeof *c->object);
  if (objects != NULL) c->object = objects;
  if (corners == NULL || objects == NULL) return false;
  memcpy(c->parallelogram + c->count, parallelogram, count * sizeof *parallelogram);
  for (size_t i = 0; i < count; i++) c->object[c->count + i] = object;
  c->count += count;
  return true;
}

/* How far outside the parallelogram a point lies, in parts of its edges and of their product's
 * root. */
static double distance_to(const double p[9], const double at[3]) {
  double from[3], n[3], dual[2][3], far = 0;
  abbe_vector_subtract(at, p, from);
  abbe_vector_cross(p + 3, p + 6, n);
  const double area2 = abbe_vector_dot(n, n);
  abbe_vector_cross(p + 6, n, dual[0]);
  abbe_vector_cross(n, p + 3, dual[1]);
  for (int axis = 0; axis < 2; axis++) {
    const double u = abbe_vector_dot(from, dual[axis]) / area2;
    far = fmax(far, fmax(-u, u - 1));
  }
  return fmax(far, fabs(abbe_vector_dot(from, n)) / pow(area2, 0.75));
}

/* The parallelogram that each face of an exact receiver is of: the nearest to its middle. */
static void find_sides(const abbe_object *object, size_t first, int32_t *side) {
  const abbe_mesh *mesh = &object->mesh;
  for (size_t i = 0; i < mesh->face_count; i++) {
    const uint32_t *f = mesh->face[i];
    double middle[3], normal[3], across[3], nearest = INFINITY;
    size_t found = 0;
    for (int k = 0; k < 3; k++)
      middle[k] = (mesh->position[f[0]][k] + mesh->position[f[1]][k] + mesh->position[f[2]][k]) / 3;
    for (size_t k = 0; k < object->exact.count; k++) {
      const double far = distance_to(object->exact.parallelogram[k], middle);
      if (far < nearest) found = k;
      nearest = fmin(nearest, far);
    }
    const double *p = object->exact.parallelogram[found];
    abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], normal);
    abbe_vector_cross(p + 3, p + 6, across);
    side[i] = (int32_t)(2 * (first + found)) + (abbe_vector_dot(normal, across) < 0 ? 1 : 0);
  }
}

static abbe_result add_exact(const abbe_object *object, size_t at, int32_t *side,
                             abbe_receiver_charts *c, abbe_error *error) {
  const size_t first = c->count;
  if (!add_charts(c, (const double(*)[9])object->exact.parallelogram, object->exact.count, at))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  find_sides(object, first, side);
  return ABBE_OK;
}

static abbe_result add_mesh(const abbe_object *object, size_t at, int32_t *side,
                            abbe_receiver_charts *c, abbe_error *error) {
  abbe_mesh_charts own = {0};
  const size_t first = c->count;
  abbe_result result = abbe_mesh_charts_make(&object->mesh, &own, error);
  if (result != ABBE_OK) return result;
  if (first + own.count > MOST_CHARTS)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the receivers fall into more than %d flat parts; use smoother meshes",
                            MOST_CHARTS);
  else if (!add_charts(c, (const double(*)[9])own.parallelogram, own.count, at))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; result == ABBE_OK && i < object->mesh.face_count; i++)
    side[i] = own.count > 0 ? (int32_t)(2 * (first + own.face[i])) : 0; /* or nothing is met */
  abbe_mesh_charts_free(&own);
  return result;
}

abbe_result abbe_receiver_charts_make(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_receiver_charts *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  out->face_first = calloc(plan->receiver_count + 1, sizeof *out->face_first);
  if (out->face_first == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; i < plan->receiver_count; i++) {
    out->face_count += scene->object[plan->receiver_object[i]].mesh.face_count;
    out->face_first[i + 1] = out->face_count;
  }
  out->face_side = calloc(out->face_count + 1, sizeof *out->face_side);
  abbe_result result = out->face_side != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (int meshes = 0; meshes < 2; meshes++)
    for (size_t i = 0; i < plan->receiver_count && result == ABBE_OK; i++) {
      const bool exact = plan->receiver_model[i] == ABBE_RECEIVER_EXACT;
      const size_t at = plan->receiver_object[i];
      int32_t *side = out->face_side + out->face_first[i];
      if (exact == (meshes == 0))
        result = (exact ? add_exact : add_mesh)(&scene->object[at], at, side, out, error);
    }
  if (result != ABBE_OK) abbe_receiver_charts_free(out);
  return result;
}

void abbe_receiver_charts_free(abbe_receiver_charts *charts) {
  if (charts == NULL) return;
  free(charts->parallelogram);
  free(charts->object);
  free(charts->face_first);
  free(charts->face_side);
  memset(charts, 0, sizeof *charts);
}
