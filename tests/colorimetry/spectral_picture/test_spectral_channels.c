#include "tests/check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/observer_integral.h"
#include "colorimetry/spectral_picture/spectral_channels.h"
#include "colorimetry/weights.h"

/* Names as [Fichet2021] writes them, and names that are none. */
TEST(names) {
  static const struct {
    const char *name;
    abbe_spectral_kind kind;
    double nm;
  } names[] = {{"S0.550,000000nm", ABBE_SPECTRAL_EMISSIVE, 550},
               {"S0.550nm", ABBE_SPECTRAL_EMISSIVE, 550},
               {"T.380,5nm", ABBE_SPECTRAL_REFLECTIVE, 380.5},
               {"T.0,55um", ABBE_SPECTRAL_REFLECTIVE, 550},
               {"M00.400,000000nm", ABBE_SPECTRAL_REFLECTIVE, 400},
               {"M01.400nm", ABBE_SPECTRAL_NONE, 0},
               {"S0.5,5E-7m", ABBE_SPECTRAL_EMISSIVE, 550},
               {"S0.5,45E14Hz", ABBE_SPECTRAL_EMISSIVE, 550.0779},
               {"S0.545THz", ABBE_SPECTRAL_EMISSIVE, 550.0779},
               {"S1.550nm", ABBE_SPECTRAL_NONE, 0},
               {"S0.550", ABBE_SPECTRAL_NONE, 0},
               {"S0.,nm", ABBE_SPECTRAL_NONE, 0},
               {"S0.5,5,0nm", ABBE_SPECTRAL_NONE, 0},
               {"S0.0nm", ABBE_SPECTRAL_NONE, 0},
               {"S0.-550nm", ABBE_SPECTRAL_NONE, 0},
               {"T.550nm.600nm", ABBE_SPECTRAL_NONE, 0},
               {"T.550xm", ABBE_SPECTRAL_NONE, 0},
               {"R", ABBE_SPECTRAL_NONE, 0},
               {"", ABBE_SPECTRAL_NONE, 0}};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    double nm = 0;
    const abbe_spectral_kind kind = abbe_spectral_channel_parse(names[i].name, &nm);
    if (kind != names[i].kind) fail_msg("'%s' is of kind %d", names[i].name, (int)kind);
    assert_near(nm, names[i].nm, 1e-4);
  }
}

static void make(const char *const *names, size_t count, abbe_image *out) {
  OK(abbe_image_make(1, 1, count, names, out, &error));
}

