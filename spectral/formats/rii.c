#include "spectral/formats/material_import.h"

#include "base/foreign_text.h"
#include "base/number.h"
#include "base/yaml/yaml.h"
#include "spectral/dispersion/points.h"
#include "spectral/materials/absorption.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 16 << 20, MAX_TEXT = 2000, HERZBERGER_TERMS = 6 };

static const double ZERO_CELSIUS_K = 273.15, HIGH_EXPANSION_K = 450;

typedef struct reader {
  abbe_yaml *yaml;
  abbe_material *m;
  abbe_report *report;
  abbe_error *error;
  bool index; /* one has been read */
  bool nonlinear;
  abbe_points n, k;
} reader;

static void note(reader *r, abbe_note_kind kind, abbe_yaml_node where, const char *sentence) {
  abbe_report_add(r->report, kind, abbe_yaml_line(r->yaml, where), r->m->name, "%s", sentence);
}

/* ---- numbers in text ---- */

/* Up to max numbers of a text or a list; how many there are, or -1 where something is none. */
static int numbers_of(const char *text, double *out, int max) {
  int count = 0;
  for (const char *c = text;;) {
    while (isspace((unsigned char)*c) || *c == ',' || *c == '[' || *c == ']') c++;
    if (*c == '\0') return count;
    const char *end = c;
    double value;
    if (!abbe_number_read(c, &end, &value) || !isfinite(value)) return -1;
    if (*end != '\0' && strchr(" \t\n,]", *end) == NULL) return -1;
    if (count == max) return -1;
    out[count++] = value;
    c = end;
  }
}

static int numbers_at(reader *r, abbe_yaml_node node, double *out, int max) {
  const char *text = abbe_yaml_text(r->yaml, node);
  if (text != NULL) return numbers_of(text, out, max);
  if (!abbe_yaml_is_sequence(r->yaml, node)) return -1;
  size_t count = abbe_yaml_count(r->yaml, node);
  if (count > (size_t)max) return -1;
  for (size_t i = 0; i < count; i++) {
    const char *item = abbe_yaml_text(r->yaml, abbe_yaml_item(r->yaml, node, i));
    if (item == NULL || numbers_of(item, &out[i], 1) != 1) return -1;
  }
  return (int)count;
}

static bool number_at(reader *r, abbe_yaml_node mapping, const char *key, double *out) {
  double value;
  const bool there = numbers_at(r, abbe_yaml_get(r->yaml, mapping, key), &value, 1) == 1;
  if (there) *out = value;
  return there;
}

/* ---- formulas ---- */

static const abbe_dispersion_model formulas[] = {
    ABBE_DISPERSION_SELLMEIER,  ABBE_DISPERSION_SELLMEIER2, ABBE_DISPERSION_POLYNOMIAL,
    ABBE_DISPERSION_RII4,       ABBE_DISPERSION_POWERS,     ABBE_DISPERSION_RII6,
    ABBE_DISPERSION_HERZBERGER, ABBE_DISPERSION_RII8,       ABBE_DISPERSION_RII9,
};

/* Powers -2, -4, … are Cauchy's form; no powers at all, a constant. */
static void simplify_powers(abbe_dispersion *d) {
  for (size_t k = 1; k + 1 < d->count; k += 2)
    if (d->c[k + 1] != -(double)(k + 1)) return;
  size_t terms = (d->count + 1) / 2;
  abbe_dispersion simple = {.model = terms == 1 ? ABBE_DISPERSION_CONSTANT : ABBE_DISPERSION_CAUCHY,
                            .count = terms,
                            .c = {d->c[0]}};
  for (size_t k = 1; k < terms; k++) simple.c[k] = d->c[2 * k - 1];
  *d = simple;
}

