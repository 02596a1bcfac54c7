/* material.h: a material: dispersion, absorption, and where its numbers come from.
 *
 * It is transparent, with a real index, or a conductor, with n and k and nothing to do with light
 * but to mirror it: a conductor has no attenuation, fit, published n_d or V_d, and does not
 * extrapolate. A transparent one may be a crystal, with two indices (spectral/uniaxial.h) or three
 * (spectral/biaxial.h), and a crystal may be pleochroic: then it absorbs by the direction of the
 * light's field.
 *
 * A zeroed record with a name, a source and a dispersion is a valid one, but for temperature_c: 0
 * means 0 Celsius, NaN that the source is silent.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_MATERIAL_H
#define ABBE_SPECTRAL_MATERIALS_MATERIAL_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/spectrum.h"

#include <stdbool.h>
#include <stddef.h>

/* A Cauchy form fitted to the material, as the table records it. */
typedef struct abbe_material_fit {
  size_t terms;     /* 0 where the table has none */
  double c[8];      /* um^(2k) */
  double max_error; /* largest |n - fit| over [min_nm, max_nm] */
  double min_nm, max_nm;
} abbe_material_fit;

enum { ABBE_MATERIAL_MAX_NAME = 80 };

/* A row of a re-radiation matrix. */
typedef struct abbe_reradiation_row {
  double nm;               /* that excites */
  abbe_spectrum *emission; /* photons by nm by photon absorbed there, dark outside its points */
  double yield;            /* all of these */
} abbe_reradiation_row;

/* What it re-radiates of what it absorbs: a re-radiation matrix [Donaldson1954], of rows or a
 * product of what excites it and of what it emits. Emission is isotropic, unpolarised and in
 * photons, none of it at shorter wavelengths than what excites. */
typedef struct abbe_fluorescence {
  double yield; /* photons emitted by photon that excites, 0 to 1; of rows the most of one; 0: it
                   does not glow */
  abbe_spectrum *excitation; /* 1/m at nm, dark outside its points: absorption of its own, all of
                                which excites; NULL: all that the material absorbs at shorter
                                wavelengths than those of the emission does */
  abbe_spectrum *emission;   /* photons by nm, of any scale, dark outside its points; of rows their
                                sum */
  size_t rows;               /* 0: it is the product */
  abbe_reradiation_row *row; /* ascending; straight between them, nothing excites outside of them */
} abbe_fluorescence;

void abbe_fluorescence_free(abbe_fluorescence *fluorescence);
/* One row more; takes the emission over, also where it fails. ABBE_NO_MEMORY. */
abbe_result abbe_fluorescence_add_row(abbe_fluorescence *fluorescence, double nm,
                                      abbe_spectrum *emission, abbe_error *error);
/* After the last: yield and emission of the rows. Errors of abbe_spectrum_make. */
abbe_result abbe_fluorescence_sum_rows(abbe_fluorescence *fluorescence, abbe_error *error);

/* What a maker's catalogue says about a glass besides its index. It is carried, not used, but for
 * the density, which weighs stones, and dn/dT. 0 (NULL) means that the catalogue is silent, as it
 * does in the catalogues themselves. */
typedef struct abbe_material_catalogue {
  char *code;                  /* the six-digit code of n_d and V_d, as printed: 517642.251 */
  char *status;                /* standard, preferred, obsolete, special or melt */
  double melt_frequency;       /* 1 (most often molten) to 5 */
  double density_g_cm3;        /* up to ABBE_MATERIAL_DENSITY_MOST; a record's own key in tables */
  double expansion_per_k[2];   /* linear, 1/K; at lower and at higher temperatures */
  double expansion_range_k[4]; /* from, to of the first, from, to of the second, K; 0, 0: that of
                                  abbe_material_expansion_range_k */
  double dpgf;                 /* deviation of the partial dispersion P_gF from the normal line */
  double thermal[6];           /* dn/dT: D0, D1, D2, E0, E1, lambda_tk (um); about temperature_c;
                                  all 0: not known */
  size_t rating_count;         /* 0 or 6 */
  double ratings[6];           /* relative cost, then resistance: climate, stain, acid, alkali,
                                  phosphate; -1 where it is not known */
} abbe_material_catalogue;

/* What makers' catalogues state expansions over: -30 to 70 C and 100 to 300 C, in K. */
extern const double abbe_material_expansion_range_k[4];

