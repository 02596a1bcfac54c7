#include "spectral/formats/agf_formula.h"

#include "base/number.h"
#include "base/text.h"
#include "spectral/dispersion/fit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

bool abbe_agf_is_blank(char c) {
  return c == ' ' || c == '\t' || c == ',';
}

const char *abbe_agf_skip(const char *c) {
  while (abbe_agf_is_blank(*c)) c++;
  return c;
}

static const char *field_end(const char *c) {
  while (*c != '\0' && !abbe_agf_is_blank(*c)) c++;
  return c;
}

const char *abbe_agf_word(const char *c, char *text, size_t size) {
  c = abbe_agf_skip(c);
  const char *end = field_end(c);
  size_t length = (size_t)(end - c) < size - 1 ? (size_t)(end - c) : size - 1;
  memcpy(text, c, length);
  text[length] = '\0';
  abbe_utf8_trim(text);
  return end;
}

/* Length of 1,5168 where that is all between two blanks; 0 where a comma parts two numbers. */
static size_t decimal_comma(const char *c) {
  static const char digits[] = "0123456789";
  size_t sign = *c == '-' || *c == '+', whole = strspn(c + sign, digits);
  const char *comma = c + sign + whole;
  size_t part = *comma == ',' ? strspn(comma + 1, digits) : 0;
  if (whole == 0 || part == 0) return 0;
  const char *end = comma + 1 + part;
  if (*end == 'e' || *end == 'E') {
    end += 1 + (end[1] == '-' || end[1] == '+');
    end += strspn(end, digits);
  }
  return *end == '\0' || *end == ' ' || *end == '\t' ? (size_t)(end - c) : 0;
}

void abbe_agf_numbers_read(const char *c, abbe_agf_numbers *to) {
  const char *end = c;
  for (c = abbe_agf_skip(c); *c != '\0' && to->count < ABBE_AGF_MAX_FIELDS;
       c = abbe_agf_skip(end)) {
    double value = NAN;
    char text[64];
    bool parted = memchr(end, ',', (size_t)(c - end)) != NULL;
    size_t length = parted ? 0 : decimal_comma(c);
    const char *field = c, *past = c;
    end = length > 0 ? c + length : field_end(c);
    if (length > 0 && length < sizeof text) {
      snprintf(text, sizeof text, "%.*s", (int)length, c);
      *strchr(text, ',') = '.';
      field = past = text;
      to->commas = true;
    }
    bool unknown = (c[0] == '-' || c[0] == '?') && (c[1] == '\0' || abbe_agf_is_blank(c[1]));
    bool good = abbe_number_read(field, &past, &value) &&
                (*past == '\0' || abbe_agf_is_blank(*past)) && isfinite(value);
    to->bad = to->bad || (!good && !unknown);
    to->value[to->count++] = good ? value : NAN;
  }
}

double abbe_agf_number(const abbe_agf_numbers *l, size_t i, double otherwise) {
  return i < l->count && isfinite(l->value[i]) ? l->value[i] : otherwise;
}

enum { FORMULAS = 13 };

static const char *const names[FORMULAS] = {
    "Schott",      "Sellmeier 1", "Herzberger",           "Sellmeier 2",
    "Conrady",     "Sellmeier 3", "Handbook of Optics 1", "Handbook of Optics 2",
    "Sellmeier 4", "Extended 1",  "Sellmeier 5",          "Extended 2",
    "Extended 3"};

const char *abbe_agf_formula_name(int number) {
  return number >= 1 && number <= FORMULAS ? names[number - 1] : NULL;
}

/* Powers of L in n^2 after the constant, in the catalogue's order; 0 ends the list. */
static const struct {
  int number;
  signed char power[ABBE_AGF_COEFFICIENTS];
} polynomials[] = {
    {1, {2, -2, -4, -6, -8}},
    {10, {2, -2, -4, -6, -8, -10, -12}},
    {12, {2, -2, -4, -6, -8, 4, 6}},
    {13, {2, 4, -2, -4, -6, -8, -10, -12}},
};
enum { POLYNOMIALS = sizeof polynomials / sizeof polynomials[0] };

/* Sums of L^2 / (L^2 - pole) by their number of terms. */
static const struct { int number, terms; } sums[] = {{2, 3}, {6, 4}, {11, 5}};

/* ---- from Zemax ---- */

static void read_polynomial(size_t which, const double *c, abbe_dispersion *d) {
  *d = (abbe_dispersion){.model = ABBE_DISPERSION_POLYNOMIAL, .count = 1, .c = {c[0]}};
  for (size_t k = 0; polynomials[which].power[k] != 0; k++) {
    d->c[d->count++] = c[k + 1];
    d->c[d->count++] = polynomials[which].power[k];
  }
}