static abbe_result read_wavelengths(reader *r, abbe_yaml_node entry) {
  double range[2];
  abbe_yaml_node node = abbe_yaml_get(r->yaml, entry, "wavelength_range");
  if (node.id == 0) node = abbe_yaml_get(r->yaml, entry, "range"); /* before 2018 */
  if (node.id == 0 || numbers_at(r, node, range, 2) != 2 || !(range[0] > 0) ||
      !(range[1] > range[0]))
    return abbe_yaml_fail(r->yaml, node.id != 0 ? node : entry, r->error,
                          "a formula wants its 'wavelength_range', two ascending wavelengths in um "
                          "such as 0.3 2.5");
  double low = abbe_number_tidy(range[0] * 1000), high = abbe_number_tidy(range[1] * 1000);
  r->m->min_nm = fmax(low, ABBE_SPECTRUM_LOW_NM);
  r->m->max_nm = fmin(high, ABBE_SPECTRUM_HIGH_NM);
  if (r->m->min_nm != low || r->m->max_nm != high)
    note(r, ABBE_NOTE_LOST, node, "its range is cut to 1 nm to 1 mm");
  return ABBE_OK;
}

static abbe_result read_formula(reader *r, abbe_yaml_node entry, int number) {
  abbe_dispersion *d = &r->m->dispersion;
  abbe_yaml_node node = abbe_yaml_get(r->yaml, entry, "coefficients");
  double c[ABBE_DISPERSION_MAX_COEFFICIENTS] = {0};
  int count = numbers_at(r, node, c, ABBE_DISPERSION_MAX_COEFFICIENTS);
  if (count < 1)
    return abbe_yaml_fail(r->yaml, node.id != 0 ? node : entry, r->error,
                          "a formula wants its 'coefficients', 1 to %d numbers",
                          ABBE_DISPERSION_MAX_COEFFICIENTS);
  *d = (abbe_dispersion){.model = formulas[number - 1], .count = (size_t)count};
  memcpy(d->c, c, sizeof c);
  /* each of its coefficients is a whole term; elsewhere what lacks would cut a term in two */
  if (d->model == ABBE_DISPERSION_HERZBERGER && d->count < HERZBERGER_TERMS)
    d->count = HERZBERGER_TERMS;
  abbe_error why;
  if (abbe_dispersion_check(d, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, node, r->error, "formula %d: %s", number, why.text);
  if (number == 5) simplify_powers(d);
  r->index = true;
  return read_wavelengths(r, entry);
}

/* ---- tables ---- */

/* A table's lines: how many numbers each has, and which are taken. */
typedef struct columns {
  bool n, k;
  int numbers;
} columns;

static abbe_result take_row(reader *r, columns which, const double *row, size_t *odd) {
  double lambda_nm = abbe_number_tidy(row[0] * 1000), n = row[1], k = row[which.n ? 2 : 1];
  bool inside = lambda_nm >= ABBE_SPECTRUM_LOW_NM && lambda_nm <= ABBE_SPECTRUM_HIGH_NM;
  bool n_good = !which.n || (n >= 1e-3 && n <= 1e3), k_good = !which.k || (k >= 0 && k <= 1e3);
  if (!inside || !n_good || !k_good) ++*odd;
  if (which.n && inside && n_good)
    ABBE_TRY(abbe_points_add(&r->n, (abbe_point){.lambda_nm = lambda_nm, .value = n}, r->error));
  if (which.k && inside && k_good)
    ABBE_TRY(abbe_points_add(&r->k, (abbe_point){.lambda_nm = lambda_nm, .value = k}, r->error));
  return ABBE_OK;
}

static abbe_result read_table(reader *r, abbe_yaml_node entry, columns which) {
  abbe_yaml_node node = abbe_yaml_get(r->yaml, entry, "data");
  const char *text = abbe_yaml_text(r->yaml, node);
  const int wanted = which.numbers;
  if (text == NULL)
    return abbe_yaml_fail(r->yaml, node.id != 0 ? node : entry, r->error,
                          "a table wants its 'data', %d numbers a line", wanted);
  size_t odd = 0, dropped = 0;
  abbe_points *list = which.n ? &r->n : &r->k;
  abbe_result result = ABBE_OK;
  while (*text != '\0' && result == ABBE_OK) {
    char line[256];
    size_t length = strcspn(text, "\n"), cut = length < sizeof line - 1 ? length : sizeof line - 1;
    memcpy(line, text, cut);
    line[cut] = '\0';
    text += length + (text[length] == '\n');
    double row[3];
    int found = numbers_of(line, row, 3);
    if (found == 0 || line[strspn(line, " \t")] == '#') continue;
    if (found == wanted)
      result = take_row(r, which, row, &odd);
    else
      odd++;
  }
  if (odd > 0)
    abbe_report_add(r->report, ABBE_NOTE_LOST, abbe_yaml_line(r->yaml, node), r->m->name,
                    "%zu lines of its table are not %d numbers, or outside 1 nm to 1 mm, n 0.001 "
                    "to 1000, k 0 to 1000",
                    odd, wanted);
  if (result == ABBE_OK) result = abbe_points_sort(&r->n, &dropped, r->error);
  if (result == ABBE_OK && which.n && which.k) result = abbe_points_sort(&r->k, &odd, r->error);
  if (result == ABBE_OK && !which.n) result = abbe_points_sort(&r->k, &dropped, r->error);
  if (dropped > 0)
    abbe_report_add(r->report, ABBE_NOTE_LOST, abbe_yaml_line(r->yaml, node), r->m->name,
                    "%zu lines of its table stand at a wavelength that was there before", dropped);
  if (result == ABBE_OK && list->count == 0)
    return abbe_yaml_fail(r->yaml, node, r->error, "the table holds no usable line of %d numbers",
                          wanted);
  return result;
}

static abbe_result read_tabulated_n(reader *r, abbe_yaml_node entry, columns which) {
  abbe_material *m = r->m;
  ABBE_TRY(read_table(r, entry, which));
  m->dispersion = (abbe_dispersion){.model = ABBE_DISPERSION_TABULATED};
  abbe_result result =
      abbe_points_spectrum(&r->n, ABBE_INTERPOLATION_MONOTONE, &m->dispersion.table, r->error);
  m->min_nm = r->n.point[0].lambda_nm;
  m->max_nm = r->n.point[r->n.count - 1].lambda_nm;
  r->index = result == ABBE_OK;
  return result;
}

/* ---- the list of data ---- */

/* N of "formula N", whatever N is; -1 where the type is another. */
static int formula_number(const char *type) {
  if (strncmp(type, "formula ", 8) != 0) return -1;
  const char *c = type + 8 + strspn(type + 8, " ");
  size_t digits = strspn(c, "0123456789");
  bool ends = c[digits + strspn(c + digits, " ")] == '\0';
  if (digits == 0 || !ends) return -1;
  return digits > 4 ? 9999 : (int)strtol(c, NULL, 10);
}

static abbe_result read_entry(reader *r, abbe_yaml_node entry) {
  const char *type = NULL;
  if (abbe_yaml_is_mapping(r->yaml, entry))
    type = abbe_yaml_text(r->yaml, abbe_yaml_get(r->yaml, entry, "type"));
  if (type == NULL)
    return abbe_yaml_fail(r->yaml, entry, r->error, "an entry of 'DATA' wants a 'type'");
  int number = formula_number(type);
  char kind[8] = "";
  bool formula = number >= 0, table = sscanf(type, "tabulated %7s", kind) == 1;
  bool n = table && kind[0] == 'n' && strcmp(kind, "n2") != 0, nk = n && strcmp(kind, "nk") == 0;
  bool k = table && strcmp(kind, "k") == 0;
  r->nonlinear = r->nonlinear || (table && strcmp(kind, "n2") == 0);
  if (formula && (number < 1 || number > 9))
    return abbe_yaml_fail(r->yaml, entry, r->error,
                          "there is no formula %d for an index; they are 1 to 9", number);
  if ((formula || n) && r->index) {
    note(r, ABBE_NOTE_LOST, entry, "a second index of the same file is not read");
    return ABBE_OK;
  }
  if (formula) return read_formula(r, entry, number);
  if (n) return read_tabulated_n(r, entry, (columns){true, nk && r->k.count == 0, 2 + nk});
  if (k && r->k.count == 0) return read_table(r, entry, (columns){false, true, 2});
  abbe_report_add(r->report, ABBE_NOTE_LOST, abbe_yaml_line(r->yaml, entry), r->m->name,
                  "data of type '%.40s' are not read", type);
  return ABBE_OK;
}

static abbe_result read_data(reader *r, abbe_yaml_node root) {
  abbe_yaml_node list = {0};
  if (abbe_yaml_is_mapping(r->yaml, root)) list = abbe_yaml_get(r->yaml, root, "DATA");
  if (!abbe_yaml_is_sequence(r->yaml, list))
    return abbe_yaml_fail(r->yaml, root, r->error,
                          "has no list 'DATA', so it is no file of refractiveindex.info");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < abbe_yaml_count(r->yaml, list) && result == ABBE_OK; i++)
    result = read_entry(r, abbe_yaml_item(r->yaml, list, i));
  if (result == ABBE_OK && !r->index)
    return abbe_yaml_fail(r->yaml, list, r->error, "holds no index, only %s",
                          r->k.count > 0 ? "k; a material needs n as well"
                          : r->nonlinear ? "a nonlinear one"
                                         : "other data");
  bool absorbs = false;
  for (size_t i = 0; i < r->k.count; i++) absorbs = absorbs || r->k.point[i].value > 0;
  return result != ABBE_OK || !absorbs
             ? result
             : abbe_absorption_spectrum_of_k(&r->k, &r->m->attenuation, r->error);
}