TEST(bands_meet_midway) {
  static const char *const names[] = {"S0.600nm", "R", "stderr.S0.500nm", "S0.500nm", "S0.520nm"};
  abbe_spectral_channels c;
  FILLED(abbe_image, image, make(names, 5, &image));
  OK(abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  assert_int_equal(c.kind, ABBE_SPECTRAL_EMISSIVE);
  assert_int_equal(c.count, 3);
  static const double edge[4] = {490, 510, 560, 640}, nm[3] = {500, 520, 600};
  static const size_t channel[3] = {3, 4, 0}, of_error[3] = {2, (size_t)-1, (size_t)-1};
  for (int i = 0; i < 4; i++) assert_near(c.edge_nm[i], edge[i], 1e-12);
  for (int i = 0; i < 3; i++) {
    assert_near(c.lambda_nm[i], nm[i], 1e-12);
    assert_int_equal(c.channel[i], channel[i]);
    assert_true(c.error[i] == of_error[i]);
  }
  abbe_spectral_channels_free(&c);
  assert_int_equal(c.count, 0);
}

TEST(layers_and_reflectances) {
  static const char *const names[] = {"left.T.500nm", "left.T.600nm", "T.400nm"};
  abbe_spectral_channels c;
  FILLED(abbe_image, image, make(names, 3, &image));
  OK(abbe_spectral_channels_find(&image, "left", "it", &c, &error));
  assert_int_equal(c.kind, ABBE_SPECTRAL_REFLECTIVE);
  assert_int_equal(c.count, 2);
  abbe_spectral_channels_free(&c);
  /* a lone one has no width */
  OK(abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  assert_true(c.count == 1 && c.edge_nm[0] == 400 && c.edge_nm[1] == 400);
  abbe_spectral_channels_free(&c);
  OK(abbe_spectral_channels_find(&image, "right", "it", &c, &error));
  assert_true(c.count == 0 && c.kind == ABBE_SPECTRAL_NONE);
}

TEST(four_units_in_any_order) {
  static const char *const names[] = {"S0.0,6um", "S0.500nm", "S0.5,45E14Hz", "S0.4E-7m",
                                      "S0.700nm"};
  static const double nm[] = {400, 500, 299792458e9 / 5.45e14, 600, 700};
  FILLED(abbe_image, image, make(names, 5, &image));
  MADE(abbe_spectral_channels, c, abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  assert_int_equal(c.count, 5);
  for (int i = 0; i < 5; i++) assert_near(c.lambda_nm[i], nm[i], 1e-9);
}

TEST(twice_the_same) {
  static const char *const names[] = {"S0.500nm", "S0.0,5um"};
  abbe_spectral_channels c;
  FILLED(abbe_image, image, make(names, 2, &image));
  REFUSED(ABBE_INVALID_ARGUMENT, "it.exr",
          abbe_spectral_channels_find(&image, NULL, "it.exr", &c, &error));
  assert_contains(last_error.text, "one wavelength");
}

TEST(what_is_not_read) {
  static const char *const names[] = {
      "S0.500nm", "S0.600nm", "S1.500nm", "S3.600nm",   "T.400nm.500nm", "T.500nm",
      "w420nm",   "w720nm",   "R",        "a.S2.500nm", "S4.500nm",      "T.x.500nm",
      "nm",       "m",        "1",        "S0.nannm",   "S0.-500nm",     "S0.0nm"};
  abbe_spectral_unread unread;
  FILLED(abbe_image, image, make(names, 18, &image));
  abbe_spectral_channels_find_unread(&image, NULL, &unread);
  static const size_t count[ABBE_SPECTRAL_UNREAD_COUNT] = {2, 1, 2, 4};
  static const char *const first[] = {"S1.500nm", "T.400nm.500nm", "w420nm", "T.x.500nm"};
  for (int k = 0; k < ABBE_SPECTRAL_UNREAD_COUNT; k++) {
    assert_int_equal(unread.count[k], count[k]);
    assert_string_equal(unread.first[k], first[k]);
  }
  abbe_spectral_channels_find_unread(&image, "a", &unread);
  assert_int_equal(unread.count[ABBE_SPECTRAL_UNREAD_POLARISED], 1);
}

TEST(the_unit) {
  static const char *const names[] = {"S0.500nm", "S0.600nm"};
  abbe_spectral_channels c;
  FILLED(abbe_image, image, make(names, 2, &image));
  OK(abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  assert_true(c.unit.factor == 1 && c.unit.quantity == ABBE_SPECTRAL_RADIANCE);
  abbe_spectral_channels_free(&c);
  abbe_image_set_attribute(&image, "emissiveUnits", "mW.m^-2", NULL);
  OK(abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  assert_near(c.unit.factor, 1e-3, 1e-18);
  assert_int_equal(c.unit.quantity, ABBE_SPECTRAL_IRRADIANCE);
  abbe_spectral_channels_free(&c);
  abbe_image_set_attribute(&image, "emissiveUnits", "photons", NULL);
  REFUSED(ABBE_UNSUPPORTED, "it: its emissiveUnits are 'photons'",
          abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
}

enum { BANDS = 40 };

/* Bands of 10 nm over 380 to 780 nm, of the kind that the prefix says. */
static void spectral_colour_make(const char *prefix, abbe_image *image, abbe_spectral_channels *c) {
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
  FILLED(abbe_image, image, spectral_colour_make("T.", &image, &c));
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
  FILLED(abbe_image, image, spectral_colour_make("S0.", &image, &c));
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

/* Half of the light around 405 nm comes back around 605: under even light that is a reflectance of
 * a half there, under D65 less by both bands' light, and of a line elsewhere nothing. */
TEST(re_radiation) {
  enum { IN = 2, OUT = 22 };
  const abbe_illuminant e = {.kind = ABBE_ILLUMINANT_E}, d65 = {0};
  char name[BANDS + 2][40];
  const char *names[BANDS + 2];
  for (int i = 0; i < BANDS + 2; i++) {
    snprintf(name[i], sizeof name[i], "T.%dnm%s", i < BANDS ? 385 + 10 * i : 405,
             i < BANDS    ? ""
             : i == BANDS ? ".605nm"
                          : ".606nm");
    names[i] = name[i];
  }
  MADE(abbe_image, image, abbe_image_make(1, 1, BANDS + 2, names, &image, &error));
  MADE(abbe_spectral_channels, c, abbe_spectral_channels_find(&image, NULL, "it", &c, &error));
  assert_true(c.count == BANDS && c.terms == BANDS + 1 && c.channel[BANDS] == BANDS);
  assert_true(c.between[0][0] == IN && c.between[0][1] == OUT);
  abbe_spectral_unread unread; /* to a wavelength that is no band */
  abbe_spectral_channels_find_unread(&image, NULL, &unread);
  assert_int_equal(unread.count[ABBE_SPECTRAL_UNREAD_RERADIATION], 1);
  assert_string_equal(unread.first[ABBE_SPECTRAL_UNREAD_RERADIATION], "T.405nm.606nm");
  double weight[BANDS + 1][3], white[3];
  OK(abbe_spectral_colour_weights(&c, &(abbe_spectral_view){.to = &e}, "it", weight, &error));
  for (int k = 0; k < 3; k++) assert_near(weight[BANDS][k], weight[OUT][k], 1e-12);
  const double even = weight[OUT][1];
  abbe_observer_integral(&e, 380, 780, white);
  const double even_white = white[1];
  OK(abbe_spectral_colour_weights(&c, &(abbe_spectral_view){.to = &d65}, "it", weight, &error));
  abbe_observer_integral(&d65, 380, 780, white);
  const double mean = abbe_observer_integral_power(&d65, 400, 410) / 10;
  assert_near(weight[BANDS][1], even * even_white / 100 * mean / white[1], 1e-12);
  abbe_image_free(&image);
  snprintf(name[BANDS + 1], sizeof *name, "M00.0,405um.605nm");
  OK(abbe_image_make(1, 1, BANDS + 2, names, &image, &error));
  abbe_spectral_channels twice;
  REFUSED(ABBE_INVALID_ARGUMENT, "are of one pair of wavelengths",
          abbe_spectral_channels_find(&image, NULL, "it", &twice, &error));
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
  spectral_colour_make("S0.", &image, &c);
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

TEST(units_are_read) {
  static const struct {
    const char *text;
    abbe_spectral_quantity quantity;
    double factor;
  } cases[] = {{NULL, ABBE_SPECTRAL_RADIANCE, 1},
               {"W.m^-2.sr^-1", ABBE_SPECTRAL_RADIANCE, 1},
               {"W.m^-2.sr^-1.nm^-1", ABBE_SPECTRAL_RADIANCE, 1},
               {"mW.m^-2.sr^-1.nm^-1", ABBE_SPECTRAL_RADIANCE, 1e-3},
               {"uW.cm^-2.sr^-1.nm^-1", ABBE_SPECTRAL_RADIANCE, 1e-2},
               {"W.m^-2.sr^-1.um^-1", ABBE_SPECTRAL_RADIANCE, 1e-3},
               {"W.m^-3.sr^-1", ABBE_SPECTRAL_RADIANCE, 1e-9},
               {"kW m-2 sr-1", ABBE_SPECTRAL_RADIANCE, 1e3},
               {"W/m^2/sr/nm", ABBE_SPECTRAL_RADIANCE, 1},
               {"W.m^-2", ABBE_SPECTRAL_IRRADIANCE, 1},
               {"mW.m^-2.nm^-1", ABBE_SPECTRAL_IRRADIANCE, 1e-3},
               {"W.nm^-1", ABBE_SPECTRAL_FLUX, 1},
               {"W.sr^-1", ABBE_SPECTRAL_INTENSITY, 1}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_spectral_unit unit;
    OK(abbe_spectral_unit_read(cases[i].text, "a.exr", &unit, &error));
    assert_int_equal(unit.quantity, cases[i].quantity);
    assert_near(unit.factor / cases[i].factor, 1, 1e-14);
  }
}

TEST(what_is_no_unit_of_light_is_refused) {
  static const char *const wrong[] = {"",           "photons.m^-2",
                                      "m^-2.sr^-1", "W^2.m^-2",
                                      "W.m^2",      "W.m^-2.sr^-2",
                                      "lm.m^-2",    "W.m^-2.Hz^-1",
                                      "W.m^-",      "W.m^",
                                      "xW.m^-2",    "W m^-2 (sr)",
                                      "J.s^-1",     "W.Ym^9.m^-9.Ym^9.m^-9.m^-2",
                                      "%",          "^2"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    abbe_spectral_unit unit;
    abbe_error error = {0};
    FREED char *text = strdup(wrong[i]); /* of which no byte before is to be read */
    if (abbe_spectral_unit_read(text, "a.exr", &unit, &error) != ABBE_UNSUPPORTED)
      fail_msg("'%s' is read", wrong[i]);
    assert_contains(error.text, "a.exr: its emissiveUnits are '");
  }
  assert_string_equal(abbe_spectral_quantity_text(ABBE_SPECTRAL_IRRADIANCE), "illuminance, lx");
}
