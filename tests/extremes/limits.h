/* limits.h: where a series of extremes must lead: to a picture that is known, or to the reference.
 */
#ifndef ABBE_TESTS_EXTREMES_LIMITS_H
#define ABBE_TESTS_EXTREMES_LIMITS_H

#include "gl/device/context.h"
#include "tests/extremes/report.h"

#include <stddef.h>

typedef struct extreme_limit {
  const char *name;
  void (*check)(abbe_context *context, extreme_row *row);
} extreme_limit;

extern const extreme_limit extreme_limits[];
extern const size_t extreme_limit_count;

#endif
