/* Laws of GGX's facets: what all of them cover, what a sampler owes its density, and what a rough
 * mirror reflects seen straight, in closed form. */
#include "tests/check.h"
#include "tests/random.h"

#include "base/maths.h"
#include "spectral/microfacets.h"

static const abbe_microfacets kinds[] = {{0.05, 0.05}, {0.3, 0.3}, {1, 1}, {0.08, 0.4}, {0.6, 0.1}};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void direction(double polar_deg, double azimuth_deg, double out[3]) {
  const double t = polar_deg * ABBE_PI / 180, a = azimuth_deg * ABBE_PI / 180;
  out[0] = sin(t) * cos(a);
  out[1] = sin(t) * sin(a);
  out[2] = cos(t);
}

typedef double (*of_direction)(const abbe_microfacets *m, const double wo[3], const double w[3]);

/* Over a hemisphere, by midpoints that lie dense where the facets' slopes are small. */
static double integrate(of_direction f, const abbe_microfacets *m, const double wo[3]) {
  enum { RINGS = 600, SECTORS = 240 };
  const double wide = fmin(m->x, m->y);
  double sum = 0;
  for (int i = 0; i < RINGS; i++) {
    /* tan = wide s / (1 - s) */
    const double s = (i + 0.5) / RINGS, tangent = wide * s / (1 - s);
    const double cosine = 1 / sqrt(1 + tangent * tangent), sine = tangent * cosine;
    const double by_s = wide / ((1 - s) * (1 - s)) * cosine * cosine * sine / RINGS;
    for (int k = 0; k < SECTORS; k++) {
      const double a = 2 * ABBE_PI * (k + 0.5) / SECTORS;
      const double h[3] = {sine * cos(a), sine * sin(a), cosine};
      sum += f(m, wo, h) * by_s * 2 * ABBE_PI / SECTORS;
    }
  }
  return sum;
}

static double covered(const abbe_microfacets *m, const double wo[3], const double h[3]) {
  (void)wo;
  return abbe_microfacets_density(m, h) * h[2];
}

static double seen(const abbe_microfacets *m, const double wo[3], const double h[3]) {
  return abbe_microfacets_density(m, h) * abbe_microfacets_visible(m, wo) *
         fmax(abbe_vector_dot(wo, h), 0);
}

/* Facets cover the surface once; and from everywhere as much of them is seen as of the surface. */
TEST(facets_cover_the_surface) {
  for (int i = 0; i < KINDS; i++) {
    double wo[3];
    assert_near(integrate(covered, &kinds[i], NULL), 1, 2e-4);
    for (int polar = 0; polar <= 75; polar += 25) {
      direction(polar, 35, wo);
      assert_near(integrate(seen, &kinds[i], wo) / wo[2], 1, 2e-3);
    }
  }
}

TEST(both_ways_are_alike) {
  uint64_t random = 5;
  for (int i = 0; i < 1000; i++) {
    const abbe_microfacets *m = &kinds[i % KINDS], turned = {m->y, m->x};
    double a[3], b[3];
    direction(random_between(&random, 0, 89), random_between(&random, 0, 360), a);
    direction(random_between(&random, 0, 89), random_between(&random, 0, 360), b);
    const double f = abbe_microfacets_reflect(m, a, b);
    assert_true(f >= 0);
    assert_near(abbe_microfacets_reflect(m, b, a), f, 1e-12 * f);
    const double c[3] = {-a[1], a[0], a[2]}, d[3] = {-b[1], b[0], b[2]};
    assert_near(abbe_microfacets_reflect(&turned, c, d), f, 1e-9 * f);
    const double below[3] = {b[0], b[1], -b[2]};
    assert_true(abbe_microfacets_reflect(m, a, below) == 0);
  }
}

/* Reflected of uniform light, seen straight on: with t the squared tangent of a facet's tilt,
 * alpha^2 / (alpha^2 + t)^2 dt of the facets have it, and of what they send at twice the angle the
 * share 2 / (1 + sqrt(1 + alpha^2 tan^2)) gets out. */
static double straight(double alpha, double most) {
  enum { STEPS = 200000 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    const double t = most * (i + 0.5) / STEPS, tangent2 = 4 * t / ((1 - t) * (1 - t));
    sum += alpha * alpha / pow(alpha * alpha + t, 2) * 2 / (1 + sqrt(1 + alpha * alpha * tangent2));
  }
  return sum * most / STEPS;
}

