/* pov_file.h: a scene as a file for POV-Ray 3.7, an outside witness of caustics and their hues.
 *
 * Writes camera, lights, receivers and refractors with photons and dispersion, in linear Rec.709
 * and in Abbe's own units: a pixel of POV-Ray's linear picture is a radiance, W/(m2 sr). It does
 * not read such files and does not run POV-Ray. What POV-Ray models otherwise than Abbe: an index
 * is two numbers, a spectrum is a table of hues, a caustic is gathered from photons nearby, and
 * absorption is three numbers.
 */
#ifndef ABBE_SCENES_EXPORT_POV_FILE_H
#define ABBE_SCENES_EXPORT_POV_FILE_H

#include "base/error.h"
#include "scenes/scene.h"
#include "spectral/dispersion/index_points.h"

#include <stddef.h>

#define ABBE_POV_MAX_SAMPLES 100
#define ABBE_POV_MAX_PHOTONS 100000000

/* Zero means the default in every field. */
typedef struct abbe_pov_options {
  size_t photons; /* shot at refractors, before dispersion splits them; 0: 100 000 */
  size_t samples; /* samples of the spectrum, 2 to 100; 0: 31 */
} abbe_pov_options;

typedef struct abbe_pov_glass {
  abbe_povray_index index;
  double worst;    /* largest |n - the material's| over POV-Ray's spectrum */
  double worst_nm; /* where that is */
  double rms;      /* root mean square of n - the material's, weighted as the fit is */
} abbe_pov_glass;

/* The two numbers that serve a material best: least squares in log n, each nanometre weighted by
 * X + Y + Z of the illuminant's light. ABBE_OUT_OF_RANGE where the material has no index in the
 * range. */
abbe_result abbe_pov_file_glass(const abbe_material *material, const abbe_illuminant *illuminant,
                                abbe_pov_glass *out, abbe_error *error);

/* POV-Ray units per metre: a power of ten that brings the scene near a size of 30, where POV-Ray's
 * fixed tolerances do no harm. */
double abbe_pov_file_scale(const abbe_scene *scene);

/* Writes the scene to path (beside and renamed); options may be NULL. In the file four values can
 * be set by POV-Ray's command line: Declare=Caustics=0 leaves caustics out, Photons and
 * Samples replace the options, Gather is how many photons make a place's light at the least.
 * ABBE_INVALID_ARGUMENT for options out of range, ABBE_UNSUPPORTED for an environment, a medium, a
 * mirror and the path of a texture that POV-Ray cannot spell, errors of abbe_pov_file_glass,
 * ABBE_IO. */
abbe_result abbe_pov_file_write(const char *path, const abbe_scene *scene,
                                const abbe_pov_options *options, abbe_error *error);

#endif
