#define _XOPEN_SOURCE 700 /* j0, j1 */
#include "scenes/shapes/water.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define GRAVITY 9.80665
#define TENSION (0.0728 / 998.2) /* m3/s2, over the density */
#define VISCOSITY 1.0e-6         /* m2/s */
#define WAVE_CELLS 16            /* a wavelength, where nothing is asked for */
#define SLOWEST 0.15 /* m/s: below every group's speed on water of a centimetre and more */

double abbe_water_frequency(double k, double depth) {
  return sqrt((GRAVITY * k + TENSION * k * k * k) * tanh(k * depth));
}

/* --- rings --- */

/* A drop's surface by the distance from it: height and slope at steps of `step`. */
typedef struct ring {
  double at[2], step;
  size_t count;
  double *height, *slope;
} ring;

/* Hankel's integral of the crater, each wavenumber at its own frequency [Lamb1932, 255], damped as
 * clean deep water is [Lamb1932, 348]. The steps in k stand for a round basin that is so wide that
 * its walls are not heard of. */
static void sum_ring(const abbe_water_drop *drop, double depth, double age, ring *out) {
  const double a2 = drop->radius * drop->radius, most = 8 / drop->radius;
  const double reach = out->step * (double)out->count;
  const double speed = sqrt(GRAVITY * depth) + 1.5 * sqrt(TENSION * most);
  const double dk = ABBE_PI / (reach + speed * age + 8 * drop->radius);
  for (double k = 0.5 * dk; k < most; k += dk) {
    const double share = drop->depth * a2 * a2 / 8 * k * k * k * exp(-0.25 * k * k * a2) * dk *
                         exp(-2 * VISCOSITY * k * k * age) *
                         cos(abbe_water_frequency(k, depth) * age);
    for (size_t i = 0; i < out->count; i++) {
      out->height[i] -= share * j0(k * out->step * (double)i);
      out->slope[i] += share * k * j1(k * out->step * (double)i);
    }
  }
}

