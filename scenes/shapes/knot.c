#include "scenes/shapes/shape.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

static const double whole = 6.28318530717958648;
enum { STEPS = 720, TURNS = 2, COILS = 3, ALONG = 1250, ACROSS = 100 };

static abbe_knot filled_in(const abbe_knot *knot) {
  abbe_knot k = *knot;
  if (k.turns == 0) k.turns = TURNS;
  if (k.coils == 0) k.coils = COILS;
  if (k.along == 0) k.along = ALONG;
  if (k.across == 0) k.across = ACROSS;
  return k;
}

/* The middle line at t, 0 to whole; its derivative, and the torus's unit normal, across it. */
static void line_at(const abbe_knot *k, double t, double at[3], double along[3], double out[3]) {
  const double p = (double)k->turns, q = (double)k->coils;
  const double cp = cos(p * t), sp = sin(p * t), cq = cos(q * t), sq = sin(q * t);
  const double reach = k->major + k->minor * cq;
  const double place[3] = {reach * cp, reach * sp, k->minor * sq};
  const double moved[3] = {-q * k->minor * sq * cp - p * reach * sp,
                           -q * k->minor * sq * sp + p * reach * cp, q * k->minor * cq};
  const double normal[3] = {cq * cp, cq * sp, sq};
  memcpy(at, place, sizeof place);
  memcpy(along, moved, sizeof moved);
  memcpy(out, normal, sizeof normal);
}

/* The least radius of a circle that touches the line at one place and passes through another. */
double abbe_knot_room(const abbe_knot *knot) {
  const abbe_knot k = filled_in(knot);
  double at[STEPS][3], along[STEPS][3], out[3], least = INFINITY;
  for (int i = 0; i < STEPS; i++) {
    line_at(&k, whole * i / STEPS, at[i], along[i], out);
    abbe_vector_normalise(along[i]);
  }
  for (int i = 0; i < STEPS; i++)
    for (int j = 0; j < STEPS; j++) {
      double to[3], across[3];
      if (i == j) continue;
      abbe_vector_subtract(at[j], at[i], to);
      abbe_vector_cross(to, along[i], across);
      const double high = 2 * abbe_vector_length(across);
      if (high > 0) least = fmin(least, abbe_vector_dot(to, to) / high);
    }
  return least;
}

static void surface_at(const abbe_knot *k, double t, double turn, double place[3]) {
  double at[3], along[3], out[3], side[3];
  line_at(k, t, at, along, out);
  abbe_vector_normalise(along);
  abbe_vector_cross(out, along, side);
  const double tall = 0.5 + 0.5 * cos((double)k->spines * t), back = 0.5 + 0.5 * cos(turn);
  const double spine = k->spines > 0 ? k->spine * tall * tall * pow(back, 4) : 0;
  const double radius = k->radius * (1 + spine);
  for (int c = 0; c < 3; c++)
    place[c] = at[c] + radius * (cos(turn) * out[c] + sin(turn) * side[c]);
}

static void normal_at(const abbe_knot *k, double t, double turn, double out[3]) {
  static const double h = 1e-5;
  double low[3], high[3], u[3], v[3];
  surface_at(k, t - h, turn, low);
  surface_at(k, t + h, turn, high);
  abbe_vector_subtract(high, low, u);
  surface_at(k, t, turn - h, low);
  surface_at(k, t, turn + h, high);
  abbe_vector_subtract(high, low, v);
  abbe_vector_cross(u, v, out);
  abbe_vector_normalise(out);
}

static size_t common_divisor(size_t a, size_t b) {
  while (b != 0) {
    const size_t rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

static abbe_result check(const abbe_knot *k, abbe_error *error) {
  const double length[3] = {k->major, k->minor, k->radius};
  static const char *const what[3] = {"major radius", "minor radius", "radius"};
  for (int i = 0; i < 3; i++)
    if (!isfinite(length[i]) || !(length[i] > 0))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "a knot with %s %g is not possible: it must be a finite length above "
                            "zero",
                            what[i], length[i]);
  if (k->minor >= k->major)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "a knot around a torus whose tube (%g) is as wide as its middle line (%g) "
        "has no hole to wind through; the minor radius must be the smaller",
        k->minor, k->major);
  if (k->turns > ABBE_KNOT_MAX_WINDINGS || k->coils > ABBE_KNOT_MAX_WINDINGS ||
      common_divisor(k->turns, k->coils) != 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu turns and %zu coils are no knot: 1 to %d each, without a common "
                          "divisor, such as 2 and 3",
                          k->turns, k->coils, ABBE_KNOT_MAX_WINDINGS);
  if (k->spines > ABBE_KNOT_MAX_SPINES || !(k->spine >= 0 && k->spine <= 2))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu spines of %g of the radius are not possible: at most %d, of 0 to 2",
                          k->spines, k->spine, ABBE_KNOT_MAX_SPINES);
  if (k->along < 3 || k->across < 3 || k->along > ABBE_KNOT_MAX_SEGMENTS ||
      k->across > ABBE_KNOT_MAX_SEGMENTS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a knot of %zu by %zu segments is not possible: from 3 to %d each",
                          k->along, k->across, ABBE_KNOT_MAX_SEGMENTS);
  const double most = k->radius * (1 + (k->spines > 0 ? k->spine : 0)), room = abbe_knot_room(k);
  if (most >= room)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a tube of %g m, with its spines, meets itself along this knot; it must "
                          "stay below %.4g m",
                          most, room);
  return ABBE_OK;
}

abbe_result abbe_knot_make(const abbe_knot *knot, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  const abbe_knot k = filled_in(knot);
  abbe_result result = check(&k, error);
  if (result == ABBE_OK)
    result = abbe_mesh_make(k.along * k.across, 2 * k.along * k.across, false, out, error);
  if (result != ABBE_OK) return result;
  size_t face = 0;
  for (size_t i = 0; i < k.along; i++)
    for (size_t j = 0; j < k.across; j++) {
      const double t = whole * (double)i / (double)k.along;
      const double turn = whole * (double)j / (double)k.across;
      const size_t here = i * k.across + j, i1 = (i + 1) % k.along, j1 = (j + 1) % k.across;
      const size_t corner[4] = {here, i1 * k.across + j, i1 * k.across + j1, i * k.across + j1};
      surface_at(&k, t, turn, out->position[here]);
      normal_at(&k, t, turn, out->normal[here]);
      for (size_t half = 0; half < 2; half++, face++) {
        out->face[face][0] = (uint32_t)here;
        for (size_t c = 1; c < 3; c++) out->face[face][c] = (uint32_t)corner[half + c];
      }
    }
  return ABBE_OK;
}
