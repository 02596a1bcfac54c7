#include "colorimetry/observer.h"

#include "colorimetry/observer_tables.h"

#include <math.h>
#include <string.h>

static double sign(double x) {
  return x < 0 ? -1 : 1;
}

/* Rise a step at knot i, limited so that the cubic never leaves its knots' values [Steffen1990];
 * at the ends that of the parabola through three knots, between flat and twice the last rise. */
static double slope(const abbe_observer_table *t, int i, int component) {
  const int at = i == 0 ? 1 : i == t->count - 1 ? i - 1 : i;
  const double left = t->xyz[at][component] - t->xyz[at - 1][component];
  const double right = t->xyz[at + 1][component] - t->xyz[at][component];
  const double mean = (left + right) / 2;
  if (i != at) {
    const double outer = i < at ? left : right, end = 2 * outer - mean;
    return sign(outer) * fmin(fmax(sign(outer) * end, 0), 2 * fabs(outer));
  }
  return (sign(left) + sign(right)) * fmin(fmin(fabs(left), fabs(right)), fabs(mean) / 2);
}

void abbe_observer_xyz_of(abbe_observer observer, double lambda_nm, double xyz[3]) {
  xyz[0] = xyz[1] = xyz[2] = 0;
  if ((unsigned)observer >= ABBE_OBSERVER_COUNT) return;
  const abbe_observer_table *t = &abbe_observer_tables[observer];
  double position = (lambda_nm - t->first_nm) / ABBE_OBSERVER_STEP_NM;
  if (!(position >= 0 && position <= t->count - 1)) return;
  int i = (int)position;
  if (i > t->count - 2) i = t->count - 2;
  double along = position - i;
  for (int k = 0; k < 3; k++) {
    double y0 = t->xyz[i][k], rise = t->xyz[i + 1][k] - y0;
    double m0 = slope(t, i, k), m1 = slope(t, i + 1, k);
    double value =
        y0 + along * (m0 + along * (3 * rise - 2 * m0 - m1 + along * (m0 + m1 - 2 * rise)));
    /* monotone between non-negative knots; rounding alone may reach below zero */
    xyz[k] = fmax(0, value);
  }
}

void abbe_observer_xyz(double lambda_nm, double xyz[3]) {
  abbe_observer_xyz_of(ABBE_OBSERVER_CIE_1931, lambda_nm, xyz);
}

static const char *const names[] = {
#define NAME(code, name, text) name,
    ABBE_OBSERVERS(NAME)
#undef NAME
};

static const char *const texts[] = {
#define TEXT(code, name, text) text,
    ABBE_OBSERVERS(TEXT)
#undef TEXT
};

const char *abbe_observer_name(abbe_observer observer) {
  return (unsigned)observer < ABBE_OBSERVER_COUNT ? names[observer] : "unknown";
}

const char *abbe_observer_text(abbe_observer observer) {
  return (unsigned)observer < ABBE_OBSERVER_COUNT ? texts[observer] : "unknown";
}

abbe_observer abbe_observer_find(const char *name) {
  if (strcmp(name, "2006-2") == 0) return ABBE_OBSERVER_CIE_2015_2;
  if (strcmp(name, "2006-10") == 0) return ABBE_OBSERVER_CIE_2015_10;
  for (int i = 0; i < ABBE_OBSERVER_COUNT; i++)
    if (strcmp(name, names[i]) == 0 || strcmp(name, texts[i]) == 0) return (abbe_observer)i;
  return ABBE_OBSERVER_COUNT;
}
