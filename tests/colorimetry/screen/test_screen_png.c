/* Pictures for a screen: which channels are shown, and in which space they are taken to be. */
#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/screen/screen_png.h"

#include <png.h>
#include <unistd.h>

static char path[64];
static const char *source; /* what --source says */
static abbe_screen_png_notes notes;

/* A pixel of `rgb` in the space (ABBE_RGB_SPACE_COUNT: none is stated), as that PNG shows it. */
static void show(const char *const *channel, size_t channels, const float *value,
                 const char *attribute, const double *xy, const char *layer, float out[3]) {
  const abbe_screen_png_desc desc = FIELDS(.display = {.view = "Plain", .source_space = source},
                                           .layer = layer, .bits = 16, .notes = &notes);
  MADE(abbe_image, image, abbe_image_make(1, 1, channels, channel, &image, &error));
  for (size_t i = 0; i < channels; i++) image.data[i] = value[i];
  if (xy != NULL) memcpy(image.xy, xy, sizeof image.xy);
  if (attribute != NULL) abbe_image_set_attribute(&image, "abbe:space", attribute, NULL);
  OK(abbe_screen_png_write(path, &image, &desc, &error));
  MADE(abbe_image, shown, abbe_png_read(path, &shown, &error));
  for (size_t k = 0; k < 3; k++) out[k] = shown.data[k];
  unlink(path);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_screen_png_%ld.png", (long)getpid());
}

GROUP(begin, NULL);

TEST(a_space_by_word_by_channels_and_by_chromaticities) {
  static const char *const rgb[] = {"R", "G", "B"}, *const xyz[] = {"X", "Y", "Z"};
  static const float ap1[] = {0.2f, 0.4f, 0.1f};
  double to_xyz[9], from_xyz[9], v[3] = {0.2, 0.4, 0.1}, xy[8];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, to_xyz);
  abbe_rgb_space_apply(to_xyz, v, v);
  const float in_xyz[] = {(float)v[0], (float)v[1], (float)v[2]};
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  abbe_rgb_space_apply(from_xyz, v, v);
  const float rec709[] = {(float)v[0], (float)v[1], (float)v[2]};
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, xy);
  float want[3], got[4][3];
  show(rgb, 3, ap1, "acescg", NULL, NULL, want);
  show(rgb, 3, rec709, "rec709", NULL, NULL, got[0]);
  show(rgb, 3, rec709, NULL, xy, NULL, got[1]);
  show(xyz, 3, in_xyz, NULL, NULL, NULL, got[2]);
  show(rgb, 3, rec709, NULL, NULL, NULL, got[3]); /* nothing is stated, as OpenEXR has it */
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++) assert_near((double)got[i][k], (double)want[k], 2e-4);
  assert_true(want[1] > want[0] && want[0] > want[2]);
}

/* Colours of other primaries are shown as the same colour in Rec.709 is, with a note where nothing
 * is stated; by the name of the space too. */
TEST(other_primaries) {
  static const char *const rgb[] = {"R", "G", "B"};
  static const struct {
    double xy[8];
    const char *name;
  } spaces[] = {{{0.680, 0.320, 0.265, 0.690, 0.150, 0.060, 0.3127, 0.3290}, "Linear P3-D65"},
                {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}, "Linear Rec.2020"},
                {{0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.3290}, "lin_adobergb_scene"},
                {{0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767}, "ACES2065-1"},
                {{0.5, 0.3, 0.2, 0.7, 0.1, 0.1, 0.3, 0.3}, NULL}};
  static const float value[] = {0.3f, 0.4f, 0.2f};
  for (size_t i = 0; i < sizeof spaces / sizeof spaces[0]; i++) {
    double to_xyz[9], from_xyz[9], v[3] = {0.3, 0.4, 0.2};
    float want[3], got[3];
    OK(abbe_rgb_space_chromaticities_to_xyz(spaces[i].xy, to_xyz, &error));
    abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
    abbe_rgb_space_apply(to_xyz, v, v);
    abbe_rgb_space_apply(from_xyz, v, v);
    const float rec709[] = {(float)v[0], (float)v[1], (float)v[2]};
    show(rgb, 3, rec709, "rec709", NULL, NULL, want);
    show(rgb, 3, value, NULL, spaces[i].xy, NULL, got);
    for (int k = 0; k < 3; k++) assert_near((double)got[k], (double)want[k], 2e-4);
    if (spaces[i].name == NULL) continue;
    source = spaces[i].name;
    show(rgb, 3, value, NULL, NULL, NULL, got);
    source = NULL;
    for (int k = 0; k < 3; k++) assert_near((double)got[k], (double)want[k], 2e-4);
  }
}