static abbe_result make_ring(const abbe_water_drop *drop, const double size[3], double age,
                             ring *out, abbe_error *error) {
  double far[2];
  for (int k = 0; k < 2; k++) far[k] = 0.5 * size[k] + fabs(drop->at[k]);
  memcpy(out->at, drop->at, sizeof out->at);
  out->step = drop->radius / 8;
  out->count = (size_t)(hypot(far[0], far[1]) / out->step) + 3;
  out->height = calloc(2 * out->count, sizeof *out->height);
  if (out->height == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a ring");
  out->slope = out->height + out->count;
  sum_ring(drop, size[2], age, out);
  return ABBE_OK;
}

/* Hermite's cubic between two steps. */
static void add_ring(const ring *r, const double at[2], double *height, double slope[2]) {
  const double x = at[0] - r->at[0], y = at[1] - r->at[1], far = hypot(x, y), u = far / r->step;
  const size_t i = (size_t)u;
  if (i + 1 >= r->count) return;
  const double t = u - (double)i, s = 1 - t;
  const double h[2] = {r->height[i], r->height[i + 1]};
  const double d[2] = {r->slope[i] * r->step, r->slope[i + 1] * r->step};
  *height += s * s * ((1 + 2 * t) * h[0] + t * d[0]) + t * t * ((1 + 2 * s) * h[1] - s * d[1]);
  if (!(far > 0)) return;
  const double along =
      (6 * s * t * (h[1] - h[0]) + s * (1 - 3 * t) * d[0] - t * (1 - 3 * s) * d[1]) / r->step;
  slope[0] += along * x / far;
  slope[1] += along * y / far;
}

/* --- the surface --- */

typedef struct surface {
  const abbe_water *water;
  size_t rings;
  ring ring[ABBE_WATER_MOST_DROPS];
} surface;

static void surface_free(surface *s) {
  for (size_t i = 0; i < s->rings; i++) free(s->ring[i].height);
}

static void height_at(const surface *s, const double at[2], double *height, double normal[3]) {
  const abbe_water *w = s->water;
  double slope[2] = {0, 0};
  *height = 0;
  for (size_t i = 0; i < w->wave_count; i++) {
    const abbe_water_wave *wave = &w->wave[i];
    const double k = 2 * ABBE_PI / wave->wavelength;
    const double d[2] = {cos(wave->direction_rad), sin(wave->direction_rad)};
    const double phase = k * (d[0] * at[0] + d[1] * at[1]) -
                         abbe_water_frequency(k, w->size[2]) * w->time + wave->phase_rad;
    *height += wave->amplitude * cos(phase);
    for (int axis = 0; axis < 2; axis++) slope[axis] -= wave->amplitude * k * d[axis] * sin(phase);
  }
  for (size_t i = 0; i < s->rings; i++) add_ring(&s->ring[i], at, height, slope);
  normal[0] = -slope[0];
  normal[1] = -slope[1];
  normal[2] = 1;
  abbe_vector_normalise(normal);
}

/* Splitmix64's finish, as a number in [0, 1). */
static double random_at(uint64_t seed, int64_t index, int axis) {
  uint64_t z = seed * 0x9e3779b97f4a7c15u + 2 * (uint64_t)index + (uint64_t)axis;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static abbe_result add_drop(const abbe_water_drop *drop, surface *s, abbe_error *error) {
  if (s->rings == ABBE_WATER_MOST_DROPS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the rings of more than %u drops are on the water at one time; let fewer "
                          "fall, or more seldom",
                          ABBE_WATER_MOST_DROPS);
  ABBE_TRY(make_ring(drop, s->water->size, s->water->time - drop->time, &s->ring[s->rings], error));
  s->rings++;
  return ABBE_OK;
}

/* Rings last until the slowest waves have left the basin. */
static abbe_result add_drops(const abbe_water *w, surface *s, abbe_error *error) {
  const double lasts = hypot(w->size[0], w->size[1]) / SLOWEST;
  const abbe_water_rain *rain = &w->rain;
  for (size_t i = 0; i < w->drop_count; i++) {
    const double age = w->time - w->drop[i].time;
    if (age >= 0 && age < lasts) ABBE_TRY(add_drop(&w->drop[i], s, error));
  }
  if (!(rain->every > 0)) return ABBE_OK;
  for (int64_t i = (int64_t)floor(w->time / rain->every);; i--) {
    abbe_water_drop drop = {
        .time = (double)i * rain->every, .depth = rain->depth, .radius = rain->radius};
    if (w->time - drop.time >= lasts) break;
    for (int axis = 0; axis < 2; axis++)
      drop.at[axis] = w->size[axis] * (random_at(rain->seed, i, axis) - 0.5);
    ABBE_TRY(add_drop(&drop, s, error));
  }
  return ABBE_OK;
}

/* --- what is possible --- */

static bool is_above(double x) {
  return isfinite(x) && x > 0;
}

static abbe_result refuse(abbe_error *error, const char *what, double value, const char *wanted) {
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "water with %s %g is not possible: %s", what,
                        value, wanted);
}

static abbe_result check_crater(double depth, double radius, abbe_error *error) {
  if (!isfinite(depth)) return refuse(error, "a drop's depth", depth, "it must be finite");
  if (!is_above(radius))
    return refuse(error, "a drop's radius", radius, "it must be a finite length above zero");
  return ABBE_OK;
}

static abbe_result check_numbers(const abbe_water *w, abbe_error *error) {
  for (int k = 0; k < 3; k++)
    if (!is_above(w->size[k]))
      return refuse(error, "a size of", w->size[k], "it must be a finite length above zero");
  for (int k = 0; k < 2; k++)
    if (w->cells[k] > ABBE_WATER_MOST_CELLS)
      return refuse(error, "so many cells:", (double)w->cells[k], "at most 2048 a side");
  if (!isfinite(w->time)) return refuse(error, "a time of", w->time, "it must be finite");
  if (w->wave_count > ABBE_WATER_MOST_WAVES)
    return refuse(error, "so many waves:", (double)w->wave_count, "at most 64");
  for (size_t i = 0; i < w->wave_count; i++) {
    const abbe_water_wave *wave = &w->wave[i];
    if (!is_above(wave->wavelength))
      return refuse(error, "a wavelength of", wave->wavelength, "it must be above zero");
    if (!isfinite(wave->amplitude) || !isfinite(wave->direction_rad) || !isfinite(wave->phase_rad))
      return refuse(error, "a wave of amplitude", wave->amplitude, "its numbers must be finite");
  }
  for (size_t i = 0; i < w->drop_count; i++) {
    const abbe_water_drop *drop = &w->drop[i];
    ABBE_TRY(check_crater(drop->depth, drop->radius, error));
    if (!(isfinite(drop->at[0] + drop->at[1] + drop->time)))
      ABBE_TRY(refuse(error, "a drop at", drop->at[0], "its place and time must be finite"));
  }
  if (w->rain.every == 0) return ABBE_OK;
  if (!is_above(w->rain.every))
    return refuse(error, "rain every", w->rain.every, "seconds between drops are above zero");
  if (fabs(w->time) / w->rain.every > 1e12)
    return refuse(error, "rain at the time", w->time, "so many drops cannot be counted");
  return check_crater(w->rain.depth, w->rain.radius, error);
}

/* The shortest length that cells have to show: a wave's, or twice a drop's radius; 0: none. */
static double shortest(const abbe_water *w) {
  double least = INFINITY;
  for (size_t i = 0; i < w->wave_count; i++) least = fmin(least, w->wave[i].wavelength);
  for (size_t i = 0; i < w->drop_count; i++) least = fmin(least, 2 * w->drop[i].radius);
  if (w->rain.every > 0) least = fmin(least, 2 * w->rain.radius);
  return isfinite(least) ? least : 0;
}

static abbe_result choose_cells(const abbe_water *w, size_t cells[2], abbe_error *error) {
  const double least = shortest(w);
  for (int k = 0; k < 2; k++) {
    cells[k] = w->cells[k];
    if (cells[k] == 0)
      cells[k] = least > 0 ? (size_t)fmin(fmax(ceil(WAVE_CELLS * w->size[k] / least), 1),
                                          ABBE_WATER_MOST_CELLS)
                           : 1;
    if (least > 0 && (double)cells[k] * least < ABBE_WATER_LEAST_CELLS * w->size[k])
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%zu cells over %g m do not show waves of %g m: it takes %d a "
                            "wavelength, so %.0f of at most %u; take longer waves or less water",
                            cells[k], w->size[k], least, ABBE_WATER_LEAST_CELLS,
                            ceil(ABBE_WATER_LEAST_CELLS * w->size[k] / least),
                            ABBE_WATER_MOST_CELLS);
  }
  return ABBE_OK;
}

