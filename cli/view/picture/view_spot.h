/* view_spot.h: a pixel's spectrum by the reference tracer, long before a whole picture has one.
 *
 * A camera looks at nothing but the pixel, with many samples; the photons of each pass are as many
 * as a picture has, and are gathered as widely. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_SPOT_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_SPOT_H

#include "base/error.h"
#include "scenes/scene.h"

#define ABBE_VIEW_SPOT_BANDS 40

typedef struct abbe_view_spot {
  size_t passes;
  size_t bands;                          /* 0: there is none */
  double nm[ABBE_VIEW_SPOT_BANDS];       /* their middles */
  double radiance[ABBE_VIEW_SPOT_BANDS]; /* W/(m2 sr nm), mean over the pixel */
  double stderr_of[ABBE_VIEW_SPOT_BANDS];
} abbe_view_spot;

/* Traces a pixel of the scene's picture of width x height pixels; at least four passes, and more
 * until so many seconds are over, up to 16. ABBE_CANCELLED where *stop (may be NULL) becomes other
 * than 0; errors of abbe_tracer_make. */
abbe_result abbe_view_spot_trace(const abbe_scene *scene, size_t width, size_t height,
                                 const size_t pixel[2], double seconds, const volatile int *stop,
                                 abbe_view_spot *out, abbe_error *error);

#endif
