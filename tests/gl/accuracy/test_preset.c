/* Presets: what is shipped is whole, broken files are named, and choices are what they promise. */
#include "tests/gl/frame.h"

#include "gl/accuracy/preset.h"

#define HEAD "error: caustic_de\nwhat: mean error\nrun: a run\nclasses:\n"
#define CLASS                                                                                      \
  "- class: convex\n  scenes: \"gem\"\n  draft: 0\n  balanced: 1\n  accurate: 2\n  front:\n"
#define POINT(photons, light, error)                                                               \
  "  - {wavelengths: 7, photons: " photons                                                         \
  ", map: 512, samples: 1, fill: bridge, exits: 8, share: 0.01,\n     light_ms: " light            \
  ", eye_ms: 10, error: " error ", least: 0.5}\n"
#define THREE POINT("32", "20", "8") POINT("64", "40", "4") POINT("128", "160", "2")

static abbe_result load_presets(const char *text, abbe_presets *out, abbe_error *why) {
  char path[] = "/tmp/abbe-test-presets-XXXXXX";
  int file = mkstemp(path);
  assert_true(file >= 0);
  close(file);
  OK(abbe_file_write(path, text, strlen(text), &error));
  abbe_result result = abbe_presets_load(path, out, why);
  unlink(path);
  return result;
}

GROUP(make_context, free_context);

/* Whether the settings are nowhere coarser than those that a plan takes by itself, and of more
 * wavelengths and photons: what is called accurate is that. */
static bool is_fine(const abbe_render_desc *d) {
  return d->wavelengths > ABBE_PLAN_WAVELENGTHS && d->photons > ABBE_PLAN_PHOTONS &&
         d->map_size >= ABBE_PLAN_MAP && d->supersample >= ABBE_PLAN_SAMPLES && d->upsample == 1 &&
         d->exits >= ABBE_PLAN_EXITS && d->energy_share <= ABBE_PLAN_SHARE &&
         d->fill == ABBE_FILL_BRIDGE && d->model == ABBE_MODEL_AUTO;
}

TEST(the_shipped_presets_are_whole) {
  bool seen[ABBE_PRESET_CLASS_COUNT] = {false};
  MADE(abbe_presets, presets, abbe_presets_load(NULL, &presets, &error));
  assert_string_equal(presets.error, "caustic_de");
  assert_true(strlen(presets.run) > 20);
  for (size_t i = 0; i < presets.count; i++) {
    const abbe_preset_front *f = &presets.front[i];
    assert_false(seen[f->of]);
    seen[f->of] = true;
    assert_true(f->named[ABBE_PRESET_DRAFT] <= f->named[ABBE_PRESET_BALANCED]);
    assert_true(f->named[ABBE_PRESET_BALANCED] <= f->named[ABBE_PRESET_ACCURATE]);
    assert_true(f->named[ABBE_PRESET_ACCURATE] < f->count);
    if (!is_fine(&f->point[f->named[ABBE_PRESET_ACCURATE]].desc))
      fail_msg("%s: accurate is not finer than the defaults", abbe_preset_class_name(f->of));
    for (size_t k = 0; k < f->count; k++) assert_true(f->point[k].least <= f->point[k].error);
  }
  assert_true(seen[ABBE_PRESET_CLASS_SPHERES]);
  assert_true(seen[ABBE_PRESET_CLASS_BOWS]);
  assert_true(seen[ABBE_PRESET_CLASS_CONVEX]);
  assert_true(seen[ABBE_PRESET_CLASS_MESHES]);
}

