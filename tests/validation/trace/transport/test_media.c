#include "tests/scenes/scene_text.h"

#include "validation/trace/transport/media.h"

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
