#include "validation/measure/frame_flicker.h"

#include <math.h>
#include <stdlib.h>

void abbe_frame_flicker_free(abbe_frame_flicker *f) {
  if (f == NULL) return;
  free(f->before);
  *f = (abbe_frame_flicker){0};
}

/* Three channels under one of the names that they have, or false. */
static bool find(const abbe_image *image, bool caustic, size_t channel[3]) {
  static const char *const names[4][3] = {{"R", "G", "B"},
                                          {"X", "Y", "Z"},
                                          {"caustic.R", "caustic.G", "caustic.B"},
                                          {"caustic.X", "caustic.Y", "caustic.Z"}};
  for (int set = caustic ? 2 : 0; set < (caustic ? 4 : 2); set++) {
    bool all = true;
    for (int k = 0; k < 3; k++) {
      channel[k] = abbe_image_find_channel(image, names[set][k]);
      all = all && channel[k] < image->channels;
    }
    if (all) return true;
  }
  return false;
}

static abbe_result begin(abbe_frame_flicker *f, const abbe_image *frame, abbe_error *error) {
  f->width = frame->width;
  f->height = frame->height;
  f->before = calloc(3 * f->width * f->height, sizeof *f->before);
  return f->before != NULL
             ? ABBE_OK
             : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a frame of %zu x %zu pixels",
                              f->width, f->height);
}

static abbe_result check(const abbe_frame_flicker *f, const abbe_image *image, const char *what,
                         size_t channel[3], abbe_error *error) {
  if (image->width != f->width || image->height != f->height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s %zu has %zu x %zu pixels; the first frame has %zu x %zu", what,
                          f->count + 1, image->width, image->height, f->width, f->height);
  if (find(image, f->caustic, channel)) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s %zu has no channels %s", what,
                        f->count + 1, f->caustic ? "caustic.R, caustic.G, caustic.B" : "R, G, B");
}

static double mean_of(const abbe_image *image, const size_t channel[3]) {
  const size_t pixels = image->width * image->height;
  double sum = 0;
  for (size_t i = 0; i < pixels; i++)
    for (int k = 0; k < 3; k++) sum += (double)image->data[i * image->channels + channel[k]];
  return sum / (double)pixels;
}

static void add(abbe_frame_flicker *f, const abbe_image *frame, const size_t from[3],
                const abbe_image *reference, const size_t to[3], abbe_frame_error *out) {
  const double mean = reference != NULL ? mean_of(reference, to) : 0;
  double squares = 0, error = 0, change = 0, all = 0, ghost = 0;
  for (size_t i = 0; i < f->width * f->height; i++) {
    double light = 0, here = 0;
    for (int k = 0; k < 3; k++) {
      const double test = (double)frame->data[i * frame->channels + from[k]];
      const double truth =
          reference != NULL ? (double)reference->data[i * reference->channels + to[k]] : 0;
      float *before = &f->before[3 * i + (size_t)k];
      squares += reference != NULL ? truth * truth : test * test;
      error += (test - truth) * (test - truth);
      change += pow(test - truth - (double)*before, 2);
      *before = (float)(test - truth);
      light += truth;
      here += test;
    }
    all += light;
    if (light <= ABBE_FRAME_FLICKER_DARK * mean) ghost += here;
  }
  out->error = reference != NULL ? sqrt(error / squares) : NAN;
  out->change = f->count > 0 ? sqrt(change / squares) : NAN;
  out->ghost = reference != NULL ? ghost / all : NAN;
}

abbe_result abbe_frame_flicker_add(abbe_frame_flicker *f, const abbe_image *frame,
                                   const abbe_image *reference, abbe_frame_error *out,
                                   abbe_error *error) {
  size_t from[3], to[3] = {0, 0, 0};
  abbe_result result = f->before == NULL ? begin(f, frame, error) : ABBE_OK;
  if (result == ABBE_OK) result = check(f, frame, "frame", from, error);
  if (result == ABBE_OK && reference != NULL) result = check(f, reference, "reference", to, error);
  if (result != ABBE_OK) return result;
  add(f, frame, from, reference, to, out);
  f->count++;
  return ABBE_OK;
}

static void add_square(double x, double *sum, size_t *known) {
  if (isnan(x)) return;
  *sum += x * x;
  ++*known;
}

void abbe_frame_flicker_sum_up(const abbe_frame_error *row, size_t count, abbe_frame_error *out) {
  double sum[3] = {0}, mean[3];
  size_t known[3] = {0};
  for (size_t i = 0; i < count; i++) {
    add_square(row[i].error, &sum[0], &known[0]);
    add_square(row[i].change, &sum[1], &known[1]);
    add_square(row[i].ghost, &sum[2], &known[2]);
  }
  for (int k = 0; k < 3; k++) mean[k] = known[k] > 0 ? sqrt(sum[k] / (double)known[k]) : NAN;
  *out = (abbe_frame_error){mean[0], mean[1], mean[2]};
}

/* NaN gives way to any number. */
void abbe_frame_flicker_largest(const abbe_frame_error *row, size_t count, abbe_frame_error *out) {
  *out = (abbe_frame_error){NAN, NAN, NAN};
  for (size_t i = 0; i < count; i++) {
    out->error = fmax(out->error, row[i].error);
    out->change = fmax(out->change, row[i].change);
    out->ghost = fmax(out->ghost, row[i].ghost);
  }
}
