/* material.h: a transparent material: dispersion, absorption, and where its numbers come from.
 */
#ifndef ABBE_SPECTRAL_MATERIAL_H
#define ABBE_SPECTRAL_MATERIAL_H

#include "spectral/dispersion.h"
#include "spectral/error.h"
#include "spectral/spectrum.h"

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A Cauchy form fitted to the material, as the table records it. */
typedef struct abbe_material_fit {
  size_t terms;        /* 0 where the table has none */
  double c[8];         /* um^(2k) */
  double max_error;    /* largest |n - fit| over [min_nm, max_nm] */
  double min_nm, max_nm;
} abbe_material_fit;

typedef struct abbe_material {
  char *name;                /* unique in its table, as on the command line */
  char *description;         /* one line for people; may be NULL */
  abbe_dispersion dispersion;
  double min_nm, max_nm;     /* valid range of the dispersion, from its source */
  bool extrapolate;          /* the record allows use outside that range; reported when used */
  abbe_spectrum *attenuation;/* natural attenuation coefficient, 1/m, at nm; NULL: clear */
  double temperature_c;      /* of the measurement, Celsius; NaN where the source is silent */
  char *source;              /* key into BIBLIOGRAPHY.md, then details */
  char *warning;             /* what a user of this row must know (thesis rows); may be NULL */
  abbe_material_fit fit[2];  /* two and three terms */
  size_t line;               /* of the record in its file, for messages */
} abbe_material;

void abbe_material_free(abbe_material *material);

/* n at lambda_nm into *n. ABBE_OUT_OF_RANGE outside [min_nm, max_nm] unless extrapolate;
 * ABBE_INVALID_ARGUMENT where the formula has no real value there. */
abbe_result abbe_material_n(const abbe_material *material, double lambda_nm, double *n,
                            abbe_error *error);

/* Whether lambda_nm lies outside the valid range (so that n there is extrapolated). */
bool abbe_material_extrapolates(const abbe_material *material, double lambda_nm);

/* Natural attenuation coefficient at lambda_nm, 1/m, >= 0; 0 for a clear material. */
double abbe_material_attenuation(const abbe_material *material, double lambda_nm);

#ifdef __cplusplus
}
#endif
#endif
