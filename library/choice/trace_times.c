#include "library/choice/trace_times.h"

#include "base/clock.h"
#include "gl/accuracy/frame_times.h"
#include "validation/measure/compare.h"
#include "validation/trace/denoise.h"
#include "validation/trace/tracer/tracer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { USUAL_FRAMES = 5, FEW_FRAMES = 3 };

typedef struct frame {
  double ms, light_ms, eye_ms;
} frame;

/* The picture of a tracer with guides becomes what abbe_denoise_picture makes of it. */
static abbe_result filter(abbe_image *picture, abbe_error *error) {
  abbe_image filtered = {0};
  const abbe_denoise_desc desc = {0};
  abbe_result result = abbe_denoise_picture(picture, &desc, &filtered, error);
  if (result != ABBE_OK) return result;
  abbe_image_free(picture);
  *picture = filtered;
  return ABBE_OK;
}

static abbe_trace_desc describe(const abbe_trace_times_desc *desc) {
  return (abbe_trace_desc){.no_map = true,
                           .guides = desc->filtered,
                           .width = desc->width,
                           .height = desc->height,
                           .photons = desc->photons * desc->photons,
                           .seed = ABBE_TRACE_TIMES_SEED};
}

static bool go_on(const abbe_trace_times_desc *desc, double done) {
  return desc->progress == NULL || desc->progress(desc->user, done);
}

static abbe_result trace(const abbe_scene *scene, const abbe_trace_times_desc *desc, double done,
                         frame *out, abbe_image *half, abbe_image *picture, abbe_error *error) {
  abbe_tracer *tracer = NULL;
  abbe_trace_statistics statistics;
  const abbe_trace_desc own = describe(desc);
  double copied = 0; /* half of it, which no frame has to do */
  abbe_image_free(half);
  abbe_image_free(picture);
  abbe_result result = abbe_tracer_make(scene, &own, &tracer, error);
  const double start = abbe_clock_seconds();
  for (size_t i = 0; i < desc->passes && result == ABBE_OK; i++) {
    if (!go_on(desc, done)) result = abbe_error_set(error, ABBE_CANCELLED, "stopped");
    if (result == ABBE_OK) result = abbe_tracer_pass(tracer, NULL, error);
    if (result != ABBE_OK || 2 * (i + 1) != desc->passes || desc->filtered) continue;
    copied = abbe_clock_seconds();
    result = abbe_tracer_picture(tracer, half, error);
    copied = abbe_clock_seconds() - copied;
  }
  if (result == ABBE_OK) result = abbe_tracer_picture(tracer, picture, error);
  if (result == ABBE_OK && desc->filtered) result = filter(picture, error);
  const double end = abbe_clock_seconds();
  if (result == ABBE_OK) {
    abbe_tracer_statistics(tracer, &statistics);
    *out =
        (frame){1e3 * (end - start), 1e3 * statistics.light_seconds, 1e3 * statistics.eye_seconds};
  }
  abbe_tracer_free(tracer);
  return result;
}

static int compare_frames(const void *a, const void *b) {
  const frame *x = a, *y = b;
  return (x->ms > y->ms) - (x->ms < y->ms);
}

static abbe_result copy_image(const abbe_image *in, abbe_image *out) {
  const size_t count = in->width * in->height * in->channels;
  abbe_result result = abbe_image_make(in->width, in->height, in->channels,
                                       (const char *const *)in->channel, out, NULL);
  if (result != ABBE_OK) return result;
  memcpy(out->data, in->data, count * sizeof *out->data);
  memcpy(out->xy, in->xy, sizeof out->xy);
  return ABBE_OK;
}

/* The mean over 9 x 9 pixels of the channels that hold the caustic: of few photons the brightest
 * pixels are those that were hit, so without it the region would leave out where light is dim. */
