/* The texts and stages of all items, once. */
#include "tests/check.h"

#include "gl/plan/facts/passes.h"

/* What files, docs and scripts read. */
static const char *const texts[] = {
    [ABBE_PASS_RECEIVER_DEPTH] = "light: receiver depth",
    [ABBE_PASS_LIGHT_FRONT] = "light: refractor front",
    [ABBE_PASS_LIGHT_BACK] = "light: refractor back",
    [ABBE_PASS_LIGHT_FRONT_AND_BACK] = "light: refractor layers",
    [ABBE_PASS_PHOTON_PLACEMENT] = "light: photon placement",
    [ABBE_PASS_PHOTONS] = "light: photons",
    [ABBE_PASS_SPECTRAL_MAP] = "light: spectral map",
    [ABBE_PASS_GAP_FILL] = "light: gap fill",
    [ABBE_PASS_PINHOLES] = "light: pinholes",
    [ABBE_PASS_SHAFTS] = "light: shafts",
    [ABBE_PASS_EYE_RECEIVERS] = "eye: receivers",
    [ABBE_PASS_EYE_FRONT] = "eye: refractor front",
    [ABBE_PASS_EYE_BACK] = "eye: refractor back",
    [ABBE_PASS_EYE_FRONT_AND_BACK] = "eye: refractor layers",
    [ABBE_PASS_EYE_ADAPTIVE] = "eye: adaptive samples",
    [ABBE_PASS_EYE_REFRACTION] = "eye: refraction",
    [ABBE_PASS_EYE_PICTURE] = "eye: picture",
    [ABBE_PASS_EYE_HAZE] = "eye: haze",
    [ABBE_CHOICE_REFRACTOR_MODEL] = "model: ",
    [ABBE_CHOICE_MIRROR] = "mirror: ",
    [ABBE_CHOICE_MORE_REFRACTORS] = "models",
    [ABBE_CHOICE_MULTI_REFRACTOR_PATHS] = "refractors in turn",
    [ABBE_CHOICE_RECEIVER_MODEL] = "model: receivers",
    [ABBE_CHOICE_RECEIVER_SHADOWS] = "shadows of receivers",
    [ABBE_CHOICE_WAVELENGTHS] = "wavelengths",
    [ABBE_CHOICE_INNER_REFLECTIONS] = "inner reflections",
    [ABBE_CHOICE_LIGHT_MAP] = "map: ",
    [ABBE_CHOICE_RECEIVER_MAPS] = "maps on receivers",
    [ABBE_CHOICE_ABSORPTION] = "absorption",
    [ABBE_CHOICE_TEXTURES] = "textures",
    [ABBE_CHOICE_RECEIVER_COLOURS] = "colours of receivers",
    [ABBE_CHOICE_LIGHT_SIZE] = "lights with a size",
    [ABBE_CHOICE_ENVIRONMENT] = "environment",
};

TEST(every_item_has_its_text) {
  assert_int_equal(sizeof texts / sizeof *texts, ABBE_PLAN_ITEM_COUNT);
  for (int i = 0; i < ABBE_PLAN_ITEM_COUNT; i++) {
    assert_non_null(texts[i]);
    assert_string_equal(abbe_plan_item_text((abbe_plan_item)i), texts[i]);
    for (int k = 0; k < i; k++) assert_string_not_equal(texts[i], texts[k]);
  }
  assert_string_equal(abbe_plan_item_text(ABBE_PLAN_ITEM_COUNT), "unknown");
  assert_string_equal(abbe_plan_item_text((abbe_plan_item)-1), "unknown");
}

TEST(a_text_begins_with_its_stage) {
  for (int i = 0; i < ABBE_PASS_COUNT; i++) {
    const bool light = abbe_pass_stage_of((abbe_pass)i) == ABBE_STAGE_LIGHT;
    assert_memory_equal(texts[i], light ? "light: " : "eye: ", light ? 7 : 5);
  }
}
