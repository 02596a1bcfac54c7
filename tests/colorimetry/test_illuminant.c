#include "tests/check.h"
#include "tests/colorimetry/colord.h"

#include "base/file.h"
#include "colorimetry/colour_temperature.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "colorimetry/weights.h"

#include <unistd.h>

static abbe_illuminant make(const char *name) {
  abbe_illuminant light = {0};
  OK(abbe_illuminant_make(name, &light, &error));
  return light;
}

/* colord normalises by the power at 560 nm and rounds to the digits it prints. */
static void compare(const char *name, const char *file, double tolerance) {
  static double cie[600];
  double start = 0, end = 0;
  size_t count = colord_read(file, cie, 600, &start, &end);
  OWNED(abbe_illuminant, light) = make(name);
  for (size_t i = 0; i < count; i++) {
    double nm = start + (end - start) * (double)i / (double)(count - 1);
    double ours = abbe_illuminant_power(&light, nm) / 100;
    if (fabs(ours - cie[i]) > tolerance) fail_msg("%s at %g nm: %g, %g", name, nm, ours, cie[i]);
  }
}

TEST(d65_is_the_cies) {
  compare("D65", "illuminant/CIE-D65.sp", 1e-12);
}

/* colord keeps three decimals, some of them means of rounded neighbours */
TEST(d50_is_the_cies) {
  compare("D50", "illuminant/CIE-D50.sp", 1.01e-3);
}

TEST(a_is_the_cies) {
  compare("A", "illuminant/CIE-A.sp", 1e-5);
}

TEST(e_is_flat) {
  compare("E", "illuminant/CIE-E.sp", 0);
}

TEST(interpolation_and_ends) {
  abbe_illuminant light = {0};
  assert_string_equal(abbe_illuminant_name(&light), "D65");
  assert_true(fabs(abbe_illuminant_power(&light, 302.5) - (0.0341 + 1.6643) / 2) < 1e-14);
  assert_true(abbe_illuminant_power(&light, 830) == 60.3125);
  static const double outside[] = {-5, 0, 299.9, 830.1, INFINITY, NAN};
  for (int i = 0; i < 6; i++) assert_true(abbe_illuminant_power(&light, outside[i]) == 0);
  abbe_illuminant a = make("a");
  assert_true(fabs(abbe_illuminant_power(&a, 560) - 100) < 1e-12);
  assert_true(abbe_illuminant_power(&a, 1e-3) >= 0 && abbe_illuminant_power(&a, 0) == 0);
}

static char *write_text(const char *text) {
  static char path[128];
  snprintf(path, sizeof path, "/tmp/abbe_test_illuminant_%ld.txt", (long)getpid());
  OK(abbe_file_write(path, text, strlen(text), &error));
  return path;
}

TEST(a_file_of_ones_own) {
  char *path = write_text("# a lamp\n400, 0\r\n\n 500;10 # middle\n600\t20");
  OWNED(abbe_illuminant, light) = make(path);
  assert_int_equal(light.kind, ABBE_ILLUMINANT_TABULATED);
  assert_true(fabs(abbe_illuminant_power(&light, 550) - 15) < 1e-12);
  assert_true(abbe_illuminant_power(&light, 399) == 0);
  assert_true(abbe_illuminant_power(&light, 601) == 0);
  abbe_illuminant_free(&light);
  unlink(path);
}

/* A spreadsheet's and a spectrometer's: what the reader of measured points takes, a light takes. */
TEST(files_in_other_dresses) {
  static const char *const dresses[] = {
      "\xef\xbb\xbf"
      "400 0\r\n500 10\r\n600 20\r\n",
      "wavelength_nm,power\n400,0\n500,10\n600,20\n",
      "Wellenlaenge [um];W/(m2 nm)\n0,4;0\n0,5;10,0\n0,6;20,0\n",
      "nm\tcounts\n600\t20\n500\t10\n400\t0\n",
  };
  for (size_t i = 0; i < sizeof dresses / sizeof dresses[0]; i++) {
    char *path = write_text(dresses[i]);
    OWNED(abbe_illuminant, light) = make(path);
    assert_true(fabs(abbe_illuminant_power(&light, 550) - 15) < 1e-12);
    assert_true(abbe_illuminant_power(&light, 399) == 0);
    unlink(path);
  }
}

