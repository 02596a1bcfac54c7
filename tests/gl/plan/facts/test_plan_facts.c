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
  assert_int_equal(plan.note_count, 16);
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
