/* Pictures that are looked at: what is shown for a state, and what a region has. */
#include "tests/check.h"

#include "cli/view/inspect/inspect.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/screen/screen_file.h"
#include "tests/colorimetry/image/exr_library.h"

#include <unistd.h>

static const char path[] = "view_inspect.exr";
static abbe_display *display; /* Plain of sRGB: the encoding alone */

static void begin(void) {
  const abbe_display_desc desc = {.display = "sRGB", .view = "Plain", .source_space = "ACEScg"};
  OK(abbe_display_make(&desc, &display, &error));
}

static void end(void) {
  abbe_display_free(display);
  unlink(path);
}

GROUP(begin, end);

/* Writes a picture whose samples are given by pixel and channel, and opens it. */
static void open_picture(abbe_inspect *s, size_t width, size_t height, size_t channels,
                         const char *const *names, const float *data) {
  MADE(abbe_image, image, abbe_image_make(width, height, channels, names, &image, &error));
  memcpy(image.data, data, width * height * channels * sizeof *data);
  OK(abbe_exr_write(path, &image, &error));
  OK(abbe_inspect_open(s, path, &error));
}

static size_t entry_of(const abbe_inspect *s, const char *name) {
  const abbe_inspect_picture *p = &s->picture[s->at];
  for (size_t i = 0; i < p->count; i++)
    if (strcmp(p->name[i], name) == 0) return i;
  fail_msg("there is no entry '%s'", name);
  return 0;
}

static void show(abbe_inspect *s, size_t at, const char *name, abbe_inspect_look look) {
  look.entry = entry_of(s, name);
  look.display = display;
  OK(abbe_inspect_show(s, at, &look, &error));
}

static void probe(const abbe_inspect *s, const size_t w[4], abbe_inspect_probe *out) {
  OK(abbe_inspect_probe_make(s, s->at, w, out, &error));
}

/* A screen of so many pixels, each of the image `zoom` of them, the image's middle in its own. */
static void draw(abbe_inspect *s, size_t width, size_t height, double zoom, unsigned char *out) {
  bool whole = false;
  abbe_inspect_fit(s, width, height);
  s->zoom = zoom;
  while (!whole) OK(abbe_inspect_draw(s, width, height, 0, out, &whole, &error));
}

static int encoded(double light) {
  return (int)(255 * abbe_srgb_encoded(light) + 0.5);
}

TEST(pixels_are_the_encoded_light_and_nothing_is_beside) {
  static const char *const names[] = {"B", "G", "R"};
  static const float data[] = {0.5F, 0.25F, 0.125F, 1, 0, 0, 0, 1, 0, 0.18F, 0.18F, 0.18F};
  FILLED(abbe_inspect, s, open_picture(&s, 2, 2, 3, names, data));
  static const int dark[3] = {22, 24, 28};
  unsigned char out[6 * 6 * 4];
  show(&s, 0, "colour", (abbe_inspect_look){0});
  draw(&s, 6, 6, 2, out);
  for (size_t y = 0; y < 6; y++)
    for (size_t x = 0; x < 6; x++) {
      const bool inside = x >= 1 && x < 5 && y >= 1 && y < 5;
      const float *v = inside ? &data[3 * ((y - 1) / 2 * 2 + (x - 1) / 2)] : data;
      for (size_t k = 0; k < 3; k++) {
        const int is = inside ? encoded((double)v[2 - k]) : dark[k];
        assert_near(out[4 * (6 * y + x) + k], is, 1);
      }
    }
  /* a stop more is twice the light */
  show(&s, 0, "colour", (abbe_inspect_look){.exposure = 1});
  draw(&s, 2, 2, 1, out);
  assert_near(out[4 * 3], encoded(0.36), 1);
  /* under the pointer */
  size_t pixel[2];
  assert_true(abbe_inspect_pixel(&s, (const size_t[2]){6, 6}, (const double[2]){3.5, 2.5}, pixel));
  assert_int_equal(pixel[0], 1);
  assert_int_equal(pixel[1], 0);
}

