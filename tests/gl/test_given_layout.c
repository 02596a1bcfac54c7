/* A layout that the request gives for a light's map, in a scene so far from the origin that the
 * renderer works in coordinates of its own. */
#include "tests/gl/frame.h"

#define FAR_SCENE                                                                                  \
  "materials: glass.yaml\n"                                                                        \
  "camera: {eye: [10000, 9999, 0.5], target: [10000, 10000, 0.05]}\n"                              \
  "lights:\n- {name: lamp, kind: point, position: [10000.05, 10000, 0.6], intensity: 1}\n"         \
  "objects:\n"                                                                                     \
  "- {name: floor, shape: rectangle, width: 2, height: 2, reflectance: 0.5,\n"                     \
  "   transform: [{translate: [10000, 10000, 0]}]}\n"                                              \
  "- {name: brick, shape: box, size: [0.1, 0.08, 0.06], material: crown,\n"                        \
  "   transform: [{translate: [10000, 10000, 0.2]}]}\n"

static void assert_same_view(const abbe_view *a, const abbe_view *b) {
  for (int k = 0; k < 3; k++) {
    assert_true(a->origin[k] == b->origin[k]);
    assert_true(a->forward[k] == b->forward[k]);
  }
  for (int k = 0; k < 4; k++) assert_true(a->window[k] == b->window[k]);
}

GROUP(make_context, free_context);

/* The plan is in the user's coordinates, as the request was, and may be one again. */
TEST(the_plan_has_it_as_it_was_given) {
  abbe_map_layout fitted, given, used;
  OWNED(abbe_image, map) = {0};
  OWNED(abbe_image, same) = {0};
  abbe_render_desc desc = {.width = 16, .height = 16, .photons = 32, .map_size = 64};
  OWNED(abbe_scene, scene) = scene_of(FAR_SCENE);
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  abbe_renderer_map_layout(renderer, 0, &fitted);
  given = fitted;
  desc.map_layout = &given;
  for (int turn = 0; turn < 3; turn++) {
    const abbe_render_desc again = abbe_renderer_plan(renderer)->desc;
    OK(abbe_renderer_change(renderer, &scene, turn < 2 ? &desc : &again, &error));
    const abbe_map_layout *held = abbe_renderer_plan(renderer)->desc.map_layout;
    assert_non_null(held);
    assert_same_view(&held->view, &fitted.view);
    abbe_renderer_map_layout(renderer, 0, &used);
    for (int k = 0; k < 3; k++) assert_near(used.view.origin[k], fitted.view.origin[k], 1e-11);
    draw_frame(renderer);
    *(turn == 0 ? &map : &same) = map_of(renderer, 0);
    if (turn > 0) assert_same_pixels(&map, &same);
    if (turn > 0) abbe_image_free(&same);
  }
  assert_true(image_sum(&map, 1) > 0);
  abbe_renderer_free(renderer);
  make_map(&scene, &desc, &same); /* made with the layout at once */
  assert_same_pixels(&map, &same);
}
