/* volume_region.h: the space around an object cut into cells: a grid, or concentric shells of
 * triangles or of an octahedral map's texels, closer together further in; which cell holds a place,
 * and through which a ray goes.
 *
 * Places are relative to the object's centre, m. It holds cells and no light.
 */
#ifndef ABBE_SCENES_VOLUME_VOLUME_REGION_H
#define ABBE_SCENES_VOLUME_VOLUME_REGION_H

#include "scenes/volume/sphere_mesh.h"

#include <stdbool.h>

typedef enum abbe_region_kind {
  ABBE_REGION_GRID,      /* cubes */
  ABBE_REGION_GEODESIC,  /* shells of a subdivided icosahedron's faces */
  ABBE_REGION_OCTAHEDRAL /* shells of an octahedral map's texels */
} abbe_region_kind;

#define ABBE_REGION_MOST_SIDE 256
#define ABBE_REGION_MOST_SHELLS 256
#define ABBE_REGION_MOST_CELLS ((size_t)1 << 26)

typedef struct abbe_region_desc {
  abbe_region_kind kind;
  size_t side;   /* grid: cells a side, 2 to 256; octahedral: texels a side */
  size_t levels; /* geodesic: of its icosahedron */
  size_t shells; /* 1 to 256; grid: not read */
  double inner;  /* radius of the first shell's inside, m, above 0; grid: not read */
  double outer;  /* outside of the last one; half a grid's side */
} abbe_region_desc;

typedef struct abbe_volume_region {
  abbe_region_desc desc;
  size_t row;            /* cells of a shell, or of a grid's layer */
  size_t rows;           /* shells, or layers */
  size_t cells;          /* row * rows; cell i is the (i % row)-th of row i / row */
  abbe_sphere_mesh mesh; /* mesh of shells */
  double *radius;        /* radii of shells [rows + 1], in geometric progression */
  double *solid_angle;   /* solid angles of shells [row], sr */
} abbe_volume_region;

/* ABBE_INVALID_ARGUMENT, with a sentence, for what is outside the limits; ABBE_NO_MEMORY. */
abbe_result abbe_volume_region_make(const abbe_region_desc *desc, abbe_volume_region *out,
                                    abbe_error *error);
void abbe_volume_region_free(abbe_volume_region *region);

/* The middle of a cell: of a shell's at the middle radius. */
void abbe_volume_region_middle(const abbe_volume_region *region, size_t cell, double p[3]);
double abbe_volume_region_volume(const abbe_volume_region *region, size_t cell); /* m3 */
/* The area that a beam along the unit direction d meets of a cell, m2; faces of shells are taken as
 * flat. */
double abbe_volume_region_across(const abbe_volume_region *region, size_t cell, const double d[3]);

/* How much of a ray lies in a cell. */
typedef struct abbe_region_piece {
  size_t cell;
  double length; /* m */
} abbe_region_piece;

#define ABBE_REGION_MOST_PIECES 4096

/* The cells of a ray from o along unit d, up to `limit` (may be INFINITY), in its order; at most
 * ABBE_REGION_MOST_PIECES. A shell that a ray leaves inwards may come a second time. Returns how
 * many. */
size_t abbe_volume_region_walk(const abbe_volume_region *region, const double o[3],
                               const double d[3], double limit, abbe_region_piece *piece);

#endif