TEST(bad_files) {
  static const struct {
    const char *text, *says;
    abbe_result result;
  } bad[] = {
      {"", "holds no points", ABBE_SCHEMA},     {"500 1\n", "at least two rows", ABBE_SCHEMA},
      {"400 0\n500 0\n", "all 0", ABBE_SCHEMA}, {"400 1\n400 2\n", ":2:", ABBE_SCHEMA},
      {"500 1\n400 -2\n", ":2:", ABBE_SCHEMA},  {"400 1\n500 -2\n", "-2", ABBE_SCHEMA},
      {"400 nan\n500 1\n", ":1:", ABBE_PARSE},  {"400 1\n500 1e999\n", ":2:", ABBE_PARSE},
      {"-400 1\n500 1\n", ":1:", ABBE_SCHEMA},  {"nm,power\n400,1\n", "two rows", ABBE_SCHEMA},
      {"400 1 2\n500 1\n", ":1:", ABBE_PARSE},  {"400\n500 1\n", ":1:", ABBE_PARSE},
      {"400,,1\n500 1\n", ":1:", ABBE_PARSE}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    char *path = write_text(bad[i].text);
    abbe_illuminant light = {0};
    abbe_error error = {0};
    abbe_result result = abbe_illuminant_make(path, &light, &error);
    if (result != bad[i].result || strstr(error.text, bad[i].says) == NULL ||
        strstr(error.text, path) == NULL || light.spectrum != NULL)
      fail_msg("case %zu: %d, %s", i, (int)result, error.text);
    unlink(path);
  }
}

TEST(unknown_names) {
  abbe_illuminant light = {0};
  abbe_error error = {0};
  assert_int_equal(abbe_illuminant_make("LED-B9", &light, &error), ABBE_NOT_FOUND);
  assert_non_null(strstr(error.text, "did you mean 'LED-B"));
  static const struct {
    const char *name;
    abbe_result result;
  } bad[] = {{"D39", ABBE_INVALID_ARGUMENT},
             {"D3999", ABBE_INVALID_ARGUMENT},
             {"D25001", ABBE_INVALID_ARGUMENT},
             {"999K", ABBE_INVALID_ARGUMENT},
             {"1000001K", ABBE_INVALID_ARGUMENT},
             {"0K", ABBE_NOT_FOUND},
             {"D", ABBE_NOT_FOUND},
             {"D5", ABBE_NOT_FOUND},
             {"D123456", ABBE_NOT_FOUND},
             {"K", ABBE_NOT_FOUND},
             {"-3000K", ABBE_NOT_FOUND},
             {"D-55", ABBE_NOT_FOUND},
             {"F13", ABBE_NOT_FOUND},
             {"F0", ABBE_NOT_FOUND},
             {"", ABBE_NOT_FOUND}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    const abbe_result result = abbe_illuminant_make(bad[i].name, &light, &error);
    if (result != bad[i].result || light.spectrum != NULL)
      fail_msg("'%s': %d, %s", bad[i].name, (int)result, error.text);
    assert_int_equal(abbe_illuminant_is_name(bad[i].name), result == ABBE_INVALID_ARGUMENT);
  }
  assert_false(abbe_illuminant_is_name(NULL));
  assert_int_equal(abbe_illuminant_make("/no/such/lamp.csv", &light, &error), ABBE_IO);
  assert_non_null(strstr(error.text, "/no/such/lamp.csv"));
  assert_int_equal(abbe_illuminant_make("/tmp", &light, &error), ABBE_IO);
}

/* x, y as [CIE15] prints them: to four or five places, from sums over its 5 nm tables; of
 * C from one that goes on beyond 780 nm. */
