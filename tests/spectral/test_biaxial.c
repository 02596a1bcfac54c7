/* Known answers of crystals of three indices, laws that hold at any face, and what other functions
 * say of two indices and of one. */
#include "tests/spectral/crystal_faces.h"

#include "spectral/biaxial.h"
#include "spectral/uniaxial.h"

static const abbe_biaxial_mode F = ABBE_BIAXIAL_FAST, S = ABBE_BIAXIAL_SLOW;

#define STRAIGHT FIELDS({1, 0, 0}, {0, 1, 0}, {0, 0, 1})
static const abbe_biaxial air = {{1, 1, 1}, STRAIGHT};
static const abbe_biaxial sphene = {{1.900, 1.907, 2.034}, STRAIGHT};

/* Axes turned any way. */
static abbe_biaxial turned(double a, double b, double c) {
  abbe_biaxial m = {{a, b, c}, STRAIGHT};
  double v[3];
  direction(m.axis[0]);
  direction(v);
  abbe_vector_cross(m.axis[0], v, m.axis[1]);
  abbe_vector_normalise(m.axis[1]);
  abbe_vector_cross(m.axis[0], m.axis[1], m.axis[2]);
  return m;
}
static double total(const abbe_biaxial_split *s) {
  return s->reflected[0].share + s->reflected[1].share + s->transmitted[0].share +
         s->transmitted[1].share;
}
static double walk_off(const abbe_biaxial_state *s) {
  double sine[3];
  abbe_vector_cross(s->normal, s->ray, sine);
  return asin(fmin(sqrt(dot(sine, sine)), 1));
}

/* ---- one wave ---- */

TEST(optic_axes_of_stones) {
  const struct {
    double n[3], twice;
  } rows[] = {{{1.607, 1.610, 1.617}, 66.67}, {{1.692, 1.693, 1.700}, 41.54},
              {{1.654, 1.672, 1.690}, 90.93}, {{1.900, 1.907, 2.034}, 27.75},
              {{1.746, 1.748, 1.756}, 53.33}, {{1.530, 1.681, 1.6854}, 161.97}};
  for (int i = 0; i < 6; i++)
    assert_near(2 * degrees(abbe_biaxial_half_angle(rows[i].n)), rows[i].twice, 0.005);
}

TEST(indices_and_walk_off_along_the_diagonal) {
  const struct {
    double n[3], fast, slow, off[2];
  } rows[] = {{{1.607, 1.610, 1.617}, 1.6083676, 1.6142827, {0.12842, 0.26906}},
              {{1.654, 1.672, 1.690}, 1.6615106, 1.6822957, {0.71326, 0.71105}},
              {{1.900, 1.907, 2.034}, 1.9034384, 1.9876196, {0.25790, 3.64705}}};
  const double r = 1 / sqrt(3), normal[3] = {r, r, r};
  for (int i = 0; i < 3; i++) {
    const abbe_biaxial m = {{rows[i].n[0], rows[i].n[1], rows[i].n[2]}, STRAIGHT};
    abbe_biaxial_state fast, slow;
    abbe_biaxial_of_normal(&m, F, normal, &fast);
    abbe_biaxial_of_normal(&m, S, normal, &slow);
    assert_near(fast.index, rows[i].fast, 1e-6);
    assert_near(slow.index, rows[i].slow, 1e-6);
    assert_near(degrees(walk_off(&fast)), rows[i].off[0], 5e-6);
    assert_near(degrees(walk_off(&slow)), rows[i].off[1], 5e-6);
  }
}

