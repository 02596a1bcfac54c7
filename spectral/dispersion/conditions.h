/* conditions.h: an index at another temperature and in air of another pressure than catalogues'.
 *
 * Catalogues measure in air of a reference temperature and 1 atm. [SchottTIE19]'s formula takes the
 * index from there, with six coefficients of the glass, and air's by F. Kohlrausch. A wavelength
 * means light of one frequency, whatever the air: it is that in the catalogue's air. Humidity
 * (below 1e-6), expansion and stress are left out.
 */
#ifndef ABBE_SPECTRAL_DISPERSION_CONDITIONS_H
#define ABBE_SPECTRAL_DISPERSION_CONDITIONS_H

#include <stdbool.h>

#define ABBE_CONDITIONS_LEAST_C (-250.0)
#define ABBE_CONDITIONS_MOST_C 200.0
#define ABBE_CONDITIONS_MOST_ATM 100.0

/* What surrounds a material, and is as warm as it is. */
typedef struct abbe_conditions {
  double temperature_c; /* Celsius; NaN: that of each material's measurement */
  double pressure_atm;  /* pressure of the air, 0: there is none; NaN: 1 */
} abbe_conditions;

/* Whether they are others than catalogues'. */
bool abbe_conditions_given(const abbe_conditions *at);

/* Colder, air of 1 atm is no gas. */
#define ABBE_AIR_LEAST_C (-190.0)

/* Index of dry air at nm, Celsius and atm, by Kohlrausch [SchottTIE19]: 1 without pressure; below
 * ABBE_AIR_LEAST_C as at that temperature. */
double abbe_air_n(double lambda_nm, double temperature_c, double pressure_atm);

/* How an index moves. Zeroed: it stays. */
typedef struct abbe_index_shift {
  bool on;
  double from_c, to_c, pressure_atm;
  double from_atm;   /* of the air that the catalogue's n is relative to; 0: to vacuum */
  double thermal[6]; /* D0, D1, D2, E0, E1, lambda_tk (um) */
} abbe_index_shift;

/* A catalogue's n relative to the air that is there; infinite at lambda_tk. Exactly 1 is the air's
 * own and stays. */
double abbe_index_shift_n(const abbe_index_shift *shift, double n, double lambda_nm);

#endif
