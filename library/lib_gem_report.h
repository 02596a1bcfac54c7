/* lib_gem_report.h: a gem's design judged in a stone, as `abbe gem report` does, for programs
 * outside. docs/gem-measures.md says what the numbers are.
 */
#ifndef ABBE_LIBRARY_LIB_GEM_REPORT_H
#define ABBE_LIBRARY_LIB_GEM_REPORT_H

#include "base/error.h"
#include "library/lib_picture.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_lib_gem_report abbe_lib_gem_report;

/* path: a design (.asc, .gem, .gcs); one that is not there is looked for among those that came with
 * the library. material: of the table. Settings: table (default, thesis or a file), width_m (6.5
 * mm), wavelengths (16), min_nm, max_nm (380, 780), head_rad (half angle of the head's shadow, 15
 * degrees), tilt_rad (to either side, 30 degrees; 0: not tilted, and no fire), step_rad (2
 * degrees), size (a side of the maps, 96), repeats (4), threads, weld, axis (of a crystal: X,Y,Z,
 * and of three indices its z and x; 0,0,1), crown_rad and pavilion_rad (angles of the main facets,
 * meets kept; 0: the design's own), slopes (1: numbers return_by_crown, iso_by_crown, fire_by_crown
 * and so by pavilion too, of a degree more of that side's main angle; fire there is in degrees).
 * progress may be NULL. ABBE_NOT_FOUND, ABBE_IO, ABBE_PARSE, ABBE_GEOMETRY, ABBE_OUT_OF_RANGE,
 * ABBE_UNSUPPORTED for a metal, ABBE_CANCELLED, ABBE_NO_MEMORY. */
abbe_result abbe_lib_gem_report_make(const char *path, const char *material,
                                     const char *const *settings, size_t count,
                                     bool (*progress)(void *user, double done), void *user,
                                     abbe_lib_gem_report **out, abbe_error *error);
void abbe_lib_gem_report_free(abbe_lib_gem_report *report);

/* Name of a number ("iso", "return", "fire", …), NULL past the last one; what it is, for people;
 * its value and standard error. ABBE_INVALID_ARGUMENT past the last one. */
const char *abbe_lib_gem_report_name(const abbe_lib_gem_report *report, size_t index);
const char *abbe_lib_gem_report_text(const abbe_lib_gem_report *report, size_t index);
abbe_result abbe_lib_gem_report_number(const abbe_lib_gem_report *report, size_t index,
                                       double *value, double *standard_error, abbe_error *error);

/* All amounts a pixel, seen from above: channels of their names, X, Y, Z of the light return, and
 * cover. ABBE_NO_MEMORY. */
abbe_result abbe_lib_gem_report_maps(const abbe_lib_gem_report *report, abbe_lib_picture **out,
                                     abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
