#include "scenes/shapes/shape.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_length(double x) {
  return isfinite(x) && x > 0.0;
}

static abbe_result refuse_length(const char *shape, const char *what, double value,
                                 abbe_error *error) {
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a %s with %s %g is not possible: it must be a finite length above zero",
                        shape, what, value);
}

static void set3(double out[3], double x, double y, double z) {
  out[0] = x;
  out[1] = y;
  out[2] = z;
}

static void set_face(abbe_mesh *mesh, size_t *face, size_t a, size_t b, size_t c) {
  const uint32_t corners[3] = {(uint32_t)a, (uint32_t)b, (uint32_t)c};
  memcpy(mesh->face[(*face)++], corners, sizeof corners);
}

/* --- sphere --- */

static abbe_result icosahedron(abbe_mesh *out, abbe_error *error) {
  static const uint32_t face[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const double g = 0.5 * (1.0 + sqrt(5.0));
  const double vertex[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  ABBE_TRY(abbe_mesh_make(12, 20, false, out, error));
  memcpy(out->position, vertex, sizeof vertex);
  memcpy(out->face, face, sizeof face);
  return ABBE_OK;
}

/* Every face in four; the new points stay where the edges are, for the caller to push out. */
static abbe_result split_in_four(abbe_mesh *mesh, abbe_error *error) {
  abbe_topology t;
  abbe_mesh fine;
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  abbe_result result =
      abbe_mesh_make(t.point_count + t.edge_count, 4 * t.face_count, false, &fine, error);
  if (result == ABBE_OK) {
    memcpy(fine.position, t.position, t.point_count * sizeof *fine.position);
    for (size_t e = 0; e < t.edge_count; e++)
      for (int k = 0; k < 3; k++)
        fine.position[t.point_count + e][k] =
            0.5 * (t.position[t.edge[e].a][k] + t.position[t.edge[e].b][k]);
    size_t n = 0;
    for (size_t f = 0; f < t.face_count; f++) {
      size_t mid[3];
      for (int k = 0; k < 3; k++) mid[k] = t.point_count + t.face_edge[f][k];
      for (int k = 0; k < 3; k++) set_face(&fine, &n, t.face[f][k], mid[k], mid[(k + 2) % 3]);
      set_face(&fine, &n, mid[0], mid[1], mid[2]);
    }
    abbe_mesh_free(mesh);
    *mesh = fine;
  }
  abbe_topology_free(&t);
  return result;
}

abbe_result abbe_shape_sphere(double radius, size_t levels, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (!is_length(radius)) return refuse_length("sphere", "radius", radius, error);
  if (levels > 9)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a sphere of %zu levels is not possible: at most 9 (5,242,880 faces)",
                          levels);
  abbe_result result = icosahedron(out, error);
  for (size_t level = 0; result == ABBE_OK; level++) {
    for (size_t v = 0; v < out->vertex_count; v++) abbe_vector_normalise(out->position[v]);
    if (level == levels) break;
    result = split_in_four(out, error);
  }
  for (size_t v = 0; result == ABBE_OK && v < out->vertex_count; v++) {
    memcpy(out->normal[v], out->position[v], sizeof out->normal[v]);
    for (int k = 0; k < 3; k++) out->position[v][k] *= radius;
  }
  if (result != ABBE_OK) abbe_mesh_free(out);
  return result;
}

/* --- ring --- */

abbe_result abbe_shape_ring(double major, double minor, size_t around, size_t across,
                            abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (!is_length(major)) return refuse_length("ring", "major radius", major, error);
  if (!is_length(minor)) return refuse_length("ring", "minor radius", minor, error);
  if (minor >= major)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a ring whose tube (%g) is as wide as its centre line (%g) cuts itself; "
                          "the minor radius must be the smaller",
                          minor, major);
  if (around < 3 || across < 3 || around > 4096 || across > 4096)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a ring of %zu by %zu segments is not possible: from 3 to 4096 each",
                          around, across);
  ABBE_TRY(abbe_mesh_make(around * across, 2 * around * across, false, out, error));
  size_t face = 0;
  for (size_t i = 0; i < around; i++)
    for (size_t j = 0; j < across; j++) {
      const double u = 2.0 * ABBE_PI * (double)i / (double)around;
      const double v = 2.0 * ABBE_PI * (double)j / (double)across;
      const size_t here = i * across + j;
      set3(out->normal[here], cos(u) * cos(v), sin(u) * cos(v), sin(v));
      set3(out->position[here], cos(u) * (major + minor * cos(v)),
           sin(u) * (major + minor * cos(v)), minor * sin(v));
      const size_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      set_face(out, &face, here, i1 * across + j, i1 * across + j1);
      set_face(out, &face, here, i1 * across + j1, i * across + j1);
    }
  return ABBE_OK;
}

