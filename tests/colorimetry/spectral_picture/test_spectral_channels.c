#include "tests/check.h"

#include "colorimetry/spectral_picture/spectral_channels.h"

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
      "S0.500nm", "S0.600nm",  "S1.500nm", "S3.600nm", "T.400nm.500nm",
      "T.500nm",  "w420nm",    "w720nm",   "R",        "a.S2.500nm",
      "S4.500nm", "T.x.500nm", "nm",       "m",        "1"};
  abbe_spectral_unread unread;
  FILLED(abbe_image, image, make(names, 15, &image));
  abbe_spectral_channels_find_unread(&image, NULL, &unread);
  static const size_t count[ABBE_SPECTRAL_UNREAD_COUNT] = {2, 1, 2};
  static const char *const first[] = {"S1.500nm", "T.400nm.500nm", "w420nm"};
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
