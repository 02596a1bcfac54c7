#include "colorimetry/image/picture_space.h"

#include <stdio.h>
#include <strings.h>

static bool is_stated(const double xy[8]) {
  for (int i = 0; i < 8; i++)
    if (xy[i] != 0) return true;
  return false;
}

static abbe_result find_observer(const abbe_image *image, const char *name, abbe_observer *out,
                                 abbe_error *error) {
  const char *word = abbe_image_attribute_text(image, "abbe:observer");
  *out = word != NULL ? abbe_observer_find(word) : ABBE_OBSERVER_CIE_1931;
  if (*out != ABBE_OBSERVER_COUNT) return ABBE_OK;
  return abbe_error_set(error, ABBE_COLOUR,
                        "%s: its attribute abbe:observer is '%.60s', no observer that is known: "
                        "'%s' is one, and 1964 another",
                        name, word, abbe_observer_text(ABBE_OBSERVER_CIE_1931));
}

abbe_result abbe_picture_space_find(const abbe_image *image, bool is_xyz, const char *name,
                                    abbe_picture_space *out, abbe_error *error) {
  *out = (abbe_picture_space){.space = is_xyz ? ABBE_RGB_SPACE_XYZ : ABBE_RGB_SPACE_COUNT};
  const abbe_result result = find_observer(image, name, &out->observer, error);
  if (result != ABBE_OK) return result;
  const char *word = abbe_image_attribute_text(image, "abbe:space");
  for (int s = 0; out->space == ABBE_RGB_SPACE_COUNT && word && s < ABBE_RGB_SPACE_COUNT; s++)
    if (strcasecmp(word, abbe_rgb_space_name((abbe_rgb_space)s)) == 0)
      out->space = (abbe_rgb_space)s;
  if (word != NULL && out->space == ABBE_RGB_SPACE_COUNT)
    return abbe_error_set(error, ABBE_COLOUR,
                          "%s: its attribute abbe:space is '%.60s', not acescg, rec709 or xyz",
                          name, word);
  if (out->space == ABBE_RGB_SPACE_COUNT && is_stated(image->xy)) {
    abbe_error why = {0};
    out->space = abbe_rgb_space_of_chromaticities(image->xy);
    snprintf(out->text, sizeof out->text, "RGB of the file's chromaticities");
    if (abbe_rgb_space_chromaticities_to_xyz(image->xy, out->to_xyz, &why) != ABBE_OK)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: %.400s", name, why.text);
    if (out->space == ABBE_RGB_SPACE_COUNT) return ABBE_OK;
  }
  out->assumed = out->space == ABBE_RGB_SPACE_COUNT;
  if (out->assumed) out->space = ABBE_RGB_SPACE_REC709;
  snprintf(out->text, sizeof out->text, "%s", abbe_rgb_space_name(out->space));
  abbe_rgb_space_to_xyz(out->space, out->to_xyz);
  return ABBE_OK;
}
