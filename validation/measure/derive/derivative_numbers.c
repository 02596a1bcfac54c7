#include "validation/measure/derive/derivative.h"

#include <math.h>

enum { PARTS = ABBE_DERIVATIVE_PARTS, SUMS = ABBE_DERIVATIVE_SUMS };

#define NAME_OF(code, name, unit) name,
#define UNIT_OF(code, name, unit) unit,
static const char *const names[] = {ABBE_DERIVATIVE_NUMBERS(NAME_OF)};
static const char *const units[] = {ABBE_DERIVATIVE_NUMBERS(UNIT_OF)};

const char *abbe_derivative_number_name(abbe_derivative_number which) {
  return names[which];
}

const char *abbe_derivative_number_unit(abbe_derivative_number which) {
  return units[which];
}

static double number(const double s[SUMS], const double middle[3], abbe_derivative_number which) {
  double around = 0, at[3];
  for (int k = 0; k < 3; k++) {
    at[k] = s[3 + k] / s[1];
    around += at[k] * at[k];
  }
  switch (which) {
  case ABBE_DERIVATIVE_FLUX:
    return s[1];
  case ABBE_DERIVATIVE_CHROMA_X:
  case ABBE_DERIVATIVE_CHROMA_Y:
    return s[which - ABBE_DERIVATIVE_CHROMA_X] / (s[0] + s[1] + s[2]);
  case ABBE_DERIVATIVE_SPREAD:
    return sqrt(fmax(s[6] / s[1] - around, 0));
  default:
    return middle[which - ABBE_DERIVATIVE_PLACE_X] + at[which - ABBE_DERIVATIVE_PLACE_X];
  }
}

/* Of the mean of all parts but one (PARTS: of all). */
static double number_without(const abbe_derivative *d, abbe_derivative_number which, size_t row,
                             size_t without) {
  double s[SUMS] = {0}, change[SUMS] = {0}, near[2][SUMS];
  const double count = without < PARTS ? PARTS - 1 : PARTS;
  double size = 0;
  for (size_t p = 0; p < PARTS; p++)
    for (int k = 0; k < SUMS && p != without; k++) {
      s[k] += d->sum[0][p][k] / count;
      if (row > 0) change[k] += d->sum[row][p][k] / count;
    }
  if (row == 0) return number(s, d->middle, which);
  for (int k = 0; k < SUMS; k++)
    if (s[k] != 0) size = fmax(size, fabs(change[k] / s[k]));
  if (size == 0) return s[1] > 0 ? 0 : NAN;
  const double by = 1e-6 / size;
  for (int k = 0; k < SUMS; k++)
    for (int i = 0; i < 2; i++) near[i][k] = s[k] + (i == 0 ? -by : by) * change[k];
  return (number(near[1], d->middle, which) - number(near[0], d->middle, which)) / (2 * by);
}

double abbe_derivative_number_of(const abbe_derivative *d, abbe_derivative_number which, size_t row,
                                 double *error) {
  const double all = number_without(d, which, row, PARTS);
  double square = 0;
  for (size_t p = 0; p < PARTS; p++) {
    const double off = number_without(d, which, row, p) - all;
    square += off * off;
  }
  *error = sqrt(square * (PARTS - 1) / PARTS);
  return all;
}
