/* baseline_comparison.h: the default profile held against another contestant's rows of the same
 * sweep: the published methods, and the tracer.
 *
 * Two questions: how much sooner does the default profile have the baseline's error, and how much
 * of its error is left in its time? Both are asked of the baseline's own settings, those that
 * were published, and of every point of its own Pareto front, where the hardest answer counts.
 * Points are measured ones; nothing is interpolated.
 */
#ifndef ABBE_VALIDATION_TRADEOFF_BASELINE_COMPARISON_H
#define ABBE_VALIDATION_TRADEOFF_BASELINE_COMPARISON_H

#include "validation/tradeoff/sweep_table.h"

/* X(profile, text, key): against whom; what its JSON names begin with. */
#define ABBE_BASELINES(X)                                                                          \
  X("thesis", "thesis profile, with the best factor on its brightness", "")                        \
  X("thesis-cie", "thesis's method with CIE weights, in physical units", "vs_fair_")               \
  X("trace", "tracer", "vs_trace_")                                                                \
  X("trace-filter", "tracer, filtered", "vs_filtered_")                                            \
  X("shah2007", "caustics mapping, with the best factor on its brightness", "vs_shah2007_")        \
  X("shah2007-cie", "caustics mapping with CIE weights, in physical units", "vs_fair_shah2007_")   \
  X("wyman2006", "photons in image space, with the best factor on its brightness",                 \
    "vs_wyman2006_")                                                                               \
  X("wyman2006-cie", "photons in image space with CIE weights, in physical units",                 \
    "vs_fair_wyman2006_")
enum { ABBE_BASELINE_COUNT = 8 };
extern const char *const abbe_baselines[ABBE_BASELINE_COUNT];
const char *abbe_baseline_text(const char *profile);
const char *abbe_baseline_key(const char *profile);

/* NaN: not known, or never reached. */
typedef struct abbe_baseline_comparison {
  const abbe_sweep_row
      *baseline; /* for the thesis 7 wavelengths, 512 photons, map 1024, smear; for caustics mapping
                    128 photons, map 768; for photons in image space 1024, map 512, gather-light,
                    with the longest history that there is; NULL: no row, or the tracer, which has
                    no settings of its own */
  double equal_error_speedup;    /* its time over the least time of an error no larger */
  double equal_time_error_ratio; /* the least error in a time no longer, over its error */
  size_t front;                  /* points of the baseline's front; 0: no rows */
  size_t beaten;                 /* number of those that a setting beats in time and in error */
  double front_speedup;          /* the least equal-error speedup over the front */
  double front_ratio;            /* the largest equal-time error ratio over it */
} abbe_baseline_comparison;

/* By one of abbe_sweep_times; rows that do not have it do not count. ABBE_NO_MEMORY. */
abbe_result abbe_baseline_comparison_make(const abbe_sweep_table *table, const char *profile,
                                          abbe_sweep_number time, abbe_sweep_number number,
                                          abbe_baseline_comparison *out, abbe_error *error);

#endif
