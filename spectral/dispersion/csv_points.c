#include "spectral/dispersion/csv_points.h"

#include "base/file.h"
#include "base/foreign_text.h"
#include "base/number.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_BYTES = 16 << 20, MAX_FIELDS = 64, MAX_FIELD = 64 };

typedef enum role { WAVELENGTH, INDEX, EXTINCTION, UNCERTAINTY, POWER, OTHER } role;

typedef struct reader {
  const char *name;
  const abbe_csv_options *options;
  bool light;         /* two columns, or one that is named, and nothing is passed over */
  const char *column; /* its name; NULL: there are two */
  const char *noun;   /* what a light's second column holds */
  abbe_csv_points *out;
  abbe_report *report;
  abbe_error *error;
  size_t line;
  bool decimal_comma;
  double header_unit_nm; /* 0: no header named one */
  role roles[MAX_FIELDS];
  size_t role_count; /* 0: no header yet */
  char field[MAX_FIELDS][MAX_FIELD];
  size_t fields;
} reader;

void abbe_csv_points_free(abbe_csv_points *points) {
  if (points == NULL) return;
  abbe_points_free(&points->n);
  abbe_points_free(&points->k);
  abbe_points_free(&points->power);
  *points = (abbe_csv_points){0};
}

/* ---- fields ---- */

static bool parts(char c, bool by_comma, bool by_semicolon, bool by_tab) {
  if (by_semicolon) return c == ';';
  if (by_comma) return c == ',';
  if (by_tab) return c == '\t';
  return c == ' ' || c == '\t';
}

static void trim(char *field) {
  size_t length = strlen(field), from = 0;
  while (length > 0 && isspace((unsigned char)field[length - 1])) field[--length] = '\0';
  while (isspace((unsigned char)field[from])) from++;
  memmove(field, field + from, length - from + 1);
  length = strlen(field);
  if (length >= 2 && field[0] == '"' && field[length - 1] == '"') {
    field[length - 1] = '\0';
    memmove(field, field + 1, length - 1);
  }
}

static void split(reader *r, const char *line, size_t length) {
  bool semicolon = memchr(line, ';', length) != NULL;
  bool tab = memchr(line, '\t', length) != NULL;
  bool comma = !semicolon && !tab && memchr(line, ',', length) != NULL;
  const bool names = r->column != NULL && tab; /* which may have blanks */
  r->decimal_comma = semicolon || tab;
  r->fields = 0;
  size_t i = 0;
  while (i <= length && r->fields < MAX_FIELDS) {
    while (!comma && !semicolon && i < length && parts(line[i], false, false, names)) i++;
    if (!comma && !semicolon && i == length) break;
    size_t used = 0;
    for (; i < length && !parts(line[i], comma, semicolon, names); i++)
      if (used + 1 < MAX_FIELD) r->field[r->fields][used++] = line[i];
    r->field[r->fields][used] = '\0';
    trim(r->field[r->fields++]);
    i++;
  }
}

static bool number(const reader *r, const char *field, double *value) {
  char text[MAX_FIELD];
  strcpy(text, field);
  char *comma = strchr(text, ',');
  if (r->decimal_comma && comma != NULL && strchr(text, '.') == NULL) *comma = '.';
  const char *end;
  return abbe_number_read(text, &end, value) && *end == '\0' && isfinite(*value);
}

/* ---- headers ---- */

static bool has(const char *field, const char *part) {
  char lower[MAX_FIELD];
  size_t i = 0;
  for (; field[i] != '\0'; i++) lower[i] = (char)tolower((unsigned char)field[i]);
  lower[i] = '\0';
  return strstr(lower, part) != NULL;
}

static bool begins(const char *field, const char *word) {
  size_t length = strlen(word);
  for (size_t i = 0; i < length; i++)
    if (tolower((unsigned char)field[i]) != word[i]) return false;
  return !isalpha((unsigned char)field[length]);
}

static role role_of(const char *field, size_t column) {
  if (has(field, "uncert") || has(field, "sigma") || has(field, "error") || has(field, "std") ||
      begins(field, "du") || begins(field, "dn") || begins(field, "u"))
    return UNCERTAINTY;
  if (has(field, "wavelength") || has(field, "lambda") || begins(field, "wl") ||
      has(field, "\xce\xbb") || begins(field, "nm") || begins(field, "um"))
    return WAVELENGTH;
  if (begins(field, "n") || has(field, "index")) return INDEX;
  if (begins(field, "k") || has(field, "kappa") || has(field, "extinction")) return EXTINCTION;
  return column == 0 ? WAVELENGTH : OTHER;
}

