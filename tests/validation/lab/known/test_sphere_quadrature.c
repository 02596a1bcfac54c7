/* The quadrature against closed forms, and against rays traced one by one as vectors. */
#include "tests/check.h"

#include "base/maths.h"
#include "spectral/formats/material_import.h"
#include "spectral/optics.h"
#include "validation/lab/known/known_light.h"

static abbe_sphere_quadrature *make(const abbe_sphere_setup *setup) {
  abbe_sphere_quadrature *q = NULL;
  OK(abbe_sphere_quadrature_make(setup, &q, &error));
  return q;
}

static double enclosed(const abbe_sphere_setup *setup, double radius_m) {
  HELD(abbe_sphere_quadrature, q) = make(setup);
  double flux = NAN;
  OK(abbe_sphere_quadrature_enclosed(q, radius_m, &flux, &error));
  return flux;
}

/* ---- closed forms ---- */

TEST(a_sphere_of_air_lets_all_light_pass) {
  abbe_sphere_setup s = {.radius = 0.03, .index = 1, .plane_distance = 0.1, .power = 7};
  for (double r = 0; r < 0.05; r += 0.004) {
    double inside = fmin(r, 0.03);
    assert_near(enclosed(&s, r), 7 * ABBE_PI * inside * inside, 1e-13);
    s.past = s.outside = true;
    s.inner_orders = 5;
    assert_near(enclosed(&s, r), 7 * ABBE_PI * r * r, 1e-13);
    s.past = s.outside = false;
  }
  s.light_distance = 0.2;
  s.past = true;
  for (double r = 0; r < 0.1; r += 0.007)
    assert_near(enclosed(&s, r), 7 * 2 * ABBE_PI * (1 - 0.3 / hypot(0.3, r)), 1e-12);
  assert_near(enclosed(&s, INFINITY), 7 * 2 * ABBE_PI, 1e-12);
}

/* A beam through an absorbing ball: 2 (1 - (1 + y) exp(-y)) / y^2 of it is left, y = 2 a R: the
 * absorption of large soft particles (anomalous diffraction) [VanDeHulst1957]. */
TEST(an_absorbing_ball) {
  for (double y = 0.01; y < 30; y *= 3) {
    abbe_sphere_setup s = {.radius = 0.02, .index = 1, .plane_distance = 0.1, .power = 1};
    s.attenuation_per_m = y / (2 * s.radius);
    double left = 2 * (1 - (1 + y) * exp(-y)) / (y * y);
    assert_near(enclosed(&s, 1) / (ABBE_PI * 0.02 * 0.02), left, 1e-9);
  }
}

/* On the axis a thin pencil from the point at s spreads as the lens equation says. The plane is so
 * close that no ray from further out crosses the axis at it. */
TEST(the_axis_is_paraxial_optics) {
  const double indices[] = {0.8, 1.05, 1.1, 1.25, 1.33}, distances[] = {0, 0.15, 1};
  for (int i = 0; i < 5; i++)
    for (int k = 0; k < 3; k++) {
      double n = indices[i], R = 0.05, h = 0.05025, s = distances[k], r = 1e-7;
      abbe_sphere_setup setup = {.radius = R, .index = n, .plane_distance = h, .power = 1};
      setup.light_distance = s;
      /* height at the sphere's centre's plane 1, slope before; the ball's power is 2 (n - 1) / nR
       */
      double slope = (s > 0 ? 1 / s : 0) - 2 * (n - 1) / (n * R), here = 1 + h * slope;
      double before = s > 0 ? 1 / (s * s) : 1, through = 1 - pow((n - 1) / (n + 1), 2);
      double irradiance = before * through * through / (here * here);
      assert_near(enclosed(&setup, r) / (ABBE_PI * r * r) / irradiance, 1, 1e-6);
    }
}

/* Under a drop of n = 4/3 the bow of three inner reflections stands 41.6 degrees from straight
 * on; the first two are thrown back and never reach the plane [Adam2002]. */
