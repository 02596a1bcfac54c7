/* However little room its lists have, a renderer lays the same light: what does not fit at a time
 * is laid in more parts, and nothing is left out. */
#include "tests/gl/frame.h"

#include "gl/renderer_state.h"

/* Rooms that are far below what a frame asks for; 0: as they are. */
typedef struct rooms {
  size_t pairs, splats;
} rooms;

static void take_rooms(abbe_renderer *renderer, const rooms *r) {
  if (r->pairs > 0) renderer->caustics.refine.most_pairs = r->pairs;
  if (r->splats == 0) return;
  renderer->caustics.deposit.most_splats = r->splats;
  renderer->caustics.deposit.splat_room = r->splats;
}

static void assert_balanced(const abbe_ledger *l) {
  assert_true(l->reached > 0);
  assert_true(abbe_ledger_imbalance(l) < 1e-4);
}

static void assert_same_light(const char *name, size_t wavelengths, const rooms *r) {
  abbe_image kept = {0};
  abbe_render_desc desc = {
      .width = 16, .height = 16, .photons = 48, .map_size = 64, .wavelengths = wavelengths};
  OWNED(abbe_scene, scene) = shipped_scene(name);
  HELD(abbe_renderer, ample) = make_renderer(&scene, &desc);
  const abbe_statistics all = draw_frame(ample);
  OWNED(abbe_image, map) = map_of(ample, 0);
  HELD(abbe_renderer, scant) = make_renderer(&scene, &desc);
  take_rooms(scant, r);
  for (int frame = 0; frame < 3; frame++) { /* that finds out; that knows; that nobody measures */
    abbe_statistics s = all;
    abbe_renderer_redraw(scant);
    if (frame < 2)
      s = draw_frame(scant);
    else
      OK(abbe_renderer_frame(scant, NULL, NULL, NULL, &error));
    kept = map_of(scant, 0);
    assert_same_pixels(&map, &kept);
    assert_memory_equal(&s.energy, &all.energy, sizeof all.energy);
    assert_balanced(&s.energy);
    abbe_image_free(&kept);
  }
}

GROUP(make_context, free_context);

TEST(refined_intervals_fit_any_room) {
  static const rooms few = {.pairs = 8};
  assert_same_light("gem", 23, &few);
}

TEST(splats_fit_any_room) {
  static const rooms few = {.splats = 512}, both = {.pairs = 37, .splats = 777};
  assert_same_light("prism", 7, &few);
  assert_same_light("gem", 23, &both);
}
