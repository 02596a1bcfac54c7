/* difference.h: colour differences as people see them. */
#ifndef ABBE_COLORIMETRY_DIFFERENCE_H
#define ABBE_COLORIMETRY_DIFFERENCE_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* CIE L*a*b* of xyz relative to the white. [CIE15] */
void abbe_difference_lab(const double xyz[3], const double white[3], double lab[3]);
/* CIEDE2000 between two Lab colours, kL = kC = kH = 1. [Sharma2005] */
double abbe_difference_ciede2000(const double lab1[3], const double lab2[3]);
/* CIE 1976 u', v' of xyz [CIE15]; false (uv untouched) where X + 15 Y + 3 Z or Y is not above 0:
 * what is dark has no chromaticity. */
bool abbe_difference_uv(const double xyz[3], double uv[2]);

#ifdef __cplusplus
}
#endif
#endif