/* However narrow a picture is, outward means smaller, at least until all of it is seen. */
TEST(the_wheel_zooms_about_the_pointer) {
  enum { HIGH = 3000 };
  static const char *const names[] = {"Z"};
  static float data[HIGH];
  static const size_t size[2] = {100, 100};
  static const double place[2] = {50, 20.01};
  size_t pixel[2], there[2];
  FILLED(abbe_inspect, s, open_picture(&s, 1, HIGH, 1, names, data));
  abbe_inspect_fit(&s, size[0], size[1]);
  const double whole = s.zoom;
  assert_near(whole, 100.0 / HIGH, 1e-12);
  abbe_inspect_wheel(&s, size, place, -1);
  assert_near(s.zoom, whole / 1.25, 1e-12);
  abbe_inspect_wheel(&s, size, place, -20);
  assert_near(s.zoom, 16.0 / HIGH, 1e-12);
  abbe_inspect_fit(&s, size[0], size[1]);
  assert_true(abbe_inspect_pixel(&s, size, place, pixel));
  for (int i = 0; i < 60; i++) abbe_inspect_wheel(&s, size, place, 1);
  assert_near(s.zoom, 64, 0);
  assert_true(abbe_inspect_pixel(&s, size, place, there));
  assert_int_equal(there[1], pixel[1]);
  /* a window of few pixels still shows all */
  abbe_inspect_wheel(&s, (const size_t[2]){8, 8}, place, -20);
  for (int i = 0; i < 3; i++) abbe_inspect_wheel(&s, (const size_t[2]){8, 8}, place, -20);
  assert_near(s.zoom, 8.0 / HIGH, 1e-12);
}

TEST(what_is_smaller_is_the_mean_of_its_pixels_in_every_tile) {
  static const char *const names[] = {"Y", "a.Z"};
  enum { SIDE = 200 };
  float *data = calloc(2 * SIDE * SIDE, sizeof *data);
  unsigned char *out = calloc(SIDE * SIDE, 4);
  for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
    data[2 * i + 1] = (i + i / SIDE) % 2 == 0 ? 1 : 0;
  FILLED(abbe_inspect, s, open_picture(&s, SIDE, SIDE, 2, names, data));
  show(&s, 0, "a.Z", (abbe_inspect_look){0});
  draw(&s, SIDE / 2, SIDE / 2, 0.5, out);
  for (size_t i = 0; i < (size_t)SIDE * SIDE / 4; i++) assert_near(out[4 * i], encoded(0.5), 1);
  draw(&s, SIDE, SIDE, 1, out);
  for (size_t i = 0; i < (size_t)SIDE * SIDE; i++)
    assert_near(out[4 * i], data[2 * i + 1] > 0 ? 255 : 0, 1);
  /* half of the samples are at each end */
  const abbe_inspect_picture *p = &s.picture[0];
  assert_int_equal(p->bin[0] + p->bin[ABBE_INSPECT_BINS - 1], SIDE * SIDE);
  assert_int_equal(p->bin[0], SIDE * SIDE / 2);
  assert_near(p->most_shown, 1, 0);
  free(out);
  free(data);
}

/* Grey is the white of sRGB, D65; as X, Y, Z it would be that of E. */
TEST(a_layer_is_named_as_its_file_has_it) {
  static const char *const names[] = {"FX.B", "FX.G", "FX.R"};
  FILLED(abbe_inspect, s, open_picture(&s, 1, 1, 3, names, (const float[]){0.5F, 0.5F, 0.5F}));
  show(&s, 0, "FX.R", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, p, probe(&s, (const size_t[4]){0}, &p));
  assert_near(p.xy[0], 0.3127, 1e-4);
  assert_near(p.xy[1], 0.3290, 1e-4);
}

/* Bands of one value from 380 to 780 nm, as light or as a reflectance, of 2 x 1 pixels. */
static void open_bands(abbe_inspect *s, const char *form, float value) {
  enum { BANDS = 41 };
  char text[BANDS][32];
  const char *names[BANDS];
  float data[2 * BANDS];
  for (int i = 0; i < BANDS; i++) {
    snprintf(text[i], sizeof text[i], form, 380 + 10 * i);
    names[i] = text[i];
    data[i] = data[BANDS + i] = value;
  }
  open_picture(s, 2, 1, BANDS, names, data);
}

