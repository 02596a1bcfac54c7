/* The mirrors' single precision against Fresnel's reflectance of a conductor in double. */
#include "tests/scenes/scene_text.h"

#include "spectral/optics.h"
#include "validation/trace/transport/mirrors.h"

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