/* Angstrom are not offered: few have them, and "a" is in many words. */
static double unit_of(const char *field) {
  if (has(field, "nm") || has(field, "nanom")) return 1;
  if (has(field, "um") || has(field, "microm") || has(field, "\xc2\xb5m") ||
      has(field, "\xce\xbcm"))
    return 1000;
  return 0;
}

/* "wavelength (nm)" parted at its blank is one name. */
static void join_units(reader *r) {
  size_t kept = 1;
  for (size_t i = 1; i < r->fields; i++) {
    char *before = r->field[kept - 1], *here = r->field[i];
    if ((here[0] == '(' || here[0] == '[') && strlen(before) + strlen(here) < MAX_FIELD)
      strcat(before, here);
    else if (kept++ != i)
      strcpy(r->field[kept - 1], here);
  }
  r->fields = kept;
}

/* Among a light's two columns the first that is called so has the wavelengths: "S(lambda)" is
 * power. */
static role role_of_two(const reader *r, size_t column) {
  bool second = role_of(r->field[1], 1) == WAVELENGTH && role_of(r->field[0], 1) != WAVELENGTH;
  return column == (size_t)second ? WAVELENGTH : POWER;
}

static void find_column(reader *r) {
  bool waits = true, found = false;
  for (size_t i = 0; i < r->fields; i++) {
    const bool here = !found && strcasecmp(r->field[i], r->column) == 0;
    const bool wavelength = !here && waits && role_of(r->field[i], i) == WAVELENGTH;
    r->roles[i] = here ? POWER : wavelength ? WAVELENGTH : OTHER;
    found = found || here;
    waits = waits && !wavelength;
    if (wavelength && unit_of(r->field[i]) > 0) r->header_unit_nm = unit_of(r->field[i]);
  }
  if (found && !waits) r->role_count = r->fields;
}

static void take_header(reader *r) {
  join_units(r);
  if (r->column != NULL) {
    find_column(r);
    return;
  }
  if (r->light && r->fields != 2) return; /* a title */
  r->role_count = r->fields;
  for (size_t i = 0; i < r->fields; i++) {
    r->roles[i] = r->light ? role_of_two(r, i) : role_of(r->field[i], i);
    double unit_nm = r->roles[i] == WAVELENGTH ? unit_of(r->field[i]) : 0;
    if (unit_nm > 0) r->header_unit_nm = unit_nm;
  }
}

/* ---- points ---- */

static role role_at(const reader *r, size_t column) {
  if (r->role_count > 0) return column < r->role_count ? r->roles[column] : OTHER;
  if (column < 2) return column == 0 ? WAVELENGTH : r->light ? POWER : INDEX;
  if (column > 2) return OTHER;
  abbe_csv_third third = r->options != NULL ? r->options->third : ABBE_CSV_UNCERTAINTY;
  return third == ABBE_CSV_K ? EXTINCTION : third == ABBE_CSV_IGNORED ? OTHER : UNCERTAINTY;
}

static abbe_result pass_over(reader *r, abbe_result code, const char *why, const char *field) {
  if (r->light)
    return abbe_error_set(r->error, code, "%s:%zu: %s: '%.40s'", r->name, r->line, why, field);
  abbe_report_add(r->report, ABBE_NOTE_SKIPPED, r->line, NULL, "%s: '%.40s'", why, field);
  return ABBE_OK;
}

static abbe_result add(reader *r, abbe_points *to, double lambda_nm, double value, double error) {
  if (r->out->first_line == 0) r->out->first_line = r->line;
  abbe_point point = {.lambda_nm = lambda_nm, .value = value, .error = isnan(error) ? 0 : error};
  return abbe_points_add(to, point, r->error);
}

static abbe_result take_power(reader *r, const double found[OTHER]) {
  const abbe_points *before = &r->out->power;
  for (size_t i = 0; i < r->fields; i++) {
    role what = role_at(r, i);
    if (what == WAVELENGTH && !(found[WAVELENGTH] > 0))
      return pass_over(r, ABBE_SCHEMA, "a wavelength is above 0", r->field[i]);
    if (what == POWER && !(found[POWER] >= 0))
      return pass_over(r, ABBE_SCHEMA,
                       r->noun[0] == 'p' ? "a power is 0 or more" : "a reflectance is 0 or more",
                       r->field[i]);
    if (what == WAVELENGTH && before->count > 0 &&
        before->point[before->count - 1].lambda_nm == found[WAVELENGTH])
      return pass_over(r, ABBE_SCHEMA, "a wavelength stands here again", r->field[i]);
  }
  return add(r, &r->out->power, found[WAVELENGTH], found[POWER], 0);
}

