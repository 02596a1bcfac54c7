#include "scenes/import/scene_reading.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"
#include "scenes/geometry/transform.h"
#include "scenes/import/scene_value.h"
#include "scenes/mesh/topology.h"
#include "scenes/object_motion.h"
#include "spectral/dispersion/csv_points.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- the place ---- */

/* The matrix scales all directions alike: by *scale. */
static bool is_similarity(const double m[16], double *scale) {
  double length[3];
  for (int i = 0; i < 3; i++) length[i] = abbe_vector_length(m + 4 * i);
  *scale = length[0];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    if (fabs(length[i] - length[0]) > 1e-9 * length[0] ||
        fabs(abbe_vector_dot(m + 4 * i, m + 4 * j)) > 1e-9 * length[0] * length[0])
      return false;
  }
  return true;
}

static void bound_vertices(const abbe_mesh *mesh, const double matrix[16], double min[3],
                           double max[3]) {
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    double p[3];
    abbe_transform_point(matrix, mesh->position[v], p);
    for (int k = 0; k < 3; k++) {
      min[k] = fmin(min[k], p[k]);
      max[k] = fmax(max[k], p[k]);
    }
  }
}

/* The matrix with the size and the place that are asked for of all parts together, which keep what
 * they took. */
static abbe_result fit_matrix(const abbe_object_surface *s, abbe_object *part, size_t count,
                              double out[16], abbe_error *error) {
  double min[3], max[3], step[16], scale;
  memcpy(out, s->matrix, 16 * sizeof *out);
  for (size_t i = 0; i < count; i++) part[i].fitted = 1;
  if (s->fit == 0 && s->width == 0 && !s->centred) return ABBE_OK;
  for (int k = 0; k < 3; k++) min[k] = INFINITY, max[k] = -INFINITY;
  for (size_t i = 0; i < count; i++) bound_vertices(&part[i].mesh, out, min, max);
  if (s->radius > 0 && is_similarity(out, &scale))
    for (int k = 0; k < 3; k++) {
      min[k] = out[12 + k] - scale * s->radius;
      max[k] = out[12 + k] + scale * s->radius;
    }
  const double across[2] = {max[0] - min[0], max[1] - min[1]};
  const double own =
      s->width > 0 ? fmin(across[0], across[1]) : fmax(fmax(across[0], across[1]), max[2] - min[2]);
  if (s->fit > 0 || s->width > 0) {
    if (!(own > 0) || !isfinite(own))
      return abbe_error_set(error, ABBE_GEOMETRY, "an object of no size cannot be fitted to one");
    const double factor = (s->width > 0 ? s->width : s->fit) / own,
                 factors[3] = {factor, factor, factor};
    abbe_transform_scale(factors, step);
    abbe_transform_multiply(step, out, out);
    for (size_t i = 0; i < count; i++) part[i].fitted = factor;
    for (int k = 0; k < 3; k++) min[k] *= factor, max[k] *= factor;
  }
  if (s->centred) {
    double offset[3], low[3], high[3];
    memcpy(low, min, sizeof low);
    memcpy(high, max, sizeof high);
    for (size_t i = 0; i < s->setting_count; i++)
      bound_vertices(&s->setting[i].mesh, out, low, high);
    for (int k = 0; k < 3; k++)
      offset[k] = s->centre[k] - (s->stands && k == 2 ? low[k] : 0.5 * (min[k] + max[k]));
    abbe_transform_translate(offset, step);
    abbe_transform_multiply(step, out, out);
    for (size_t i = 0; i < count; i++) memcpy(part[i].centring, offset, sizeof offset);
  }
  return ABBE_OK;
}

double abbe_object_unit(const abbe_object_surface *surface, const abbe_mesh *mesh) {
  abbe_object_surface bare = *surface;
  abbe_object stone = {.mesh = *mesh};
  double matrix[16];
  bare.setting_count = 0;
  if (fit_matrix(&bare, &stone, 1, matrix, NULL) != ABBE_OK) return 0;
  return cbrt(fabs(abbe_transform_determinant3(matrix)));
}