/* After the properties, of which a conductor keeps less. */
static abbe_result take_metal(reader *r, abbe_yaml_node root) {
  bool made = false;
  abbe_result result = abbe_conductor_of_metal(&r->n, &r->k, r->m, &made, r->error);
  if (made)
    note(r, ABBE_NOTE_CHANGED, root,
         "k is above 0.08 in most of the visible: it is taken as a conductor, for mirrors");
  return result;
}

/* ---- texts and properties ---- */

static abbe_result read_text(reader *r, abbe_yaml_node root, const char *key, char **out) {
  const char *html = abbe_yaml_text(r->yaml, abbe_yaml_get(r->yaml, root, key));
  if (html == NULL) return ABBE_OK;
  char *text = abbe_html_text(html, MAX_TEXT);
  if (text == NULL) return abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for a text");
  if (strchr(html, '<') != NULL && strchr(text, '<') == NULL)
    note(r, ABBE_NOTE_CHANGED, abbe_yaml_get(r->yaml, root, key), "references lose their HTML");
  if (text[0] != '\0')
    *out = text;
  else
    free(text);
  return ABBE_OK;
}

static bool is_true(reader *r, abbe_yaml_node mapping, const char *key) {
  const char *text = abbe_yaml_text(r->yaml, abbe_yaml_get(r->yaml, mapping, key));
  return text != NULL && (strcmp(text, "true") == 0 || strcmp(text, "True") == 0);
}