static abbe_result take_index(reader *r, const double found[OTHER]) {
  const char *first = r->fields > 0 ? r->field[0] : "";
  bool n = !isnan(found[INDEX]), k = !isnan(found[EXTINCTION]);
  if (!(found[WAVELENGTH] > 0) || (!n && !k))
    return pass_over(r, ABBE_SCHEMA, "a line wants a wavelength above 0 and an index", first);
  if ((n && !(found[INDEX] >= 1e-3 && found[INDEX] <= 1e3)) ||
      (k && !(found[EXTINCTION] >= 0 && found[EXTINCTION] <= 1e3)) || found[UNCERTAINTY] < 0)
    return pass_over(r, ABBE_SCHEMA,
                     "n lies from 0.001 to 1000, k from 0 to 1000, an uncertainty is not negative",
                     first);
  ABBE_TRY(n ? add(r, &r->out->n, found[WAVELENGTH], found[INDEX], found[UNCERTAINTY]) : ABBE_OK);
  if (k) ABBE_TRY(add(r, &r->out->k, found[WAVELENGTH], found[EXTINCTION], 0));
  return ABBE_OK;
}

static abbe_result take_point(reader *r) {
  double found[OTHER] = {NAN, NAN, NAN, NAN, NAN};
  if (r->column != NULL && r->role_count == 0)
    return abbe_error_set(r->error, ABBE_SCHEMA,
                          "%s:%zu: numbers begin, and no header before them names a wavelength and "
                          "the column '%.60s'",
                          r->name, r->line, r->column);
  for (size_t i = 0; i < r->fields; i++) {
    role what = role_at(r, i);
    if (what == OTHER || r->field[i][0] == '\0' || !isnan(found[what])) continue;
    if (!number(r, r->field[i], &found[what]))
      return pass_over(r, ABBE_PARSE, "this is not a number", r->field[i]);
  }
  if (r->light && r->column == NULL && r->fields != 2)
    return pass_over(r, ABBE_PARSE,
                     r->noun[0] == 'p' ? "a line wants two numbers, a wavelength and a power"
                                       : "a line wants two numbers, a wavelength and a reflectance "
                                         "(of more columns, name one)",
                     r->fields > 0 ? r->field[0] : "");
  return r->light ? take_power(r, found) : take_index(r, found);
}

/* A line whose first field begins no number, before which no header stood or behind which another
 * block begins. */
static bool is_header(const reader *r) {
  double value;
  const char *end;
  if (r->fields == 0 || abbe_number_read(r->field[0], &end, &value)) return false;
  for (size_t i = 0; i < r->fields; i++)
    if (r->field[i][0] != '\0' && !abbe_number_read(r->field[i], &end, &value) &&
        role_of(r->field[i], i) != OTHER)
      return true;
  return false;
}

static abbe_result take_line(reader *r, const char *line, size_t length) {
  const char *remark = memchr(line, '#', length);
  if (remark != NULL) length = (size_t)(remark - line);
  while (length > 0 && isspace((unsigned char)line[length - 1])) length--;
  while (length > 0 && isspace((unsigned char)*line)) line++, length--;
  if (length == 0 || *line == '%') return ABBE_OK;
  split(r, line, length);
  if (!is_header(r) || (r->light && r->out->power.count > 0)) return take_point(r);
  take_header(r);
  return ABBE_OK;
}

/* ---- units and order ---- */

static abbe_result find_unit(reader *r, double *unit_nm) {
  const abbe_points *lists[] = {&r->out->n, &r->out->k, &r->out->power};
  double low = INFINITY, high = 0;
  for (int l = 0; l < 3; l++)
    for (size_t i = 0; i < lists[l]->count; i++) {
      low = fmin(low, lists[l]->point[i].lambda_nm);
      high = fmax(high, lists[l]->point[i].lambda_nm);
    }
  *unit_nm = r->options != NULL && r->options->unit_nm > 0 ? r->options->unit_nm
             : r->header_unit_nm > 0                       ? r->header_unit_nm
             : low > 100                                   ? 1
             : high < 50                                   ? 1000
                                                           : 0;
  if (*unit_nm > 0) return ABBE_OK;
  return abbe_error_set(r->error, ABBE_PARSE,
                        "%s:%zu: wavelengths from %g to %g are in no unit that can be told; name "
                        "the column wavelength_nm or wavelength_um",
                        r->name, r->out->first_line, low, high);
}

