/* One view of a light, or a cube of them, and who may have which. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/light_views.h"

/* Where the default profile has a cube, the thesis's has none; of a spot its view is the cone. */
TEST(the_thesis_profile_looks_through_one_view) {
  static const struct {
    const char *kind;
    bool one_view;
  } rows[] = {{"point", false}, {"spot, direction: [1, 0, 0], cone: 30", true}};
  static const abbe_profile profiles[] = {ABBE_PROFILE_THESIS, ABBE_PROFILE_THESIS_CIE};
  for (size_t i = 0; i < 4; i++) {
    OWNED(abbe_plan, plan);
    abbe_error error = {0};
    OWNED(abbe_scene, scene) = scene_of(printed(
        CAMERA "lights:\n- {name: lamp, kind: %s, position: [0.1, 0, 0.2], intensity: 1}\n" FLOOR
               "%s" BALL("crown"),
        rows[i / 2].kind, BRICK("crown")));
    const abbe_render_desc desc = {.profile = profiles[i % 2]};
    const abbe_result result = abbe_plan_make(&scene, &desc, &plan, &error);
    assert_int_equal(result, rows[i / 2].one_view ? ABBE_OK : ABBE_UNSUPPORTED);
    if (!rows[i / 2].one_view) assert_contains(error.text, "looks through one view");
  }
}