static const struct {
  const char *name;
  double x, y, half; /* half of the last place, and rounding */
} published[] = {{"C", 0.31006, 0.31616, 1.1e-5},     {"F1", 0.3131, 0.3371, 5.1e-5},
                 {"F2", 0.3721, 0.3751, 5.1e-5},      {"F3", 0.4091, 0.3941, 5.1e-5},
                 {"F4", 0.4402, 0.4031, 5.1e-5},      {"F5", 0.3138, 0.3452, 5.1e-5},
                 {"F6", 0.3779, 0.3882, 5.1e-5},      {"F7", 0.3129, 0.3292, 5.1e-5},
                 {"F8", 0.3458, 0.3586, 5.1e-5},      {"F9", 0.3741, 0.3727, 5.1e-5},
                 {"F10", 0.3458, 0.3588, 5.1e-5},     {"F11", 0.3805, 0.3769, 5.1e-5},
                 {"F12", 0.4370, 0.4042, 5.1e-5},     {"LED-B1", 0.4560, 0.4078, 5.1e-5},
                 {"LED-B2", 0.4357, 0.4012, 5.1e-5},  {"LED-B3", 0.3756, 0.3723, 5.1e-5},
                 {"LED-B4", 0.3422, 0.3502, 5.1e-5},  {"LED-B5", 0.3118, 0.3236, 5.1e-5},
                 {"LED-BH1", 0.4474, 0.4066, 5.1e-5}, {"LED-RGB1", 0.4557, 0.4211, 5.1e-5},
                 {"LED-V1", 0.4548, 0.4044, 5.1e-5},  {"LED-V2", 0.3781, 0.3775, 5.1e-5}};

static void colour_by_sums(const abbe_illuminant *light, double xy[2]) {
  double sum[3] = {0};
  for (double nm = 360; nm <= 830; nm += 5) {
    double xyz[3];
    abbe_observer_xyz(nm, xyz);
    for (int k = 0; k < 3; k++) sum[k] += xyz[k] * abbe_illuminant_power(light, nm);
  }
  for (int k = 0; k < 2; k++) xy[k] = sum[k] / (sum[0] + sum[1] + sum[2]);
}

/* And the whole integral, in which lamps' lines are triangles, is near. */
TEST(published_colours) {
  for (size_t i = 0; i < sizeof published / sizeof *published; i++) {
    OWNED(abbe_illuminant, light) = make(published[i].name);
    assert_string_equal(abbe_illuminant_name(&light), published[i].name);
    double xy[2], xyz[3];
    colour_by_sums(&light, xy);
    if (fabs(xy[0] - published[i].x) > published[i].half ||
        fabs(xy[1] - published[i].y) > published[i].half)
      fail_msg("%s: %.6f, %.6f", published[i].name, xy[0], xy[1]);
    abbe_weights_band_xyz(&light, 360, 830, 360, 830, xyz);
    assert_near(xyz[0] / (xyz[0] + xyz[1] + xyz[2]), published[i].x, 4e-4);
    assert_near(xyz[1] / (xyz[0] + xyz[1] + xyz[2]), published[i].y, 4e-4);
  }
}

/* Daylight by temperature: D65's and D50's own tables, to the places of the components, and the
 * colours that [CIE15] prints of D55 and D75. */
TEST(daylight_of_a_temperature) {
  static const struct {
    const char *series, *table;
    double off;
  } same[] = {{"D6504", "D65", 0.05}, {"D5003", "D50", 0.05}};
  for (size_t i = 0; i < 2; i++) {
    OWNED(abbe_illuminant, one) = make(same[i].series);
    abbe_illuminant other = make(same[i].table);
    for (double nm = 300; nm <= 830; nm += 10)
      assert_near(abbe_illuminant_power(&one, nm), abbe_illuminant_power(&other, nm), same[i].off);
  }
  OWNED(abbe_illuminant, d55) = make("d55"), d75 = make("D75"), whole = make("D7504");
  double xy[2];
  colour_by_sums(&d55, xy);
  assert_near(xy[0], 0.33242, 2e-5);
  assert_near(xy[1], 0.34743, 2e-5);
  colour_by_sums(&d75, xy);
  assert_near(xy[0], 0.29902, 2e-5);
  assert_near(xy[1], 0.31485, 2e-5);
  assert_string_equal(abbe_illuminant_name(&d55), "D55");
  assert_near(abbe_illuminant_power(&d75, 400), abbe_illuminant_power(&whole, 400), 0.01);
}

