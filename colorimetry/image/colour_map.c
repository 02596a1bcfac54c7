#include "colorimetry/image/colour_map.h"

#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

static double held(double value) {
  return value < 0 ? 0 : value > 1 ? 1 : value;
}

/* One and a half turns through the hues about the grey diagonal [Green2011]. */
static void cubehelix(double t, double rgb[3]) {
  const double start = 0.5, turns = -1.5, tau = 6.283185307179586;
  double angle = tau * (start / 3 + turns * t), amplitude = t * (1 - t) / 2;
  double c = amplitude * cos(angle), s = amplitude * sin(angle);
  rgb[0] = t - 0.14861 * c + 1.78277 * s;
  rgb[1] = t - 0.29227 * c - 0.90649 * s;
  rgb[2] = t + 1.97294 * c;
}

static double from_lab(double f) {
  return f > 6.0 / 29 ? f * f * f : 3 * 6.0 / 29 * 6.0 / 29 * (f - 4.0 / 29);
}

static double srgb_encoded(double linear) {
  return abbe_srgb_encoded(linear);
}

/* Straight in magnitude, saturation and hue of CIELAB, the hue of the ends turned on to where the
 * greys meet without a kink [Moreland2009]. */
static void cool_to_warm(double t, double rgb[3]) {
  const double middle[2] = {88, 1.061}, end[2] = {80, 1.08}, hue[2] = {-1.1, 0.5};
  int warm = t > 0.5;
  double share = fabs(2 * t - 1); /* 0 in the middle, 1 at the ends */
  double m = middle[0] + (end[0] - middle[0]) * share, s = end[1] * share;
  double h0 = warm ? middle[1] : hue[0] - (middle[1] - hue[1]);
  double h = h0 + (hue[warm] - h0) * share;
  double l = m * cos(s), a = m * sin(s) * cos(h), b = m * sin(s) * sin(h), fy = (l + 16) / 116;
  double xyz[3] = {0.95047 * from_lab(fy + a / 500), from_lab(fy),
                   1.08883 * from_lab(fy - b / 200)};
  double matrix[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, matrix);
  abbe_rgb_space_apply(matrix, xyz, rgb);
  for (int i = 0; i < 3; i++) rgb[i] = srgb_encoded(rgb[i]);
}

void abbe_colour_map_at(abbe_colour_map map, double t, double rgb[3]) {
  if (isnan(t)) {
    rgb[0] = rgb[2] = 0;
    rgb[1] = 0.8;
    return;
  }
  if (map == ABBE_COLOUR_MAP_DIFFERENCE)
    cool_to_warm(held(t), rgb);
  else
    cubehelix(held(t), rgb);
  for (int i = 0; i < 3; i++) rgb[i] = held(rgb[i]);
}
