#include "spectral/materials/material_query.h"

#include "base/number.h"

#include <ctype.h>
#include <fnmatch.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *abbe_material_key_name(abbe_material_key key) {
  static const char *const names[] = {
#define ABBE_MATERIAL_KEY_ROW(code, name) name,
      ABBE_MATERIAL_KEYS(ABBE_MATERIAL_KEY_ROW)
#undef ABBE_MATERIAL_KEY_ROW
  };
  return (int)key >= 0 && key < ABBE_MATERIAL_KEY_COUNT ? names[key] : "unknown";
}

/* ---- choosing ---- */

static char *lower(const char *text) {
  char *made = strdup(text);
  for (char *at = made; at != NULL && *at != '\0'; at++) *at = (char)tolower((unsigned char)*at);
  return made;
}

/* Both are in lower case; pattern may be NULL. */
static bool matches(const char *pattern, const char *text) {
  if (pattern == NULL) return true;
  if (text == NULL) return false;
  if (strpbrk(pattern, "*?[") != NULL) return fnmatch(pattern, text, 0) == 0;
  return strstr(text, pattern) != NULL;
}

static bool text_matches(const char *pattern, const char *text, bool *no_memory) {
  if (pattern == NULL) return true;
  char *plain = lower(text != NULL ? text : "");
  if (plain == NULL) *no_memory = true;
  bool found = plain != NULL && matches(pattern, plain);
  free(plain);
  return found;
}

static bool within(double value, double min, double max) {
  return (min == 0 && max == 0) || (value >= min && value <= max);
}

/* ---- sorting ---- */

typedef struct place {
  size_t row;
  double number;    /* NaN: the row has none */
  const char *text; /* NULL where numbers sort */
  bool descending;
} place;

static int in_order(const void *a, const void *b) {
  const place *x = a, *y = b;
  int order = 0;
  if (x->text != NULL && y->text != NULL)
    order = strcasecmp(x->text, y->text);
  else if (isnan(x->number) || isnan(y->number))
    return isnan(x->number) == isnan(y->number) ? (x->row > y->row) - (x->row < y->row)
           : isnan(x->number)                   ? 1
                                                : -1;
  else
    order = (x->number > y->number) - (x->number < y->number);
  if (order != 0) return x->descending ? -order : order;
  return (x->row > y->row) - (x->row < y->row);
}

static place place_of(const abbe_material_table *table, size_t row, const abbe_material_query *q,
                      const abbe_material_numbers *n) {
  const abbe_material *m = &table->material[row];
  place p = {.row = row, .descending = q->descending, .number = (double)row};
  switch (q->sort) {
  case ABBE_MATERIAL_KEY_NAME:
    p.text = m->name;
    break;
  case ABBE_MATERIAL_KEY_SOURCE:
    p.text = m->source != NULL ? m->source : "";
    break;
  case ABBE_MATERIAL_KEY_ND:
    p.number = n->n_d;
    break;
  case ABBE_MATERIAL_KEY_VD:
    p.number = n->v_d;
    break;
  case ABBE_MATERIAL_KEY_BG:
    p.number = n->b_g;
    break;
  case ABBE_MATERIAL_KEY_PGF:
    p.number = n->p_gF;
    break;
  case ABBE_MATERIAL_KEY_FROM:
    p.number = m->min_nm;
    break;
  case ABBE_MATERIAL_KEY_TO:
    p.number = m->max_nm;
    break;
  default:
    break;
  }
  return p;
}

/* ---- both ---- */

static size_t choose(const abbe_material_table *table, const abbe_material_query *q,
                     const char *name, const char *source, place *places, bool *no_memory) {
  size_t count = 0;
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    abbe_material_numbers n;
    abbe_material_numbers_make(m, &n);
    if (within(n.n_d, q->n_d_min, q->n_d_max) && within(n.v_d, q->v_d_min, q->v_d_max) &&
        text_matches(name, m->name, no_memory) && text_matches(source, m->source, no_memory))
      places[count++] = place_of(table, i, q, &n);
  }
  qsort(places, count, sizeof *places, in_order);
  return count;
}

abbe_result abbe_material_query_run(const abbe_material_table *table,
                                    const abbe_material_query *query, size_t **rows, size_t *count,
                                    abbe_error *error) {
  *rows = NULL;
  *count = 0;
  if ((int)query->sort < 0 || query->sort >= ABBE_MATERIAL_KEY_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no key %d to sort by",
                          (int)query->sort);
  place *places = malloc((table->count + 1) * sizeof *places);
  char *name = query->name != NULL ? lower(query->name) : NULL;
  char *source = query->source != NULL ? lower(query->source) : NULL;
  bool no_memory = places == NULL || (query->name != NULL && name == NULL) ||
                   (query->source != NULL && source == NULL);
  size_t found = no_memory ? 0 : choose(table, query, name, source, places, &no_memory);
  if (found > 0) *rows = malloc(found * sizeof **rows);
  no_memory = no_memory || (found > 0 && *rows == NULL);
  for (size_t i = 0; i < found && !no_memory; i++) (*rows)[i] = places[i].row;
  free(places);
  free(name);
  free(source);
  if (no_memory) {
    free(*rows);
    *rows = NULL;
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to choose rows");
  }
  *count = found;
  return ABBE_OK;
}

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
