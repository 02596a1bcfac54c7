/* oklab.h: a space in which equal hues look of one hue, also of colours that are very saturated.
 *
 * Oklab [Ottosson2020] of XYZ relative to D65. Light k times as bright has L, a and b of k^(1/3)
 * times the size: hue and saturation do not depend on exposure. Internal to colorimetry/.
 */
#ifndef ABBE_COLORIMETRY_GAMUT_OKLAB_H
#define ABBE_COLORIMETRY_GAMUT_OKLAB_H

/* L (1: white), a, b of xyz, and back. */
void abbe_oklab_of_xyz(const double xyz[3], double lab[3]);
void abbe_oklab_to_xyz(const double lab[3], double xyz[3]);

#endif