TEST(the_tertiary_rainbow_is_a_fold) {
  abbe_sphere_setup s = {.radius = 1e-6, .index = 4.0 / 3, .plane_distance = 1, .power = 1};
  const double *fold = NULL;
  s.without_direct_order = true;
  s.inner_orders = 2;
  HELD(abbe_sphere_quadrature, q) = make(&s);
  for (size_t i = abbe_sphere_quadrature_folds(q, &fold); i-- > 0;)
    assert_true(fold[i] > tan(80 * ABBE_PI / 180));
  abbe_sphere_quadrature_free(q);
  s.inner_orders = 3;
  q = make(&s);
  bool seen = false;
  size_t count = abbe_sphere_quadrature_folds(q, &fold);
  for (size_t i = 0; i < count; i++)
    seen = seen || fabs(atan(fold[i]) * 180 / ABBE_PI - 41.6) < 0.05;
  assert_true(seen);
}

/* Below the focus the marginal rays cross the axis first: all light lies inside the fold until the
 * marginal ray leaves it. Where the fold stands, the landing has its extreme. */
TEST(the_fold_bounds_the_core) {
  abbe_sphere_setup s = {.radius = 1, .index = 1.5, .plane_distance = 1.3, .power = 1};
  double widest = 0;
  for (int k = 0; k < 200000; k++) { /* the rays that land on the near side of the axis */
    double i = (k + 0.5) / 200000 * ABBE_PI / 2, turn = 2 * (i - asin(sin(i) / 1.5));
    double x = (sin(i) - 1.3 * sin(turn)) / cos(turn);
    if (turn < 1) widest = fmax(widest, x);
  }
  const double *fold = NULL;
  HELD(abbe_sphere_quadrature, q) = make(&s);
  assert_int_equal(abbe_sphere_quadrature_folds(q, &fold), 1);
  assert_near(fold[0], widest, 1e-9);
}

/* ---- against rays traced as vectors ---- */

enum { RAYS = 20000, CIRCLES = 9 };

static void unit(double v[2]) {
  double length = hypot(v[0], v[1]);
  v[0] /= length;
  v[1] /= length;
}

static void score(const abbe_sphere_setup *s, const double at[2], const double to[2], double flux,
                  const double *radius, double *sum) {
  if (!(to[1] < 0)) return;
  double x = fabs(at[0] + to[0] * (at[1] + s->plane_distance) / -to[1]);
  for (int k = 0; k < CIRCLES; k++)
    if (x <= radius[k]) sum[k] += flux;
}

/* From the point `at` on the sphere inside it along `to`: to the other side, and on. */
static void follow_inside(const abbe_sphere_setup *s, double at[2], double to[2], double flux,
                          const double *radius, double *sum) {
  for (size_t k = 0; k <= s->inner_orders; k++) {
    double along = -2 * (at[0] * to[0] + at[1] * to[1]);
    at[0] += along * to[0];
    at[1] += along * to[1];
    flux *= abbe_optics_transmittance(s->attenuation_per_m, along);
    double in[3] = {-at[0] / s->radius, -at[1] / s->radius, 0}, wi[3] = {-to[0], -to[1], 0};
    double wt[3], wo[3], cosine = wi[0] * in[0] + wi[1] * in[1];
    double reflected = abbe_optics_fresnel(cosine, s->index);
    if (abbe_optics_refract(wi, in, s->index, wt) && !(k == 0 && s->without_direct_order))
      score(s, at, wt, flux * (1 - reflected), radius, sum);
    abbe_optics_reflect(wi, in, wo);
    flux *= reflected;
    to[0] = wo[0];
    to[1] = wo[1];
  }
}

