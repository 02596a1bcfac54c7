/* gem_stone.h: a cut stone as light meets it: its planes, and its material at some wavelengths.
 *
 * The stone is what lies behind its planes: a ray inside tests them all, without a BVH. Lengths
 * are scaled so that the ball around its corners has radius 1, about the origin; axes are the
 * cut's, z up through the table. It stands alone in air. A crystal has its axes in it, and is what
 * the tracer's media are (validation/trace/transport/media.h).
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_STONE_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_STONE_H

#include "base/error.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "spectral/materials/material.h"
#include "spectral/wavelengths.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/solid.h"

#include <stddef.h>

typedef struct abbe_gem_stone {
  abbe_solid solid; /* the same planes, in single precision */
  size_t plane_count;
  double (*plane)[4]; /* [plane_count] n . x = plane[3], n unit, outwards */
  size_t vertex_count;
  double (*vertex)[3];
  double unit_m;            /* metres in a unit of length */
  double middle[3], radius; /* its origin in the cut, and the cut's units in one of its own */
  size_t wavelengths;
  abbe_media media; /* the stone alone; its step k begins at wavelength k */
} abbe_gem_stone;

/* The polyhedron is the cut's. width_m: of the girdle, the lesser of its extents along x and y; it
 * matters where the material absorbs. ABBE_INVALID_ARGUMENT for a width that is not above 0 and
 * finite, for an index that is not above 1;
 * ABBE_OUT_OF_RANGE and others as abbe_material_n; ABBE_NO_MEMORY. */
abbe_result abbe_gem_stone_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                const abbe_material *material, const abbe_wavelengths *wavelengths,
                                double width_m, abbe_gem_stone *out, abbe_error *error);
/* How a crystal lies in its cut: its optic axis, or that of its largest index, and that of its
 * least one, which is made square to the first. Of any length; zero: along z, and about along x. */
typedef struct abbe_gem_axes {
  double z[3], x[3];
} abbe_gem_axes;

/* "X,Y,Z" is z, and "X,Y,Z,X,Y,Z" z and x. ABBE_INVALID_ARGUMENT, for a z that is zero too. */
abbe_result abbe_gem_axes_read(const char *text, abbe_gem_axes *out, abbe_error *error);
/* Turns the crystal in its cut, from where stone_make leaves it: z along z, and x along x.
 * ABBE_INVALID_ARGUMENT for a stone of one index in all directions, and for x along z. */
abbe_result abbe_gem_stone_turn(abbe_gem_stone *stone, const abbe_gem_axes *axes,
                                abbe_error *error);
/* Safe on a zeroed one. */
void abbe_gem_stone_free(abbe_gem_stone *stone);

#endif
