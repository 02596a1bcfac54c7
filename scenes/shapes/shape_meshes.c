#include "scenes/shapes/shape.h"

#include "base/maths.h"
#include "scenes/shapes/convex.h"

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
  ABBE_TRY(check(&k, error));
  ABBE_TRY(abbe_mesh_make(k.along * k.across, 2 * k.along * k.across, false, out, error));
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

enum { MAINS = 8, GIRDLE = 2 * MAINS, FACES = 6 + MAINS * 13, PLANES = 73 };

/* Vertices, one after another: corners of the table, of the stars, of the girdle above and below,
 * of the mains' sides, the culet. Odd ones of the girdle lie below stars. */
enum {
  TABLE = 0,
  STAR = TABLE + MAINS,
  ABOVE = STAR + MAINS,
  BELOW = ABOVE + GIRDLE,
  SIDE = BELOW + GIRDLE,
  CULET = SIDE + MAINS,
  VERTICES
};

static abbe_result check_share(const char *what, double value, abbe_error *error) {
  if (value > 0 && value < 1) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a brilliant's %s is %g; it is a share between 0 and 1", what, value);
}

static abbe_result check_angle(const char *what, double radians, abbe_error *error) {
  if (radians > 0 && radians <= 80 * ABBE_PI / 180) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a brilliant's %s angle is %g degrees; it may be above 0, to 80", what,
                        radians * 180 / ABBE_PI);
}

static abbe_result resolve(abbe_brilliant *cut, abbe_error *error) {
  if (cut->table == 0) cut->table = 0.56;
  if (cut->crown_rad == 0) cut->crown_rad = 34.5 * ABBE_PI / 180;
  if (cut->pavilion_rad == 0) cut->pavilion_rad = 40.75 * ABBE_PI / 180;
  if (cut->star == 0) cut->star = 0.5;
  if (cut->lower == 0) cut->lower = 0.77;
  if (cut->girdle == 0) cut->girdle = 0.03;
  if (!(cut->diameter > 0) || !isfinite(cut->diameter))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a brilliant's diameter is %g; it must be a finite length above zero",
                          cut->diameter);
  ABBE_TRY(check_share("table", cut->table, error));
  ABBE_TRY(check_share("star", cut->star, error));
  ABBE_TRY(check_share("lower half", cut->lower, error));
  ABBE_TRY(check_share("girdle", cut->girdle, error));
  ABBE_TRY(check_angle("crown", cut->crown_rad, error));
  return check_angle("pavilion", cut->pavilion_rad, error);
}

/* Steps of half a main's angle. */
static void place(abbe_mesh *mesh, size_t vertex, double radius, double half_steps, double z) {
  const double angle = half_steps * ABBE_PI / MAINS;
  mesh->position[vertex][0] = radius * cos(angle);
  mesh->position[vertex][1] = radius * sin(angle);
  mesh->position[vertex][2] = z;
}

static void place_all(const abbe_brilliant *cut, abbe_mesh *mesh) {
  const double r = 0.5 * cut->diameter, edge = 0.5 * cut->girdle * cut->diameter;
  const double half = cos(ABBE_PI / MAINS), table = cut->table * r;
  const double star = table * half + cut->star * (r - table * half), side = (1 - cut->lower) * r;
  const double crown = tan(cut->crown_rad), pavilion = tan(cut->pavilion_rad);
  for (size_t k = 0; k < MAINS; k++) {
    const double at = 2.0 * (double)k;
    place(mesh, TABLE + k, table, at, edge + (r - table) * crown);
    /* Stars' and sides' corners lie in the planes of the bezels and mains beside them. */
    place(mesh, STAR + k, star, at + 1, edge + (r - star * half) * crown);
    place(mesh, SIDE + k, side, at + 1, -edge - (r - side * half) * pavilion);
  }
  for (size_t k = 0; k < GIRDLE; k++) {
    place(mesh, ABOVE + k, r, (double)k, edge);
    place(mesh, BELOW + k, r, (double)k, -edge);
  }
  place(mesh, CULET, 0, 0, -edge - r * pavilion);
}

static void add(abbe_mesh *mesh, size_t *face, size_t a, size_t b, size_t c) {
  const uint32_t corners[3] = {(uint32_t)a, (uint32_t)b, (uint32_t)c};
  memcpy(mesh->face[(*face)++], corners, sizeof corners);
}

static void join_all(abbe_mesh *mesh) {
  size_t face = 0;
  for (size_t k = 1; k + 1 < MAINS; k++) add(mesh, &face, TABLE, TABLE + k, TABLE + k + 1);
  for (size_t k = 0; k < MAINS; k++) {
    const size_t next = (k + 1) % MAINS, last = (k + MAINS - 1) % MAINS;
    const size_t corner = 2 * k, middle = corner + 1, end = (corner + 2) % GIRDLE;
    add(mesh, &face, TABLE + k, STAR + k, TABLE + next);
    add(mesh, &face, TABLE + k, STAR + last, ABOVE + corner);
    add(mesh, &face, TABLE + k, ABOVE + corner, STAR + k);
    add(mesh, &face, STAR + k, ABOVE + corner, ABOVE + middle);
    add(mesh, &face, STAR + k, ABOVE + middle, ABOVE + end);
    add(mesh, &face, ABOVE + corner, BELOW + corner, BELOW + middle);
    add(mesh, &face, ABOVE + corner, BELOW + middle, ABOVE + middle);
    add(mesh, &face, ABOVE + middle, BELOW + middle, BELOW + end);
    add(mesh, &face, ABOVE + middle, BELOW + end, ABOVE + end);
    add(mesh, &face, SIDE + k, BELOW + middle, BELOW + corner);
    add(mesh, &face, SIDE + k, BELOW + end, BELOW + middle);
    add(mesh, &face, CULET, SIDE + k, BELOW + corner);
    add(mesh, &face, CULET, BELOW + corner, SIDE + last);
  }
}

abbe_result abbe_brilliant_make(const abbe_brilliant *cut, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_brilliant c = *cut;
  double plane[PLANES][4];
  abbe_convex found = {0};
  abbe_result result = resolve(&c, error);
  if (result == ABBE_OK) result = abbe_mesh_make(VERTICES, FACES, false, out, error);
  if (result != ABBE_OK) return result;
  place_all(&c, out);
  join_all(out);
  result = abbe_mesh_compute_normals(out, ABBE_NORMALS_FLAT, error);
  if (result == ABBE_OK) result = abbe_convex_find(out, PLANES, plane, NULL, &found, error);
  if (result == ABBE_OK && found.verdict != ABBE_CONVEX_SOLID)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "a brilliant with a star of %g and lower halves of %g is not convex; "
                            "0.5 and 0.77 are usual",
                            c.star, c.lower);
  if (result != ABBE_OK) abbe_mesh_free(out);
  return result;
}