/* ---- what is known exactly ---- */

static abbe_result parallelograms(abbe_object *out, abbe_error *error) {
  const size_t count = out->mesh.vertex_count / 4;
  out->exact.parallelogram = malloc(count * sizeof *out->exact.parallelogram);
  if (!out->exact.parallelogram) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  for (size_t i = 0; i < count; i++) {
    const double *corner = out->mesh.position[4 * i];
    double edge[2][3], normal[3];
    abbe_vector_subtract(out->mesh.position[4 * i + 1], corner, edge[0]);
    abbe_vector_subtract(out->mesh.position[4 * i + 3], corner, edge[1]);
    abbe_vector_cross(edge[0], edge[1], normal);
    const int mirrored = abbe_vector_dot(normal, out->mesh.normal[4 * i]) < 0.0;
    double *p = out->exact.parallelogram[i];
    memcpy(p, corner, 3 * sizeof *p);
    memcpy(p + 3, edge[mirrored], 3 * sizeof *p);
    memcpy(p + 6, edge[!mirrored], 3 * sizeof *p);
  }
  out->exact.count = count;
  out->exact.kind = ABBE_EXACT_PARALLELOGRAMS;
  return ABBE_OK;
}

/* Triangles of one plane have its normal, whatever their own is: so thin ones bend no light. */
static abbe_result take_plane_normals(abbe_mesh *mesh, const double (*plane)[4],
                                      const uint32_t *plane_of, abbe_error *error) {
  ABBE_TRY(abbe_mesh_compute_normals(mesh, ABBE_NORMALS_FLAT, error));
  for (size_t c = 0; c < 3 * mesh->face_count; c++)
    memcpy(mesh->normal[mesh->face[c / 3][c % 3]], plane[plane_of[c / 3]], sizeof *mesh->normal);
  return ABBE_OK;
}

/* The planes of a mesh; it is a solid where out->exact.convex says so. */
static abbe_result find_planes(abbe_object *out, double (*plane)[4], uint32_t *plane_of,
                               abbe_error *error) {
  return abbe_convex_find(&out->mesh, ABBE_SCENE_MAX_PLANES, plane, plane_of, &out->exact.convex,
                          error);
}

/* Triangles that lie off their planes by more than rounding become those of the planes: what leaves
 * a plane would meet the triangle that stands before it. The mesh stays where planes of their means
 * are no solid. */
