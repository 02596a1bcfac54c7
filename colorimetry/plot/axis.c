#include "colorimetry/plot/chart_panel.h"

#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

abbe_axis abbe_axis_make(double min, double max, double margin, bool log, bool reversed) {
  if (!(min <= max)) { /* no value at all */
    min = log ? 0.1 : 0;
    max = log ? 10 : 1;
  } else if (log) {
    double low = log10(min), high = log10(max), room = margin * (high - low);
    if (low == high) room = 0.5;
    min = pow(10, low - room);
    max = pow(10, high + room);
  } else {
    double room = margin * (max - min);
    if (min == max) room = min == 0 ? 1 : fabs(min) * 0.1;
    min -= room;
    max += room;
  }
  /* spans and steps of what is left are finite */
  const double most = 1e300, least = log ? 1 / most : -most;
  min = fmin(fmax(min, least), most / 10);
  max = fmin(max, most);
  if (max <= min) max = log ? 10 * min : min + most / 10;
  return (abbe_axis){min, max, log, reversed};
}

double abbe_axis_at(const abbe_axis *a, double value) {
  double at =
      a->log ? log(value / a->min) / log(a->max / a->min) : (value - a->min) / (a->max - a->min);
  if (a->log && !(value > 0)) return NAN;
  return a->reversed ? 1 - at : at;
}

const char *abbe_axis_power(int exponent, char text[40]) {
  static const char *const raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  char digits[16];
  snprintf(digits, sizeof digits, "%d", abs(exponent));
  strcpy(text, exponent < 0 ? "10⁻" : "10");
  for (char *d = digits; *d != '\0'; d++) strcat(text, raised[*d - '0']);
  return text;
}

/* The least of 1, 2 and 5 times a power of ten that is not below value. */
static double round_step(double value) {
  double power = pow(10, floor(log10(value))), share = value / power;
  return power * (share <= 1.0001 ? 1 : share <= 2.0001 ? 2 : share <= 5.0001 ? 5 : 10);
}

static size_t linear_ticks(const abbe_axis *a, size_t wanted, abbe_axis_tick *tick, int *exponent) {
  double step;
  do /* one label alone gives no scale */
    step = round_step((a->max - a->min) / (double)wanted);
  while (floor(a->max / step + 1e-6) - ceil(a->min / step - 1e-6) < 1 && wanted++ < 12);
  double size = fmax(fabs(a->min), fabs(a->max));
  *exponent = size >= 1e5 || size < 1e-3 ? (int)floor(log10(size)) : 0;
  double unit = pow(10, *exponent);
  int decimals = (int)-floor(log10(step / unit) + 1e-9);
  if (decimals < 0) decimals = 0;
  if (decimals > 12) decimals = 12;
  size_t count = 0;
  double first = ceil(a->min / step - 1e-6), last = floor(a->max / step + 1e-6);
  for (double i = first; i <= last && count < ABBE_AXIS_MAX_TICKS; i++) {
    abbe_axis_tick *t = &tick[count++];
    *t = (abbe_axis_tick){.value = i * step, .major = true};
    double shown = i * step / unit;
    /* a hyphen is no minus sign, and there is no -0 */
    bool negative = shown < 0 && i != 0;
    abbe_number_format(t->label, sizeof t->label, "%s%.*f", negative ? "−" : "", decimals,
                       fabs(shown));
  }
  return count;
}

static void label_decade(int power, char *label, size_t size) {
  char text[40];
  if (power >= -3 && power <= 4)
    abbe_number_format(label, size, "%.*f", power < 0 ? -power : 0, pow(10, power));
  else
    snprintf(label, size, "%s", abbe_axis_power(power, text));
}

/* Every `stride`th power of ten has a label; with `between` twice and five times it too. */
static size_t powers_of_ten(const abbe_axis *a, int stride, bool between, abbe_axis_tick *tick,
                            size_t *major_count) {
  int low = (int)floor(log10(a->min) - 1e-9), high = (int)ceil(log10(a->max) + 1e-9), count = 0;
  *major_count = 0;
  for (int power = low; power <= high; power++)
    for (int digit = 1; digit < 10; digit++) {
      double value = digit * pow(10, power);
      bool power_itself = digit == 1 && power % stride == 0;
      bool major = power_itself || (between && (digit == 2 || digit == 5));
      if (value < a->min * (1 - 1e-9) || value > a->max * (1 + 1e-9)) continue;
      if ((!major && stride > 1 && digit > 1) || count == ABBE_AXIS_MAX_TICKS) continue;
      tick[count] = (abbe_axis_tick){.value = value, .major = major};
      if (power_itself)
        label_decade(power, tick[count].label, sizeof tick[count].label);
      else if (major)
        abbe_number_format(tick[count].label, sizeof tick[count].label, "%.*f",
                           power < 0 ? -power : 0, value);
      *major_count += major;
      count++;
    }
  return (size_t)count;
}

static size_t log_ticks(const abbe_axis *a, size_t wanted, abbe_axis_tick *tick, int *exponent) {
  const double decades = log10(a->max / a->min);
  size_t major, count;
  int stride = 1 + (int)(ceil(decades) / (double)(wanted + 1));
  do count = powers_of_ten(a, stride, false, tick, &major);
  while (major < 2 && stride-- > 1);
  if (major >= 2) return count;
  /* round values show more than one lonely power of ten */
  const bool plain = a->min >= 1e-3 && a->max <= 1e5 && decades >= 1;
  if (plain) count = powers_of_ten(a, 1, true, tick, &major);
  return plain && major >= 2 ? count : linear_ticks(a, wanted, tick, exponent);
}

size_t abbe_axis_ticks(const abbe_axis *axis, size_t wanted,
                       abbe_axis_tick tick[ABBE_AXIS_MAX_TICKS], int *exponent) {
  *exponent = 0;
  if (wanted < 2) wanted = 2;
  if (wanted > ABBE_AXIS_MAX_TICKS / 4) wanted = ABBE_AXIS_MAX_TICKS / 4;
  return axis->log ? log_ticks(axis, wanted, tick, exponent)
                   : linear_ticks(axis, wanted, tick, exponent);
}
