#include "colorimetry/upsampling.h"

#include "colorimetry/observer_integral.h"
#include "colorimetry/weights.h"

#include <math.h>
#include <stdbool.h>

enum { KNOT_COUNT = 81 };
static const double first_nm = 380, step_nm = 5;

/* Red and blue; green is what they leave of 1 (script/making/upsampling). */
static const double knots[KNOT_COUNT][2] = {
    {0.026638, 0.973362}, {0.026636, 0.973364}, {0.026630, 0.973370}, {0.026615, 0.973385},
    {0.026579, 0.973421}, {0.026501, 0.973499}, {0.026349, 0.973651}, {0.026062, 0.973938},
    {0.025544, 0.974456}, {0.024675, 0.975325}, {0.023396, 0.976604}, {0.021811, 0.978189},
    {0.020244, 0.979756}, {0.019375, 0.980625}, {0.020180, 0.979820}, {0.023970, 0.976030},
    {0.028895, 0.964169}, {0.023290, 0.928931}, {0.012336, 0.871765}, {0.002336, 0.795100},
    {0.000000, 0.701258}, {0.000000, 0.598345}, {0.000000, 0.492510}, {0.000000, 0.387964},
    {0.000000, 0.288519}, {0.000000, 0.197933}, {0.000000, 0.120097}, {0.000000, 0.058907},
    {0.000000, 0.017922}, {0.000000, 0.000000}, {0.000000, 0.000000}, {0.000000, 0.000000},
    {0.000000, 0.000000}, {0.000000, 0.000000}, {0.000000, 0.000000}, {0.000000, 0.000000},
    {0.000000, 0.002388}, {0.000000, 0.022509}, {0.032804, 0.040775}, {0.107999, 0.048997},
    {0.214438, 0.049300}, {0.340658, 0.043892}, {0.475246, 0.035035}, {0.607959, 0.024781},
    {0.729983, 0.014872}, {0.834091, 0.006753}, {0.914898, 0.001552}, {0.969197, 0.000000},
    {0.997074, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000}, {1.000000, 0.000000},
    {1.000000, 0.000000},
};

void abbe_upsampling_basis(double lambda_nm, double basis[3]) {
  const double at = (lambda_nm - first_nm) / step_nm, last = KNOT_COUNT - 1;
  const double held = at >= 0 ? fmin(at, last) : 0;
  const int low = (int)fmin(held, last - 1);
  const double t = held - low;
  basis[0] = (1 - t) * knots[low][0] + t * knots[low + 1][0];
  basis[2] = (1 - t) * knots[low][1] + t * knots[low + 1][1];
  basis[1] = fmax(1 - basis[0] - basis[2], 0);
}

/* Trapezoids between knots: exact. */
void abbe_upsampling_basis_mean(double from_nm, double to_nm, double mean[3]) {
  double sum[3] = {0}, here[3], there[3];
  abbe_upsampling_basis(from_nm, mean);
  if (!(from_nm < to_nm)) return;
  for (double at = from_nm; at < to_nm;) {
    const double next = fmin(step_nm * floor(at / step_nm) + step_nm, to_nm);
    abbe_upsampling_basis(at, here);
    abbe_upsampling_basis(next, there);
    for (int k = 0; k < 3; k++) sum[k] += 0.5 * (next - at) * (here[k] + there[k]);
    at = next;
  }
  for (int k = 0; k < 3; k++) mean[k] = sum[k] / (to_nm - from_nm);
}

static bool make_coefficients(abbe_upsampling *u) {
  const double most = 100; /* a standard illuminant's are below 2 */
  double of_basis[9], inverse[9];
  abbe_observer_integral_of(u->observer, u->illuminant, u->min_nm, u->max_nm, abbe_upsampling_basis,
                            of_basis);
  for (int i = 0; i < 9; i++) of_basis[i] /= u->white_y;
  abbe_matrix3_invert(of_basis, inverse);
  abbe_matrix3_multiply(inverse, u->to_xyz, u->to_coefficients);
  bool held = true;
  for (int i = 0; i < 9; i++) held = held && fabs(u->to_coefficients[i]) <= most;
  return held;
}

