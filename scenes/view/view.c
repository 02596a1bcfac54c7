#include "scenes/view/view.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/mesh/bvh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void cross(const double a[3], const double b[3], double out[3]) {
  double c[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  memcpy(out, c, sizeof c);
}

static void normalise(double v[3]) {
  double length = sqrt(abbe_vector_dot(v, v));
  for (int i = 0; i < 3; i++) v[i] /= length;
}

void abbe_view_look(const double origin[3], const double forward[3], const double up[3],
                    bool orthographic, abbe_view *out) {
  static const double hints[3][3] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  memset(out, 0, sizeof *out);
  out->orthographic = orthographic;
  memcpy(out->origin, origin, sizeof out->origin);
  memcpy(out->forward, forward, sizeof out->forward);
  normalise(out->forward);
  cross(out->forward, up, out->right);
  for (int i = 0; i < 3 && abbe_vector_dot(out->right, out->right) < 1e-12; i++)
    cross(out->forward, hints[i], out->right);
  normalise(out->right);
  cross(out->right, out->forward, out->up);
  out->window[0] = out->window[2] = out->near = INFINITY;
  out->window[1] = out->window[3] = out->far = -INFINITY;
}

/* The lesser of two finite numbers; the library's own functions are calls, which a mesh's many
 * vertices would pay for. */
static double lesser(double a, double b) {
  return a < b ? a : b;
}

static double greater(double a, double b) {
  return a > b ? a : b;
}

/* A point beyond the limit still widens the window, towards its own side. Whether it does not lie
 * beyond it. */
static bool to_window(double *x, double *y, double *z) {
  static const double limit = ABBE_VIEW_MAX_TANGENT;
  const double far = greater(fabs(*x), fabs(*y));
  const bool fits = *z > 0 && far <= limit * *z;
  const double depth = fits ? *z : greater(*z, far / limit);
  if (depth <= 0) {
    *x = *y = *z = NAN;
    return false;
  }
  *x = fits ? *x / depth : lesser(greater(*x / depth, -limit), limit);
  *y = fits ? *y / depth : lesser(greater(*y / depth, -limit), limit);
  *z = greater(*z, depth * 1e-3);
  return fits;
}

bool abbe_view_fit(abbe_view *view, const double (*points)[3], size_t count) {
  abbe_view v = *view;
  bool fits = true;
  for (size_t i = 0; i < count; i++) {
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = points[i][k] - v.origin[k];
    double x = abbe_vector_dot(d, v.right), y = abbe_vector_dot(d, v.up),
           z = abbe_vector_dot(d, v.forward);
    if (!v.orthographic) fits = to_window(&x, &y, &z) && fits;
    /* not a number: it has no place, and the others stay */
    v.window[0] = x < v.window[0] ? x : v.window[0];
    v.window[1] = x > v.window[1] ? x : v.window[1];
    v.window[2] = y < v.window[2] ? y : v.window[2];
    v.window[3] = y > v.window[3] ? y : v.window[3];
    v.near = z < v.near ? z : v.near;
    v.far = z > v.far ? z : v.far;
  }
  *view = v;
  return fits;
}

void abbe_view_pad(abbe_view *view, double share) {
  double size = fmax(view->window[1] - view->window[0], view->window[3] - view->window[2]);
  double least = fmax(size, 1e-9) * 1e-3;
  for (int axis = 0; axis < 2; axis++) {
    double *low = &view->window[2 * axis], *high = &view->window[2 * axis + 1];
    double grow = fmax((*high - *low) * share, least);
    *low -= grow;
    *high += grow;
  }
  double depth = fmax(view->far - view->near, 1e-3 * fabs(view->far));
  view->far += share * depth;
  view->near -= share * depth;
  if (!view->orthographic) view->near = fmax(view->near, 1e-3 * view->far);
}

void abbe_view_square(abbe_view *view) {
  double half = 0.5 * fmax(view->window[1] - view->window[0], view->window[3] - view->window[2]);
  for (int axis = 0; axis < 2; axis++) {
    double middle = 0.5 * (view->window[2 * axis] + view->window[2 * axis + 1]);
    view->window[2 * axis] = middle - half;
    view->window[2 * axis + 1] = middle + half;
  }
}

void abbe_view_matrix(const abbe_view *view, double out[16]) {
  double look[16], clip[16], target[3];
  for (int k = 0; k < 3; k++) target[k] = view->origin[k] + view->forward[k];
  abbe_transform_look_at(view->origin, target, view->up, look);
  const double *w = view->window;
  if (view->orthographic)
    abbe_transform_orthographic(w[0], w[1], w[2], w[3], view->near, view->far, clip);
  else
    abbe_transform_perspective(w[0], w[1], w[2], w[3], view->near, view->far, clip);
  abbe_transform_multiply(clip, look, out);
}

void abbe_view_reversed_matrix(const abbe_view *view, double out[16]) {
  abbe_view_matrix(view, out);
  for (int column = 0; column < 4; column++) {
    double *depth = &out[4 * column + 2];
    const double last = column == 3 ? view->near : 0;
    *depth = view->orthographic ? 0.5 * (out[4 * column + 3] - *depth) : last;
  }
}

