/* difference.h: colour differences as people see them. */
#ifndef ABBE_COLORIMETRY_DIFFERENCE_H
#define ABBE_COLORIMETRY_DIFFERENCE_H

#include <stdbool.h>

/* CIE L*a*b* of xyz relative to the white. [CIE15] */
void abbe_difference_lab(const double xyz[3], const double white[3], double lab[3]);
/* CIEDE2000 between two Lab colours, kL = kC = kH = 1. [Sharma2005] */
double abbe_difference_ciede2000(const double lab1[3], const double lab2[3]);
/* The distance of two Lab colours [CIE15]. */
double abbe_difference_cie76(const double lab1[3], const double lab2[3]);
/* CIE94 of a sample against a standard, for graphic arts: kL = kC = kH = 1, K1 = 0.045, K2 = 0.015.
 * The standard's chroma weighs it, so the two cannot be exchanged. [CIE116] */
double abbe_difference_cie94(const double standard[3], const double sample[3]);

/* What the white of a picture that knows no cd/m2 is taken for in ICtCp [BT2408]. */
#define ABBE_DIFFERENCE_HDR_WHITE 203.0
/* The PQ signal, 0 to 1, of light of 0 to 10000 cd/m2, and back [BT2100]. What is below 0 or above
 * the ends is at the nearest end. */
double abbe_difference_pq(double cd_m2);
double abbe_difference_pq_light(double signal);
/* I, Ct, Cp (with PQ) of xyz relative to D65, Y in cd/m2 [BT2100]. Cones whose signal is negative
 * are taken as dark. */
void abbe_difference_ictcp(const double xyz[3], double ictcp[3]);
/* The distance of two colours in ICtCp, 1 being what is just to be seen [BT2124]. */
double abbe_difference_itp(const double ictcp1[3], const double ictcp2[3]);

/* CIE 1976 u', v' of xyz [CIE15]; false (uv untouched) where X + 15 Y + 3 Z or Y is not above 0:
 * what is dark has no chromaticity. */
bool abbe_difference_uv(const double xyz[3], double uv[2]);

#endif
