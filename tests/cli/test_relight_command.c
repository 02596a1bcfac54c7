/* The subcommands relight and display on spectral pictures, as a person runs them. */
#include "tests/cli/run_output.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/weights.h"

static char lamp[] = "relight_lamp.exr", chart[] = "relight_chart.exr";
static char exr[] = "relight_out.exr", png[] = "relight_out.png";

enum { BANDS = 40 };

/* The light of one watt of D65 in bands, and a reflectance of one half. */
static void write_spectral(const char *path, const char *prefix, bool emissive) {
  const abbe_illuminant d65 = {0};
  char name[BANDS][40];
  const char *names[BANDS];
  for (int i = 0; i < BANDS; i++) {
    snprintf(name[i], sizeof name[i], "%s%d,000000nm", prefix, 385 + 10 * i);
    names[i] = name[i];
  }
  MADE(abbe_image, image, abbe_image_make(2, 2, BANDS, names, &image, &error));
  for (size_t i = 0; i < 4 * BANDS; i++) {
    const double from = 380 + 10 * (double)(i % BANDS);
    image.data[i] =
        emissive ? (float)(abbe_weights_band_power(&d65, 380, 780, from, from + 10) / 10) : 0.5f;
  }
  OK(abbe_exr_write(path, &image, &error));
}

static void make_pictures(void) {
  write_spectral(lamp, "S0.", true);
  write_spectral(chart, "T.", false);
}

static void remove_pictures(void) {
  const char *const paths[] = {lamp, chart, exr, png};
  for (int i = 0; i < 4; i++) remove(paths[i]);
}

/* The white of A [CIE15], by the sum of X, Y and Z. */
static void expect_a(double y) {
  MADE(abbe_image, image, abbe_exr_read(exr, &image, &error));
  assert_int_equal(image.channels, 3);
  double xyz[3];
  for (int k = 0; k < 3; k++) xyz[k] = (double)image.data[k];
  const double sum = xyz[0] + xyz[1] + xyz[2];
  assert_near(xyz[0] / sum, 0.44757, 2e-4);
  assert_near(xyz[1] / sum, 0.40745, 2e-4);
  assert_near(xyz[1], y, 1e-4);
}

GROUP(make_pictures, remove_pictures);

TEST(relight) {
  assert_int_equal(run("relight relight_lamp.exr --lit-by D65 --illuminant A --space xyz -o "
                       "relight_out.exr --png relight_out.png"),
                   0);
  assert_contains(output, "CIE 1931, 2 degrees; 1 is radiance, W/(m2 sr)");
  expect_a(1);
  assert_int_equal(run("relight relight_chart.exr --illuminant A --space xyz -o relight_out.exr"),
                   0);
  expect_a(0.5);
  assert_int_equal(run("relight relight_lamp.exr --illuminant A -o relight_out.exr"), 1);
  assert_contains(output, "which light it was made with");
  assert_int_equal(run("relight relight_lamp.exr"), 2);
  assert_int_equal(run("relight relight_lamp.exr -o relight_out.exr --observer 1954"), 2);
  assert_contains(output, "1964");
}

TEST(display) {
  assert_int_equal(run("display relight_chart.exr -o relight_out.png"), 0);
  assert_contains(output, "the colour of the spectrum, CIE 1931, 2 degrees");
  assert_int_equal(run("display relight_chart.exr -o relight_out.png --observer 2015-10"), 0);
  assert_contains(output, "CIE 2015, 10 degrees");
  assert_int_equal(run("display relight_lamp.exr -o relight_out.png --layer 550nm"), 0);
  assert_int_equal(run("display relight_lamp.exr -o relight_out.png --layer 550nm --bits 16"), 1);
  assert_contains(output, "false colours, without --bits");
  assert_int_equal(run("display relight_lamp.exr -o relight_out.png --layer 950nm"), 1);
}