/* A is a black body of 2848 K by the c2 of its time: 2855.5 K by today's. */
TEST(black_bodies) {
  OWNED(abbe_illuminant, body) = make("2856k");
  abbe_illuminant a = make("A");
  OWNED(abbe_illuminant, cold) = make("1000K"), hot = make("1000000K");
  for (double nm = 380; nm <= 780; nm += 5)
    assert_near(abbe_illuminant_power(&body, nm) / abbe_illuminant_power(&a, nm), 1, 1e-3);
  for (double nm = 360.25; nm < 829; nm += 0.5) {
    assert_near(abbe_illuminant_power(&cold, nm) / abbe_colour_temperature_planck(1000, nm), 1,
                1e-4);
    assert_near(abbe_illuminant_power(&hot, nm) / abbe_colour_temperature_planck(1e6, nm), 1, 1e-6);
  }
  assert_string_equal(abbe_illuminant_name(&body), "2856K");
}

/* All of a line is in its band, wherever the bands' edges are, at the colour of its wavelength. */
TEST(lines_are_exact_and_not_binned) {
  static const struct {
    const char *name;
    size_t lines;
    double first_nm, last_nm;
  } lamps[] = {{"sodium", 2, 588.9950, 589.5924},  {"Mercury", 6, 404.6563, 579.0663},
               {"hydrogen", 5, 410.174, 656.2852}, {"632.8nm", 1, 632.8, 632.8},
               {"line-d", 1, 587.5618, 587.5618},  {"line-F'", 1, 479.9914, 479.9914}};
  for (size_t i = 0; i < sizeof lamps / sizeof *lamps; i++) {
    OWNED(abbe_illuminant, light) = make(lamps[i].name);
    double nm[ABBE_ILLUMINANT_MOST_LINES], xyz[3], bar[3];
    assert_int_equal(abbe_illuminant_lines(&light, nm), lamps[i].lines);
    assert_near(nm[0], lamps[i].first_nm, 0);
    assert_near(nm[lamps[i].lines - 1], lamps[i].last_nm, 0);
    assert_string_equal(abbe_illuminant_name(&light), lamps[i].name);
    if (lamps[i].lines == 1) {
      abbe_weights_band_xyz(&light, 380, 780, 380, 780, xyz);
      abbe_observer_xyz(nm[0], bar);
      for (int k = 0; k < 3; k++) assert_near(xyz[k], bar[k] / bar[1], 1e-6);
    }
  }
  OWNED(abbe_illuminant, sodium) = make("sodium");
  abbe_illuminant d65 = {0}, bad = {0};
  double nm[ABBE_ILLUMINANT_MOST_LINES];
  assert_int_equal(abbe_illuminant_lines(&d65, nm), 0);
  assert_near(abbe_weights_band_power(&sodium, 380, 780, 589, 589.1), 0, 0);
  assert_near(abbe_weights_band_power(&sodium, 380, 780, 588.99, 589), 2.0 / 3, 1e-9);
  assert_near(abbe_weights_band_power(&sodium, 380, 780, 589.59, 780), 1.0 / 3, 1e-9);
  REFUSED(ABBE_INVALID_ARGUMENT, "a line lies from 360 to 830 nm",
          abbe_illuminant_make("1064nm", &bad, &error));
  REFUSED(ABBE_NOT_FOUND, "did you mean 'sodium'?", abbe_illuminant_make("sodum", &bad, &error));
  REFUSED(ABBE_NOT_FOUND, "neither", abbe_illuminant_make("line-x", &bad, &error));
}

TEST(every_listed_name_is_a_light) {
  size_t count = 0;
  for (const char *name; (name = abbe_illuminant_listed(count)) != NULL; count++) {
    OWNED(abbe_illuminant, light) = make(name);
    assert_true(abbe_illuminant_is_name(name));
    double nm[ABBE_ILLUMINANT_MOST_LINES];
    const size_t lines = abbe_illuminant_lines(&light, nm);
    assert_true(abbe_illuminant_power(&light, lines > 0 ? nm[0] : 550) > 0);
  }
  assert_int_equal(count, 29);
  OWNED(abbe_illuminant, f11) = make("fl11"), same = make("F11");
  assert_near(abbe_illuminant_power(&f11, 545), abbe_illuminant_power(&same, 545), 0);
}
