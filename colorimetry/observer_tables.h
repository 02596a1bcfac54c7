/* observer_tables.h: the CIE's colour-matching functions in steps of 5 nm. Internal to
 * colorimetry/. */
#ifndef ABBE_COLORIMETRY_OBSERVER_TABLES_H
#define ABBE_COLORIMETRY_OBSERVER_TABLES_H

#include "colorimetry/observer.h"

#define ABBE_OBSERVER_STEP_NM 5.0

typedef struct abbe_observer_table {
  double first_nm;
  int count;
  const double (*xyz)[3]; /* [count] xbar, ybar, zbar */
} abbe_observer_table;

extern const abbe_observer_table abbe_observer_tables[ABBE_OBSERVER_COUNT];

#endif
