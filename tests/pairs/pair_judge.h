/* pair_judge.h: whether a case's picture has the light and the hue of its trace.
 *
 * Hue is the dominant wavelength of a region's mean colour where that is saturated enough for one,
 * else the CIEDE2000 between both means, brought to one luminance. Traces are kept as the regions'
 * means with their standard errors, in traces.csv; three of these are granted beside each bound.
 */
#ifndef ABBE_TESTS_PAIRS_PAIR_JUDGE_H
#define ABBE_TESTS_PAIRS_PAIR_JUDGE_H

#include "tests/pairs/pair_case.h"

#include <stdio.h>

/* Of a colour whose excitation purity is below, no dominant wavelength is told. */
#define PAIR_PURITY 0.1

typedef struct pair_verdict {
  bool saturated;        /* hue is a wavelength */
  double nm[2];          /* dominant wavelengths, traced and drawn; of a purple the complementary
                            one, negative */
  double hue, hue_bound; /* how far off: nm, or CIEDE2000 */
  double light, light_bound; /* mean luminance over the traced one's, and how far off 1 it may be */
} pair_verdict;

bool pair_verdict_hue(const pair_verdict *v);
bool pair_verdict_light(const pair_verdict *v);

/* Reads the trace of a stone in company from traces.csv; ABBE_PARSE where it is not there. */
abbe_result pair_judge_read(size_t stone, size_t company, pair_light *out, abbe_error *error);
void pair_judge_write(FILE *file, size_t stone, size_t company, const pair_light *traced);

void pair_judge(const cover_row *row, size_t region, const pair_light *traced,
                const pair_light *drawn, pair_verdict *out);

#endif