/* Fresnel's equation, the fields' right angles, and the way back from the ray. */
TEST(normals_and_rays_belong_together) {
  for (int i = 0; i < 2000; i++) {
    const abbe_biaxial m = turned(1 + next(), 1 + next(), 1 + next());
    double normal[3];
    direction(normal);
    for (int mode = 0; mode < 2; mode++) {
      abbe_biaxial_state s, back[2];
      abbe_biaxial_of_normal(&m, (abbe_biaxial_mode)mode, normal, &s);
      double product = 0, sum = 0;
      for (int p = 0; p < 3; p++) {
        const double c = dot(normal, m.axis[p]);
        double others = c * c;
        for (int q = 0; q < 3; q++)
          if (q != p) others *= 1 / (s.index * s.index) - 1 / (m.n[q] * m.n[q]);
        sum += others;
        product += fabs(others);
      }
      assert_near(sum, 0, 1e-13 + 1e-12 * product);
      assert_near(dot(s.field, s.ray), 0, 1e-14);
      for (int k = 0; k < 2; k++) abbe_biaxial_of_ray(&m, (abbe_biaxial_mode)k, s.ray, &back[k]);
      const int same =
          fabs(dot(back[0].field, s.field)) > fabs(dot(back[1].field, s.field)) ? 0 : 1;
      for (int k = 0; k < 3; k++) assert_near(back[same].normal[k], normal[k], 1e-7);
      assert_near(back[same].index, s.index, 1e-7);
    }
  }
}

/* Conical refraction: the rays of normals around an optic axis, and the normals of rays around an
 * axis of single ray velocity. */
TEST(cones_of_aragonite_and_ktp) {
  const struct {
    double n[3], inner, outer;
  } rows[] = {{{1.530, 1.6810, 1.6854}, 1.8823, 1.7178},
              {{1.76774, 1.77755, 1.87337}, 1.9072, 1.9989}};
  for (int i = 0; i < 2; i++) {
    const abbe_biaxial m = {{rows[i].n[0], rows[i].n[1], rows[i].n[2]}, STRAIGHT};
    const double v = abbe_biaxial_half_angle(m.n);
    const double w = atan(tan(v) * m.n[0] / m.n[2]);
    double widest[2] = {0, 0};
    for (int side = -1; side <= 1; side += 2)
      for (int mode = 0; mode < 2; mode++) {
        abbe_biaxial_state s;
        const double normal[3] = {sin(v + 1e-9 * side), 0, cos(v + 1e-9 * side)},
                     ray[3] = {sin(w + 1e-9 * side), 0, cos(w + 1e-9 * side)};
        abbe_biaxial_of_normal(&m, (abbe_biaxial_mode)mode, normal, &s);
        widest[0] = fmax(widest[0], degrees(walk_off(&s)));
        abbe_biaxial_of_ray(&m, (abbe_biaxial_mode)mode, ray, &s);
        widest[1] = fmax(widest[1], degrees(walk_off(&s)));
      }
    /* tan = root((c^2 - b^2) (b^2 - a^2)) over a c, and over b^2 [BornWolf1999, 15.3.4] */
    const double *n = m.n, root = sqrt((n[2] * n[2] - n[1] * n[1]) * (n[1] * n[1] - n[0] * n[0]));
    assert_near(widest[0], degrees(atan(root / (n[0] * n[2]))), 1e-6);
    assert_near(widest[1], degrees(atan(root / (n[1] * n[1]))), 1e-6);
    /* the fifth decimals of KTP's indices move its cones by so much */
    assert_near(widest[0], rows[i].inner, i == 0 ? 5e-5 : 6e-4);
    assert_near(widest[1], rows[i].outer, i == 0 ? 5e-5 : 6e-4);
  }
}

/* ---- faces ---- */

static void reflect(const abbe_biaxial *m, double degree, double out[2][2]) {
  double in[3];
  down(degree, in);
  for (int from = 0; from < 2; from++) {
    abbe_biaxial_split s;
    abbe_biaxial_meet(&air, m, up, (abbe_biaxial_mode)from, in, NULL, &s);
    for (int to = 0; to < 2; to++) out[from][to] = s.reflected[to].share;
    assert_near(total(&s), 1, 1e-13);
  }
}

TEST(air_to_sphene) {
  double r[2][2], in[3];
  reflect(&sphene, 45, r);
  assert_near(r[0][0], 0.1843246, 1e-7);
  assert_near(r[1][1], 0.0316583, 1e-7);
  abbe_biaxial_split s;
  down(45, in);
  abbe_biaxial_meet(&air, &sphene, up, (abbe_biaxial_mode)1, in, NULL, &s);
  const abbe_biaxial_wave *p = &s.transmitted[s.transmitted[0].share > 0.5 ? 0 : 1];
  assert_near(p->state.index, 1.9166925, 1e-7);
  assert_near(p->state.normal[0], 0.368920, 1e-6);
  assert_near(p->state.ray[0], 0.327270, 1e-6);
}

