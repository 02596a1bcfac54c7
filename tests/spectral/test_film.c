#include "spectral/film.h"

#include "tests/check.h"

#include "base/maths.h"
#include "spectral/biaxial.h"
#include "spectral/optics.h"

#include <complex.h>
#include <stdint.h>

#define MGF2_NM (550 / (4 * 1.38)) /* a quarter of a wavelength of 550 nm */

typedef struct stack {
  size_t count;
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
} stack;

static const double glass[2] = {1.52, 0};

static abbe_film_light at(const stack *s, bool reversed, double from, const double to[2],
                          double degrees, double nm) {
  abbe_film_light out;
  abbe_film_light_at(s->layer, s->count, reversed, from, to, cos(degrees * ABBE_DEGREE), nm, &out);
  return out;
}

static double reflected(const stack *s, double to, double nm) {
  const double medium[2] = {to, 0};
  return at(s, false, 1, medium, 0, nm).reflected[0];
}

static stack one(double n, double k, double nm) {
  return (stack){1, {{n, k, nm, NULL}}};
}

TEST(an_anti_reflection_coating_of_magnesium_fluoride) {
  const stack s = one(1.38, 0, MGF2_NM);
  const double rows[][2] = {{550, 0.012600790},
                            {450, 0.0162043},
                            {650, 0.0143684},
                            {400, 0.022052515},
                            {700, 0.015961969}};
  for (int i = 0; i < 5; i++)
    assert_near(reflected(&s, 1.52, rows[i][0]), rows[i][1], i == 1 || i == 2 ? 5e-8 : 5e-10);
  const stack none = {0};
  assert_near(reflected(&none, 1.52, 550), 0.042579995, 5e-10);
  abbe_film_light out = at(&s, false, 1, glass, 45, 550);
  assert_near(out.reflected[ABBE_FILM_S], 0.040047718, 5e-10);
  assert_near(out.reflected[ABBE_FILM_P], 0.001355739, 5e-10);
  const double air[2] = {1, 0};
  out = at(&s, true, 1.52, air, 30, 550);
  assert_near(out.reflected[ABBE_FILM_S], 0.051454540, 5e-10);
  assert_near(out.reflected[ABBE_FILM_P], 0.000320226, 5e-10);
}

TEST(films_of_a_half_wave_a_root_and_many_layers) {
  const stack none = {0}, half = one(1.38, 0, 2 * MGF2_NM), coated = one(1.38, 0, MGF2_NM);
  assert_near(reflected(&half, 1.52, 550), reflected(&none, 1.52, 550), 1e-15);
  assert_near(reflected(&coated, 2.417, 550), 0.0140705, 5e-8);
  assert_near(reflected(&none, 2.417, 550), 0.1719688, 5e-8);
  const stack root = one(sqrt(2.417), 0, 550 / (4 * sqrt(2.417)));
  assert_near(reflected(&root, 2.417, 550), 0, 1e-15);
  stack many = {.count = 11};
  for (int i = 0; i < 11; i++) {
    const double n = i % 2 == 0 ? 2.35 : 1.38;
    many.layer[i] = (abbe_film_layer){n, 0, 550 / (4 * n), NULL};
  }
  assert_near(reflected(&many, 1.52, 550), 0.994645548, 5e-10);
  const stack three = {
      3, {{1.38, 0, MGF2_NM, NULL}, {2.15, 0, 550 / (2 * 2.15), NULL}, {1.70, 0, 550 / 6.8, NULL}}};
  assert_near(reflected(&three, 1.52, 450), 0.004153581, 5e-10);
  const stack bubble = one(1.33, 0, 100), thin = one(1.33, 0, 5);
  assert_near(reflected(&bubble, 1, 550), 0.0769246, 5e-8);
  assert_near(reflected(&thin, 1, 550), 0.000481, 5e-7);
}

TEST(titania_on_topaz) {
  static const double nm[] = {60, 90, 120, 150};
  static const double row[][3] = {{.28088, .31603, .31102},
                                  {.06030, .17772, .26736},
                                  {.23025, .06251, .09715},
                                  {.29848, .25081, .09302}};
  for (int i = 0; i < 4; i++) {
    const stack s = one(2.40, 0, nm[i]);
    for (int k = 0; k < 3; k++) assert_near(reflected(&s, 1.61, 450 + 100 * k), row[i][k], 5.1e-6);
  }
  const stack s = one(2.40, 0, 120);
  const double air[2] = {1, 0}, topaz[2] = {1.61, 0};
  abbe_film_light in = at(&s, true, 1.61, air, 20, 550);
  assert_near(in.reflected[ABBE_FILM_S], 0.0851382, 5e-8);
  assert_near(in.reflected[ABBE_FILM_P], 0.0323444, 5e-8);
  const double outside = asin(1.61 * sin(20 * ABBE_DEGREE)) / ABBE_DEGREE;
  const abbe_film_light out = at(&s, false, 1, topaz, outside, 550);
  for (int p = 0; p < 2; p++) {
    assert_near(out.reflected[p], in.reflected[p], 1e-14);
    assert_near(out.transmitted[p], 1 - in.reflected[p], 1e-14);
  }
  in = at(&s, true, 1.61, air, 45, 550);
  for (int p = 0; p < 2; p++) {
    assert_near(in.reflected[p], 1, 1e-14);
    assert_true(in.transmitted[p] == 0);
  }
}

