#include "scenes/environment/sky.h"

#include "scenes/geometry/vector.h"

#define PI 3.14159265358979323846

/* a, b of the gradation; c, d, e of the scattering [CIES011, table 1]. */
static const double parameters[15][5] = {
    {4.0, -0.70, 0, -1.0, 0},      {4.0, -0.70, 2, -1.5, 0.15},   {1.1, -0.80, 0, -1.0, 0},
    {1.1, -0.80, 2, -1.5, 0.15},   {0.0, -1.00, 0, -1.0, 0},      {0.0, -1.00, 2, -1.5, 0.15},
    {0.0, -1.00, 5, -2.5, 0.30},   {0.0, -1.00, 10, -3.0, 0.45},  {-1.0, -0.55, 2, -1.5, 0.15},
    {-1.0, -0.55, 5, -2.5, 0.30},  {-1.0, -0.55, 10, -3.0, 0.45}, {-1.0, -0.32, 10, -3.0, 0.45},
    {-1.0, -0.32, 16, -3.0, 0.30}, {-1.0, -0.15, 16, -3.0, 0.30}, {-1.0, -0.15, 24, -2.8, 0.15}};

bool abbe_sky_needs_sun(int type) {
  return type >= 1 && type <= 15 && parameters[type - 1][2] > 0;
}

/* By the cosine of the angle from the zenith. */
static double gradation(const double p[5], double cosine) {
  return 1 + p[0] * exp(p[1] / cosine);
}

/* By the cosine of the angle from the sun. */
static double scattering(const double p[5], double cosine) {
  const double held = fmin(fmax(cosine, -1), 1);
  return 1 + p[2] * (exp(p[3] * acos(held)) - exp(p[3] * PI / 2)) + p[4] * held * held;
}

double abbe_sky_relative(const abbe_sky *sky, const double direction[3]) {
  if (!(direction[2] > 0) || sky->type < 1 || sky->type > ABBE_SKY_TYPES) return 0;
  if (sky->type == ABBE_SKY_OVERCAST) return (1 + 2 * direction[2]) / 3;
  const double *p = parameters[sky->type - 1];
  const double relative = gradation(p, direction[2]) / gradation(p, 1);
  if (!abbe_sky_needs_sun(sky->type)) return relative;
  return relative * scattering(p, abbe_vector_dot(direction, sky->sun)) /
         scattering(p, sky->sun[2]);
}

/* Midpoints, even in z: smooth as far as the horizon. */
double abbe_sky_horizontal(const abbe_sky *sky) {
  enum { RINGS = 500, PLACES = 800 };
  double sum = 0;
  for (int i = 0; i < RINGS; i++) {
    const double z = (i + 0.5) / RINGS, aside = sqrt(1 - z * z);
    for (int j = 0; j < PLACES; j++) {
      const double azimuth = 2 * PI * (j + 0.5) / PLACES;
      const double direction[3] = {aside * cos(azimuth), aside * sin(azimuth), z};
      sum += z * abbe_sky_relative(sky, direction);
    }
  }
  return 2 * PI * sum / (RINGS * PLACES);
}
