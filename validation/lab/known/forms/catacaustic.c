#include "validation/lab/known/forms/closed_form.h"

#include <math.h>

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
