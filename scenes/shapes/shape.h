/* shape.h: shapes with parameters: as triangles, and as the exact surface where one is known.
 *
 * Shapes stand in their own coordinates, metres, z up, centred on the origin unless stated
 * otherwise. Curved shapes are tessellated with smooth normals, faceted ones with face normals.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_SHAPES_SHAPE_H
#define ABBE_SCENES_SHAPES_SHAPE_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"
#include "spectral/microfacets.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SHAPE_MAX_PROFILE 4096u /* points of a lathe profile */

/* An icosahedron subdivided `levels` times onto the sphere: 20 * 4^levels faces. */
abbe_result abbe_shape_sphere(double radius, size_t levels, abbe_mesh *out, abbe_error *error);
/* Torus around z: major (centre line) and minor (tube) radius; 2 * around * across faces. */
abbe_result abbe_shape_ring(double major, double minor, size_t around, size_t across,
                            abbe_mesh *out, abbe_error *error);
/* A cut stone of `sides`-fold symmetry: table fanned from its centre, crown antiprism down to the
 * girdle, pavilion to the culet: 4 * sides faces (24 for six). Girdle in the plane z = 0. */
abbe_result abbe_shape_gem(size_t sides, double girdle_radius, double table_radius,
                           double crown_height, double pavilion_depth, abbe_mesh *out,
                           abbe_error *error);
/* Isosceles triangular prism: apex angle (radians) at the top (+z), side length of the two faces
 * that meet there, length along y; the triangle's centroid lies on the y axis. */
abbe_result abbe_shape_prism(double apex_rad, double side, double length, abbe_mesh *out,
                             abbe_error *error);
/* Axis-aligned box of the given edge lengths. */
abbe_result abbe_shape_box(const double size[3], abbe_mesh *out, abbe_error *error);
/* Rectangle in the xy plane, facing +z, uv from 0 to 1. */
abbe_result abbe_shape_rectangle(double width, double height, abbe_mesh *out, abbe_error *error);
/* Surface of revolution around z through count profile points (r, z), `around` segments, smooth
 * except at profile corners sharper than 30 degrees. Closed where both ends lie on the axis: from
 * the bottom outside up and inside down to the axis again. An end off the axis is a rim. */
abbe_result abbe_shape_lathe(const double (*profile)[2], size_t count, size_t around,
                             abbe_mesh *out, abbe_error *error);

/* Rounds a profile by cutting every corner at a quarter of its sides, `times` times (Chaikin's
 * curve); the ends stay. *out is malloc'd; count points become 2 count - 2 each time. */
abbe_result abbe_shape_round_profile(const double (*profile)[2], size_t count, size_t times,
                                     double (**out)[2], size_t *out_count, abbe_error *error);

/* The round brilliant cut, the usual shape of a diamond, from its proportions.
 *
 * A crown of a table, 8 stars, 8 bezels and 16 upper halves; a girdle of 16 upright faces; a
 * pavilion of 16 lower halves and 8 mains that meet in a point: 73 flat faces. Other cuts come as
 * meshes. Terms and proportions are those of the trade [Moses2004]. */

/* Zero means the default in every field but the diameter. */
typedef struct abbe_brilliant {
  double diameter;     /* between opposite corners of the girdle, metres */
  double table;        /* its width between opposite corners, of the diameter; 0: 0.56 */
  double crown_rad;    /* angle of the bezels above the girdle's plane; 0: 34.5 degrees */
  double pavilion_rad; /* angle of the mains below it; 0: 40.75 degrees */
  double star;         /* how far stars reach from the table's edge to the girdle; 0: 0.5 */
  double lower;        /* how far lower halves reach from the girdle to the culet; 0: 0.77 */
  double girdle;       /* its height where it is least, of the diameter; 0: 0.03 */
} abbe_brilliant;

/* Table up, the girdle's middle in z = 0, flat faces with normals of their own.
 * ABBE_INVALID_ARGUMENT for proportions that are out of range or make no convex stone. */
abbe_result abbe_brilliant_make(const abbe_brilliant *cut, abbe_mesh *out, abbe_error *error);

/* A tube along a knot, with spines on its back: a curled solid with as many faces as wanted.
 *
 * Its middle line winds around a torus that stands around z, centred, and comes back to itself.
 * Smooth normals are those of the surface itself. Lengths in metres. */

#define ABBE_KNOT_MAX_SEGMENTS 4096
#define ABBE_KNOT_MAX_WINDINGS 16
#define ABBE_KNOT_MAX_SPINES 1024

typedef struct abbe_knot {
  double major, minor;  /* the torus: around z, and of its own tube */
  double radius;        /* radius of the tube along the knot, where it has no spine */
  size_t turns, coils;  /* around z, and through the torus's hole; 0: 2, 3; no common divisor */
  size_t spines;        /* on the side away from the torus; 0: none */
  double spine;         /* how far they stand out, of the radius, 0 to 2 */
  size_t along, across; /* segments; 0: 1250, 100: 250,000 faces */
} abbe_knot;

/* 2 along across faces, closed. ABBE_INVALID_ARGUMENT where the tube would meet itself: it may be
 * as wide as the middle line's global radius of curvature [GonzalezMaddocks1999]. ABBE_NO_MEMORY.
 */
abbe_result abbe_knot_make(const abbe_knot *knot, abbe_mesh *out, abbe_error *error);

/* The radius of the widest tube along the middle line, m. */
double abbe_knot_room(const abbe_knot *knot);

/* How rough a mirror is and in which direction its grooves run. What that does to light
 * is in spectral/microfacets.h. */

/* A zeroed one is smooth. */
typedef struct abbe_brushing {
  abbe_microfacets facets; /* x: along the grooves, y: across; both 0: smooth */
  bool around;             /* they run around the axis through `centre`, as on a lathe; else along
                              the axis, as far as the surface does */
  double axis[3],
      centre[3]; /* world; of no meaning where x and y are alike. A zero axis: any direction */
} abbe_brushing;

static inline bool abbe_brushing_is_rough(const abbe_brushing *b) {
  return b->facets.x > 0;
}

/* Unit vector along the grooves at p, where n is the surface's unit normal; where they have no
 * direction, one of those across n. */
void abbe_brushing_grain(const abbe_brushing *b, const double p[3], const double n[3],
                         double along[3]);

/* Moves it with its object, by an affine 4x4 matrix. */
void abbe_brushing_move(abbe_brushing *b, const double matrix[16]);

#endif