/* Head on into a slab whose Z is 45 degrees off its normal. */
TEST(a_slab_of_sphene_shifts_one_wave) {
  const double r = sqrt(0.5), in[3] = {0, 0, -1};
  const abbe_biaxial m = {{1.900, 1.907, 2.034}, {{r, 0, -r}, {0, 1, 0}, {r, 0, r}}};
  abbe_biaxial_split s;
  abbe_biaxial_meet_unpolarised(&air, &m, up, in, NULL, &s);
  double shift[2];
  for (int i = 0; i < 2; i++)
    shift[i] = fabs(s.transmitted[i].state.ray[0] / s.transmitted[i].state.ray[2]);
  assert_near(fmin(shift[0], shift[1]), 0, 1e-15);
  assert_near(fmax(shift[0], shift[1]), 0.0680451, 1e-7);
}

/* Calcite, as from the function of two indices, and against numbers of another hand. */
TEST(air_to_calcite) {
  const struct {
    double axis[3], degree, ss, sp, pp;
  } rows[] = {{{0, 0, 1}, 30, 0.0853982, 0, 0.0432403},
              {{1, 0, 0}, 30, 0.0853982, 0, 0.0221650},
              {{0, 1, 0}, 30, 0.0554475, 0, 0.0408032},
              {{1, 1, 0}, 30, 0.0697565, 0.0007536, 0.0306925},
              {{1, 1, 0}, 60, 0.2001170, 0.0008624, 0.0018110}};
  for (int i = 0; i < 5; i++) {
    double r[2][2], v[3] = {0.3, -0.5, 0.7};
    abbe_biaxial m = {{1.65834, 1.65834, 1.48613}, STRAIGHT};
    memcpy(m.axis[2], rows[i].axis, sizeof v);
    abbe_vector_normalise(m.axis[2]);
    abbe_vector_cross(v, m.axis[2], m.axis[0]);
    abbe_vector_normalise(m.axis[0]);
    abbe_vector_cross(m.axis[2], m.axis[0], m.axis[1]);
    reflect(&m, rows[i].degree, r);
    assert_near(r[0][0], rows[i].ss, 1e-7);
    assert_near(r[0][1], rows[i].sp, 1e-7);
    assert_near(r[1][0], rows[i].sp, 1e-7);
    assert_near(r[1][1], rows[i].pp, 1e-7);
  }
}

/* Where two indices are alike the waves are those of a uniaxial crystal. */
TEST(two_indices_are_uniaxial) {
  for (int i = 0; i < 4000; i++) {
    double in[3];
    const double o[2] = {1.3 + next(), 1.3 + next()}, e[2] = {1.3 + next(), 1.3 + next()};
    abbe_biaxial m[2];
    abbe_uniaxial u[2];
    for (int k = 0; k < 2; k++) {
      m[k] = turned(o[k], o[k], e[k]);
      u[k] = (abbe_uniaxial){.n_o = o[k], .n_e = e[k]};
      memcpy(u[k].axis, m[k].axis[2], sizeof u[k].axis);
    }
    do direction(in);
    while (in[2] > -0.05);
    for (int wave = 0; wave < 2; wave++) {
      abbe_uniaxial_split x;
      abbe_biaxial_split y;
      /* ordinary is fast where the other index is larger */
      const abbe_biaxial_mode mode =
          (wave == 0) == (o[0] < e[0]) ? ABBE_BIAXIAL_FAST : ABBE_BIAXIAL_SLOW;
      abbe_uniaxial_meet(&u[0], &u[1], up, (abbe_uniaxial_mode)wave, in, &x);
      abbe_biaxial_meet(&m[0], &m[1], up, mode, in, NULL, &y);
      assert_near(total(&y), 1, 1e-12);
      for (int k = 0; k < 4; k++) {
        const abbe_uniaxial_wave *a = k < 2 ? &x.reflected[k] : &x.transmitted[k - 2];
        const bool fast = ((k & 1) == 0) == (o[k / 2] < e[k / 2]);
        double share = 0;
        const abbe_biaxial_wave *found = NULL;
        for (int j = 0; j < 2; j++) {
          const abbe_biaxial_wave *b = k < 2 ? &y.reflected[j] : &y.transmitted[j];
          if (b->travels && b->mode == (fast ? ABBE_BIAXIAL_FAST : ABBE_BIAXIAL_SLOW)) {
            share += b->share;
            found = b;
          }
        }
        assert_near(share, a->share, 1e-9);
        for (int c = 0; c < 3 && found != NULL && a->share > 1e-6; c++)
          assert_near(found->state.ray[c], a->ray[c], 1e-9);
      }
    }
  }
}

