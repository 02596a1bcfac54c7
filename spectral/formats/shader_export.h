/* shader_export.h: materials in the words of other renderers, with the loss stated.
 *
 * pbrt-v4 gets n and absorption as sampled spectra, MDL likewise; POV-Ray gets ior, a dispersion
 * ratio and exponential fading; glTF gets ior, dispersion and an attenuation colour. None of these
 * can be read back. For each material the largest error of n that the form implies is noted.
 */
#ifndef ABBE_SPECTRAL_FORMATS_SHADER_EXPORT_H
#define ABBE_SPECTRAL_FORMATS_SHADER_EXPORT_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material_table.h"

#include <stdio.h>

typedef enum abbe_shader {
  ABBE_SHADER_PBRT,   /* named materials and media for pbrt-v4, spectra every 5 nm */
  ABBE_SHADER_POVRAY, /* interiors for an include file of POV-Ray */
  ABBE_SHADER_MDL,    /* a module of NVIDIA's Material Definition Language, spectra every 5 nm */
  ABBE_SHADER_GLTF,   /* materials for a glTF file: ior, dispersion, transmission, volume */
  ABBE_SHADER_COUNT
} abbe_shader;

/* POV-Ray's two numbers (spectral/dispersion/povray_index.h), fitted over the part of 380 to 730 nm
 * that the record vouches for, and the largest error of n there. */
void abbe_shader_povray_numbers(const abbe_material *material, double *ior, double *dispersion,
                                double *max_error);
/* glTF's law: Cauchy's two terms through n_d and V_d = 20 / dispersion [glTFDispersion]; the
 * largest error of n over 380 to 780 nm. dispersion is 0 where V_d is not above 0. */
void abbe_shader_gltf_numbers(const abbe_material *material, double *ior, double *dispersion,
                              double *max_error);

/* Writes all materials of the table. Outside a record's range n is continued where the record
 * allows it, else held at the range's end, and noted as ASSUMED. Names become identifiers, each
 * only once. ABBE_IO where the stream fails; a material that a table may not hold is noted as
 * SKIPPED, and so is a conductor, but for pbrt. */
abbe_result abbe_shader_write(abbe_shader shader, const abbe_material_table *table, FILE *to,
                              abbe_report *report, abbe_error *error);

#endif