/* --- faceted shapes --- */

abbe_result abbe_shape_gem(size_t sides, double girdle_radius, double table_radius,
                           double crown_height, double pavilion_depth, abbe_mesh *out,
                           abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (sides < 3 || sides > 1024)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a gem of %zu sides is not possible: from 3 to 1024", sides);
  if (!is_length(girdle_radius)) return refuse_length("gem", "girdle radius", girdle_radius, error);
  if (!is_length(table_radius)) return refuse_length("gem", "table radius", table_radius, error);
  if (!is_length(crown_height)) return refuse_length("gem", "crown height", crown_height, error);
  if (!is_length(pavilion_depth))
    return refuse_length("gem", "pavilion depth", pavilion_depth, error);
  if (table_radius >= girdle_radius)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a gem's table (radius %g) must be smaller than its girdle (%g)",
                          table_radius, girdle_radius);
  ABBE_TRY(abbe_mesh_make(2 * sides + 2, 4 * sides, false, out, error));
  const size_t centre = 2 * sides, culet = centre + 1;
  set3(out->position[centre], 0.0, 0.0, crown_height);
  set3(out->position[culet], 0.0, 0.0, -pavilion_depth);
  size_t face = 0;
  for (size_t i = 0; i < sides; i++) {
    const double a = 2.0 * ABBE_PI * (double)i / (double)sides, b = a + ABBE_PI / (double)sides;
    const size_t next = (i + 1) % sides;
    set3(out->position[i], table_radius * cos(a), table_radius * sin(a), crown_height);
    set3(out->position[sides + i], girdle_radius * cos(b), girdle_radius * sin(b), 0.0);
    set_face(out, &face, centre, i, next);
    set_face(out, &face, i, sides + i, next);
    set_face(out, &face, next, sides + i, sides + next);
    set_face(out, &face, culet, sides + next, sides + i);
  }
  return abbe_mesh_compute_normals(out, ABBE_NORMALS_FLAT, error);
}

abbe_result abbe_shape_prism(double apex_rad, double side, double length, abbe_mesh *out,
                             abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (!is_length(side)) return refuse_length("prism", "side", side, error);
  if (!is_length(length)) return refuse_length("prism", "length", length, error);
  if (!(apex_rad > 1e-6 && apex_rad < ABBE_PI - 1e-6))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a prism with an apex of %g degrees is not possible: between 0 and 180",
                          apex_rad * 180.0 / ABBE_PI);
  static const uint32_t face[8][3] = {{0, 1, 2}, {3, 5, 4}, {0, 4, 1}, {0, 3, 4},
                                      {1, 5, 2}, {1, 4, 5}, {2, 3, 0}, {2, 5, 3}};
  ABBE_TRY(abbe_mesh_make(6, 8, false, out, error));
  const double height = side * cos(0.5 * apex_rad), half = side * sin(0.5 * apex_rad);
  for (size_t end = 0; end < 2; end++) {
    const double y = end ? 0.5 * length : -0.5 * length;
    set3(out->position[3 * end], 0.0, y, height * 2.0 / 3.0);
    set3(out->position[3 * end + 1], -half, y, -height / 3.0);
    set3(out->position[3 * end + 2], half, y, -height / 3.0);
  }
  memcpy(out->face, face, sizeof face);
  return abbe_mesh_compute_normals(out, ABBE_NORMALS_FLAT, error);
}

abbe_result abbe_shape_rectangle(double width, double height, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (!is_length(width)) return refuse_length("rectangle", "width", width, error);
  if (!is_length(height)) return refuse_length("rectangle", "height", height, error);
  ABBE_TRY(abbe_mesh_make(4, 2, true, out, error));
  for (size_t v = 0; v < 4; v++) {
    const double u = v == 1 || v == 2 ? 1.0 : 0.0, w = v >= 2 ? 1.0 : 0.0;
    set3(out->position[v], width * (u - 0.5), height * (w - 0.5), 0.0);
    set3(out->normal[v], 0.0, 0.0, 1.0);
    out->uv[v][0] = u;
    out->uv[v][1] = w;
  }
  size_t face = 0;
  set_face(out, &face, 0, 1, 2);
  set_face(out, &face, 0, 2, 3);
  return ABBE_OK;
}

