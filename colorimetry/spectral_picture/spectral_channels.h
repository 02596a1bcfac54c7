/* spectral_channels.h: which of a picture's channels are samples of a spectrum, by their names.
 *
 * The layout of [Fichet2021]: "S0.550,000000nm" is emitted (or arriving) light, "T.550,000000nm" a
 * reflectance, "T.400,000000nm.550,000000nm" what comes back at 550 nm of light at 400: the
 * reflectances are the diagonal of a matrix [Donaldson1954], and these its other places. The comma
 * is the decimal point, the unit m or Hz with or without a prefix. What stands before, up to a
 * point, is a layer. Each sample stands for a band; bands meet midway between neighbouring samples
 * and reach as far beyond the first and the last; a lone sample has no known band, and so no width.
 * It reads no files. */
#ifndef ABBE_COLORIMETRY_SPECTRAL_PICTURE_SPECTRAL_CHANNELS_H
#define ABBE_COLORIMETRY_SPECTRAL_PICTURE_SPECTRAL_CHANNELS_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/image/image.h"
#include "colorimetry/observer.h"

#include <stdbool.h>
#include <stddef.h>

/* What a unit of a spectral picture's numbers is, by the attribute emissiveUnits of the layout of
 * [Fichet2021].
 *
 * It knows units of light a nanometre: radiance, irradiance, intensity and flux. It reads no
 * files. */

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

typedef enum abbe_spectral_kind {
  ABBE_SPECTRAL_NONE,
  ABBE_SPECTRAL_EMISSIVE,  /* S0 */
  ABBE_SPECTRAL_REFLECTIVE /* T */
} abbe_spectral_kind;

/* What a channel's name without its layer means, and the wavelength in *lambda_nm (vacuum's, where
 * the name has a frequency). Of polarised light only S0, all of it, counts; re-radiation
 * ("T.550nm.600nm") is no band. */
abbe_spectral_kind abbe_spectral_channel_parse(const char *name, double *lambda_nm);

/* Zeroed: none. */
typedef struct abbe_spectral_channels {
  abbe_spectral_kind kind;
  size_t count;
  double *lambda_nm;    /* [count] ascending */
  double *edge_nm;      /* [count + 1] of the bands */
  size_t terms;         /* bands, and behind them channels of re-radiation between two of them */
  size_t *channel;      /* [terms] in the image */
  size_t *error;        /* [terms] the channel of its standard error, "stderr." before the name, or
                           (size_t)-1 */
  size_t (*between)[2]; /* [terms - count] the band of the light that comes, and of what leaves */
  abbe_spectral_unit
      unit; /* unit of emissive samples, by the attribute emissiveUnits; else of factor 1 */
} abbe_spectral_channels;

/* The emissive samples of a picture, else the reflective ones and what is re-radiated between them,
 * else none (count 0, ABBE_OK).
 * `layer` names the layer that they are in, NULL: in none. `name` is what errors call the picture.
 * ABBE_INVALID_ARGUMENT for two channels of one wavelength or pair of them, ABBE_UNSUPPORTED for a
 * unit that is none of light. */
abbe_result abbe_spectral_channels_find(const abbe_image *image, const char *layer,
                                        const char *name, abbe_spectral_channels *out,
                                        abbe_error *error);
/* Channels that are of a spectrum and are not read: S1 to S3 of polarised light, re-radiation
 * between wavelengths that are no bands of a reflectance, what bands are called elsewhere
 * ("w420nm"), and bands of a wavelength that is none ("S0.nannm"). */
typedef enum abbe_spectral_unread_kind {
  ABBE_SPECTRAL_UNREAD_POLARISED,
  ABBE_SPECTRAL_UNREAD_RERADIATION,
  ABBE_SPECTRAL_UNREAD_NAMED,
  ABBE_SPECTRAL_UNREAD_WAVELENGTH,
  ABBE_SPECTRAL_UNREAD_COUNT
} abbe_spectral_unread_kind;

typedef struct abbe_spectral_unread {
  size_t count[ABBE_SPECTRAL_UNREAD_COUNT];
  const char *first[ABBE_SPECTRAL_UNREAD_COUNT]; /* one of their names, the image's; NULL */
} abbe_spectral_unread;

void abbe_spectral_channels_find_unread(const abbe_image *image, const char *layer,
                                        abbe_spectral_unread *out);
void abbe_spectral_channels_free(abbe_spectral_channels *channels);

/* The colour of a spectral picture, for any observer and under any light.
 *
 * A picture of bands keeps what the light of each wavelength did in the scene; so it can be looked
 * at by another observer, and under another illuminant than it was made with, by new weights of its
 * bands, without tracing anything anew. It knows nothing of screens. */

/* lm/W at 540 THz, the definition of the candela; in use for every observer here. */
#define ABBE_SPECTRAL_COLOUR_KM 683.0

/* Zeroed: the observer of 1931, and the light that there is. The illuminants are not owned. */
typedef struct abbe_spectral_view {
  abbe_observer observer;
  const abbe_illuminant *from; /* emissive: that all lights of the scene had; NULL: not known */
  const abbe_illuminant *to;   /* to look at it under; NULL: as it is, a reflectance under D65 */
} abbe_spectral_view;

/* What a unit of each channel adds to X, Y and Z, whatever unit the picture states:
 * weight[channels->terms].
 *
 * Emissive, `from` not known: each band is even within itself, and XYZ is in lm (of a radiance in
 * W/(m2 sr nm): cd/m2). `from` known: within a band light has its shape, and XYZ is in the unit of
 * Abbe's pictures, where a light of one watt is white with Y = 1; under `to`, every light of the
 * scene has that illuminant instead, with as many of these units. Reflective: relative to a perfect
 * white under `to`, whose Y is 1. Re-radiation: light of the one band, by its mean a nm under `to`,
 * comes back even within the other.
 *
 * ABBE_INVALID_ARGUMENT where there are less than two bands, where they hold no light that the eye
 * sees, and where `to` is given for a light that is not known. */
abbe_result abbe_spectral_colour_weights(const abbe_spectral_channels *channels,
                                         const abbe_spectral_view *view, const char *name,
                                         double (*weight)[3], abbe_error *error);

/* XYZ with Y = 1 of the white of that view, over the bands' range: `to`, else `from`, else D65. */
void abbe_spectral_colour_white(const abbe_spectral_channels *channels,
                                const abbe_spectral_view *view, double xyz[3]);

#endif
