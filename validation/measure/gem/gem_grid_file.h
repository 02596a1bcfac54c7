/* gem_grid_file.h: the pairs of angles that one part of a search has judged, as a table that goes
 * together with those of the other parts.
 */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_GRID_FILE_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_GRID_FILE_H

#include "validation/measure/gem/gem_optimum.h"

/* CSV: what was asked and what the design itself has, as comments; then a row for each pair that
 * was judged, with its place in value[], both angles in radians, value and standard error, all to
 * the last bit. ABBE_IO. */
abbe_result abbe_gem_grid_file_write(const char *path, const abbe_gem_optimum *optimum,
                                     abbe_error *error);

/* Takes the pairs of a table into a search that has begun; best becomes the best of all that are
 * known. ABBE_INVALID_ARGUMENT for a table of another search (other angles, another measure, or
 * another number for the design itself, which differs where the design, the stone or the view do),
 * and for a pair that is known already; ABBE_IO, ABBE_PARSE for what cannot be read, with the line.
 * On failure optimum may have some of the pairs. */
abbe_result abbe_gem_grid_file_read(const char *path, abbe_gem_optimum *optimum, abbe_error *error);

#endif
