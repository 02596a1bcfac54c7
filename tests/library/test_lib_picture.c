/* Pictures by handle: pixels and names in and out, files there and back, what is refused. */
#include "tests/check.h"

#include "colorimetry/screen/screen_file.h"
#include "library/lib_picture.h"

#include <unistd.h>

HOLDS(abbe_lib_picture);

static const char *const names[] = {"B", "G", "R", "Z"}; /* a file sorts them */
static const float pixels[2 * 3 * 4] = {0.25f, 0.5f, 0.75f, 1,    -1,    0,  1e-7f, 1e7f,
                                        1,     2,    3,     4,    0,     0,  0,     0,
                                        0.1f,  0.2f, 0.3f,  0.4f, 65504, 12, 13,    14};

static char folder[] = "/tmp/abbe-lib-picture-XXXXXX";

static void setup(void) {
  assert_non_null(mkdtemp(folder));
}

static void teardown(void) {
  assert_false(rmdir(folder));
}

static abbe_lib_picture *made(void) {
  abbe_lib_picture *p = NULL;
  OK(abbe_lib_picture_make(3, 2, 4, names, pixels, &p, &error));
  return p;
}

static void assert_is_made(abbe_lib_picture *p) {
  assert_int_equal(abbe_lib_picture_width(p), 3);
  assert_int_equal(abbe_lib_picture_height(p), 2);
  assert_int_equal(abbe_lib_picture_channels(p), 4);
  for (size_t i = 0; i < 4; i++) assert_string_equal(abbe_lib_picture_channel(p, i), names[i]);
  assert_null(abbe_lib_picture_channel(p, 4));
  assert_memory_equal(abbe_lib_picture_pixels(p), pixels, sizeof pixels);
}

GROUP(setup, teardown);

TEST(pixels_are_copied) {
  HELD(abbe_lib_picture, p) = made();
  assert_is_made(p);
  assert_true(abbe_lib_picture_pixels(p) != pixels);
  abbe_lib_picture_free(p);
  OK(abbe_lib_picture_make(2, 2, 1, names, NULL, &p, &error));
  for (int i = 0; i < 4; i++) assert_near(abbe_lib_picture_pixels(p)[i], 0, 0);
}

TEST(a_file_keeps_every_bit) {
  HELD(abbe_lib_picture, p) = made();
  HELD(abbe_lib_picture, q) = NULL;
  const char *path = printed("%s/a.exr", folder);
  OK(abbe_lib_picture_set_attribute(p, "abbe:space", "rec709", &error));
  OK(abbe_lib_picture_set_attribute(p, "who", "me", &error));
  OK(abbe_lib_picture_save(p, path, &error));
  OK(abbe_lib_picture_load(path, &q, &error));
  assert_is_made(q);
  assert_string_equal(abbe_lib_picture_attribute(q, "who"), "me");
  assert_string_equal(abbe_lib_picture_attribute(q, "abbe:space"), "rec709");
  assert_null(abbe_lib_picture_attribute(q, "nobody"));
  size_t count = 0;
  while (abbe_lib_picture_attribute_name(q, count) != NULL) count++;
  assert_true(count >= 2);
  assert_int_equal(unlink(path), 0);
}

/* White is white and black is black in every display's view; one stop brightens. */
TEST(a_png_is_for_a_screen) {
  abbe_error error = {0};
  HELD(abbe_lib_picture, p) = NULL;
  abbe_lib_picture *q = NULL;
  const float grey[] = {0, 0, 0, 0.1f, 0.1f, 0.1f};
  const char *const brighter[] = {"exposure=1", "bits=16"};
  float plain = 0;
  const char *path = printed("%s/a.png", folder);
  assert_int_equal(abbe_lib_picture_make(2, 1, 3, names, grey, &p, &error), ABBE_OK);
  for (size_t n = 0; n <= 2; n += 2) {
    assert_int_equal(abbe_lib_picture_save_png(p, path, brighter, n, &error), ABBE_OK);
    assert_int_equal(abbe_lib_picture_load(path, &q, &error), ABBE_OK);
    const float *shown = abbe_lib_picture_pixels(q);
    assert_near(shown[0], 0, 0.01);
    if (n == 0) plain = shown[3];
    assert_true(shown[3] > 0.1 && shown[3] < 1);
    if (n == 2) assert_true(shown[3] > 1.1 * plain);
    abbe_lib_picture_free(q);
  }
  assert_int_equal(
      abbe_lib_picture_save_png(p, path, (const char *const[]){"view=None"}, 1, &error),
      ABBE_COLOUR);
  assert_int_equal(abbe_lib_picture_save_png(p, path, (const char *const[]){"bits=12"}, 1, &error),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(unlink(path), 0);
}

/* Those that are stated are not replaced by those that the file needs. */
TEST(bits_are_taken_or_refused) {
  HELD(abbe_lib_picture, p) = made();
  const char *path = printed("%s/a.png", folder);
  const char *const hdr[] = {"display=Rec.2100 PQ", "bits=16", "bits=8"};
  OK(abbe_lib_picture_save_png(p, path, hdr, 1, &error));
  OK(abbe_lib_picture_save_png(p, path, hdr, 2, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "16 bits", abbe_lib_picture_save_png(p, path, hdr, 3, &error));
  if (abbe_screen_kind_of("a.avif")->library == NULL)
    REFUSED(ABBE_INVALID_ARGUMENT, "10 or 12",
            abbe_lib_picture_save_png(p, "a.avif", hdr + 2, 1, &error));
  assert_int_equal(unlink(path), 0);
}

TEST(what_is_none_is_refused) {
  abbe_lib_picture *p = NULL;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_picture_make(0, 2, 1, names, NULL, &p, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_picture_make(2, 40000, 1, names, NULL, &p, &error));
  REFUSED(ABBE_IO, "/nowhere/a.exr", abbe_lib_picture_load("/nowhere/a.exr", &p, &error));
  assert_null(p);
  p = made();
  REFUSED(ABBE_INVALID_ARGUMENT, "mauve",
          abbe_lib_picture_set_attribute(p, "abbe:space", "mauve", &error));
  REFUSED(ABBE_IO, "", abbe_lib_picture_save(p, "/nowhere/a.exr", &error));
  abbe_lib_picture_free(p);
  abbe_lib_picture_free(NULL);
  assert_int_equal(abbe_lib_picture_width(NULL), 0);
  assert_null(abbe_lib_picture_pixels(NULL));
}
