#include "tests/check.h"

#include "spectral/optics.h"
#include "tests/scenes/scene_text.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"

TEST(the_last_refractor_is_there) {
  assert_int_equal(abbe_media_of(0), -1);
  assert_int_equal(abbe_media_of(1), 0);
  assert_int_equal(abbe_media_of(5), 2);
  assert_int_equal(abbe_media_of((abbe_media_set)1 << 63 | 3), 63);
}

TEST(crossing_and_crossing_back_change_nothing) {
  for (uint32_t i = 0; i < 64; i += 7) {
    abbe_media_set before, after, back, outside = 0x5a5a & ~((abbe_media_set)1 << i);
    abbe_media_cross(outside, i, true, &before, &after);
    assert_true(before == outside && after != outside);
    abbe_media_cross(after, i, false, &before, &back);
    assert_true(before == after && back == outside);
  }
}

/* Between knots the index is interpolated: the error of a line over a step of 0.2 nm. */
TEST(tables_follow_the_formula) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("smoke"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  enum { STEPS = 2000 };
  static double lambda_nm[STEPS + 1];
  for (int k = 0; k <= STEPS; k++) lambda_nm[k] = 380 + 400.0 * k / STEPS;
  MADE(abbe_media, m, abbe_media_make(&g, lambda_nm, STEPS, &m, &error));
  assert_true(m.dispersive[0]);
  assert_false(m.dispersive[1]);
  for (uint32_t k = 0; k < STEPS; k += 97) {
    double um = (lambda_nm[k] + 0.5 * 400.0 / STEPS) / 1000;
    assert_true(fabs((double)abbe_media_n(&m, 0, k, 0.5f) - (1.5 + 0.006 / (um * um))) < 2e-7);
    assert_true(abbe_media_n(&m, 1, k, 0.5f) == 1.5f);
    assert_true(abbe_media_attenuation(&m, 0, k, 0.5f) == 0);
  }
  /* 20/m at 400 nm, and lengths are in frame units */
  float a = abbe_media_attenuation(&m, 1, 100, 0);
  assert_true(fabs((double)a / (20 * g.unit) - 1) < 1e-6);
  assert_true(abbe_media_n(&m, -1, 3, 0.5f) == 1);
}

TEST(refuses_what_the_record_does_not_know) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("narrow"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  abbe_media m;
  double lambda_nm[2] = {380, 780};
  REFUSED(ABBE_OUT_OF_RANGE, "narrow", abbe_media_make(&g, lambda_nm, 1, &m, &error));
}

