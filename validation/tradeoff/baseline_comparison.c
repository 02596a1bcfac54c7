#include "validation/tradeoff/baseline_comparison.h"

#include "validation/tradeoff/pareto_front.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ABBE_NAME_OF(name, text, key) name,
#define ABBE_TEXT_OF(name, text, key) text,
#define ABBE_KEY_OF(name, text, key) key,
const char *const abbe_baselines[] = {ABBE_BASELINES(ABBE_NAME_OF)};
static const char *const texts[] = {ABBE_BASELINES(ABBE_TEXT_OF)};
static const char *const keys[] = {ABBE_BASELINES(ABBE_KEY_OF)};

const char *abbe_baseline_text(const char *profile) {
  for (int i = 0; i < ABBE_BASELINE_COUNT; i++)
    if (strcmp(abbe_baselines[i], profile) == 0) return texts[i];
  return profile;
}

const char *abbe_baseline_key(const char *profile) {
  for (int i = 0; i < ABBE_BASELINE_COUNT; i++)
    if (strcmp(abbe_baselines[i], profile) == 0) return keys[i];
  return "";
}

/* The published settings. */
static bool is_own(const abbe_sweep_setting *s, const char *profile) {
  if (strcmp(s->profile, profile) != 0) return false;
  if (strncmp(profile, "shah2007", 8) == 0) return s->photons == 128 && s->map == 768;
  if (strncmp(profile, "wyman2006", 9) == 0)
    return s->photons == 1024 && s->map == 512 && strcmp(s->fill, "gather-light") == 0;
  return s->wavelengths == 7 && s->photons == 512 && s->map == 1024 &&
         strcmp(s->fill, "smear") == 0;
}

/* The default profile against one point. */
static void meet(const abbe_sweep_table *table, abbe_sweep_number time, abbe_sweep_number number,
                 double ms, double error, double *speedup, double *ratio) {
  double least_ms = INFINITY, least_error = INFINITY;
  for (size_t i = 0; i < table->count; i++) {
    const abbe_sweep_row *row = &table->row[i];
    if (strcmp(row->setting.profile, "default") != 0 ||
        abbe_sweep_setting_has_history(&row->setting))
      continue;
    double own_ms = row->number[time], own = row->number[number];
    if (own <= error) least_ms = fmin(least_ms, own_ms);
    if (own_ms <= ms) least_error = fmin(least_error, own);
  }
  *speedup = isfinite(least_ms) ? ms / least_ms : NAN;
  *ratio = isfinite(least_error) && error > 0 ? least_error / error : NAN;
}

static void meet_front(const abbe_sweep_table *table, const double *cost, const double *error,
                       const size_t *order, abbe_sweep_number time, abbe_sweep_number number,
                       abbe_baseline_comparison *out) {
  double least = INFINITY, most = 0;
  bool reached = true, begun = true;
  for (size_t i = 0; i < out->front; i++) {
    double speedup, ratio, ms = cost[order[i]], wrong = error[order[i]];
    meet(table, time, number, ms, wrong, &speedup, &ratio);
    /* A setting with no more error in no more time, and less of one. */
    out->beaten += (speedup > 1 && ratio <= 1) || (speedup >= 1 && ratio < 1);
    reached = reached && isfinite(speedup);
    begun = begun && isfinite(ratio);
    least = fmin(least, speedup);
    most = fmax(most, ratio);
  }
  /* One point that is not reached at all is worse than any number. */
  if (out->front > 0 && reached) out->front_speedup = least;
  if (out->front > 0 && begun) out->front_ratio = most;
}

abbe_result abbe_baseline_comparison_make(const abbe_sweep_table *table, const char *profile,
                                          abbe_sweep_number time, abbe_sweep_number number,
                                          abbe_baseline_comparison *out, abbe_error *error) {
  size_t count = table->count;
  double *cost = calloc(2 * count + 1, sizeof *cost);
  size_t *order = calloc(count + 1, sizeof *order);
  *out = (abbe_baseline_comparison){NULL, NAN, NAN, 0, 0, NAN, NAN};
  abbe_result result = ABBE_OK;
  if (cost == NULL || order == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the baseline's front");
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    const abbe_sweep_row *row = &table->row[i];
    bool counts = strcmp(row->setting.profile, profile) == 0;
    cost[i] = counts ? row->number[time] : NAN;
    cost[count + i] = row->number[number];
    if (is_own(&row->setting, profile) &&
        (out->baseline == NULL || row->setting.history > out->baseline->setting.history))
      out->baseline = row;
  }
  if (result == ABBE_OK) {
    out->front = abbe_pareto_front_order(cost, cost + count, count, order);
    meet_front(table, cost, cost + count, order, time, number, out);
  }
  if (result == ABBE_OK && out->baseline != NULL)
    meet(table, time, number, out->baseline->number[time], out->baseline->number[number],
         &out->equal_error_speedup, &out->equal_time_error_ratio);
  free(cost);
  free(order);
  return result;
}