abbe_result abbe_shape_box(const double size[3], abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  for (int k = 0; k < 3; k++)
    if (!is_length(size[k])) return refuse_length("box", "edge", size[k], error);
  ABBE_TRY(abbe_mesh_make(24, 12, true, out, error));
  size_t face = 0;
  for (size_t side = 0; side < 6; side++) {
    /* the axes u, v, n of a side are a right-handed turn of x, y, z */
    const size_t n = side / 2, u = (n + 1) % 3, v = (n + 2) % 3;
    const double sign = side % 2 ? -1.0 : 1.0;
    for (size_t corner = 0; corner < 4; corner++) {
      const size_t at = 4 * side + corner;
      const double a = corner == 1 || corner == 2 ? 1.0 : 0.0, b = corner >= 2 ? 1.0 : 0.0;
      out->position[at][n] = 0.5 * sign * size[n];
      out->position[at][u] = sign * size[u] * (a - 0.5);
      out->position[at][v] = size[v] * (b - 0.5);
      out->normal[at][n] = sign;
      out->uv[at][0] = a;
      out->uv[at][1] = b;
    }
    set_face(out, &face, 4 * side, 4 * side + 1, 4 * side + 2);
    set_face(out, &face, 4 * side, 4 * side + 2, 4 * side + 3);
  }
  return ABBE_OK;
}

/* --- lathe --- */

static abbe_result check_profile(const double (*profile)[2], size_t count, size_t around,
                                 abbe_error *error) {
  if (count < 2 || count > ABBE_SHAPE_MAX_PROFILE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a lathe profile of %zu points is not possible: from 2 to %u", count,
                          ABBE_SHAPE_MAX_PROFILE);
  if (around < 3 || around > 4096)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a lathe of %zu segments around is not possible: from 3 to 4096", around);
  for (size_t i = 0; i < count; i++) {
    const bool end = i == 0 || i == count - 1;
    if (!isfinite(profile[i][0]) || !isfinite(profile[i][1]) || !(profile[i][0] >= 0.0) ||
        (!end && profile[i][0] == 0.0))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "point %zu of the lathe profile is (%g, %g): radii must be above 0, "
                            "and only the ends may lie on the axis",
                            i + 1, profile[i][0], profile[i][1]);
    if (i > 0 && profile[i][0] == profile[i - 1][0] && profile[i][1] == profile[i - 1][1])
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "points %zu and %zu of the lathe profile are the same", i, i + 1);
  }
  if (count == 2 && profile[0][0] == 0.0 && profile[1][0] == 0.0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "both points of the lathe profile lie on the axis");
  return ABBE_OK;
}

/* Outward normal (r, z) of the profile's segment i. */
static void segment_normal(const double (*profile)[2], size_t i, double n[2]) {
  const double dr = profile[i + 1][0] - profile[i][0], dz = profile[i + 1][1] - profile[i][1];
  const double length = hypot(dr, dz);
  n[0] = dz / length;
  n[1] = -dr / length;
}

/* Normal of segment i at its end (0 first, 1 second): shared with the neighbour where the profile
 * bends by 30 degrees or less; on the axis the mirrored segment is the neighbour, at a rim none is.
 */
static void end_normal(const double (*profile)[2], size_t count, size_t i, size_t end,
                       double n[2]) {
  const double smooth = cos(30.0 * ABBE_PI / 180.0);
  double own[2], other[2];
  segment_normal(profile, i, own);
  memcpy(n, own, sizeof own);
  if ((i == 0 && end == 0) || (i == count - 2 && end == 1)) {
    if (profile[i + end][0] != 0.0) return;
    other[0] = -own[0];
    other[1] = own[1];
  } else {
    segment_normal(profile, end ? i + 1 : i - 1, other);
  }
  if (own[0] * other[0] + own[1] * other[1] < smooth) return;
  const double sum[2] = {own[0] + other[0], own[1] + other[1]};
  const double length = hypot(sum[0], sum[1]);
  n[0] = sum[0] / length;
  n[1] = sum[1] / length;
}

/* The two rings of segment i, and its faces. On the axis a vertex serves one face, with the
 * normal half way round it. */
