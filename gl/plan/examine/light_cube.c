#include "gl/plan/examine/light_cube.h"

#include "gl/plan/examine/reach.h"
#include "scenes/geometry/vector.h"

#include <math.h>
#include <string.h>

/* What reaches no further into a pyramid than a float can tell lies outside. */
static const double rounding = 1e-7;

static const double quarter = 0.78539816339744831; /* pi / 4 */

int abbe_light_cube_face(const double d[3]) {
  int axis = fabs(d[0]) >= fabs(d[1]) && fabs(d[0]) >= fabs(d[2]) ? 0
             : fabs(d[1]) >= fabs(d[2])                           ? 1
                                                                  : 2;
  return 2 * axis + (d[axis] < 0 ? 1 : 0);
}

static void axis_of(int face, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = k == face / 2 ? (face % 2 != 0 ? -1 : 1) : 0;
}

void abbe_light_cube_look(const double origin[3], int face, abbe_view *out) {
  static const double up[3] = {0, 1, 0};
  double forward[3];
  axis_of(face, forward);
  abbe_view_look(origin, forward, up, false, out);
}

/* x to the right, y up, z forward. */
static void to_view(const abbe_view *view, const double p[3], double out[3]) {
  double d[3];
  abbe_vector_subtract(p, view->origin, d);
  out[0] = abbe_vector_dot(d, view->right);
  out[1] = abbe_vector_dot(d, view->up);
  out[2] = abbe_vector_dot(d, view->forward);
}

static void grow(abbe_view *view, int axis, double low, double high) {
  double *window = view->window + 2 * axis;
  window[0] = fmin(window[0], fmax(low, -1));
  window[1] = fmax(window[1], fmin(high, 1));
}

/* Distance of p from the pyramid |x|, |y| <= z: the nearest of its nearest places inside, on a
 * side, on an edge and at the apex, of those that there are. */
static double from_pyramid(const double p[3]) {
  const double x = fabs(p[0]), y = fabs(p[1]), z = p[2];
  if (x <= z && y <= z) return 0;
  double least = sqrt(x * x + y * y + z * z);
  const double across[2][2] = {{x, y}, {y, x}};
  for (int side = 0; side < 2; side++) {
    const double along = 0.5 * (across[side][0] + z);
    if (along >= 0 && across[side][1] <= along)
      least = fmin(least, fabs(across[side][0] - z) * sqrt(0.5));
  }
  const double edge = fmax((x + y + z) / 3, 0);
  return fmin(least, sqrt(pow(x - edge, 2) + pow(y - edge, 2) + pow(z - edge, 2)));
}

/* Each axis of the window around the sphere's shadow on the plane of that axis and forward. */
static bool fit_sphere(abbe_view *view, const abbe_exact *sphere) {
  double c[3];
  to_view(view, sphere->centre, c);
  if (!(from_pyramid(c) < sphere->radius * (1 - rounding))) return false;
  for (int axis = 0; axis < 2; axis++) {
    const double distance = hypot(c[axis], c[2]), middle = atan2(c[axis], c[2]);
    double low = -1, high = 1;
    if (distance > sphere->radius) {
      const double half = asin(sphere->radius / distance);
      for (int turn = -1; turn <= 1; turn++) {
        const double from = fmax(middle - half + 8 * turn * quarter, -quarter);
        const double to = fmin(middle + half + 8 * turn * quarter, quarter);
        if (from < to) low = tan(from), high = tan(to);
      }
    }
    grow(view, axis, low, high);
  }
  return true;
}

enum { MOST_CORNERS = 8 }; /* a triangle's, and one for each plane that cuts it */

/* The part of a polygon where scale z - side p[axis] >= 0. */
static int cut(const double (*from)[3], int count, int axis, double side, double (*to)[3]) {
  int kept = 0;
  for (int i = 0; i < count; i++) {
    const double *a = from[i], *b = from[(i + 1) % count];
    const double in_a = (1 - rounding) * a[2] - side * a[axis];
    const double in_b = (1 - rounding) * b[2] - side * b[axis];
    if (in_a >= 0 && kept < MOST_CORNERS) memcpy(to[kept++], a, sizeof *to);
    if ((in_a >= 0) == (in_b >= 0) || kept == MOST_CORNERS) continue;
    const double t = in_a / (in_a - in_b);
    for (int k = 0; k < 3; k++) to[kept][k] = a[k] + t * (b[k] - a[k]);
    kept++;
  }
  return kept;
}

static bool fit_triangle(abbe_view *view, const double corner[3][3]) {
  double polygon[2][MOST_CORNERS][3];
  int count = 3;
  bool any = false;
  memcpy(polygon[0], corner, 3 * sizeof *corner);
  for (int k = 0; k < 4 && count > 0; k++)
    count = cut((const double(*)[3])polygon[k % 2], count, k / 2, k % 2 != 0 ? -1 : 1,
                polygon[(k + 1) % 2]);
  for (int i = 0; i < count; i++) {
    const double *p = polygon[0][i];
    if (!(p[2] > 0)) continue;
    any = true;
    for (int axis = 0; axis < 2; axis++) grow(view, axis, p[axis] / p[2], p[axis] / p[2]);
  }
  return any;
}

static void read_triangle(const abbe_mesh *mesh, size_t face, double corner[3][3]) {
  for (int k = 0; k < 3; k++)
    memcpy(corner[k], mesh->position[mesh->face[face][k]], sizeof corner[k]);
}

bool abbe_light_cube_fit(abbe_view *view, const abbe_object *object) {
  const abbe_mesh *mesh = &object->mesh;
  bool any = false;
  if (object->exact.kind == ABBE_EXACT_SPHERE) return fit_sphere(view, &object->exact);
  for (size_t i = 0; i < mesh->face_count; i++) {
    double world[3][3], corner[3][3];
    read_triangle(mesh, i, world);
    for (int k = 0; k < 3; k++) to_view(view, world[k], corner[k]);
    any = fit_triangle(view, (const double(*)[3])corner) || any;
  }
  return any;
}

unsigned abbe_light_cube_reached(const abbe_light *light, const abbe_object *object) {
  static const double to_corner_rad = 0.95531661812450927; /* acos(1 / sqrt 3) */
  unsigned faces = 0;
  if (!abbe_reach_light(light, object)) return 0;
  for (int face = 0; face < ABBE_LIGHT_CUBE_FACES; face++) {
    double axis[3];
    abbe_view view;
    axis_of(face, axis);
    if (light->kind == ABBE_LIGHT_SPOT) {
      const double c = fmin(fmax(abbe_vector_dot(axis, light->direction), -1), 1);
      if (acos(c) > light->cone_rad + to_corner_rad) continue;
    }
    abbe_light_cube_look(light->position, face, &view);
    if (abbe_light_cube_fit(&view, object)) faces |= 1u << face;
  }
  return faces;
}
