#include "cli/view/picture/view_show.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void find_dominant(abbe_view_probe *out) {
  static const double white[2] = {0.31272, 0.32903}, least = 1e-4;
  abbe_dominant found;
  out->dominant_nm = out->purity = 0;
  if (hypot(out->xy[0] - white[0], out->xy[1] - white[1]) < least) return;
  if (!abbe_chromaticity_dominant(out->xy, white, ABBE_OBSERVER_CIE_1931, &found)) return;
  out->dominant_nm = isfinite(found.lambda_nm) ? found.lambda_nm : -found.complementary_nm;
  out->purity = fmin(1, found.purity);
}

/* The traced picture's bands: S0.…nm, and stderr.S0.…nm beside them. */
static void read_bands(const abbe_image *image, size_t at, abbe_view_probe *out) {
  for (size_t c = 0; c < image->channels && out->bands < ABBE_VIEW_PROBE_BANDS; c++) {
    const char *name = image->channel[c];
    char error_name[64];
    if (!abbe_image_band_middle(name, &out->nm[out->bands])) continue;
    snprintf(error_name, sizeof error_name, "stderr.%.50s", name);
    const size_t e = abbe_image_find_channel(image, error_name);
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
  const size_t side = out->traced || p->coarse == 0 ? 1 : p->coarse;
  const size_t x = pixel[0] / side, y = (pixel[1] + (side > 1 ? p->beyond : 0)) / side;
  size_t channel[3];
  if (image->data == NULL || !abbe_view_channels(image, "", channel) || x >= image->width ||
      y >= image->height)
    return;
  const size_t at = y * image->width + x;
  for (size_t k = 0; k < 3; k++) rgb[k] = (double)image->data[at * image->channels + channel[k]];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  abbe_rgb_space_apply(matrix, rgb, out->xyz);
  const double sum = out->xyz[0] + out->xyz[1] + out->xyz[2];
  out->coloured = sum > 0 && out->xyz[1] > 0;
  if (out->traced) read_bands(image, at, out);
  if (!out->coloured) return;
  out->xy[0] = out->xyz[0] / sum;
  out->xy[1] = out->xyz[1] / sum;
  abbe_chromaticity_uv_of_xy(out->xy, out->uv);
  find_dominant(out);
}

void abbe_view_probe_take_spot(abbe_view_probe *probe, size_t passes, const abbe_view_spot *spot) {
  if (spot->bands == 0 || (probe->bands > 0 && passes >= spot->passes)) return;
  probe->bands = spot->bands;
  memcpy(probe->nm, spot->nm, sizeof spot->nm);
  memcpy(probe->radiance, spot->radiance, sizeof spot->radiance);
  memcpy(probe->stderr_of, spot->stderr_of, sizeof spot->stderr_of);
}

bool abbe_view_probe_shows_caustic(const abbe_image *layers, const float *pixel) {
  static const char *const names[2][3] = {{"direct.R", "direct.G", "direct.B"},
                                          {"caustic.R", "caustic.G", "caustic.B"}};
  double sum[2] = {0};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) {
      const size_t at = abbe_image_find_channel(layers, names[i][k]);
      if (at != (size_t)-1) sum[i] += fabs((double)pixel[at]);
    }
  return sum[1] > 0.01 * sum[0];
}

bool abbe_view_probe_find_hue(const abbe_view_pictures *pictures, const double nm[2],
                              const double part[4], double xy[2]) {
  const abbe_image *image = &pictures->rendered;
  const abbe_view_pictures rendered = {.rendered = *image};
  const double side = pictures->coarse > 1 ? (double)pictures->coarse : 1;
  const double beyond = pictures->coarse > 1 ? (double)pictures->beyond : 0;
  double best = 0;
  for (size_t y = 0; image->data != NULL && y < image->height; y++)
    for (size_t x = 0; x < image->width; x++) {
      abbe_view_probe probe;
      const double at[2] = {side * ((double)x + 0.5), side * ((double)y + 0.5) - beyond};
      const float *v = &image->data[image->channels * (y * image->width + x)];
      if (at[0] < part[0] || at[1] < part[1] || at[0] > part[2] || at[1] > part[3]) continue;
      if (!(fmaxf(v[0], fmaxf(v[1], v[2])) > 1.5F * fminf(v[0], fminf(v[1], v[2])))) continue;
      abbe_view_probe_make(&rendered, (const size_t[2]){x, y}, &probe);
      if (probe.dominant_nm < nm[0] || probe.dominant_nm > nm[1]) continue;
      if (probe.purity * probe.xyz[1] <= best) continue;
      best = probe.purity * probe.xyz[1];
      xy[0] = at[0];
      xy[1] = at[1];
    }
  return best > 0;
}