typedef struct abbe_material {
  char *name;        /* unique in its table, as on the command line */
  char *description; /* one line for people; may be NULL */
  abbe_dispersion dispersion;
  abbe_dispersion extraordinary; /* the second index of a uniaxial crystal, whose ordinary index is
                                    the other; of any other material zeroed */
  abbe_dispersion outer[2];      /* the lowest and the highest index of a biaxial crystal, whose
                                    middle one is `dispersion`; of any other material zeroed */
  double min_nm, max_nm;         /* valid range of the dispersion, from its source */
  bool extrapolate;              /* the record allows use outside that range; reported when used */
  abbe_spectrum *attenuation;    /* natural attenuation coefficient, 1/m, at nm; NULL: clear; of a
                                    pleochroic crystal for a field along x */
  abbe_spectrum *attenuation_yz[2]; /* a pleochroic crystal's, along y (NULL: as along x) and along
                                       z, a uniaxial one's optic axis; else both NULL */
  abbe_fluorescence fluorescence;
  double
      temperature_c; /* temperature of the measurement, Celsius; NaN where the source is silent */
  bool n_absolute; /* its indices are relative to vacuum; else to air of that temperature and 1 atm,
                      or below ABBE_AIR_LEAST_C to vacuum as well */
  char *source;    /* key into BIBLIOGRAPHY.md, then details */
  char *warning;   /* what a user of this row must know (thesis rows); may be NULL */
  abbe_material_fit fit[2]; /* two and three terms */
  double published_n_d;     /* n_d and V_d as the source prints them, for the check; */
  double published_v_d;     /* 0 where it prints none */
  char *comment;            /* the source's own remark; may be NULL */
  abbe_material_catalogue catalogue;
  size_t line; /* the record's line in its file, for messages */
  size_t row;  /* of a store that all else is in but name and line; 0: all is here */
} abbe_material;

void abbe_material_free(abbe_material *material);

/* What a table holds of a catalogue's numbers: no other is larger. */
#define ABBE_MATERIAL_CATALOGUE_MOST 1e12
#define ABBE_MATERIAL_MELT_MOST 1e6
#define ABBE_MATERIAL_DENSITY_MOST 1e3
#define ABBE_MATERIAL_DPGF_MOST 1e3

/* Makes a table able to hold what a file has, which may be anything: a number that is not finite or
 * beyond those bounds, or a density or melt frequency below 0, becomes 0 (a rating -1). Returns how
 * many did. */
size_t abbe_material_catalogue_bound(abbe_material_catalogue *catalogue);

/* Whether a table may hold the record, that is: what is written of it can be read again. The name
 * has 1 to 80 printable characters and no space at its ends, there is a source, the coefficients go
 * with the model, the range ascends inside [ABBE_SPECTRUM_LOW_NM, ABBE_SPECTRUM_HIGH_NM] and inside
 * the points of a tabulated model, the formula has a real index at 1001 wavelengths over it, the
 * extraordinary one as well and three indices in their order, and a conductor has nothing that only
 * a transparent material has. ABBE_INVALID_ARGUMENT, with a sentence that begins with the name. */
abbe_result abbe_material_check(const abbe_material *material, abbe_error *error);
/* Checks all of it but the last, which takes its time: what needs no value of the formula. */
abbe_result abbe_material_check_form(const abbe_material *material, abbe_error *error);
/* The part of it that is about absorption along axes. */
abbe_result abbe_material_check_absorption(const abbe_material *material, abbe_error *error);
/* The part of it that is about fluorescence: a yield of 0 to 1, an emission of some light, none of
 * it at shorter wavelengths than the excitation, and something that excites. */
abbe_result abbe_material_check_fluorescence(const abbe_material *material, abbe_error *error);
/* The part of it that is about the name alone. */
abbe_result abbe_material_check_name(const char *name, abbe_error *error);

/* n at lambda_nm into *n. ABBE_OUT_OF_RANGE outside [min_nm, max_nm] unless extrapolate;
 * ABBE_INVALID_ARGUMENT where the formula has no real value there; ABBE_UNSUPPORTED for a
 * conductor. */
abbe_result abbe_material_n(const abbe_material *material, double lambda_nm, double *n,
                            abbe_error *error);

