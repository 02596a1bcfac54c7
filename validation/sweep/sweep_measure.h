/* sweep_measure.h: settings against a traced reference: one measurement, the reference.
 *
 * A setting is drawn (or traced, where the tracer is the contestant: then no map is compared, which
 * would be the reference's own estimator against itself), timed as the median of warmed frames, and
 * compared with the reference: its receiver map in the reference's layout, its picture pixel by
 * pixel. The thesis profile knows no units, so its map and its picture are first multiplied by the
 * one factor each that suits it best; the same method in physical units (thesis-cie) gets none.
 * Maps of both, which they lay out by the light's cone, are resampled. It keeps no files and draws
 * no charts. Internal to validation/sweep/.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_MEASURE_H
#define ABBE_VALIDATION_SWEEP_SWEEP_MEASURE_H

#include "colorimetry/image/image.h"
#include "gl/device/context.h"
#include "gl/plan/plan.h"
#include "scenes/view/map_layout.h"
#include "validation/tradeoff/sweep_table.h"

#define ABBE_SWEEP_BANDS 8 /* in which maps are compared over wavelength */

/* What the settings are held against. The images outlive it. */
typedef struct abbe_sweep {
  abbe_context *context;
  const abbe_scene *scene;
  size_t light;              /* whose map is compared */
  size_t frames;             /* behind a median; 0: 5; three where they took over 3 s */
  const abbe_image *picture; /* the reference; NULL: no picture is compared */
  const abbe_image *map;     /* the same, with its layout; NULL: no map */
  /* The same with matched physics, which separates what the model leaves out from what sampling
   * does; or NULL. */
  const abbe_image *matched_picture, *matched_map;
} abbe_sweep;

/* The layout into which the default profile's default fits the light's map: the reference's.
 * ABBE_UNSUPPORTED where nothing refracts. */
abbe_result abbe_sweep_fit_layout(abbe_context *context, const abbe_scene *scene, size_t light,
                                  abbe_map_layout *out, abbe_error *error);

/* Draws, times and compares one setting, at the reference picture's size. `picture` (may be NULL)
 * receives what was drawn. ABBE_CANCELLED where progress says stop; errors of abbe_renderer_make
 * and abbe_compare. */
abbe_result abbe_sweep_measure(const abbe_sweep *sweep, const abbe_sweep_setting *setting,
                               abbe_render_progress progress, void *user, abbe_sweep_row *out,
                               abbe_image *picture, abbe_error *error);

/* A picture against the reference's, which is there, over all of it and its caustic; scaled: times
 * the factor that suits it best. Other numbers are not known. Errors of abbe_compare. */
abbe_result abbe_sweep_compare_picture(const abbe_sweep *sweep, const abbe_image *picture,
                                       bool scaled, abbe_sweep_row *out, abbe_error *error);

/* The times alone, at another size (0: the scene's). */
abbe_result abbe_sweep_time(const abbe_sweep *sweep, const abbe_sweep_setting *setting,
                            size_t width, size_t height, abbe_sweep_row *out, abbe_error *error);

/* How far matched physics is from full: what a renderer would have that leaves out nothing but what
 * the model does. Needs all four references. */
abbe_result abbe_sweep_model_measure(const abbe_sweep *sweep, abbe_sweep_model *out,
                                     abbe_error *error);

#endif
