#include "spectral/polarisation.h"

#include "tests/check.h"

#include "base/maths.h"
#include "spectral/uniaxial.h"

#define DIAMOND 2.417
#define GLASS 1.5

static const double natural[4] = {1, 0, 0, 0};

static abbe_film_light face(double from, double to, double k, double degrees) {
  const double medium[2] = {to, k};
  abbe_film_light out;
  abbe_film_light_at(NULL, 0, false, from, medium, cos(degrees * ABBE_DEGREE), 550, &out);
  return out;
}

static abbe_jones mirror(double from, double to, double k, double degrees) {
  const abbe_film_light light = face(from, to, k, degrees);
  return abbe_jones_of_face(&light, true);
}

/* r_s r_p*, whose argument is what s lags behind p. */
static double complex retards(double n, double degrees) {
  const abbe_film_light l = face(n, 1, 0, degrees);
  return (l.r[0][0] + I * l.r[0][1]) * (l.r[1][0] - I * l.r[1][1]);
}

static void pass(const abbe_jones *jones, const double in[4], double turned, double out[4]) {
  const double a = turned * ABBE_DEGREE;
  double s[4];
  abbe_stokes_turn(in, cos(a), sin(a), s);
  abbe_jones_apply(jones, s, s);
  abbe_stokes_turn(s, cos(a), -sin(a), out);
}

static const abbe_jones sheet = {{{1, 0}, {0, 0}}};

static double two_sheets(const abbe_jones *between, double degrees, double turned) {
  double s[4];
  pass(&sheet, natural, 0, s);
  pass(between, s, turned, s);
  pass(&sheet, s, degrees, s);
  return s[0];
}

TEST(polarisers_and_plates_between_them) {
  const abbe_jones none = {{{1, 0}, {0, 1}}}, quarter = {{{1, 0}, {0, I}}},
                   half = {{{1, 0}, {0, -1}}};
  assert_near(two_sheets(&none, 30, 0), 0.375, 1e-15);
  assert_near(two_sheets(&none, 90, 0), 0, 1e-15);
  assert_near(two_sheets(&quarter, 90, 45), 0.25, 1e-15);
  assert_near(two_sheets(&half, 90, 45), 0.5, 1e-15);
}

/* Of quartz at 589.3 nm, axis in its face: 16.1896 um make a quarter of a wave, whose sixth digit
 * is 1e-6 of the light. */
TEST(a_quarter_wave_plate_of_quartz) {
  const abbe_uniaxial air = {1, 1, {0, 0, 1}}, quartz = {1.5442, 1.5533, {0, 1, 0}};
  const double up[3] = {0, 0, 1}, down[3] = {0, 0, -1}, waves = 16.1896 / 0.5893;
  abbe_uniaxial_split s;
  abbe_uniaxial_meet_unpolarised(&air, &quartz, up, down, &s);
  const double o = s.transmitted[ABBE_UNIAXIAL_ORDINARY].index,
               e = s.transmitted[ABBE_UNIAXIAL_EXTRAORDINARY].index;
  assert_near(0.5893 / 4 / (e - o), 16.1896, 5e-5);
  const abbe_jones plate = {
      {{cexp(2 * ABBE_PI * I * o * waves), 0}, {0, cexp(2 * ABBE_PI * I * e * waves)}}};
  assert_near(two_sheets(&plate, 90, 45), 0.25, 2e-6);
  double circular[4] = {1, 0, 1, 0};
  abbe_jones_apply(&plate, circular, circular);
  assert_near(fabs(circular[3]), 1, 1e-10);
}

/* Ex = 1 and Ey = -i: clockwise to one who looks into the light. */
TEST(the_sign_of_circular_light) {
  const abbe_jones right = {{{1, 0}, {-I, 0}}};
  const double x[4] = {1, 1, 0, 0};
  double s[4];
  abbe_jones_apply(&right, x, s);
  assert_near(s[0], 2, 1e-15);
  assert_near(s[3], 2, 1e-15);
  pass(&sheet, natural, 45, s);
  assert_near(s[2], 0.5, 1e-15);
}

