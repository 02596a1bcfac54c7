/* mesh.h: triangle meshes: loading through assimp, checking, mending, subdividing.
 *
 * Refractors must be closed, consistently oriented (normals outwards) and free of degenerate
 * faces; abbe_mesh_check says what is wrong and abbe_mesh_mend mends what is safe to mend.
 */
#ifndef ABBE_SCENES_MESH_H
#define ABBE_SCENES_MESH_H

#include "spectral/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_MESH_MAX_VERTICES 50000000u
#define ABBE_MESH_MAX_FACES 50000000u

typedef struct abbe_mesh {
  size_t vertex_count, face_count;
  double (*position)[3]; /* [vertex_count], metres */
  double (*normal)[3];   /* [vertex_count], unit, outwards; faceted meshes have split vertices */
  double (*uv)[2];       /* [vertex_count] or NULL */
  uint32_t (*face)[3];   /* [face_count] vertex indices, counter-clockwise seen from outside */
} abbe_mesh;

/* Room for the given counts, zeroed; uv too where with_uv. Checks sizes first. */
abbe_result abbe_mesh_make(size_t vertices, size_t faces, bool with_uv, abbe_mesh *out,
                           abbe_error *error);
void abbe_mesh_free(abbe_mesh *mesh);

/* Loads OBJ, PLY, STL or glTF; all its meshes as one. smooth: shared normals across faces
 * (area-weighted); else one normal a face. ABBE_PARSE with assimp's reason, ABBE_GEOMETRY for
 * coordinates that are not finite or a file without triangles. */
abbe_result abbe_mesh_load(const char *path, bool smooth, abbe_mesh *out, abbe_error *error);

typedef struct abbe_mesh_report {
  size_t open_edges;        /* edges with one face */
  size_t crowded_edges;     /* edges with more than two */
  size_t flipped_edges;     /* edges that both faces run along in the same direction */
  size_t degenerate_faces;  /* zero area or repeated positions */
  size_t shells;            /* connected components (by position) */
  double volume;            /* signed, m3; negative: inside out */
  double area;              /* m2 */
  double min[3], max[3];    /* bounds */
} abbe_mesh_report;

/* Vertices at the same position count as one. */
abbe_result abbe_mesh_check(const abbe_mesh *mesh, abbe_mesh_report *report, abbe_error *error);

/* Mends what is safe: drops degenerate faces, makes orientation consistent, turns an inside-out
 * mesh, closes flat or small holes by a fan. *what (may be NULL) gets a malloc'd sentence that
 * says what was done, or NULL where nothing was. A mended mesh has new normals and no uv. Leaves
 * the mesh closed and outwards or fails with ABBE_GEOMETRY, the mesh unchanged, and a sentence
 * that counts what is wrong. */
abbe_result abbe_mesh_mend(abbe_mesh *mesh, bool smooth, char **what, abbe_error *error);

/* Whether a point lies inside the closed mesh (the parity of crossings along three rays). */
bool abbe_mesh_contains(const abbe_mesh *mesh, const double point[3]);

/* Loop subdivision [Loop1987], `levels` times (x4 faces each); smooth normals, no uv. */
abbe_result abbe_mesh_subdivide(abbe_mesh *mesh, size_t levels, abbe_error *error);

/* Fewer faces between vertices of the mesh, which keep their normals: edges are collapsed as long
 * as the mean distance to the planes of the faces that were there stays below distance_m, by
 * quadrics [GarlandHeckbert1997]. What is closed stays closed, but folds may come to share an edge;
 * where vertices are split, as a faceted mesh's are, they hold their edges. To be drawn, not to be
 * traced. *face is malloc'd, *count of them; distance_m = 0 gives the mesh's own.
 * ABBE_INVALID_ARGUMENT, ABBE_NO_MEMORY. */
abbe_result abbe_mesh_simplify(const abbe_mesh *mesh, double distance_m, uint32_t (**face)[3],
                               size_t *count, abbe_error *error);

/* Recomputes normals: smooth (area-weighted over shared positions) or one a face (splits). */
abbe_result abbe_mesh_compute_normals(abbe_mesh *mesh, bool smooth, abbe_error *error);

/* Applies a column-major 4x4 matrix to positions and normals; turns faces where it mirrors. */
abbe_result abbe_mesh_transform(abbe_mesh *mesh, const double matrix[16], abbe_error *error);

/* Where the closed mesh is a convex polyhedron with at most max_planes distinct face planes:
 * writes them (unit outward normal and offset: n . x <= d) to plane[][4] and their number to
 * *count; else *count is 0. Faces within 1e-6 of the same plane share one. ABBE_NO_MEMORY. */
abbe_result abbe_mesh_convex_planes(const abbe_mesh *mesh, size_t max_planes, double (*plane)[4],
                                    size_t *count, abbe_error *error);

#define ABBE_MESH_MAX_CONVEX_FACES 30000u

/* Whether every vertex lies behind every face, to 1e-6 of the mesh's size. Larger meshes than
 * ABBE_MESH_MAX_CONVEX_FACES are not examined: false. */
bool abbe_mesh_is_convex(const abbe_mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
