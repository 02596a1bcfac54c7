/* error_bars.h: how far off a picture is, estimated from other pictures of the same request.
 *
 * Where the cells of the photon grid, the map's texels and the camera's samples lie is a matter of
 * chance: variants of the picture lay them elsewhere, each variant at a place of its own along each
 * axis (a Latin hypercube). One more, coarse picture has half the photons a side, half the texels a
 * side and half the wavelengths. From these
 *
 *     error^2 = (picture - mean)^2 + spread^2 / (variants + 1) + (0.4 (mean - coarse))^2
 *
 * pixel by pixel and channel by channel, with mean and spread of the variants and the picture,
 * which is one of them: how far this picture is from the mean, how far that may be from the mean of
 * many, and what it would gain by still finer settings.
 *
 * It sees what sampling and reconstruction leave out. What the plan leaves out is in every variant
 * alike, and so is what two layers miss of a mesh: that it cannot see. Default profile only.
 */
#ifndef ABBE_GL_ACCURACY_ERROR_BARS_H
#define ABBE_GL_ACCURACY_ERROR_BARS_H

#include "colorimetry/image/image.h"
#include "gl/device/context.h"
#include "gl/renderer.h"
#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_ERROR_BARS_VARIANTS 4 /* by default */
#define ABBE_ERROR_BARS_MAX_VARIANTS 64

/* A request; zero means the default in every field. */
typedef struct abbe_error_bars_desc {
  size_t variants; /* 2 to ABBE_ERROR_BARS_MAX_VARIANTS; 0: 4 */
  bool of_mean;    /* the errors of the mean, not of the picture */
  bool aovs;       /* variants keep what the picture keeps: slower, by programs that are there */
  abbe_render_progress progress;
  void *user;
} abbe_error_bars_desc;

/* Over a region of the picture, of R, G, B (or X, Y, Z) together. */
typedef struct abbe_error_bars_summary {
  size_t pixels;
  double relative_rmse; /* root of the mean squared error over the mean */
  double ciede2000;     /* mean CIEDE2000 [Sharma2005] between the picture and itself, off by 0.8 of
                           its error, a normal error's mean size, towards the mean (the mean's:
                           towards the coarse picture) */
} abbe_error_bars_summary;

typedef struct abbe_error_bars {
  abbe_image error; /* "stderr.R", … or "stderr.X", …: one standard error, in the picture's unit */
  abbe_image mean; /* with the picture: nearer to the truth than each of them; channels and
                      attributes as the picture's R, G, B */
  abbe_error_bars_summary whole;
  abbe_error_bars_summary caustic; /* where 95 % of the caustic's light is; no pixels where the
                                      request keeps no layers or nothing refracts */
  size_t variants;
  size_t frames; /* that were drawn besides the picture */
  double ms;     /* all of it */
} abbe_error_bars;

/* Estimates the errors of the frame that the renderer holds; it is not drawn anew. Each variant is
 * a renderer of its own, one after another. desc may be NULL. Errors of abbe_error_bars_check and
 * abbe_renderer_make; ABBE_CANCELLED. */
abbe_result abbe_error_bars_make(abbe_context *context, const abbe_scene *scene,
                                 abbe_renderer *renderer, const abbe_error_bars_desc *desc,
                                 abbe_error_bars *out, abbe_error *error);
void abbe_error_bars_free(abbe_error_bars *bars);

/* ABBE_INVALID_ARGUMENT for a thesis profile and for a number of variants outside the limits. */
abbe_result abbe_error_bars_check(abbe_profile profile, const abbe_error_bars_desc *desc,
                                  abbe_error *error);

/* The request of variant i of so many, from a resolved one (abbe_plan.desc). `layout` receives the
 * map's layout of the picture's renderer with its texels moved; it must outlive the request. */
void abbe_error_bars_variant(const abbe_render_desc *desc, const abbe_map_layout *map, size_t i,
                             size_t variants, abbe_map_layout *layout, abbe_render_desc *out);

/* Adds the channels of the error to the picture. ABBE_NO_MEMORY. */
abbe_result abbe_error_bars_attach(const abbe_error_bars *bars, abbe_image *picture,
                                   abbe_error *error);

/* A picture's error bars in false colours, with a scale bar.
 *
 * The error of Y a pixel, if its channels err together; black where it is a thousandth of the
 * scale's end or less. It estimates nothing: that is error_bars.h's business. */

/* To path, a .png or .svg. The scale is logarithmic and ends at the 1, 2 or 5 times a power of ten
 * that 99.9 % of the errors stay under. ABBE_NO_MEMORY; errors of abbe_chart_write. */
abbe_result abbe_error_picture_write(const char *path, const abbe_error_bars *bars,
                                     abbe_error *error);

#endif
