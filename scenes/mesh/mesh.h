/* mesh.h: triangle meshes: loading, checking, fixing, subdividing.
 *
 * Refractors must be closed, consistently oriented (normals outwards) and free of degenerate
 * faces; abbe_mesh_check says what is wrong and abbe_mesh_fix fixes what is safe to fix.
 */
#ifndef ABBE_SCENES_MESH_MESH_H
#define ABBE_SCENES_MESH_MESH_H

#include "base/error.h"
#include "base/maths.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_MESH_MAX_VERTICES 50000000u
#define ABBE_MESH_MAX_FACES 50000000u

typedef struct abbe_mesh {
  size_t vertex_count, face_count;
  double (*position)[3]; /* [vertex_count], metres */
  double (*normal)[3];   /* [vertex_count], unit, outwards; faceted meshes have split vertices */
  double (*uv)[2];       /* [vertex_count] or NULL */
  uint32_t (*face)[3];   /* [face_count] vertex indices, counter-clockwise seen from outside */
  bool given_normals;    /* they are its file's own */
} abbe_mesh;

/* Which normals the corners of faces have. */
typedef enum abbe_mesh_normals {
  ABBE_NORMALS_FLAT,   /* their face's */
  ABBE_NORMALS_SMOOTH, /* one a point, of all faces there, by their areas */
  ABBE_NORMALS_AUTO /* the file's own; else one a point of those faces there that turn from one to
                       the next by no more than ABBE_MESH_CREASE_RAD, by their angles there */
} abbe_mesh_normals;

#define ABBE_MESH_CREASE_RAD (30 * ABBE_PI / 180)

/* Allocates a mesh of the given counts, zeroed; uv too where with_uv. Checks sizes first. */
abbe_result abbe_mesh_make(size_t vertices, size_t faces, bool with_uv, abbe_mesh *out,
                           abbe_error *error);
void abbe_mesh_free(abbe_mesh *mesh);

/* Loads OBJ, PLY, STL or glTF; all its meshes as one. An STL's normals are those of its faces and
 * not taken. ABBE_PARSE with the line or element that is wrong, ABBE_UNSUPPORTED with the name of
 * what is not read, ABBE_GEOMETRY for coordinates that are not finite or a file without faces.
 * *others (may be NULL) gets the paths of the files that it names and that were read with it, such
 * as a glTF's buffers: malloc'd, each ends with a zero, an empty one is behind the last; NULL where
 * there are none. */
abbe_result abbe_mesh_load(const char *path, abbe_mesh_normals normals, abbe_mesh *out,
                           char **others, abbe_error *error);
/* The same of the triangles alone whose material has that name in the file; NULL: all. */
abbe_result abbe_mesh_load_part(const char *path, const char *material, abbe_mesh_normals normals,
                                abbe_mesh *out, char **others, abbe_error *error);

typedef struct abbe_mesh_report {
  size_t open_edges;       /* edges with one face */
  size_t touching_edges;   /* edges with more than two that pair up around bodies */
  size_t crowded_edges;    /* edges with more than two that do not */
  size_t flipped_edges;    /* edges that both faces run along in the same direction */
  size_t degenerate_faces; /* zero area or repeated positions */
  size_t shells;           /* connected components over edges */
  double volume;           /* signed, m3; negative: inside out */
  double area;             /* m2 */
  double min[3], max[3];   /* bounds */
  size_t holes;            /* that open edges make */
  size_t hole_edges;       /* edges of the widest */
  double hole[3];          /* its middle */
  double hole_size;        /* and the longest side of its bounds, m */
  double crowded[2][3];    /* ends of the first crowded edge */
  size_t crowded_faces;    /* and its faces */
  double flipped[2][3];    /* ends of the first flipped edge */
  double degenerate[3];    /* a corner of the first face without area */
} abbe_mesh_report;

/* Vertices at the same position count as one. */
abbe_result abbe_mesh_check(const abbe_mesh *mesh, abbe_mesh_report *report, abbe_error *error);

/* What keeps the mesh from being closed and consistently oriented, how much of it and where, as a
 * part of a sentence; empty where nothing does. */
void abbe_mesh_report_faults(const abbe_mesh_report *report, char *text, size_t size);

/* Fixes what is safe: joins corners that lie up to 3e-4 of its size apart, if that closes it, drops
 * degenerate faces and faces that are there twice, makes orientation
 * consistent, turns an inside-out mesh, closes flat or small holes. *what (may
 * be NULL) gets a malloc'd sentence that says what was done, and where the surface still crosses
 * itself, or NULL where there is nothing to say. A fixed mesh has no uv; given normals stay where
 * faces do. Leaves the mesh closed and outwards or fails with ABBE_GEOMETRY, the mesh unchanged,
 * and a sentence that counts what is wrong and says where.
 * *solids (may be NULL): of how many parts abbe_mesh_split makes it. */