/* ---- laws ---- */

TEST(energy_is_conserved) {
  double worst = 0;
  for (int i = 0; i < 20000; i++) {
    const double spread = i % 3 == 0 ? 1 : i % 3 == 1 ? 0.01 : 1e-5;
    const abbe_biaxial a =
        turned(1.5 + spread * next(), 1.5 + spread * next(), 1.5 + spread * next());
    const abbe_biaxial b =
        turned(1.2 + spread * next(), 1.2 + spread * next(), 1.2 + spread * next());
    double in[3];
    do direction(in);
    while (in[2] > -1e-3);
    for (int mode = 0; mode < 2; mode++) {
      abbe_biaxial_split s;
      abbe_biaxial_meet(&a, i % 2 ? &b : &air, up, (abbe_biaxial_mode)mode, in, NULL, &s);
      worst = fmax(worst, fabs(total(&s) - 1));
      abbe_biaxial_meet(&b, &a, up, (abbe_biaxial_mode)mode, in, NULL, &s);
      worst = fmax(worst, fabs(total(&s) - 1));
    }
    abbe_biaxial_split s;
    abbe_biaxial_meet_unpolarised(&air, &a, up, in, NULL, &s);
    worst = fmax(worst, fabs(total(&s) - 1));
  }
  if (!(worst < 1e-7)) fail_msg("energy is off by up to %g", worst);
}

/* Beside an optic axis one sheet is a cone that the normal's line may cut twice, 5e-5 from the
 * other sheet. */
TEST(a_line_cuts_one_sheet_twice) {
  const abbe_biaxial a = {{1.5854431039481225, 2.0921986136783981, 1.255409664203319},
                          {{-0.76568079320346594, 0.48003479515317465, -0.42813493008812159},
                           {0.63140726640082845, 0.43394997132409846, -0.64266031954995273},
                           {-0.12271017421365008, -0.76240016909105135, -0.63536461603900474}}};
  const double in[3] = {0.75678215138145233, 0.64205317696124842, -0.12267230047744471};
  for (int mode = 0; mode < 2; mode++) {
    abbe_biaxial_split s;
    abbe_biaxial_meet(&a, &sphene, up, (abbe_biaxial_mode)mode, in, NULL, &s);
    assert_near(total(&s), 1, 1e-9);
  }
}

/* What enters as one wave by one ray comes back by the same ray with the same share. */
TEST(ways_back_have_the_same_share) {
  for (int i = 0; i < 2000; i++) {
    const abbe_biaxial a = turned(1.5 + 0.3 * next(), 1.5 + 0.3 * next(), 1.5 + 0.3 * next());
    const abbe_biaxial b = turned(1.5 + 0.3 * next(), 1.5 + 0.3 * next(), 1.5 + 0.3 * next());
    const double below[3] = {0, 0, -1};
    double in[3];
    do direction(in);
    while (in[2] > -0.2);
    for (int mode = 0; mode < 2; mode++) {
      abbe_biaxial_split s, t;
      abbe_biaxial_meet(&a, &b, up, (abbe_biaxial_mode)mode, in, NULL, &s);
      for (int k = 0; k < 2; k++) {
        const abbe_biaxial_wave *w = &s.transmitted[k];
        if (!w->travels || w->share < 1e-3 || fabs(w->state.ray[2]) < 0.05) continue;
        double back[3], share = 0;
        for (int c = 0; c < 3; c++) back[c] = -w->state.ray[c];
        abbe_biaxial_meet(&b, &a, below, w->mode, back, NULL, &t);
        for (int j = 0; j < 2; j++)
          if (t.transmitted[j].travels && fabs(dot(t.transmitted[j].state.ray, in) + 1) < 1e-9 &&
              t.transmitted[j].mode == (abbe_biaxial_mode)mode)
            share += t.transmitted[j].share;
        assert_near(share, w->share, 1e-7);
      }
    }
  }
}

