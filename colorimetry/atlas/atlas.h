/* atlas.h: the spectral colours, what so many bands make of them, and what each gamut does.
 *
 * Of light of one wavelength at half the white's luminance: its chromaticity for an observer; the
 * chromaticity of the band of a sampled spectrum that it lies in; how far outside of each gamut it
 * is and what bringing it inside costs. CIEDE2000 is under D65.
 */
#ifndef ABBE_COLORIMETRY_ATLAS_ATLAS_H
#define ABBE_COLORIMETRY_ATLAS_ATLAS_H

#include "colorimetry/gamut.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"

typedef struct abbe_atlas_desc {
  abbe_observer observer;            /* the CIE's of 1931 */
  const abbe_illuminant *illuminant; /* illuminant of the light whose bands are summed; NULL: D65 */
  double min_nm, max_nm;             /* both 0: 400 to 700 nm */
  size_t bands;                      /* that tile the range; 0: 21 */
} abbe_atlas_desc;

typedef struct abbe_atlas_row {
  double lambda_nm;
  double xyz[3], band_xyz[3]; /* for Y = 0.5 */
  double xy[2], band_xy[2];
  double band_uv;         /* distance in u'v' of the band's colour from the wavelength's own */
  double band_difference; /* the same as CIEDE2000 */
  double excess[ABBE_GAMUT_COUNT];                           /* abbe_gamut_excess */
  double difference[ABBE_GAMUT_COUNT][ABBE_GAMUT_MAP_COUNT]; /* CIEDE2000 of each mapping */
} abbe_atlas_row;

typedef struct abbe_atlas {
  abbe_observer observer;
  double min_nm, max_nm;
  size_t bands;
  size_t count;
  abbe_atlas_row *row; /* [count] every nm of the range */
} abbe_atlas;

/* Errors of abbe_wavelengths_make; ABBE_INVALID_ARGUMENT for a range that is not within 380 to 730
 * nm (380 from where the observer's table begins), where colours are distinguishable. */
abbe_result abbe_atlas_make(const abbe_atlas_desc *desc, abbe_atlas *out, abbe_error *error);
void abbe_atlas_free(abbe_atlas *atlas);

/* Strips of colour as a PNG, by Display P3: the wavelengths and under them the bands, each towards
 * white into the gamut. */
abbe_result abbe_atlas_picture(const abbe_atlas *atlas, const char *path, abbe_error *error);
/* Differences over wavelength, as a .png or .svg: of the bands, and of each gamut. */
abbe_result abbe_atlas_plot(const abbe_atlas *atlas, const char *path, abbe_error *error);

#endif
