#include "cli/view/picture/view_feed.h"

#include "base/clock.h"
#include "base/maths.h"
#include "cli/view/state/view_camera.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <stdlib.h>

static bool goes_on(void *user, double done) {
  const volatile int *stop = user;
  (void)done;
  return *stop == 0;
}

/* One batch of a light's wavelengths. last: no other follows. Where the next begins: with the last
 * one of this. */
static abbe_result add_batch(abbe_renderer *renderer, size_t light, size_t first, bool alone,
                             volatile int *stop, abbe_view_feed *feed, size_t *next,
                             abbe_error *error) {
  const size_t wavelengths = abbe_renderer_plan(renderer)->desc.wavelengths;
  abbe_renderer_hits hits;
  ABBE_TRY(abbe_renderer_read_hits(renderer, light, first, goes_on, (void *)stop, &hits, error));
  const bool last = first + hits.samples >= wavelengths;
  const abbe_view_hits batch = {.at = hits.at,
                                .path = hits.path,
                                .cell = hits.cell,
                                .count = hits.count,
                                .slots = hits.slots,
                                .samples = hits.samples,
                                .grid = {hits.grid[0], hits.grid[1]},
                                .last = last || alone,
                                .stop = stop,
                                .view = hits.view};
  abbe_result result = abbe_view_feed_add(feed, &batch, error);
  *next = last || hits.samples < 2 ? first + hits.samples : first + hits.samples - 1;
  abbe_renderer_hits_free(&hits);
  return result;
}

/* The number of the wavelength before this one. */
static size_t wavelength_before(const abbe_render_desc *desc, double nm) {
  const double share = (nm - desc->min_nm) / (desc->max_nm - desc->min_nm);
  return (size_t)(fmin(fmax(share, 0), 1) * (double)(desc->wavelengths - 1));
}

/* Adds all lights: a batch about a wavelength, or all of them. */
static abbe_result add_lights(abbe_renderer *renderer, double nm, bool all, volatile int *stop,
                              abbe_view_feed *feed, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  const size_t most = plan->desc.wavelengths;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < plan->light_view_count; i++) {
    size_t first = all ? 0 : wavelength_before(&plan->desc, nm);
    while (plan->reaches[i] && first < most && result == ABBE_OK && !*stop) {
      result = add_batch(renderer, i, first, !all, stop, feed, &first, error);
      if (!all) break;
    }
  }
  return result;
}

abbe_result abbe_view_look_feed(abbe_renderer *renderer, const abbe_scene *scene,
                                const double point[3], double radius, double nm, volatile int *stop,
                                abbe_view_feed *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  abbe_view_feed_begin(point, radius, out);
  if (abbe_view_feed_look(out, scene, nm)) {
    result = add_lights(renderer, nm, false, stop, out, error);
    if (result == ABBE_OK && out->photons == 0)
      result = add_lights(renderer, nm, true, stop, out, error);
  }
  abbe_view_feed_end(out, scene, stop);
  if (result != ABBE_OK || !*stop) return result;
  return abbe_error_set(error, ABBE_CANCELLED, "the look was cancelled");
}

/* For photons alone: the smallest picture. */
static abbe_render_desc desc_of(const abbe_renderer *renderer, volatile int *stop) {
  abbe_render_desc desc = abbe_renderer_plan(renderer)->desc;
  desc.width = desc.height = 16;
  desc.supersample = desc.receiver_samples = desc.adaptive = 1;
  desc.upsample = 0;
  desc.history = 0;
  desc.aovs = false;
  desc.coarse = ABBE_COARSE_NONE;
  desc.progress = goes_on;
  desc.progress_user = (void *)stop;
  return desc;
}

abbe_result abbe_view_look_closer(abbe_context *context, const abbe_renderer *renderer,
                                  const abbe_scene *scene, const double point[3], double radius,
                                  double nm, volatile int *stop, abbe_view_feed *out,
                                  abbe_error *error) {
  abbe_render_desc desc = desc_of(renderer, stop);
  abbe_renderer *closer = NULL;
  abbe_result result = ABBE_OK;
  for (desc.photons *= 2; desc.photons <= ABBE_VIEW_LOOK_PHOTONS && result == ABBE_OK;
       desc.photons *= 2) {
    if (desc.map_size < 2 * desc.photons) desc.map_size = 2 * desc.photons; /* keeps all cells */
    result = closer == NULL ? abbe_renderer_make(context, scene, &desc, &closer, error)
                            : abbe_renderer_change(closer, scene, &desc, error);
    if (result == ABBE_OK)
      result = abbe_view_look_feed(closer, scene, point, radius, nm, stop, out, error);
    if (out->photons > 0) break;
  }
  abbe_renderer_free(closer);
  return result;
}

abbe_result abbe_view_look_map(abbe_renderer *renderer, abbe_image *out, abbe_error *error) {
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  *out = (abbe_image){0};
  for (size_t i = 0; i < plan->light_view_count; i++)
    if (plan->reaches[i]) return abbe_renderer_read_map(renderer, i, false, out, error);
  return ABBE_OK;
}

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
  ABBE_TRY(abbe_tracer_pass(tracer, stop, error));
  ABBE_TRY(abbe_tracer_picture(tracer, &picture, error));
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
