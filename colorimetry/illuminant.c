#include "colorimetry/illuminant.h"

#include "base/number.h"
#include "base/text.h"
#include "colorimetry/colour_temperature.h"
#include "colorimetry/illuminant_tables.h"
#include "colorimetry/observer.h"
#include "spectral/dispersion/csv_points.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { TABLE_COUNT = 107 };
static const double table_min_nm = 300, table_step_nm = 5;

/* Relative power from 300 to 830 nm in steps of 5 nm, linear between [CIE15, table T.1]. */
static const double d65[TABLE_COUNT] = {
    0.0341,  1.6643,  3.2945,  11.7652, 20.236,  28.6447, 37.0535, 38.5011, 39.9488, 42.4302,
    44.9117, 45.775,  46.6383, 49.3637, 52.0891, 51.0323, 49.9755, 52.3118, 54.6482, 68.7015,
    82.7549, 87.1204, 91.486,  92.4589, 93.4318, 90.057,  86.6823, 95.7736, 104.865, 110.936,
    117.008, 117.41,  117.812, 116.336, 114.861, 115.392, 115.923, 112.367, 108.811, 109.082,
    109.354, 108.578, 107.802, 106.296, 104.79,  106.239, 107.689, 106.047, 104.405, 104.225,
    104.046, 102.023, 100,     98.1671, 96.3342, 96.0611, 95.788,  92.2368, 88.6856, 89.3459,
    90.0062, 89.8026, 89.5991, 88.6489, 87.6987, 85.4936, 83.2886, 83.4939, 83.6992, 81.863,
    80.0268, 80.1207, 80.2146, 81.2462, 82.2778, 80.281,  78.2842, 74.0027, 69.7213, 70.6652,
    71.6091, 72.979,  74.349,  67.9765, 61.604,  65.7448, 69.8856, 72.4863, 75.087,  69.3398,
    63.5927, 55.0054, 46.4182, 56.6118, 66.8054, 65.0941, 63.3828, 63.8434, 64.304,  61.8779,
    59.4519, 55.7054, 51.959,  54.6998, 57.4406, 58.8765, 60.3125};

static const double d50[TABLE_COUNT] = {
    0.02,   1.03,   2.05,   4.91,   7.78,   11.26, 14.75, 16.35, 17.95, 19.48, 21.01,  22.48,
    23.94,  25.45,  26.96,  25.72,  24.49,  27.18, 29.87, 39.59, 49.31, 52.91, 56.51,  58.27,
    60.03,  58.93,  57.82,  66.32,  74.82,  81.04, 87.25, 88.93, 90.61, 90.99, 91.37,  93.24,
    95.11,  93.54,  91.96,  93.84,  95.72,  96.17, 96.61, 96.87, 97.13, 99.61, 102.10, 101.43,
    100.75, 101.54, 102.32, 101.16, 100.00, 98.87, 97.74, 98.33, 98.92, 96.21, 93.50,  95.59,
    97.69,  98.48,  99.27,  99.16,  99.04,  97.38, 95.72, 97.29, 98.86, 97.26, 95.67,  96.93,
    98.19,  100.60, 103.00, 101.07, 99.13,  93.26, 87.38, 89.49, 91.60, 92.25, 92.89,  84.87,
    76.85,  81.68,  86.51,  89.55,  92.58,  85.40, 78.23, 67.96, 57.69, 70.31, 82.92,  80.60,
    78.27,  78.91,  79.55,  76.48,  73.40,  68.66, 63.92, 67.35, 70.78, 72.61, 74.44};

static const char *const names[] = {
#define NAME(name) #name,
    ABBE_ILLUMINANT_KINDS(NAME)
#undef NAME
};

static double table_at(const double table[TABLE_COUNT], double lambda_nm) {
  double position = (lambda_nm - table_min_nm) / table_step_nm;
  if (!(position >= 0 && position <= TABLE_COUNT - 1)) return 0;
  int i = (int)position;
  if (i > TABLE_COUNT - 2) i = TABLE_COUNT - 2;
  double t = position - i;
  return (1 - t) * table[i] + t * table[i + 1];
}

/* The CIE's formula: a Planckian radiator at 2848 K with the c2 of 1931, 1.435e7 nm K [CIE15]. */
static double power_a(double lambda_nm) {
  const double c2_over_t = 1.435e7 / 2848;
  double ratio = 560 / lambda_nm;
  return 100 * pow(ratio, 5) * expm1(c2_over_t / 560) / expm1(c2_over_t / lambda_nm);
}