/* --- the body --- */

static void set_face(abbe_mesh *mesh, size_t *face, size_t a, size_t b, size_t c) {
  const uint32_t corners[3] = {(uint32_t)a, (uint32_t)b, (uint32_t)c};
  memcpy(mesh->face[(*face)++], corners, sizeof corners);
}

static abbe_result make_top(const surface *s, const size_t cells[2], abbe_mesh *out, size_t *face,
                            abbe_error *error) {
  const double *size = s->water->size;
  const size_t row = cells[0] + 1;
  for (size_t j = 0; j <= cells[1]; j++)
    for (size_t i = 0; i < row; i++) {
      double *p = out->position[j * row + i];
      p[0] = size[0] * ((double)i / (double)cells[0] - 0.5);
      p[1] = size[1] * ((double)j / (double)cells[1] - 0.5);
      height_at(s, p, &p[2], out->normal[j * row + i]);
      if (!(p[2] > -size[2]))
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "the waves lay the bottom bare: the water is %g m deep, and its "
                              "surface falls by %g m",
                              size[2], -p[2]);
    }
  for (size_t j = 0; j < cells[1]; j++)
    for (size_t i = 0; i < cells[0]; i++) {
      const size_t a = j * row + i, c = a + row + 1;
      set_face(out, face, a, a + 1, c);
      set_face(out, face, a, c, c - 1);
    }
  return ABBE_OK;
}