/* Around an optic axis and at it: energy closes. */
TEST(along_an_optic_axis_energy_closes) {
  for (int stone = 0; stone < 2; stone++)
    for (double off = 0; off < 0.1; off = off == 0 ? 1e-13 : 5 * off) {
      abbe_biaxial m = {{1.530, 1.6810, 1.6854}, STRAIGHT};
      if (stone == 1) m.n[0] = 1.6809, m.n[2] = 1.6811;
      const double v = abbe_biaxial_half_angle(m.n);
      /* the axis along the face's normal and, by Snell's law, the way of a slanted ray */
      for (int slant = 0; slant < 2; slant++) {
        const double to = slant ? 0.4 : 0;
        const double turn = v - asin(sin(to) / 1.681) + off, c = cos(turn), s = sin(turn);
        const double axes[3][3] = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}};
        memcpy(m.axis, axes, sizeof axes);
        const double in[3] = {-sin(to), off, -cos(to)};
        double ray[3] = {in[0], in[1], in[2]};
        abbe_vector_normalise(ray);
        abbe_biaxial_split out;
        for (int mode = 0; mode < 2; mode++) {
          abbe_biaxial_meet(&air, &m, up, (abbe_biaxial_mode)mode, ray, NULL, &out);
          assert_near(total(&out), 1, 1e-7);
        }
      }
    }
}

/* At the edge of total reflection, grazing and behind. */
TEST(awkward_directions) {
  for (double off = 1e-15; off < 0.1; off *= 7)
    for (int i = 0; i < 20; i++) {
      const abbe_biaxial m = turned(1.6, 1.65, 1.75);
      abbe_biaxial_split s;
      const double ray[3] = {sqrt(1 - off * off), 0, -off};
      for (int mode = 0; mode < 2; mode++) {
        abbe_biaxial_meet(&air, &m, up, (abbe_biaxial_mode)mode, ray, NULL, &s);
        assert_near(total(&s), 1, 1e-7);
        abbe_biaxial_meet(&m, &air, up, (abbe_biaxial_mode)mode, ray, NULL, &s);
        /* the quartic's roots of the wave that comes and of its mirror image all but meet */
        assert_near(total(&s), 1, 1e-7 + 5e-16 / (off * off));
        for (int side = -1; side <= 1; side += 2) {
          const double c = asin(1 / m.n[1]) + side * off, edge[3] = {sin(c), 0, -cos(c)};
          abbe_biaxial_meet(&m, &air, up, (abbe_biaxial_mode)mode, edge, NULL, &s);
          assert_near(total(&s), 1, 1e-7);
        }
      }
    }
}

/* A field along an axis loses that axis's; the rest is what two indices say. */
TEST(absorption_goes_by_the_field) {
  const double a[3] = {2000, 2000, 300}, n = 30;
  const abbe_biaxial m = {{1.644, 1.644, 1.624}, STRAIGHT};
  const double normal[3] = {sin(radians(n)), 0, cos(radians(n))};
  abbe_biaxial_state s;
  abbe_biaxial_of_normal(&m, F, normal, &s);
  assert_near(abbe_biaxial_attenuation(&m, a, s.field), 1563.166, 5e-4);
  abbe_biaxial_of_normal(&m, S, normal, &s);
  assert_near(abbe_biaxial_attenuation(&m, a, s.field), 2000, 1e-9);
}

/* ---- films ---- */

