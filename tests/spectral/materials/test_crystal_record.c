/* Records of crystals: three indices, and absorption along axes. */
#include "tests/spectral/shipped_table.h"

static abbe_material_table parse(const char *text) {
  abbe_material_table table;
  OK(abbe_material_table_parse(text, strlen(text), "t.yaml", &table, &error));
  return table;
}

/* Three indices, the record's own being the middle one or given with the others. */
TEST(a_biaxial_crystal_has_three_indices) {
  OWNED(abbe_material_table, t) = parse(
      "materials:\n- {name: a, model: constant, coefficients: [1.61], source: s,\n"
      "   biaxial: {alpha: {model: constant, coefficients: [1.6]},\n"
      "     gamma: {model: tabulated, points: [[1, 1.63], [1000000, 1.62]]}},\n"
      "   absorption: {x: {attenuation_per_m: [[500, 1]]}, y: {attenuation_per_m: [[500, 2]]},\n"
      "     z: {attenuation_per_m: [[500, 3]]}}}\n"
      "- {name: b, source: s, range_nm: [400, 700],\n"
      "   biaxial: {alpha: {model: constant, coefficients: [1.6]}, beta: {model: cauchy, "
      "coefficients: [1.61, 0.001]}, gamma: {model: constant, coefficients: [1.7]}}}\n");
  const double wanted[2][3] = {{1.6, 1.61, 1.63}, {1.6, 1.614, 1.7}};
  for (size_t i = 0; i < 2; i++) {
    assert_true(abbe_material_is_biaxial(&t.material[i]));
    assert_true(abbe_material_is_crystal(&t.material[i]));
    assert_false(abbe_material_is_uniaxial(&t.material[i]));
    for (int axis = 0; axis < 3; axis++) {
      double n = 0;
      OK(abbe_material_n_along(&t.material[i], axis, 500, &n, &error));
      assert_near(n, wanted[i][axis], 1e-5);
      if (i == 0)
        assert_near(abbe_material_attenuation_along(&t.material[i], axis, 500), axis + 1, 1e-12);
    }
  }
  assert_near(abbe_material_attenuation(&t.material[0], 500), 2, 1e-12);
}

