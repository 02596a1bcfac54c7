/* axis.h: the axis of a chart: where a value lies on it, and which ticks it shows.
 *
 * Linear or logarithmic, in either direction. It draws nothing. Internal to colorimetry/plot/.
 */
#ifndef ABBE_COLORIMETRY_PLOT_AXIS_H
#define ABBE_COLORIMETRY_PLOT_AXIS_H

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_AXIS_MAX_TICKS = 128 };

typedef struct abbe_axis {
  double min, max; /* min < max, finite; log: 0 < min */
  bool log;
  bool reversed; /* max is at the origin */
} abbe_axis;

typedef struct abbe_axis_tick {
  double value;
  bool major;     /* a long tick, with a label */
  char label[24]; /* UTF-8; "" for a minor tick */
} abbe_axis_tick;

/* An axis that shows min to max with `margin` of its length free at either end; a single value, or
 * none (min > max), gets a range too. */
abbe_axis abbe_axis_make(double min, double max, double margin, bool log, bool reversed);

/* Where value lies: 0 at the origin, 1 at the end, beyond them outside; NaN for what a logarithmic
 * axis does not have. */
double abbe_axis_at(const abbe_axis *axis, double value);

/* About `wanted` (2 or more) labelled ticks at round values, ascending, and on a logarithmic axis
 * minor ones between; how many. Labels show value / 10^*exponent, so that long rows of zeros go
 * into one note; *exponent is 0 where that is not needed. */
size_t abbe_axis_ticks(const abbe_axis *axis, size_t wanted,
                       abbe_axis_tick tick[ABBE_AXIS_MAX_TICKS], int *exponent);

/* "10" with the exponent raised, as UTF-8. */
const char *abbe_axis_power(int exponent, char text[40]);

#endif