/* Makers' 20, 23 and 25 C stand as whole kelvin, and dn/dT counts from theirs. */
static double zero_k(double kelvin) {
  return kelvin == 293 || kelvin == 296 || kelvin == 298 ? 273 : ZERO_CELSIUS_K;
}

static abbe_result read_conditions(reader *r, abbe_yaml_node root) {
  static const char *const keys[] = {"CONDITIONS", "SPECS"};
  bool absolute = false, vacuum = false;
  for (int i = 0; i < 2; i++) {
    abbe_yaml_node node = abbe_yaml_get(r->yaml, root, keys[i]);
    if (!abbe_yaml_is_mapping(r->yaml, node)) continue;
    double kelvin;
    if (number_at(r, node, "temperature", &kelvin) && kelvin >= 0 && kelvin <= 1e4)
      r->m->temperature_c = abbe_number_tidy(kelvin - zero_k(kelvin));
    absolute |= is_true(r, node, "n_absolute") || is_true(r, node, "n_is_absolute");
    vacuum |= is_true(r, node, "wavelength_vacuum") || is_true(r, node, "wavelength_is_vacuum");
  }
  r->m->n_absolute = absolute;
  if (!absolute && !vacuum) return ABBE_OK;
  char text[240];
  snprintf(text, sizeof text, "%s%s%s",
           absolute ? "The index is relative to vacuum, not to air, "
                      "where it is lower by 0.03 %. "
                    : "",
           vacuum ? "Wavelengths are those in vacuum, longer than in air by 0.03 %. " : "",
           "Taken as they stand.");
  note(r, ABBE_NOTE_CHANGED, root, text);
  r->m->warning = strdup(text);
  return r->m->warning != NULL ? ABBE_OK
                               : abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for a text");
}