static abbe_result straighten(abbe_object *out, double (*plane)[4], uint32_t **plane_of,
                              abbe_error *error) {
  static const double tolerance[] = ABBE_CONVEX_TOLERANCES;
  const abbe_convex found = out->exact.convex;
  double moved = 0;
  if (found.tolerance <= tolerance[0]) return ABBE_OK;
  abbe_result result = ABBE_GEOMETRY;
  for (int times = 1; times <= 3 && result == ABBE_GEOMETRY; times += 2)
    result = abbe_convex_flatten(&out->mesh, times * found.tolerance, ABBE_SCENE_MAX_PLANES, &moved,
                                 error);
  if (result == ABBE_GEOMETRY) return ABBE_OK;
  if (result == ABBE_OK) result = abbe_mesh_fix(&out->mesh, ABBE_NORMALS_FLAT, NULL, NULL, error);
  if (result != ABBE_OK) return result;
  uint32_t *room = realloc(*plane_of, (out->mesh.face_count + 1) * sizeof *room);
  if (room == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for face planes");
  *plane_of = room;
  result = find_planes(out, plane, *plane_of, error);
  out->exact.convex.tolerance = found.tolerance; /* the file's tolerance */
  return result;
}

static abbe_result convex(abbe_object *out, abbe_error *error) {
  const double alike = 1e-9; /* rad */
  double(*plane)[4] = malloc(ABBE_SCENE_MAX_PLANES * sizeof *plane);
  uint32_t *plane_of = malloc((out->mesh.face_count + 1) * sizeof *plane_of);
  abbe_result result = plane && plane_of
                           ? find_planes(out, plane, plane_of, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for face planes");
  if (result == ABBE_OK && out->exact.convex.verdict == ABBE_CONVEX_SOLID)
    result = straighten(out, plane, &plane_of, error);
  const bool found = result == ABBE_OK && out->exact.convex.verdict == ABBE_CONVEX_SOLID;
  if (found && out->exact.convex.off > alike)
    result = take_plane_normals(&out->mesh, (const double(*)[4])plane, plane_of, error);
  if (found) {
    out->exact.kind = ABBE_EXACT_CONVEX;
    out->exact.count = out->exact.convex.planes;
    out->exact.plane = plane;
  } else {
    free(plane);
  }
  free(plane_of);
  return result;
}

static abbe_result find_exact(const abbe_object_surface *s, const double matrix[16],
                              abbe_object *out, abbe_error *error) {
  double scale;
  if (s->radius > 0 && is_similarity(matrix, &scale)) {
    out->exact.kind = ABBE_EXACT_SPHERE;
    memcpy(out->exact.centre, matrix + 12, sizeof out->exact.centre);
    out->exact.radius = scale * s->radius;
    return ABBE_OK;
  }
  if (abbe_object_kind_of(out) == ABBE_OBJECT_REFRACTOR) return convex(out, error);
  return s->rectangles ? parallelograms(out, error) : ABBE_OK;
}

/* ---- one object, or several ---- */

static abbe_result has_crease(const abbe_mesh *mesh, bool *creased, abbe_error *error) {
  const double least = cos(ABBE_MESH_CREASE_RAD);
  abbe_topology t;
  const abbe_result result = abbe_topology_make(mesh, &t, error);
  *creased = false;
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < t.edge_count && !*creased; i++) {
    double n[2][3];
    const uint32_t *pair = t.edge[i].face;
    for (int k = 0; k < 2 && pair[1] != ABBE_TOPOLOGY_NONE; k++)
      abbe_vector_triangle(t.position[t.face[pair[k]][0]], t.position[t.face[pair[k]][1]],
                           t.position[t.face[pair[k]][2]], n[k]);
    if (pair[1] != ABBE_TOPOLOGY_NONE && abbe_vector_normalise(n[0]) && abbe_vector_normalise(n[1]))
      *creased = abbe_vector_dot(n[0], n[1]) < least;
  }
  abbe_topology_free(&t);
  return ABBE_OK;
}

/* A file without normals does not say whether its solid is cut or rounded, and a stone's facets
 * meet at small angles too. A convex solid of a few planes that has an edge as sharp as a crease is
 * cut. */
static abbe_result choose_facets(abbe_mesh *mesh, abbe_error *error) {
  double(*plane)[4] = malloc(ABBE_SCENE_MAX_PLANES * sizeof *plane);
  abbe_convex found = {0};
  bool creased = false;
  abbe_result result =
      plane ? abbe_convex_find(mesh, ABBE_SCENE_MAX_PLANES, plane, NULL, &found, error)
            : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for face planes");
  if (result == ABBE_OK && found.verdict == ABBE_CONVEX_ROUNDED)
    result = has_crease(mesh, &creased, error);
  if (creased) result = abbe_mesh_compute_normals(mesh, ABBE_NORMALS_FLAT, error);
  free(plane);
  return result;
}

static abbe_result add_note(abbe_object *out, const char *text, abbe_error *error) {
  const size_t size = (out->fixes ? strlen(out->fixes) : 0) + strlen(text) + 3;
  char *all = malloc(size);
  if (!all) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a sentence");
  snprintf(all, size, "%s%s%s", out->fixes ? out->fixes : "", out->fixes ? "; " : "", text);
  free(out->fixes);
  out->fixes = all;
  return ABBE_OK;
}

static abbe_result note_parts(abbe_object *out, size_t parts, abbe_error *error) {
  char text[96];
  snprintf(text, sizeof text,
           "parts of the mesh cross, and are followed as %zu solids that overlap", parts);
  return add_note(out, text, error);
}

/* Part i of an object, as an object of its own. */
static abbe_result make_part(const abbe_object *whole, size_t i, size_t count, abbe_mesh *mesh,
                             abbe_object *out, abbe_error *error) {
  const size_t size = strlen(whole->name) + 64;
  out->mesh = *mesh;
  memset(mesh, 0, sizeof *mesh);
  out->material = whole->material;
  memcpy(out->axis, whole->axis, sizeof out->axis);
  memcpy(out->axis_x, whole->axis_x, sizeof out->axis_x);
  out->axes_turned = whole->axes_turned;
  out->line = whole->line;
  out->name = malloc(size);
  if (!out->name) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  snprintf(out->name, size, "%s (part %zu of %zu)", whole->name, i + 1, count);
  return abbe_medium_copy(whole->medium, &out->medium, error);
}

/* A refractor's mesh, closed; where shells cross, as several solids. */
static abbe_result solidify(const abbe_object_surface *s, abbe_object *out, size_t room,
                            size_t *count, abbe_error *error) {
  abbe_mesh *part = NULL;
  size_t parts = 1;
  abbe_result result = abbe_mesh_fix(&out->mesh, s->normals, &parts, &out->fixes, error);
  if (result == ABBE_OK && parts > 1) result = abbe_mesh_split(&out->mesh, &part, &parts, error);
  if (result != ABBE_OK || parts < 2) return result;
  if (parts > room)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "%zu parts of the mesh cross, and the scene has room for %zu objects "
                            "more, of %d",
                            parts, room, ABBE_SCENE_MAX_OBJECTS);
  if (result == ABBE_OK) {
    abbe_mesh_free(&out->mesh);
    out->mesh = part[0];
    memset(&part[0], 0, sizeof part[0]);
  }
  for (size_t i = 1; i < parts && result == ABBE_OK; i++) {
    *count = i + 1;
    result = make_part(out, i, parts, &part[i], &out[i], error);
  }
  for (size_t i = 0; i < parts; i++) abbe_mesh_free(&part[i]);
  free(part);
  return result == ABBE_OK ? note_parts(out, parts, error) : result;
}

