#include "tests/check.h"

#include "colorimetry/image/picture_space.h"

static abbe_image picture(const char *id, const double *xy) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_image image;
  OK(abbe_image_make(1, 1, 3, names, &image, &error));
  if (id != NULL) OK(abbe_image_set_attribute(&image, "colorInteropID", id, &error));
  for (int i = 0; i < 8 && xy != NULL; i++) image.xy[i] = xy[i];
  return image;
}

static const double rec709[8] = {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
static const double ap1[8] = {0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767};

/* Y of red, green and blue is the middle row of the published matrices. */
TEST(an_id_says_what_the_numbers_are) {
  static const struct {
    const char *id;
    abbe_rgb_space space;
    double y[3];
  } known[] = {
      {"lin_ap1_scene", ABBE_RGB_SPACE_ACESCG, {0, 0, 0}},
      {"lin_rec709_scene", ABBE_RGB_SPACE_REC709, {0.2126, 0.7152, 0.0722}},
      {"studio:show:lin_rec709_scene", ABBE_RGB_SPACE_REC709, {0.2126, 0.7152, 0.0722}},
      {"lin_p3d65_scene", ABBE_RGB_SPACE_COUNT, {0.2290, 0.6917, 0.0793}},
      {"lin_rec2020_scene", ABBE_RGB_SPACE_COUNT, {0.2627, 0.6780, 0.0593}},
      {"lin_adobergb_scene", ABBE_RGB_SPACE_COUNT, {0.2973, 0.6274, 0.0753}},
      {"lin_ciexyzd65_scene", ABBE_RGB_SPACE_XYZ, {0, 1, 0}},
  };
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    OWNED(abbe_image, image) = picture(known[i].id, NULL);
    abbe_picture_space space;
    OK(abbe_picture_space_find(&image, false, "x.exr", &space, &error));
    assert_int_equal(space.space, known[i].space);
    assert_false(space.assumed);
    for (int k = 0; k < 3 && known[i].y[1] > 0; k++)
      assert_near(space.to_xyz[3 + k], known[i].y[k], 6e-5);
  }
}

TEST(an_id_is_of_colours_and_agrees_with_the_chromaticities) {
  static const struct {
    const char *id;
    const double *xy;
    const char *words;
  } refused[] = {{"lin_rec709_scene", ap1, "contradict each other"},
                 {"data", NULL, "are data and no colours"},
                 {"srgb_rec709_scene", rec709, "'srgb_rec709_scene' is no linear space"},
                 {"LIN_AP1_SCENE", NULL, "is no linear space"}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    OWNED(abbe_image, image) = picture(refused[i].id, refused[i].xy);
    abbe_picture_space space;
    REFUSED(ABBE_COLOUR, refused[i].words,
            abbe_picture_space_find(&image, false, "x.exr", &space, &error));
    OK(abbe_picture_space_find(&image, true, "x.exr", &space, &error)); /* X, Y, Z */
  }
}

TEST(without_an_id_chromaticities_are_meant_and_else_rec709) {
  static const struct {
    const char *id;
    const double *xy;
    abbe_rgb_space space;
    bool assumed;
  } without[] = {{NULL, ap1, ABBE_RGB_SPACE_ACESCG, false},
                 {"unknown", ap1, ABBE_RGB_SPACE_ACESCG, false},
                 {"lin_ap1_scene", ap1, ABBE_RGB_SPACE_ACESCG, false},
                 {NULL, NULL, ABBE_RGB_SPACE_REC709, true}};
  for (size_t i = 0; i < sizeof without / sizeof *without; i++) {
    OWNED(abbe_image, image) = picture(without[i].id, without[i].xy);
    abbe_picture_space space;
    OK(abbe_picture_space_find(&image, false, "x.exr", &space, &error));
    assert_int_equal(space.space, without[i].space);
    assert_int_equal(space.assumed, without[i].assumed);
  }
}

TEST(an_observer_that_is_not_known_is_refused) {
  OWNED(abbe_image, image) = picture(NULL, rec709);
  abbe_picture_space space;
  OK(abbe_image_set_attribute(&image, "abbe:observer", "me", &error));
  for (int xyz = 0; xyz < 2; xyz++)
    REFUSED(ABBE_COLOUR, "abbe:observer is 'me'",
            abbe_picture_space_find(&image, xyz, "x.exr", &space, &error));
  assert_null(abbe_picture_space_id(&image));
}

static void check_colour(abbe_colour_map map, double t, double r, double g, double b,
                         double tolerance) {
  double rgb[3];
  abbe_colour_map_at(map, t, rgb);
  assert_near(rgb[0], r, tolerance);
  assert_near(rgb[1], g, tolerance);
  assert_near(rgb[2], b, tolerance);
}

/* The colours that the paper prints, in 8 bits. */
TEST(differences_have_the_published_ends) {
  check_colour(ABBE_COLOUR_MAP_DIFFERENCE, 0, 59 / 255.0, 76 / 255.0, 192 / 255.0, 1.5 / 255);
  check_colour(ABBE_COLOUR_MAP_DIFFERENCE, 0.5, 221 / 255.0, 221 / 255.0, 221 / 255.0, 1.0 / 255);
  check_colour(ABBE_COLOUR_MAP_DIFFERENCE, 1, 180 / 255.0, 4 / 255.0, 38 / 255.0, 1.5 / 255);
}

TEST(amounts_grow_lighter) {
  check_colour(ABBE_COLOUR_MAP_AMOUNT, 0, 0, 0, 0, 0);
  check_colour(ABBE_COLOUR_MAP_AMOUNT, 1, 1, 1, 1, 0);
  double before = -1;
  for (int i = 0; i <= 1000; i++) {
    double rgb[3];
    abbe_colour_map_at(ABBE_COLOUR_MAP_AMOUNT, i / 1000.0, rgb);
    /* the weights that the map is built about: perceived brightness of encoded components */
    double lightness = 0.30 * rgb[0] + 0.59 * rgb[1] + 0.11 * rgb[2];
    assert_true(lightness > before);
    assert_near(lightness, i / 1000.0, 0.003);
    before = lightness;
  }
}

TEST(what_is_outside_is_held) {
  for (int map = 0; map < 2; map++) {
    double in[3], out[3];
    abbe_colour_map_at((abbe_colour_map)map, 0, in);
    abbe_colour_map_at((abbe_colour_map)map, -INFINITY, out);
    assert_memory_equal(in, out, sizeof in);
    abbe_colour_map_at((abbe_colour_map)map, 1, in);
    abbe_colour_map_at((abbe_colour_map)map, 7, out);
    assert_memory_equal(in, out, sizeof in);
    check_colour((abbe_colour_map)map, NAN, 0, 0.8, 0, 0);
  }
}