/* White of E is (1/3, 1/3); a lumen is 683 lm/W times the integral of ybar, 106.857 nm [CIE15]. */
TEST(an_even_light_is_white_of_e_and_its_luminance_is_known) {
  static const size_t all[4] = {0, 0, 1, 0};
  FILLED(abbe_inspect, s, open_bands(&s, "S0.%d,000000nm", 2));
  show(&s, 0, "colour of the bands", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, p, probe(&s, all, &p));
  assert_near(p.xy[0], 1.0 / 3, 1e-4);
  assert_near(p.xy[1], 1.0 / 3, 1e-4);
  assert_near(p.xyz[1], 2, 1e-9);
  assert_near(p.unit * p.xyz[1], 2 * 683 * 106.857, 0.001 * 2 * 683 * 106.857);
  assert_int_equal(p.pixels, 2);
  assert_int_equal(p.cloud_count, 2);
  assert_near(p.cloud[1][0], p.xy[0], 1e-9);
  /* lit by D65 and seen under A, it would be A times the ratio; lit by E under A, A itself */
  const abbe_illuminant e = {.kind = ABBE_ILLUMINANT_E}, a = {.kind = ABBE_ILLUMINANT_A};
  show(&s, 0, "colour of the bands", (abbe_inspect_look){.view = {.from = &e, .to = &a}});
  FILLED(abbe_inspect_probe, lit, probe(&s, all, &lit));
  assert_near(lit.xy[0], 0.44758, 2e-4);
  assert_near(lit.xy[1], 0.40745, 2e-4);
}

TEST(a_grey_reflectance_has_the_white_of_its_light) {
  static const size_t one[4] = {1, 0, 1, 0};
  const abbe_illuminant a = {.kind = ABBE_ILLUMINANT_A};
  FILLED(abbe_inspect, s, open_bands(&s, "T.%d,000000nm", 0.5F));
  show(&s, 0, "colour of the bands", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, day, probe(&s, one, &day));
  assert_near(day.xy[0], 0.31272, 1e-4);
  assert_near(day.xy[1], 0.32903, 1e-4);
  assert_near(day.xyz[1], 0.5, 1e-6);
  show(&s, 0, "colour of the bands", (abbe_inspect_look){.view.to = &a});
  FILLED(abbe_inspect_probe, evening, probe(&s, one, &evening));
  assert_near(evening.xy[0], 0.44758, 2e-4);
  unsigned char out[4 * 2];
  show(&s, 0, "colour of the bands", (abbe_inspect_look){0});
  draw(&s, 2, 1, 1, out);
  for (size_t k = 0; k < 3; k++) assert_near(out[k], encoded(0.5), 1);
}

/* As a camera's files have them; the slider takes the nearest. */
TEST(bands_of_another_name_are_light_without_a_unit) {
  FILLED(abbe_inspect, s, open_bands(&s, "w%dnm", 1));
  assert_true(s.picture[0].renamed);
  assert_int_equal(s.picture[0].bands.count, 41);
  show(&s, 0, "one band", (abbe_inspect_look){.wavelength_nm = 554.9});
  assert_string_equal(s.picture[0].image.channel[s.picture[0].mix.channel[0]], "S0.550nm");
  show(&s, 0, "colour of the bands", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, p, probe(&s, (const size_t[4]){0}, &p));
  assert_near(p.unit, 0, 0);
}

TEST(bands_that_no_eye_sees_have_no_colour) {
  static const char *const names[] = {"S0.1000nm", "S0.1100nm"};
  FILLED(abbe_inspect, s, open_picture(&s, 1, 1, 2, names, (const float[]){1, 2}));
  assert_contains(s.picture[0].note, "hold no light that the eye sees");
  assert_int_equal(s.picture[0].entry[0].kind, ABBE_INSPECT_BAND);
  show(&s, 0, "one band", (abbe_inspect_look){.wavelength_nm = 1090});
  assert_near(s.picture[0].most_shown, 2, 0);
}