/* Points that cannot be kept. */
static abbe_result lose(reader *r, size_t count, const char *what, const char *where) {
  const char *plural = count == 1 ? "" : "s";
  if (count == 0) return ABBE_OK;
  if (r->light)
    return abbe_error_set(r->error, ABBE_SCHEMA, "%s: %zu point%s of %s %s", r->name, count, plural,
                          what, where);
  abbe_report_add(r->report, ABBE_NOTE_LOST, 0, NULL, "%zu point%s of %s %s", count, plural, what,
                  where);
  return ABBE_OK;
}

static abbe_result order(reader *r, abbe_points *list, double unit_nm, const char *what) {
  for (size_t i = 0; i < list->count && unit_nm != 1; i++)
    list->point[i].lambda_nm = abbe_number_tidy(list->point[i].lambda_nm * unit_nm);
  bool repeats = r->options != NULL && r->options->repeats;
  size_t kept = 0, dropped = 0;
  for (size_t i = 0; i < list->count; i++) {
    double lambda_nm = list->point[i].lambda_nm;
    if (lambda_nm >= ABBE_SPECTRUM_LOW_NM && lambda_nm <= ABBE_SPECTRUM_HIGH_NM)
      list->point[kept++] = list->point[i];
  }
  char range[64];
  abbe_number_format(range, sizeof range, "outside %g to %g nm", ABBE_SPECTRUM_LOW_NM,
                     ABBE_SPECTRUM_HIGH_NM);
  ABBE_TRY(lose(r, list->count - kept, what, range));
  list->count = kept;
  ABBE_TRY(abbe_points_sort(list, repeats ? NULL : &dropped, r->error));
  return lose(r, dropped, what, "at a wavelength that was there before");
}

static size_t count_of(const abbe_csv_points *points) {
  return points->n.count + points->k.count + points->power.count;
}

static abbe_result finish(reader *r) {
  double unit_nm = 0;
  if (count_of(r->out) == 0)
    return abbe_error_set(r->error, ABBE_SCHEMA, "%s: holds no points; a line wants %s", r->name,
                          r->light && r->noun[0] == 'r'
                              ? "a wavelength and a reflectance, such as 380, 0.18"
                          : r->light ? "a wavelength and a power, such as 380, 49.98"
                                     : "a wavelength and an index, such as 587.6, 1.5168");
  ABBE_TRY(find_unit(r, &unit_nm));
  ABBE_TRY(order(r, &r->out->n, unit_nm, "n"));
  ABBE_TRY(order(r, &r->out->k, unit_nm, "k"));
  ABBE_TRY(order(r, &r->out->power, unit_nm, r->noun));
  if (count_of(r->out) == 0)
    ABBE_TRY(abbe_error_set(r->error, ABBE_SCHEMA, "%s: no point lies from %g to %g nm", r->name,
                            ABBE_SPECTRUM_LOW_NM, ABBE_SPECTRUM_HIGH_NM));
  return ABBE_OK;
}

abbe_result abbe_csv_points_parse(const char *text, size_t size, const char *name,
                                  const abbe_csv_options *options, abbe_csv_points *out,
                                  abbe_report *report, abbe_error *error) {
  *out = (abbe_csv_points){0};
  char *clean = NULL;
  size_t length = 0;
  abbe_result result = abbe_encoding_decode(text, size, &clean, &length, error);
  if (result != ABBE_OK) return result;
  reader r = {.name = name, .options = options, .out = out, .report = report, .error = error};
  r.light = options != NULL && options->quantity != ABBE_CSV_INDEX;
  r.column = r.light ? options->column : NULL;
  r.noun = r.light && options->quantity == ABBE_CSV_REFLECTANCE ? "reflectance" : "power";
  for (size_t at = 0; at < length && result == ABBE_OK;) {
    const char *end = memchr(clean + at, '\n', length - at);
    size_t count = end == NULL ? length - at : (size_t)(end - (clean + at));
    r.line++;
    result = take_line(&r, clean + at, count);
    at += count + 1;
  }
  free(clean);
  if (result == ABBE_OK) result = finish(&r);
  if (result != ABBE_OK) abbe_csv_points_free(out);
  return result;
}

abbe_result abbe_csv_points_load(const char *path, const abbe_csv_options *options,
                                 abbe_csv_points *out, abbe_report *report, abbe_error *error) {
  *out = (abbe_csv_points){0};
  ABBE_FREED char *text = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_file_read_text(path, MAX_BYTES, &text, &size, error));
  return abbe_csv_points_parse(text, size, path, options, out, report, error);
}
