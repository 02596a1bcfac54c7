#include "colorimetry/reflectance/reflected_light.h"

#include "colorimetry/matrix3.h"
#include "colorimetry/upsampling.h"
#include "colorimetry/weights.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct abbe_reflected_light {
  size_t count;
  double *middle_nm;  /* [count] */
  double (*xyz)[3];   /* [count] of the illuminant, in all with Y = 1 */
  double white[3];    /* their sum */
  bool lifted;        /* from_xyz holds */
  double from_xyz[9]; /* from XYZ to the coefficients of the three functions */
};

void abbe_reflectance_channels(const abbe_spectrum *measured, double lambda_nm, double out[3]) {
  if (measured == NULL) {
    abbe_upsampling_basis(lambda_nm, out);
    return;
  }
  out[0] = abbe_spectrum_at(measured, lambda_nm);
  out[1] = out[2] = 0;
}

static void find_lift(abbe_reflected_light *light) {
  const double most = 100; /* as of upsampling.h: beyond, colours are of rounding */
  double of_basis[9] = {0}, inverse[9], basis[3];
  for (size_t i = 0; i < light->count; i++) {
    abbe_upsampling_basis(light->middle_nm[i], basis);
    for (int k = 0; k < 3; k++)
      for (int j = 0; j < 3; j++) of_basis[3 * k + j] += light->xyz[i][k] * basis[j];
  }
  abbe_matrix3_invert(of_basis, inverse);
  light->lifted = true;
  for (int i = 0; i < 9; i++)
    light->lifted = light->lifted && isfinite(inverse[i]) && fabs(inverse[i]) < most;
  memcpy(light->from_xyz, inverse, sizeof inverse);
}

abbe_result abbe_reflected_light_make_by(abbe_observer observer, const abbe_illuminant *illuminant,
                                         double min_nm, double max_nm, abbe_reflected_light **out,
                                         abbe_error *error) {
  enum { LEAST = 16, MOST = 470 }; /* the eye sees 470 nm */
  *out = NULL;
  if (!(min_nm > 0 && min_nm < max_nm && isfinite(max_nm)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a range of wavelengths rises from above 0, as 380:780 does: not %g:%g",
                          min_nm, max_nm);
  const double from = fmin(fmax(min_nm, 360), 829), to = fmax(fmin(max_nm, 830), from + 1);
  abbe_reflected_light *light = calloc(1, sizeof *light);
  if (light != NULL) {
    light->count = (size_t)fmin(fmax(ceil(to - from), LEAST), MOST);
    light->middle_nm = calloc(light->count, sizeof *light->middle_nm);
    light->xyz = calloc(light->count, sizeof *light->xyz);
  }
  if (light == NULL || light->middle_nm == NULL || light->xyz == NULL) {
    abbe_reflected_light_free(light);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a light's colours");
  }
  abbe_weights_range range;
  abbe_weights_range_make_by(observer, illuminant, min_nm, max_nm, &range);
  for (size_t i = 0; i < light->count; i++) {
    const double step = (to - from) / (double)light->count, at = from + step * (double)i;
    light->middle_nm[i] = at + step / 2;
    abbe_weights_range_xyz(&range, at, at + step, light->xyz[i]);
    for (int k = 0; k < 3; k++) light->white[k] += light->xyz[i][k];
  }
  find_lift(light);
  *out = light;
  return ABBE_OK;
}

abbe_result abbe_reflected_light_make(const abbe_illuminant *illuminant, double min_nm,
                                      double max_nm, abbe_reflected_light **out,
                                      abbe_error *error) {
  return abbe_reflected_light_make_by(ABBE_OBSERVER_CIE_1931, illuminant, min_nm, max_nm, out,
                                      error);
}

void abbe_reflected_light_free(abbe_reflected_light *light) {
  if (light == NULL) return;
  free(light->middle_nm);
  free(light->xyz);
  free(light);
}

void abbe_reflected_light_white(const abbe_reflected_light *light, double xyz[3]) {
  memcpy(xyz, light->white, sizeof light->white);
}

size_t abbe_reflected_light_steps(const abbe_reflected_light *light) {
  return light->count;
}

void abbe_reflected_light_step(const abbe_reflected_light *light, size_t step, double *lambda_nm,
                               double xyz[3]) {
  *lambda_nm = light->middle_nm[step];
  memcpy(xyz, light->xyz[step], sizeof light->xyz[step]);
}

void abbe_reflected_light_xyz(const abbe_reflected_light *light, const abbe_spectrum *measured,
                              double xyz[3][3]) {
  memset(xyz, 0, 9 * sizeof xyz[0][0]);
  for (size_t i = 0; i < light->count; i++) {
    double share[3];
    abbe_reflectance_channels(measured, light->middle_nm[i], share);
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) xyz[j][k] += share[j] * light->xyz[i][k];
  }
}

/* As if X, Y and Z were each reflected by a share of their own. */
static void scale_xyz(const abbe_reflected_light *light, double xyz[3][3], double matrix[3][9]) {
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++)
      matrix[j][4 * k] = light->white[k] > 0 ? xyz[j][k] / light->white[k] : 0;
}

void abbe_reflected_light_matrices(const abbe_reflected_light *light, const abbe_spectrum *measured,
                                   double matrix[3][9]) {
  double of[3][9] = {{0}}, xyz[3][3];
  memset(matrix, 0, 27 * sizeof matrix[0][0]);
  if (!light->lifted) {
    abbe_reflected_light_xyz(light, measured, xyz);
    scale_xyz(light, xyz, matrix);
    return;
  }
  for (size_t i = 0; i < light->count; i++) {
    double share[3], basis[3];
    abbe_reflectance_channels(measured, light->middle_nm[i], share);
    abbe_upsampling_basis(light->middle_nm[i], basis);
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++)
        for (int b = 0; b < 3; b++) of[j][3 * k + b] += share[j] * basis[b] * light->xyz[i][k];
  }
  for (int j = 0; j < 3; j++) abbe_matrix3_multiply(of[j], light->from_xyz, matrix[j]);
}
