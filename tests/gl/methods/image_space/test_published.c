/* The published methods behind one set of verbs: what of their light a moved camera keeps. */
#include "tests/gl/frame.h"

GROUP(make_context, free_context);

/* A camera that moves keeps the map in the light's image, or the buffer of photons that go to
 * its own, and sees what it would see anew. */
TEST(still_light_is_kept) {
  static const struct {
    abbe_profile profile;
    abbe_fill fill;
    bool draws; /* photons, into the camera's image */
    unsigned polygons;
  } rows[] = {{ABBE_PROFILE_SHAH2007, ABBE_FILL_AUTO, false, 0},
              {ABBE_PROFILE_SHAH2007_CIE, ABBE_FILL_AUTO, false, 0},
              {ABBE_PROFILE_WYMAN2006, ABBE_FILL_AUTO, false, 0},
              {ABBE_PROFILE_WYMAN2006_CIE, ABBE_FILL_AUTO, false, 0},
              {ABBE_PROFILE_WYMAN2006, ABBE_FILL_POINTS, true, 0},
              {ABBE_PROFILE_WYMAN2006, ABBE_FILL_QUADS, true, 0},
              {ABBE_PROFILE_WYMAN2006_CIE, ABBE_FILL_QUADS, false, ABBE_POLYGONS_IN_LIGHT},
              {ABBE_PROFILE_WYMAN2006_CIE, ABBE_FILL_GATHER_EYE, true, 0}};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  OWNED(abbe_scene, moved) = scene_of(
      "materials: glass.yaml\ncamera: {eye: [0.4, -0.8, 0.6], target: [0, 0, 0]}\n" POINT_LIGHT
          FLOOR BALL("flat"));
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const abbe_render_desc desc =
        FIELDS(.profile = rows[i].profile, .fill = rows[i].fill, .polygons = rows[i].polygons,
               .width = 64, .height = 48, .photons = 64, .map_size = 64);
    HELD(abbe_renderer, renderer) = make_renderer(&scene, &desc);
    abbe_statistics statistics = draw_frame(renderer);
    assert_true(abbe_statistics_ran(&statistics, ABBE_PASS_PHOTONS));
    OK(abbe_renderer_change(renderer, &moved, &desc, &error));
    statistics = draw_frame(renderer);
    assert_int_equal(abbe_statistics_ran(&statistics, ABBE_PASS_PHOTONS), rows[i].draws);
    assert_false(abbe_statistics_ran(&statistics, ABBE_PASS_RECEIVER_DEPTH));
    const bool covers = rows[i].fill == ABBE_FILL_QUADS; /* also what is kept */
    assert_int_equal(statistics.polygon_layers > 0, covers);
    OWNED(abbe_image, kept) = picture_of(renderer);
    abbe_renderer_free(renderer);
    renderer = make_renderer(&moved, &desc);
    draw_frame(renderer);
    OWNED(abbe_image, anew) = picture_of(renderer);
    assert_same_pixels(&kept, &anew);
  }
}
