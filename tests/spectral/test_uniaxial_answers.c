/* Known answers of uniaxial crystals: closed forms, and numbers of the full boundary conditions
 * from another hand. */
#include "tests/spectral/crystal_faces.h"

#include "base/maths.h"
#include "spectral/uniaxial.h"

#include <complex.h>

static const abbe_uniaxial air = {1, 1, {0, 0, 1}};
static const abbe_uniaxial_mode O = ABBE_UNIAXIAL_ORDINARY, E = ABBE_UNIAXIAL_EXTRAORDINARY;

static double total(const abbe_uniaxial_split *s) {
  return s->reflected[0].share + s->reflected[1].share + s->transmitted[0].share +
         s->transmitted[1].share;
}

static abbe_uniaxial spar(double x, double y, double z) {
  const double length = sqrt(x * x + y * y + z * z);
  return (abbe_uniaxial){1.65834, 1.48613, {x / length, y / length, z / length}};
}

static double most_walk_off(double o, double e) {
  return degrees(abbe_uniaxial_walk_off(o, e, cos(atan(e / o))));
}

TEST(walk_off_of_crystals) {
  assert_near(degrees(abbe_uniaxial_walk_off(1.65834, 1.48613, sqrt(0.5))), 6.232257, 1e-6);
  assert_near(most_walk_off(1.65834, 1.48613), 6.269457, 1e-6);
  assert_near(degrees(atan(1.48613 / 1.65834)), 41.86527, 1e-5);
  assert_near(tan(abbe_uniaxial_walk_off(1.65834, 1.48613, cos(radians(44.6)))), 0.1093605, 1e-7);
  assert_near(most_walk_off(1.5442, 1.5533), 0.33665, 1e-5);
  assert_near(most_walk_off(1.925, 1.984), 1.72944, 1e-5);
  assert_near(most_walk_off(2.616, 2.903), 5.95365, 1e-5);
}

/* Reflected into s and p by light of s and of p. */
static void reflect(abbe_uniaxial m, double degree, double out[2][2]) {
  double in[3];
  down(degree, in);
  for (int from = 0; from < 2; from++) {
    abbe_uniaxial_split s;
    abbe_uniaxial_meet(&air, &m, up, (abbe_uniaxial_mode)from, in, &s);
    for (int to = 0; to < 2; to++) out[from][to] = s.reflected[to].share;
    assert_near(total(&s), 1, 1e-13);
  }
}

TEST(air_to_calcite) {
  const struct {
    double axis[3], degree, ss, sp, pp;
  } rows[] = {{{0, 0, 1}, 30, 0.0853982, 0, 0.0432403},
              {{1, 0, 0}, 30, 0.0853982, 0, 0.0221650},
              {{0, 1, 0}, 30, 0.0554475, 0, 0.0408032},
              {{1, 1, 0}, 30, 0.0697565, 0.0007536, 0.0306925},
              {{1, 1, 0}, 60, 0.2001170, 0.0008624, 0.0018110}};
  for (int i = 0; i < 5; i++) {
    double r[2][2];
    reflect(spar(rows[i].axis[0], rows[i].axis[1], rows[i].axis[2]), rows[i].degree, r);
    assert_near(r[0][0], rows[i].ss, 1e-7);
    assert_near(r[0][1], rows[i].sp, 1e-7);
    assert_near(r[1][0], rows[i].sp, 1e-7);
    assert_near(r[1][1], rows[i].pp, 1e-7);
  }
}

