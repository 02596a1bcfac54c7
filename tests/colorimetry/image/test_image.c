#include "tests/check.h"

#include "colorimetry/image/image.h"

static const char *const rgb[] = {"R", "G", "B"};

TEST(make_is_black_and_named) {
  MADE(abbe_image, image, abbe_image_make(3, 2, 3, rgb, &image, &error));
  for (int i = 0; i < 18; i++) assert_true(image.data[i] == 0);
  assert_int_equal(abbe_image_find_channel(&image, "B"), 2);
  assert_true(abbe_image_find_channel(&image, "A") == (size_t)-1);
  abbe_image_free(&image);
  assert_null(image.data);
  abbe_image_free(NULL);
}

TEST(sizes_are_checked_first) {
  static const size_t bad[][3] = {{0, 1, 1},        {1, 0, 1},
                                  {1, 1, 0},        {ABBE_IMAGE_MAX_SIDE + 1, 1, 1},
                                  {1, SIZE_MAX, 1}, {1, 1, ABBE_IMAGE_MAX_CHANNELS + 1}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    abbe_image image = {0};
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_image_make(bad[i][0], bad[i][1], bad[i][2], rgb, &image, &error));
    assert_null(image.data);
    assert_true(strlen(last_error.text) > 20);
  }
}

TEST(attributes_have_a_limit) {
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, rgb, &image, &error));
  for (int i = 0; i < ABBE_IMAGE_MAX_ATTRIBUTES; i++) {
    OK(abbe_image_set_attribute(&image, printed("a%d", i), "", &error));
  }
  OK(abbe_image_set_attribute(&image, "a7", "other", &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "'more'", abbe_image_set_attribute(&image, "more", "", &error));
}

TEST(what_unfolds) {
  static const struct {
    size_t width, height, channels, bytes;
    abbe_result result;
  } cases[] = {{1000, 1000, 3, 1, ABBE_OK}, /* 12 million bytes are free */
               {1000, 1001, 3, 1, ABBE_UNSUPPORTED},
               {1000, 1001, 3, 12012000 / ABBE_IMAGE_MAX_EXPANSION, ABBE_UNSUPPORTED},
               {1000, 1001, 3, 12012000 / ABBE_IMAGE_MAX_EXPANSION + 1, ABBE_OK},
               {SIZE_MAX, SIZE_MAX, SIZE_MAX, SIZE_MAX, ABBE_UNSUPPORTED}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_error error = {0};
    assert_int_equal(abbe_image_check_expansion("a.png", cases[i].width, cases[i].height,
                                                cases[i].channels, cases[i].bytes, 12000000,
                                                &error),
                     cases[i].result);
    if (cases[i].result != ABBE_OK) assert_non_null(strstr(error.text, "a.png: "));
  }
}

TEST(places) {
  MADE(abbe_image, a, abbe_image_make(3, 2, 3, rgb, &a, &error));
  MADE(abbe_image, b, abbe_image_make(3, 2, 3, rgb, &b, &error));
  assert_int_equal(a.display_window.x1, 2);
  assert_int_equal(a.data_window.y1, 1);
  OK(abbe_image_check_place(&a, "a", &b, "b", &error));
  b.data_window.x0 = 1; /* where there is data does not matter */
  OK(abbe_image_check_place(&a, "a", &b, "b", &error));
  b.display_window = (abbe_image_window){0, 3, 2, 4};
  REFUSED(ABBE_INVALID_ARGUMENT, "b (0, 3) to (2, 4)",
          abbe_image_check_place(&a, "a", &b, "b", &error));
  b.display_window = (abbe_image_window){-7, 0, -5, 1};
  REFUSED(ABBE_INVALID_ARGUMENT, "a shows (0, 0) to (2, 1) and b (-7, 0) to (-5, 1)",
          abbe_image_check_place(&a, "a", &b, "b", &error));
}