TEST(broken_files_are_named) {
  static const struct {
    const char *text, *part;
  } broken[] = {
      {"error: caustic_de\n", "'what' is not stated"},
      {"error: a\nwhat: b\nrun: c\n", "classes"},
      {HEAD CLASS POINT("0", "1", "1"), "photons"},
      {HEAD CLASS POINT("64", "-1", "1"), "light_ms"},
      {HEAD CLASS POINT("64", "1", "nan"), "error"},
      {HEAD CLASS THREE POINT("16", "1", "1"), "rising cost and falling error"},
      {HEAD CLASS THREE POINT("16", "500", "3"), "rising cost and falling error"},
      {HEAD CLASS POINT("64", "1", "1"), "balanced"}, /* names a point that is not there */
      {HEAD "- class: cubes\n  scenes: a\n  front: []\n", "cubes"},
      {HEAD "- class: convex\n  scenes: a\n  front: []\n", "a list of 1 to"},
      {HEAD "- class: convex\n  scenes: a\n", "front"},
      {HEAD CLASS "  - {photons: 3}\n", "has no 'wavelengths'"},
      {HEAD CLASS THREE "wrong: 1\n", "wrong"},
      {HEAD CLASS THREE "  margin: 0.9\n", "margin"},
  };
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
    abbe_presets presets;
    abbe_error error = {0};
    if (load_presets(broken[i].text, &presets, &error) == ABBE_OK)
      fail_msg("accepted: %s", broken[i].text);
    assert_contains(error.text, broken[i].part);
    assert_contains(error.text, "/tmp/abbe-test-presets-");
    assert_int_equal(presets.count, 0);
  }
}

/* What is promised is what was measured times the margin; the first point's time is measured anew.
 */
TEST(margins_widen_promises) {
  bool kept;
  MADE(abbe_presets, presets,
       load_presets(HEAD CLASS THREE "  margin: 1.5\n  time_margin: 2\n  margin_scenes: 3\n",
                    &presets, &error));
  const abbe_preset_front *f = &presets.front[0];
  assert_int_equal(f->margin_scenes, 3);
  static const double worst[] = {8, 4, 2}, light[] = {20, 80, 320}, eye[] = {10, 20, 20};
  for (size_t i = 0; i < 3; i++) {
    assert_near(f->point[i].worst, worst[i], 1e-12);
    assert_near(f->point[i].error, 1.5 * worst[i], 1e-12);
    assert_near(f->point[i].light_ms, light[i], 1e-12);
    assert_near(f->point[i].eye_ms, eye[i], 1e-12);
  }
  /* 4 was measured, but 6 is promised. */
  assert_int_equal(abbe_preset_for_error(f, 5.9, &kept), 2);
  assert_int_equal(abbe_preset_for_error(f, 6, &kept), 1);
  const abbe_preset_speed same = {.light = 1, .eye = 1};
  assert_int_equal(abbe_preset_for_time(f, &same, 99, &kept), 0);
  assert_int_equal(abbe_preset_for_time(f, &same, 100, &kept), 1);
}

/* Presets off a sweep without fine settings have no accurate: the name promises more than the
 * defaults. */
TEST(a_name_may_be_missing) {
  MADE(abbe_presets, presets,
       load_presets(HEAD "- class: convex\n  scenes: \"gem\"\n  draft: 0\n  front:\n" THREE,
                    &presets, &error));
  assert_int_equal(presets.front[0].named[ABBE_PRESET_DRAFT], 0);
  assert_int_equal(presets.front[0].named[ABBE_PRESET_ACCURATE], 3);
}

TEST(choices) {
  bool kept;
  MADE(abbe_presets, presets, load_presets(HEAD CLASS THREE, &presets, &error));
  const abbe_preset_front *f = &presets.front[0];
  assert_int_equal(abbe_preset_for_error(f, 100, &kept), 0);
  assert_true(kept);
  assert_int_equal(abbe_preset_for_error(f, 4, &kept), 1);
  assert_int_equal(abbe_preset_for_error(f, 3.9, &kept), 2);
  assert_true(kept);
  assert_int_equal(abbe_preset_for_error(f, 1, &kept), 2);
  assert_false(kept);
  const abbe_preset_speed same = {.light = 1, .eye = 1}, slow = {.light = 2, .eye = 10};
  assert_near(abbe_preset_ms(&f->point[1], &same), 50, 1e-12);
  assert_near(abbe_preset_ms(&f->point[1], &slow), 180, 1e-12);
  assert_int_equal(abbe_preset_for_time(f, &same, 170, &kept), 2);
  assert_true(kept);
  assert_int_equal(abbe_preset_for_time(f, &same, 169, &kept), 1);
  assert_int_equal(abbe_preset_for_time(f, &slow, 169, &kept), 0);
  assert_true(kept);
  assert_int_equal(abbe_preset_for_time(f, &slow, 139, &kept), 0);
  assert_false(kept);
}

