/* camera_bands.h: the bands of wavelengths that the camera's rays are followed for, of every
 * refractor and mirror, as float copies of what the shaders read (refraction.comp). Internal to
 * gl/.
 *
 * A set has a band for each wavelength, then these joined by twos, and so on to one. The first set
 * is of the plan's wavelengths. The others are for the samples of a pixel, which share the
 * spectrum: their wavelengths stand at one quarter after the other of the plan's bands, so that
 * four samples together have four times as many. Each set by itself makes white of white. Where
 * attenuation or reflectance varies by wavelength each band has parts (band_parts.h).
 */
#ifndef ABBE_GL_SCENE_SPECTRA_CAMERA_BANDS_H
#define ABBE_GL_SCENE_SPECTRA_CAMERA_BANDS_H

#include "gl/scene/spectra/spectral_tables.h"

enum { ABBE_CAMERA_BAND_SHARES = 4, ABBE_CAMERA_BAND_SETS = 1 + ABBE_CAMERA_BAND_SHARES };

typedef struct abbe_camera_band {
  float weight_n[4]; /* X, Y, Z, each of a sum of 1 over a level; mean index */
  float surface[4];  /* attenuation, 1/m; then of a mirror: factor, n, k, as of a node */
} abbe_camera_band;

/* Texels of a band's colour: the columns of a matrix that makes of XYZ what of it the band has, by
 * the band's own X, Y and Z; what is seen is lifted to all wavelengths by upsampling.h. All of a
 * level's bands together have what is seen, and of white each has its weight. */
enum { ABBE_BAND_COLOUR_TEXELS = 3 };
/* Texels of a band's parts: of a refractor their attenuation, 1/m, of a mirror their factors; and
 * of their light X, Y and Z, two each. */
enum { ABBE_PART_TEXELS = 2, ABBE_PART_LIGHT_TEXELS = 6 };

/* Bands of a set for so many wavelengths, all levels together; *levels: so many. */
size_t abbe_camera_bands_count(size_t wavelengths, size_t *levels);
/* Texels of all colours, of all parts where the plan needs these, and of crystals. */
size_t abbe_camera_bands_texels(const abbe_plan *plan);
/* The first texel of crystals: z and x of each refractor's axes; then [refractors][sets][count],
 * with the inverse squares of the outer indices as half their sum and half the difference of x's
 * and z's, and the sine and cosine of the angle between an optic axis and z, which lies between x
 * and z (crystals.glsl). */
size_t abbe_camera_bands_crystals(const abbe_plan *plan);
/* Of all that the object, which glows, emits in the light that comes to its middle, the share of
 * each row of its material's re-radiation. */
void abbe_glow_rows_weigh(const abbe_scene *scene, const abbe_plan *plan, const abbe_object *object,
                          double *weight);
/* The first texel of what refractors emit by fluorescence, of a plan in which some glow:
 * [refractors][sets][count][ABBE_PART_LIGHT_TEXELS], X, Y and Z of a photon a unit of the lights'
 * power, shared out over the parts; others emit none. */
size_t abbe_camera_bands_glow(const abbe_plan *plan);

/* So many wavelengths that bands are joined first, and come back where they differ. */
bool abbe_camera_bands_refine(const abbe_plan *plan);
/* Whether each sample that shares the spectrum takes every second band of a level of more than two,
 * and its neighbours those between: of the sets of such samples a band then has half of the light
 * of each beside it besides its own, all of the first's and the last's. */
bool abbe_camera_bands_interleave(const abbe_plan *plan);

/* out: [refractors][ABBE_CAMERA_BAND_SETS][abbe_camera_bands_count]; texel, zeroed: as many as
 * abbe_camera_bands_texels says, of [sets][count][ABBE_BAND_COLOUR_TEXELS], then of
 * [refractors][sets][count][ABBE_PART_TEXELS] and of [sets][count][ABBE_PART_LIGHT_TEXELS], and
 * the parts along x, y and z of a plan with pleochroism, as those before; crystals and glow. Errors
 * of abbe_spectral_tables_make. */
abbe_result abbe_camera_bands_fill(const abbe_scene *scene, const abbe_plan *plan,
                                   const abbe_spectral_tables *tables, abbe_camera_band *out,
                                   float (*texel)[4], abbe_error *error);

/* Wavelengths that a band of a set has of its own; bands go level after level. */
void abbe_camera_bands_range(const abbe_plan *plan, const abbe_wavelengths *all, int set,
                             size_t band, double range_nm[2]);

/* What films on refractors' faces in air make of unpolarised light (films.glsl). By the cosine of
 * the angle in air, in even steps; beyond total reflection, where absorbing films take light, by
 * the tangent of half the angle whose sine is that cosine's imaginary part over its most. A photon
 * has the film of its wavelength, the camera the mean over its band, by the light's brightness. */
enum { ABBE_FILM_ANGLES = 128 };

/* The films of refractor r, which are numbered through from *first on; NULL: it has none that are
 * drawn. */
const abbe_coatings *abbe_film_tables_of(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                                         uint32_t *first);
size_t abbe_film_tables_texels(const abbe_scene *scene, const abbe_plan *plan);
/* texel: of each refractor, the number of the film on all of it, -1: it is bare, -2: its planes
 * have their own; of a crystal, by how much more films are numbered that stand on another of its
 * indices than the ordinary or middle one, and along which axis it is; then that of each plane;
 * then of each film, first of all wavelengths, then of all bands of all sets, 2 ABBE_FILM_ANGLES +
 * 1 each: what is reflected from outside and from inside, and what passes. Errors of
 * abbe_coating_at. */
abbe_result abbe_film_tables_fill(const abbe_scene *scene, const abbe_plan *plan,
                                  const abbe_spectral_tables *tables, float (*texel)[4],
                                  abbe_error *error);

/* X, Y and Z of white, each of 1, that mirror r reflects at normal incidence, of what fill has
 * made. */
void abbe_camera_bands_reflected(const abbe_plan *plan, const abbe_camera_band *band,
                                 const float (*texel)[4], size_t r, double xyz[3]);

#endif
