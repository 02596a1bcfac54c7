/* pinhole_limits.h: what pinholes come to with far more samples, of which the error of few is
 * separated from what the method leaves out and from a reference's noise. Internal to
 * validation/sweep/studies/.
 */
#ifndef ABBE_VALIDATION_SWEEP_STUDIES_PINHOLE_LIMITS_H
#define ABBE_VALIDATION_SWEEP_STUDIES_PINHOLE_LIMITS_H

#include "gl/renderer.h"
#include "scenes/samples/surface_samples.h"

#define ABBE_PINHOLE_LIMITS_MOST 8 /* profiles, each with footprints and without */

/* A zeroed one knows nothing yet. */
typedef struct abbe_pinhole_limits {
  /* The limit is the mean of so many pictures of so many samples, other ones in each; 0: 4 of as
   * many as there may be. */
  size_t pictures, samples;
  size_t count;
  struct {
    abbe_profile profile;
    abbe_footprint footprint;
    abbe_image picture;
  } limit[ABBE_PINHOLE_LIMITS_MOST];
} abbe_pinhole_limits;
void abbe_pinhole_limits_free(abbe_pinhole_limits *known);

/* The request's limit, with its size: drawn where it is not known; *out belongs to `known`. Errors
 * of abbe_renderer_make and abbe_renderer_frame. */
abbe_result abbe_pinhole_limits_find(abbe_pinhole_limits *known, abbe_context *context,
                                     const abbe_scene *scene, const abbe_render_desc *desc,
                                     const abbe_image **out, abbe_error *error);

/* Root mean square of R, G, B of a picture's difference to another one of its size, over the
 * other's root mean square. */
double abbe_pinhole_limits_distance(const abbe_image *picture, const abbe_image *limit);

/* The same of a request: the root mean square over some draws of its samples. Both are drawn with
 * each sample taken by itself and with tiles of 32 texels a side, so that samples alone differ. */
abbe_result abbe_pinhole_limits_measure(abbe_pinhole_limits *known, abbe_context *context,
                                        const abbe_scene *scene, const abbe_render_desc *desc,
                                        double *rmse, abbe_error *error);

#endif
