#include "scenes/shapes/shape.h"

#include "base/maths.h"
#include "scenes/shapes/convex.h"

#include <math.h>
#include <string.h>

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
  abbe_result result = check_share("table", cut->table, error);
  if (result == ABBE_OK) result = check_share("star", cut->star, error);
  if (result == ABBE_OK) result = check_share("lower half", cut->lower, error);
  if (result == ABBE_OK) result = check_share("girdle", cut->girdle, error);
  if (result == ABBE_OK) result = check_angle("crown", cut->crown_rad, error);
  return result == ABBE_OK ? check_angle("pavilion", cut->pavilion_rad, error) : result;
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