TEST(refractors_of_one_material_are_one_medium) {
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("dense") RING("crown"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  const double lambda_nm[2] = {380, 780};
  MADE(abbe_media, m, abbe_media_make(&g, lambda_nm, 1, &m, &error));
  assert_true(abbe_media_same(&m, 0, 2) && abbe_media_same(&m, 2, 0));
  assert_true(abbe_media_same(&m, 1, 1) && abbe_media_same(&m, -1, -1));
  assert_false(abbe_media_same(&m, 0, 1));
  assert_false(abbe_media_same(&m, -1, 0));
  assert_false(abbe_media_same(&m, 1, -1));
}

/* Which refractor a film or facets are on is in the key, by which a trace goes on from a file. */
TEST(the_key_knows_whose_face_is_rough_or_coated) {
  static const char *const face[] = {"", ", roughness: 0.3", ", coating: {layers: [[1.38, 99.6]]}"};
  const double lambda_nm[2] = {380, 780};
  uint64_t key[3][2];
  for (int i = 0; i < 6; i++) {
    const char *ball = i % 2 ? face[i / 2] : "", *brick = i % 2 ? "" : face[i / 2];
    OWNED(abbe_scene, scene) =
        scene_of(printed(CAMERA POINT_LIGHT FLOOR BALL("crown%s") BRICK("crown%s"), ball, brick));
    MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
    MADE(abbe_media, m, abbe_media_make(&g, lambda_nm, 1, &m, &error));
    key[i / 2][i % 2] = m.films.key;
  }
  assert_true(key[0][0] == 0 && key[0][1] == 0);
  for (int i = 1; i < 3; i++) assert_true(key[i][0] != key[i][1]);
}

/* The mirrors' single precision against Fresnel's reflectance of a conductor in double. */

enum { STEPS = 40 };

#define DEFAULT_TABLE "materials: default\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
#define MIRROR(name, what)                                                                         \
  "- {name: " name                                                                                 \
  ", shape: sphere, radius: 0.05, transform: [{translate: [0, 0, 0.3]}], mirror: " what "}\n"

TEST(metals_reflect_as_their_n_and_k_say) {
  double lambda_nm[STEPS + 1];
  for (int k = 0; k <= STEPS; k++) lambda_nm[k] = 380 + 10.0 * k;
  OWNED(abbe_scene, scene) = scene_of(DEFAULT_TABLE POINT_LIGHT FLOOR MIRROR("a", "silver") MIRROR(
      "b", "gold") MIRROR("c", "0.7") MIRROR("d", "copper"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  MADE(abbe_mirrors, m, abbe_mirrors_make(&g, lambda_nm, STEPS, &m, &error));
  assert_int_equal(m.count, 4);
  for (uint32_t i = 0; i < 4; i++) {
    assert_int_equal(abbe_mirrors_is_grey(&m, i), i == 2);
    for (uint32_t k = 0; k < STEPS; k++)
      for (int c = 0; c <= 50; c++) {
        const float cosine = (float)c / 50;
        const double seen = (double)abbe_mirrors_reflect(&m, i, cosine, k, 0);
        double n, kk;
        if (i == 2) {
          assert_near(seen, 0.7, 1e-7);
          continue;
        }
        const abbe_material *metal = scene.object[g.mirror_object[i]].conductor;
        OK(abbe_material_nk(metal, lambda_nm[k], &n, &kk, &error));
        assert_near(seen, abbe_optics_fresnel_conductor((double)cosine, n, kk), 5e-6);
      }
  }
}

TEST(what_is_not_known_is_refused) {
  abbe_mirrors m;
  const double lambda_nm[] = {380, 1e5};
  OWNED(abbe_scene, scene) = scene_of(DEFAULT_TABLE POINT_LIGHT FLOOR MIRROR("a", "gold"));
  MADE(abbe_geometry, g, abbe_geometry_make(&scene, &g, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "gold", abbe_mirrors_make(&g, lambda_nm, 1, &m, &error));
}

/* Single precision against the double oracle over all angles and ratios from 1/4 to 4. */
TEST(matches_the_oracle) {
  double worst = 0, worst_cos = 0;
  for (int i = 0; i <= 400; i++)
    for (int j = 0; j <= 400; j++) {
      float cos_i = (float)i / 400, eta = (float)exp2((j - 200) / 100.0), cos_t;
      float share = abbe_interface_reflectance(cos_i, eta, &cos_t);
      double exact = abbe_optics_fresnel((double)cos_i, (double)eta);
      bool total;
      double exact_cos = abbe_optics_cos_refracted((double)cos_i, (double)eta, &total);
      assert_true(share >= 0 && share <= 1);
      /* towards the critical angle the cosine is the root of a small difference: a rounding of
         that, at most eta^2 of one of 1, is one of 1 / cosine in the cosine and the reflectance */
      double scale = exact_cos / fmax(1, (double)(eta * eta));
      worst = fmax(worst, fabs((double)share - exact) * scale);
      worst_cos = fmax(worst_cos, fabs((double)cos_t - exact_cos) * scale);
    }
  assert_true(worst < 1e-6);
  assert_true(worst_cos < 1e-6);
}

TEST(nothing_happens_between_equal_media) {
  float cos_t;
  for (float c = 0; c <= 1; c += 0.125f) {
    assert_true(abbe_interface_reflectance(c, 1, &cos_t) == 0);
    assert_true(cos_t == c);
  }
}

TEST(all_is_reflected_beyond_the_critical_angle) {
  float cos_t;
  assert_true(abbe_interface_reflectance(0.5f, 1.5f, &cos_t) == 1);
  assert_true(cos_t == 0);
  assert_true(abbe_interface_reflectance(0, 1.5f, &cos_t) == 1);
  assert_true(abbe_interface_reflectance(0, 0.5f, &cos_t) == 1);
}

TEST(directions_match_the_oracle) {
  for (int i = 1; i < 40; i++)
    for (int j = 0; j < 2; j++) {
      double angle = i * 0.039, eta = j ? 1.5 : 1 / 1.5;
      float n[3] = {0, 0, 1}, d[3] = {(float)sin(angle), 0, -(float)cos(angle)}, out[3], cos_t;
      double n2[3] = {0, 0, 1}, wi[3] = {-sin(angle), 0, cos(angle)}, exact[3];
      float cos_i = -d[2];
      abbe_interface_reflect(d, n, cos_i, out);
      abbe_optics_reflect(wi, n2, exact);
      for (int k = 0; k < 3; k++) assert_true(fabs((double)out[k] - exact[k]) < 3e-7);
      if (!abbe_optics_refract(wi, n2, eta, exact)) continue;
      abbe_interface_reflectance(cos_i, (float)eta, &cos_t);
      abbe_interface_refract(d, n, (float)eta, cos_i, cos_t, out);
      for (int k = 0; k < 3; k++) assert_true(fabs((double)out[k] - exact[k]) < 1e-6);
    }
}

/* On the right side nothing changes; from the wrong one a direction comes back to just beside the
 * face. */
TEST(light_stays_on_its_side) {
  static const float up[3] = {0, 0, 1};
  for (int i = 0; i <= 16; i++)
    for (int side = -1; side <= 1; side += 2) {
      const double angle = 3.1 * (i - 8) / 16; /* from the face */
      float d[3] = {(float)cos(angle), 0, (float)sin(angle)};
      const float before[3] = {d[0], d[1], d[2]};
      abbe_interface_keep_side(up, (float)side, d);
      const float along = (float)side * d[2];
      assert_true(along > 0);
      assert_near(d[0] * d[0] + d[2] * d[2], 1, 1e-6);
      if ((float)side * before[2] > 0)
        assert_memory_equal(d, before, sizeof d);
      else
        assert_near(along / sqrtf(d[0] * d[0] + 1e-12f), 1e-3f / fabsf(before[0]), 1e-4);
    }
}