static double tabulated_at(const abbe_spectrum *spectrum, double lambda_nm) {
  const double *nm = abbe_spectrum_lambda_nm(spectrum);
  bool inside = lambda_nm >= nm[0] && lambda_nm <= nm[abbe_spectrum_count(spectrum) - 1];
  return inside ? abbe_spectrum_at(spectrum, lambda_nm) : 0;
}

double abbe_illuminant_power(const abbe_illuminant *illuminant, double lambda_nm) {
  if (!(lambda_nm > 0)) return 0;
  switch (illuminant->kind) {
  case ABBE_ILLUMINANT_D65:
    return table_at(d65, lambda_nm);
  case ABBE_ILLUMINANT_D50:
    return table_at(d50, lambda_nm);
  case ABBE_ILLUMINANT_A:
    return power_a(lambda_nm);
  case ABBE_ILLUMINANT_E:
    return 100;
  case ABBE_ILLUMINANT_TABULATED:
    return tabulated_at(illuminant->spectrum, lambda_nm);
  case ABBE_ILLUMINANT_KIND_COUNT:
    break;
  }
  return 0;
}

const char *abbe_illuminant_name(const abbe_illuminant *illuminant) {
  if (illuminant->kind == ABBE_ILLUMINANT_TABULATED)
    return illuminant->name[0] != '\0' ? illuminant->name : "tabulated";
  return (unsigned)illuminant->kind < ABBE_ILLUMINANT_KIND_COUNT ? names[illuminant->kind]
                                                                 : "unknown";
}

void abbe_illuminant_free(abbe_illuminant *illuminant) {
  if (illuminant == NULL) return;
  abbe_spectrum_free(illuminant->spectrum);
  *illuminant = (abbe_illuminant){0};
}

static abbe_result load(const char *path, abbe_illuminant *out, abbe_error *error) {
  abbe_csv_points points;
  const abbe_csv_options options = {.quantity = ABBE_CSV_POWER};
  abbe_result result = abbe_csv_points_load(path, &options, &points, NULL, error);
  if (result != ABBE_OK) return result;
  const abbe_points *power = &points.power;
  bool shines = false;
  for (size_t i = 0; i < power->count; i++) shines = shines || power->point[i].value > 0;
  if (power->count < 2 || !shines)
    result = abbe_error_set(error, ABBE_SCHEMA,
                            "%s: a spectrum of a light needs at least two rows and a power above "
                            "0; there %s %zu row%s%s",
                            path, power->count == 1 ? "is" : "are", power->count,
                            power->count == 1 ? "" : "s", shines ? "" : ", all 0");
  if (result == ABBE_OK)
    result = abbe_points_spectrum(power, ABBE_INTERPOLATION_LINEAR, &out->spectrum, error);
  if (result == ABBE_OK) out->kind = ABBE_ILLUMINANT_TABULATED;
  abbe_csv_points_free(&points);
  return result;
}

/* ---- names ---- */

static abbe_result take(const double *lambda_nm, const double *power, size_t count,
                        abbe_interpolation interpolation, abbe_illuminant *out, abbe_error *error) {
  ABBE_TRY(abbe_spectrum_make(lambda_nm, power, count, interpolation, &out->spectrum, error));
  out->kind = ABBE_ILLUMINANT_TABULATED;
  return ABBE_OK;
}

static abbe_result make_published(const abbe_illuminant_table *t, abbe_illuminant *out,
                                  abbe_error *error) {
  double nm[TABLE_COUNT];
  for (size_t i = 0; i < t->count; i++)
    nm[i] = t->first_nm + ABBE_ILLUMINANT_TABLE_STEP_NM * (double)i;
  snprintf(out->name, sizeof out->name, "%s", t->name);
  return take(nm, t->power, t->count, ABBE_INTERPOLATION_LINEAR, out, error);
}

/* Daylight of a correlated colour temperature: S0 + M1 S1 + M2 S2, the factors from x and y, to
 * three places, as the CIE has them [CIE15]. */
