#include "validation/trace/transport/bands.h"

#include "colorimetry/image/image.h"

#include <stdio.h>
#include <stdlib.h>

abbe_result abbe_bands_make(const abbe_spectral_sampling *s, size_t count, abbe_bands *out,
                            abbe_error *error) {
  *out = (abbe_bands){0};
  if (count > ABBE_BANDS_MAX)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%zu bands are too many: at most %d", count,
                          ABBE_BANDS_MAX);
  if (count == 0) return ABBE_OK;
  double low = s->lambda_nm[0], width = (s->lambda_nm[s->steps] - low) / (double)count;
  abbe_bands b = {.count = count, .width_nm = width};
  b.middle_nm = calloc(count, sizeof *b.middle_nm);
  b.of_step = calloc(s->steps, sizeof *b.of_step);
  b.power = calloc(s->lights * count + 1, sizeof *b.power);
  *out = b;
  if (b.middle_nm == NULL || b.of_step == NULL || b.power == NULL) {
    abbe_bands_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu bands", count);
  }
  for (size_t i = 0; i < count; i++) b.middle_nm[i] = low + width * ((double)i + 0.5);
  for (size_t k = 0; k < s->steps; k++) {
    double at = (0.5 * (s->lambda_nm[k] + s->lambda_nm[k + 1]) - low) / width;
    size_t band = at < (double)count ? (size_t)at : count - 1;
    b.of_step[k] = (uint16_t)band;
  }
  for (size_t l = 0; l < s->lights; l++) {
    double share[ABBE_BANDS_MAX] = {0};
    for (size_t k = 0; k < s->steps; k++)
      share[b.of_step[k]] += (double)s->power[l * s->steps + k] / (double)s->steps;
    for (size_t i = 0; i < count; i++) b.power[l * count + i] = (float)(share[i] / width);
  }
  return ABBE_OK;
}

void abbe_bands_free(abbe_bands *b) {
  if (b == NULL) return;
  free(b->middle_nm);
  free(b->of_step);
  free(b->power);
  *b = (abbe_bands){0};
}

void abbe_bands_name(const abbe_bands *bands, size_t band, char *out, size_t size) {
  abbe_image_band_name(bands->middle_nm[band], out, size);
}
