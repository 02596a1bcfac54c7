#include "spectral/index_points.h"

#include "spectral/file.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_FIELDS = 3, MAX_BYTES = 16 << 20 };

void abbe_index_points_free(abbe_index_points *points) {
  free(points->lambda_nm);
  free(points->n);
  free(points->uncertainty);
  *points = (abbe_index_points){0};
}

static abbe_result allocate(abbe_index_points *points, size_t count, bool uncertain,
                            abbe_error *error) {
  points->lambda_nm = calloc(count, sizeof(double));
  points->n = calloc(count, sizeof(double));
  if (uncertain) points->uncertainty = calloc(count, sizeof(double));
  if (points->lambda_nm != NULL && points->n != NULL && (points->uncertainty != NULL || !uncertain))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", count);
}

/* ---- of a formula ---- */

abbe_result abbe_index_points_sample(const abbe_dispersion *dispersion, double min_nm,
                                     double max_nm, size_t at_least, size_t at_most,
                                     abbe_index_points *out, abbe_error *error) {
  *out = (abbe_index_points){.exact = true};
  if (!isfinite(min_nm) || !isfinite(max_nm) || min_nm <= 0 || min_nm >= max_nm)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g:%g nm is not one, such as 380:780", min_nm, max_nm);
  if (at_least < 2 || at_most < at_least || at_most > ABBE_INDEX_POINTS_MAX_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu to %zu points of a formula are asked for; 2 to %d are possible",
                          at_least, at_most, ABBE_INDEX_POINTS_MAX_COUNT);
  double span = max_nm - min_nm;
  bool by_nm = ceil(span) + 1 >= (double)at_least && ceil(span) + 1 <= (double)at_most;
  size_t count = by_nm ? (size_t)ceil(span) + 1 : span < (double)at_least ? at_least : at_most;
  abbe_result result = allocate(out, count, false, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    double step = by_nm ? (double)i : span * (double)i / (double)(count - 1);
    out->lambda_nm[i] = i + 1 == count ? max_nm : min_nm + step;
    out->n[i] = abbe_dispersion_n(dispersion, out->lambda_nm[i]);
    if (isnan(out->n[i]))
      result =
          abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the %s formula has no real index at %g nm",
                         abbe_dispersion_model_name(dispersion->model), out->lambda_nm[i]);
  }
  out->count = count;
  if (result != ABBE_OK) abbe_index_points_free(out);
  return result;
}

/* ---- of a file ---- */

typedef enum unit { UNIT_UNKNOWN, UNIT_NM, UNIT_UM } unit;

typedef struct row {
  double field[MAX_FIELDS];
  size_t fields, line;
} row;

typedef struct reader {
  const char *name;
  row *rows;
  size_t count, capacity;
  unit unit;
  bool named; /* the first line of words has been read */
  abbe_error *error;
} reader;

static bool separates(char c) {
  return c == ',' || c == ';' || isspace((unsigned char)c);
}

/* Whether the line holds the unit as a word of its own: "um" is none in "number". */
static bool says(const char *line, const char *what, bool whole) {
  size_t length = strlen(what);
  for (const char *at = line; *at != '\0'; at++) {
    bool begins = at == line || !isalpha((unsigned char)at[-1]);
    if (begins && strncasecmp(at, what, length) == 0 &&
        (!whole || !isalpha((unsigned char)at[length])))
      return true;
  }
  return false;
}

/* The unit that a line of words names, for instance "wavelength (nm),n". */
static unit named_unit(const char *line) {
  bool nm = says(line, "nm", true) || says(line, "nanomet", false);
  bool um = says(line, "um", true) || says(line, "\xc2\xb5m", true) ||
            says(line, "\xce\xbcm", true) || says(line, "micro", false);
  return nm == um ? UNIT_UNKNOWN : nm ? UNIT_NM : UNIT_UM;
}

