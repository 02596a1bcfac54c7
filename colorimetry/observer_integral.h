/* observer_integral.h: integrals over wavelength of a light as the standard observer sees it.
 *
 * Gauss-Legendre pieces cut at every knot of the observer, the CIE's illuminants and a tabulated
 * light: exact for their stated interpolations.
 */
#ifndef ABBE_COLORIMETRY_OBSERVER_INTEGRAL_H
#define ABBE_COLORIMETRY_OBSERVER_INTEGRAL_H

#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"

#include <math.h>

/* Neumaier's compensated sum: thousands of bands add up to the last bit or so. */
typedef struct abbe_sum3 {
  double value[3], lost[3];
} abbe_sum3;

static inline void abbe_sum3_add(abbe_sum3 *sum, const double x[3]) {
  for (int k = 0; k < 3; k++) {
    double total = sum->value[k] + x[k];
    sum->lost[k] += fabs(sum->value[k]) >= fabs(x[k]) ? (sum->value[k] - total) + x[k]
                                                      : (x[k] - total) + sum->value[k];
    sum->value[k] = total;
  }
}

static inline void abbe_sum3_get(const abbe_sum3 *sum, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = sum->value[k] + sum->lost[k];
}

/* Integral over [from_nm, to_nm] of observer x illuminant, nm x the illuminant's unit; 0 for an
 * empty interval. Only 360 to 830 nm count. */
void abbe_observer_integral(const abbe_illuminant *illuminant, double from_nm, double to_nm,
                            double xyz[3]);

/* The same of any observer. */
void abbe_observer_integral_by(abbe_observer observer, const abbe_illuminant *illuminant,
                               double from_nm, double to_nm, double xyz[3]);

/* The same of observer x illuminant x each of three functions that are at most cubic between
 * multiples of 5 nm: matrix[3 * i + j] is component i of XYZ of function j. */
void abbe_observer_integral_of(abbe_observer observer, const abbe_illuminant *illuminant,
                               double from_nm, double to_nm,
                               void (*functions)(double lambda_nm, double value[3]),
                               double matrix[9]);

/* Integral of the illuminant alone, at any wavelength. */
double abbe_observer_integral_power(const abbe_illuminant *illuminant, double from_nm,
                                    double to_nm);

#endif
