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