/* Makes one part the convex solid of few planes that it nearly is, and says so. */
static abbe_result flatten(const abbe_object_surface *s, abbe_object *out, abbe_error *error) {
  double moved = 0;
  char text[128];
  ABBE_TRY(abbe_convex_flatten(&out->mesh, s->flatten, ABBE_SCENE_MAX_PLANES, &moved, error));
  ABBE_TRY(abbe_mesh_fix(&out->mesh, ABBE_NORMALS_FLAT, NULL, NULL, error));
  abbe_number_format(
      text, sizeof text,
      "made a convex solid of planes, of which its corners lie up to %.2g %% of its size off",
      100 * moved);
  return add_note(out, text, error);
}

/* Whether it is cut or rounded. */
static abbe_result shape_one(const abbe_object_surface *s, abbe_object *out, abbe_error *error) {
  if (abbe_object_kind_of(out) != ABBE_OBJECT_REFRACTOR) return ABBE_OK;
  if (s->flatten > 0) return flatten(s, out, error);
  return s->file && s->normals == ABBE_NORMALS_AUTO && !out->mesh.given_normals
             ? choose_facets(&out->mesh, error)
             : ABBE_OK;
}

static abbe_result place_one(const abbe_object_surface *s, const double matrix[16],
                             abbe_object *out, abbe_error *error) {
  ABBE_TRY(abbe_mesh_transform(&out->mesh, matrix, error));
  abbe_object_turn_axes(out, matrix);
  abbe_brushing_move(&out->brushing, matrix);
  ABBE_TRY(find_exact(s, matrix, out, error));
  abbe_object_bound(out);
  if (!(abbe_vector_finite(out->min) && abbe_vector_finite(out->max)))
    return abbe_error_set(error, ABBE_GEOMETRY, "the placed object has no finite size");
  return ABBE_OK;
}