static void trace(const abbe_sphere_setup *s, const double *radius, double *sum) {
  double beam = s->power * ABBE_PI * s->radius * s->radius / RAYS, R = s->radius,
         d = s->light_distance;
  double edge = d > 0 ? sqrt((1 - R / d) * (1 + R / d)) : 0;
  double cone = s->power * 2 * ABBE_PI * (1 - edge) / RAYS;
  for (int k = 0; k < RAYS; k++) {
    double u = (k + 0.5) / RAYS, to[2] = {0, -1}, at[2] = {R * sqrt(u), 0};
    if (d > 0) { /* evenly over the solid angle of the cone around the sphere */
      double cosine = 1 - u * (1 - edge);
      to[0] = sqrt((1 - cosine) * (1 + cosine));
      to[1] = -cosine;
      double near = d * cosine - sqrt(fmax(0, R * R - d * d * to[0] * to[0]));
      at[0] = near * to[0];
      at[1] = d + near * to[1];
    } else {
      at[1] = R * sqrt(1 - u);
    }
    double n[3] = {at[0], at[1], 0}, wi[3] = {-to[0], -to[1], 0}, wt[3], wo[3];
    unit(n);
    double cosine = wi[0] * n[0] + wi[1] * n[1], flux = d > 0 ? cone : beam;
    double reflected = abbe_optics_fresnel(cosine, 1 / s->index);
    abbe_optics_reflect(wi, n, wo);
    if (s->outside) score(s, at, wo, flux * reflected, radius, sum);
    if (abbe_optics_refract(wi, n, 1 / s->index, wt)) {
      to[0] = wt[0];
      to[1] = wt[1];
      follow_inside(s, at, to, flux * (1 - reflected), radius, sum);
    }
  }
}

/* The rays' own error: each circle's edge cuts one stratum a crossing, of a few a way. */
static void compare(const abbe_sphere_setup *s) {
  double radius[CIRCLES], sum[CIRCLES] = {0};
  for (int k = 0; k < CIRCLES; k++) radius[k] = s->radius * 0.02 * pow(2, k);
  trace(s, radius, sum);
  HELD(abbe_sphere_quadrature, q) = make(s);
  double incident = s->power * ABBE_PI * pow(s->radius, 2);
  if (s->light_distance > 0)
    incident = s->power * 2 * ABBE_PI * (1 - sqrt(1 - pow(s->radius / s->light_distance, 2)));
  double tolerance = incident * (3.0 + (double)s->inner_orders) / RAYS;
  for (int k = 0; k < CIRCLES; k++) {
    double flux = NAN;
    OK(abbe_sphere_quadrature_enclosed(q, radius[k], &flux, &error));
    assert_near(flux, sum[k], tolerance);
  }
}

TEST(every_order_agrees_with_traced_rays) {
  const double indices[] = {0.7, 0.99, 1, 1.02, 1.33, 1.5, 1.8, 2.4, 4};
  const double planes[] = {1.001, 1.3, 2, 10}, lights[] = {0, 1.05, 2, 30};
  for (int n = 0; n < 9; n++)
    for (int h = 0; h < 4; h++)
      for (int l = 0; l < 4; l++) {
        abbe_sphere_setup s = {.radius = 0.04, .index = indices[n], .power = 3};
        s.plane_distance = planes[h] * s.radius;
        s.light_distance = lights[l] * s.radius;
        if ((n + h + l) % 2 == 0) s.attenuation_per_m = 12;
        s.inner_orders = (size_t)(4 * ((n + h) % 2));
        s.outside = (h + l) % 2 == 1;
        s.without_direct_order = n % 3 == 2;
        compare(&s);
      }
}

/* ---- laws ---- */

TEST(wider_circles_hold_more) {
  abbe_sphere_setup s = {.radius = 0.05, .index = 1.6, .plane_distance = 0.09, .power = 2};
  s.inner_orders = 3;
  HELD(abbe_sphere_quadrature, q) = make(&s);
  double inner = 0, outer;
  for (int i = 0; i <= 32; i++) {
    OK(abbe_sphere_quadrature_enclosed(q, 0.08 * i / 32, &outer, &error));
    assert_true(outer >= inner);
    inner = outer;
  }
}

