#include "cli/view/state/view_camera.h"

#include "base/maths.h"
#include "scenes/view/view.h"

#include <string.h>

#define STEEPEST (89 * ABBE_PI / 180)

static void add(const double a[3], double s, const double b[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = a[k] + s * b[k];
}

/* v turned about the unit axis, the right-handed way. */
static void turn(const double v[3], const double axis[3], double rad, double out[3]) {
  const double c = cos(rad), s = sin(rad), along = abbe_vector_dot(v, axis);
  double side[3];
  abbe_vector_cross(axis, v, side);
  for (int k = 0; k < 3; k++) out[k] = v[k] * c + side[k] * s + axis[k] * along * (1 - c);
}

static void look_of(const abbe_camera *camera, abbe_view *out) {
  double forward[3];
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_view_look(camera->eye, forward, camera->up, false, out);
}

/* The vector turned about `up` by that angle and raised towards it, its length kept. */
static void turn_and_raise(const abbe_camera *camera, double around_rad, double raise_rad,
                           double v[3]) {
  abbe_view view;
  double axis[3], level[3];
  const double length = abbe_vector_length(v);
  memcpy(axis, camera->up, sizeof axis);
  abbe_vector_normalise(axis);
  const double high = abbe_vector_dot(v, axis) / length;
  add(v, -high * length, axis, level);
  if (!(abbe_vector_length(level) > 1e-9 * length)) { /* straight along up: the view's own side */
    look_of(camera, &view);
    abbe_vector_cross(view.right, axis, level);
  }
  abbe_vector_normalise(level);
  turn((const double[3]){level[0], level[1], level[2]}, axis, around_rad, level);
  const double before = asin(fmin(1, fmax(-1, high)));
  const double after = fmin(STEEPEST, fmax(-STEEPEST, before + raise_rad));
  for (int k = 0; k < 3; k++) v[k] = length * (cos(after) * level[k] + sin(after) * axis[k]);
}

void abbe_view_camera_orbit(abbe_camera *camera, double right_rad, double up_rad) {
  double from[3];
  abbe_vector_subtract(camera->eye, camera->target, from);
  turn_and_raise(camera, right_rad, up_rad, from);
  add(camera->target, 1, from, camera->eye);
}

void abbe_view_camera_look(abbe_camera *camera, double right_rad, double up_rad) {
  double to[3];
  abbe_vector_subtract(camera->target, camera->eye, to);
  turn_and_raise(camera, -right_rad, up_rad, to);
  add(camera->eye, 1, to, camera->target);
}

void abbe_view_camera_fly(abbe_camera *camera, const double step[3]) {
  abbe_view view;
  look_of(camera, &view);
  const double *axis[3] = {view.right, view.up, view.forward};
  for (int i = 0; i < 3; i++) {
    add(camera->eye, step[i], axis[i], camera->eye);
    add(camera->target, step[i], axis[i], camera->target);
  }
}

void abbe_view_camera_pan(abbe_camera *camera, double right, double up) {
  double to[3];
  abbe_vector_subtract(camera->target, camera->eye, to);
  const double height = 2 * tan(0.5 * camera->fov_y_rad) * abbe_vector_length(to);
  abbe_view_camera_fly(camera, (const double[3]){right * height, up * height, 0});
}

void abbe_view_camera_zoom(abbe_camera *camera, double factor) {
  double from[3];
  abbe_vector_subtract(camera->eye, camera->target, from);
  add(camera->target, factor, from, camera->eye);
}

/* The view with the picture's window. */
static void view_of(const abbe_camera *camera, size_t width, size_t height, abbe_view *out) {
  const double y = tan(0.5 * camera->fov_y_rad), x = y * (double)width / (double)height;
  look_of(camera, out);
  memcpy(out->window, (const double[4]){-x, x, -y, y}, sizeof out->window);
}

bool abbe_view_camera_project(const abbe_camera *camera, size_t width, size_t height,
                              const double point[3], double xy[2]) {
  abbe_view view;
  double uvz[3];
  view_of(camera, width, height, &view);
  if (!abbe_view_project(&view, point, uvz)) return false;
  xy[0] = uvz[0] * (double)width;
  xy[1] = (1 - uvz[1]) * (double)height;
  return true;
}

bool abbe_view_camera_beyond(const abbe_camera *camera, size_t width, size_t height,
                             const double point[3], double inside, double xy[2], double way[2]) {
  const double half[2] = {0.5 * (double)width, 0.5 * (double)height};
  double at[2], to[3], forward[3], right[3], up[3];
  if (abbe_view_camera_project(camera, width, height, point, at) && at[0] >= 0 && at[1] >= 0 &&
      at[0] <= 2 * half[0] && at[1] <= 2 * half[1])
    return false;
  abbe_vector_subtract(point, camera->eye, to);
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_vector_cross(forward, camera->up, right);
  abbe_vector_cross(right, forward, up);
  if (!abbe_vector_normalise(right) || !abbe_vector_normalise(up)) return false;
  way[0] = abbe_vector_dot(to, right);
  way[1] = -abbe_vector_dot(to, up);
  const double length = hypot(way[0], way[1]);
  for (int k = 0; k < 2; k++) way[k] = length > 0 ? way[k] / length : k; /* straight behind: down */
  const double reach = fmin((half[0] - inside) / fmax(1e-9, fabs(way[0])),
                            (half[1] - inside) / fmax(1e-9, fabs(way[1])));
  for (int k = 0; k < 2; k++) xy[k] = half[k] + fmax(0, reach) * way[k];
  return true;
}

void abbe_view_camera_point(const abbe_camera *camera, size_t width, size_t height,
                            const double xy[2], double distance, double out[3]) {
  const double uv[2] = {xy[0] / (double)width, 1 - xy[1] / (double)height};
  abbe_view view;
  double origin[3], direction[3];
  view_of(camera, width, height, &view);
  abbe_view_ray(&view, uv, origin, direction);
  for (int k = 0; k < 3; k++) out[k] = origin[k] + distance * direction[k];
}

/* Where the ray of a pixel meets the plane. */
static bool meet(const abbe_view *view, size_t width, size_t height, const double xy[2],
                 const double point[3], const double normal[3], double out[3]) {
  const double uv[2] = {xy[0] / (double)width, 1 - xy[1] / (double)height};
  double origin[3], direction[3], to[3];
  abbe_view_ray(view, uv, origin, direction);
  abbe_vector_subtract(point, origin, to);
  const double down = abbe_vector_dot(direction, normal), deep = abbe_vector_dot(to, normal);
  if (!(deep / down > 0) || fabs(down) < 1e-3) return false; /* beside or above the horizon */
  add(origin, deep / down, direction, out);
  return true;
}

bool abbe_view_camera_drag(const abbe_camera *camera, size_t width, size_t height,
                           abbe_view_drag drag, const double point[3], const double from[2],
                           const double to[2], double out[3]) {
  abbe_view view;
  double axis[3], normal[3], a[3], b[3], step[3];
  memmove(out, point, sizeof step);
  view_of(camera, width, height, &view);
  memcpy(axis, camera->up, sizeof axis);
  abbe_vector_normalise(axis);
  /* the plane that holds the axis and faces the camera as well as it can */
  add(view.forward, -abbe_vector_dot(view.forward, axis), axis, normal);
  if (drag == ABBE_VIEW_DRAG_UPRIGHT && abbe_vector_length(normal) < 0.05) return false;
  if (drag == ABBE_VIEW_DRAG_LEVEL) memcpy(normal, axis, sizeof normal);
  abbe_vector_normalise(normal);
  const double *held = out;
  if (!meet(&view, width, height, from, held, normal, a) ||
      !meet(&view, width, height, to, held, normal, b))
    return false;
  abbe_vector_subtract(b, a, step);
  if (drag == ABBE_VIEW_DRAG_UPRIGHT) {
    const double up = abbe_vector_dot(step, axis);
    for (int k = 0; k < 3; k++) step[k] = up * axis[k];
  }
  add(out, 1, step, out);
  return true;
}