static void smooth_caustic(const abbe_image *in, abbe_image *out) {
  enum { REACH = 4 };
  const size_t w = in->width, h = in->height, n = in->channels;
  for (size_t c = 0; c < n; c++) {
    if (strncmp(in->channel[c], "caustic.", 8) != 0) continue;
    for (size_t y = 0; y < h; y++) {
      for (size_t x = 0; x < w; x++) {
        const size_t x0 = x > REACH ? x - REACH : 0, x1 = x + REACH < w ? x + REACH : w - 1;
        const size_t y0 = y > REACH ? y - REACH : 0, y1 = y + REACH < h ? y + REACH : h - 1;
        float sum = 0;
        for (size_t j = y0; j <= y1; j++)
          for (size_t i = x0; i <= x1; i++) sum += in->data[(j * w + i) * n + c];
        out->data[(y * w + x) * n + c] = sum / (float)((x1 - x0 + 1) * (y1 - y0 + 1));
      }
    }
  }
}

/* The mean of all passes less that of half of them varies as the mean of all does, colours and
 * neighbours together, which standard errors of channels do not contain. */
static double own_error(const abbe_image *half, const abbe_image *picture) {
  static const char name[] = "the picture";
  abbe_field a = {0}, b = {0}, smooth = {0};
  abbe_image copy = {0};
  abbe_mask mask = {0};
  abbe_comparison c;
  const abbe_compare_options options = {.mask = &mask};
  double own = NAN;
  if (copy_image(picture, &copy) != ABBE_OK) return own;
  smooth_caustic(picture, &copy);
  if (abbe_field_make(picture, name, &a, NULL) == ABBE_OK &&
      abbe_field_make(half, name, &b, NULL) == ABBE_OK &&
      abbe_field_make(&copy, name, &smooth, NULL) == ABBE_OK &&
      abbe_mask_make_caustic(&smooth, name, ABBE_MASK_CAUSTIC_SHARE, &mask, NULL) == ABBE_OK &&
      abbe_compare(&a, &b, &options, &c, NULL) == ABBE_OK) {
    own = c.mask.metric[ABBE_COMPARE_CIEDE2000_MEAN].value;
    abbe_comparison_free(&c);
  }
  abbe_mask_free(&mask);
  abbe_field_free(&a);
  abbe_field_free(&b);
  abbe_field_free(&smooth);
  abbe_image_free(&copy);
  return own;
}

abbe_result abbe_trace_times_measure(const abbe_scene *scene, const abbe_trace_times_desc *desc,
                                     abbe_trace_times *out, abbe_image *picture,
                                     abbe_error *error) {
  frame frames[ABBE_FRAME_TIMES_MAX];
  abbe_image image = {0}, half = {0};
  size_t count = desc->frames > 0 ? desc->frames : USUAL_FRAMES, done = 0;
  double spent = 0;
  *out = (abbe_trace_times){NAN, NAN, NAN, NAN, NAN};
  if (desc->passes < (desc->filtered ? 2 : 1) || desc->photons < 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu passes of %zu x %zu photons are too few to trace%s", desc->passes,
                          desc->photons, desc->photons, desc->filtered ? " and filter" : "");
  if (count > ABBE_FRAME_TIMES_MAX) count = ABBE_FRAME_TIMES_MAX;
  abbe_result result = ABBE_OK;
  while (done < count && result == ABBE_OK) {
    if (desc->enough_ms > 0 && spent > desc->enough_ms && done >= FEW_FRAMES) break;
    result = trace(scene, desc, (double)done / (double)count, &frames[done], &half, &image, error);
    if (result == ABBE_OK) spent += frames[done++].ms;
  }
  if (result == ABBE_OK && half.data != NULL) out->own_de = own_error(&half, &image);
  abbe_image_free(&half);
  if (result != ABBE_OK) {
    abbe_image_free(&image);
    return result;
  }
  qsort(frames, done, sizeof *frames, compare_frames);
  out->frame_ms = frames[done / 2].ms;
  out->fastest_ms = frames[0].ms;
  out->light_ms = frames[done / 2].light_ms;
  out->eye_ms = frames[done / 2].eye_ms;
  if (picture != NULL)
    *picture = image;
  else
    abbe_image_free(&image);
  return ABBE_OK;
}
