#include "tests/check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/spectral_picture/spectral_colour.h"
#include "colorimetry/weights.h"

enum { BANDS = 40 };

/* Bands of 10 nm over 380 to 780 nm, of the kind that the prefix says. */
static void make(const char *prefix, abbe_image *image, abbe_spectral_channels *c) {
  char name[BANDS][32];
  const char *names[BANDS];
  for (int i = 0; i < BANDS; i++) {
    snprintf(name[i], sizeof name[i], "%s%dnm", prefix, 385 + 10 * i);
    names[i] = name[i];
  }
  OK(abbe_image_make(2, 1, BANDS, names, image, &error));
  OK(abbe_spectral_channels_find(image, NULL, "it", c, &error));
  assert_int_equal(c->count, BANDS);
}

/* A perfect white is the illuminant's own colour: as [CIE15] prints them for 380 to 780 nm, for
 * both of its observers. */
TEST(whites_of_illuminants) {
  static const struct {
    abbe_observer observer;
    abbe_illuminant_kind kind;
    double xy[2];
  } white[] = {{ABBE_OBSERVER_CIE_1931, ABBE_ILLUMINANT_D65, {0.31272, 0.32903}},
               {ABBE_OBSERVER_CIE_1931, ABBE_ILLUMINANT_A, {0.44757, 0.40745}},
               {ABBE_OBSERVER_CIE_1931, ABBE_ILLUMINANT_D50, {0.34567, 0.35850}},
               {ABBE_OBSERVER_CIE_1964, ABBE_ILLUMINANT_D65, {0.31382, 0.33100}},
               {ABBE_OBSERVER_CIE_1964, ABBE_ILLUMINANT_A, {0.45117, 0.40594}},
               {ABBE_OBSERVER_CIE_1964, ABBE_ILLUMINANT_D50, {0.34773, 0.35952}}};
  OWNED(abbe_spectral_channels, c);
  FILLED(abbe_image, image, make("T.", &image, &c));
  for (size_t i = 0; i < sizeof white / sizeof *white; i++) {
    const abbe_illuminant light = {.kind = white[i].kind};
    const abbe_spectral_view view = {.observer = white[i].observer, .to = &light};
    double weight[BANDS][3], sum[3] = {0}, xy[2], own[3];
    OK(abbe_spectral_colour_weights(&c, &view, "it", weight, &error));
    for (int b = 0; b < BANDS; b++)
      for (int k = 0; k < 3; k++) sum[k] += weight[b][k];
    assert_near(sum[1], 1, 1e-12);
    abbe_spectral_colour_white(&c, &view, own);
    for (int k = 0; k < 3; k++) assert_near(sum[k], own[k], 1e-12);
    assert_true(abbe_chromaticity_xy(sum, xy));
    assert_near(xy[0], white[i].xy[0], 6e-5);
    assert_near(xy[1], white[i].xy[1], 6e-5);
  }
}

/* The light of a lamp of one watt in bands is its white with Y = 1; and every band's part is the
 * weight that a picture is made with. Under another illuminant it is that one's white. */
TEST(a_lamp_in_bands) {
  const abbe_illuminant d65 = {0}, a = {.kind = ABBE_ILLUMINANT_A};
  OWNED(abbe_spectral_channels, c);
  FILLED(abbe_image, image, make("S0.", &image, &c));
  const abbe_spectral_view as_it_is = {.from = &d65}, under_a = {.from = &d65, .to = &a};
  double weight[BANDS][3], other[BANDS][3], sum[3] = {0}, white[3];
  OK(abbe_spectral_colour_weights(&c, &as_it_is, "it", weight, &error));
  OK(abbe_spectral_colour_weights(&c, &under_a, "it", other, &error));
  for (int b = 0; b < BANDS; b++) {
    double expected[3];
    const double from = 380 + 10 * b,
                 power = abbe_weights_band_power(&d65, 380, 780, from, from + 10) / 10;
    abbe_weights_band_xyz(&d65, 380, 780, from, from + 10, expected);
    for (int k = 0; k < 3; k++) {
      assert_near(weight[b][k] * power, expected[k], 1e-12);
      sum[k] += other[b][k] * power;
    }
  }
  abbe_spectral_colour_white(&c, &under_a, white);
  for (int k = 0; k < 3; k++) assert_near(sum[k], white[k], 1e-12);
}

/* A radiance of 1 W/(m2 sr nm) in the band around 555 nm alone is 683 lm/W there. */
TEST(absolute_light) {
  static const char *const names[] = {"S0.554nm", "S0.555nm", "S0.556nm"};
  const abbe_spectral_view view = {0};
  double weight[3][3];
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, names, &image, &error));
  MADE(abbe_spectral_channels, c, abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  OK(abbe_spectral_colour_weights(&c, &view, "it", weight, &error));
  assert_near(weight[1][1], 683, 0.1);
}

TEST(refusals) {
  static const char *const infrared[] = {"T.900nm", "T.910nm"}, *const lone[] = {"S0.500nm"};
  const abbe_illuminant a = {.kind = ABBE_ILLUMINANT_A};
  const abbe_spectral_view view = {0}, under_a = {.to = &a};
  abbe_image image;
  abbe_spectral_channels c;
  double weight[BANDS][3];
  make("S0.", &image, &c);
  REFUSED(ABBE_INVALID_ARGUMENT, "which light it was made with",
          abbe_spectral_colour_weights(&c, &under_a, "it", weight, &error));
  abbe_spectral_channels_free(&c);
  abbe_image_free(&image);
  for (int i = 0; i < 2; i++) {
    OK(abbe_image_make(1, 1, 2 - (size_t)i, i ? lone : infrared, &image, &error));
    OK(abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
    REFUSED(ABBE_INVALID_ARGUMENT, i ? "two or more" : "no light that the eye sees",
            abbe_spectral_colour_weights(&c, &view, "it", weight, &error));
    abbe_spectral_channels_free(&c);
    abbe_image_free(&image);
  }
}
