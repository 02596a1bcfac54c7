/* observer.h: the CIE 1931 2-degree standard observer.
 *
 * The CIE's 5 nm table, 360 to 830 nm [CIE15], interpolated by Steffen's monotone cubic so that
 * no colour-matching value is ever negative. Zero outside the table.
 */
#ifndef ABBE_COLORIMETRY_OBSERVER_H
#define ABBE_COLORIMETRY_OBSERVER_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ABBE_OBSERVER_MIN_NM 360.0
#define ABBE_OBSERVER_MAX_NM 830.0

/* xbar, ybar, zbar at lambda_nm. */
void abbe_observer_xyz(double lambda_nm, double xyz[3]);

#ifdef __cplusplus
}
#endif
#endif
