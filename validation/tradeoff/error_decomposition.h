/* error_decomposition.h: of what a setting's error is made: model, sampling, reconstruction; in
 * words.
 *
 * The model's part is how far matched physics is from full. The rest is how far the setting is from
 * matched physics: sampling and reconstruction together. What reconstruction does is seen where the
 * sweep has the same setting with and without its fill; whether sampling has come to its end, where
 * it has the same setting with half the photons a side or half the wavelengths. Errors are
 * mean CIEDE2000 of the caustic; they do not add up, so parts are named by size and not summed.
 */
#ifndef ABBE_VALIDATION_TRADEOFF_ERROR_DECOMPOSITION_H
#define ABBE_VALIDATION_TRADEOFF_ERROR_DECOMPOSITION_H

#include "validation/tradeoff/sweep_table.h"

/* NaN: not measured. Each part with its reference's noise taken off in squares (0: all noise). */
typedef struct abbe_error_decomposition {
  const abbe_sweep_row *row; /* the setting: the default profile's most accurate; NULL: none */
  double total, total_noise;
  double model, model_noise;      /* matched physics against full */
  double rest, rest_noise;        /* the setting against matched physics */
  double with_fill, without_fill; /* against matched physics, of one setting that has both */
  double fewer_photons;           /* the rest with half the photons a side, or fewer */
  double fewer_wavelengths;       /* the rest with half the wavelengths, or fewer */
  double energy, model_energy; /* energy of the map, against full: the setting's, and the model's */
  double fill_invented, fill_lost; /* shares of the map's light, of the setting */
} abbe_error_decomposition;

/* From the rows of a table, which outlives it; NaN for what no row has. */
void abbe_error_decomposition_make(const abbe_sweep_table *table, abbe_error_decomposition *out);

/* One paragraph; "" where the table has no row of the default profile. */
void abbe_error_decomposition_say(const abbe_error_decomposition *decomposition, char *out,
                                  size_t size);

#endif
