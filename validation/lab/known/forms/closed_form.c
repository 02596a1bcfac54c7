#include "validation/lab/known/forms/closed_form.h"

#include <complex.h>
#include <math.h>

double abbe_closed_form_fresnel(double incidence, double n) {
  double sine = sin(incidence) / n;
  if (sine >= 1) return 1;
  double refraction = asin(sine);
  if (incidence < 1e-6) return pow((n - 1) / (n + 1), 2); /* the laws' limit */
  double s = sin(incidence - refraction) / sin(incidence + refraction);
  double p = tan(incidence - refraction) / tan(incidence + refraction);
  return (s * s + p * p) / 2;
}

double abbe_closed_form_conductor(double incidence, double n, double k) {
  const double complex m = n + k * I, sine = sin(incidence) / m, cosine = csqrt(1 - sine * sine);
  const double c = cos(incidence);
  const double s = cabs((c - m * cosine) / (c + m * cosine));
  const double p = cabs((m * c - cosine) / (m * c + cosine));
  return (s * s + p * p) / 2;
}

/* Over the edges: the angle that each is seen under, times the patch's cosine to the normal of the
 * plane through the edge and p. */
double abbe_closed_form_polygon(const double (*corner)[3], size_t count, const double p[3],
                                const double n[3]) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) {
    double a[3], b[3], across[3];
    for (int k = 0; k < 3; k++) {
      a[k] = corner[i][k] - p[k];
      b[k] = corner[(i + 1) % count][k] - p[k];
    }
    for (int k = 0; k < 3; k++)
      across[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    const double length =
        sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
    const double along = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    if (length > 0)
      sum +=
          atan2(length, along) * (across[0] * n[0] + across[1] * n[1] + across[2] * n[2]) / length;
  }
  return fabs(sum) / (2 * acos(-1));
}

double abbe_closed_form_coaxial_disks(double from, double to, double h) {
  const double a = from / h, b = to / h;
  if (!(from > 0)) return b * b / (1 + b * b);
  const double x = 1 + (1 + b * b) / (a * a);
  return (x - sqrt(x * x - 4 * pow(to / from, 2))) / 2;
}

double abbe_closed_form_penumbra(double at) {
  if (!(fabs(at) < 1)) return at > 0 ? 1 : 0;
  return 0.5 + (at * sqrt(1 - at * at) + asin(at)) / acos(-1);
}

void abbe_closed_form_slab(double r, double tau, double *reflected, double *passed) {
  double once = (1 - r) * (1 - r) * tau, again = 1 - r * r * tau * tau;
  if (again <= 0) { /* mirrors: nothing enters */
    *reflected = 1;
    *passed = 0;
    return;
  }
  *passed = once / again;
  *reflected = r + once * r * tau / again;
}

void abbe_closed_form_film(const abbe_closed_film *film, double incidence, bool p,
                           double *reflected, double *passed) {
  const double complex index[3] = {film->from, film->n + film->k * I, film->to};
  const double kappa = film->from * sin(incidence);
  double complex q[3], y[3];
  for (int i = 0; i < 3; i++) {
    q[i] = csqrt(index[i] * index[i] - kappa * kappa);
    y[i] = p ? q[i] / (index[i] * index[i]) : q[i];
  }
  const double complex first = (y[0] - y[1]) / (y[0] + y[1]), last = (y[1] - y[2]) / (y[1] + y[2]);
  const double complex cross = cexp(2 * acos(-1) * I * film->waves * q[1]);
  const double complex again = 1 + first * last * cross * cross;
  const double complex t = 4 * y[0] * y[1] / ((y[0] + y[1]) * (y[1] + y[2])) * cross / again;
  *reflected = pow(cabs((first + last * cross * cross) / again), 2);
  *passed = creal(y[2]) / creal(y[0]) * pow(cabs(t), 2);
}

double abbe_closed_form_slab_shift(double thickness, double incidence, double n) {
  double s = sin(incidence);
  return thickness * s * (1 - cos(incidence) / sqrt(n * n - s * s));
}

double abbe_closed_form_ball_focus(double radius, double n) {
  return n * radius / (2 * (n - 1));
}

double abbe_closed_form_ball_crossing(double radius, double n, double height) {
  double s = height / radius;
  return height / sin(2 * (asin(s) - asin(s / n)));
}

double abbe_closed_form_shell_turn(double radius, double n, double core, double core_n,
                                   double height) {
  double shell = 2 * (asin(height / radius) - asin(height / (radius * n)));
  double in = height / (core * n), out = height / (core * core_n);
  if (in >= 1) return shell;
  if (out >= 1) return shell - (acos(-1) - 2 * asin(in));
  return shell + 2 * (asin(in) - asin(out));
}

bool abbe_closed_form_rainbow(double n, size_t order, double *deviation, double *incidence) {
  double k = (double)order;
  if (order < 1 || !(n > 1) || n >= k + 1) return false;
  double i = acos(sqrt((n - 1) * (n + 1) / (k * (k + 2)))), t = asin(sin(i) / n);
  *incidence = i;
  *deviation = 2 * (i - t) + k * (acos(-1) - 2 * t);
  return true;
}

bool abbe_closed_form_prism_least(double apex, double n, double *deviation) {
  double s = n * sin(apex / 2);
  if (!(s <= 1)) return false;
  *deviation = 2 * asin(s) - apex;
  return true;
}

/* Along the left face the apex and both crossings make a triangle: its angles at the crossings
 * are those of refraction's complements. */
bool abbe_closed_form_prism_ray(double apex, double n, double incidence, double along,
                                abbe_prism_ray *ray) {
  double h = apex / 2, in = asin(sin(incidence) / n), second = apex - in;
  double leaving = n * sin(second);
  if (!(fabs(leaving) < 1) || !(along > 0)) return false;
  double out = asin(leaving), away = along * cos(in) / cos(second);
  if (!(away > 0)) return false;
  double before = incidence - h, after = h - out; /* above the level */
  *ray = (abbe_prism_ray){
      .deviation = incidence + out - apex,
      .from = {-along * sin(h), -along * cos(h)},
      .came = {cos(before), sin(before)},
      .exit = {away * sin(h), -away * cos(h)},
      .direction = {cos(after), sin(after)},
  };
  return true;
}
