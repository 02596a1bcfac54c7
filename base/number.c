#include "base/number.h"

#include <locale.h>
#include <math.h>
#include <pthread.h>
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

double abbe_number_tidy(double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  if (!isfinite(value)) return value;
  locale_t host = abbe_number_enter();
  snprintf(text, sizeof text, "%.15g", value);
  double tidy = strtod(text, NULL);
  abbe_number_leave(host);
  return tidy;
}

static bool digit(char c) {
  return c >= '0' && c <= '9';
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