static abbe_result not_a_number(const reader *r, size_t line, const char *word) {
  const char *hint = strchr(word, '.') == NULL && isdigit((unsigned char)word[0])
                         ? "; decimals take a point, as in 587.6"
                         : "";
  return abbe_error_set(r->error, ABBE_PARSE,
                        "%s:%zu: '%.40s' is not a number; a line is a wavelength, an index and, if "
                        "known, its uncertainty, such as 587.6,1.5168,0.00002%s",
                        r->name, line, word, hint);
}

/* The numbers of one line, which is cut up. A word where no number has been yet is a heading. */
static abbe_result read_fields(reader *r, char *text, size_t line, row *out, bool *heading) {
  *out = (row){.line = line};
  *heading = false;
  for (char *at = text; *at != '\0';) {
    while (separates(*at)) at++;
    if (*at == '\0') break;
    char *end = at, *stop = NULL;
    while (*end != '\0' && !separates(*end)) end++;
    char after = *end;
    *end = '\0';
    double value = strtod(at, &stop);
    bool number = stop != at && *stop == '\0';
    if (!number && out->fields == 0 && r->count == 0 && !r->named) {
      *end = after;
      *heading = true;
      return ABBE_OK;
    }
    if (!number || !isfinite(value)) return not_a_number(r, line, at);
    if (out->fields == MAX_FIELDS)
      return abbe_error_set(r->error, ABBE_PARSE,
                            "%s:%zu: more than three numbers; a line is a wavelength, an index "
                            "and, if known, its uncertainty",
                            r->name, line);
    out->field[out->fields++] = value;
    at = after == '\0' ? end : end + 1;
  }
  return ABBE_OK;
}

static abbe_result keep(reader *r, const row *made) {
  if (made->fields < 2)
    return abbe_error_set(r->error, ABBE_PARSE,
                          "%s:%zu: one number is not a point; a line is a wavelength and an index, "
                          "such as 587.6,1.5168",
                          r->name, made->line);
  if (r->count > 0 && made->fields != r->rows[0].fields)
    return abbe_error_set(r->error, ABBE_SCHEMA,
                          "%s:%zu: %zu numbers, but line %zu has %zu; uncertainties stand on every "
                          "line or on none",
                          r->name, made->line, made->fields, r->rows[0].line, r->rows[0].fields);
  if (r->count == ABBE_INDEX_POINTS_MAX_COUNT)
    return abbe_error_set(r->error, ABBE_SCHEMA, "%s:%zu: more than %d points", r->name, made->line,
                          ABBE_INDEX_POINTS_MAX_COUNT);
  if (r->count == r->capacity) {
    size_t capacity = r->capacity > 0 ? 2 * r->capacity : 64;
    row *rows = realloc(r->rows, capacity * sizeof *rows);
    if (rows == NULL)
      return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory for its points", r->name);
    r->rows = rows;
    r->capacity = capacity;
  }
  r->rows[r->count++] = *made;
  return ABBE_OK;
}

static abbe_result read_line(reader *r, char *text, size_t line) {
  row made;
  bool heading = false;
  char *comment = strchr(text, '#');
  if (comment != NULL) *comment = '\0';
  abbe_result result = read_fields(r, text, line, &made, &heading);
  if (result != ABBE_OK || (made.fields == 0 && !heading)) return result;
  if (!heading) return keep(r, &made);
  r->named = true;
  r->unit = named_unit(text);
  return ABBE_OK;
}

static int by_wavelength(const void *a, const void *b) {
  const row *x = a, *y = b;
  if (x->field[0] != y->field[0]) return x->field[0] < y->field[0] ? -1 : 1;
  return x->line < y->line ? -1 : x->line > y->line;
}

/* No optical wavelength is below 100 nm or above 100 um in both readings at once. */
static abbe_result settle_unit(reader *r, bool *guessed) {
  *guessed = false;
  if (r->unit != UNIT_UNKNOWN) return ABBE_OK;
  double low = r->rows[0].field[0], high = r->rows[r->count - 1].field[0];
  *guessed = true;
  if (low >= 100 || high < 100) {
    r->unit = low >= 100 ? UNIT_NM : UNIT_UM;
    return ABBE_OK;
  }
  return abbe_error_set(r->error, ABBE_SCHEMA,
                        "%s: wavelengths from %g to %g are nm or um? A first line such as "
                        "'wavelength_nm,n' says",
                        r->name, low, high);
}