TEST(a_region_has_its_mean_deviation_and_error) {
  static const char *const names[] = {"Z", "stderr.Z"};
  const float data[] = {1, 0.1F, 2, 0.1F, 3, 0.1F, 4, 0.1F, NAN, 0, 5, INFINITY};
  FILLED(abbe_inspect, s, open_picture(&s, 2, 3, 2, names, data));
  assert_int_equal(s.picture[0].odd.nan, 1);
  assert_int_equal(s.picture[0].odd.infinite, 1);
  assert_int_equal(s.picture[0].odd_at[0], 0);
  assert_int_equal(s.picture[0].odd_at[1], 2);
  show(&s, 0, "Z", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, four, probe(&s, (const size_t[4]){0, 0, 1, 1}, &four));
  assert_near(four.mean[0], 2.5, 1e-7);
  assert_near(four.deviation[0], 1.2909944487, 1e-6);
  assert_near(four.error[0], 0.6454972244, 1e-6);
  /* what is not finite is left out and counted; all that lies beyond the edge too */
  FILLED(abbe_inspect_probe, all, probe(&s, (const size_t[4]){0, 0, 9, 9}, &all));
  assert_near(all.mean[0], 3, 1e-7);
  assert_near(all.mean[1], 0.08, 1e-7);
  assert_int_equal(all.pixels, 6);
  assert_int_equal(all.odd, 1);
  FILLED(abbe_inspect_probe, one, probe(&s, (const size_t[4]){1, 0, 1, 0}, &one));
  assert_near(one.error[0], 0.1, 1e-7);
  assert_true(isnan(one.deviation[0]));
  assert_false(one.coloured);
}

/* A distance beyond all takes nothing from a colour; a pixel that lacks part of it is none. */
TEST(what_is_not_finite_is_left_out_by_channel) {
  static const char *const names[] = {"B", "G", "R", "Z"};
  static const float data[] = {1, 1, 1, INFINITY, 3, 3, 3, INFINITY, 5, NAN, 8, 2};
  FILLED(abbe_inspect, s, open_picture(&s, 3, 1, 4, names, data));
  show(&s, 0, "colour", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, p, probe(&s, (const size_t[4]){0, 0, 2, 0}, &p));
  assert_int_equal(p.odd, 1);
  assert_near(p.mean[0], 3, 1e-7);
  assert_near(p.mean[1], 2, 1e-7);
  assert_near(p.mean[3], 2, 1e-7);
  assert_near(p.xyz[1], 2, 1e-6);
  assert_near(p.xy[0], 0.3127, 1e-4);
  assert_int_equal(p.cloud_count, 2);
  show(&s, 0, "Z", (abbe_inspect_look){0});
  FILLED(abbe_inspect_probe, far, probe(&s, (const size_t[4]){0, 0, 1, 0}, &far));
  assert_int_equal(far.odd, 2);
  assert_true(isnan(far.mean[3]));
  assert_near(far.xyz[1], 2, 1e-6);
}

TEST(polarised_light_has_a_degree_and_an_angle) {
  static const char *const names[] = {"S0.500nm", "S0.600nm", "S1.500nm", "S1.600nm",
                                      "S2.500nm", "S2.600nm", "S3.500nm"};
  const float data[] = {2, 1, 1, -0.5F, 1, 0, 1};
  FILLED(abbe_inspect, s, open_picture(&s, 1, 1, 7, names, data));
  const abbe_inspect_picture *p = &s.picture[0];
  show(&s, 0, "degree of polarisation", (abbe_inspect_look){.wavelength_nm = 500});
  assert_near(p->most_shown, sqrt(3) / 2, 1e-6);
  show(&s, 0, "degree of polarisation", (abbe_inspect_look){.wavelength_nm = 600});
  assert_near(p->most_shown, 0.5, 1e-6);
  show(&s, 0, "angle of polarisation", (abbe_inspect_look){.wavelength_nm = 500});
  assert_near(p->most_shown, 22.5, 1e-5);
  show(&s, 0, "angle of polarisation", (abbe_inspect_look){.wavelength_nm = 600});
  assert_near(p->most_shown, 90, 1e-5);
}

