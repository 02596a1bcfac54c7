/* spectral_unit.h: what a unit of a spectral picture's numbers is, by the attribute emissiveUnits
 * of the layout of [Fichet2021].
 *
 * It knows units of light a nanometre: radiance, irradiance, intensity and flux. It reads no files.
 */
#ifndef ABBE_COLORIMETRY_SPECTRAL_PICTURE_SPECTRAL_UNIT_H
#define ABBE_COLORIMETRY_SPECTRAL_PICTURE_SPECTRAL_UNIT_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum abbe_spectral_quantity {
  ABBE_SPECTRAL_RADIANCE,   /* W/(m2 sr nm) */
  ABBE_SPECTRAL_IRRADIANCE, /* W/(m2 nm) */
  ABBE_SPECTRAL_INTENSITY,  /* W/(sr nm) */
  ABBE_SPECTRAL_FLUX        /* W/nm */
} abbe_spectral_quantity;

typedef struct abbe_spectral_unit {
  abbe_spectral_quantity quantity;
  double factor; /* a number of the picture is so much of the quantity's own unit */
} abbe_spectral_unit;

/* The unit of such a text: watts, areas and steradians with SI prefixes, as "mW.m^-2.sr^-1", with
 * or without the wavelength ("nm^-1", "m^-3"): numbers are densities a nanometre where it is not
 * stated. NULL: W.m^-2.sr^-1, the layout's own. ABBE_UNSUPPORTED, with `name` and what is right,
 * for any other text. */
abbe_result abbe_spectral_unit_read(const char *text, const char *name, abbe_spectral_unit *out,
                                    abbe_error *error);

/* What its luminous counterpart is, in words: "luminance, cd/m2". */
const char *abbe_spectral_quantity_text(abbe_spectral_quantity quantity);

/* The power of ten of an SI prefix of so many letters ("" is one); false: there is none. */
bool abbe_spectral_prefix(const char *text, size_t length, int *exponent);

#endif
