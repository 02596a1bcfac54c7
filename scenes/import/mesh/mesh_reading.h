/* mesh_reading.h: what the readers of mesh files collect, and the mesh that it makes.
 *
 * Points, texture coordinates and normals are in lists of their own, and polygons name them by
 * corner, as files do. Readers of the formats are declared here as well. Internal to scenes/.
 */
#ifndef ABBE_SCENES_IMPORT_MESH_MESH_READING_H
#define ABBE_SCENES_IMPORT_MESH_MESH_READING_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_MESH_READING_NONE UINT32_MAX

/* A growing list. */
typedef struct abbe_mesh_list {
  void *item;
  size_t count, capacity;
} abbe_mesh_list;

typedef struct abbe_mesh_corner {
  uint32_t point, uv, normal; /* indices; it has no uv or normal where there is none of that */
} abbe_mesh_corner;

typedef struct abbe_mesh_reading {
  const char *path, *material;      /* material: triangles of that name alone are read; NULL: all */
  abbe_mesh_list point, uv, normal; /* lists of double[3], double[2], double[3] */
  abbe_mesh_list corner,
      sides;             /* a list of abbe_mesh_corner; one of uint32_t: corners of each polygon */
  size_t open;           /* corners of the polygon that is being read */
  abbe_mesh_list others; /* a list of char: paths that the file names, each with its zero */
  size_t line;           /* that is being read, from 1; 0: the format has none */
  uint32_t farthest;     /* the greatest point that a corner names, */
  size_t farthest_line;  /* and the first line that does */
} abbe_mesh_reading;

/* Whether the list could grow by count items of size bytes, which are at *to. False too where it
 * would have more than a mesh may have vertices. */
bool abbe_mesh_list_add(abbe_mesh_list *list, size_t count, size_t size, const void *from);

/* These are false where memory lacks. A polygon is ended after its corners; one of fewer than three
 * is dropped. */
bool abbe_mesh_reading_point(abbe_mesh_reading *r, const double at[3]);
bool abbe_mesh_reading_corner(abbe_mesh_reading *r, abbe_mesh_corner corner);
bool abbe_mesh_reading_end_polygon(abbe_mesh_reading *r);
abbe_result abbe_mesh_reading_no_memory(const abbe_mesh_reading *r, abbe_error *error);

/* The mesh of all polygons, cut into triangles; normals (given_normals) where all corners have
 * them, else zero, and uv where a corner has some. Where these have indices of their own, each
 * corner becomes a vertex. ABBE_GEOMETRY for coordinates that are not finite, corners without a
 * point, and where there are no polygons, ABBE_UNSUPPORTED, ABBE_NO_MEMORY. */
abbe_result abbe_mesh_reading_finish(const abbe_mesh_reading *r, abbe_mesh *out, abbe_error *error);
void abbe_mesh_reading_free(abbe_mesh_reading *r);

/* The formats. data is the whole file, with a zero byte past its end. ABBE_PARSE with the line or
 * the element that is wrong, ABBE_UNSUPPORTED for what is not read. */
abbe_result abbe_obj_read(abbe_mesh_reading *r, const char *data, size_t size, abbe_error *error);
abbe_result abbe_ply_read(abbe_mesh_reading *r, const char *data, size_t size, abbe_error *error);
abbe_result abbe_stl_read(abbe_mesh_reading *r, const char *data, size_t size, abbe_error *error);
abbe_result abbe_gltf_read(abbe_mesh_reading *r, const char *data, size_t size, abbe_error *error);

/* Cuts the polygons of mesh files into triangles.
 *
 * A polygon's corners lie in a plane or near one, in order around it. It may be concave, have
 * corners in line, and pass points twice, as where a bridge leads to a hole. Whether corners turn
 * left or right is decided exactly. No corners are added. */

/* What all polygons of a file may take together, counted in looks at a corner, each of some
 * nanoseconds: so much, and so much more for each of their corners. */
#define ABBE_POLYGON_WORK 4e9
#define ABBE_POLYGON_WORK_A_CORNER 200.0

/* Cuts it into count - 2 triangles (count >= 3), which run around as it does: triangle[i] are
 * indices into corner. Of a polygon that does not cross itself, seen along the axis that is nearest
 * its normal, they lie inside and not over one another; those of one that does cross itself, or
 * has no area, are any. Longer polygons than four corners get the triangles of Delaunay.
 * *work is what it may take, and then what is left of that. ABBE_UNSUPPORTED where it takes more,
 * ABBE_NO_MEMORY. */
abbe_result abbe_polygon_cut(const double (*corner)[3], size_t count, uint32_t (*triangle)[3],
                             double *work, abbe_error *error);

#endif
