/* changed_frame.h: a renderer that is changed, beside one that is made anew, for tests.
 */
#ifndef ABBE_TESTS_GL_CHANGES_CHANGED_FRAME_H
#define ABBE_TESTS_GL_CHANGES_CHANGED_FRAME_H

#include "tests/gl/frame.h"

static const abbe_render_desc tiny = {
    .width = 24, .height = 20, .photons = 32, .map_size = 64, .supersample = 1};

#define GLASS_SCENE                                                                                \
  CAMERA POINT_LIGHT FLOOR BRICK("crown") "- {name: card, shape: rectangle, width: 0.1, height: "  \
                                          "0.1, reflectance: 0.7, transform: "                     \
                                          "[{translate: [-0.2, 0, 0.1]}]}\n"

/* Two lights, a mesh that is traversed, and a receiver that is no rectangle. */
#define MESH_SCENE                                                                                 \
  CAMERA "lights:\n"                                                                               \
         "- {name: lamp, kind: point, position: [0.05, 0.03, 0.6], intensity: 1}\n"                \
         "- {name: spot, kind: spot, position: [-0.4, 0, 0.7], target: [0, 0, 0.2], intensity: 2," \
         " cone: 40}\n" FLOOR RING("crown") HILL

static inline bool stop_at(void *user, double done) {
  int *left = user;
  (void)done;
  return --*left > 0;
}

static inline abbe_result change(abbe_renderer *renderer, const abbe_scene *scene,
                                 const abbe_render_desc *desc) {
  abbe_error error = {0};
  return abbe_renderer_change(renderer, scene, desc, &error);
}

static inline void assert_as_made_anew(abbe_renderer *renderer, const abbe_scene *scene,
                                       const abbe_render_desc *desc, const char *what) {
  OWNED(abbe_image, kept) = {0}, anew = {0}, kept_map = {0}, anew_map = {0};
  HELD(abbe_renderer, other) = make_renderer(scene, desc);
  const abbe_statistics a = draw_frame(renderer), b = draw_frame(other);
  kept = read_picture(renderer, desc->aovs);
  anew = read_picture(other, desc->aovs);
  assert_int_equal(kept.width * kept.height * kept.channels,
                   anew.width * anew.height * anew.channels);
  for (size_t i = 0; i < kept.width * kept.height * kept.channels; i++)
    if (memcmp(&kept.data[i], &anew.data[i], sizeof *kept.data) != 0) {
      print_error("after %s, value %zu: %.9g, and %.9g anew\n", what, i, (double)kept.data[i],
                  (double)anew.data[i]);
      fail();
    }
  if (abbe_renderer_plan(renderer)->caustics && abbe_renderer_plan(renderer)->reaches[0]) {
    kept_map = map_of(renderer, 0);
    anew_map = map_of(other, 0);
    assert_same_pixels(&kept_map, &anew_map);
  }
  assert_memory_equal(&a.energy, &b.energy, sizeof a.energy);
  assert_int_equal(a.photons, b.photons);
}

/* Of the frame after a change. */
static inline void assert_ran(const abbe_statistics *s, bool light, bool eye) {
  for (abbe_pass pass = 0; pass < ABBE_PASS_COUNT; pass++) {
    const bool is_light = abbe_pass_stage_of(pass) == ABBE_STAGE_LIGHT;
    const bool ran = abbe_statistics_ran(s, pass);
    if (ran && !(is_light ? light : eye)) print_error("'%s' ran\n", abbe_plan_item_text(pass));
    assert_true(!ran || (is_light ? light : eye));
    assert_false(ran && s->kept[pass]);
  }
  assert_true(abbe_statistics_ran(s, ABBE_PASS_PHOTONS) == light);
  assert_true(s->kept[ABBE_PASS_PHOTONS] == !light);
  assert_true(abbe_statistics_ran(s, ABBE_PASS_EYE_RECEIVERS) == eye);
  assert_true(s->kept[ABBE_PASS_EYE_RECEIVERS] == !eye);
}

#endif
