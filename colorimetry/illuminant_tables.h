/* illuminant_tables.h: relative spectral powers as the CIE prints them [CIE15], in steps of 5 nm:
 * illuminant C, the fluorescent sources F1 to F12, the LED sources; and the components of daylight.
 *
 * illuminant.h makes lights of them. Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_ILLUMINANT_TABLES_H
#define ABBE_COLORIMETRY_ILLUMINANT_TABLES_H

#include <stddef.h>

typedef struct abbe_illuminant_table {
  const char *name;
  double first_nm; /* then every ABBE_ILLUMINANT_TABLE_STEP_NM */
  size_t count;
  const double *power; /* [count], >= 0 */
} abbe_illuminant_table;

#define ABBE_ILLUMINANT_TABLE_STEP_NM 5.0
#define ABBE_ILLUMINANT_TABLE_COUNT 22
extern const abbe_illuminant_table abbe_illuminant_tables[ABBE_ILLUMINANT_TABLE_COUNT];

/* The mean daylight S0 and its two components S1, S2 [CIE15, table T.2], from 300 nm in steps of
 * 10 nm, with values between them midway. */
#define ABBE_ILLUMINANT_DAYLIGHT_COUNT 54
extern const double *const abbe_illuminant_daylight[3];

#endif