static void lathe_segment(const double (*profile)[2], size_t count, size_t i, size_t around,
                          abbe_mesh *out, size_t *face) {
  const size_t first = 2 * i * around;
  const bool bottom = profile[i][0] == 0.0, top = profile[i + 1][0] == 0.0;
  for (size_t end = 0; end < 2; end++) {
    double n[2];
    end_normal(profile, count, i, end, n);
    const double r = profile[i + end][0], z = profile[i + end][1];
    for (size_t j = 0; j < around; j++) {
      const double turn = (end == 0 ? bottom : top) ? 0.5 : 0.0;
      const double a = 2.0 * ABBE_PI * ((double)j + turn) / (double)around;
      const size_t at = first + end * around + j;
      set3(out->position[at], r * cos(a), r * sin(a), z);
      set3(out->normal[at], n[0] * cos(a), n[0] * sin(a), n[1]);
    }
  }
  for (size_t j = 0; j < around; j++) {
    const size_t j1 = (j + 1) % around, low = first, high = first + around;
    if (!bottom) set_face(out, face, low + j, low + j1, top ? high + j : high + j1);
    if (!top) set_face(out, face, low + j, high + j1, high + j);
  }
}

abbe_result abbe_shape_lathe(const double (*profile)[2], size_t count, size_t around,
                             abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  ABBE_TRY(check_profile(profile, count, around, error));
  const size_t segments = count - 1;
  const size_t points = (profile[0][0] == 0.0 ? 1u : 0u) + (profile[segments][0] == 0.0 ? 1u : 0u);
  ABBE_TRY(
      abbe_mesh_make(2 * segments * around, (2 * segments - points) * around, false, out, error));
  size_t face = 0;
  for (size_t i = 0; i < segments; i++) lathe_segment(profile, count, i, around, out, &face);
  return ABBE_OK;
}

abbe_result abbe_shape_round_profile(const double (*profile)[2], size_t count, size_t times,
                                     double (**out)[2], size_t *out_count, abbe_error *error) {
  *out = NULL;
  *out_count = 0;
  size_t final = count;
  if (count < 2) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a profile needs 2 points");
  for (size_t i = 0; i < times; i++) {
    if (final > ABBE_SHAPE_MAX_PROFILE) break;
    final = 2 * (final - 2) + 2;
  }
  if (final > ABBE_SHAPE_MAX_PROFILE || times > 16)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a profile of %zu points rounded %zu times has more than %u points",
                          count, times, ABBE_SHAPE_MAX_PROFILE);
  double(*now)[2] = malloc(final * sizeof *now), (*next)[2] = malloc(final * sizeof *next);
  if (!now || !next) {
    free(now);
    free(next);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a lathe profile");
  }
  memcpy(now, profile, count * sizeof *now);
  for (size_t i = 0; i < times; i++) {
    size_t n = 0;
    memcpy(next[n++], now[0], sizeof *now);
    for (size_t p = 1; p + 1 < count; p++)
      for (size_t side = 0; side < 2; side++, n++)
        for (int k = 0; k < 2; k++)
          next[n][k] = 0.75 * now[p][k] + 0.25 * now[side ? p + 1 : p - 1][k];
    memcpy(next[n++], now[count - 1], sizeof *now);
    double(*spare)[2] = now;
    now = next;
    next = spare;
    count = n;
  }
  free(next);
  *out = now;
  *out_count = count;
  return ABBE_OK;
}

/* What of v runs along the surface; false where next to nothing does. */
static bool flatten(const double n[3], double v[3]) {
  const double least = 1e-9, before = abbe_vector_length(v), along = abbe_vector_dot(n, v);
  for (int k = 0; k < 3; k++) v[k] -= along * n[k];
  return abbe_vector_length(v) > least * before && abbe_vector_normalise(v);
}

void abbe_brushing_grain(const abbe_brushing *b, const double p[3], const double n[3],
                         double along[3]) {
  double from[3];
  memcpy(along, b->axis, 3 * sizeof *along);
  if (b->around) {
    abbe_vector_subtract(p, b->centre, from);
    abbe_vector_cross(b->axis, from, along);
  }
  if (flatten(n, along)) return;
  const int least = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2)
                                            : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
  for (int k = 0; k < 3; k++) along[k] = k == least;
  flatten(n, along);
}

void abbe_brushing_move(abbe_brushing *b, const double matrix[16]) {
  abbe_transform_direction(matrix, b->axis, b->axis);
  abbe_vector_normalise(b->axis);
  abbe_transform_point(matrix, b->centre, b->centre);
}
