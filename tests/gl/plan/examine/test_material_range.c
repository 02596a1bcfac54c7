/* Extremes of index and attenuation over a range, and an index that is not known in it. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/examine/spectral_needs.h"

TEST(extremes_are_those_of_the_range) {
  abbe_material_range range;
  double first, last;
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR BALL("murk")); /* n falls; 20 per m at 400, 0 at 500 */
  const abbe_material *murk = scene.object[1].material;
  OK(abbe_material_range_make(murk, 400, 700, &range, &error));
  OK(abbe_material_n(murk, 400, &first, &error));
  OK(abbe_material_n(murk, 700, &last, &error));
  assert_true(range.most_n == first && range.least_n == last && last < first);
  assert_near(range.most_per_m, 20, 1e-12);
  assert_near(range.least_per_m, 0, 0);
  OK(abbe_material_n(murk, 550, &first, &error));
  assert_near(range.middle_n, first, 0);
  assert_near(range.middle_per_m, 0, 0);
  OK(abbe_material_range_make(murk, 500, 700, &range, &error));
  assert_near(range.most_per_m, 0, 0);
}

TEST(an_unknown_index_is_an_error) {
  abbe_material_range range;
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("narrow"));
  const abbe_material *narrow = scene.object[1].material;
  OK(abbe_material_range_make(narrow, 400, 700, &range, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "narrow", abbe_material_range_make(narrow, 400, 701, &range, &error));
}
