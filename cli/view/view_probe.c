#include "cli/view/view_probe.h"

#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOCUS_FROM_NM 380
#define LOCUS_TO_NM 700

void abbe_view_locus(double lambda_nm, double xy[2]) {
  double xyz[3];
  abbe_observer_xyz(lambda_nm, xyz);
  const double sum = xyz[0] + xyz[1] + xyz[2];
  xy[0] = xyz[0] / sum;
  xy[1] = xyz[1] / sum;
}

void abbe_view_uv(const double xy[2], double uv[2]) {
  const double d = -2 * xy[0] + 12 * xy[1] + 3;
  uv[0] = 4 * xy[0] / d;
  uv[1] = 9 * xy[1] / d;
}

/* Where the ray from white along `to` meets the side from a to b: how far along the ray in its own
 * length, and how far along the side; false where it does not. */
static bool meet(const double white[2], const double to[2], const double a[2], const double b[2],
                 double *along, double *share) {
  const double s[2] = {b[0] - a[0], b[1] - a[1]}, w[2] = {a[0] - white[0], a[1] - white[1]};
  const double d = to[0] * s[1] - to[1] * s[0];
  if (d == 0) return false;
  *along = (w[0] * s[1] - w[1] * s[0]) / d;
  *share = (w[0] * to[1] - w[1] * to[0]) / d;
  return *along > 0 && *share >= 0 && *share <= 1;
}

static double cross_locus(const double white[2], const double to[2], double *along) {
  for (int nm = LOCUS_FROM_NM; nm < LOCUS_TO_NM; nm++) {
    double a[2], b[2], share;
    abbe_view_locus(nm, a);
    abbe_view_locus(nm + 1, b);
    if (meet(white, to, a, b, along, &share)) return nm + share;
  }
  return 0;
}

static void find_dominant(abbe_view_probe *out) {
  static const double white[2] = {0.31272, 0.32903}, least = 1e-4;
  const double to[2] = {out->xy[0] - white[0], out->xy[1] - white[1]};
  const double back[2] = {-to[0], -to[1]};
  double along = 1, other, share, a[2], b[2];
  out->dominant_nm = out->purity = 0;
  if (hypot(to[0], to[1]) < least) return;
  out->dominant_nm = cross_locus(white, to, &along);
  if (out->dominant_nm == 0) {
    out->dominant_nm = -cross_locus(white, back, &other);
    abbe_view_locus(LOCUS_FROM_NM, a);
    abbe_view_locus(LOCUS_TO_NM, b);
    if (!meet(white, to, a, b, &along, &share)) along = 1;
  }
  out->purity = fmin(1, 1 / along);
}

/* The traced picture's bands: S0.…nm, and stderr.S0.…nm beside them. */
static void read_bands(const abbe_image *image, size_t at, abbe_view_probe *out) {
  for (size_t c = 0; c < image->channels && out->bands < ABBE_VIEW_PROBE_BANDS; c++) {
    const char *name = image->channel[c];
    char error_name[64];
    if (strncmp(name, "S0.", 3) != 0) continue;
    snprintf(error_name, sizeof error_name, "stderr.%.50s", name);
    const size_t e = abbe_image_find_channel(image, error_name);
    const double whole = (double)strtol(name + 3, NULL, 10);
    const char *comma = strchr(name, ',');
    const double part = comma != NULL ? (double)strtol(comma + 1, NULL, 10) / 1e6 : 0;
    out->nm[out->bands] = whole + part;
    out->radiance[out->bands] = (double)image->data[at * image->channels + c];
    out->stderr_of[out->bands] =
        e != (size_t)-1 ? (double)image->data[at * image->channels + e] : 0;
    out->bands++;
  }
}

void abbe_view_probe_make(const abbe_view_pictures *p, const size_t pixel[2],
                          abbe_view_probe *out) {
  const abbe_image *image = p->traced.data != NULL ? &p->traced : &p->rendered;
  double matrix[9], rgb[3];
  *out = (abbe_view_probe){.traced = p->traced.data != NULL};
  size_t channel[3];
  if (image->data == NULL || !abbe_view_channels(image, "", channel) || pixel[0] >= image->width ||
      pixel[1] >= image->height)
    return;
  const size_t at = pixel[1] * image->width + pixel[0];
  for (size_t k = 0; k < 3; k++) rgb[k] = (double)image->data[at * image->channels + channel[k]];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  abbe_rgb_space_apply(matrix, rgb, out->xyz);
  const double sum = out->xyz[0] + out->xyz[1] + out->xyz[2];
  out->coloured = sum > 0 && out->xyz[1] > 0;
  if (out->traced) read_bands(image, at, out);
  if (!out->coloured) return;
  out->xy[0] = out->xyz[0] / sum;
  out->xy[1] = out->xyz[1] / sum;
  abbe_view_uv(out->xy, out->uv);
  find_dominant(out);
}
