/* sweep_trace.h: the tracer as a contestant of a sweep: its picture by so many passes, and how long
 * that takes once the scene stands.
 *
 * What is made once for a scene (geometry, tables, where lights aim) is not in the times, as what a
 * renderer prepares is not. It compares nothing.
 */
#ifndef ABBE_LIBRARY_CHOICE_SWEEP_TRACE_H
#define ABBE_LIBRARY_CHOICE_SWEEP_TRACE_H

#include "colorimetry/image/image.h"
#include "gl/plan/facts/render_desc.h"
#include "scenes/scene.h"
#include "validation/tradeoff/sweep_table.h"

/* The seed of all traced contestants; references have other noise. */
#define ABBE_SWEEP_TRACE_SEED 20261u

typedef struct abbe_sweep_trace_desc {
  size_t width, height;          /* pixels; 0: the scene's */
  size_t frames;                 /* behind the median; 0: 5; three where they took over enough_ms */
  double enough_ms;              /* 0: all are traced */
  abbe_render_progress progress; /* or NULL */
  void *user;
} abbe_sweep_trace_desc;

/* Sets frame_ms, fastest_ms, light_ms, eye_ms and (of an even number of passes that are not
 * filtered) own_de of the row, whose setting is traced, and gives the picture (may be NULL).
 * ABBE_INVALID_ARGUMENT for a setting that is not traced; ABBE_CANCELLED; errors of
 * abbe_tracer_make and abbe_tracer_pass. */
abbe_result abbe_sweep_trace_measure(const abbe_scene *scene, const abbe_sweep_trace_desc *desc,
                                     abbe_sweep_row *row, abbe_image *picture, abbe_error *error);

/* Whether the tracer knows the scene. Errors of abbe_tracer_make. */
abbe_result abbe_sweep_trace_check(const abbe_scene *scene, abbe_error *error);

#endif