TEST(the_angle_of_brewster) {
  const double angle = atan(GLASS) / ABBE_DEGREE, diamond = atan(DIAMOND) / ABBE_DEGREE;
  const abbe_film_light l = face(1, GLASS, 0, angle);
  assert_near(angle, 56.30993, 5e-6);
  assert_near(l.reflected[ABBE_FILM_S], 0.1479290, 5e-8);
  assert_near(l.reflected[ABBE_FILM_P], 0, 1e-15);
  double s[4];
  const abbe_jones through = abbe_jones_of_face(&l, false);
  abbe_jones_apply(&through, natural, s);
  assert_near(abbe_stokes_degree(s), 0.0798722, 5e-8);
  assert_near(diamond, 67.5234, 5e-5);
  assert_near(face(1, DIAMOND, 0, diamond).reflected[ABBE_FILM_S], 0.500815, 5e-7);
}

/* One face each, their planes of incidence parallel and at right angles. */
TEST(two_glass_mirrors_at_the_angle_of_brewster) {
  const abbe_jones j = mirror(1, GLASS, 0, atan(GLASS) / ABBE_DEGREE);
  double first[4], s[4];
  pass(&j, natural, 0, first);
  pass(&j, first, 0, s);
  assert_near(s[0], 0.0109415, 5e-8);
  pass(&j, first, 90, s);
  assert_near(s[0], 0, 1e-15);
}

/* Plates one behind another, with all that goes to and fro between their faces. */
TEST(piles_of_plates_at_the_angle_of_brewster) {
  static const struct {
    int plates;
    double passed, degree;
  } rows[] = {{1, 0.871134, 0.147929}, {4, 0.709302, 0.409836}, {10, 0.611801, 0.634518}};
  const double outside = atan(GLASS) / ABBE_DEGREE, within = 90 - outside;
  for (int i = 0; i < 3; i++) {
    double t[2];
    for (int p = 0; p < 2; p++) {
      double all = 0;
      t[p] = 1;
      for (int k = 0; k < 2 * rows[i].plates; k++) {
        const abbe_film_light l = k % 2 ? face(GLASS, 1, 0, within) : face(1, GLASS, 0, outside);
        const double r = l.reflected[p], on = l.transmitted[p], between = 1 - all * r;
        all = r + on * on * all / between;
        t[p] *= on / between;
      }
      assert_near(all + t[p], 1, 1e-12);
    }
    assert_near((t[0] + t[1]) / 2, rows[i].passed, 5e-7);
    assert_near((t[1] - t[0]) / (t[1] + t[0]), rows[i].degree, 5e-7);
  }
}

