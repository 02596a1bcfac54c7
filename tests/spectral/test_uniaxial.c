#include "tests/spectral/crystal_faces.h"

#include "spectral/optics.h"
#include "spectral/uniaxial.h"

/* Calcite at 589.3 nm [Ghosh1999]. */
static const double n_o = 1.65835, n_e = 1.48640;
static const abbe_uniaxial air = {1, 1, {0, 0, 1}};
static const abbe_uniaxial_mode O = ABBE_UNIAXIAL_ORDINARY, E = ABBE_UNIAXIAL_EXTRAORDINARY;

static abbe_uniaxial calcite(double x, double y, double z) {
  const double length = sqrt(x * x + y * y + z * z);
  return (abbe_uniaxial){n_o, n_e, {x / length, y / length, z / length}};
}
static double total(const abbe_uniaxial_split *s) {
  return s->reflected[0].share + s->reflected[1].share + s->transmitted[0].share +
         s->transmitted[1].share;
}

/* ---- one wave ---- */

TEST(the_index_runs_from_n_o_to_n_e) {
  assert_near(abbe_uniaxial_index(n_o, n_e, 1), n_o, 1e-15);
  assert_near(abbe_uniaxial_index(n_o, n_e, 0), n_e, 1e-15);
  for (double a = 0; a <= 90; a += 7.5) {
    const double n = abbe_uniaxial_index(n_o, n_e, cos(radians(a)));
    assert_near(1 / (n * n), pow(cos(radians(a)) / n_o, 2) + pow(sin(radians(a)) / n_e, 2), 1e-15);
    assert_near(n, abbe_uniaxial_index(n_o, n_e, -cos(radians(a))), 1e-15);
  }
  /* at 45 degrees: n_o n_e / sqrt((n_o^2 + n_e^2) / 2) */
  assert_near(abbe_uniaxial_index(n_o, n_e, sqrt(0.5)), 1.5653, 5e-5);
}

/* Calcite's angle: 6.22 degrees at 45 degrees to the axis, and the largest, where tan = n_e / n_o,
 * has the tangent (n_o^2 - n_e^2) / (2 n_o n_e). */
TEST(calcites_ray_leaves_its_normal_by_six_degrees) {
  assert_near(degrees(abbe_uniaxial_walk_off(n_o, n_e, sqrt(0.5))), 6.22, 0.005);
  const double most = cos(atan(n_e / n_o));
  assert_near(tan(abbe_uniaxial_walk_off(n_o, n_e, most)),
              (n_o * n_o - n_e * n_e) / (2 * n_o * n_e), 1e-15);
  assert_near(abbe_uniaxial_walk_off(n_o, n_e, 0), 0, 0);
  assert_near(abbe_uniaxial_walk_off(n_o, n_e, 1), 0, 0);
  assert_near(abbe_uniaxial_walk_off(n_o, n_e, -0.3), abbe_uniaxial_walk_off(n_o, n_e, 0.3), 0);
}

TEST(rays_and_normals_belong_together) {
  for (int i = 0; i < 1000; i++) {
    double axis[3], normal[3], ray[3], back[3];
    direction(axis);
    direction(normal);
    const abbe_uniaxial m = {1 + 2 * next(), 1 + 2 * next(), {axis[0], axis[1], axis[2]}};
    abbe_uniaxial_ray(&m, E, normal, ray);
    abbe_uniaxial_normal(&m, E, ray, back);
    assert_near(dot(ray, ray), 1, 1e-14);
    for (int k = 0; k < 3; k++) assert_near(back[k], normal[k], 1e-14);
    assert_near(acos(fmin(dot(ray, normal), 1)),
                abbe_uniaxial_walk_off(m.n_o, m.n_e, dot(normal, axis)), 3e-8);
    abbe_uniaxial_ray(&m, O, normal, ray);
    for (int k = 0; k < 3; k++) assert_near(ray[k], normal[k], 1e-15);
  }
}

/* ---- published cases ---- */

/* Light falls straight onto a face that is cut at 45 degrees to the axis: the ordinary ray goes
 * straight on, the extraordinary one leans away from the axis, for calcite is negative; both
 * normals stay. */
