/* traced_picture.h: the picture of `abbe render` where the tracer serves the request best.
 * Internal to cli/render/. */
#ifndef ABBE_CLI_RENDER_TRACED_PICTURE_H
#define ABBE_CLI_RENDER_TRACED_PICTURE_H

#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "library/choice/picture_choice.h"

typedef struct abbe_traced_picture_desc {
  size_t width, height; /* pixels; 0: the scene's */
  double min_nm, max_nm;
  abbe_rgb_space space;
  abbe_observer observer;
  bool quiet;
} abbe_traced_picture_desc;

/* Traces the choice's point, with a bar; where an error is requested, until its own passes show
 * that it is kept. Sets the choice's passes and met. Errors of abbe_bounded_trace_make. */
abbe_result abbe_traced_picture_make(abbe_picture_choice *choice, const abbe_scene *scene,
                                     const abbe_traced_picture_desc *desc, abbe_image *out,
                                     abbe_error *error);

/* Compares the picture, with its caustic's layers, with traced passes of other chance, with a bar,
 * in the time that the budget leaves, until they show whether its error is what was expected. Sets
 * the choice's passes, others, timed_out and met. Errors of abbe_checked_picture_make. */
abbe_result abbe_traced_picture_check_in_time(abbe_picture_choice *choice, const abbe_scene *scene,
                                              const abbe_traced_picture_desc *desc,
                                              const abbe_image *picture, abbe_error *error);

/* Holds the rendered picture, with its caustic's layers, against traced passes, with a bar. Sets
 * the choice's passes and met. `traced` receives what the passes made where that keeps the error
 * that is requested and the picture does not, and the choice's traced_instead then says so; else it
 * is left without pixels, as it is without `may_trace`. Errors of abbe_checked_picture_make. */
abbe_result abbe_traced_picture_check(abbe_picture_choice *choice, const abbe_scene *scene,
                                      const abbe_traced_picture_desc *desc, bool may_trace,
                                      const abbe_image *picture, abbe_image *traced,
                                      abbe_error *error);

#endif
