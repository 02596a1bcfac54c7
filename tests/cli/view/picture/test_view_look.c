/* A place that a caustic lights is fed by photons, however few the picture has. */
#include "tests/gl/frame.h"

#include "cli/view/picture/view_feed.h"

/* The sun through a brick, half a metre wide, over a floor. */
static const char text[] =
    "materials: glass.yaml\n"
    "camera: {eye: [0, -2, 1.5], target: [0, 0, 0]}\n"
    "lights: [{name: sun, kind: directional, direction: [0, 0, -1], irradiance: 1}]\n"
    "objects:\n"
    "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5}\n"
    "- {name: brick, shape: box, size: [0.5, 0.5, 0.2], material: crown,\n"
    "   transform: [{translate: [0, 0, 0.3]}]}\n";

GROUP(make_context, free_context);

TEST(a_caustic_is_fed_however_few_photons_there_are) {
  static const double place[3] = {0.11, 0.07, 0};
  const double radius = 2e-4; /* of 48 pixels, a hundredth of a metre */
  static const size_t photons[] = {8, 20};
  static abbe_view_feed feed;
  volatile int stop = 0;
  OWNED(abbe_scene, scene) = scene_of(text);
  for (size_t i = 0; i < sizeof photons / sizeof *photons; i++) {
    const abbe_render_desc desc = {
        .width = 16, .height = 16, .photons = photons[i], .wavelengths = 3, .map_size = 64};
    HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &desc);
    OK(abbe_view_look_feed(renderer, &scene, place, radius, 550, &stop, &feed, &error));
    assert_int_equal(feed.photons, 0); /* they land too far from each other */
    OK(abbe_view_look_closer(context, renderer, &scene, place, radius, 550, &stop, &feed, &error));
    assert_true(feed.photons > 0 && feed.facet_count == 1);
    assert_int_equal(feed.facet[0].object, 1);
    assert_near(feed.facet[0].normal[2], 1, 1e-9);
    assert_near(feed.ray[0].entry[0], place[0], 0.01);
    assert_int_equal(abbe_renderer_plan(renderer)->desc.photons, photons[i]);
    stop = 1;
    REFUSED(
        ABBE_CANCELLED, "",
        abbe_view_look_closer(context, renderer, &scene, place, radius, 550, &stop, &feed, &error));
    stop = 0;
  }
  const abbe_render_desc many = {
      .width = 16, .height = 16, .photons = 513, .wavelengths = 3, .map_size = 1026};
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &many);
  OK(abbe_view_look_feed(renderer, &scene, place, radius, 550, &stop, &feed, &error));
  const size_t found = feed.photons;
  assert_true(found > 0);
  /* there are no more to follow: what was found stays */
  OK(abbe_view_look_closer(context, renderer, &scene, place, radius, 550, &stop, &feed, &error));
  assert_int_equal(feed.photons, found);
}