abbe_result abbe_mesh_fix(abbe_mesh *mesh, abbe_mesh_normals normals, size_t *solids, char **what,
                          abbe_error *error);

#define ABBE_MESH_MAX_SOLIDS 32u

/* Shares the shells of a closed mesh out among solids of which none crosses itself: *part is
 * malloc'd, *count of them, 1 where nothing crosses, and is then NULL. Where faces of shells lie on
 * one another, solids but the first grow by a few 1e-5 of the mesh's diagonal, so that they
 * overlap. ABBE_UNSUPPORTED for more than ABBE_MESH_MAX_SOLIDS, ABBE_GEOMETRY where hollows cross,
 * ABBE_NO_MEMORY. */
abbe_result abbe_mesh_split(const abbe_mesh *mesh, abbe_mesh **part, size_t *count,
                            abbe_error *error);

/* Whether a point lies inside the closed mesh (the parity of crossings along three rays). */
bool abbe_mesh_contains(const abbe_mesh *mesh, const double point[3]);

/* Loop subdivision [Loop1987], `levels` times (x4 faces each); smooth normals, no uv. */
abbe_result abbe_mesh_subdivide(abbe_mesh *mesh, size_t levels, abbe_error *error);

/* Recomputes normals; AUTO goes by the angles alone. Vertices are split where normals are. */
abbe_result abbe_mesh_compute_normals(abbe_mesh *mesh, abbe_mesh_normals normals,
                                      abbe_error *error);

/* Applies a column-major 4x4 matrix to positions and normals; turns faces where it mirrors. */
abbe_result abbe_mesh_transform(abbe_mesh *mesh, const double matrix[16], abbe_error *error);

#define ABBE_MESH_MAX_CONVEX_FACES 30000u

/* Whether every vertex lies behind every face, to 1e-6 of the mesh's size. Larger meshes than
 * ABBE_MESH_MAX_CONVEX_FACES are not examined: false. */
bool abbe_mesh_is_convex(const abbe_mesh *mesh);

/* A smooth mesh by fewer triangles, for pictures that are drawn in a hurry.
 *
 * Vertices are merged cell by cell of a grid; each group is stood for by that vertex of it which
 * is nearest to its middle [RossignacBorrel1993]. So what is left lies on the surface, with its
 * normals. Vertices of a cell that look away from each other are two groups: the sides of a thin
 * wall stay apart. Where two vertices stand at the same place, along a seam of normals, they stay
 * as they are. It has no bound on its error but the cells' size. */

/* About as many triangles as that are left, or more where a mesh is much folded. */
#define ABBE_COARSE_MESH_FACES 24000u

/* Whether it has many triangles and is smooth, but for some seams. */
bool abbe_coarse_mesh_serves(const abbe_mesh *mesh);

/* Triangles of the mesh's own vertices: *face is malloc'd, *count of them. What is seen of a closed
 * mesh has no holes; triangles that would lie folded between others are left out. NULL and 0 for a
 * mesh of which that saves less than half, and for one that it does not serve. ABBE_NO_MEMORY. */
abbe_result abbe_coarse_mesh_make(const abbe_mesh *mesh, uint32_t (**face)[3], size_t *count,
                                  abbe_error *error);

/* Charts of a mesh: parts that can be laid out flat, each seen from one direction.
 *
 * A chart is what hangs together by edges of faces whose normals lie within 60 degrees of one of
 * the six axes, so a place on it follows from its projection along that axis unless the chart
 * winds over itself. Every face belongs to one chart. It knows no textures and no light. */

typedef struct abbe_mesh_charts {
  size_t count; /* 0 where no face has an area */
  /* [count] corner, U, V: the rectangle that bounds it, across its axis; U x V points along that,
   * to the side that the normals point to */
  double (*parallelogram)[9];
  uint32_t *face; /* [face_count] chart of each; faces without an area are of the first */
} abbe_mesh_charts;

/* ABBE_INVALID_ARGUMENT for what abbe_topology_make refuses, ABBE_NO_MEMORY. */
abbe_result abbe_mesh_charts_make(const abbe_mesh *mesh, abbe_mesh_charts *out, abbe_error *error);
void abbe_mesh_charts_free(abbe_mesh_charts *charts);

#endif