TEST(two_pictures_and_their_difference) {
  static const char *const names[] = {"Y", "Z"};
  const float a[] = {1, 2, 1, 4}, b[] = {1, 3, 1, 1}, c[] = {1, 1};
  FILLED(abbe_inspect, s, open_picture(&s, 2, 1, 2, names, a));
  open_picture(&s, 2, 1, 2, names, b);
  open_picture(&s, 1, 1, 2, names, c);
  show(&s, 0, "Z", (abbe_inspect_look){.difference = true});
  assert_near(s.picture[0].least_shown, -1, 0);
  assert_near(s.picture[0].most_shown, 3, 0);
  assert_int_equal(s.picture[0].scale.map, ABBE_COLOUR_MAP_DIFFERENCE);
  /* the entry of the same name, and no difference of what lies elsewhere */
  show(&s, 1, "Z", (abbe_inspect_look){0});
  assert_string_equal(s.picture[1].name[s.look.entry], "Z");
  assert_near(s.picture[1].most_shown, 3, 0);
  s.other = 2;
  REFUSED(ABBE_INVALID_ARGUMENT, "has 1 x 1: there is no difference",
          abbe_inspect_show(&s, 1, &(abbe_inspect_look){.difference = true}, &error));
  assert_near(s.picture[1].most_shown, 3, 0);
  /* amounts are false colours up to a round number that nearly all are below, here 1; a stop
   * less is half of it */
  unsigned char out[8];
  double rgb[3];
  show(&s, 1, "Z", (abbe_inspect_look){.false_colours = true, .exposure = -1});
  draw(&s, 2, 1, 1, out);
  abbe_colour_map_at(ABBE_COLOUR_MAP_AMOUNT, 0.5, rgb);
  for (size_t k = 0; k < 3; k++) assert_near(out[4 + k], 255 * rgb[k], 1);
}

enum { LARGE_W = 300, LARGE_H = 200, TILE = 16 };

/* A picture of so many numbers at first, with levels of detail or in scan lines. */
static void open_large(abbe_inspect *s, size_t numbers, bool levels) {
  const exr_library_file file = {.data_window = {0, 0, LARGE_W - 1, LARGE_H - 1},
                                 .display_window = {0, 0, LARGE_W - 1, LARGE_H - 1},
                                 .channels = 2,
                                 .name = {"Y", "Z"},
                                 .type = {2, 2},
                                 .tile = {levels ? TILE : 0, levels ? TILE : 0},
                                 .levels = levels};
  char why[200];
  if (!exr_library_write(path, &file, why, sizeof why)) fail_msg("%s", why);
  s->most_numbers = numbers;
  OK(abbe_inspect_open(s, path, &error));
}

/* Levels hold the full picture's corner each, so that it shows which one was read. */
TEST(of_a_large_picture_what_is_shown_is_read) {
  static const size_t whole[4] = {0, 0, LARGE_W - 1, LARGE_H - 1};
  OWNED(abbe_inspect, all) = {.count = 0};
  OWNED(abbe_inspect, s) = {.count = 0};
  open_large(&all, 0, true);
  assert_int_equal(all.picture[0].coarse, 0);
  open_large(&s, 2 * 80 * 50, true);
  abbe_inspect_picture *p = &s.picture[0];
  assert_int_equal(p->coarse, 2);
  assert_true(p->width == LARGE_W && p->height == LARGE_H);
  assert_true(p->image.width == LARGE_W / 4 && p->image.height == LARGE_H / 4);
  const abbe_image *full = &all.picture[0].image;
  for (size_t y = 0; y < LARGE_H / 4; y++)
    for (size_t x = 0; x < 2 * (LARGE_W / 4); x++)
      assert_near(p->image.data[y * 2 * (LARGE_W / 4) + x], full->data[y * 2 * LARGE_W + x], 0);
  show(&s, 0, "Z", (abbe_inspect_look){.exposure = -5});
  show(&all, 0, "Z", (abbe_inspect_look){.exposure = -5});
  /* pixel by pixel it is the same picture, also at the edge, and so are a pixel and a region */
  static unsigned char out[2][4 * LARGE_W * LARGE_H];
  draw(&s, LARGE_W, LARGE_H, 1, out[0]);
  draw(&all, LARGE_W, LARGE_H, 1, out[1]);
  assert_memory_equal(out[0], out[1], sizeof out[0]);
  FILLED(abbe_inspect_probe, one, probe(&s, (const size_t[4]){299, 7, 299, 7}, &one));
  assert_near(one.mean[1], full->data[2 * (7 * LARGE_W + 299) + 1], 1e-6);
  FILLED(abbe_inspect_probe, part, probe(&s, (const size_t[4]){90, 70, 120, 99}, &part));
  FILLED(abbe_inspect_probe, same, probe(&all, (const size_t[4]){90, 70, 120, 99}, &same));
  assert_near(part.mean[0], same.mean[0], 1e-9);
  assert_int_equal(part.pixels, same.pixels);
  FILLED(abbe_inspect_probe, means, probe(&s, whole, &means));
  assert_int_equal(means.side, 4);
  assert_int_equal(means.pixels, LARGE_W / 4 * (LARGE_H / 4));
}

