/* What a plan holds: entries run by the table's conditions, are found by id, and have limits. */
#include "tests/check.h"

#include "gl/plan/facts/plan_facts.h"

TEST(an_entry_runs_by_its_condition) {
  static abbe_plan plan;
  plan = (abbe_plan){.caustics = true, .reaches = {false, true}};
  abbe_plan_add(&plan, ABBE_PASS_PHOTONS, "%d %s", 7, "wavelengths");
  abbe_plan_add(&plan, ABBE_PASS_LIGHT_BACK, "no back");
  abbe_plan_add_about(&plan, ABBE_CHOICE_LIGHT_MAP, 0, "lamp", "misses");
  abbe_plan_add_about(&plan, ABBE_CHOICE_LIGHT_MAP, 1, "sun", "meets");
  assert_int_equal(plan.entry_count, 4);
  assert_true(plan.entry[0].runs && !plan.entry[1].runs && !plan.entry[2].runs);
  assert_true(plan.entry[3].runs);
  assert_string_equal(plan.entry[0].name, "light: photons");
  assert_string_equal(plan.entry[0].reason, "7 wavelengths");
  assert_string_equal(plan.entry[3].name, "map: sun");
  assert_ptr_equal(abbe_plan_find(&plan, ABBE_CHOICE_LIGHT_MAP, 1), &plan.entry[3]);
  assert_null(abbe_plan_find(&plan, ABBE_CHOICE_LIGHT_MAP, 2));
  assert_null(abbe_plan_find(&plan, ABBE_PASS_EYE_RECEIVERS, 0));
}

/* What turns each item on, alone or with what it needs; all else stays off. */
TEST(each_condition_is_its_own) {
  static const abbe_plan empty = {.receivers = ABBE_RECEIVER_EXACT};
  static abbe_plan plan;
  for (int i = 0; i < ABBE_PLAN_ITEM_COUNT; i++) {
    const bool always = i == ABBE_PASS_EYE_RECEIVERS || i == ABBE_CHOICE_MORE_REFRACTORS ||
                        i == ABBE_CHOICE_RECEIVER_MODEL || i == ABBE_CHOICE_WAVELENGTHS;
    assert_int_equal(abbe_plan_runs(&empty, (abbe_plan_item)i, 0), always);
  }
  plan = (abbe_plan){.caustics = true};
  assert_true(abbe_plan_runs(&plan, ABBE_PASS_LIGHT_FRONT, 0));
  assert_false(abbe_plan_runs(&plan, ABBE_PASS_EYE_FRONT, 0));
  assert_false(abbe_plan_runs(&plan, ABBE_PASS_LIGHT_FRONT_AND_BACK, 0));
  plan.desc.profile = ABBE_PROFILE_THESIS_CIE;
  assert_true(abbe_plan_runs(&plan, ABBE_PASS_LIGHT_FRONT_AND_BACK, 0));
  plan = (abbe_plan){.camera_sees_refractor = true, .draw_back = true};
  assert_true(abbe_plan_runs(&plan, ABBE_PASS_EYE_BACK, 0));
  assert_false(abbe_plan_runs(&plan, ABBE_PASS_LIGHT_BACK, 0));
  plan.desc.exits = 2;
  assert_true(abbe_plan_runs(&plan, ABBE_CHOICE_INNER_REFLECTIONS, 0));
  plan.desc.exits = 1;
  assert_false(abbe_plan_runs(&plan, ABBE_CHOICE_INNER_REFLECTIONS, 0));
  plan = (abbe_plan){.desc = {.upsample = 2}};
  assert_true(abbe_plan_runs(&plan, ABBE_PASS_EYE_PICTURE, 0));
  assert_false(abbe_plan_runs(&plan, ABBE_PASS_EYE_ADAPTIVE, 0));
  plan = (abbe_plan){.desc = {.adaptive = 2}};
  assert_true(abbe_plan_runs(&plan, ABBE_PASS_EYE_ADAPTIVE, 0));
  assert_false(abbe_plan_runs(&plan, ABBE_PLAN_ITEM_COUNT, 0));
  size_t object[] = {3, 5};
  plan = (abbe_plan){.refractor_count = 2, .refractor_object = object};
  assert_true(abbe_plan_runs(&plan, ABBE_CHOICE_REFRACTOR_MODEL, 5));
  assert_false(abbe_plan_runs(&plan, ABBE_CHOICE_REFRACTOR_MODEL, 4));
}

TEST(what_there_is_no_room_for_is_left_out) {
  static abbe_plan plan;
  char wide[600];
  memset(wide, 'x', sizeof wide);
  wide[sizeof wide - 1] = '\0';
  memset(&plan, 0, sizeof plan);
  for (int i = 0; i < 200; i++) {
    abbe_plan_add_about(&plan, ABBE_CHOICE_REFRACTOR_MODEL, 0, wide, "%s", wide);
    abbe_plan_note(&plan, "%s", wide);
  }
  assert_int_equal(plan.entry_count, ABBE_PLAN_MAX_ENTRIES);
  assert_int_equal(plan.note_count, 200);
  assert_int_equal(strlen(plan.note[199]), sizeof plan.note[199] - 1);
  assert_int_equal(strlen(plan.entry[0].name), strlen("model: ") + 50);
  assert_int_equal(strlen(plan.entry[0].reason), sizeof plan.entry[0].reason - 1);
  abbe_plan_free(&plan);
  abbe_plan_free(NULL);
}

/* Four wavelengths are enough to begin with where light is laid between them, unless the air takes
 * of it by wavelength, which hits do not keep. */
TEST(least_wavelengths_are_few_where_light_is_bridged) {
  static abbe_plan plan;
  static const struct {
    size_t wavelengths, least;
    bool fills, tinted_air;
    abbe_profile profile;
  } rows[] = {
      {7, 4, true, false, ABBE_PROFILE_DEFAULT},
      {7, 7, true, true, 0},
      {7, 7, false, false, 0},
      {3, 3, true, false, 0},
      {7, 7, true, false, 1},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    plan = (abbe_plan){.desc = {.wavelengths = rows[i].wavelengths, .profile = rows[i].profile},
                       .fills = rows[i].fills,
                       .tinted_air = rows[i].tinted_air};
    assert_int_equal(abbe_plan_least_wavelengths(&plan), rows[i].least);
  }
}

/* The texts and stages of all items, once. */

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
    [ABBE_PASS_EYE_GLOW] = "eye: glow",
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
