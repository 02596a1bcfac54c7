#include "library/lib_weights.h"

#include "colorimetry/weights.h"
#include "library/lib_handles.h"

#include <string.h>
#include <strings.h>

static abbe_result find_space(const char *text, abbe_rgb_space *out, abbe_error *error) {
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
    *out = (abbe_rgb_space)s;
    if (strcasecmp(text, abbe_rgb_space_name(*out)) == 0) return ABBE_OK;
  }
  return abbe_error_set(error, ABBE_NOT_FOUND, "the space '%.60s' is not acescg, rec709 or xyz",
                        text);
}

abbe_result abbe_lib_weights_fill(const char *illuminant, const char *space, double min_nm,
                                  double max_nm, size_t count, double *lambda_nm, double *weight,
                                  abbe_error *error) {
  ABBE_REQUIRE(lambda_nm && weight, error);
  ABBE_OWNED(abbe_wavelengths, samples) = {0};
  ABBE_OWNED(abbe_illuminant, light) = {0};
  ABBE_OWNED(abbe_weights, weights) = {0};
  abbe_rgb_space own;
  ABBE_TRY(find_space(space == NULL ? "xyz" : space, &own, error));
  ABBE_TRY(abbe_wavelengths_make(count, min_nm, max_nm, &samples, error));
  ABBE_TRY(abbe_illuminant_make(illuminant == NULL ? "D65" : illuminant, &light, error));
  ABBE_TRY(abbe_weights_make(&samples, &light, own, &weights, error));
  memcpy(lambda_nm, samples.lambda_nm, count * sizeof *lambda_nm);
  memcpy(weight, weights.weight, 3 * count * sizeof *weight);
  return ABBE_OK;
}
