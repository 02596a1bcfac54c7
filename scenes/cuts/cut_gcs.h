/* cut_gcs.h: Gem Cut Studio's files of designs (.gcs), in.
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

#ifdef __cplusplus
extern "C" {
#endif

/* name is for messages; report (may be NULL) gets what was left out or assumed. ABBE_PARSE for what
 * is no such file, ABBE_SCHEMA for values that no stone has, with the line. */
abbe_result abbe_cut_gcs_parse(const char *data, size_t size, const char *name, abbe_cut *out,
                               abbe_report *report, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
