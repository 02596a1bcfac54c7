/* cut_solid.h: the stone of a design as a solid for other programs: STL, OBJ, glTF.
 *
 * Facets stay flat: no corner is shared between two of them where a format has normals. Lengths are
 * metres in glTF, y up, and millimetres in STL and OBJ, z up.
 */
#ifndef ABBE_SCENES_CUTS_CUT_SOLID_H
#define ABBE_SCENES_CUTS_CUT_SOLID_H

#include "base/error.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "spectral/materials/material.h"

#include <stdio.h>

/* X(code, ending): .gltf is not written, for it is two files. */
#define ABBE_CUT_SOLIDS(X)                                                                         \
  X(STL, ".stl")                                                                                   \
  X(OBJ, ".obj")                                                                                   \
  X(GLB, ".glb")

typedef enum abbe_cut_solid_format {
#define ABBE_CUT_SOLID_ENUM(code, ending) ABBE_CUT_SOLID_##code,
  ABBE_CUT_SOLIDS(ABBE_CUT_SOLID_ENUM)
#undef ABBE_CUT_SOLID_ENUM
      ABBE_CUT_SOLID_COUNT
} abbe_cut_solid_format;

/* The format of a path's ending, or ABBE_CUT_SOLID_COUNT. */
abbe_cut_solid_format abbe_cut_solid_format_of(const char *path);

/* Writes the cut's polyhedron; scale is metres a unit of the design, above 0. STL is binary. OBJ
 * has a group a facet, of its name, and polygons. In glTF the stone has KHR_materials_ior,
 * transmission, volume and dispersion ([glTFDispersion]: 20
 * V_d), colours by the transmittance of the stone's own width; material NULL: an index of 1.5
 * without dispersion. ABBE_OUT_OF_RANGE where the material does not cover the visible,
 * ABBE_NO_MEMORY, ABBE_IO. */
abbe_result abbe_cut_solid_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                 double scale, const abbe_material *material,
                                 abbe_cut_solid_format format, FILE *to, abbe_error *error);

#endif