bool abbe_view_project(const abbe_view *view, const double p[3], double uvz[3]) {
  double d[3];
  for (int k = 0; k < 3; k++) d[k] = p[k] - view->origin[k];
  double x = abbe_vector_dot(d, view->right), y = abbe_vector_dot(d, view->up),
         z = abbe_vector_dot(d, view->forward);
  uvz[2] = z;
  if (!view->orthographic) {
    x /= z;
    y /= z;
    uvz[2] = sqrt(abbe_vector_dot(d, d));
  }
  uvz[0] = (x - view->window[0]) / (view->window[1] - view->window[0]);
  uvz[1] = (y - view->window[2]) / (view->window[3] - view->window[2]);
  return view->orthographic || z > 0;
}

void abbe_view_ray(const abbe_view *view, const double uv[2], double origin[3],
                   double direction[3]) {
  double x = view->window[0] + uv[0] * (view->window[1] - view->window[0]);
  double y = view->window[2] + uv[1] * (view->window[3] - view->window[2]);
  for (int k = 0; k < 3; k++) {
    double side = view->right[k] * x + view->up[k] * y;
    origin[k] = view->origin[k] + (view->orthographic ? side : 0);
    direction[k] = view->forward[k] + (view->orthographic ? 0 : side);
  }
  normalise(direction);
}

double abbe_view_area(const abbe_view *view) {
  return (view->window[1] - view->window[0]) * (view->window[3] - view->window[2]);
}

void abbe_view_pack(const abbe_view *view, float out[24]) {
  const double *rows[4] = {view->origin, view->right, view->up, view->forward};
  memset(out, 0, 24 * sizeof *out);
  for (int row = 0; row < 4; row++)
    for (int k = 0; k < 3; k++) out[4 * row + k] = (float)rows[row][k];
  out[3] = view->orthographic ? 0.0f : 1.0f;
  for (int k = 0; k < 4; k++) out[16 + k] = (float)view->window[k];
  out[20] = (float)view->near;
  out[21] = (float)view->far;
}

/* The corners of all objects' faces. */
static abbe_result gather(const abbe_scene *scene, double (**out)[9], size_t *count,
                          abbe_error *error) {
  *count = 0;
  for (size_t i = 0; i < scene->object_count; i++) *count += scene->object[i].mesh.face_count;
  *out = malloc((*count + 1) * sizeof **out);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu faces", *count);
  double(*at)[9] = *out;
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_mesh *m = &scene->object[i].mesh;
    for (size_t f = 0; f < m->face_count; f++, at++)
      for (int k = 0; k < 3; k++)
        memcpy(*at + 3 * k, m->position[m->face[f][k]], 3 * sizeof(double));
  }
  return ABBE_OK;
}

/* Right, up and forward. */
static void look(const abbe_camera *camera, double axis[3][3]) {
  abbe_vector_subtract(camera->target, camera->eye, axis[2]);
  abbe_vector_normalise(axis[2]);
  abbe_vector_cross(axis[2], camera->up, axis[0]);
  abbe_vector_normalise(axis[0]);
  abbe_vector_cross(axis[0], axis[2], axis[1]);
}

abbe_result abbe_coverage_make(const abbe_scene *scene, size_t width, size_t height, size_t samples,
                               abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"A"};
  double(*triangle)[9] = NULL, axis[3][3];
  size_t count = 0;
  abbe_bvh bvh = {0};
  memset(out, 0, sizeof *out);
  if (samples < 1 || samples > 16)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "1 to 16 samples a pixel's side, not %zu",
                          samples);
  abbe_result result = gather(scene, &triangle, &count, error);
  if (result == ABBE_OK) result = abbe_image_make(width, height, 1, names, out, error);
  if (result == ABBE_OK && count > 0)
    result = abbe_bvh_make((const double(*)[9])triangle, count, &bvh, error);
  look(&scene->camera, axis);
  const double tangent = tan(0.5 * scene->camera.fov_y_rad);
  const double wide = (double)(width * samples), high = (double)(height * samples);
  for (size_t y = 0; y < height * samples && result == ABBE_OK && count > 0; y++)
    for (size_t x = 0; x < width * samples; x++) {
      const double right = tangent * (2 * ((double)x + 0.5) - wide) / high;
      const double up = tangent * (high - 2 * ((double)y + 0.5)) / high;
      double d[3];
      abbe_bvh_hit hit;
      for (int k = 0; k < 3; k++) d[k] = axis[2][k] + right * axis[0][k] + up * axis[1][k];
      if (abbe_bvh_trace(&bvh, (const double(*)[9])triangle, scene->camera.eye, d, 0, 0, INFINITY,
                         &hit))
        out->data[y / samples * width + x / samples] += 1.0f / (float)(samples * samples);
    }
  abbe_bvh_free(&bvh);
  free(triangle);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
