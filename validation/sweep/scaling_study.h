/* scaling_study.h: how a frame's time grows: with photons, wavelengths, pixels, faces, and the
 * refractors' share of the view.
 *
 * From one setting of the default profile one thing is changed at a time, and the frame is timed as
 * a sweep times it. Faces are those of the refractors, each cut into four alike, so the shape
 * stays; the share of the view grows by a narrower field of view. It compares with no reference.
 */
#ifndef ABBE_VALIDATION_SWEEP_SCALING_STUDY_H
#define ABBE_VALIDATION_SWEEP_SCALING_STUDY_H

#include "validation/sweep/sweep_measure.h"

#include <stdio.h>

/* X(code, name, text): what is changed, and the unit of its numbers. */
#define ABBE_SCALINGS(X)                                                                           \
  X(PHOTONS, "photons", "cells of the photon grid")                                                \
  X(WAVELENGTHS, "wavelengths", "wavelengths")                                                     \
  X(PIXELS, "pixels", "pixels")                                                                    \
  X(FACES, "faces", "faces of the refractors")                                                     \
  X(SHARE, "share", "refractors' share of the view, 1: the scene's own")

typedef enum abbe_scaling_study_axis {
#define ABBE_SWEEP_ENUM(code, name, text) ABBE_SCALING_##code,
  ABBE_SCALINGS(ABBE_SWEEP_ENUM)
#undef ABBE_SWEEP_ENUM
      ABBE_SCALING_COUNT
} abbe_scaling_study_axis;

#define ABBE_SCALING_MAX 40

typedef struct abbe_scaling_study_point {
  abbe_scaling_study_axis axis;
  double x;
  double frame_ms, light_ms, eye_ms, baseline_ms; /* medians */
} abbe_scaling_study_point;

typedef struct abbe_scaling_study {
  char scene[256], base[200]; /* the setting that is changed */
  size_t count;
  abbe_scaling_study_point point[ABBE_SCALING_MAX]; /* axis by axis, x rising */
  double base_x[ABBE_SCALING_COUNT];
} abbe_scaling_study;

/* The base setting has `side` pixels square (16 to 2048, a multiple of 8), half as many photons a
 * side, a map of twice as many texels, 7 wavelengths; sweep's references are not looked at. The
 * scene's camera and refractors' meshes are changed on the way and are as before in the end. Errors
 * of abbe_renderer_make. */
abbe_result abbe_scaling_study_measure(const abbe_sweep *sweep, abbe_scene *scene, size_t side,
                                       abbe_render_progress progress, void *user,
                                       abbe_scaling_study *out, abbe_error *error);

/* Slope of log time against log x, by least squares: 1 is proportional, 0 free. NaN with fewer than
 * two points. */
double abbe_scaling_study_slope(const abbe_scaling_study *study, abbe_scaling_study_axis axis);

/* CSV: axis, x, frame_ms, light_ms, eye_ms, baseline_ms. A Markdown table on `out`. And a chart
 * (.png or .svg), every x over the base setting's. */
abbe_result abbe_scaling_study_save(const abbe_scaling_study *study, const char *path,
                                    abbe_error *error);
void abbe_scaling_study_print(const abbe_scaling_study *study, FILE *out);
abbe_result abbe_scaling_study_plot(const abbe_scaling_study *study, const char *path,
                                    abbe_error *error);

#endif
