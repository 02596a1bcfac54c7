#include "scenes/import/mesh/mesh_reading.h"

#include "base/maths.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool abbe_mesh_list_add(abbe_mesh_list *list, size_t count, size_t size, const void *from) {
  const size_t most = 3 * (size_t)ABBE_MESH_MAX_FACES;
  if (count > most - list->count) return false;
  if (list->count + count > list->capacity) {
    size_t capacity = 2 * list->capacity > 256 ? 2 * list->capacity : 256;
    if (capacity < list->count + count) capacity = list->count + count;
    void *more = realloc(list->item, capacity * size);
    if (more == NULL) return false;
    list->item = more;
    list->capacity = capacity;
  }
  memcpy((char *)list->item + list->count * size, from, count * size);
  list->count += count;
  return true;
}

bool abbe_mesh_reading_point(abbe_mesh_reading *r, const double at[3]) {
  return abbe_mesh_list_add(&r->point, 1, 3 * sizeof *at, at);
}

bool abbe_mesh_reading_corner(abbe_mesh_reading *r, abbe_mesh_corner corner) {
  r->open++;
  if (corner.point > r->farthest || r->farthest_line == 0) {
    r->farthest = corner.point;
    r->farthest_line = r->line;
  }
  return abbe_mesh_list_add(&r->corner, 1, sizeof corner, &corner);
}

bool abbe_mesh_reading_end_polygon(abbe_mesh_reading *r) {
  const uint32_t sides = (uint32_t)r->open;
  if (r->open < 3) r->corner.count -= r->open;
  r->open = 0;
  return sides < 3 || abbe_mesh_list_add(&r->sides, 1, sizeof sides, &sides);
}

abbe_result abbe_mesh_reading_no_memory(const abbe_mesh_reading *r, abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for so large a mesh", r->path);
}

void abbe_mesh_reading_free(abbe_mesh_reading *r) {
  abbe_mesh_list *const all[] = {&r->point, &r->uv, &r->normal, &r->corner, &r->sides, &r->others};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
    free(all[i]->item);
    *all[i] = (abbe_mesh_list){0};
  }
}

/* ---- the mesh ---- */

/* Fails for a face whose corner's point is none. */
static abbe_result fail_point(const abbe_mesh_reading *r, size_t face, uint32_t point,
                              abbe_error *error) {
  if (r->line > 0)
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "%s: line %zu: a face names vertex %" PRIu32
                          ", counted from 1, that is none of the file's %zu",
                          r->path, r->farthest_line, r->farthest + 1, r->point.count);
  return abbe_error_set(error, ABBE_GEOMETRY,
                        "%s: face %zu names vertex %" PRIu32
                        ", counted from 0, that is none of the file's %zu",
                        r->path, face + 1, point, r->point.count);
}

static abbe_result check(const abbe_mesh_reading *r, abbe_error *error) {
  const double(*point)[3] = r->point.item;
  const uint32_t *sides = r->sides.item;
  const abbe_mesh_corner *corner = r->corner.item;
  if (r->sides.count == 0 && r->material != NULL)
    return abbe_error_set(error, ABBE_GEOMETRY, "%s: no triangle is of a material called '%.80s'",
                          r->path, r->material);
  if (r->sides.count == 0)
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "%s: no faces were read from it: points and lines alone have no surface",
                          r->path);
  for (size_t i = 0; i < r->point.count; i++)
    if (!abbe_vector_finite(point[i]))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "%s: vertex %zu is at (%g, %g, %g); coordinates must be finite",
                            r->path, i, point[i][0], point[i][1], point[i][2]);
  for (size_t f = 0; f < r->sides.count; corner += sides[f++])
    for (uint32_t k = 0; k < sides[f]; k++)
      if (corner[k].point >= r->point.count) return fail_point(r, f, corner[k].point, error);
  return ABBE_OK;
}

/* What corners have. */
typedef struct features {
  bool normals, uv, split;
} features;

static features find_features(const abbe_mesh_reading *r) {
  const abbe_mesh_corner *corner = r->corner.item;
  features has = {.normals = true};
  for (size_t i = 0; i < r->corner.count; i++) {
    const bool normal = corner[i].normal < r->normal.count, uv = corner[i].uv < r->uv.count;
    has.normals = has.normals && normal;
    has.uv = has.uv || uv;
    has.split = has.split || (normal && corner[i].normal != corner[i].point) ||
                (uv && corner[i].uv != corner[i].point);
  }
  return has;
}