TEST(names_are_needed) {
  static const char *const bad[] = {"R", "", "B"};
  static const char *const none[] = {"R", NULL, "B"};
  abbe_image image = {0};
  assert_int_equal(abbe_image_make(1, 1, 3, bad, &image, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_image_make(1, 1, 3, none, &image, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_image_make(1, 1, 3, NULL, &image, NULL), ABBE_INVALID_ARGUMENT);
}

TEST(attributes) {
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, rgb, &image, &error));
  assert_null(abbe_image_attribute_text(&image, "abbe:space"));
  OK(abbe_image_set_attribute(&image, "abbe:space", "xyz", &error));
  OK(abbe_image_set_attribute(&image, "comment", "", &error));
  OK(abbe_image_set_attribute(&image, "abbe:space", "acescg", &error));
  assert_int_equal(image.attribute_count, 2);
  assert_string_equal(abbe_image_attribute_text(&image, "abbe:space"), "acescg");
  assert_string_equal(abbe_image_attribute_text(&image, "comment"), "");
  assert_int_equal(abbe_image_set_attribute(&image, "", "x", NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_image_set_attribute(&image, NULL, "x", NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_image_set_attribute(&image, "a", NULL, NULL), ABBE_INVALID_ARGUMENT);
}

TEST(append) {
  static const char *const more[] = {"S0.500nm", "Z"};
  MADE(abbe_image, image, abbe_image_make(2, 1, 3, rgb, &image, &error));
  MADE(abbe_image, other, abbe_image_make(2, 1, 2, more, &other, &error));
  MADE(abbe_image, twice, abbe_image_make(1, 2, 1, more, &twice, &error));
  for (int i = 0; i < 6; i++) image.data[i] = (float)i;
  for (int i = 0; i < 4; i++) other.data[i] = (float)(10 + i);
  image.xy[0] = 0.64;
  OK(abbe_image_set_attribute(&image, "a", "own", &error));
  OK(abbe_image_set_attribute(&other, "a", "its", &error));
  OK(abbe_image_set_attribute(&other, "b", "its", &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "1 x 2", abbe_image_append(&image, &twice, &error));
  twice.width = 2;
  REFUSED(ABBE_INVALID_ARGUMENT, "2 x 2", abbe_image_append(&image, &twice, &error));
  twice.width = 1;
  OWNED(abbe_image, full) = {0}, one = {0};
  OK(abbe_image_make(2, 1, 1, rgb, &full, &error));
  OK(abbe_image_make(2, 1, 1, more, &one, &error));
  for (int i = 0; i < ABBE_IMAGE_MAX_ATTRIBUTES; i++)
    OK(abbe_image_set_attribute(&full, printed("a%d", i), "", &error));
  OK(abbe_image_set_attribute(&one, "one more", "", &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "one more", abbe_image_append(&full, &one, &error));
  assert_int_equal(full.channels, 1);
  OK(abbe_image_append(&image, &other, &error));
  assert_int_equal(image.channels, 5);
  assert_string_equal(image.channel[3], "S0.500nm");
  static const float expected[] = {0, 1, 2, 10, 11, 3, 4, 5, 12, 13};
  for (int i = 0; i < 10; i++) assert_true(image.data[i] == expected[i]);
  assert_true(image.xy[0] == 0.64 && image.width == 2);
  assert_string_equal(abbe_image_attribute_text(&image, "a"), "own");
  assert_string_equal(abbe_image_attribute_text(&image, "b"), "its");
  REFUSED(ABBE_INVALID_ARGUMENT, "'S0.500nm' already", abbe_image_append(&image, &other, &error));
}

TEST(bands_are_known_by_their_channels) {
  static const char *const others[] = {
      "R", "S0.", "S0.nm", "S0.550nm", "S0.550,00nm", "stderr.S0.550,000000nm", "S0.550,000000nm2"};
  char name[64];
  double middle = 0;
  for (double nm = 385; nm < 780; nm += 26.34375) {
    abbe_image_band_name(nm, name, sizeof name);
    assert_true(abbe_image_band_middle(name, &middle));
    assert_near(middle, nm, 1e-6);
  }
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    assert_false(abbe_image_band_middle(others[i], &middle));
}
