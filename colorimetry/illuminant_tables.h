/* illuminant_tables.h: relative spectral powers as the CIE prints them [CIE15], in steps of 5 nm:
 * illuminant C, the fluorescent sources F1 to F12, the LED sources; and the components of daylight.
 * Also lines: of sodium, mercury and hydrogen [Sansonetti2005], Fraunhofer's [Schott2014], lasers'.
 *
 * illuminant.h makes lights of them. Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_ILLUMINANT_TABLES_H
#define ABBE_COLORIMETRY_ILLUMINANT_TABLES_H

#include "colorimetry/illuminant.h"

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

typedef struct abbe_illuminant_line {
  double lambda_nm, power; /* nm in air; relative */
} abbe_illuminant_line;

/* Lines of the light of that name, ascending, into out; how many, 0 where it names none. "NUMBERnm"
 * and "line-LETTER" have one. */
size_t abbe_illuminant_lines_named(const char *name,
                                   abbe_illuminant_line out[ABBE_ILLUMINANT_MOST_LINES]);

/* The lamps of several lines, one by one: NULL beyond the last. */
const char *abbe_illuminant_lines_listed(size_t index);

#endif