/* Linear between knots, so the smallest value is at one, or where the range ends. */
static double least_of(const abbe_upsampling *u) {
  double least = INFINITY;
  for (int i = 0; i < KNOT_COUNT + 2; i++) {
    double nm = i < KNOT_COUNT ? first_nm + i * step_nm : i == KNOT_COUNT ? u->min_nm : u->max_nm;
    if (nm < u->min_nm || nm > u->max_nm) continue;
    for (int k = 0; k < 3; k++)
      least = fmin(least, abbe_upsampling_at(u, (const double[3]){k == 0, k == 1, k == 2}, nm));
  }
  return least;
}

abbe_result abbe_upsampling_make(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                                 abbe_upsampling *out, abbe_error *error) {
  *out = (abbe_upsampling){0};
  abbe_upsampling u = {.illuminant = illuminant, .min_nm = min_nm, .max_nm = max_nm};
  double from_xyz[9], to_xyz[9], own[3];
  if (min_nm < max_nm) abbe_observer_integral(illuminant, min_nm, max_nm, u.white);
  u.white_y = u.white[1];
  if (!(u.white_y > 0 && isfinite(u.white_y)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g to %g nm holds no light that the eye sees under the "
                          "illuminant %s",
                          min_nm, max_nm, abbe_illuminant_name(illuminant));
  for (int k = 0; k < 3; k++) u.white[k] /= u.white_y;
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  abbe_rgb_space_apply(from_xyz, u.white, own);
  for (int i = 0; i < 9; i++) u.to_xyz[i] = to_xyz[i] * own[i % 3];
  if (!make_coefficients(&u))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the light of the illuminant %s in %g to %g nm makes too few colours for "
                          "RGB: it is of a line or two, or of a narrow band",
                          abbe_illuminant_name(illuminant), min_nm, max_nm);
  u.least = least_of(&u);
  *out = u;
  return ABBE_OK;
}

abbe_result abbe_upsampling_make_by(abbe_observer observer, const abbe_illuminant *illuminant,
                                    double min_nm, double max_nm, abbe_upsampling *out,
                                    abbe_error *error) {
  abbe_upsampling u;
  abbe_result result = abbe_upsampling_make(illuminant, min_nm, max_nm, &u, error);
  *out = (abbe_upsampling){0};
  if (result != ABBE_OK) return result;
  if (observer != ABBE_OBSERVER_CIE_1931) {
    abbe_weights_range range;
    abbe_weights_range_make_by(observer, illuminant, min_nm, max_nm, &range);
    if (!(range.white_y > 0))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the range %g to %g nm holds no light that the observer %s sees under "
                            "the illuminant %s",
                            min_nm, max_nm, abbe_observer_text(observer),
                            abbe_illuminant_name(illuminant));
    u.observer = observer;
    u.white_y = range.white_y;
    abbe_weights_range_xyz(&range, min_nm, max_nm, u.white);
    abbe_upsampling_band(&u, ABBE_RGB_SPACE_XYZ, min_nm, max_nm, u.to_xyz);
  }
  *out = u;
  return ABBE_OK;
}

double abbe_upsampling_at(const abbe_upsampling *upsampling, const double rgb[3],
                          double lambda_nm) {
  double basis[3], c[3];
  abbe_upsampling_basis(lambda_nm, basis);
  abbe_rgb_space_apply(upsampling->to_coefficients, rgb, c);
  return basis[0] * c[0] + basis[1] * c[1] + basis[2] * c[2];
}

void abbe_upsampling_band(const abbe_upsampling *u, abbe_rgb_space space, double from_nm,
                          double to_nm, double matrix[9]) {
  double of_basis[9], to_space[9], coloured[9];
  abbe_observer_integral_of(u->observer, u->illuminant, fmax(from_nm, u->min_nm),
                            fmin(to_nm, u->max_nm), abbe_upsampling_basis, of_basis);
  for (int i = 0; i < 9; i++) of_basis[i] /= u->white_y;
  abbe_rgb_space_from_xyz(space, to_space);
  abbe_matrix3_multiply(to_space, of_basis, coloured);
  abbe_matrix3_multiply(coloured, u->to_coefficients, matrix);
}
