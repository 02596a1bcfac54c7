#include "base/number.h"

#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static locale_t c_locale;
static pthread_once_t made = PTHREAD_ONCE_INIT;

/* Lives as long as the process. glibc takes no memory for this one; where another libc has none for
 * it, the host's locale serves. */
static void make_locale(void) {
  c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
}

locale_t abbe_number_enter(void) {
  pthread_once(&made, make_locale);
  return c_locale == (locale_t)0 ? (locale_t)0 : uselocale(c_locale);
}

void abbe_number_leave(locale_t host) {
  if (host != (locale_t)0) uselocale(host);
}

const char *abbe_number_text(double value, char text[ABBE_NUMBER_TEXT_SIZE]) {
  if (!isfinite(value)) {
    strcpy(text, isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
    return text;
  }
  locale_t host = abbe_number_enter();
  /* %g drops the zeros at the end, so 15 digits are as short as the value allows */
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, ABBE_NUMBER_TEXT_SIZE, "%.*g", digits, value);
    if (strtod(text, NULL) == value) break;
  }
  abbe_number_leave(host);
  return text;
}

/* Powers of ten that a double has exactly. A whole number below 2^53 times or over one of them is
 * rounded once, as the decimal is that they stand for [Clinger1990]. */
enum { EXACT_POWERS = 23 };
static const double power_of_ten[EXACT_POWERS] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* The decimal of six places that a value has nearly is its nearest one of 15 digits, wherever it
 * is nearer than half a step of these. */
static bool tidy_at_once(double value, double *tidy) {
  const double scaled = value * power_of_ten[6], whole = nearbyint(scaled);
  if (!(fabs(scaled) < 1e15) || !(fabs(scaled - whole) <= 3.5e-16 * fabs(scaled))) return false;
  *tidy = whole / power_of_ten[6];
  return true;
}

double abbe_number_tidy(double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  if (!isfinite(value)) return value;
  double at_once;
  if (tidy_at_once(value, &at_once)) return at_once;
  locale_t host = abbe_number_enter();
  snprintf(text, sizeof text, "%.15g", value);
  double tidy = strtod(text, NULL);
  abbe_number_leave(host);
  return tidy;
}

static bool digit(char c) {
  return c >= '0' && c <= '9';
}

/* A decimal of few digits, from its first digit or point on; false leaves it to strtod. */
static bool read_short(const char *c, bool negative, const char **end, double *value) {
  enum { MOST_DIGITS = 15 };
  uint64_t whole = 0;
  int digits = 0, places = 0, power = 0;
  for (; digit(*c) && digits <= MOST_DIGITS; c++, digits++)
    whole = 10 * whole + (uint64_t)(*c - '0');
  if (*c == '.')
    for (c++; digit(*c) && digits <= MOST_DIGITS; c++, digits++, places++)
      whole = 10 * whole + (uint64_t)(*c - '0');
  if (digits == 0 || digits > MOST_DIGITS || digit(*c)) return false;
  if (*c == 'e' || *c == 'E') {
    const char *at = c + 1;
    const bool below = *at == '-';
    if (*at == '-' || *at == '+') at++;
    if (!digit(*at)) return false;
    for (; digit(*at) && power < EXACT_POWERS; at++) power = 10 * power + (*at - '0');
    if (digit(*at)) return false;
    if (below) power = -power;
    c = at;
  }
  power -= places;
  if (abs(power) >= EXACT_POWERS) return false;
  const double size =
      power < 0 ? (double)whole / power_of_ten[-power] : (double)whole * power_of_ten[power];
  *value = negative ? -size : size;
  *end = c;
  return true;
}

bool abbe_number_read(const char *text, const char **end, double *value) {
  const char *c = text;
  while (*c == ' ' || *c == '\t') c++;
  const char *first = c;
  if (*c == '+' || *c == '-') c++;
  if (*c == '.') c++;
  *end = text;
  /* what strtod reads beyond decimals: hexadecimal (after a 0), inf and nan (no digit) */
  if (!digit(*c) || (*c == '0' && (c[1] == 'x' || c[1] == 'X'))) return false;
  if (read_short(c > first && c[-1] == '.' ? c - 1 : c, *first == '-', end, value)) return true;
  locale_t host = abbe_number_enter();
  char *past = NULL;
  *value = strtod(first, &past);
  abbe_number_leave(host);
  *end = past;
  return true;
}

bool abbe_number_read_length(const char *text, const char **end, double *metres) {
  /* a quotient is the decimal's own double (6.5 mm is 0.0065), a product need not be */
  static const struct {
    const char *name;
    double metres, parts;
  } units[] = {{"um", 1, 1e6}, {"mm", 1, 1e3},    {"cm", 1, 1e2},
               {"m", 1, 1},    {"in", 0.0254, 1}, {"ft", 0.3048, 1}};
  if (!abbe_number_read(text, end, metres)) return false;
  const char *unit = *end + strspn(*end, " ");
  const size_t length = strspn(unit, "abcdefghijklmnopqrstuvwxyz");
  for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
    if (length != strlen(units[i].name) || strncmp(unit, units[i].name, length) != 0) continue;
    *metres = *metres * units[i].metres / units[i].parts;
    *end = unit + length;
  }
  return true;
}

int abbe_number_format_list(char *out, size_t size, const char *format, va_list arguments) {
  locale_t host = abbe_number_enter();
  const int length = vsnprintf(out, size, format, arguments);
  abbe_number_leave(host);
  return length;
}

int abbe_number_format(char *out, size_t size, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int length = abbe_number_format_list(out, size, format, arguments);
  va_end(arguments);
  return length;
}

int abbe_number_write(FILE *file, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  locale_t host = abbe_number_enter();
  const int length = vfprintf(file, format, arguments);
  abbe_number_leave(host);
  va_end(arguments);
  return length;
}