TEST(what_the_caller_asks_for_stays) {
  MADE(abbe_presets, presets, load_presets(HEAD CLASS THREE, &presets, &error));
  abbe_render_desc empty = {0}, own = {.wavelengths = 21}, equal = {.photons = 64};
  const abbe_preset_point *point = &presets.front[0].point[1];
  assert_true(abbe_preset_apply(point, NULL, &empty));
  assert_int_equal(empty.photons, 64);
  assert_int_equal(empty.map_size, 512);
  assert_int_equal(empty.supersample, 1);
  assert_int_equal(empty.exits, 0); /* as many as a plan has by itself: left to it */
  assert_int_equal(empty.fill, ABBE_FILL_BRIDGE);
  assert_near(empty.energy_share, 0, 0); /* likewise: a gem's own is lower */
  assert_false(abbe_preset_apply(point, NULL, &own));
  assert_int_equal(own.wavelengths, 21);
  assert_int_equal(own.photons, 64);
  assert_true(abbe_preset_apply(point, NULL, &equal));
  abbe_preset_point fewer = *point;
  abbe_render_desc some = {0}, other = {.exits = 3};
  fewer.desc.exits = 2;
  assert_true(abbe_preset_apply(&fewer, NULL, &some));
  assert_int_equal(some.exits, 2);
  assert_false(abbe_preset_apply(&fewer, NULL, &other));
  assert_int_equal(other.exits, 3);
  abbe_preset_point faint = *point;
  abbe_render_desc low = {0}, high = {.energy_share = 0.1};
  faint.desc.energy_share = 0.003;
  assert_true(abbe_preset_apply(&faint, NULL, &low));
  assert_near(low.energy_share, 0.003, 0);
  assert_false(abbe_preset_apply(&faint, NULL, &high));
  assert_near(high.energy_share, 0.1, 0);
  abbe_preset_point draft = *point;
  abbe_render_desc coarse = {0}, fine = {.supersample = 2};
  draft.desc.upsample = 2;
  assert_true(abbe_preset_apply(&draft, NULL, &coarse));
  assert_true(coarse.upsample == 2 && coarse.supersample == 1);
  assert_false(abbe_preset_apply(&draft, NULL, &fine));
  assert_true(fine.upsample == 1 && fine.supersample == 2);
}

/* The fastest points of meshes follow no light off mirrors, show nothing that stands in a refractor
 * or that it scatters, and are seen from outside alone; others are drawn all the same. */