/* Of three indices alike it is a film on glass, for s and p and both ways. */
TEST(a_film_on_a_crystal_of_one_index_is_one_on_glass) {
  const abbe_film_layer layer[3] = {
      {1.38, 0, 99.6, NULL}, {2.4, 0.3, 60, NULL}, {0.42, 2.4, 12, NULL}};
  const double n = 1.61;
  for (int i = 0; i < 60; i++) {
    const bool inside = i % 2 != 0;
    /* not quite alike, so that it is solved as a crystal */
    const abbe_biaxial stone = {{n - 1e-12, n, n + 1e-12}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const double angle = (0.5 + i) / 60 * 1.5, ray[3] = {sin(angle), 0, -cos(angle)};
    const double to[2] = {inside ? 1 : n, 0};
    const abbe_biaxial_film film = {layer, 3, inside, 450 + 3 * i};
    abbe_biaxial_split split;
    abbe_film_light light;
    abbe_film_light_at(layer, 3, inside, inside ? n : 1, to, cos(angle), film.lambda_nm, &light);
    double r, t, back = 0, on = 0;
    abbe_film_unpolarised(&light, &r, &t);
    if (inside) {
      for (int mode = 0; mode < 2; mode++) {
        abbe_biaxial_meet(&stone, &air, up, (abbe_biaxial_mode)mode, ray, &film, &split);
        for (int k = 0; k < 2; k++) {
          back += split.reflected[k].share / 2;
          on += split.transmitted[k].share / 2;
        }
      }
    } else {
      abbe_biaxial_meet_unpolarised(&air, &stone, up, ray, &film, &split);
      for (int k = 0; k < 2; k++) {
        back += split.reflected[k].share;
        on += split.transmitted[k].share;
      }
    }
    assert_near(back, r, 1e-7);
    assert_near(on, t, 1e-7);
  }
}

/* Clear films keep the energy of any crystal's waves, and one of half a wave is none. */
TEST(films_on_crystals_keep_energy) {
  const double r = sqrt(1.0 / 3);
  const abbe_biaxial stone = {{1.900, 1.907, 2.034},
                              {{0.8, 0.6, 0},
                               {-0.6 * r, 0.8 * r, sqrt(1 - r * r)},
                               {0.6 * sqrt(1 - r * r), -0.8 * sqrt(1 - r * r), r}}};
  for (int i = 0; i < 200; i++) {
    const double angle = (0.5 + i) / 200 * 1.5, turn = 2.4 * i,
                 ray[3] = {sin(angle) * cos(turn), sin(angle) * sin(turn), -cos(angle)};
    const abbe_film_layer layer[2] = {{1.2 + 0.01 * i, 0, 3.0 * i, NULL}, {2.4, 0, 60, NULL}},
                          half = {1.38, 0, 275 / 1.38, NULL};
    const abbe_biaxial_film film = {layer, 2, true, 550}, none = {&half, 1, true, 550};
    for (int mode = 0; mode < 2; mode++) {
      abbe_biaxial_split a, b;
      abbe_biaxial_meet(&stone, &air, up, (abbe_biaxial_mode)mode, ray, &film, &a);
      double sum = 0;
      for (int k = 0; k < 2; k++) sum += a.reflected[k].share + a.transmitted[k].share;
      assert_near(sum, 1, 1e-7);
      const double down[3] = {0, 0, -1};
      const abbe_biaxial upright = {{1.900, 1.907, 2.034}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
      abbe_biaxial_meet(&upright, &air, up, (abbe_biaxial_mode)mode, down, &none, &a);
      abbe_biaxial_meet(&upright, &air, up, (abbe_biaxial_mode)mode, down, NULL, &b);
      for (int k = 0; k < 2; k++) assert_near(a.reflected[k].share, b.reflected[k].share, 1e-12);
    }
  }
}

/* Of all normals the greatest is between the axes of the extreme indices. */
TEST(the_extreme_indices_decide_the_greatest_walk_off) {
  for (double middle = 1.9; middle <= 2.034; middle += 0.067) {
    const abbe_biaxial m = {{1.9, middle, 2.034}, STRAIGHT};
    double most = 0;
    for (int i = 0; i < 20000; i++) {
      abbe_biaxial_state s;
      double normal[3];
      direction(normal);
      if (i % 2 == 0) normal[1] = 0;
      abbe_vector_normalise(normal);
      abbe_biaxial_of_normal(&m, i % 4 < 2 ? F : S, normal, &s);
      most = fmax(most, walk_off(&s));
    }
    assert_near(most, abbe_uniaxial_walk_off(1.9, 2.034, cos(atan(2.034 / 1.9))), 1e-7);
  }
}