TEST(notes) {
  static const char *const rgb[] = {"R", "G", "B", "Z"}, *const y[] = {"Y"};
  static const float value[] = {INFINITY, 1, NAN, INFINITY}, nan[] = {1, 1, NAN, 1};
  float got[3];
  show(rgb, 4, value, NULL, NULL, NULL, got);
  assert_true(notes.space_assumed && notes.odd.infinite == 1 && notes.odd.nan == 0);
  assert_true(got[0] > 0.99f && got[2] < 0.01f);
  show(rgb, 4, nan, "rec709", NULL, NULL, got);
  assert_true(!notes.space_assumed && notes.odd.infinite == 0 && notes.odd.nan == 1);
  show(y, 1, nan, NULL, NULL, NULL, got);
  assert_true(!notes.space_assumed && notes.odd.nan == 0); /* a grey is one in every space */
  /* infinite red of other primaries is red */
  show(rgb, 3, (const float[]){INFINITY, 0, 0}, NULL,
       (const double[]){0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.3290}, NULL, got);
  assert_true(got[0] > 0.99f && got[1] < 0.01f && got[2] < 0.01f);
}

/* The exposure that shows more is that of finite light; of infinite light alone there is none. */
TEST(stops_are_those_of_finite_light) {
  static const char *const rgb[] = {"R", "G", "B"};
  static const float value[][3] = {
      {INFINITY, INFINITY, INFINITY}, {NAN, NAN, NAN}, {3.2f, 1, 0}, {0.1f, 0.2f, 3.2f}};
  const abbe_screen_png_desc desc = {.bits = 8, .notes = &notes};
  MADE(abbe_image, image, abbe_image_make(4, 1, 3, rgb, &image, &error));
  memcpy(image.data, value, sizeof value);
  OK(abbe_screen_png_write(path, &image, &desc, &error));
  assert_near(notes.stops, -2, 1e-6);
  abbe_screen_png_desc exposed = desc;
  exposed.exposed = true;
  exposed.display.exposure = 5;
  OK(abbe_screen_png_write(path, &image, &desc, &error));
  assert_near(notes.exposure, 0, 0);
  OK(abbe_screen_png_write(path, &image, &exposed, &error));
  assert_near(notes.exposure, -2, 1e-6);
  /* what the picture says, unless the request does */
  static const struct {
    const char *said;
    bool stated;
    double stops;
  } of[] = {{"auto", false, -2}, {"1.5", false, 1.5}, {"1e9", false, 60}, {"1.5", true, 0},
            {"auto", true, 0},   {"dark", false, 0},  {"nan", false, 0},  {"", false, 0}};
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    abbe_screen_png_desc own = desc;
    own.stated = of[i].stated;
    OK(abbe_image_set_attribute(&image, ABBE_SCREEN_EXPOSURE, of[i].said, &error));
    OK(abbe_screen_png_write(path, &image, &own, &error));
    assert_near(notes.exposure, of[i].stops, 1e-6);
    if (!of[i].stated) assert_near(abbe_screen_png_exposure(&image), of[i].stops, 1e-6);
  }
  for (size_t i = 0; i < 12; i++) image.data[i] = INFINITY;
  OK(abbe_screen_png_write(path, &image, &desc, &error));
  assert_true(notes.stops == 0 && notes.white == 1);
  unlink(path);
}

