/* traced_picture.h: the picture of `abbe render` where the tracer serves the request best. */
#ifndef ABBE_CLI_RENDER_TRACED_PICTURE_H
#define ABBE_CLI_RENDER_TRACED_PICTURE_H

#include "colorimetry/rgb_space.h"
#include "validation/sweep/picture_choice.h"

typedef struct abbe_traced_picture_desc {
  size_t width, height; /* pixels; 0: the scene's */
  double min_nm, max_nm;
  abbe_rgb_space space;
  bool quiet;
} abbe_traced_picture_desc;

/* Traces the point's passes, with a bar, and filters them where it says so. error_met receives
 * abbe_sweep_trace_own_error; NaN of an odd number of passes.
 * ABBE_CANCELLED; errors of abbe_tracer_make. */
abbe_result abbe_traced_picture_make(const abbe_picture_point *point, const abbe_scene *scene,
                                     const abbe_traced_picture_desc *desc, abbe_image *out,
                                     double *error_met, abbe_error *error);

#endif
