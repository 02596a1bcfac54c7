/* caustic_volume.h: the light that an object sends to the space around it, for directional lights
 * from many directions, computed beforehand: for each light node and cell the vector irradiance of
 * unit light; or, as the method was printed, the share of the beam's light
 * [WymanHansenShirley2003]; or the rays that leave the object (light_exits.h), from which the cells
 * are filled for a light where it stands (exit_light.h).
 *
 * All in the object's own coordinates: places from its centre in m, as it stood when the volume was
 * made. It holds numbers; validation/lab/volume_fill.h finds them out, its file stores
 * them.
 */
#ifndef ABBE_SCENES_VOLUME_CAUSTIC_VOLUME_H
#define ABBE_SCENES_VOLUME_CAUSTIC_VOLUME_H

#include "base/error.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/sphere_mesh.h"
#include "scenes/volume/volume_body.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The space around an object cut into cells: a grid, or concentric shells of
 * triangles or of an octahedral map's texels, closer together further in; which cell holds a place,
 * and through which a ray goes.
 *
 * Places are relative to the object's centre, m. It holds cells and no light. */

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

typedef enum abbe_volume_kind {
  /* F of X, Y and Z, of light with an irradiance of 1 across its beam whose white has Y = 1: what
   * lies before it gets -n . F, where all light comes from the front. */
  ABBE_VOLUME_VECTOR,
  /* R, G and B (linear Rec.709 of equal white) in bytes: light on a surface that faces the object's
   * centre, of that of the beam. */
  ABBE_VOLUME_PRINTED,
  /* Rays that leave the object; it has no values, and looks none up. */
  ABBE_VOLUME_EXITS
} abbe_volume_kind;

/* Where light from between nodes is looked up: at the node nearest to it; at the three around it;
 * there, about the axes that bring the light to each of them. */
#define ABBE_VOLUME_LOOKUPS(X)                                                                     \
  X(AUTO, "auto") X(NEAREST, "nearest") X(BLEND, "blend") X(TURN, "turn")
typedef enum abbe_volume_lookup {
#define ABBE_VOLUME_LOOKUP_ENUM(code, name) ABBE_VOLUME_LOOKUP_##code,
  ABBE_VOLUME_LOOKUPS(ABBE_VOLUME_LOOKUP_ENUM)
#undef ABBE_VOLUME_LOOKUP_ENUM
      ABBE_VOLUME_LOOKUP_COUNT
} abbe_volume_lookup;

typedef struct abbe_caustic_volume {
  abbe_volume_kind kind;
  abbe_volume_body body;
  abbe_volume_region region;
  abbe_light_nodes nodes;
  double white[3]; /* XYZ of the light that it was made for, Y = 1 */
  double min_nm, max_nm;
  double byte;            /* PRINTED: what a byte of 1 stands for */
  double error;           /* relative standard error of what was summed up; 0: not known */
  uint16_t *value;        /* halves [nodes.count][region.cells][channels]; EXITS: NULL */
  abbe_light_exits exits; /* EXITS: for the nodes, and cells of the region */
} abbe_caustic_volume;

/* 9: F.x, F.y, F.z of X, then of Y, then of Z; printed 3. */
static inline size_t abbe_caustic_volume_channels(const abbe_caustic_volume *v) {
  return v->kind == ABBE_VOLUME_PRINTED ? 3 : 9;
}

/* Allocates the values of a body, a region and nodes that are there, all 0: ABBE_NO_MEMORY;
 * ABBE_INVALID_ARGUMENT for more than ABBE_CAUSTIC_VOLUME_MOST of them, and for exits. */
#define ABBE_CAUSTIC_VOLUME_MOST ((size_t)1 << 31)
abbe_result abbe_caustic_volume_allocate(abbe_caustic_volume *volume, abbe_error *error);
void abbe_caustic_volume_free(abbe_caustic_volume *volume);
/* Bytes of values or exits, in memory. */
size_t abbe_caustic_volume_bytes(const abbe_caustic_volume *volume);

/* How a lookup that is left open is done: by turns of a ball, which they are exact for, and where
 * there is one node; else by three nodes, printed too. */
abbe_volume_lookup abbe_caustic_volume_resolve(const abbe_caustic_volume *volume,
                                               abbe_volume_lookup lookup);

/* Which nodes light from unit direction to_light is looked up at, by their weights, with the turn
 * of each into its node's light (row-major; the unit matrix but of TURN). */
typedef struct abbe_volume_sight {
  size_t count; /* 1 to 3 */
  size_t node[3];
  double weight[3];
  double turn[3][9];
} abbe_volume_sight;
void abbe_caustic_volume_look(const abbe_caustic_volume *volume, abbe_volume_lookup lookup,
                              const double to_light[3], abbe_volume_sight *out);

/* Caustic volumes as OpenEXR files: one part, half precision, ZIP, written beside their target and
 * renamed; what they are stands in named attributes.
 *
 * Pixels follow each other along rows, node after node and cell after cell; those that are left in
 * the last row are 0. Channels are X.x, X.y, X.z, Y.x ... of a vector volume, R, G, B of a printed
 * one. Of exits there are points, then exits node after node, then the cells' free space; channels
 * are P.x to Dn.z, T and S. */

/* ABBE_IO, ABBE_NO_MEMORY; ABBE_UNSUPPORTED for more values than a picture has pixels. */
abbe_result abbe_volume_file_write(const char *path, const abbe_caustic_volume *volume,
                                   abbe_error *error);

/* Everything is checked before it is used: ABBE_NOT_FOUND for a picture that is no volume,
 * ABBE_PARSE for an attribute that is broken or does not go with the pixels, errors of
 * abbe_exr_read and abbe_volume_region_make. */
abbe_result abbe_volume_file_read(const char *path, abbe_caustic_volume *out, abbe_error *error);

#endif