static void read_sum(int terms, const double *c, abbe_dispersion *d) {
  *d = (abbe_dispersion){.model = ABBE_DISPERSION_SELLMEIER2, .count = 1};
  for (int k = 0; k < terms; k++) {
    if (c[2 * k] == 0) continue; /* catalogues fill up with zeros */
    d->c[d->count++] = c[2 * k];
    d->c[d->count++] = c[2 * k + 1];
  }
}

static void read_conrady(const double *c, abbe_dispersion *d) {
  if (c[1] == 0 && c[2] == 0)
    *d = (abbe_dispersion){.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {c[0]}};
  else
    *d = (abbe_dispersion){
        .model = ABBE_DISPERSION_POWERS, .count = 5, .c = {c[0], c[1], -1, c[2], -3.5}};
}

static void set(abbe_dispersion *d, abbe_dispersion_model model, size_t count, const double *c) {
  *d = (abbe_dispersion){.model = model, .count = count};
  memcpy(d->c, c, count * sizeof *c);
}

static void read_rest(int number, const double *c, abbe_dispersion *d) {
  switch (number) {
  case 3:
    set(d, ABBE_DISPERSION_HERZBERGER, 6, c);
    break;
  case 4:
    set(d, ABBE_DISPERSION_RII4, 9,
        (double[]){abbe_number_tidy(1 + c[0]), c[1], 2, c[2], 2, c[3], 0, c[4], 2});
    break;
  case 5:
    read_conrady(c, d);
    break;
  case 7:
    set(d, ABBE_DISPERSION_RII4, 11, (double[]){c[0], c[1], 0, c[2], 1, 0, 0, 0, 1, -c[3], 2});
    break;
  case 8:
    set(d, ABBE_DISPERSION_RII4, 11, (double[]){c[0], c[1], 2, c[2], 1, 0, 0, 0, 1, -c[3], 2});
    break;
  default: /* 9 */
    set(d, ABBE_DISPERSION_RII4, 9, (double[]){c[0], c[1], 2, c[2], 1, c[3], 2, c[4], 1});
  }
}

static void read_formula(int number, const double *c, abbe_dispersion *d) {
  for (size_t i = 0; i < POLYNOMIALS; i++)
    if (polynomials[i].number == number) {
      read_polynomial(i, c, d);
      return;
    }
  for (size_t i = 0; i < sizeof sums / sizeof sums[0]; i++)
    if (sums[i].number == number) {
      read_sum(sums[i].terms, c, d);
      return;
    }
  read_rest(number, c, d);
}

abbe_result abbe_agf_formula_read(const abbe_agf_formula *formula, abbe_dispersion *out,
                                  abbe_error *error) {
  *out = (abbe_dispersion){0};
  if (abbe_agf_formula_name(formula->number) == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "there is no formula %d; a catalogue's are 1 to %d", formula->number,
                          FORMULAS);
  bool any = false;
  for (int i = 0; i < ABBE_AGF_COEFFICIENTS; i++) {
    if (!isfinite(formula->c[i]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "coefficient %d is %g", i, formula->c[i]);
    any = any || formula->c[i] != 0;
  }
  if (!any) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "all of its coefficients are 0");
  read_formula(formula->number, formula->c, out);
  return ABBE_OK;
}

/* ---- to Zemax ---- */

static bool write_polynomial(const abbe_dispersion *d, abbe_agf_formula *out) {
  for (size_t i = 0; i < POLYNOMIALS; i++) {
    *out = (abbe_agf_formula){.number = polynomials[i].number, .c = {d->c[0]}};
    bool fits = true;
    for (size_t k = 1; k + 1 < d->count && fits; k += 2) {
      size_t place = 0;
      while (polynomials[i].power[place] != 0 && polynomials[i].power[place] != d->c[k + 1])
        place++;
      if (polynomials[i].power[place] != 0)
        out->c[place + 1] += d->c[k];
      else if (d->c[k + 1] == 0)
        out->c[0] += d->c[k];
      else
        fits = d->c[k] == 0;
    }
    if (fits) return true;
  }
  return false;
}

/* A constant is a term with its pole at 0. */
static bool write_sum(const abbe_dispersion *d, bool pole_squared, abbe_agf_formula *out) {
  double c[ABBE_AGF_COEFFICIENTS] = {0};
  int terms = 0;
  for (size_t k = 1; k + 1 < d->count; k += 2) {
    if (d->c[k] == 0) continue;
    if (terms == 5) return false;
    c[2 * terms] = d->c[k];
    c[2 * terms++ + 1] = pole_squared ? abbe_number_tidy(d->c[k + 1] * d->c[k + 1]) : d->c[k + 1];
  }
  if (d->c[0] != 0 && terms == 5) return false;
  if (d->c[0] != 0) c[2 * terms++] = d->c[0];
  size_t form = 0;
  while (sums[form].terms < terms) form++;
  out->number = sums[form].number;
  memcpy(out->c, c, sizeof c);
  return true;
}

