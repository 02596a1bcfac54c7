#include "scenes/volume/exits/exit_sheets.h"

#include "base/maths.h"

#include <string.h>

/* Into the object's own coordinates. */
static void turn_back(const double turn[9], const double v[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = turn[k] * v[0] + turn[3 + k] * v[1] + turn[6 + k] * v[2];
}

void abbe_exit_sheet_make(const double p[9], const abbe_volume_place *place, abbe_exit_sheet *out) {
  double from[3], u[3], v[3], n[3];
  abbe_vector_subtract(p, place->centre, from);
  turn_back(place->turn, from, out->corner);
  turn_back(place->turn, p + 3, u);
  turn_back(place->turn, p + 6, v);
  abbe_vector_cross(u, v, n);
  const double square = abbe_vector_dot(n, n);
  abbe_vector_cross(v, n, out->du);
  abbe_vector_cross(n, u, out->dv);
  for (int k = 0; k < 3; k++) {
    out->du[k] /= square;
    out->dv[k] /= square;
  }
  memcpy(out->normal, n, sizeof n);
  abbe_vector_normalise(out->normal);
  out->area = sqrt(square);
}

static void project(const double axis[3], const double at[3], const double by[3], float out[2]) {
  out[0] = (float)abbe_vector_dot(axis, at);
  out[1] = (float)abbe_vector_dot(axis, by);
}

void abbe_exit_sheets_track(const abbe_exit_sheet *sheet, size_t sheets, const abbe_exit_ray *ray,
                            abbe_exit_track *track) {
  for (size_t i = 0; i < sheets; i++) {
    const abbe_exit_sheet *s = &sheet[i];
    double from[3];
    abbe_vector_subtract(ray->place, s->corner, from);
    project(s->normal, from, ray->place_by, track[i].height);
    project(s->normal, ray->way, ray->way_by, track[i].fall);
    project(s->du, from, ray->place_by, track[i].u);
    project(s->dv, from, ray->place_by, track[i].v);
    project(s->du, ray->way, ray->way_by, track[i].u_along);
    project(s->dv, ray->way, ray->way_by, track[i].v_along);
  }
}

static float at_step(const float value[2], float step) {
  return value[0] + step * value[1];
}

/* Where four of the parts come to the plane: a processor does them at once. */
static void meet_plane(const abbe_exit_track *plane, const float *restrict step,
                       float *restrict fall, float *restrict far, float *restrict u,
                       float *restrict v) {
  const abbe_exit_track t = *plane;
  for (size_t i = 0; i < 4; i++) {
    fall[i] = at_step(t.fall, step[i]);
    far[i] = -at_step(t.height, step[i]) / fall[i];
    u[i] = at_step(t.u, step[i]) + far[i] * at_step(t.u_along, step[i]);
    v[i] = at_step(t.v, step[i]) + far[i] * at_step(t.v_along, step[i]);
  }
}

static void take_nearer(const abbe_exit_landing *from, const float *fall, int sheet, size_t parts,
                        abbe_exit_landing *to) {
  for (size_t i = 0; i < parts; i++) {
    const float far = from->far[i], u = from->u[i], v = from->v[i];
    if (!(far > 0 && far < to->far[i] && u >= 0 && u <= 1 && v >= 0 && v <= 1)) continue;
    to->far[i] = far;
    to->u[i] = u;
    to->v[i] = v;
    to->page[i] = 2 * sheet + (fall[i] > 0);
  }
}

void abbe_exit_sheets_meet(const abbe_exit_track *track, size_t sheets,
                           const float step[ABBE_EXIT_MOST_PARTS], size_t parts,
                           abbe_exit_landing *out) {
  for (size_t i = 0; i < parts; i++) {
    out->far[i] = INFINITY;
    out->page[i] = -1;
  }
  for (size_t i = 0; i < sheets; i++) {
    abbe_exit_landing at;
    float fall[ABBE_EXIT_MOST_PARTS];
    for (size_t k = 0; k < parts; k += 4)
      meet_plane(&track[i], step + k, fall + k, at.far + k, at.u + k, at.v + k);
    take_nearer(&at, fall, (int)i, parts, out);
  }
}

bool abbe_exit_sheets_hide(const abbe_exit_sheet *sheet, size_t sheets, const double place[3],
                           const double way[3], double limit) {
  for (const abbe_exit_sheet *s = sheet; s < sheet + sheets; s++) {
    double from[3], at[3];
    abbe_vector_subtract(place, s->corner, from);
    const double height = abbe_vector_dot(s->normal, from), fall = abbe_vector_dot(s->normal, way);
    if (height * fall >= 0) continue; /* it goes away from there */
    const double far = -height / fall;
    if (!(far > 1e-9 * abbe_vector_length(from)) || !(far < limit)) continue;
    for (int k = 0; k < 3; k++) at[k] = from[k] + far * way[k];
    const double u = abbe_vector_dot(at, s->du), v = abbe_vector_dot(at, s->dv);
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) return true;
  }
  return false;
}