TEST(brewsters_angle_of_calcite) {
  const double axes[3][3] = {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  const double wanted[3] = {60.78699, 54.03402, 58.90949};
  for (int i = 0; i < 3; i++) {
    const abbe_uniaxial m = spar(axes[i][0], axes[i][1], axes[i][2]);
    double r[2][2];
    reflect(m, wanted[i], r);
    assert_near(r[1][1], 0, 1e-12);
    for (int side = -1; side <= 1; side += 2) {
      reflect(m, wanted[i] + 1e-3 * side, r);
      assert_true(r[1][1] > 5e-12);
    }
  }
}

/* A tilted axis, and a wave inside that becomes two. */
TEST(oblique_axes_of_calcite) {
  abbe_uniaxial_split s;
  double in[3];
  down(30, in);
  in[2] = -in[2];
  const double below[3] = {0, 0, -1};
  const abbe_uniaxial m = spar(1, 0, 1);
  abbe_uniaxial_meet_unpolarised(&air, &m, below, in, &s);
  assert_near(degrees(asin(s.transmitted[E].normal[0])), 18.00080, 1e-5);
  assert_near(degrees(asin(s.transmitted[E].ray[0])), 12.60769, 1e-5);
  assert_near(degrees(asin(s.transmitted[O].ray[0])), 17.54810, 1e-5);
  const double t = radians(60), p = radians(30), sine = 1.2 / 1.65834;
  const abbe_uniaxial n = spar(sin(t) * cos(p), sin(t) * sin(p), cos(t));
  const double inside[3] = {sine, 0, sqrt(1 - sine * sine)};
  abbe_uniaxial_meet(&n, &air, below, O, inside, &s);
  assert_near(s.reflected[O].share, 0.090781, 1e-6);
  assert_near(s.reflected[E].share, 0.909219, 1e-6);
}

/* Calcite's Wollaston prism of 15 degrees: both rays, in air again. */
TEST(wollastons_prism) {
  const abbe_uniaxial first = spar(1, 0, 0), second = spar(0, 1, 0);
  const double a = radians(15), slanted[3] = {sin(a), 0, -cos(a)}, below[3] = {0, 0, -1};
  double found[2];
  for (int wave = 0; wave < 2; wave++) {
    abbe_uniaxial_split s;
    const double in[3] = {0, 0, 1};
    abbe_uniaxial_meet(&first, &second, slanted, (abbe_uniaxial_mode)wave, in, &s);
    const int other = 1 - wave;
    assert_near(s.transmitted[wave].share, 0, 1e-20);
    double ray[3];
    memcpy(ray, s.transmitted[other].ray, sizeof ray);
    abbe_uniaxial_meet(&second, &air, below, (abbe_uniaxial_mode)other, ray, &s);
    const int strong = s.transmitted[0].share > s.transmitted[1].share ? 0 : 1;
    found[wave] = degrees(asin(s.transmitted[strong].ray[0]));
  }
  assert_near(fabs(found[0]), 2.65587, 1e-5);
  assert_near(fabs(found[1]), 2.63497, 1e-5);
  assert_true(found[0] * found[1] < 0);
}

/* The air gap of a Glan prism, its axis across the plane of incidence: which wave goes no further,
 * from where. */
TEST(critical_angles_of_a_glan_prism) {
  const double wanted[2] = {37.08597, 42.29041}, below[3] = {0, 0, -1};
  const abbe_uniaxial m = spar(0, 1, 0);
  for (int wave = 0; wave < 2; wave++)
    for (int side = -1; side <= 1; side += 2) {
      const double angle = radians(wanted[wave] + 1e-5 * side), in[3] = {sin(angle), 0, cos(angle)};
      abbe_uniaxial_split s;
      abbe_uniaxial_meet(&m, &air, below, (abbe_uniaxial_mode)wave, in, &s);
      const double passed = s.transmitted[0].share + s.transmitted[1].share;
      assert_near(s.reflected[wave].share + passed, 1, 1e-12);
      assert_true(side < 0 ? passed > 1e-4 : passed == 0);
    }
}

/* A slab whose axis lies in its face, head on, with all that goes to and fro. */
TEST(a_slab_of_calcite_head_on) {
  const double wanted[2] = {0.1155736, 0.0736532};
  const abbe_uniaxial m = spar(0, 1, 0);
  double r[2][2];
  reflect(m, 0, r);
  for (int i = 0; i < 2; i++) {
    const double one = r[i == 0][i == 0]; /* its axis along y: s sees n_e */
    assert_near(2 * one / (1 + one), wanted[i], 1e-7);
  }
}

/* ---- absorption by direction ---- */

TEST(tourmalines_extraordinary_wave_loses_by_its_ray) {
  const double o = 1.644, e = 1.624;
  const abbe_uniaxial m = {o, e, {0, 0, 1}};
  const struct {
    double a_o, a_e, degree, wanted;
  } rows[] = {{2000, 300, 30, 1563.166}, {20, 300, 60, 231.9069}};
  for (int i = 0; i < 2; i++) {
    const double normal[3] = {sin(radians(rows[i].degree)), 0, cos(radians(rows[i].degree))};
    double ray[3];
    abbe_uniaxial_ray(&m, E, normal, ray);
    assert_near(abbe_uniaxial_attenuation(o, e, rows[i].a_o, rows[i].a_e, ray[2]), rows[i].wanted,
                5e-7 * rows[i].wanted);
  }
  assert_near(abbe_uniaxial_attenuation(o, e, 2000, 300, 1), 2000, 1e-12);
  assert_near(abbe_uniaxial_attenuation(o, e, 2000, 300, 0), 300, 1e-12);
}

/* What is left of unpolarised light that runs head on through two plates, in the waves of the
 * second; of what faces reflect nothing counts. mm: the thickness of each. */
static void two_plates(const abbe_uniaxial *first, const abbe_uniaxial *second, const double mm[2],
                       double left[2]) {
  const abbe_uniaxial *plates[2] = {first, second};
  const double in[3] = {0, 0, -1};
  double lost[2][2];
  abbe_uniaxial_split s, t;
  for (int plate = 0; plate < 2; plate++) {
    const abbe_uniaxial *m = plates[plate];
    abbe_uniaxial_meet_unpolarised(&air, m, up, in, &s);
    for (int wave = 0; wave < 2; wave++) {
      const double per_m = wave == 0
                               ? 2000
                               : abbe_uniaxial_attenuation(m->n_o, m->n_e, 2000, 300,
                                                           dot(s.transmitted[E].ray, m->axis));
      assert_near(s.transmitted[wave].ray[2], -1, 1e-15);
      lost[plate][wave] = exp(-per_m * mm[plate] / 1000);
    }
  }
  left[0] = left[1] = 0;
  for (int from = 0; from < 2; from++) {
    abbe_uniaxial_meet(first, second, up, (abbe_uniaxial_mode)from, in, &t);
    const double passed = t.transmitted[0].share + t.transmitted[1].share;
    assert_near(passed, 1, 1e-4);
    for (int to = 0; to < 2; to++)
      left[to] += 0.5 * lost[0][from] * t.transmitted[to].share / passed * lost[1][to];
  }
}

TEST(plates_of_tourmaline_polarise) {
  const abbe_uniaxial m = {1.644, 1.624, {1, 0, 0}}, crossed = {1.644, 1.624, {0, 1, 0}},
                      upright = {1.644, 1.624, {0, 0, 1}};
  double left[2];
  two_plates(&m, &m, (const double[2]){1, 0}, left);
  assert_near(2 * left[O], 0.135335, 5e-7);
  assert_near(2 * left[E], 0.740818, 5e-7);
  assert_near(left[O] + left[E], 0.438077, 5e-7);
  assert_near((left[E] - left[O]) / (left[E] + left[O]), 0.691069, 5e-7);
  two_plates(&m, &m, (const double[2]){1, 1}, left);
  assert_near(left[O] + left[E], 0.283564, 5e-7);
  two_plates(&m, &crossed, (const double[2]){1, 1}, left);
  assert_near(left[O] + left[E], 0.100259, 5e-7);
  /* along the axis both waves are ordinary: one exponential */
  two_plates(&upright, &upright, (const double[2]){1, 0.5}, left);
  assert_near(left[O] + left[E], exp(-3), 1e-15);
}

/* The complex tensor: the index of a wave along `normal` is complex, and what it loses a metre of
 * ray is 2 k0 Im n times the cosine between both. */
TEST(loss_along_the_ray_is_that_of_the_complex_index) {
  const double k0 = 2 * ABBE_PI / 550e-9;
  for (int i = 0; i < 200; i++) {
    const double o = 1.4 + next(), e = 1.4 + next(), a[2] = {1000 * next(), 1000 * next()},
                 c = next();
    const double _Complex eo = o * o + I * o * a[0] / k0, ee = e * e + I * e * a[1] / k0;
    const double _Complex square = 1 / (c * c / eo + (1 - c * c) / ee);
    const double imaginary = cimag(csqrt(square));
    const abbe_uniaxial m = {o, e, {0, 0, 1}};
    const double normal[3] = {sqrt(1 - c * c), 0, c};
    double ray[3];
    abbe_uniaxial_ray(&m, E, normal, ray);
    const double wanted = 2 * k0 * imaginary * dot(normal, ray);
    assert_near(abbe_uniaxial_attenuation(o, e, a[0], a[1], ray[2]), wanted, 1e-6 * wanted);
  }
}
