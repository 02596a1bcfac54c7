#include "gl/renderer.h"

#include "gl/renderer_state.h"

#include <stdlib.h>

enum { NAME_SIZE = 32 };

static abbe_result make_image(const abbe_renderer *r, size_t bands, abbe_image *out,
                              abbe_error *error) {
  char(*name)[NAME_SIZE] = calloc(bands, sizeof *name);
  const char **names = calloc(3 + bands, sizeof *names);
  abbe_result result = ABBE_OK;
  if (name == NULL || names == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu bands", bands);
  if (result == ABBE_OK) {
    const double min = r->plan.desc.min_nm, width = (r->plan.desc.max_nm - min) / (double)bands;
    names[0] = "X";
    names[1] = "Y";
    names[2] = "Z";
    for (size_t i = 0; i < bands; i++) {
      abbe_image_band_name(min + width * ((double)i + 0.5), name[i], sizeof name[i]);
      names[3 + i] = name[i];
    }
    const size_t side = r->plan.desc.map_size;
    result = abbe_image_make(side, side, 3 + bands, names, out, error);
  }
  free(names);
  free(name);
  return result;
}

/* The map's three sums as it stands, into the channels from `first` on. */
static abbe_result read_three(abbe_renderer *r, size_t light, double factor, size_t first,
                              abbe_image *out, abbe_error *error) {
  abbe_image map = {0};
  abbe_result result = abbe_renderer_read_map(r, light, true, &map, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < map.width * map.height; i++)
    for (size_t c = 0; c < 3 && first + c < out->channels; c++)
      out->data[i * out->channels + first + c] = (float)(factor * (double)map.data[3 * i + c]);
  abbe_image_free(&map);
  return ABBE_OK;
}

static abbe_result sum_again(abbe_renderer *r, size_t bands, size_t first, abbe_error *error) {
  abbe_result result = abbe_renderer_weigh_bands(r, bands, first, error);
  if (result != ABBE_OK) return result;
  abbe_renderer_bind_tables(r);
  return abbe_renderer_photons(r, NULL, NULL, error);
}

abbe_result abbe_renderer_read_map_bands(abbe_renderer *r, size_t light, size_t bands,
                                         abbe_image *out, abbe_error *error) {
  ABBE_REQUIRE(r && out, error);
  *out = (abbe_image){0};
  if (bands < 1 || bands > ABBE_RENDER_MAX_BANDS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a map of %zu bands; it may have 1 to %d",
                          bands, ABBE_RENDER_MAX_BANDS);
  if (abbe_profile_is_thesis(r->plan.desc.profile))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thesis's passes sum colours; bands go with the default profile");
  const double width = (r->plan.desc.max_nm - r->plan.desc.min_nm) / (double)bands;
  abbe_result result = abbe_renderer_check_map(r, light, error);
  if (result != ABBE_OK) return result;
  result = make_image(r, bands, out, error);
  if (result == ABBE_OK) result = read_three(r, light, 1, 0, out, error);
  for (size_t first = 0; first < bands && result == ABBE_OK; first += 3) {
    result = sum_again(r, bands, first, error);
    if (result == ABBE_OK) result = read_three(r, light, 1 / width, 3 + first, out, error);
  }
  const abbe_result restored = sum_again(r, 0, 0, result == ABBE_OK ? error : NULL);
  if (result == ABBE_OK) result = restored;
  abbe_map_layout layout;
  abbe_renderer_map_layout(r, light, &layout);
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_XYZ, out->xy);
  if (result == ABBE_OK)
    result = abbe_map_layout_write(&layout, r->scene->light[light].name, out, error);
  if (result != ABBE_OK) abbe_image_free(out);
  return result;
}