TEST(metal_films_absorb_and_pass_alike_both_ways) {
  const double air[2] = {1, 0}, bk7[2] = {1.5168, 0}, topaz[2] = {1.61, 0};
  const stack grey = one(0.42, 2.4, 10), chromium = one(3.18, 4.41, 10);
  abbe_film_light out = at(&grey, false, 1, topaz, 0, 550), in = at(&grey, true, 1.61, air, 0, 550);
  assert_near(out.transmitted[0], 0.7295517, 5e-8);
  assert_near(in.transmitted[0], 0.7295517, 5e-8);
  assert_near(out.reflected[0], 0.1622338, 5e-8);
  assert_near(in.reflected[0], 0.0974556, 5e-8);
  out = at(&chromium, false, 1, bk7, 0, 587.56);
  in = at(&chromium, true, 1.5168, air, 0, 587.56);
  assert_near(out.reflected[0], 0.431482776, 5e-10);
  assert_near(out.transmitted[0], 0.183909144, 5e-10);
  assert_near(in.reflected[0], 0.237165867, 5e-10);
  assert_near(in.transmitted[0], 0.183909144, 5e-10);
}

TEST(a_gap_of_air_is_tunnelled_through) {
  const double bk7[2] = {1.5168, 0};
  const stack gap = one(1, 0, 100);
  const abbe_film_light out = at(&gap, false, 1.5168, bk7, 45, 587.56);
  for (int p = 0; p < 2; p++) assert_near(out.reflected[p] + out.transmitted[p], 1, 1e-14);
  assert_near(out.reflected[ABBE_FILM_S], 0.308006731, 1e-9);
  assert_near(out.reflected[ABBE_FILM_P], 0.158428032, 1e-9);
}

/* coh_tmm of the package tmm [Byrnes2016], its own test. */
TEST(absorbing_layers_on_an_absorbing_ground) {
  const stack s = {2, {{2, 4, 2, NULL}, {3, 0.3, 3, NULL}}};
  const double to[2] = {1, 0.1};
  const abbe_film_light out = at(&s, false, 1, to, 0.1 / ABBE_DEGREE, 100);
  assert_near(out.reflected[ABBE_FILM_S], 0.372732088, 5e-10);
  assert_near(out.transmitted[ABBE_FILM_S], 0.226044920, 5e-8);
  assert_near(out.reflected[ABBE_FILM_P], 0.370161104, 5e-10);
  assert_near(out.transmitted[ABBE_FILM_P], 0.228243743, 5e-8);
}

TEST(without_a_film_it_is_fresnels_law_and_its_phase) {
  const stack none = {0}, naught = one(2, 3, 0);
  const double air[2] = {1, 0};
  for (double degrees = 0; degrees < 90; degrees += 0.7)
    for (int i = 0; i < 2; i++) {
      const double n = i == 0 ? 1 : 1.5, to[2] = {i == 0 ? 1.5 : 1, 0};
      const abbe_film_light a = at(&none, false, n, to, degrees, 500),
                            b = at(&naught, false, n, to, degrees, 500);
      double r, t;
      abbe_film_unpolarised(&a, &r, &t);
      assert_near(r, abbe_optics_fresnel(cos(degrees * ABBE_DEGREE), n / to[0]), 1e-13);
      assert_near(r + t, 1, 1e-13);
      assert_near(a.reflected[0], b.reflected[0], 1e-13);
    }
  /* total reflection retards p against s: n 1.5, 45 degrees */
  const abbe_film_light out = at(&none, false, 1.5, air, 45, 500);
  const double complex s = out.r[0][0] + I * out.r[0][1], p = out.r[1][0] + I * out.r[1][1];
  assert_near(fabs(carg(s * conj(p))) / ABBE_DEGREE, 36.86990, 5e-6);
  /* metal on the ground is the mirror's law */
  const double silver[2] = {0.06, 3.6};
  const abbe_film_light metal = at(&none, false, 1, silver, 40, 550);
  double r, t;
  abbe_film_unpolarised(&metal, &r, &t);
  assert_near(r, abbe_optics_fresnel_conductor(cos(40 * ABBE_DEGREE), 0.06, 3.6), 1e-14);
}

