#include "tests/check.h"

#include "scenes/cuts/cut.h"
#include "tests/scenes/cuts/designs.h"

TEST(directions_are_those_of_the_gear) {
  OWNED(abbe_cut, cut) = {.gear = 96};
  OK(abbe_cut_add_tier(&cut, 45, 2, &error));
  OK(abbe_cut_add_facet(&cut, 96, &error));
  OK(abbe_cut_add_facet(&cut, 24, &error));
  OK(abbe_cut_add_tier(&cut, -30, 1, &error));
  OK(abbe_cut_add_facet(&cut, 24, &error));
  OK(abbe_cut_add_tier(&cut, -0.0, 1, &error));
  OK(abbe_cut_add_facet(&cut, 24, &error));
  abbe_cut_place(&cut);
  const double expected[4][4] = {{0, sqrt(0.5), sqrt(0.5), 2},
                                 {sqrt(0.5), 0, sqrt(0.5), 2},
                                 {0.5, 0, -sqrt(0.75), 1},
                                 {0, 0, -1, 1}};
  for (int i = 0; i < 4; i++) {
    for (int k = 0; k < 3; k++) assert_near(cut.facet[i].n[k], expected[i][k], 1e-15);
    assert_near(cut.facet[i].d, expected[i][3], 0);
  }
  cut.gear = -96;
  cut.offset = 48;
  abbe_cut_place(&cut);
  assert_near(cut.facet[0].n[1], -sqrt(0.5), 1e-15);
  assert_near(cut.facet[1].n[0], sqrt(0.5), 1e-15);
  OK(abbe_cut_check(&cut, &error));
}

TEST(angles_and_indices_come_back_from_planes) {
  const char *const designs[] = {design_a, design_b, design_c, design_d};
  for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i]);
    for (size_t f = 0; f < cut.facet_count; f++) {
      const abbe_cut_facet *facet = &cut.facet[f];
      const double angle = cut.tier[facet->tier].angle_deg;
      assert_near(abbe_cut_angle(facet->n), angle, 1e-12);
      assert_int_equal(!signbit(abbe_cut_angle(facet->n)), !signbit(angle));
      const double flat = cut.offset > 0 ? cut.offset : 96;
      const double index = angle == 0 ? flat : facet->index;
      assert_near(abbe_cut_index(&cut, facet->n), index, 1e-9);
    }
  }
}

TEST(names_go_on_within_a_tier) {
  OWNED(abbe_cut, cut) = design_parse(design_d);
  assert_string_equal(abbe_cut_facet_name(&cut, 0), "87");
  assert_string_equal(abbe_cut_facet_name(&cut, 1), "87");
  assert_string_equal(abbe_cut_facet_name(&cut, 2), "G");
  assert_string_equal(abbe_cut_facet_name(&cut, 5), "G2");
  assert_true(abbe_cut_facet_is_girdle(&cut.facet[5]));
  assert_false(abbe_cut_facet_is_girdle(&cut.facet[6]));
  abbe_cut_free(&cut);
  cut = design_parse(design_c);
  assert_string_equal(abbe_cut_facet_name(&cut, 20), "");
  cut.facet[2].name = strdup("late");
  assert_string_equal(abbe_cut_facet_name(&cut, 0), "late");
}

TEST(what_no_stone_has_is_refused) {
  OWNED(abbe_cut, cut) = {.gear = 96};
  REFUSED(ABBE_INVALID_ARGUMENT, "a facet needs a tier before it",
          abbe_cut_add_facet(&cut, 1, &error));
  REFUSED(ABBE_SCHEMA, "at least 4", abbe_cut_check(&cut, &error));
  OK(abbe_cut_add_tier(&cut, 45, 2, &error));
  for (size_t i = 0; i < ABBE_CUT_MAX_FACETS; i++) OK(abbe_cut_add_facet(&cut, 1, &error));
  REFUSED(ABBE_UNSUPPORTED, "no stone has so many", abbe_cut_add_facet(&cut, 1, &error));
  abbe_cut_place(&cut);
  OK(abbe_cut_check(&cut, &error));
  cut.facet[7].n[0] = NAN;
  REFUSED(ABBE_SCHEMA, "facet 8 faces no direction", abbe_cut_check(&cut, &error));
  abbe_cut_place(&cut);
  cut.facet[8].d = INFINITY;
  REFUSED(ABBE_SCHEMA, "lies inf from the centre", abbe_cut_check(&cut, &error));
  cut.facet[8].d = 1;
  cut.facet[7].index = NAN;
  REFUSED(ABBE_SCHEMA, "facet 8 faces no direction", abbe_cut_check(&cut, &error));
  const int gears[] = {0, ABBE_CUT_MAX_GEAR + 1, 96};
  for (int i = 0; i < 3; i++) {
    cut.gear = gears[i];
    cut.offset = i == 2 ? INFINITY : 0;
    REFUSED(ABBE_SCHEMA, "teeth", abbe_cut_check(&cut, &error));
  }
}

TEST(letters_of_windows_1252_become_a_byte_each) {
  char out[32];
  assert_int_equal(abbe_cut_text_narrow("a\xc3\xa9\xe2\x82\xac\xc2\xb0", out, sizeof out), 4);
  assert_string_equal(out, "a\xe9\x80\xb0");
  assert_int_equal(abbe_cut_text_narrow("\xe2\x88\x92\n\x7f", out, sizeof out), 3);
  assert_string_equal(out, "?  ");
  assert_int_equal(abbe_cut_text_narrow("\xc2\x85", out, sizeof out), 1);
  assert_string_equal(out, "?");
  assert_int_equal(abbe_cut_text_narrow("\xff", out, sizeof out), 1);
  assert_string_equal(out, "?");
  assert_int_equal(abbe_cut_text_narrow("abcdef", out, 4), 3);
  assert_string_equal(out, "abc");
}

TEST(bytes_come_back_as_letters) {
  char bytes[256], back[256];
  for (int i = 0; i < 255; i++) bytes[i] = (char)(i + 1);
  FREED char *text = abbe_cut_text_widen(bytes, 255);
  assert_int_equal(abbe_cut_text_narrow(text, back, sizeof back), 255);
  for (int i = 0; i < 255; i++) {
    const unsigned char byte = (unsigned char)bytes[i];
    const bool none = byte == 0x81 || byte == 0x8d || byte == 0x8f || byte == 0x90 || byte == 0x9d;
    const bool control = byte < ' ' || byte == 0x7f;
    assert_int_equal((unsigned char)back[i], none ? '?' : control ? ' ' : byte);
  }
}