static void copy_if_finite(const double *from, size_t count, double *to) {
  for (size_t k = 0; k < count; k++)
    if (!isfinite(from[k])) return;
  memcpy(to, from, count * sizeof *to);
}

/* Vertices of the corners that name them. */
static void fill_vertices(const abbe_mesh_reading *r, const features *has, abbe_mesh *out) {
  const double(*point)[3] = r->point.item, (*normal)[3] = r->normal.item, (*uv)[2] = r->uv.item;
  const abbe_mesh_corner *corner = r->corner.item;
  if (!has->split) memcpy(out->position, point, r->point.count * sizeof *point);
  for (size_t i = 0; i < r->corner.count; i++) {
    const size_t v = has->split ? i : corner[i].point;
    if (has->split) memcpy(out->position[v], point[corner[i].point], sizeof *point);
    if (has->normals) copy_if_finite(normal[corner[i].normal], 3, out->normal[v]);
    if (has->uv && corner[i].uv < r->uv.count) copy_if_finite(uv[corner[i].uv], 2, out->uv[v]);
  }
  out->given_normals = has->normals;
}

/* Faces of the polygon whose first corner is that; place has capacity for its corners. */
static abbe_result cut(const abbe_mesh_reading *r, const features *has, size_t first, size_t sides,
                       double (*place)[3], uint32_t (*face)[3], double *work, abbe_error *error) {
  const double(*point)[3] = r->point.item;
  const abbe_mesh_corner *corner = (const abbe_mesh_corner *)r->corner.item + first;
  for (size_t k = 0; k < sides && sides > 3; k++)
    memcpy(place[k], point[corner[k].point], sizeof *place);
  ABBE_TRY(abbe_polygon_cut((const double(*)[3])place, sides, face, work, error));
  for (size_t t = 0; t + 2 < sides; t++)
    for (int k = 0; k < 3; k++)
      face[t][k] = has->split ? (uint32_t)first + face[t][k] : corner[face[t][k]].point;
  return ABBE_OK;
}

static abbe_result cut_all(const abbe_mesh_reading *r, const features *has, size_t longest,
                           abbe_mesh *out, abbe_error *error) {
  const uint32_t *sides = r->sides.item;
  double(*place)[3] = malloc(longest * sizeof *place);
  abbe_result result = place == NULL ? abbe_mesh_reading_no_memory(r, error) : ABBE_OK;
  size_t first = 0, face = 0;
  double work = ABBE_POLYGON_WORK + ABBE_POLYGON_WORK_A_CORNER * (double)r->corner.count;
  for (size_t f = 0; f < r->sides.count && result == ABBE_OK; f++) {
    abbe_error why;
    result = cut(r, has, first, sides[f], place, out->face + face, &work, &why);
    if (result != ABBE_OK)
      abbe_error_set(error, result, "%s: face %zu: %s", r->path, f + 1, why.text);
    first += sides[f];
    face += sides[f] - 2;
  }
  free(place);
  return result;
}

abbe_result abbe_mesh_reading_finish(const abbe_mesh_reading *r, abbe_mesh *out,
                                     abbe_error *error) {
  const uint32_t *sides = r->sides.item;
  size_t longest = 3;
  memset(out, 0, sizeof *out);
  ABBE_TRY(check(r, error));
  const features has = find_features(r);
  for (size_t f = 0; f < r->sides.count; f++)
    if (sides[f] > longest) longest = sides[f];
  const size_t vertices = has.split ? r->corner.count : r->point.count;
  const size_t faces = r->corner.count - 2 * r->sides.count;
  if (vertices > ABBE_MESH_MAX_VERTICES || faces > ABBE_MESH_MAX_FACES)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: it has %zu vertices and %zu triangles; at the most %u of each are "
                          "read",
                          r->path, vertices, faces, ABBE_MESH_MAX_FACES);
  ABBE_TRY(abbe_mesh_make(vertices, faces, has.uv, out, error));
  fill_vertices(r, &has, out);
  abbe_result result = cut_all(r, &has, longest, out, error);
  if (result != ABBE_OK) abbe_mesh_free(out);
  return result;
}