static abbe_result make_daylight(double kelvin, abbe_illuminant *out, abbe_error *error) {
  enum { COUNT = ABBE_ILLUMINANT_DAYLIGHT_COUNT };
  double nm[COUNT], power[COUNT], xy[2] = {0};
  abbe_colour_temperature_daylight_xy(kelvin, xy);
  const double m = 0.0241 + 0.2562 * xy[0] - 0.7341 * xy[1];
  const double m1 = round(1e3 * (-1.3515 - 1.7703 * xy[0] + 5.9114 * xy[1]) / m) / 1e3;
  const double m2 = round(1e3 * (0.0300 - 31.4424 * xy[0] + 30.0717 * xy[1]) / m) / 1e3;
  for (int i = 0; i < COUNT; i++) {
    nm[i] = table_min_nm + 10 * i;
    power[i] = fmax(abbe_illuminant_daylight[0][i] + m1 * abbe_illuminant_daylight[1][i] +
                        m2 * abbe_illuminant_daylight[2][i],
                    0);
  }
  return take(nm, power, COUNT, ABBE_INTERPOLATION_LINEAR, out, error);
}

/* Every nanometre, cubic between: within 1e-6 of the formula from 1000 K on. */
static abbe_result make_planckian(double kelvin, abbe_illuminant *out, abbe_error *error) {
  enum { COUNT = 531 };
  double nm[COUNT], power[COUNT];
  for (int i = 0; i < COUNT; i++) {
    nm[i] = table_min_nm + i;
    power[i] = abbe_colour_temperature_planck(kelvin, nm[i]);
  }
  return take(nm, power, COUNT, ABBE_INTERPOLATION_MONOTONE, out, error);
}

/* "D" and hundreds of kelvin in two or three digits, which count by the c2 of 1931 as in D65, or
 * kelvin in four or five: 0 where it is no such name. */
static double daylight_kelvin(const char *name) {
  const size_t digits = strlen(name) - 1;
  double number;
  const char *end;
  if ((name[0] != 'D' && name[0] != 'd') || digits < 2 || digits > 5) return 0;
  if (strspn(name + 1, "0123456789") != digits || !abbe_number_read(name + 1, &end, &number))
    return 0;
  return digits > 3 ? number : number * 100 * 1.4388 / 1.4380;
}

/* "3200K": 0 where it is no such name. */
static double planckian_kelvin(const char *name) {
  const size_t digits = strspn(name, "0123456789");
  double number;
  const char *end;
  if (digits == 0 || digits > 7 || (name[digits] != 'K' && name[digits] != 'k') ||
      name[digits + 1] != '\0' || !abbe_number_read(name, &end, &number))
    return 0;
  return number;
}

static abbe_result refuse_temperature(const char *name, const char *what, double low, double high,
                                      abbe_error *error) {
  char range[64];
  abbe_number_format(range, sizeof range, "%g to %g K", low, high);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the illuminant '%.40s': %s are known from %s", name, what, range);
}

static abbe_result make_at_temperature(const char *name, double daylight, double planckian,
                                       abbe_illuminant *out, abbe_error *error) {
  double xy[2];
  if (daylight > 0 && !abbe_colour_temperature_daylight_xy(daylight, xy))
    return refuse_temperature(name, "daylights", 4000, 25000, error);
  if (planckian > 0 &&
      !(planckian >= ABBE_COLOUR_TEMPERATURE_MIN && planckian <= ABBE_COLOUR_TEMPERATURE_MAX))
    return refuse_temperature(name, "black bodies", ABBE_COLOUR_TEMPERATURE_MIN,
                              ABBE_COLOUR_TEMPERATURE_MAX, error);
  snprintf(out->name, sizeof out->name, "%s", name);
  for (char *c = out->name; *c != '\0'; c++)
    if (*c == 'd' || *c == 'k') *c = (char)(*c - 'a' + 'A');
  return daylight > 0 ? make_daylight(daylight, out, error) : make_planckian(planckian, out, error);
}