TEST(layers_are_left_where_they_show_too_little) {
#define SEA(more, deep)                                                                            \
  CAMERA POINT_LIGHT                                                                               \
      "objects:\n- {name: sea, shape: water, size: [1, 1, 0.3], cells: 4, material: crown" more    \
      ", waves: [{amplitude: 0.01, wavelength: 1}]}\n"                                             \
      "- {name: sand, shape: rectangle, width: 1, height: 1, reflectance: 0.5, "                   \
      "transform: [{translate: [0, 0, " deep "]}]}\n"
  static const char *const texts[] = {
      CAMERA POINT_LIGHT FLOOR RING("crown"),
      CAMERA POINT_LIGHT FLOOR RING(
          "crown") "- {name: glass, shape: rectangle, width: 1, height: 1, mirror: 0.9, transform: "
                   "[{translate: [0, 0, -1]}]}\n",
      SEA("", "-0.2"), SEA("", "-0.5"), SEA(", medium: {scattering: 1}", "-0.5")};
  static const bool may[] = {true, false, false, true, false};
  size_t layers = 0;
  const abbe_scene inside = {.camera.inside = true};
  MADE(abbe_presets, presets, abbe_presets_load(NULL, &presets, &error));
  for (size_t t = 0; t < sizeof texts / sizeof *texts; t++) {
    OWNED(abbe_scene, scene) = scene_of(texts[t]);
    for (size_t i = 0; i < presets.count; i++)
      for (size_t k = 0; k < presets.front[i].count; k++) {
        const abbe_preset_point *point = &presets.front[i].point[k];
        const bool layered = point->desc.model == ABBE_MODEL_LAYERS;
        abbe_render_desc desc = {0}, plain = {0};
        abbe_plan plan;
        assert_int_equal(abbe_preset_apply(point, &scene, &desc), !layered || may[t]);
        assert_int_equal(desc.model == ABBE_MODEL_LAYERS, layered && may[t]);
        assert_true(abbe_preset_apply(point, NULL, &plain));
        assert_int_equal(plain.model, point->desc.model);
        if (t < 2) {
          OK(abbe_plan_make(&scene, &desc, &plan, &error));
          abbe_plan_free(&plan);
        }
        layers += layered;
        desc = (abbe_render_desc){0}; /* and none from inside of glass */
        assert_int_equal(abbe_preset_apply(point, &inside, &desc), !layered);
        assert_int_not_equal(desc.model, ABBE_MODEL_LAYERS);
      }
  }
  assert_true(layers > 0);
}

/* From between floor and ball: no receiver stands behind it. */
#define LAMP_BELOW "lights:\n- {name: lamp, kind: point, position: [0, 0, 0.02], intensity: 1}\n"
TEST(classes_and_calibration) {
  static const struct {
    const char *text;
    abbe_preset_class of;
  } scenes[] = {{CAMERA POINT_LIGHT FLOOR, ABBE_PRESET_CLASS_NONE},
                {CAMERA POINT_LIGHT FLOOR BALL("crown"), ABBE_PRESET_CLASS_SPHERES},
                {CAMERA LAMP_BELOW FLOOR BALL("crown"), ABBE_PRESET_CLASS_BOWS},
                {CAMERA LAMP_BELOW FLOOR BRICK("crown"), ABBE_PRESET_CLASS_CONVEX},
                {CAMERA POINT_LIGHT FLOOR RING("crown"), ABBE_PRESET_CLASS_MESHES},
                {CAMERA POINT_LIGHT FLOOR BALL("crown") BRICK("crown"), ABBE_PRESET_CLASS_CONVEX}};
  abbe_error why = {0};
  MADE(abbe_presets, presets, load_presets(HEAD CLASS THREE, &presets, &error));
  for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
    const abbe_preset_front *front = NULL;
    OWNED(abbe_scene, scene) = scene_of(scenes[i].text);
    MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
    assert_int_equal(abbe_preset_class_of(&plan), scenes[i].of);
    abbe_result result = abbe_presets_find(&presets, &plan, &front, &why);
    assert_int_equal(result, scenes[i].of == ABBE_PRESET_CLASS_CONVEX ? ABBE_OK : ABBE_UNSUPPORTED);
    if (result != ABBE_OK) assert_contains(why.text, abbe_preset_class_name(scenes[i].of));
    if (result == ABBE_OK) {
      abbe_preset_speed speed = {0};
      const abbe_render_desc small = {.width = 16, .height = 16};
      OK(abbe_preset_calibrate(context, &scene, front, &small, &speed, &error));
      assert_true(speed.light > 0 && isfinite(speed.light));
      assert_true(speed.eye > 0 && isfinite(speed.eye));
    }
  }
}