/* The first number of a list of mappings that have `value`, or of a mapping. */
static double value_of(reader *r, abbe_yaml_node node, size_t item) {
  double value = 0;
  if (abbe_yaml_is_sequence(r->yaml, node))
    node = item < abbe_yaml_count(r->yaml, node) ? abbe_yaml_item(r->yaml, node, item)
                                                 : (abbe_yaml_node){0};
  else if (item > 0)
    return 0;
  if (abbe_yaml_is_mapping(r->yaml, node)) number_at(r, node, "value", &value);
  return value;
}

static void read_ratings(reader *r, abbe_yaml_node node) {
  static const char *const keys[] = {"climatic", "stain", "acid", "alkali", "phosphate"};
  abbe_material_catalogue *c = &r->m->catalogue;
  if (!abbe_yaml_is_mapping(r->yaml, node)) return;
  c->ratings[0] = -1; /* the cost is not there */
  for (size_t i = 0; i < 5; i++) {
    c->ratings[i + 1] = -1;
    if (number_at(r, node, keys[i], &c->ratings[i + 1]) && c->ratings[i + 1] >= 0)
      c->rating_count = 6;
  }
}

/* In the order of the file; a lone one of high temperatures is the second. */
static void read_expansion(reader *r, abbe_yaml_node node, size_t item) {
  abbe_material_catalogue *c = &r->m->catalogue;
  const double value = value_of(r, node, item);
  const bool list = abbe_yaml_is_sequence(r->yaml, node);
  const bool lone = !list || abbe_yaml_count(r->yaml, node) == 1;
  double kelvin[2] = {0};
  if (value == 0) return;
  if (list) node = abbe_yaml_item(r->yaml, node, item);
  const bool ranged =
      numbers_at(r, abbe_yaml_get(r->yaml, node, "temperature_range"), kelvin, 2) == 2 &&
      kelvin[0] >= 0 && kelvin[0] < kelvin[1];
  const size_t at = lone && ranged && kelvin[1] > HIGH_EXPANSION_K ? 1 : item;
  c->expansion_per_k[at] = value;
  const double *usual = abbe_material_expansion_range_k + 2 * at;
  if (ranged && (kelvin[0] != usual[0] || kelvin[1] != usual[1]))
    memcpy(c->expansion_range_k + 2 * at, kelvin, sizeof kelvin);
}

static void read_thermal(reader *r, abbe_yaml_node list) {
  abbe_material_catalogue *c = &r->m->catalogue;
  if (!abbe_yaml_is_sequence(r->yaml, list) || abbe_yaml_count(r->yaml, list) == 0) return;
  abbe_yaml_node entry = abbe_yaml_item(r->yaml, list, 0);
  if (!abbe_yaml_is_mapping(r->yaml, entry)) return;
  const char *type = abbe_yaml_text(r->yaml, abbe_yaml_get(r->yaml, entry, "type"));
  double thermal[6];
  if (type == NULL || strcmp(type, "formula A") != 0) return;
  if (numbers_at(r, abbe_yaml_get(r->yaml, entry, "coefficients"), thermal, 6) == 6)
    memcpy(c->thermal, thermal, sizeof thermal);
}

static abbe_result keep(reader *r, abbe_yaml_node mapping, const char *key, char **out) {
  const char *text = abbe_yaml_text(r->yaml, abbe_yaml_get(r->yaml, mapping, key));
  if (text == NULL || text[0] == '\0' || strlen(text) > 40) return ABBE_OK;
  *out = strdup(text);
  return *out != NULL ? ABBE_OK : abbe_error_set(r->error, ABBE_NO_MEMORY, "no memory for a text");
}

static abbe_result read_properties(reader *r, abbe_yaml_node root) {
  abbe_material_catalogue *c = &r->m->catalogue;
  abbe_yaml_node node = abbe_yaml_get(r->yaml, root, "PROPERTIES");
  if (!abbe_yaml_is_mapping(r->yaml, node)) node = abbe_yaml_get(r->yaml, root, "SPECS");
  if (!abbe_yaml_is_mapping(r->yaml, node)) return ABBE_OK;
  double n_d = 0, v_d = 0;
  if (number_at(r, node, "nd", &n_d) && n_d >= 1e-3 && n_d < 1e3) r->m->published_n_d = n_d;
  if (number_at(r, node, "Vd", &v_d) && fabs(v_d) < 1e6) r->m->published_v_d = v_d;
  number_at(r, node, "dPgF", &c->dpgf);
  double density = value_of(r, abbe_yaml_get(r->yaml, node, "density"), 0);
  c->density_g_cm3 = abbe_number_tidy(fmax(density, 0) / 1000);
  for (size_t i = 0; i < 2; i++)
    read_expansion(r, abbe_yaml_get(r->yaml, node, "thermal_expansion"), i);
  read_thermal(r, abbe_yaml_get(r->yaml, node, "thermal_dispersion"));
  read_ratings(r, abbe_yaml_get(r->yaml, node, "resistance"));
  if (abbe_material_catalogue_bound(c) > 0)
    note(r, ABBE_NOTE_LOST, node, "properties that are too large to be true are left out");
  ABBE_TRY(keep(r, node, "glass_code", &c->code));
  return keep(r, node, "glass_status", &c->status);
}

