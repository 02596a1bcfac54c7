/* gem_output.h: a design that a verb of `abbe gem` writes, by its name's ending. */
#ifndef ABBE_CLI_GEM_GEM_OUTPUT_H
#define ABBE_CLI_GEM_GEM_OUTPUT_H

#include "base/report.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"
#include "spectral/materials/material.h"

/* .asc and .gem keep the design; .stl, .obj and .glb its solid, scale metres a unit. Written beside
 * and renamed. ABBE_INVALID_ARGUMENT for another ending; what the formats say. */
abbe_result abbe_gem_output_write(const char *path, const abbe_cut *cut,
                                  const abbe_cut_polyhedron *stone, double scale,
                                  const abbe_material *material, abbe_report *report,
                                  abbe_error *error);

#endif