static abbe_result make_lines(const char *name, const abbe_illuminant_line *line, size_t count,
                              abbe_illuminant *out, abbe_error *error) {
  double nm[3 * ABBE_ILLUMINANT_MOST_LINES], power[3 * ABBE_ILLUMINANT_MOST_LINES];
  for (size_t i = 0; i < 3 * count; i++) {
    nm[i] = line[i / 3].lambda_nm + ((double)(i % 3) - 1) * ABBE_ILLUMINANT_LINE_HALF_NM;
    power[i] = i % 3 == 1 ? line[i / 3].power : 0;
  }
  if (nm[0] < ABBE_OBSERVER_MIN_NM || nm[3 * count - 1] > ABBE_OBSERVER_MAX_NM ||
      strlen(name) >= sizeof out->name)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the illuminant '%.40s': a line lies from 360 to 830 nm, in up to %zu "
                          "letters",
                          name, sizeof out->name - 1);
  snprintf(out->name, sizeof out->name, "%s", name);
  return take(nm, power, 3 * count, ABBE_INTERPOLATION_LINEAR, out, error);
}

size_t abbe_illuminant_lines(const abbe_illuminant *illuminant,
                             double lambda_nm[ABBE_ILLUMINANT_MOST_LINES]) {
  abbe_illuminant_line line[ABBE_ILLUMINANT_MOST_LINES];
  if (illuminant->kind != ABBE_ILLUMINANT_TABULATED) return 0;
  const size_t count = abbe_illuminant_lines_named(illuminant->name, line);
  for (size_t i = 0; i < count; i++) lambda_nm[i] = line[i].lambda_nm;
  return count;
}

/* "FL2" is F2. */
static const abbe_illuminant_table *find_table(const char *name) {
  const bool fl = strncasecmp(name, "FL", 2) == 0;
  for (size_t i = 0; i < ABBE_ILLUMINANT_TABLE_COUNT; i++) {
    const abbe_illuminant_table *t = &abbe_illuminant_tables[i];
    if (strcasecmp(name, t->name) == 0) return t;
    if (fl && t->name[0] == 'F' && strcasecmp(name + 2, t->name + 1) == 0) return t;
  }
  return NULL;
}

static int find_kind(const char *name) {
  for (int i = 0; i < ABBE_ILLUMINANT_TABULATED; i++)
    if (strcasecmp(name, names[i]) == 0) return i;
  return -1;
}

bool abbe_illuminant_is_name(const char *name) {
  abbe_illuminant_line line[ABBE_ILLUMINANT_MOST_LINES];
  if (name == NULL) return false;
  return find_kind(name) >= 0 || find_table(name) != NULL || daylight_kelvin(name) > 0 ||
         planckian_kelvin(name) > 0 || abbe_illuminant_lines_named(name, line) > 0;
}

const char *abbe_illuminant_listed(size_t index) {
  if (index < ABBE_ILLUMINANT_TABULATED) return names[index];
  index -= ABBE_ILLUMINANT_TABULATED;
  return index < ABBE_ILLUMINANT_TABLE_COUNT
             ? abbe_illuminant_tables[index].name
             : abbe_illuminant_lines_listed(index - ABBE_ILLUMINANT_TABLE_COUNT);
}

static const char *nearest(const char *name) {
  const char *all[64];
  size_t count = 0;
  while (count < 64 && (all[count] = abbe_illuminant_listed(count)) != NULL) count++;
  return abbe_nearest_word(name, all, count);
}

abbe_result abbe_illuminant_make(const char *name_or_path, abbe_illuminant *out,
                                 abbe_error *error) {
  *out = (abbe_illuminant){0};
  const int kind = find_kind(name_or_path);
  if (kind >= 0) {
    out->kind = (abbe_illuminant_kind)kind;
    return ABBE_OK;
  }
  const abbe_illuminant_table *table = find_table(name_or_path);
  if (table != NULL) return make_published(table, out, error);
  abbe_illuminant_line line[ABBE_ILLUMINANT_MOST_LINES];
  const size_t lines = abbe_illuminant_lines_named(name_or_path, line);
  if (lines > 0) return make_lines(name_or_path, line, lines, out, error);
  const double daylight = daylight_kelvin(name_or_path), planckian = planckian_kelvin(name_or_path);
  if (daylight > 0 || planckian > 0)
    return make_at_temperature(name_or_path, daylight, planckian, out, error);
  abbe_result result = load(name_or_path, out, error);
  if (result != ABBE_IO || strpbrk(name_or_path, "/.") != NULL) return result;
  const char *near = nearest(name_or_path);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "the illuminant '%s' is neither " ABBE_ILLUMINANT_NAMES
                        " nor the path of a readable file of two columns%s%s%s",
                        name_or_path, near ? "; did you mean '" : "", near ? near : "",
                        near ? "'?" : "");
}