/* ---- names and whole files ---- */

/* The parts of a path from its end: [0] the file without its ending, [1] its folder, … */
static size_t part(const char *path, size_t from_end, char *out, size_t size) {
  size_t end = strlen(path);
  for (size_t i = 0;; i++) {
    size_t start = end;
    while (start > 0 && path[start - 1] != '/') start--;
    if (i == from_end) {
      size_t length = end - start;
      if (i == 0) {
        const char *dot = memchr(path + start, '.', length);
        for (const char *next = dot; next != NULL;
             next = memchr(next + 1, '.', (size_t)(path + end - next - 1)))
          dot = next;
        if (dot != NULL && dot > path + start) length = (size_t)(dot - (path + start));
      }
      snprintf(out, size, "%.*s", (int)(length < size ? length : size - 1), path + start);
      return length;
    }
    if (start == 0) break;
    end = start - 1;
  }
  out[0] = '\0';
  return 0;
}

static char *name_of(const char *path) {
  char file[256], folder[256], book[256], name[520];
  part(path, 0, file, sizeof file);
  part(path, 1, folder, sizeof folder);
  part(path, 2, book, sizeof book);
  bool page = strcmp(folder, "nk") == 0 && book[0] != '\0';
  snprintf(name, sizeof name, page ? "%s-%s" : "%.0s%s", book, file);
  return strdup(strlen(name) <= ABBE_MATERIAL_MAX_NAME ? name : file);
}

static abbe_result read_file(reader *r, const char *path, const char *name) {
  abbe_yaml_node root = abbe_yaml_root(r->yaml);
  r->m->name = name != NULL ? strdup(name) : name_of(path);
  if (r->m->name == NULL) return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", path);
  ABBE_TRY(read_data(r, root));
  ABBE_TRY(read_text(r, root, "REFERENCES", &r->m->source));
  ABBE_TRY(read_text(r, root, "COMMENTS", &r->m->comment));
  ABBE_TRY(read_conditions(r, root));
  ABBE_TRY(read_properties(r, root));
  ABBE_TRY(take_metal(r, root));
  if (r->m->source == NULL) {
    char text[300];
    snprintf(text, sizeof text, "a file of refractiveindex.info without references, %.200s", path);
    r->m->source = strdup(text);
    if (r->m->source == NULL)
      return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", path);
    note(r, ABBE_NOTE_ASSUMED, root, "it names no references; the file itself is the source");
  }
  abbe_error why;
  if (abbe_material_check(r->m, &why) != ABBE_OK)
    return abbe_yaml_fail(r->yaml, root, r->error, "%s", why.text);
  return ABBE_OK;
}

abbe_result abbe_rii_parse(const char *text, size_t size, const char *path, const char *name,
                           abbe_material *out, abbe_report *report, abbe_error *error) {
  *out = (abbe_material){.temperature_c = NAN, .line = 1};
  char *clean = NULL;
  size_t length = 0;
  reader r = {.m = out, .report = report, .error = error};
  abbe_result result = abbe_encoding_decode(text, size, &clean, &length, error);
  if (result == ABBE_OK) result = abbe_yaml_parse(clean, length, path, &r.yaml, error);
  free(clean);
  if (result == ABBE_OK) result = read_file(&r, path, name);
  abbe_points_free(&r.n);
  abbe_points_free(&r.k);
  abbe_yaml_free(r.yaml);
  if (result != ABBE_OK) abbe_material_free(out);
  return result;
}
