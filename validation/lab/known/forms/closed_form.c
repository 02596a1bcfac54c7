#include "validation/lab/known/forms/closed_form.h"

#include "base/maths.h"

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

enum { SCANNED = 3000, HALVINGS = 60 };

/* A ray in plan, on its way after the last reflection. */
typedef struct course {
  double from[2], direction[2];
  double before; /* m, from the light to the wall; of the sun 0 */
  double chord;  /* m, from wall to wall */
  double
      width; /* that a ray apart by 1 rad of the wall has: m of the sun's beam, rad of a light's */
} course;

/* The course of the ray that meets the wall first at the angle phi. */
static course follow(const abbe_catacaustic *c, double phi, size_t bounces) {
  double n[2] = {cos(phi), sin(phi)}, d[2] = {1, 0};
  course ray = {.from = {c->radius * n[0], c->radius * n[1]}};
  if (c->elevation == 0) {
    for (int k = 0; k < 2; k++) d[k] = ray.from[k] - c->lamp[k];
    ray.before = hypot(d[0], d[1]);
    for (int k = 0; k < 2; k++) d[k] /= ray.before;
  }
  const double cosine = d[0] * n[0] + d[1] * n[1]; /* the same at every reflection */
  ray.chord = 2 * c->radius * cosine;
  ray.width = c->radius * cosine / (c->elevation == 0 ? ray.before : 1);
  for (size_t b = 1;; b++) {
    for (int k = 0; k < 2; k++) d[k] -= 2 * cosine * n[k];
    if (b == bounces) break;
    for (int k = 0; k < 2; k++) {
      ray.from[k] += ray.chord * d[k];
      n[k] = ray.from[k] / c->radius;
    }
  }
  for (int k = 0; k < 2; k++) ray.direction[k] = d[k];
  return ray;
}

/* How far off p the ray passes, m, to the left of it. */
static double miss(const abbe_catacaustic *c, const double p[2], size_t bounces, double phi) {
  const course r = follow(c, phi, bounces);
  return r.direction[0] * (p[1] - r.from[1]) - r.direction[1] * (p[0] - r.from[0]);
}

/* Irradiance by the ray that comes to p; 0 where the wall ends too low or too high for it. */
static double light_of(const abbe_catacaustic *c, const double p[2], size_t bounces, double phi) {
  const course r = follow(c, phi, bounces);
  const double last = r.direction[0] * (p[0] - r.from[0]) + r.direction[1] * (p[1] - r.from[1]);
  if (!(r.chord > 0) || !(last > 0)) return 0;
  const double step = 1e-6;
  const double spread =
      fabs(miss(c, p, bounces, phi + step) - miss(c, p, bounces, phi - step)) / (2 * step);
  const double after = (double)(bounces - 1) * r.chord + last; /* from the first reflection on */
  if (c->elevation != 0) {
    const double rise = tan(c->elevation), met = after * rise;
    if (met > c->height || met <= c->height - r.chord * rise) return 0; /* over the wall behind */
    return sin(c->elevation) * r.width / spread;
  }
  const double whole = r.before + after, h = c->lamp[2];
  if (h * after / whole > c->height) return 0;
  return h * whole / pow(h * h + whole * whole, 1.5) * r.width / spread;
}

double abbe_catacaustic_irradiance(const abbe_catacaustic *c, const double p[2], size_t bounces,
                                   size_t *branches) {
  const double turn = (c->elevation != 0 ? 1 : 2) * acos(-1); /* the sun lights one side */
  double sum = 0, before = 0;
  size_t found = 0;
  for (int i = 0; i <= SCANNED; i++) {
    /* no root of a symmetrical place lies on a node */
    const double at = turn * ((i + 0.137) / SCANNED - 0.5), here = miss(c, p, bounces, at);
    if (i > 0 && (here < 0) != (before < 0)) {
      double low = at - turn / SCANNED, high = at;
      for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (low + high);
        if ((miss(c, p, bounces, middle) < 0) == (before < 0))
          low = middle;
        else
          high = middle;
      }
      const double light = light_of(c, p, bounces, 0.5 * (low + high));
      sum += light;
      found += light > 0 ? 1 : 0;
    }
    before = here;
  }
  if (branches != NULL) *branches = found;
  return sum;
}

double abbe_catacaustic_mean(const abbe_catacaustic *c, const double p[2], double half,
                             size_t steps, double reflectance, size_t bounces, size_t *branches) {
  double sum = 0, share = 1;
  *branches = 0;
  for (size_t b = 1; b <= bounces; b++) {
    size_t here;
    share *= reflectance;
    abbe_catacaustic_irradiance(c, p, b, &here);
    *branches += here;
    for (size_t i = 0; i < steps * steps; i++) {
      const double at[2] = {p[0] + half * ((2 * (double)(i % steps) + 1) / (double)steps - 1),
                            p[1] + half * ((2 * (double)(i / steps) + 1) / (double)steps - 1)};
      sum += share * abbe_catacaustic_irradiance(c, at, b, NULL);
    }
  }
  return sum / (double)(steps * steps);
}

double abbe_wave_caustic_landing(const abbe_wave_caustic *w, double x, double *passed) {
  const double k = 2 * ABBE_PI / w->wavelength, below = w->depth + w->amplitude * cos(k * x);
  const double tilt = atan(-w->amplitude * k * sin(k * x));
  const double turn = tilt - asin(sin(tilt) / w->index); /* off the vertical */
  if (passed != NULL)
    *passed = (1 - abbe_closed_form_fresnel(fabs(tilt), w->index)) *
              exp(-w->attenuation_per_m * below / cos(turn));
  return x + below * tan(turn);
}

double abbe_wave_caustic_focus(const abbe_wave_caustic *w) {
  const double k = 2 * ABBE_PI / w->wavelength;
  return w->index / ((w->index - 1) * w->amplitude * k * k);
}

/* Light that meets the bottom between `from` and `to` enters within this of them, for no slope is
 * steeper. */
static double reach(const abbe_wave_caustic *w) {
  const double tilt = atan(w->amplitude * 2 * ABBE_PI / w->wavelength);
  return (w->depth + w->amplitude) * tan(tilt - asin(sin(tilt) / w->index));
}

double abbe_wave_caustic_mean(const abbe_wave_caustic *w, double from, double to, size_t rays) {
  const double first = from - reach(w), step = (to + reach(w) - first) / (double)rays;
  double sum = 0;
  for (size_t i = 0; i < rays; i++) {
    double passed;
    const double at = abbe_wave_caustic_landing(w, first + ((double)i + 0.5) * step, &passed);
    if (at >= from && at < to) sum += passed;
  }
  return sum * step / (to - from);
}

size_t abbe_wave_caustic_branches(const abbe_wave_caustic *w, double x, size_t rays) {
  const double first = x - 1.001 * reach(w) - 1e-12, step = 2 * (x - first) / (double)rays;
  size_t count = 0;
  double before = abbe_wave_caustic_landing(w, first, NULL);
  for (size_t i = 1; i <= rays; i++) {
    const double at = abbe_wave_caustic_landing(w, first + (double)i * step, NULL);
    count += (before < x) != (at < x);
    before = at;
  }
  return count;
}