TEST(straight_light_splits_in_calcite) {
  const abbe_uniaxial m = calcite(1, 0, 1);
  double in[3] = {0, 0, -1};
  abbe_uniaxial_split s;
  abbe_uniaxial_meet_unpolarised(&air, &m, up, in, &s);
  const abbe_uniaxial_wave *o = &s.transmitted[O], *e = &s.transmitted[E];
  for (int k = 0; k < 3; k++) {
    assert_near(o->ray[k], in[k], 1e-15);
    assert_near(e->normal[k], in[k], 1e-15);
  }
  assert_near(degrees(acos(-e->ray[2])), 6.22, 0.005);
  assert_true(e->ray[0] > 0); /* the axis is at -x, -z along it */
  assert_near(e->ray[1], 0, 1e-15);
  assert_near(o->index, n_o, 1e-15);
  assert_near(e->index, 1.5653, 5e-5);
  /* half of the light each, less Fresnel's loss at its own index */
  assert_near(o->share, 0.5 * (1 - pow((n_o - 1) / (n_o + 1), 2)), 1e-14);
  assert_near(e->share, 0.5 * (1 - pow((e->index - 1) / (e->index + 1), 2)), 1e-14);
  assert_near(total(&s), 1, 1e-14);
  /* fields: the ordinary one across the axis, the other across the ray */
  assert_near(dot(o->field, m.axis), 0, 1e-15);
  assert_near(dot(e->field, e->ray), 0, 1e-15);
}

/* Axis along the face's normal: s sees n_o, and p is r = (n_o n_e c - q) / (n_o n_e c + q) with
 * q = sqrt(n_e^2 - sin^2) [Lekner1991]. */
TEST(an_axis_across_the_face) {
  const abbe_uniaxial m = calcite(0, 0, 1);
  for (double a = 0; a < 90; a += 3) {
    double in[3];
    down(a, in);
    const double c = cos(radians(a)), q = sqrt(n_e * n_e - pow(sin(radians(a)), 2));
    abbe_uniaxial_split s;
    abbe_uniaxial_meet(&air, &m, up, E, in, &s);
    const double r = (n_o * n_e * c - q) / (n_o * n_e * c + q);
    assert_near(s.reflected[E].share, r * r, 1e-13);
    assert_near(s.transmitted[E].share, 1 - r * r, 1e-13);
    assert_near(s.transmitted[O].share + s.reflected[O].share, 0, 1e-13);
    abbe_uniaxial_meet(&air, &m, up, O, in, &s);
    const double t = sqrt(n_o * n_o - pow(sin(radians(a)), 2)), r_s = (c - t) / (c + t);
    assert_near(s.reflected[O].share, r_s * r_s, 1e-13);
    assert_near(s.transmitted[E].share + s.reflected[E].share, 0, 1e-13);
  }
}

/* Axis in the face and across the plane of incidence: the extraordinary wave is the s wave of n_e,
 * the ordinary one the p wave of n_o, both by Snell and Fresnel; from inside as well, to total
 * reflection. */
TEST(an_axis_across_the_plane_of_incidence) {
  const abbe_uniaxial m = calcite(0, 1, 0);
  for (double a = 1; a < 90; a += 2) {
    double in[3];
    down(a, in);
    const double c = cos(radians(a));
    const double index[2] = {n_o, n_e};
    abbe_uniaxial_split s;
    for (int inside = 0; inside < 2; inside++)
      for (int mode = 0; mode < 2; mode++) { /* of the crystal; s of air is its extraordinary */
        const double eta = inside ? index[mode] : 1 / index[mode];
        bool beyond;
        const double t = abbe_optics_cos_refracted(c, eta, &beyond);
        const double r =
            mode == (int)E ? (eta * c - t) / (eta * c + t) : (c - eta * t) / (c + eta * t);
        const double share = beyond ? 1 : r * r;
        if (inside) {
          abbe_uniaxial_meet(&m, &air, up, (abbe_uniaxial_mode)mode, in, &s);
          assert_near(s.reflected[mode].share, share, 1e-12);
          assert_near(s.transmitted[!mode].share, 1 - share, 1e-12);
          assert_near(s.reflected[!mode].share, 0, 1e-12);
        } else {
          abbe_uniaxial_meet(&air, &m, up, (abbe_uniaxial_mode)!mode, in, &s);
          assert_near(s.reflected[!mode].share, share, 1e-12);
          assert_near(s.transmitted[mode].share, 1 - share, 1e-12);
          assert_near(s.transmitted[mode].ray[0], eta * in[0], 1e-13);
        }
      }
  }
}

