/* What single precision or the photon grid would lose is refused, with what would be right. */
#include "tests/scenes/scene_text.h"

#include "gl/plan/examine/examine.h"
#include "gl/plan/plan.h"

static abbe_result check(const char *text, size_t photons, abbe_error *error) {
  OWNED(abbe_plan, plan);
  const abbe_render_desc desc = {.photons = photons};
  OWNED(abbe_scene, scene) = scene_of(text);
  return abbe_plan_make(&scene, &desc, &plan, error);
}

TEST(ordinary_scenes_are_fine) {
  static const char *const texts[] = {
      CAMERA POINT_LIGHT FLOOR,
      CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("flat"),
      CAMERA SUN FLOOR HILL RING("crown"),
  };
  for (size_t i = 0; i < 3; i++)
    for (size_t photons = 1; photons <= 4096; photons *= 8) OK(check(texts[i], photons, &error));
}

TEST(a_light_too_far_away_is_directional) {
  /* 65536 times 0.08 m is 5243 m. */
  OK(check(
      CAMERA
      "lights:\n- {name: star, kind: point, position: [0, 0, 5000], intensity: 1}\n" FLOOR BALL(
          "flat"),
      0, &error));
  REFUSED(ABBE_UNSUPPORTED, "'star' is 5.5e+03 m from the refractor 'ball'",
          check(CAMERA "lights:\n- {name: star, kind: point, position: [0, 0, 5500.2], intensity: "
                       "30250000}\n" FLOOR BALL("flat"),
                0, &error));
  assert_contains(last_error.text, "a directional light of 1 W/m2");
}

#define OTHER_BALL(x)                                                                              \
  "- {name: other, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [" x            \
  ", 0, 0.2]}], material: flat}\n"

TEST(a_refractor_lost_in_its_scene_is_told) {
  /* However far its receivers reach; 65536 times 0.08 m is 5243 m. */
  OK(check(CAMERA SUN "objects:\n- {name: plain, shape: rectangle, width: 100000, height: 100000, "
                      "reflectance: 0.5}\n" BALL("flat"),
           0, &error));
  OK(check(CAMERA SUN FLOOR BALL("flat") OTHER_BALL("5000"), 1, &error));
  REFUSED(ABBE_UNSUPPORTED, "the refractors reach over 5.3e+03 m, and 'ball' is 0.16 m wide",
          check(CAMERA SUN FLOOR BALL("flat") OTHER_BALL("5300"), 1, &error));
  assert_contains(last_error.text, "move them nearer together");
}

#define PANE(thick)                                                                                \
  "- {name: pane, shape: box, size: [0.2, 0.2, " thick "], material: flat, transform: [{rotate: "  \
  "{axis: [1, 2, 3], angle: 40}}, {translate: [0, 0, 0.2]}]}\n"

TEST(a_skin_has_no_inside) {
  OK(check(CAMERA POINT_LIGHT FLOOR PANE("1e-6"), 0, &error));
  REFUSED(ABBE_UNSUPPORTED, "'pane' is 3e-07 m thin",
          check(CAMERA POINT_LIGHT FLOOR PANE("3e-7"), 0, &error));
}

#define SPECK(radius)                                                                              \
  "- {name: speck, shape: sphere, radius: " radius ", levels: 2, material: flat, transform: "      \
  "[{translate: [0.4, 0, 0.2]}]}\n"

TEST(specks_between_photons_are_told) {
  REFUSED(ABBE_UNSUPPORTED, "'speck' is 0.2",
          check(CAMERA POINT_LIGHT FLOOR BALL("flat") SPECK("1e-3"), 64, &error));
  assert_contains(last_error.text, "photons a side");
  OK(check(CAMERA POINT_LIGHT FLOOR BALL("flat") SPECK("1e-3"), 512, &error));
}

#define CLOSE(at)                                                                                  \
  CAMERA "lights:\n- {name: lamp, kind: point, position: [" at "], intensity: 1}\n" FLOOR

/* Half the ball's diagonal is 0.1386 m, a 4096th of it 3.4e-5 m. */
TEST(a_light_that_touches_is_told) {
  OK(check(CLOSE("0, 0, 0.28004") BALL("flat"), 0, &error));
  REFUSED(ABBE_UNSUPPORTED, "'lamp' is 3e-05 m from the surface of the refractor 'ball'",
          check(CLOSE("0, 0, 0.28003") BALL("flat"), 0, &error));
  assert_contains(last_error.text, "at least 3.38e-05 m away");
  /* Over the middle of a box's side: its corners are no measure of the way. */
  OK(check(CLOSE("0.2, 0, 0.23002") BRICK("flat"), 0, &error));
  REFUSED(ABBE_UNSUPPORTED, "single precision does not resolve what it",
          check(CLOSE("0.2, 0, 0.23001") BRICK("flat"), 0, &error));
}
