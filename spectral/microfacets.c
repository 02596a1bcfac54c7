#include "spectral/microfacets.h"

#include "base/maths.h"

#include <math.h>

static bool normalise(double a[3]) {
  const double length = sqrt(abbe_vector_dot(a, a));
  if (!(length > 0)) return false;
  for (int k = 0; k < 3; k++) a[k] /= length;
  return true;
}

double abbe_microfacets_density(const abbe_microfacets *m, const double h[3]) {
  if (!(h[2] > 0)) return 0;
  const double x = h[0] / m->x, y = h[1] / m->y, square = x * x + y * y + h[2] * h[2];
  return 1 / (ABBE_PI * m->x * m->y * square * square);
}

/* Facets hidden by others, for each that is seen [Heitz2014]. */
static double hidden(const abbe_microfacets *m, const double w[3]) {
  const double x = m->x * w[0], y = m->y * w[1];
  return 0.5 * (sqrt(1 + (x * x + y * y) / (w[2] * w[2])) - 1);
}

double abbe_microfacets_visible(const abbe_microfacets *m, const double w[3]) {
  return w[2] > 0 ? 1 / (1 + hidden(m, w)) : 0;
}

static double visible_from_both(const abbe_microfacets *m, const double a[3], const double b[3]) {
  return a[2] > 0 && b[2] > 0 ? 1 / (1 + hidden(m, a) + hidden(m, b)) : 0;
}

/* The normal of what reflects one to the other. */
static bool halfway(const double wi[3], const double wo[3], double h[3]) {
  for (int k = 0; k < 3; k++) h[k] = wi[k] + wo[k];
  return normalise(h);
}

double abbe_microfacets_reflect(const abbe_microfacets *m, const double wi[3], const double wo[3]) {
  double h[3];
  if (!(wi[2] > 0) || !(wo[2] > 0) || !halfway(wi, wo, h)) return 0;
  return abbe_microfacets_density(m, h) * visible_from_both(m, wi, wo) / (4 * wi[2] * wo[2]);
}

double abbe_microfacets_pdf(const abbe_microfacets *m, const double wo[3], const double wi[3]) {
  double h[3];
  if (!(wo[2] > 0) || !halfway(wi, wo, h)) return 0;
  return abbe_microfacets_density(m, h) * abbe_microfacets_visible(m, wo) / (4 * wo[2]);
}

/* A place on the disk that half a sphere shows along v: a half disk and half an ellipse. */
static void see_hemisphere(const double v[3], const double u[2], double out[3]) {
  const double across = sqrt(v[0] * v[0] + v[1] * v[1]), radius = sqrt(u[0]);
  const double a[3] = {across > 0 ? -v[1] / across : 1, across > 0 ? v[0] / across : 0, 0};
  const double b[3] = {-v[2] * a[1], v[2] * a[0], v[0] * a[1] - v[1] * a[0]};
  const double s = radius * cos(2 * ABBE_PI * u[1]), whole = sqrt(fmax(1 - s * s, 0));
  const double share = 0.5 * (1 + v[2]);
  const double t = (1 - share) * whole + share * radius * sin(2 * ABBE_PI * u[1]);
  const double rest = sqrt(fmax(1 - s * s - t * t, 0));
  for (int k = 0; k < 3; k++) out[k] = s * a[k] + t * b[k] + rest * v[k];
}

double abbe_microfacets_sample(const abbe_microfacets *m, const double wo[3], const double u[2],
                               double h[3], double wi[3]) {
  double v[3] = {m->x * wo[0], m->y * wo[1], wo[2]};
  normalise(v);
  see_hemisphere(v, u, h);
  h[0] *= m->x;
  h[1] *= m->y;
  h[2] = fmax(h[2], 0);
  if (!normalise(h)) h[2] = 1;
  const double along = abbe_vector_dot(wo, h);
  for (int k = 0; k < 3; k++) wi[k] = 2 * along * h[k] - wo[k];
  const double seen = abbe_microfacets_visible(m, wo);
  return seen > 0 ? visible_from_both(m, wi, wo) / seen : 0;
}

/* The area of all facets that w sees, by that of the surface. */
static double seen_area(const abbe_microfacets *m, const double w[3]) {
  const double x = m->x * w[0], y = m->y * w[1];
  return 0.5 * (sqrt(w[2] * w[2] + x * x + y * y) + w[2]);
}

double abbe_microfacets_normals(const abbe_microfacets *m, const double wo[3], const double h[3]) {
  const double along = abbe_vector_dot(wo, h), area = seen_area(m, wo);
  return along > 0 && area > 0 ? abbe_microfacets_density(m, h) * along / area : 0;
}

double abbe_microfacets_escape(const abbe_microfacets *m, const double w[3], double height) {
  return w[2] > 0 ? pow(height, hidden(m, w)) : 0;
}

bool abbe_microfacets_travel(const abbe_microfacets *m, const double w[3], double u,
                             double *height) {
  if (u >= 1 - abbe_microfacets_escape(m, w, *height)) return false;
  const double others = hidden(m, w), power = w[2] > 0 ? -others : 1 + others;
  /* along the surface it stays as high as it is */
  if (isfinite(power)) *height = fmin(*height * pow(1 - u, 1 / power), 1);
  return true;
}