/* Some lines are there at once, each further one as that above it; then all. */
TEST(lines_of_a_large_picture_are_read_one_after_another) {
  OWNED(abbe_inspect, all) = {.count = 0};
  OWNED(abbe_inspect, s) = {.count = 0};
  static unsigned char out[3][4 * LARGE_W * LARGE_H];
  bool whole = false;
  open_large(&all, 0, false);
  open_large(&s, 2 * LARGE_W * LARGE_H / 4, false);
  abbe_inspect_picture *p = &s.picture[0];
  const abbe_image *full = &all.picture[0].image;
  assert_true(all.picture[0].reader == NULL && p->reader != NULL && p->coarse == 0);
  assert_near(p->read, 0.25, 0.01);
  for (size_t y = 0; y < LARGE_H; y++)
    assert_memory_equal(p->image.data + y * 2 * LARGE_W, full->data + y / 4 * 4 * 2 * LARGE_W,
                        2 * LARGE_W * sizeof(float));
  show(&s, 0, "Z", (abbe_inspect_look){.exposure = -5});
  draw(&s, LARGE_W, LARGE_H, 1, out[0]);
  while (!whole) OK(abbe_inspect_read_on(&s, 0.01, &whole, &error));
  assert_true(p->reader == NULL && p->read == 1);
  assert_memory_equal(p->image.data, full->data, 2 * LARGE_W * LARGE_H * sizeof(float));
  show(&s, 0, "Z", (abbe_inspect_look){.exposure = -5});
  draw(&s, LARGE_W, LARGE_H, 1, out[1]);
  show(&all, 0, "Z", (abbe_inspect_look){.exposure = -5});
  draw(&all, LARGE_W, LARGE_H, 1, out[2]);
  assert_memory_equal(out[1], out[2], sizeof out[1]);
  assert_memory_not_equal(out[0], out[2], sizeof out[0]);
}

/* What is sent into a file whose lines are still being read is not read over. */
TEST(what_is_sent_stays) {
  OWNED(abbe_inspect, s) = {.count = 0};
  size_t focus;
  bool whole = false;
  unsigned char packet[400] = {[4] = 3}; /* one pixel of Z at 1, 150 becomes 1 */
  const size_t length = strlen(path), size = length + 29;
  static const char rest[] = "Z\0\1\0\0\0\226\0\0\0\1\0\0\0\1\0\0\0\0\0\200\77";
  assert_true(size < 256);
  packet[0] = (unsigned char)size;
  memcpy(packet + 6, path, length);
  memcpy(packet + 7 + length, rest, sizeof rest - 1);
  open_large(&s, 2 * LARGE_W * LARGE_H / 4, false);
  assert_non_null(s.picture[0].reader);
  OK(abbe_inspect_take_packet(&s, packet, size, &focus, &error));
  while (!whole) OK(abbe_inspect_read_on(&s, 0.01, &whole, &error));
  assert_near(s.picture[0].image.data[2 * (150 * LARGE_W + 1) + 1], 1, 0);
}