static abbe_result check_row(const reader *r, const row *at, double lambda_nm) {
  if (!(lambda_nm >= 1 && lambda_nm <= 1e6))
    return abbe_error_set(r->error, ABBE_SCHEMA,
                          "%s:%zu: the wavelength %g is %g nm; 1 nm to 1 mm are possible (a first "
                          "line such as 'wavelength_um,n' names the unit)",
                          r->name, at->line, at->field[0], lambda_nm);
  if (!(at->field[1] >= 1e-3 && at->field[1] <= 1e3))
    return abbe_error_set(r->error, ABBE_SCHEMA,
                          "%s:%zu: the index %g is outside 0.001 to 1000; the second number of a "
                          "line is n",
                          r->name, at->line, at->field[1]);
  if (at->fields == 3 && !(at->field[2] > 0))
    return abbe_error_set(r->error, ABBE_SCHEMA,
                          "%s:%zu: the uncertainty %g is not one; it is a standard uncertainty of "
                          "n, above 0, such as 0.00002",
                          r->name, at->line, at->field[2]);
  return ABBE_OK;
}

static abbe_result settle(reader *r, abbe_index_points *out) {
  if (r->count == 0)
    return abbe_error_set(r->error, ABBE_PARSE,
                          "%s has no points; a line is a wavelength and an index, such as "
                          "587.6,1.5168",
                          r->name);
  qsort(r->rows, r->count, sizeof *r->rows, by_wavelength);
  abbe_result result = settle_unit(r, &out->unit_guessed);
  bool uncertain = r->rows[0].fields == 3;
  if (result == ABBE_OK) result = allocate(out, r->count, uncertain, r->error);
  for (size_t i = 0; i < r->count && result == ABBE_OK; i++) {
    const row *at = &r->rows[i];
    double lambda_nm = at->field[0] * (r->unit == UNIT_UM ? 1000 : 1);
    result = check_row(r, at, lambda_nm);
    out->lambda_nm[i] = lambda_nm;
    out->n[i] = at->field[1];
    if (uncertain) out->uncertainty[i] = at->field[2];
  }
  out->count = r->count;
  return result;
}

abbe_result abbe_index_points_parse(const char *text, size_t size, const char *name,
                                    abbe_index_points *out, abbe_error *error) {
  *out = (abbe_index_points){0};
  reader r = {.name = name, .error = error};
  if (size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) text += 3, size -= 3; /* byte order mark */
  if (size > MAX_BYTES)
    return abbe_error_set(error, ABBE_SCHEMA, "%s: more than %d bytes", name, MAX_BYTES);
  if (size > 0 && memchr(text, '\0', size) != NULL)
    return abbe_error_set(error, ABBE_PARSE, "%s is not a text file: it holds a zero byte", name);
  char *copy = malloc(size + 1);
  if (copy == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", name);
  if (size > 0) memcpy(copy, text, size);
  copy[size] = '\0';
  abbe_result result = ABBE_OK;
  size_t line = 1;
  for (char *at = copy; at != NULL && result == ABBE_OK; line++) {
    char *end = strchr(at, '\n');
    if (end != NULL) *end = '\0';
    result = read_line(&r, at, line);
    at = end != NULL ? end + 1 : NULL;
  }
  if (result == ABBE_OK) result = settle(&r, out);
  if (result != ABBE_OK) abbe_index_points_free(out);
  free(r.rows);
  free(copy);
  return result;
}

abbe_result abbe_index_points_load(const char *path, abbe_index_points *out, abbe_error *error) {
  *out = (abbe_index_points){0};
  char *text = NULL;
  size_t size = 0;
  abbe_result result = abbe_file_read(path, MAX_BYTES, &text, &size, error);
  if (result == ABBE_OK) result = abbe_index_points_parse(text, size, path, out, error);
  free(text);
  return result;
}