static double any(uint32_t *state) {
  *state = *state * 1664525u + 1013904223u;
  return (*state >> 8) * 0x1p-24;
}

/* Energy closes, light passes alike both ways, and nothing overflows, whatever the stack is. */
TEST(any_stack_keeps_its_energy_both_ways) {
  uint32_t state = 1;
  for (int i = 0; i < 20000; i++) {
    stack s = {.count = (size_t)(17 * any(&state))};
    const bool clear = i % 2 == 0;
    for (size_t k = 0; k < s.count; k++)
      s.layer[k] =
          (abbe_film_layer){0.1 + 4 * any(&state), clear ? 0 : 10 * any(&state) * any(&state),
                            ABBE_FILM_MOST_NM * pow(any(&state), 4), NULL};
    const double a[2] = {1 + 2 * any(&state), 0}, b[2] = {1 + 2 * any(&state), 0},
                 nm = 380 + 400 * any(&state);
    const double sine = any(&state), back = a[0] * sine / b[0];
    abbe_film_light out, in;
    abbe_film_light_at(s.layer, s.count, false, a[0], b, sqrt(1 - sine * sine), nm, &out);
    if (back < 1)
      abbe_film_light_at(s.layer, s.count, true, b[0], a, sqrt(1 - back * back), nm, &in);
    for (int p = 0; p < 2; p++) {
      const double sum = out.reflected[p] + out.transmitted[p];
      assert_true(out.reflected[p] >= 0 && out.transmitted[p] >= 0 && sum < 1 + 1e-9);
      if (clear) assert_near(sum, 1, 1e-9);
      if (back < 1) assert_near(out.transmitted[p], in.transmitted[p], 1e-9);
      if (back > 1) assert_true(out.transmitted[p] == 0);
    }
  }
  const stack thick = one(1.5, 20, ABBE_FILM_MOST_NM);
  const abbe_film_light out = at(&thick, false, 1, glass, 30, 380);
  assert_true(out.transmitted[0] == 0 && out.reflected[0] > 0.5 && out.reflected[1] < 1);
}

/* A table of a film's own shares is that film, from either side. */
TEST(a_table_of_a_film_is_the_film) {
  enum { ANGLES = 91, WAVES = 61 };
  const stack film = one(1.38, 0, MGF2_NM);
  const double air[2] = {1, 0};
  FREED abbe_film_table *t =
      calloc(1, sizeof *t + (ANGLES + WAVES + 4 * ANGLES * WAVES) * sizeof *t->number);
  t->angles = ANGLES;
  t->wavelengths = WAVES;
  double *to = t->number + ANGLES + WAVES;
  for (int k = 0; k < WAVES; k++) t->number[ANGLES + k] = 400 + 5 * k;
  for (int i = 0; i < ANGLES; i++) {
    t->number[i] = 1 - cos(i * ABBE_DEGREE);
    for (int k = 0; k < WAVES; k++) {
      const abbe_film_light l = at(&film, false, 1, glass, i, 400 + 5 * k);
      for (int p = 0; p < 2; p++) {
        *to++ = l.reflected[p];
        *to++ = l.transmitted[p];
      }
    }
  }
  const stack table = {1, {{.n = 1, .table = t}}};
  for (int i = 0; i < 178; i++) {
    const double degrees = i / 2., nm = 400 + 1.6 * i,
                 inside = asin(sin(degrees * ABBE_DEGREE) / 1.52);
    const abbe_film_light a[2] = {at(&table, false, 1, glass, degrees, nm),
                                  at(&table, true, 1.52, air, inside / ABBE_DEGREE, nm)},
                          b[2] = {at(&film, false, 1, glass, degrees, nm),
                                  at(&film, true, 1.52, air, inside / ABBE_DEGREE, nm)};
    for (int side = 0; side < 2; side++)
      for (int p = 0; p < 2; p++) {
        assert_near(a[side].reflected[p], b[side].reflected[p], 2e-3); /* linear between degrees */
        assert_near(a[side].reflected[p] + a[side].transmitted[p], 1, 1e-12);
      }
  }
  assert_near(at(&table, false, 1, glass, 45, 550).reflected[ABBE_FILM_S], 0.040047718, 5e-10);
  assert_near(at(&table, false, 1, glass, 45, 550).reflected[ABBE_FILM_P], 0.001355739, 5e-10);
}