/* ---- polarisers ---- */

/* A polariser along or across the axis of a plate: one wave alone is in it, and an analyser across
 * it stays dark. Between, the fields share out as sine and cosine. */
TEST(crossed_polarisers_are_dark_where_the_axis_is_along_one) {
  const abbe_uniaxial m = calcite(1, 0, 0);
  double in[3] = {0, 0, -1};
  for (double a = 0; a <= 90; a += 15) {
    abbe_uniaxial_split enter[2];
    for (int i = 0; i < 2; i++)
      abbe_uniaxial_meet(&air, &m, up, (abbe_uniaxial_mode)i, in, &enter[i]);
    /* a field of 1 at the angle a to the axis, made of s and p */
    const double field[3] = {cos(radians(a)), sin(radians(a)), 0};
    const double s = dot(field, enter[O].field), p = dot(field, enter[E].field);
    double leaves[3] = {0}; /* no retardation: a plate of a whole number of waves */
    for (int mode = 0; mode < 2; mode++) {
      const double inside =
          s * enter[O].transmitted[mode].amplitude[0] + p * enter[E].transmitted[mode].amplitude[0];
      const double n = mode == (int)O ? n_o : n_e;
      assert_near(fabs(inside), 2 / (1 + n) * (mode == (int)O ? field[1] : field[0]), 1e-14);
      abbe_uniaxial_split leave;
      abbe_uniaxial_meet(&m, &air, up, (abbe_uniaxial_mode)mode, enter[O].transmitted[mode].ray,
                         &leave);
      const double way = dot(leave.field, enter[O].transmitted[mode].field); /* the same wave */
      for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
          leaves[k] +=
              way * inside * leave.transmitted[i].amplitude[0] * leave.transmitted[i].field[k];
    }
    const double t_o = 4 * n_o / pow(1 + n_o, 2), t_e = 4 * n_e / pow(1 + n_e, 2);
    const double across[3] = {-field[1], field[0], 0};
    assert_near(dot(leaves, across), sin(radians(a)) * cos(radians(a)) * (t_o - t_e), 1e-14);
    if (a == 0 || a == 90) assert_near(dot(leaves, across), 0, 1e-15);
  }
}

/* Along its axis a crystal is as glass of n_o: nothing is retarded, nothing walks off. */
TEST(along_the_axis_nothing_splits) {
  const abbe_uniaxial m = calcite(0, 0, 1);
  double in[3] = {0, 0, -1};
  abbe_uniaxial_split s;
  for (int mode = 0; mode < 2; mode++) {
    abbe_uniaxial_meet(&air, &m, up, (abbe_uniaxial_mode)mode, in, &s);
    for (int i = 0; i < 2; i++) {
      assert_near(s.transmitted[i].index, n_o, 1e-15);
      assert_near(s.transmitted[i].ray[2], -1, 0);
    }
    assert_near(s.transmitted[O].share + s.transmitted[E].share, 4 * n_o / pow(1 + n_o, 2), 1e-14);
  }
}

/* ---- laws ---- */

static void random_medium(abbe_uniaxial *m) {
  *m = (abbe_uniaxial){.n_o = 1 + 1.5 * next(), .n_e = 1 + 1.5 * next()};
  direction(m->axis);
  if (next() < 0.25) m->n_e = m->n_o;
}

static void random_ray(const double n[3], double ray[3]) {
  do direction(ray);
  while (!(dot(ray, n) < -1e-3));
}

/* No light is lost or made, into, inside and out of crystals, total reflection included; tangential
 * wave vectors stay, and rays leave to their sides. */
