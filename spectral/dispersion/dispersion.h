/* dispersion.h: refractive index as a function of wavelength, n(lambda).
 *
 * The models are the published formulas with their own coefficients; lambda is in nm in this
 * interface and in micrometres inside the formulas. Indices are relative to air at the source's
 * conditions, wavelengths in air, unless the material's record says otherwise, or to the air of its
 * shift. It knows nothing of names, tables or files.
 */
#ifndef ABBE_SPECTRAL_DISPERSION_DISPERSION_H
#define ABBE_SPECTRAL_DISPERSION_DISPERSION_H

#include "base/error.h"
#include "spectral/spectrum.h"

#include <stdbool.h>
#include <stddef.h>

/* An index at another temperature and in air of another pressure than catalogues'.
 *
 * Catalogues measure in air of a reference temperature and 1 atm. [SchottTIE19]'s formula takes the
 * index from there, with six coefficients of the glass, and air's by F. Kohlrausch. A wavelength
 * means light of one frequency, whatever the air: it is that in the catalogue's air. Humidity
 * (below 1e-6), expansion and stress are left out. */

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

/* X(code, name in files, formula); c[0], c[1], … are the coefficients, L is lambda in um. */
#define ABBE_DISPERSION_MODELS(X)                                                                  \
  X(CONSTANT, "constant", "n = c0")                                                                \
  X(CAUCHY, "cauchy", "n = c0 + c1 L^-2 + c2 L^-4 + ...")                                          \
  X(SELLMEIER, "sellmeier", "n^2 - 1 = c0 + sum_k c(2k-1) L^2 / (L^2 - c(2k)^2)")                  \
  X(SELLMEIER2, "sellmeier2", "n^2 - 1 = c0 + sum_k c(2k-1) L^2 / (L^2 - c(2k))")                  \
  X(POLYNOMIAL, "polynomial", "n^2 = c0 + sum_k c(2k-1) L^c(2k)")                                  \
  X(RII4, "rii4",                                                                                  \
    "n^2 = c0 + c1 L^c2/(L^2 - c3^c4) + c5 L^c6/(L^2 - c7^c8) + c9 L^c10 + c11 L^c12 + ...")       \
  X(POWERS, "powers", "n = c0 + sum_k c(2k-1) L^c(2k)")                                            \
  X(HERZBERGER, "herzberger",                                                                      \
    "n = c0 + c1 K + c2 K^2 + c3 L^2 + c4 L^4 + c5 L^6, K = 1 / (L^2 - 0.028)")                    \
  X(RII6, "rii6", "n - 1 = c0 + sum_k c(2k-1) / (c(2k) - L^-2)")                                   \
  X(RII8, "rii8", "(n^2 - 1) / (n^2 + 2) = c0 + c1 L^2 / (L^2 - c2) + c3 L^2")                     \
  X(RII9, "rii9", "n^2 = c0 + c1 / (L^2 - c2) + c3 (L - c4) / ((L - c4)^2 + c5)")                  \
  X(TABULATED, "tabulated", "n through tabulated points")                                          \
  X(CONDUCTOR, "conductor", "n + i k straight between tabulated points")

typedef enum abbe_dispersion_model {
#define ABBE_DISPERSION_ENUM(code, name, formula) ABBE_DISPERSION_##code,
  ABBE_DISPERSION_MODELS(ABBE_DISPERSION_ENUM)
#undef ABBE_DISPERSION_ENUM
      ABBE_DISPERSION_MODEL_COUNT
} abbe_dispersion_model;

#define ABBE_DISPERSION_MAX_COEFFICIENTS 32

typedef struct abbe_dispersion {
  abbe_dispersion_model model;
  size_t count; /* coefficients used */
  double c[ABBE_DISPERSION_MAX_COEFFICIENTS];
  abbe_spectrum *table;   /* TABULATED, CONDUCTOR: n at nm; owned; else NULL */
  abbe_spectrum *k;       /* CONDUCTOR: k at the nm of n; owned; else NULL */
  abbe_index_shift shift; /* to a scene's conditions; zeroed in tables */
} abbe_dispersion;

void abbe_dispersion_free(abbe_dispersion *dispersion);

/* ABBE_INVALID_ARGUMENT, with what would be right, where the coefficients are not finite or their
 * count does not fit the model, or a tabulated model has no table, or a conductor not both of its
 * own: n and k at the same wavelengths, linear, in [0, 1e3]. */
abbe_result abbe_dispersion_check(const abbe_dispersion *dispersion, abbe_error *error);

/* n at lambda_nm (> 0). No range is checked here: that is the material's. Returns NaN where the
 * formula has no real, positive, finite value (a pole, n^2 <= 0), and for a conductor, which has no
 * real index anywhere. */
double abbe_dispersion_n(const abbe_dispersion *dispersion, double lambda_nm);

/* The complex index n + i k of a conductor at lambda_nm (> 0), held beyond its points. False, with
 * *n and *k as they were, for any other model. */
bool abbe_dispersion_nk(const abbe_dispersion *dispersion, double lambda_nm, double *n, double *k);

/* Fraunhofer lines, nm in air [Schott2014]; B and G are the gem trade's. */
#define ABBE_LINE_C_NM 656.2725
#define ABBE_LINE_D_NM 587.5618
#define ABBE_LINE_F_NM 486.1327
#define ABBE_LINE_B_NM 686.7
#define ABBE_LINE_G_NM 430.8

typedef struct abbe_dispersion_numbers {
  double n_d, n_F, n_C; /* indices at the lines d, F, C */
  double v_d;           /* Abbe number (n_d - 1) / (n_F - n_C); infinite where n_F == n_C */
  double b_g;           /* gem trade's dispersion n(G) - n(B), Fraunhofer G 430.8, B 686.7 nm */
} abbe_dispersion_numbers;

abbe_dispersion_numbers abbe_dispersion_describe(const abbe_dispersion *dispersion);

const char *abbe_dispersion_model_name(abbe_dispersion_model model);
/* The formula as one line of text, for people. */
const char *abbe_dispersion_model_formula(abbe_dispersion_model model);

#endif
