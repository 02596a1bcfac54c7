/* material_query.h: which rows of a table, in which order.
 *
 * It chooses and sorts; it neither prints nor changes the table.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_MATERIAL_QUERY_H
#define ABBE_SPECTRAL_MATERIALS_MATERIAL_QUERY_H

#include "base/error.h"
#include "spectral/dispersion/index_points.h"
#include "spectral/materials/material.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>

/* X(code, name): what rows may be sorted by. */
#define ABBE_MATERIAL_KEYS(X)                                                                      \
  X(FILE, "file") /* the order of the file */                                                      \
  X(NAME, "name") /* whatever the case */                                                          \
  X(ND, "n_d")                                                                                     \
  X(VD, "v_d")                                                                                     \
  X(BG, "b_g")                                                                                     \
  X(PGF, "p_gF")                                                                                   \
  X(FROM, "from") /* the shortest wavelength with data */                                          \
  X(TO, "to")     /* the longest */                                                                \
  X(SOURCE, "source")

typedef enum abbe_material_key {
#define ABBE_MATERIAL_KEY_ENUM(code, name) ABBE_MATERIAL_KEY_##code,
  ABBE_MATERIAL_KEYS(ABBE_MATERIAL_KEY_ENUM)
#undef ABBE_MATERIAL_KEY_ENUM
      ABBE_MATERIAL_KEY_COUNT
} abbe_material_key;

/* Zero asks for every row in the file's order. */
typedef struct abbe_material_query {
  const char *name;        /* part of the name, or a pattern with * ? [ ] for the whole of it */
  const char *source;      /* the same for the source */
  double n_d_min, n_d_max; /* ends included; both 0: any */
  double v_d_min, v_d_max;
  abbe_material_key sort;
  bool descending; /* rows without the number come last either way */
} abbe_material_query;

/* The rows' places in the table into *rows (malloc'd; NULL for none) and their *count. Letters
 * match whatever their case. A row without n_d or V_d is in no range of them. ABBE_NO_MEMORY;
 * ABBE_INVALID_ARGUMENT for a key that is none. */
abbe_result abbe_material_query_run(const abbe_material_table *table,
                                    const abbe_material_query *query, size_t **rows, size_t *count,
                                    abbe_error *error);

const char *abbe_material_key_name(abbe_material_key key);

/* The numbers by which people know a material, from its record.
 *
 * Indices at the lines, Abbe numbers, partial dispersion, the gem trade's dispersion, and what the
 * record's own text gives them as. A number that the record does not cover is NaN. */

/* Mercury's lines, nm in air [Schott2014]. */
#define ABBE_LINE_E_NM 546.074
#define ABBE_LINE_SMALL_G_NM 435.8343

typedef struct abbe_material_numbers {
  double n_d, n_F, n_C, n_e, n_g; /* indices at the lines d, F, C, e, g */
  double v_d;                     /* (n_d - 1) / (n_F - n_C); infinite where n_F == n_C */
  double b_g;                     /* gem trade's dispersion, n(430.8 nm) - n(686.7 nm) */
  double p_gF;                    /* partial dispersion (n_g - n_F) / (n_F - n_C) */
  /* p_gF less that of a normal glass of the same V_d, 0.6438 - 0.001682 V_d [SchottTIE29] */
  double dp_gF;
} abbe_material_numbers;

/* NaN where a line lies outside the record's range and the record does not extrapolate. */
void abbe_material_numbers_make(const abbe_material *material, abbe_material_numbers *out);

/* Gain of the index per kelvin, 1/K, mean from 10 K below a temperature to 10 K above it: [0]
 * relative to air of 1 atm, [1] absolute; NaN where the record does not give it. */
void abbe_material_dn_dt(const abbe_material *material, double lambda_nm, double temperature_c,
                         double out[2]);

/* n_d and V_d as the record has them from its source, each with half of its last digit; NaN
 * where it is silent. From its own keys, else from the words "n_d NUMBER" and "V_d NUMBER" in
 * its source. */
typedef struct abbe_material_published {
  double n_d, n_d_half, v_d, v_d_half;
} abbe_material_published;
void abbe_material_published_make(const abbe_material *material, abbe_material_published *out);

/* Half of the last digit of a finite value that was read from a decimal: 5e-5 of 1.5168, 5e-13 of
 * 1.2e-11. Zeros at its end, which a file may have had, are not known. */
double abbe_material_half_digit(double value);

/* A recorded fit against the record's own index over the fit's range. ABBE_INVALID_ARGUMENT where
 * there is no such fit, or no index in that range. */
abbe_result abbe_material_fit_residual(const abbe_material *material, const abbe_material_fit *fit,
                                       abbe_index_difference *out, abbe_error *error);
/* The recorded fit as a dispersion; its count is 0 where the record has none. */
abbe_dispersion abbe_material_fit_dispersion(const abbe_material_fit *fit);

#endif
