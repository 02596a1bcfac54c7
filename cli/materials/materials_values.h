/* materials_values.h: a material's numbers as the verbs of `abbe materials` print them, and as
 * JSON. */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_VALUES_H
#define ABBE_CLI_MATERIALS_MATERIALS_VALUES_H

#include "spectral/materials/material.h"

#include <cjson/cJSON.h>
#include <stddef.h>

/* The numbers of a material; NaN where its record does not vouch for the wavelengths. */
abbe_dispersion_numbers abbe_materials_numbers(const abbe_material *material);
/* value by format into text[size], or "-" for NaN, or "infinite"; returns what to print. */
const char *abbe_materials_number(char *text, size_t size, const char *format, double value);

/* An object for abbe_materials_print_json; want of memory at any step after this is remembered,
 * and then nothing is printed: half an answer is none. */
cJSON *abbe_materials_json(void);
abbe_result abbe_materials_print_json(const cJSON *root, abbe_error *error);
/* Adds text, or null where there is none. */
void abbe_materials_add_text(cJSON *to, const char *key, const char *text);
/* n_d, v_d, the indices at the lines, b_g and partial dispersions; null where the record does not
 * vouch for them. */
void abbe_materials_add_numbers(cJSON *to, const abbe_material *material);
/* A few coefficients to twelve digits, for a record that people read: no index moves by 1e-10. */
void abbe_materials_round(abbe_dispersion *dispersion);
/* density_g_cm3, null where the record has none. */
void abbe_materials_add_density(cJSON *to, const abbe_material *material);
void abbe_materials_add_pair(cJSON *to, const char *key, double a, double b);

#endif
