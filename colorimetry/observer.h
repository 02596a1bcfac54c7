/* observer.h: the colour-matching functions of the CIE's standard observers.
 *
 * The CIE's 5 nm tables, interpolated by Steffen's monotone cubic [Steffen1990] so that no
 * colour-matching value is ever negative; zero outside the table. Wherever no observer is named it
 * is that of 1931, which pictures and weights are made for.
 */
#ifndef ABBE_COLORIMETRY_OBSERVER_H
#define ABBE_COLORIMETRY_OBSERVER_H

#include <stdbool.h>

/* X(code, name, text). Those of 1931 and 1964 go from 360 to 830 nm [CIE15]; those of 2015, which
 * are the XYZ of the cone fundamentals of 2006, from 390 to 830 nm [CIE170-2]. */
#define ABBE_OBSERVERS(X)                                                                          \
  X(CIE_1931, "1931", "CIE 1931, 2 degrees")                                                       \
  X(CIE_1964, "1964", "CIE 1964, 10 degrees")                                                      \
  X(CIE_2015_2, "2015-2", "CIE 2015, 2 degrees")                                                   \
  X(CIE_2015_10, "2015-10", "CIE 2015, 10 degrees")

typedef enum abbe_observer {
#define ABBE_OBSERVER_ENUM(code, name, text) ABBE_OBSERVER_##code,
  ABBE_OBSERVERS(ABBE_OBSERVER_ENUM)
#undef ABBE_OBSERVER_ENUM
      ABBE_OBSERVER_COUNT
} abbe_observer;

/* Range of the observer of 1931; no other reaches further. */
#define ABBE_OBSERVER_MIN_NM 360.0
#define ABBE_OBSERVER_MAX_NM 830.0

/* xbar, ybar, zbar of the observer of 1931 at lambda_nm. */
void abbe_observer_xyz(double lambda_nm, double xyz[3]);
/* The same of any. */
void abbe_observer_xyz_of(abbe_observer observer, double lambda_nm, double xyz[3]);

/* "1931", and "CIE 1931, 2 degrees"; "unknown" for what is none. */
const char *abbe_observer_name(abbe_observer observer);
const char *abbe_observer_text(abbe_observer observer);
/* The observer of that name ("2006-2" and "2006-10" are those of 2015) or text, or
 * ABBE_OBSERVER_COUNT. */
abbe_observer abbe_observer_find(const char *name);

#endif