/* The rim's vertex after `step` of all steps around, counter-clockwise from the least corner. */
static size_t rim(const size_t cells[2], size_t step) {
  const size_t x = cells[0], y = cells[1], row = x + 1;
  step %= 2 * (x + y);
  if (step < x) return step;
  if (step < x + y) return (step - x) * row + x;
  if (step < 2 * x + y) return y * row + x - (step - x - y);
  return (y - (step - 2 * x - y)) * row;
}

static size_t add_vertex(abbe_mesh *mesh, size_t *vertex, const double p[3], double z,
                         const double normal[3]) {
  double *at = mesh->position[*vertex];
  at[0] = p[0];
  at[1] = p[1];
  at[2] = z;
  memcpy(mesh->normal[*vertex], normal, sizeof *mesh->normal);
  return (*vertex)++;
}

/* Each step of the rim has a wall of its own and a corner of the bottom. */
static void make_walls(const size_t cells[2], double depth, abbe_mesh *out, size_t vertex,
                       size_t *face) {
  static const double outwards[4][3] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  static const double down[3] = {0, 0, -1}, middle[3] = {0, 0, 0};
  const size_t around = 2 * (cells[0] + cells[1]),
               turn[4] = {0, cells[0], cells[0] + cells[1], 2 * cells[0] + cells[1]};
  const size_t centre = add_vertex(out, &vertex, middle, -depth, down), first = vertex;
  for (size_t i = 0; i < around; i++)
    add_vertex(out, &vertex, out->position[rim(cells, i)], -depth, down);
  for (size_t i = 0; i < around; i++)
    set_face(out, face, centre, first + (i + 1) % around, first + i);
  size_t side = 0;
  for (size_t i = 0; i < around; i++) {
    while (side < 3 && i >= turn[side + 1]) side++;
    const double *from = out->position[rim(cells, i)], *to = out->position[rim(cells, i + 1)];
    const size_t a = add_vertex(out, &vertex, from, -depth, outwards[side]);
    const size_t b = add_vertex(out, &vertex, to, -depth, outwards[side]);
    const size_t c = add_vertex(out, &vertex, to, to[2], outwards[side]);
    const size_t d = add_vertex(out, &vertex, from, from[2], outwards[side]);
    set_face(out, face, a, b, c);
    set_face(out, face, a, c, d);
  }
}

abbe_result abbe_water_make(const abbe_water *water, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  size_t cells[2] = {0}, face = 0;
  surface s = {.water = water};
  abbe_result result = check_numbers(water, error);
  if (result == ABBE_OK) result = choose_cells(water, cells, error);
  if (result == ABBE_OK) result = add_drops(water, &s, error);
  if (result == ABBE_OK) {
    const size_t around = 2 * (cells[0] + cells[1]), top = (cells[0] + 1) * (cells[1] + 1);
    result = abbe_mesh_make(top + 1 + 5 * around, 2 * cells[0] * cells[1] + 3 * around, false, out,
                            error);
    if (result == ABBE_OK) result = make_top(&s, cells, out, &face, error);
    if (result == ABBE_OK) make_walls(cells, water->size[2], out, top, &face);
  }
  surface_free(&s);
  if (result != ABBE_OK) abbe_mesh_free(out);
  return result;
}