abbe_result abbe_object_place(const abbe_object_surface *s, abbe_object *out, size_t room,
                              size_t *count, abbe_error *error) {
  double matrix[16];
  *count = 1;
  ABBE_TRY(abbe_object_kind_of(out) == ABBE_OBJECT_REFRACTOR ? solidify(s, out, room, count, error)
                                                             : ABBE_OK);
  for (size_t i = 0; i < *count; i++) ABBE_TRY(shape_one(s, &out[i], error));
  /* what was dropped has no part in its size */
  ABBE_TRY(fit_matrix(s, out, *count, matrix, error));
  for (size_t i = 0; i < *count; i++) ABBE_TRY(place_one(s, matrix, &out[i], error));
  return ABBE_OK;
}

static abbe_result load(const char *path, const char *column, abbe_spectrum **out,
                        abbe_error *error) {
  abbe_csv_points points;
  const abbe_csv_options options = {.quantity = ABBE_CSV_REFLECTANCE, .column = column};
  abbe_result result = abbe_csv_points_load(path, &options, &points, NULL, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < points.power.count && result == ABBE_OK; i++)
    if (points.power.point[i].value > 1)
      result = abbe_error_set(error, ABBE_SCHEMA,
                              "%s: the reflectance at %g nm is %g; it is 0 to 1 (of per cent: "
                              "divide by 100)",
                              path, points.power.point[i].lambda_nm, points.power.point[i].value);
  if (result == ABBE_OK)
    result = abbe_points_spectrum(&points.power, ABBE_INTERPOLATION_LINEAR, out, error);
  abbe_csv_points_free(&points);
  return result;
}

static abbe_result load_file(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                             const char *name, abbe_object *out, abbe_error *error) {
  char *column = NULL;
  abbe_result result = abbe_yaml_get_string(yaml, node, "column", &column, error);
  if (result == ABBE_OK) {
    out->spectrum_path = abbe_scene_value_path(folder, name);
    result = out->spectrum_path ? load(out->spectrum_path, column, &out->spectrum, error)
                                : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
    if (result != ABBE_OK)
      abbe_scene_value_locate(yaml, abbe_yaml_get(yaml, node, "spectrum"), result, error);
  }
  free(column);
  return result;
}

/* Its linear Rec.709 under D65, kept within 0 to 1. */
static abbe_result find_colour(abbe_object *out, abbe_error *error) {
  const abbe_illuminant d65 = {0};
  abbe_reflected_light *light = NULL;
  ABBE_TRY(abbe_reflected_light_make(&d65, ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, &light,
                                     error));
  double xyz[3][3], matrix[9];
  abbe_reflected_light_xyz(light, out->spectrum, xyz);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz[0], out->reflectance);
  for (int k = 0; k < 3; k++) out->reflectance[k] = fmin(fmax(out->reflectance[k], 0), 1);
  abbe_reflected_light_free(light);
  return ABBE_OK;
}

abbe_result abbe_reflectance_file_read(abbe_yaml *yaml, abbe_yaml_node node, const char *folder,
                                       abbe_object *out, abbe_error *error) {
  char *patch = NULL, *file = NULL;
  abbe_result result = abbe_yaml_get_string(yaml, node, "patch", &patch, error);
  if (result == ABBE_OK) result = abbe_yaml_get_string(yaml, node, "spectrum", &file, error);
  const bool column = abbe_yaml_get(yaml, node, "column").id != 0;
  if (result == ABBE_OK) result = abbe_yaml_check_keys(yaml, node, "'reflectance'", error);
  if (result == ABBE_OK && ((patch == NULL) == (file == NULL) || (patch != NULL && column)))
    result =
        abbe_yaml_fail(yaml, node, error,
                       "a measured 'reflectance' is either {spectrum: FILE} with a 'column' if "
                       "the file has several, or {patch: NAME} of the ColorChecker");
  if (result == ABBE_OK && file != NULL) result = load_file(yaml, node, folder, file, out, error);
  if (result == ABBE_OK && patch != NULL) {
    result = abbe_colour_checker_make(patch, &out->spectrum, error);
    if (result != ABBE_OK)
      abbe_scene_value_locate(yaml, abbe_yaml_get(yaml, node, "patch"), result, error);
  }
  free(patch);
  free(file);
  return result == ABBE_OK ? find_colour(out, error) : result;
}