/* Against 4x4 matrices of the layers' fields and their eigenvectors, solved apart from Abbe: bare
 * and under three layers, one of which absorbs, from an index and from inside of crystals that lie
 * any way. The greater share first. [Berreman1972] */
#define STRAIGHT FIELDS({1, 0, 0}, {0, 1, 0}, {0, 0, 1})
TEST(faces_answer_as_matrices_of_fields_do) {
  static const abbe_biaxial stone = {{1.55, 1.62, 1.75},
                                     {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}},
                            other = {{1.9, 1.907, 2.034},
                                     {{0, 0.6, 0.8}, {1, 0, 0}, {0, 0.8, -0.6}}};
  static const abbe_film_layer three[] = {{1.38, 0, 90, NULL},
                                          {2.35, 0, 110, NULL},
                                          {1.9, 0.4, 30, NULL}},
                               gap[] = {{1.2, 0, 150, NULL}};
  static const struct {
    double n, degrees;
    const abbe_film_layer *layer;
    size_t count;
    double s[3], p[3]; /* reflected as s, as p, transmitted */
  } outside[] = {
      {1, 35, NULL, 0, {.094822436, .000252246, .904925318}, {.000002965, .031825263, .968171772}},
      {1, 80, NULL, 0, {.589641761, .000299096, .410059143}, {.000061124, .223045425, .776893450}},
      {1, 35, three, 3, {.014754157, .000157588, .738888392}, {.000001852, .014291491, .740770077}},
      {1, 80, three, 3, {.435438622, .000188905, .406268042}, {.000038605, .322860839, .494988489}},
      {1.8, 60, gap, 1, {.914529573, .000400055, .085070371}, {.000543233, .972603833, .026852934}},
      {1.8, 75, three, 3, {.910764168, .000820612, 0}, {.000820612, .857956515, 0}},
  };
  const double n[3] = {0, 0, -1};
  for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
    const double a = outside[i].degrees * ABBE_DEGREE, k = outside[i].n,
                 ray[3] = {sin(a), 0, cos(a)};
    const abbe_biaxial from = {{k, k, k}, STRAIGHT};
    const abbe_biaxial_film film = {outside[i].layer, outside[i].count, false, 550};
    abbe_biaxial_split both[2];
    abbe_biaxial_meet_both(&from, &stone, n, ray, &film, both);
    for (int p = 0; p < 2; p++) {
      const double *wanted = p == 0 ? outside[i].s : outside[i].p;
      for (int j = 0; j < 2; j++) assert_near(both[p].reflected[j].share, wanted[j], 1e-9);
      assert_near(both[p].transmitted[0].share + both[p].transmitted[1].share, wanted[2], 1e-9);
    }
  }
  static const struct {
    double ray[3];
    int mode;
    bool filmed, on; /* into the other crystal, or into air */
    double back[2], through[2];
  } inside[] = {
      {{.3, .2, .9}, 0, 0, 0, {.031942544, .015157529}, {.861112039, .091787889}},
      {{.3, .2, .9}, 0, 1, 0, {.011427608, .006759961}, {.673852129, .072909332}},
      {{.3, .2, .9}, 0, 1, 1, {.086509699, .031060201}, {.541174153, .140440223}},
      {{.3, .2, .9}, 1, 1, 0, {.031476473, .004206817}, {.733488406, .002373350}},
      {{.5, -.2, .75}, 1, 0, 0, {.901374668, .098625332}, {0, 0}},
      {{.5, -.2, .75}, 1, 1, 0, {.324713422, .019159211}, {0, 0}},
      {{.5, -.2, .75}, 1, 1, 1, {.114019289, .110513771}, {.367709652, .212648643}},
  };
  for (size_t i = 0; i < sizeof inside / sizeof *inside; i++) {
    const abbe_biaxial_film film = {three, inside[i].filmed ? 3 : 0, !inside[i].on, 550};
    double ray[3] = {inside[i].ray[0], inside[i].ray[1], inside[i].ray[2]};
    abbe_vector_normalise(ray);
    abbe_biaxial_split m;
    abbe_biaxial_meet(&stone, inside[i].on ? &other : &(abbe_biaxial){{1, 1, 1}, STRAIGHT}, n,
                      (abbe_biaxial_mode)inside[i].mode, ray, &film, &m);
    for (int side = 0; side < 2; side++) {
      const abbe_biaxial_wave *w = side == 0 ? m.reflected : m.transmitted;
      const double *wanted = side == 0 ? inside[i].back : inside[i].through;
      assert_near(fmax(w[0].share, w[1].share), wanted[0], 1e-9);
      assert_near(fmin(w[0].share, w[1].share), wanted[1], 1e-9);
    }
  }
}
