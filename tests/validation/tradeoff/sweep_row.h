/* sweep_row.h: a row of a sweep for tests: seven wavelengths, what else is usual, no number known.
 */
#ifndef ABBE_TESTS_VALIDATION_TRADEOFF_SWEEP_ROW_H
#define ABBE_TESTS_VALIDATION_TRADEOFF_SWEEP_ROW_H

#include "tests/check.h"

#include "validation/tradeoff/sweep_table.h"

static inline abbe_sweep_row sweep_row(const char *profile, size_t photons) {
  abbe_sweep_row row = {.setting = {.wavelengths = 7,
                                    .photons = photons,
                                    .map = 512,
                                    .samples = 1,
                                    .upsample = 1,
                                    .fill = "bridge",
                                    .share = 0.01,
                                    .exits = 8,
                                    .history = 1,
                                    .model = "auto"}};
  snprintf(row.setting.profile, sizeof row.setting.profile, "%s", profile);
  for (int i = 0; i < ABBE_SWEEP_NUMBER_COUNT; i++) row.number[i] = NAN;
  return row;
}

#endif
