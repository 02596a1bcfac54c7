/* cut_gem.h: GemCad's binary files of designs (.gem), in and out.
 *
 * A file holds each facet's plane and polygon. The planes rule: the polygons of some files are of
 * another size, and they are not read. Angles and indices are worked out from the planes. The
 * second design that a file may carry, the preform, is left out.
 */
#ifndef ABBE_SCENES_CUTS_CUT_GEM_H
#define ABBE_SCENES_CUTS_CUT_GEM_H

#include "base/report.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

#include <stdio.h>

/* name is for messages; report (may be NULL) gets what was left out. ABBE_PARSE for what is no such
 * file, ABBE_SCHEMA for values that no stone has, with the byte. */
abbe_result abbe_cut_gem_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

/* With the polygons of the polyhedron, which is the cut's. report (may be NULL) gets what the
 * format does not hold: texts beyond 255 bytes. */
abbe_result abbe_cut_gem_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron, FILE *to,
                               abbe_report *report, abbe_error *error);

#endif