TEST(layers_and_greys) {
  static const char *const names[] = {"B", "caustic.B", "caustic.G", "caustic.R", "G", "R"};
  static const float value[] = {0.1f, 0.3f, 0.2f, 0.5f, 0.4f, 0.6f};
  static const char *const rgb[] = {"R", "G", "B"}, *const y[] = {"Y"};
  float want[3], got[3];
  show(rgb, 3, (const float[]){0.6f, 0.4f, 0.1f}, NULL, NULL, NULL, want);
  show(names, 6, value, NULL, NULL, NULL, got);
  assert_memory_equal(got, want, sizeof want);
  show(rgb, 3, (const float[]){0.5f, 0.2f, 0.3f}, NULL, NULL, NULL, want);
  show(names, 6, value, NULL, NULL, "caustic", got);
  assert_memory_equal(got, want, sizeof want);
  show(y, 1, value, NULL, NULL, NULL, got);
  assert_near((double)got[0], (double)got[2], 2e-4);
}

/* Half of a pixel is covered by a grey of 0.6: the file has the grey, and half. */
TEST(alpha_is_straight) {
  static const char *const channels[] = {"R", "G", "B", "A"};
  static const float pixels[] = {0.3f, 0.3f, 0.3f, 0.5f, 0, 0, 0, 0}, whole[] = {0.6f, 0.6f, 0.6f};
  const abbe_screen_png_desc desc = {.display = {.view = "Plain"}, .alpha = true, .bits = 8};
  float shown[3];
  FREED unsigned char *data = NULL;
  size_t size;
  MADE(abbe_image, image, abbe_image_make(2, 1, 4, channels, &image, &error));
  memcpy(image.data, pixels, sizeof pixels);
  abbe_image_set_attribute(&image, "abbe:space", "rec709", NULL);
  OK(abbe_screen_png_write(path, &image, &desc, &error));
  OK(abbe_file_read(path, 1 << 16, (char **)&data, &size, &error));
  assert_int_equal(data[25], 6); /* IHDR's colour type: RGB and alpha */
  png_image png = {.version = PNG_IMAGE_VERSION};
  unsigned char rgba[8];
  assert_true(png_image_begin_read_from_file(&png, path));
  png.format = PNG_FORMAT_RGBA;
  assert_true(png_image_finish_read(&png, NULL, rgba, 0, NULL));
  show(channels, 3, whole, "rec709", NULL, NULL, shown);
  assert_int_equal(rgba[3], 128);
  for (int k = 0; k < 3; k++) {
    assert_near(rgba[k] / 255.0, (double)shown[k], 0.5 / 255 + 1e-6);
    assert_int_equal(rgba[4 + k], 0);
  }
  assert_int_equal(rgba[7], 0);
}

/* What is not covered is not black: a quarter of the picture of a light of 3.2 is as all of it. */
TEST(stops_are_those_of_what_is_covered) {
  static const char *const channels[] = {"R", "G", "B", "A"};
  MADE(abbe_image, image, abbe_image_make(40, 1, 4, channels, &image, &error));
  abbe_image_set_attribute(&image, "abbe:space", "rec709", NULL);
  for (size_t i = 0; i < 4 * 3; i++) image.data[i] = i % 4 == 3 ? 0.5f : 1.6f;
  for (int alpha = 0; alpha < 2; alpha++) {
    const abbe_screen_png_desc desc = {.bits = 8, .notes = &notes, .alpha = alpha == 1};
    OK(abbe_screen_png_write(path, &image, &desc, &error));
    assert_near(notes.stops, alpha ? -2 : 0, 1e-6);
  }
  unlink(path);
}

TEST(what_cannot_be_shown_is_refused) {
  static const char *const names[] = {"U", "V", "R"}, *const rgb[] = {"R", "G", "B"};
  const abbe_screen_png_desc desc = {.name = "it.exr"};
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, names, &image, &error));
  REFUSED(ABBE_NOT_FOUND, "it.exr: it has no channels R, G, B",
          abbe_screen_png_write(path, &image, &desc, &error));
  assert_contains(last_error.text, "it has: U, V, R");
  abbe_image_free(&image);
  OK(abbe_image_make(1, 1, 3, rgb, &image, &error));
  const double line[] = {0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.3, 0.3};
  memcpy(image.xy, line, sizeof image.xy);
  REFUSED(ABBE_INVALID_ARGUMENT, "it.exr: ", abbe_screen_png_write(path, &image, &desc, &error));
  abbe_image_set_attribute(&image, "abbe:space", "p3", NULL);
  REFUSED(ABBE_COLOUR, "abbe:space is 'p3'", abbe_screen_png_write(path, &image, &desc, &error));
  assert_int_equal(access(path, F_OK), -1);
}
