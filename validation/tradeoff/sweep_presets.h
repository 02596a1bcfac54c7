/* sweep_presets.h: presets read off sweeps: one Pareto front for every class of scenes, as YAML.
 *
 * A class's front is over the settings of the default profile that all its sweeps have: cost is the
 * cheapest setting's time (geometric mean) times the worst of the sweeps' ratios to it, error the
 * worst of theirs. The three named ones are picked by
 * rule: draft is the cheapest, accurate the cheapest whose error is at most 2 % above the least of
 * those that are finer than the defaults, balanced where the front between draft and the least
 * error bends most. gl/accuracy/preset.h reads the file; the fronts of whole pictures in it are
 * sweep_pictures.h's.
 */
#ifndef ABBE_VALIDATION_TRADEOFF_SWEEP_PRESETS_H
#define ABBE_VALIDATION_TRADEOFF_SWEEP_PRESETS_H

#include "validation/tradeoff/sweep_table.h"

/* Writes the presets of the tables to path, beside and renamed; name[count] are the tables' paths,
 * for sentences. is_fine holds which settings are finer than the defaults; a class without one has
 * no accurate, and a comment says so. ABBE_INVALID_ARGUMENT where a table names no class, was made
 * on another machine or device than the first, or where the sweeps of a class have no setting in
 * common with a known error. */
abbe_result abbe_sweep_presets_write(const char *path, const abbe_sweep_table *tables,
                                     const char *const *names, size_t count,
                                     abbe_sweep_number number,
                                     bool (*is_fine)(const abbe_sweep_setting *setting),
                                     abbe_error *error);

#endif
