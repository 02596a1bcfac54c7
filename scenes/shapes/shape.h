/* shape.h: shapes with parameters: as triangles, and as the exact surface where one is known.
 *
 * Shapes stand in their own coordinates, metres, z up, centred on the origin unless stated
 * otherwise. Curved shapes are tessellated with smooth normals, faceted ones with face normals.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_SHAPES_SHAPE_H
#define ABBE_SCENES_SHAPES_SHAPE_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

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

#endif
