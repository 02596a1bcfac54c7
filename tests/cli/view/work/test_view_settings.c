/* What stages ask of the renderer: the presets of their names, and what keeps up with a hand. */
#include "tests/check.h"

#include "cli/view/work/view_worker.h"

static abbe_preset_point points[] = {
    {.desc = {.wavelengths = 5, .photons = 100, .supersample = 1}},
    {.desc = {.wavelengths = 9, .photons = 200, .supersample = 1}},
    {.desc = {.wavelengths = 31, .photons = 400, .supersample = 2}}};
static const abbe_preset_front measured = {.named = {0, 1, 2}, .count = 3, .point = points};
static const abbe_preset_front unknown = {0};

static abbe_render_desc ask(const abbe_preset_front *front, abbe_view_job job) {
  const abbe_view_document none = {0};
  return abbe_view_settings_of(front, NULL, &job, &none, NULL);
}

TEST(a_stage_takes_the_preset_of_its_name) {
  const abbe_render_desc balanced =
      ask(&measured, (abbe_view_job){.stage = ABBE_VIEW_BALANCED, .light = ABBE_VIEW_BALANCED});
  const abbe_render_desc accurate =
      ask(&measured, (abbe_view_job){.stage = ABBE_VIEW_ACCURATE, .light = ABBE_VIEW_ACCURATE});
  assert_int_equal(balanced.wavelengths, 9);
  assert_int_equal(balanced.photons, 200);
  assert_int_equal(accurate.wavelengths, 31);
  assert_int_equal(accurate.supersample, 2);
  assert_int_equal(accurate.coarse, ABBE_COARSE_NONE);
  assert_null(abbe_view_settings_point(&unknown, ABBE_VIEW_ACCURATE));
  assert_ptr_equal(abbe_view_settings_point(&measured, ABBE_VIEW_MOVING), &points[0]);
}

/* A camera that moves leaves light as good as it is; light that moves is coarser itself. */
TEST(what_moves_is_coarser) {
  const abbe_render_desc camera =
      ask(&measured,
          (abbe_view_job){.stage = ABBE_VIEW_MOVING, .light = ABBE_VIEW_ACCURATE, .eye_step = 2});
  const abbe_render_desc light =
      ask(&measured,
          (abbe_view_job){.stage = ABBE_VIEW_MOVING, .light = ABBE_VIEW_MOVING, .light_step = 2});
  assert_int_equal(camera.photons, 400);
  assert_int_equal(camera.wavelengths, 31);
  assert_int_equal(camera.supersample, 1);
  assert_int_equal(camera.upsample, 3);
  assert_int_equal(camera.coarse, ABBE_COARSE_EYE);
  assert_int_equal(camera.history, 0);
  assert_int_equal(light.photons, 50);
  assert_int_equal(light.coarse, ABBE_COARSE_ALL);
  assert_int_equal(light.history, ABBE_RENDER_MAX_HISTORY);
}

/* Sliders hold for what rests, not for light that moves. */
TEST(a_documents_settings_hold_at_rest) {
  const abbe_view_document few = {.wavelengths = 13, .photons = 77, .map_size = 333};
  const abbe_view_job rest = {.stage = ABBE_VIEW_BALANCED, .light = ABBE_VIEW_BALANCED};
  const abbe_view_job moves = {.stage = ABBE_VIEW_MOVING, .light = ABBE_VIEW_MOVING};
  const abbe_render_desc a = abbe_view_settings_of(&unknown, NULL, &rest, &few, NULL);
  const abbe_render_desc b = abbe_view_settings_of(&unknown, NULL, &moves, &few, NULL);
  assert_int_equal(a.wavelengths, 13);
  assert_int_equal(a.photons, 77);
  assert_int_equal(a.map_size, 333);
  assert_int_not_equal(b.wavelengths, 13);
  assert_int_not_equal(b.photons, 77);
  assert_int_not_equal(b.map_size, 333);
}

/* A stone under water has what it has alone, as far as it is not fine enough by itself. */
TEST(a_small_refractor_beside_a_large_one_is_looked_at_closer) {
  static const abbe_material water = {0};
  abbe_object object[2] = {{.material = &water, .max = {5, 0, 0}},
                           {.material = &water, .max = {1, 0, 0}}};
  const abbe_scene scene = {.object = object, .object_count = 2};
  static abbe_preset_point own[] = {{.desc = {.photons = 24, .map_size = 128}},
                                    {.desc = {.photons = 64, .map_size = 256}},
                                    {.desc = {.photons = 512, .map_size = 2048}}};
  const abbe_preset_front front = {.named = {0, 1, 2}, .count = 3, .point = own};
  const size_t right[][2] = {{120, 640}, {256, 1024}, {512, 2048}};
  const abbe_view_stage stages[] = {ABBE_VIEW_MOVING, ABBE_VIEW_BALANCED, ABBE_VIEW_ACCURATE};
  const abbe_view_document none = {0};
  for (int i = 0; i < 3; i++) {
    const abbe_view_job job = {.stage = stages[i], .light = stages[i]};
    const abbe_render_desc desc = abbe_view_settings_of(&front, &scene, &job, &none, NULL);
    assert_int_equal(desc.photons, right[i][0]);
    assert_int_equal(desc.map_size, right[i][1]);
  }
}