TEST(the_closed_form_has_an_end) {
  assert_near(straight(1, 1), 1 - log(2), 1e-6);
}

/* Means over the sampler. What leaves within an angle of the normal is the closed form's, seen
 * straight on; at any angle each share is that of reflect, by its density. */
TEST(the_sampler_is_the_lobe) {
  enum { SAMPLES = 200000 };
  static const double polar[] = {0, 30, 70};
  uint64_t random = 11;
  for (int i = 0; i < KINDS; i++)
    for (int p = 0; p < 3; p++) {
      const abbe_microfacets *m = &kinds[i];
      double wo[3], h[3], wi[3], all = 0, near = 0;
      direction(polar[p], 20, wo);
      for (int k = 0; k < SAMPLES; k++) {
        const double u[2] = {random_between(&random, 0, 1), random_between(&random, 0, 1)};
        const double share = abbe_microfacets_sample(m, wo, u, h, wi);
        assert_near(abbe_vector_dot(wi, wi), 1, 1e-9);
        assert_true(share >= 0 && share <= 1 && (share > 0) == (wi[2] > 0));
        all += share;
        if (wi[2] > 0.8) near += share;
        if (k >= 200) continue;
        const double f = abbe_microfacets_reflect(m, wi, wo) * wi[2];
        assert_near(share * abbe_microfacets_pdf(m, wo, wi), f, 1e-9 * f + 1e-12);
      }
      assert_true(all <= SAMPLES);
      if (p > 0 || m->x < m->y || m->y < m->x) continue;
      const double five = 5 * 0.5 / sqrt(SAMPLES), t = (1 - 0.8) / (1 + 0.8);
      assert_near(all / SAMPLES, straight(m->x, 1 - 1e-9), five);
      assert_near(near / SAMPLES, straight(m->x, t), five);
    }
}

static double shared_out(const abbe_microfacets *m, const double wo[3], const double h[3]) {
  const double along = abbe_vector_dot(wo, h);
  double wi[3];
  if (!(along > 0)) return 0;
  for (int k = 0; k < 3; k++) wi[k] = 2 * along * h[k] - wo[k];
  return abbe_microfacets_pdf(m, wo, wi) * 4 * along; /* by the facet's normal */
}

/* Counted in sectors of the facets' slopes, too: a density that is of another lobe fails. */
TEST(samples_fall_where_the_density_says) {
  enum { SAMPLES = 200000 };
  uint64_t random = 3;
  for (int i = 0; i < KINDS; i++) {
    const abbe_microfacets *m = &kinds[i];
    double wo[3], h[3], wi[3];
    int narrow = 0;
    direction(40, 250, wo);
    assert_near(integrate(shared_out, m, wo), 1, 2e-3);
    direction(0, 0, wo);
    for (int k = 0; k < SAMPLES; k++) {
      const double u[2] = {random_between(&random, 0, 1), random_between(&random, 0, 1)};
      abbe_microfacets_sample(m, wo, u, h, wi);
      narrow += fabs(h[0] / h[2]) < m->x;
    }
    /* the slope along x alone: 1 / (2 a) (1 + s^2 / a^2)^(-3/2), of which 1 / sqrt 2 is within a */
    assert_near((double)narrow / SAMPLES, sqrt(0.5), 5 * 0.5 / sqrt(SAMPLES));
  }
}

/* A mirror is what is left as roughness goes, at all angles; the share that it loses goes with the
 * square. */
TEST(no_roughness_is_a_mirror) {
  uint64_t random = 17;
  for (double a = 0.1; a >= ABBE_MICROFACETS_LEAST; a /= 10) {
    const abbe_microfacets m = {a, 0.5 * a};
    double lost = 0;
    for (int k = 0; k < 2000; k++) {
      const double u[2] = {random_between(&random, 0, 0.9), random_between(&random, 0, 1)};
      double wo[3], h[3], wi[3];
      direction(random_between(&random, 0, 40), random_between(&random, 0, 360), wo);
      lost += 1 - abbe_microfacets_sample(&m, wo, u, h, wi);
      const double mirror[3] = {-wo[0], -wo[1], wo[2]};
      assert_true(abbe_vector_dot(wi, mirror) > cos(fmin(12 * a, ABBE_PI)));
    }
    assert_true(lost / 2000 < 3 * a * a);
  }
}
