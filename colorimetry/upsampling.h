/* upsampling.h: spectra for colours: linear Rec.709 RGB of a radiance lifted to all wavelengths.
 *
 * RGB here is relative to an illuminant, as a reflectance under it is: each channel multiplies the
 * illuminant's own Rec.709 colour, so (1, 1, 1) is the illuminant's white, and under D65 RGB is
 * plain Rec.709 (to the 5e-4 by which the table's white is off the nominal one). A colour's
 * spectrum is
 *
 *     illuminant(lambda) * sum over j of c_j * B_j(lambda),  c = M^-1 rgb
 *
 * with three fixed functions B_j that are linear between multiples of 5 nm, never negative, and add
 * up to 1 everywhere: equal c give exactly the illuminant. They are the smoothest that have, under
 * D65, the colours of Rec.709's red, green and blue [MallettYuksel2019]; script/making/upsampling
 * computes them. M is such that the spectrum's XYZ over the range of wavelengths is the RGB's, to
 * rounding. Under D65 over 380 to 780 nm it is the identity to 1e-6, and no spectrum of a colour
 * with R, G, B >= 0 is below -1e-6 of the illuminant; elsewhere `least` says how negative they are.
 * What a colour's true spectrum was, nothing can tell: docs/colour.md says how far off that may be.
 */
#ifndef ABBE_COLORIMETRY_UPSAMPLING_H
#define ABBE_COLORIMETRY_UPSAMPLING_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "spectral/wavelengths.h"

/* The three functions at lambda_nm, each in [0, 1], their sum 1 to rounding; beyond 380 to 780 nm
 * they stay what they are at the end. For red, green and blue, in this order. */
void abbe_upsampling_basis(double lambda_nm, double basis[3]);

/* Their means over [from_nm, to_nm]; at from_nm where that is empty. */
void abbe_upsampling_basis_mean(double from_nm, double to_nm, double mean[3]);

/* How colours are lifted under one illuminant over one range of wavelengths. */
typedef struct abbe_upsampling {
  abbe_observer observer;            /* whom white, white_y and to_xyz are for */
  const abbe_illuminant *illuminant; /* not owned: it outlives this */
  double min_nm, max_nm;             /* the range whose light is seen */
  double white_y;   /* integral of ybar x power over the range, nm x the illuminant's unit, > 0 */
  double white[3];  /* the illuminant's own colour: XYZ, Y = 1 */
  double to_xyz[9]; /* row-major: XYZ of RGB; its rows add up to white */
  double to_coefficients[9]; /* row-major M^-1: c of RGB; its rows add up to 1 */
  double least; /* smallest value of the spectra of (1, 0, 0), (0, 1, 0) and (0, 0, 1), over the
                   illuminant's: 0 to rounding, or below */
} abbe_upsampling;

/* ABBE_INVALID_ARGUMENT where the range is empty or holds no light that the eye sees, and where the
 * light in it makes too few colours: that of one or two lines, or of a narrow band. */
abbe_result abbe_upsampling_make(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                                 abbe_upsampling *out, abbe_error *error);
/* The same spectra as another observer sees them: RGB stays what it is, which is defined by the
 * observer of 1931; white, white_y and to_xyz are the other's. */
abbe_result abbe_upsampling_make_by(abbe_observer observer, const abbe_illuminant *illuminant,
                                    double min_nm, double max_nm, abbe_upsampling *out,
                                    abbe_error *error);

/* The spectrum of rgb at lambda_nm, over the illuminant's own: 1 for (1, 1, 1). Linear in rgb. */
double abbe_upsampling_at(const abbe_upsampling *upsampling, const double rgb[3], double lambda_nm);

/* Row-major matrix that takes RGB to what the light in the band [from_nm, to_nm] adds to a colour
 * in `space`; unit and normalisation are those of abbe_weights_range_xyz, and applied to (1, 1, 1)
 * it gives that weight. What of the band lies outside the range is left out. */
void abbe_upsampling_band(const abbe_upsampling *upsampling, abbe_rgb_space space, double from_nm,
                          double to_nm, double matrix[9]);

#endif
