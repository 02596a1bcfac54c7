#include "tests/check.h"

#include "colorimetry/spectral_picture/spectral_channels.h"

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
                                      "J.s^-1",     "W.Ym^9.m^-9.Ym^9.m^-9.m^-2"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    abbe_spectral_unit unit;
    abbe_error error = {0};
    if (abbe_spectral_unit_read(wrong[i], "a.exr", &unit, &error) != ABBE_UNSUPPORTED)
      fail_msg("'%s' is read", wrong[i]);
    assert_contains(error.text, "a.exr: its emissiveUnits are '");
  }
  assert_string_equal(abbe_spectral_quantity_text(ABBE_SPECTRAL_IRRADIANCE), "illuminance, lx");
}