/* All tiles of the finest level, which come first, are made unreadable. */
TEST(a_large_picture_is_opened_without_its_finest_tiles) {
  OWNED(abbe_inspect, s) = {.count = 0};
  static unsigned char out[4 * LARGE_W * LARGE_H];
  bool whole = false;
  open_large(&s, 2 * 80 * 50, true);
  abbe_inspect_free(&s);
  FILE *file = fopen(path, "r+b");
  const size_t most = LARGE_W * LARGE_H * 2 * sizeof(float);
  FREED unsigned char *junk = calloc(most, 1);
  assert_int_equal(fseek(file, 0, SEEK_END), 0);
  const long size = ftell(file);
  assert_true((size_t)size > most);
  /* codec 0 packs nothing: the coarser levels are a third of it, behind */
  const long coarser = (150 * 100 + 75 * 50 + 37 * 25 + 18 * 12 + 9 * 6 + 4 * 3 + 2 + 1) * 8;
  assert_int_equal(fseek(file, size - coarser - 4096 - (long)most / 2, SEEK_SET), 0);
  memset(junk, 0xff, most);
  assert_int_equal(fwrite(junk, 1, most / 4, file), most / 4);
  fclose(file);
  abbe_image image;
  assert_int_not_equal(abbe_exr_read(path, &image, NULL), ABBE_OK);
  s.most_numbers = 2 * 80 * 50;
  OK(abbe_inspect_open(&s, path, &error));
  show(&s, 0, "Z", (abbe_inspect_look){0});
  draw(&s, LARGE_W / 4, LARGE_H / 4, 0.25, out);
  s.zoom = 1;
  REFUSED(ABBE_PARSE, path, abbe_inspect_draw(&s, LARGE_W, LARGE_H, 9, out, &whole, &error));
}

/* A grey of the white of graphics, 203 cd/m2 [BT2408], is 0.58 in PQ and 0.75 in HLG; half of
 * Display P3's light stays half. */
TEST(an_avif_is_the_light_that_it_encodes) {
  static const char *const names[] = {"R", "G", "B"};
  static const double rec2020[8] = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290};
  static const struct {
    int transfer;
    float value;
    double light;
  } cases[] = {{16, 0.5806F, 1}, {18, 0.75F, 1}, {0, 0.7354F, 0.5}};
  static const char avif[] = "view_inspect.avif";
  for (size_t i = 0; i < 3; i++) {
    MADE(abbe_image, image, abbe_image_make(16, 16, 3, names, &image, &error));
    if (cases[i].transfer == 0) abbe_rgb_encoding_display_p3(image.xy, image.curve);
    if (cases[i].transfer != 0) memcpy(image.xy, rec2020, sizeof rec2020);
    image.transfer = cases[i].transfer;
    for (size_t k = 0; k < 3 * 256; k++) image.data[k] = cases[i].value;
    const abbe_result written = abbe_screen_file_write(avif, &image, 12, NULL);
    if (written == ABBE_UNSUPPORTED) return; /* a build without libavif */
    OWNED(abbe_inspect, s) = {.count = 0};
    OK(abbe_inspect_open(&s, avif, &error));
    unlink(avif);
    show(&s, 0, "colour", (abbe_inspect_look){0});
    FILLED(abbe_inspect_probe, p, probe(&s, (const size_t[4]){8, 8, 8, 8}, &p));
    assert_near(p.xyz[1], cases[i].light, 0.01);
    assert_near(p.xy[0], 0.3127, 1e-3);
    assert_false(s.picture[0].space.assumed);
  }
}

TEST(what_cannot_be_read_is_said_as_by_its_reader) {
  OWNED(abbe_inspect, s) = {.count = 0};
  static const char *const twice[] = {"S0.500,0nm", "S0.500nm"};
  MADE(abbe_image, image, abbe_image_make(1, 1, 2, twice, &image, &error));
  OK(abbe_exr_write(path, &image, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "are of one wavelength", abbe_inspect_open(&s, path, &error));
  REFUSED(ABBE_UNSUPPORTED, ".exr, .hdr, .pic, .png and .avif",
          abbe_inspect_open(&s, "picture.jxl", &error));
  REFUSED(ABBE_IO, "absent.png", abbe_inspect_open(&s, "absent.png", &error));
  assert_int_equal(truncate(path, 100), 0);
  REFUSED(ABBE_PARSE, path, abbe_inspect_open(&s, path, &error));
  assert_int_equal(s.count, 0);
}