/* Scaling everything changes nothing but the unit. */
TEST(the_answer_has_no_unit_of_its_own) {
  for (double scale = 1e-4; scale < 1e6; scale *= 100) {
    abbe_sphere_setup s = {.radius = 0.4 * scale, .index = 1.6, .plane_distance = 0.7 * scale};
    s.power = 1 / (scale * scale);
    s.inner_orders = 2;
    s.attenuation_per_m = 0.5 / scale;
    abbe_sphere_setup one = {.radius = 0.4, .index = 1.6, .plane_distance = 0.7, .power = 1};
    one.inner_orders = 2;
    one.attenuation_per_m = 0.5;
    assert_near(enclosed(&s, 0.1 * scale) / enclosed(&one, 0.1), 1, 1e-10);
  }
}

/* Each further way adds light, and all of them together less than fell on the sphere. */
TEST(nothing_is_made) {
  abbe_sphere_setup s = {.radius = 1, .index = 1.3, .plane_distance = 1.01, .power = 1};
  s.outside = true;
  double before = 0;
  for (size_t orders = 0; orders <= 12; orders += 3) {
    s.inner_orders = orders;
    double all = enclosed(&s, INFINITY);
    assert_true(all >= before);
    assert_true(all < ABBE_PI);
    before = all;
  }
}

TEST(white_light_is_the_sum_of_its_bands) {
  const abbe_material *flint = NULL;
  const abbe_illuminant d65 = {0};
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  OK(abbe_material_table_find(&table, "sf10", &flint, &error));
  abbe_sphere_setup s = {.radius = 0.04, .plane_distance = 0.07, .power = 5};
  const double radius[] = {0.002, 0.01, INFINITY};
  double coarse[3][3], fine[3][3], white[1][3];
  OK(abbe_sphere_quadrature_xyz(&s, flint, &d65, 380, 780, 100, radius, 3, coarse, &error));
  OK(abbe_sphere_quadrature_xyz(&s, flint, &d65, 380, 780, 400, radius, 3, fine, &error));
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) assert_near(coarse[i][k] / fine[i][k], 1, 2e-4);
  /* every band's power adds up to the light's white with Y = power */
  abbe_material air = {.dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1}},
                       .min_nm = 1,
                       .max_nm = 1e5};
  OK(abbe_sphere_quadrature_xyz(&s, &air, &d65, 380, 780, 40, radius + 2, 1, white, &error));
  assert_near(white[0][1], 5 * ABBE_PI * 0.04 * 0.04, 1e-12);
  assert_near(white[0][0] / white[0][1], 0.95043, 2e-4); /* D65 [CIE15] */
  assert_near(white[0][2] / white[0][1], 1.08880, 5e-4);
}

/* ---- wrong use ---- */

static void refuse(abbe_sphere_setup s, const char *part) {
  abbe_sphere_quadrature *q = NULL;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sphere_quadrature_make(&s, &q, &error));
  assert_null(q);
  assert_contains(last_error.text, part);
}

TEST(wrong_setups_are_refused) {
  const abbe_sphere_setup s = {.radius = 1, .index = 1.5, .plane_distance = 2, .power = 1};
  abbe_sphere_setup w = s;
  refuse((w.radius = 0, w), "radius is 0");
  refuse((w = s, w.radius = NAN, w), "radius");
  refuse((w = s, w.index = 0.05, w), "index is 0.05; it must be from 0.1 to 10");
  refuse((w = s, w.plane_distance = 1, w), "plane_distance is 1");
  refuse((w = s, w.plane_distance = INFINITY, w), "plane_distance");
  refuse((w = s, w.light_distance = 0.5, w), "light_distance is 0.5");
  refuse((w = s, w.power = -1, w), "power is -1");
  refuse((w = s, w.attenuation_per_m = -1, w), "attenuation_per_m is -1");
  refuse((w = s, w.inner_orders = 65, w), "65 inner orders");
  HELD(abbe_sphere_quadrature, q) = make(&s);
  double flux = 0;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sphere_quadrature_enclosed(q, -1, &flux, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_sphere_quadrature_enclosed(q, NAN, &flux, &error));
  abbe_sphere_quadrature_free(NULL);
}