/* The square of sum c_k x^k, x = L^-2, is a polynomial of Schott's kind. */
static bool write_cauchy(const abbe_dispersion *d, abbe_agf_formula *out) {
  double square[16] = {0};
  if (d->count > 4) return false;
  for (size_t i = 0; i < d->count; i++)
    for (size_t j = 0; j < d->count; j++) square[i + j] += d->c[i] * d->c[j];
  *out = (abbe_agf_formula){.number = d->count <= 3 ? 1 : 10, .c = {square[0]}};
  for (size_t k = 1; k <= 6; k++) out->c[k + 1] = square[k];
  return true;
}

static bool write_powers(const abbe_dispersion *d, abbe_agf_formula *out) {
  *out = (abbe_agf_formula){.number = 5, .c = {d->c[0]}};
  for (size_t k = 1; k + 1 < d->count; k += 2) {
    if (d->c[k] != 0 && d->c[k + 1] != -1 && d->c[k + 1] != -3.5) return false;
    if (d->c[k] != 0) out->c[d->c[k + 1] == -1 ? 1 : 2] += d->c[k];
  }
  return true;
}

/* The shapes that formulas 4, 7, 8 and 9 take as rii4: NaN where any number may stand. */
static bool write_rii4(const abbe_dispersion *d, abbe_agf_formula *out) {
  const double any = NAN, *c = d->c;
  const struct {
    int number;
    size_t count;
    double shape[11];
  } shapes[] = {{4, 9, {any, any, 2, any, 2, any, 0, any, 2}},
                {9, 9, {any, any, 2, any, 1, any, 2, any, 1}},
                {7, 9, {any, any, 0, any, 1, 0, any, any, any}},
                {8, 9, {any, any, 2, any, 1, 0, any, any, any}},
                {7, 11, {any, any, 0, any, 1, 0, 0, 0, 1, any, 2}},
                {8, 11, {any, any, 2, any, 1, 0, 0, 0, 1, any, 2}}};
  for (size_t i = 0; i < sizeof shapes / sizeof shapes[0]; i++) {
    bool fits = d->count == shapes[i].count;
    for (size_t k = 0; k < d->count && fits; k++)
      fits = isnan(shapes[i].shape[k]) || shapes[i].shape[k] == c[k];
    if (!fits) continue;
    *out = (abbe_agf_formula){.number = shapes[i].number, .c = {c[0], c[1], c[3]}};
    if (out->number == 4) out->c[0] = abbe_number_tidy(out->c[0] - 1);
    if (out->number == 4 || out->number == 9)
      memcpy(out->c + 3, (double[]){c[5], c[7]}, 2 * sizeof *c);
    if (d->count == 11) out->c[3] = -c[9];
    return true;
  }
  return false;
}

static bool write_same(const abbe_dispersion *d, abbe_agf_formula *out) {
  switch (d->model) {
  case ABBE_DISPERSION_CONSTANT:
    *out = (abbe_agf_formula){.number = 5, .c = {d->c[0]}};
    return true;
  case ABBE_DISPERSION_CAUCHY:
    return write_cauchy(d, out);
  case ABBE_DISPERSION_SELLMEIER:
    return write_sum(d, true, out);
  case ABBE_DISPERSION_SELLMEIER2:
    return write_sum(d, false, out);
  case ABBE_DISPERSION_POLYNOMIAL:
    return write_polynomial(d, out);
  case ABBE_DISPERSION_POWERS:
    return write_powers(d, out);
  case ABBE_DISPERSION_RII4:
    return write_rii4(d, out);
  case ABBE_DISPERSION_HERZBERGER:
    *out = (abbe_agf_formula){.number = 3};
    memcpy(out->c, d->c, 6 * sizeof *d->c);
    return true;
  default:
    return false;
  }
}

static bool reads_back(const abbe_agf_formula *formula, const abbe_dispersion *d) {
  abbe_dispersion back = {0};
  abbe_agf_formula_read(formula, &back, NULL);
  return back.model == d->model && back.count == d->count &&
         memcmp(back.c, d->c, d->count * sizeof *d->c) == 0;
}

abbe_result abbe_agf_formula_write(const abbe_dispersion *dispersion, double min_nm, double max_nm,
                                   abbe_agf_formula *out, abbe_agf_fidelity *fidelity,
                                   double *max_error, abbe_error *error) {
  *max_error = 0;
  *out = (abbe_agf_formula){0};
  if (write_same(dispersion, out)) {
    *fidelity = reads_back(out, dispersion) ? ABBE_AGF_SAME : ABBE_AGF_REWRITTEN;
    return ABBE_OK;
  }
  *fidelity = ABBE_AGF_FITTED;
  abbe_dispersion fit;
  ABBE_TRY(abbe_fit_dispersion(dispersion, 4, min_nm, max_nm, &fit, max_error, error));
  write_cauchy(&fit, out);
  return ABBE_OK;
}
