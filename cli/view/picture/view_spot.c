#include "cli/view/picture/view_feed.h"

#include "base/clock.h"
#include "base/maths.h"
#include "cli/view/state/view_camera.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 32, LEAST_PASSES = 4, MOST_PASSES = 16 };

/* The pixel alone: as much of the sphere as it has, at its middle. */
static abbe_camera look_at(const abbe_camera *camera, size_t width, size_t height,
                           const size_t pixel[2]) {
  const double xy[2] = {(double)pixel[0] + 0.5, (double)pixel[1] + 0.5};
  double forward[3], along[3];
  abbe_camera out = *camera;
  abbe_view_camera_point(camera, width, height, xy, 1, out.target);
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_vector_subtract(out.target, camera->eye, along);
  abbe_vector_normalise(forward);
  abbe_vector_normalise(along);
  const double side = 2 * tan(0.5 * camera->fov_y_rad) / (double)height;
  out.fov_y_rad = 2 * atan(0.5 * side * pow(abbe_vector_dot(forward, along), 1.5));
  return out;
}

/* The means over all pixels, and where the bands lie. */
static void read_bands(const abbe_image *image, abbe_view_spot *out, double mean[]) {
  const size_t pixels = image->width * image->height;
  out->bands = 0;
  for (size_t c = 0; c < image->channels && out->bands < ABBE_VIEW_SPOT_BANDS; c++) {
    if (!abbe_image_band_middle(image->channel[c], &out->nm[out->bands])) continue;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) sum += (double)image->data[i * image->channels + c];
    mean[out->bands++] = sum / (double)pixels;
  }
}

/* One pass more; from the means before and after it follows what it alone has shown, so that the
 * spread of passes counts what the pixel's samples have in common. */
static abbe_result add_pass(abbe_tracer *tracer, const volatile int *stop, double before[],
                            double squares[], abbe_view_spot *out, abbe_error *error) {
  abbe_image picture;
  double mean[ABBE_VIEW_SPOT_BANDS];
  abbe_result result = abbe_tracer_pass(tracer, stop, error);
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, &picture, error);
  if (result != ABBE_OK) return result;
  read_bands(&picture, out, mean);
  abbe_image_free(&picture);
  const double n = (double)++out->passes;
  for (size_t k = 0; k < out->bands; k++) {
    const double one = n * mean[k] - (n - 1) * before[k];
    squares[k] += (one - before[k]) * (one - mean[k]); /* squares of differences from the mean */
    before[k] = mean[k];
  }
  return ABBE_OK;
}

abbe_result abbe_view_spot_trace(const abbe_scene *scene, size_t width, size_t height,
                                 const size_t pixel[2], double seconds, const volatile int *stop,
                                 abbe_view_spot *out, abbe_error *error) {
  const double start_s = abbe_clock_seconds();
  const abbe_trace_desc desc = {.no_map = true,
                                .width = SIDE,
                                .height = SIDE,
                                .whole_pixels = width * height,
                                .pixel_sides = SIDE,
                                .bands = ABBE_VIEW_SPOT_BANDS,
                                .stop = stop};
  double before[ABBE_VIEW_SPOT_BANDS] = {0}, squares[ABBE_VIEW_SPOT_BANDS] = {0};
  abbe_tracer *tracer = NULL;
  abbe_scene seen = *scene;
  *out = (abbe_view_spot){0};
  seen.camera = look_at(&scene->camera, width, height, pixel);
  abbe_result result = abbe_tracer_make(&seen, &desc, &tracer, error);
  while (result == ABBE_OK && out->passes < MOST_PASSES &&
         (out->passes < LEAST_PASSES || abbe_clock_seconds() - start_s < seconds))
    result = add_pass(tracer, stop, before, squares, out, error);
  abbe_tracer_free(tracer);
  const double n = (double)out->passes;
  for (size_t k = 0; k < out->bands; k++) {
    out->radiance[k] = before[k];
    out->stderr_of[k] = n > 1 ? sqrt(squares[k] / (n * (n - 1))) : 0;
  }
  if (result != ABBE_OK) out->bands = 0;
  return result;
}
