/* sweep_promises.h: what presets promise for a class of scenes, beside what a sweep of one met. */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_PROMISES_H
#define ABBE_VALIDATION_SWEEP_SWEEP_PROMISES_H

#include "gl/accuracy/preset.h"
#include "validation/tradeoff/sweep_table.h"

/* The promise of one point of the front that the table has. */
typedef struct abbe_sweep_promise {
  const char *preset; /* its name, or "" */
  const abbe_sweep_row *row;
  double error, ms;         /* promised */
  double error_met, ms_met; /* NaN: not measured */
} abbe_sweep_promise;

typedef struct abbe_sweep_promises {
  abbe_presets presets;
  const abbe_preset_front *front; /* NULL: nothing is promised of such a table */
  size_t count;
  abbe_sweep_promise promise[ABBE_PRESET_MAX_POINTS]; /* [count] in the front's order */
} abbe_sweep_promises;

/* By the presets in a file (NULL: the shipped ones): errors as they are, times by the ratio of the
 * cheapest point's, as it was measured here. The table outlives it. Errors of abbe_presets_load. */
abbe_result abbe_sweep_promises_make(const abbe_sweep_table *table, const char *presets,
                                     abbe_sweep_promises *out, abbe_error *error);
void abbe_sweep_promises_free(abbe_sweep_promises *promises);

#endif
