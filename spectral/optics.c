#include "spectral/optics.h"

#include "base/maths.h"

#include <math.h>
#include <stddef.h>

static double clamp_unit(double x) {
  return x < 0 ? 0 : x > 1 ? 1 : x;
}

static void normalise(double v[3]) {
  double length = sqrt(abbe_vector_dot(v, v));
  if (length > 0)
    for (int i = 0; i < 3; i++) v[i] /= length;
}

/* cos_t^2 = (1 - eta^2) + (eta cos_i)^2 = 1 - (eta sin_i)^2. The first keeps its digits near
 * grazing and near eta = 1, the second near normal incidence: the one with the smaller terms. */
double abbe_optics_cos_refracted(double cos_i, double eta, bool *total) {
  double c = clamp_unit(cos_i), along = eta * c;
  if (total != NULL) *total = false;
  if (eta == 1 || c == 1) return c;
  double squared = eta <= 1 || along < 1 ? (1 - eta) * (1 + eta) + along * along
                                         : 1 - eta * eta * ((1 - c) * (1 + c));
  if (isnan(squared)) return squared;
  if (squared > 0) return sqrt(fmin(squared, 1));
  if (total != NULL) *total = true;
  return 0;
}

/* The two amplitudes are r_s = (eta c - t) / (eta c + t) and r_p = (eta t - c) / (eta t + c). For
 * eta near 1 their differences are multiplied out by Snell's law, so that nothing cancels. */
double abbe_optics_fresnel(double cos_i, double eta) {
  double c = clamp_unit(cos_i);
  if (eta == 1) return 0;
  if (c == 0) return 1;
  bool total = false;
  double t = abbe_optics_cos_refracted(c, eta, &total);
  if (total) return 1;
  double s = eta * c + t, p = eta * t + c;
  double r_s = (eta * c - t) / s, r_p = (eta * t - c) / p;
  if (eta > 0.5 && eta < 2) {
    double contrast = (eta - 1) * (eta + 1);
    r_s = contrast / (s * s);
    r_p = contrast / (p * p) * (c * c * (1 + eta * eta) - eta * eta);
  }
  return clamp_unit((r_s * r_s + r_p * r_p) / 2);
}

/* With N = n + i k and w = a + i b = sqrt(N^2 - sin^2), r_s = (c - w) / (c + w) and
 * r_p = (N^2 c - w) / (N^2 c + w). Their differences are multiplied out as above:
 * r_s = (1 - N^2) / (c + w)^2 and r_p = (N^2 - 1) ((N^2 + 1) c^2 - 1) / (N^2 c + w)^2. */
double abbe_optics_fresnel_conductor(double cos_i, double n, double k) {
  double c = clamp_unit(cos_i), s2 = (1 - c) * (1 + c);
  if (n == 1 && k == 0) return 0;
  if (c == 0 || hypot(n, k) < 1e-100) return 1;         /* below, 1 - R is 4 n */
  double square = (n - k) * (n + k), twice = 2 * n * k; /* N^2 */
  double below = c * c > 0.5 ? square - s2 : (n - 1) * (n + 1) + (c * c - k * k);
  double size = hypot(below, twice);
  /* the smaller of a and b by a b = n k, since its own difference cancels */
  double a = sqrt((size + fabs(below)) / 2), b = a > 0 ? twice / (2 * a) : 0;
  if (below < 0) {
    double larger = a;
    a = b;
    b = larger;
  }
  double contrast = hypot(n - 1, k) * hypot(n + 1, k); /* |N^2 - 1| */
  double s = hypot(c + a, b), p = hypot(square * c + a, twice * c + b);
  double r_s = contrast / s / s;
  double r_p = contrast / p * (hypot(square * c * c - s2, twice * c * c) / p);
  return clamp_unit((r_s * r_s + r_p * r_p) / 2);
}

bool abbe_optics_refract(const double wi[3], const double n[3], double eta, double wt[3]) {
  bool total = false;
  double c = clamp_unit(abbe_vector_dot(wi, n));
  double t = abbe_optics_cos_refracted(c, eta, &total);
  if (total) return false;
  /* eta c - t, without its cancellation */
  double sum = eta * c + t;
  double bend = sum > 0 ? (eta - 1) * ((eta + 1) / sum) : 0;
  double out[3]; /* wt may be wi */
  for (int i = 0; i < 3; i++) out[i] = bend * n[i] - eta * wi[i];
  normalise(out);
  for (int i = 0; i < 3; i++) wt[i] = out[i];
  return true;
}

void abbe_optics_reflect(const double wi[3], const double n[3], double wo[3]) {
  double twice = 2 * abbe_vector_dot(wi, n), out[3];
  for (int i = 0; i < 3; i++) out[i] = twice * n[i] - wi[i];
  normalise(out);
  for (int i = 0; i < 3; i++) wo[i] = out[i];
}

double abbe_optics_transmittance(double attenuation_per_m, double distance_m) {
  if (attenuation_per_m == 0 || distance_m == 0) return 1; /* also against infinity */
  return exp(-attenuation_per_m * distance_m);
}
