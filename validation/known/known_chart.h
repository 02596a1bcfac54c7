/* known_chart.h: the table of known answers as a picture: every row's error as a share of its
 * tolerance, group by group, and above it the error against the photons where it was measured.
 */
#ifndef ABBE_VALIDATION_KNOWN_KNOWN_CHART_H
#define ABBE_VALIDATION_KNOWN_KNOWN_CHART_H

#include "base/error.h"
#include "validation/known/known_answers.h"

/* Writes a .png or .svg beside and renamed; errors as abbe_chart_write, and ABBE_INVALID_ARGUMENT
 * where there are no answers. */
abbe_result abbe_known_chart_write(const char *path, const abbe_known_answers *answers,
                                   abbe_error *error);

#endif
