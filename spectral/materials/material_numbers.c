#include "spectral/materials/material_numbers.h"

#include "base/number.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A number is given only where the record covers it. */
static double n_at(const abbe_material *m, double lambda_nm) {
  if (abbe_material_extrapolates(m, lambda_nm) && !m->extrapolate) return NAN;
  return abbe_dispersion_n(&m->dispersion, lambda_nm);
}

void abbe_material_numbers_make(const abbe_material *m, abbe_material_numbers *out) {
  abbe_material_numbers made = {
      .n_d = n_at(m, ABBE_LINE_D_NM),
      .n_F = n_at(m, ABBE_LINE_F_NM),
      .n_C = n_at(m, ABBE_LINE_C_NM),
      .n_e = n_at(m, ABBE_LINE_E_NM),
      .n_g = n_at(m, ABBE_LINE_SMALL_G_NM),
      .b_g = n_at(m, ABBE_LINE_G_NM) - n_at(m, ABBE_LINE_B_NM),
  };
  double spread = made.n_F - made.n_C;
  made.v_d = spread == 0 ? INFINITY : (made.n_d - 1) / spread;
  made.p_gF = spread == 0 ? NAN : (made.n_g - made.n_F) / spread;
  made.dp_gF = made.p_gF - (0.6438 - 0.001682 * made.v_d);
  *out = made;
}

/* ---- what the source prints ---- */

/* Half of the last digit of a decimal number's text: 1.5168 is known to 5e-5. */
static double half_digit(const char *text, const char *end) {
  const char *point = memchr(text, '.', (size_t)(end - text));
  return point == NULL ? 0.5 : 0.5 * pow(10, -(double)(end - point - 1));
}

static bool stated(const char *text, const char *word, double *value, double *half) {
  size_t length = strlen(word);
  for (const char *at = text; at != NULL && (at = strstr(at, word)) != NULL; at += length) {
    if (at > text && (isalnum((unsigned char)at[-1]) || at[-1] == '_')) continue;
    const char *number = at + length + strspn(at + length, " :=");
    if (!isdigit((unsigned char)*number)) continue;
    const char *end = number + strspn(number, "0123456789."), *read;
    while (end[-1] == '.') end--; /* the end of a sentence */
    if (!abbe_number_read(number, &read, value)) continue;
    *half = half_digit(number, end);
    return isfinite(*value);
  }
  return false;
}

double abbe_material_half_digit(double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  abbe_number_text(value, text);
  const char *end = text + strcspn(text, "e");
  double scale = *end == 'e' ? pow(10, atoi(end + 1)) : 1;
  return scale * half_digit(text, end);
}

/* A number of the record's own key. */
static void keyed(double value, double *out, double *half) {
  if (!(value > 0)) return;
  *out = value;
  *half = abbe_material_half_digit(value);
}

void abbe_material_dn_dt(const abbe_material *material, double lambda_nm, double temperature_c,
                         double out[2]) {
  /* 10 degrees to both sides, as far as conditions reach */
  const double side_c[2] = {fmax(temperature_c - 10, ABBE_CONDITIONS_LEAST_C),
                            fmin(temperature_c + 10, ABBE_CONDITIONS_MOST_C)};
  double n[2][2] = {{NAN, NAN}, {NAN, NAN}};
  for (int i = 0; i < 2; i++) {
    abbe_material m = *material; /* owns nothing of its own */
    const abbe_conditions at = {side_c[i], 1};
    if (isnan(temperature_c) || !(side_c[0] < side_c[1]) ||
        abbe_material_place(&m, &at, NULL) != ABBE_OK)
      continue;
    abbe_material_n(&m, lambda_nm, &n[i][0], NULL);
    abbe_material_n_absolute(&m, lambda_nm, &n[i][1], NULL);
  }
  for (int k = 0; k < 2; k++) out[k] = (n[1][k] - n[0][k]) / (side_c[1] - side_c[0]);
}

void abbe_material_published_make(const abbe_material *m, abbe_material_published *out) {
  *out = (abbe_material_published){NAN, NAN, NAN, NAN};
  if (m->source != NULL) {
    stated(m->source, "n_d", &out->n_d, &out->n_d_half);
    stated(m->source, "V_d", &out->v_d, &out->v_d_half);
  }
  keyed(m->published_n_d, &out->n_d, &out->n_d_half);
  keyed(m->published_v_d, &out->v_d, &out->v_d_half);
}

/* ---- recorded fits ---- */

abbe_dispersion abbe_material_fit_dispersion(const abbe_material_fit *fit) {
  abbe_dispersion made = {.model = ABBE_DISPERSION_CAUCHY, .count = fit->terms};
  memcpy(made.c, fit->c, sizeof fit->c);
  return made;
}

abbe_result abbe_material_fit_residual(const abbe_material *m, const abbe_material_fit *fit,
                                       abbe_index_difference *out, abbe_error *error) {
  if (fit->terms == 0 || fit->terms > sizeof fit->c / sizeof fit->c[0])
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s has no such fit", m->name);
  abbe_dispersion form = abbe_material_fit_dispersion(fit);
  return abbe_index_difference_of_curves(&form, &m->dispersion, fit->min_nm, fit->max_nm, out,
                                         error);
}