/* Whether its record gives dn/dT. */
bool abbe_material_has_thermal(const abbe_material *material);
/* Takes its index, from now on, at those conditions; twice moves it from its record's again. A
 * material of an index of exactly 1 is the air around, and stays. Where a temperature is not of its
 * measurement, ABBE_UNSUPPORTED of what gives no dn/dT, or one for two indices, or a negative
 * lambda_tk, which programs read in two ways; also of a conductor. ABBE_INVALID_ARGUMENT of given
 * ones outside ABBE_CONDITIONS_LEAST_C to _MOST_C or _MOST_ATM. */
abbe_result abbe_material_place(abbe_material *material, const abbe_conditions *at,
                                abbe_error *error);
/* Its absolute index there, n relative to vacuum; as abbe_material_n. */
abbe_result abbe_material_n_absolute(const abbe_material *material, double lambda_nm, double *n,
                                     abbe_error *error);

/* Whether it is a uniaxial crystal: it has an extraordinary index besides. */
bool abbe_material_is_uniaxial(const abbe_material *material);
/* Whether it has three indices, and whether it has more than one. */
bool abbe_material_is_biaxial(const abbe_material *material);
bool abbe_material_is_crystal(const abbe_material *material);
/* The index of a field along principal axis 0, 1 or 2, as abbe_material_n: of a biaxial crystal
 * alpha, beta and gamma; of a uniaxial one ordinary, ordinary and extraordinary. */
abbe_result abbe_material_n_along(const abbe_material *material, int axis, double lambda_nm,
                                  double *n, abbe_error *error);
/* The extraordinary index, as abbe_material_n; that of any other material is its only one. */
abbe_result abbe_material_n_extraordinary(const abbe_material *material, double lambda_nm,
                                          double *n, abbe_error *error);

/* Whether it is a conductor: opaque, with a complex index, for mirrors. */
bool abbe_material_is_conductor(const abbe_material *material);

/* The complex index n + i k of a conductor at lambda_nm, straight between the published points.
 * ABBE_OUT_OF_RANGE outside [min_nm, max_nm], always; ABBE_UNSUPPORTED for any other material. */
abbe_result abbe_material_nk(const abbe_material *material, double lambda_nm, double *n, double *k,
                             abbe_error *error);

/* Whether lambda_nm lies outside the valid range (so that n there is extrapolated). */
bool abbe_material_extrapolates(const abbe_material *material, double lambda_nm);

/* Natural attenuation coefficient at lambda_nm, 1/m, >= 0; 0 for a clear material. That of a
 * pleochroic crystal is the mean over its three principal axes; what excites fluorescence is in it.
 */
double abbe_material_attenuation(const abbe_material *material, double lambda_nm);

/* Whether it absorbs by the direction of the light's field. */
bool abbe_material_is_pleochroic(const abbe_material *material);
/* The same for a field along principal axis 0, 1 or 2 (x, y, z; the optic axis is z). */
double abbe_material_attenuation_along(const abbe_material *material, int axis, double lambda_nm);

/* Whether it glows; the share of what it absorbs at lambda_nm that excites it; photons that it
 * emits by photon that excites; and the share of its photons, of all rows alike, from one
 * wavelength to another, ascending. */
bool abbe_material_is_fluorescent(const abbe_material *material);
double abbe_material_excites(const abbe_material *material, double lambda_nm);
double abbe_material_yield(const abbe_material *material, double lambda_nm);
double abbe_material_emission(const abbe_material *material, double from_nm, double to_nm);
/* Rows of its re-radiation, a product being one; what a row adds to the yield at lambda_nm, and the
 * share of the row's photons from one wavelength to another. */
size_t abbe_material_glow_rows(const abbe_material *material);
double abbe_material_row_yield(const abbe_material *material, size_t row, double lambda_nm);
double abbe_material_row_emission(const abbe_material *material, size_t row, double from_nm,
                                  double to_nm);
/* Photons by nm at to_nm by photon that excites at from_nm. */
double abbe_material_reradiates(const abbe_material *material, double from_nm, double to_nm);

/* Whether it absorbs within a wavelength (down to 1/e: k above 0.08) in most of the range, as
 * metals do, in which light does not get on. A conductor does. */
bool abbe_material_is_opaque(const abbe_material *material, double min_nm, double max_nm);

#endif