TEST(the_mueller_matrix_of_reflection) {
  const double axis[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  const abbe_jones j = mirror(1, GLASS, 0, 60);
  double m[4][4]; /* by columns */
  for (int c = 0; c < 4; c++) abbe_jones_apply(&j, axis[c], m[c]);
  assert_near(m[0][0], 0.0891867, 5e-8);
  assert_near(m[1][1], m[0][0], 1e-15);
  assert_near(m[1][0], 0.0873848, 5e-8);
  assert_near(m[0][1], m[1][0], 1e-15);
  assert_near(m[2][2], 0.0178373, 5e-8);
  assert_near(m[3][3], m[2][2], 1e-15);
  assert_near(m[2][3], 0, 1e-15);
  assert_near(m[0][2] + m[0][3] + m[1][2] + m[1][3] + m[2][0] + m[3][0], 0, 1e-15);
}

static double greatest(double n, double *at) {
  double best = 0;
  for (double a = asin(1 / n) / ABBE_DEGREE; a < 90; a += 1e-4) {
    const double lag = carg(retards(n, a)) / ABBE_DEGREE;
    if (lag > best) best = lag, *at = a;
  }
  return best;
}

TEST(total_reflection_retards) {
  double at = 0;
  assert_near(carg(retards(GLASS, 45)) / ABBE_DEGREE, 36.86990, 5e-6);
  assert_near(greatest(GLASS, &at), 45.23973, 5e-6);
  assert_near(at, 51.67118, 2e-4);
  const double complex c = retards(DIAMOND, 40.75);
  assert_near(creal(c), 0.1075433, 5e-8);
  assert_near(cimag(c), 0.9942004, 5e-8);
  assert_near(carg(c) / ABBE_DEGREE, 83.826, 5e-4);
  assert_near(greatest(DIAMOND, &at), 90.0934, 5e-5);
  assert_near(at, 32.7288, 2e-4);
  assert_near(carg(retards(1.51, 48.62436)) / ABBE_DEGREE, 45, 1e-5);
  assert_near(carg(retards(1.51, 54.62311)) / ABBE_DEGREE, 45, 1e-5);
}

/* A rhomb of Fresnel's makes light at 45 degrees circular. */
TEST(two_total_reflections_make_light_circular) {
  const abbe_jones j = mirror(1.51, 1, 0, 54.62311);
  double s[4] = {1, 0, 1, 0};
  abbe_jones_apply(&j, s, s);
  abbe_jones_apply(&j, s, s);
  assert_near(fabs(s[3]), 1, 1e-9);
  assert_near(s[0], 1, 1e-15);
}

static const abbe_film_layer layers[] = {
    {0.42, 2.4, 10, NULL}, {2.35, 0, 80, NULL}, {1.38, 0, 120, NULL}};

TEST(no_smooth_face_depolarises) {
  const double in[4] = {1, 0.36, -0.48, 0.8}, glass[2] = {GLASS, 0};
  for (double angle = 0; angle < 90; angle += 3) {
    abbe_film_light light;
    abbe_film_light_at(layers, 3, false, 1, glass, cos(angle * ABBE_DEGREE), 500, &light);
    for (int reflected = 0; reflected < 2; reflected++) {
      const abbe_jones j = abbe_jones_of_face(&light, reflected);
      double s[4];
      abbe_jones_apply(&j, in, s);
      assert_near(abbe_stokes_degree(s), 1, 1e-12);
      abbe_jones_apply(&j, natural, s);
      const double *share = reflected ? light.reflected : light.transmitted;
      assert_near(s[0], (share[0] + share[1]) / 2, 1e-15);
    }
  }
  const double right[4] = {1, 0, 0, 1};
  const double nk[][2] = {{GLASS, 0}, {0.2, 3.4}, {DIAMOND, 0}};
  for (int i = 0; i < 3; i++) {
    const abbe_jones j = mirror(1, nk[i][0], nk[i][1], 0);
    double s[4];
    abbe_jones_apply(&j, right, s);
    assert_near(s[3] / s[0], -1, 1e-12);
  }
}

/* In the frame of the light that runs back, y has the other sign: the Mueller matrix is the
 * transpose, with U turned over on both sides. */
TEST(light_that_runs_back_has_the_same_share) {
  const double from[4] = {1, 0.36, -0.48, 0.8}, to[4] = {1, -0.6, 0.64, 0.48};
  const double ends[2][2] = {{1, 0}, {GLASS, 0}};
  for (double angle = 0; angle < 88; angle += 4) {
    const double c = cos(angle * ABBE_DEGREE), s = sin(angle * ABBE_DEGREE) / GLASS;
    abbe_film_light there, back;
    abbe_film_light_at(layers, 3, false, 1, ends[1], c, 500, &there);
    abbe_film_light_at(layers, 3, true, GLASS, ends[0], sqrt(1 - s * s), 500, &back);
    for (int reflected = 0; reflected < 2; reflected++) {
      const abbe_jones out = abbe_jones_of_face(&there, reflected),
                       in = abbe_jones_of_face(reflected ? &there : &back, reflected);
      double a[4], b[4];
      abbe_jones_apply(&out, from, a);
      abbe_jones_apply(&in, to, b);
      assert_near(to[0] * a[0] + to[1] * a[1] - to[2] * a[2] + to[3] * a[3],
                  from[0] * b[0] + from[1] * b[1] - from[2] * b[2] + from[3] * b[3], 1e-14);
    }
  }
}
