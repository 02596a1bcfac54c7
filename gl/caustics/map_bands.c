#include "gl/caustics/caustics.h"

#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 32 };

static abbe_result make_image(const abbe_render_desc *desc, size_t bands, abbe_image *out,
                              abbe_error *error) {
  char(*name)[NAME_SIZE] = calloc(bands, sizeof *name);
  const char **names = calloc(3 + bands, sizeof *names);
  abbe_result result = ABBE_OK;
  if (name == NULL || names == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu bands", bands);
  if (result == ABBE_OK) {
    const double min = desc->min_nm, width = (desc->max_nm - min) / (double)bands;
    names[0] = "X";
    names[1] = "Y";
    names[2] = "Z";
    for (size_t i = 0; i < bands; i++) {
      abbe_image_band_name(min + width * ((double)i + 0.5), name[i], sizeof name[i]);
      names[3 + i] = name[i];
    }
    const size_t side = desc->map_size;
    result = abbe_image_make(side, side, 3 + bands, names, out, error);
  }
  free(names);
  free(name);
  return result;
}

/* The map's three sums as it stands, into the channels from `first` on. */
static abbe_result read_three(const abbe_caustics *c, size_t light, double unit, double factor,
                              size_t first, abbe_image *out, abbe_error *error) {
  abbe_image map = {0};
  ABBE_TRY(abbe_spectral_map_read(c->map, light, unit, &map, error));
  for (size_t i = 0; i < map.width * map.height; i++)
    for (size_t k = 0; k < 3 && first + k < out->channels; k++)
      out->data[i * out->channels + first + k] = (float)(factor * (double)map.data[3 * i + k]);
  abbe_image_free(&map);
  return ABBE_OK;
}

static abbe_result sum_again(abbe_caustics *c, size_t bands, size_t first, abbe_error *error) {
  double untimed_ms = 0;
  abbe_result result = abbe_photon_spectra_weigh(&c->spectra, bands, first, error);
  memset(c->measured, 0, sizeof c->measured);
  return result == ABBE_OK ? abbe_caustics_run(c, &untimed_ms, error) : result;
}

abbe_result abbe_map_bands_read(abbe_caustics *c, size_t light, size_t bands, double unit,
                                abbe_image *out, abbe_error *error) {
  const abbe_render_desc *desc = &c->views->scene->plan->desc;
  const double width = (desc->max_nm - desc->min_nm) / (double)bands;
  abbe_result result = make_image(desc, bands, out, error);
  if (result == ABBE_OK) result = read_three(c, light, unit, 1, 0, out, error);
  for (size_t first = 0; first < bands && result == ABBE_OK; first += 3) {
    result = sum_again(c, bands, first, error);
    if (result == ABBE_OK) result = read_three(c, light, unit, 1 / width, 3 + first, out, error);
  }
  const abbe_result restored = sum_again(c, 0, 0, result == ABBE_OK ? error : NULL);
  if (result == ABBE_OK) result = restored;
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_XYZ, out->xy);
  return result;
}
