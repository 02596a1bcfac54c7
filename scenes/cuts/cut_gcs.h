/* cut_gcs.h: Gem Cut Studio's files of designs (.gcs), in and out.
 *
 * XML of tiers and facets. A facet's normal rules over its index; a tier's depth may be missing,
 * and then the facet's corners say it. Designs are turned by half a turn about z, so that the index
 * at the gear's offset is in the direction of y, and indices are worked out anew from the normals:
 * those of the program run the other way round on the crown. Document types, entities and whatever
 * else could reach outside the file are refused.
 */
#ifndef ABBE_SCENES_CUTS_CUT_GCS_H
#define ABBE_SCENES_CUTS_CUT_GCS_H

#include "base/report.h"
#include "scenes/cuts/cut.h"
#include "scenes/cuts/cut_polyhedron.h"

#include <stdio.h>

/* name is for messages; report (may be NULL) gets what was left out or assumed. ABBE_PARSE for what
 * is no such file, ABBE_SCHEMA for values that no stone has, with the line. */
abbe_result abbe_cut_gcs_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

/* UTF-8, with the facets' corners; polyhedron is the cut's. As the program has it, the stone is
 * scaled so that its corners reach 1 in x or y, and its middle height is 0; facets without a face
 * are left out, and a tier whose facets lie at several distances has none of its own. report (may
 * be NULL) gets what was left out. ABBE_IO where the stream fails; ABBE_GEOMETRY where the middle
 * height lies outside a facet's plane, which the format cannot say. */
abbe_result abbe_cut_gcs_write(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron, FILE *to,
                               abbe_report *report, abbe_error *error);

#endif