TEST(energy_is_conserved) {
  size_t totals = 0, couples = 0;
  for (int i = 0; i < 50000; i++) {
    abbe_uniaxial from, to;
    double n[3], ray[3], k[3];
    random_medium(&from);
    random_medium(&to);
    direction(n);
    random_ray(n, ray);
    const abbe_uniaxial_mode mode = next() < 0.5 ? O : E;
    abbe_uniaxial_split s;
    abbe_uniaxial_meet(&from, &to, n, mode, ray, &s);
    assert_near(total(&s), 1, 1e-10);
    abbe_uniaxial_normal(&from, mode, ray, k);
    const double index =
        mode == O ? from.n_o : abbe_uniaxial_index(from.n_o, from.n_e, dot(k, from.axis));
    const abbe_uniaxial_wave *waves[] = {&s.reflected[0], &s.reflected[1], &s.transmitted[0],
                                         &s.transmitted[1]};
    for (int w = 0; w < 4; w++) {
      if (!waves[w]->travels) continue;
      assert_true(w < 2 ? dot(waves[w]->ray, n) > 0 : dot(waves[w]->ray, n) < 0);
      for (int c = 0; c < 3; c++) {
        const double before = index * (k[c] - dot(k, n) * n[c]);
        const double after =
            waves[w]->index * (waves[w]->normal[c] - dot(waves[w]->normal, n) * n[c]);
        assert_near(after, before, 1e-12);
      }
    }
    if (!waves[2]->travels && !waves[3]->travels) totals++;
    if (s.reflected[!mode].share > 0.01 && from.n_e != from.n_o) couples++;
  }
  assert_true(totals > 1000 && couples > 1000); /* the cases are among them */
}

/* The share from one wave to another is that of the way back. */
TEST(ways_back_have_the_same_share) {
  for (int i = 0; i < 5000; i++) {
    abbe_uniaxial from, to;
    double n[3], ray[3];
    random_medium(&from);
    random_medium(&to);
    direction(n);
    random_ray(n, ray);
    const abbe_uniaxial_mode mode = next() < 0.5 ? O : E;
    abbe_uniaxial_split s, back;
    abbe_uniaxial_meet(&from, &to, n, mode, ray, &s);
    for (int w = 0; w < 2; w++) {
      double turned[3], other[3];
      for (int k = 0; k < 3; k++) {
        turned[k] = -s.transmitted[w].ray[k];
        other[k] = -n[k];
      }
      if (!s.transmitted[w].travels || fabs(dot(turned, n)) < 1e-3) continue;
      abbe_uniaxial_meet(&to, &from, other, (abbe_uniaxial_mode)w, turned, &back);
      assert_near(back.transmitted[mode].share, s.transmitted[w].share, 1e-9);
      for (int k = 0; k < 3; k++) turned[k] = -s.reflected[w].ray[k];
      if (!s.reflected[w].travels || fabs(dot(turned, n)) < 1e-3) continue;
      abbe_uniaxial_meet(&from, &to, n, (abbe_uniaxial_mode)w, turned, &back);
      assert_near(back.reflected[mode].share, s.reflected[w].share, 1e-9);
    }
  }
}

/* Of one index it is Fresnel's and Snell's glass, whatever the axis is. */
TEST(without_birefringence_it_is_fresnels_glass) {
  for (int i = 0; i < 5000; i++) {
    abbe_uniaxial m = {1 + 2 * next(), 0, {0}};
    double n[3], ray[3], wi[3], wt[3];
    m.n_e = m.n_o;
    direction(m.axis);
    direction(n);
    random_ray(n, ray);
    for (int k = 0; k < 3; k++) wi[k] = -ray[k];
    for (int inside = 0; inside < 2; inside++) {
      const abbe_uniaxial *from = inside ? &m : &air, *to = inside ? &air : &m;
      const double eta = from->n_o / to->n_o;
      abbe_uniaxial_split s;
      abbe_uniaxial_meet_unpolarised(from, to, n, ray, &s);
      assert_near(s.reflected[O].share + s.reflected[E].share,
                  abbe_optics_fresnel(-dot(ray, n), eta), 1e-12);
      const bool passes = abbe_optics_refract(wi, n, eta, wt);
      assert_true(passes == s.transmitted[O].travels && passes == s.transmitted[E].travels);
      for (int k = 0; k < 3 && passes; k++) assert_near(s.transmitted[E].ray[k], wt[k], 1e-9);
    }
  }
}

