/* sweep_plot.h: a sweep as a picture: error against time in logarithms, and the Pareto front.
 *
 * Every setting is a point, a profile a colour; the front is a line with its settings' names,
 * and each other profile's own front a line without; the
 * reference's own noise is a dashed line, below which an error is not known. It finds no front.
 */
#ifndef ABBE_VALIDATION_TRADEOFF_SWEEP_PLOT_H
#define ABBE_VALIDATION_TRADEOFF_SWEEP_PLOT_H

#include "validation/tradeoff/sweep_table.h"

/* Draws the charts of the errors named against that time, one above the other, to path (.png or
 * .svg); the fronts are found anew for each. ABBE_INVALID_ARGUMENT for a number that is no error or
 * where no row has it; errors of abbe_chart_write. */
abbe_result abbe_sweep_plot(const char *path, const abbe_sweep_table *table, abbe_sweep_number time,
                            const abbe_sweep_number *errors, size_t count, abbe_error *error);

/* Several scenes in one picture: a row of charts a table, a column for each of abbe_sweep_times
 * that any table knows, that error against that time, and in each chart every contestant's own
 * Pareto front. 1 to 16 tables; errors as above. */
abbe_result abbe_sweep_plot_scenes(const char *path, const abbe_sweep_table *tables, size_t count,
                                   abbe_sweep_number number, abbe_error *error);

#endif