TEST(indices_that_cannot_be_are_refused) {
#define ALPHA "alpha: {model: constant, coefficients: [1.6]}"
#define GAMMA "gamma: {model: constant, coefficients: [1.7]}"
  const struct {
    const char *text, *part;
  } rows[] = {
      {"biaxial: 3", "'biaxial' wants 'alpha', 'beta' and 'gamma'"},
      {"biaxial: {" ALPHA "}", "'biaxial' wants 'gamma' too"},
      {"biaxial: {" GAMMA "}", "'biaxial' wants 'alpha' too"},
      {"biaxial: {" ALPHA ", " GAMMA ", delta: 1}", "has no key 'delta'"},
      {"biaxial: {" ALPHA ", gamma: {model: constant, coefficients: [1.5]}}",
       "its indices are to ascend, alpha <= beta <= gamma; at 100 nm they are 1.6, 1.65, 1.5"},
      {"biaxial: {" ALPHA ", gamma: {model: constant, coefficients: [11]}}",
       "an index of a crystal is above 0 and at most 10"},
      {"extraordinary: {model: constant, coefficients: [11]}", "an index of a crystal is above 0"},
      {"biaxial: {" ALPHA ", gamma: {model: tabulated, points: [[450, 1.8], [800, 1.7]]}}",
       "wider than those of its index gamma, which reach from 450 to 800 nm"},
      {"biaxial: {" ALPHA ", gamma: {model: constant, coefficients: [1.7], range_nm: [1, 2]}}",
       "'gamma' has no key 'range_nm'"},
      {"biaxial: {" ALPHA ", " GAMMA ", beta: {model: constant, coefficients: [1.65]}}",
       "'model' stands beside 'biaxial'"},
      {"biaxial: {" ALPHA ", " GAMMA "}, extraordinary: {model: constant, coefficients: [1.7]}",
       "and not both"},
      {"biaxial: {" ALPHA ", " GAMMA
       "}, absorption: {ordinary: {k: [[500, 1]]}, extraordinary: {k: [[500, 1]]}}",
       "of a biaxial crystal goes along 'x', 'y' and 'z'"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_material_table t;
    const char *text =
        printed("materials:\n- {name: a, model: constant, coefficients: [1.65], source: s, %s}\n",
                rows[i].text);
    REFUSED(ABBE_SCHEMA, rows[i].part,
            abbe_material_table_parse(text, strlen(text), "t.yaml", &t, &error));
  }
#undef ALPHA
#undef GAMMA
}

/* Of a crystal along its axes, each in any of the ways; x and y of a uniaxial one are alike. */
TEST(absorption_goes_by_axes) {
#define CRYSTAL                                                                                    \
  "model: constant, coefficients: [1.6], source: s,\n"                                             \
  "   extraordinary: {model: constant, coefficients: [1.5]},\n   absorption: "
  OWNED(abbe_material_table, t) =
      parse("materials:\n"
            "- {name: a, " CRYSTAL "{ordinary: {attenuation_per_m: [[400, 10], [500, 20]]},\n"
            "     extraordinary: {colour: [0.9, 0.25, 1], distance_m: 0.02}}}\n"
            "- {name: b, " CRYSTAL
            "{x: {k: [[400, 1e-7], [500, 2e-7]]}, y: {k: [[400, 1e-7], [500, 2e-7]]},\n"
            "     z: {transmittance: [[400, 0.5]], thickness_m: 0.01}}}\n");
  assert_true(abbe_material_is_pleochroic(&t.material[0]));
  assert_near(abbe_material_attenuation_along(&t.material[0], 0, 450), 15, 1e-13);
  assert_near(abbe_material_attenuation_along(&t.material[0], 1, 450), 15, 1e-13);
  assert_near(abbe_material_attenuation_along(&t.material[0], 2, 549.1), -log(0.25) / 0.02, 1e-10);
  assert_near(abbe_material_attenuation(&t.material[0], 549.1), (2 * 20 - log(0.25) / 0.02) / 3,
              1e-10);
  assert_null(t.material[1].attenuation_yz[0]);
  assert_near(abbe_material_attenuation_along(&t.material[1], 2, 600), log(2) / 0.01, 1e-10);
}

TEST(absorption_that_no_axes_have_is_refused) {
#define A "{attenuation_per_m: [[400, 1]]}"
#define B "{attenuation_per_m: [[400, 2]]}"
  const struct {
    const char *text, *part;
  } rows[] = {
      {CRYSTAL "{ordinary: " A "}", "'absorption' along axes wants 'extraordinary' too"},
      {CRYSTAL "{extraordinary: " A "}", "'absorption' along axes wants 'ordinary' too"},
      {CRYSTAL "{x: " A ", z: " A "}", "'absorption' along axes wants 'y' too"},
      {CRYSTAL "{ordinary: 3, extraordinary: " A "}", "'ordinary' wants 'attenuation_per_m'"},
      {CRYSTAL "{ordinary: {}, extraordinary: " A "}", "'absorption' wants one of"},
      {CRYSTAL "{ordinary: " A ", extraordinary: " A ", k: [[400, 1]]}", "has no key 'k'"},
      {CRYSTAL "{ordinary: " A ", extraordinary: " A ", z: " A "}", "has no key 'z'"},
      {CRYSTAL "{x: " A ", y: " B ", z: " A "}", "a uniaxial crystal absorbs alike along x and y"},
      {"model: constant, coefficients: [1.6], source: s,\n   absorption: {ordinary: " A
       ", extraordinary: " B "}",
       "it absorbs by direction, and has one index in all directions"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    abbe_material_table t;
    const char *text = printed("materials:\n- {name: a, %s}\n", rows[i].text);
    REFUSED(ABBE_SCHEMA, rows[i].part,
            abbe_material_table_parse(text, strlen(text), "t.yaml", &t, &error));
  }
#undef A
#undef B
#undef CRYSTAL
}