/* Total reflection turns the phase of s by -2 atan(sqrt(n^2 sin^2 - 1) / (n cos)) [BornWolf1999]:
 * the wave outside dies out, and does not grow. */
TEST(total_reflection_has_fresnels_phase) {
  const abbe_uniaxial glass = {1.5, 1.5, {0, 0, 1}};
  for (double a = 42; a < 90; a += 4) {
    double in[3];
    down(a, in);
    const double s = 1.5 * sin(radians(a)), c = 1.5 * cos(radians(a));
    abbe_uniaxial_split split;
    abbe_uniaxial_meet(&glass, &air, up, O, in, &split);
    assert_near(split.reflected[O].share, 1, 1e-14);
    assert_false(split.transmitted[O].travels);
    assert_near(atan2(split.reflected[O].amplitude[1], split.reflected[O].amplitude[0]),
                -2 * atan(sqrt(s * s - 1) / c), 1e-12);
  }
}

/* A vanishing birefringence has the limit without, also where the axis is along the light. */
TEST(a_vanishing_birefringence_changes_nothing) {
  for (double tilt = 1e-12; tilt < 2; tilt *= 10) {
    const abbe_uniaxial m = {1.5, 1.5 + 1e-9, {sin(tilt), 0, cos(tilt)}};
    const double in[3] = {0.6, 0, -0.8};
    double head_on[3] = {0, 0, -1};
    abbe_uniaxial_split s;
    abbe_uniaxial_meet_unpolarised(&air, &m, up, in, &s);
    assert_near(s.reflected[O].share + s.reflected[E].share, abbe_optics_fresnel(0.8, 1 / 1.5),
                1e-8);
    assert_near(total(&s), 1, 1e-12);
    abbe_uniaxial_meet_unpolarised(&m, &air, up, head_on, &s);
    assert_near(total(&s), 1, 1e-12);
  }
}

/* Close to the axis, grazing, and at the edge of total reflection. */
TEST(awkward_directions) {
  const abbe_uniaxial m = calcite(0.3, 0.2, 0.9);
  for (double off = 1e-15; off < 0.1; off *= 7) {
    abbe_uniaxial_split s;
    double ray[3] = {sqrt(1 - off * off), 0, -off};
    abbe_uniaxial_meet_unpolarised(&air, &m, up, ray, &s);
    assert_near(total(&s), 1, 1e-9);
    const abbe_uniaxial *from[2] = {&m, &air};
    for (int mode = 0; mode < 2; mode++) {
      abbe_uniaxial_meet(from[0], &air, up, (abbe_uniaxial_mode)mode, ray, &s);
      assert_near(total(&s), 1, 1e-9);
      for (int k = 0; k < 3; k++) ray[k] = -m.axis[k] + (k == 0 ? off : 0);
      const double length = sqrt(dot(ray, ray));
      for (int k = 0; k < 3; k++) ray[k] /= length;
      abbe_uniaxial_meet(&m, &air, up, (abbe_uniaxial_mode)mode, ray, &s);
      assert_near(total(&s), 1, 1e-9);
      /* the critical angle of the ordinary wave, a little to both sides */
      const double c = asin(1 / n_o) + (mode == 0 ? off : -off);
      double edge[3] = {sin(c), 0, -cos(c)};
      abbe_uniaxial_meet(&m, &air, up, O, edge, &s);
      assert_near(total(&s), 1, 1e-9);
    }
  }
  /* exactly along the face, and from behind it */
  double along[3] = {1, 0, 0};
  abbe_uniaxial_split s;
  abbe_uniaxial_meet(&m, &air, up, E, along, &s);
  assert_near(total(&s), 1, 0);
  assert_near(s.reflected[E].share, 1, 0);
}
