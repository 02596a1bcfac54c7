#include "tests/colorimetry/image/one_colour.h"

#include "base/file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"

#include <lcms2.h>
#include <unistd.h>

static const char *const names[] = {"R", "G", "B", "caustic.R", "A"};

static abbe_display *make(const abbe_display_desc *desc) {
  abbe_display *display = NULL;
  OK(abbe_display_make(desc, &display, &error));
  return display;
}

static double srgb_encode(double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

static double srgb_decode(double x) {
  return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

/* Each space of the toolkit goes through its name in the configuration by the same matrices. */
TEST(plain_is_the_encoding_alone) {
  static const double colours[][3] = {{0, 0, 0},        {1, 1, 1},         {0.18, 0.18, 0.18},
                                      {0.9, 0.1, 0.02}, {0.001, 0.3, 0.7}, {0.4, 1.3, -0.2},
                                      {2, 3, 4}};
  double to_709[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, to_709);
  for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++)
    for (size_t i = 0; i < sizeof colours / sizeof colours[0]; i++) {
      double to_xyz[9], expected[3], got[3];
      memcpy(got, colours[i], sizeof got);
      abbe_rgb_space_to_xyz((abbe_rgb_space)s, to_xyz);
      abbe_rgb_space_apply(to_xyz, colours[i], expected);
      abbe_rgb_space_apply(to_709, expected, expected);
      for (int k = 0; k < 3; k++) expected[k] = srgb_encode(expected[k]);
      const abbe_display_desc desc = {.source_space = abbe_rgb_space_ocio_name((abbe_rgb_space)s),
                                      .display = "sRGB",
                                      .view = "Plain"};
      show(&desc, got);
      near(got, expected, 3e-5, desc.source_space);
    }
}

TEST(display_p3) {
  /* Rec.709 red on a Display P3 screen, as published for CSS colours */
  double red[3] = {1, 0, 0};
  const double expected[3] = {0.91749, 0.20029, 0.13856};
  const abbe_display_desc desc = {
      .source_space = "Linear Rec.709 (sRGB)", .display = "Display P3", .view = "Plain"};
  show(&desc, red);
  near(red, expected, 2e-5, "Rec.709 red in P3");
}

TEST(exposure_is_in_stops) {
  double plain[3] = {0.4, 0.2, 0.1}, exposed[3] = {0.1, 0.05, 0.025};
  abbe_display_desc desc = {.view = "Plain"};
  show(&desc, plain);
  desc.exposure = 2;
  show(&desc, exposed);
  near(exposed, plain, 1e-6, "two stops");
  double raw[3] = {-1, 0.5, 7};
  const double same[3] = {-1, 0.5, 7};
  const abbe_display_desc none = {.view = "Raw"};
  show(&none, raw);
  near(raw, same, 0, "raw");
}

static void must_fail(const abbe_display_desc *desc, abbe_result expected, const char *says) {
  abbe_display *display = NULL;
  abbe_error error = {0};
  abbe_result result = abbe_display_make(desc, &display, &error);
  if (result != expected || display != NULL || strstr(error.text, says) == NULL)
    fail_msg("%d: '%s' says nothing of '%s'", (int)result, error.text, says);
}

/* White of a scene is 203 cd/m2: a signal of 58 % PQ, of 75 % HLG [BT2408]. */
TEST(hdr_white) {
  static const struct {
    const char *display;
    double signal;
  } displays[] = {{"Rec.2100 PQ", 0.58}, {"Rec.2100 HLG", 0.75}};
  for (int d = 0; d < 2; d++) {
    double white[3] = {1, 1, 1};
    const abbe_display_desc desc = {.display = displays[d].display};
    show(&desc, white);
    for (int k = 0; k < 3; k++)
      if (!(fabs(white[k] - displays[d].signal) < 0.005))
        fail_msg("%s: white is %.4f", displays[d].display, white[k]);
  }
}

/* Red light of a wavelength is shown red, not salmon: with up to the light of white in ACEScg's
 * red, green and blue have less than a tenth of red's light. */
TEST(spectral_red_stays_red) {
  static const char *const displays[] = {"sRGB", "Display P3"};
  double from[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, from);
  for (int d = 0; d < 2; d++)
    for (double nm = 625; nm <= 690; nm += 15)
      for (double red = 0.125; red <= 1; red *= 2) {
        double v[3], most;
        abbe_observer_xyz(nm, v);
        abbe_rgb_space_apply(from, v, v);
        most = fmax(v[0], fmax(v[1], v[2]));
        for (int k = 0; k < 3; k++) v[k] *= red / most;
        const abbe_display_desc desc = {.display = displays[d]};
        show(&desc, v);
        for (int k = 1; k < 3; k++)
          if (!(srgb_decode(v[k]) < 0.1 * srgb_decode(v[0])))
            fail_msg("%s, %g nm, %g: component %d is %.3f beside %.3f", displays[d], nm, red, k,
                     v[k], v[0]);
      }
}

/* A gamut map comes before the view: towards white keeps Oklab's hue on a plain screen; where the
 * display's primaries are not told, it is refused. A white that is asked for is shown white. */
TEST(gamut_and_white) {
  double clipped[3] = {-0.1, 0.4, 0.2}, white[3] = {-0.1, 0.4, 0.2}, lamp[3];
  abbe_display_desc desc = {.source_space = "Linear Rec.709 (sRGB)", .view = "Plain"};
  desc.gamut = ABBE_GAMUT_MAP_CLIP;
  show(&desc, clipped);
  near(clipped, (double[]){0, srgb_encode(0.4), srgb_encode(0.2)}, 1e-4, "clip");
  desc.gamut = ABBE_GAMUT_MAP_WHITE;
  show(&desc, white);
  assert_true(white[0] < 1e-3 && white[2] > clipped[2] + 0.01 && white[1] < clipped[1] - 0.01);
  /* illuminant A of Y = 0.5, x = 0.44757, y = 0.40745 [CIE15] */
  double to[9];
  const double a[3] = {0.5 * 0.44757 / 0.40745, 0.5, 0.5 * (1 - 0.44757 - 0.40745) / 0.40745};
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, to);
  abbe_rgb_space_apply(to, a, lamp);
  desc.gamut = ABBE_GAMUT_MAP_NONE;
  desc.white[0] = 0.44757;
  desc.white[1] = 0.40745;
  show(&desc, lamp);
  near(lamp, (double[]){srgb_encode(0.5), srgb_encode(0.5), srgb_encode(0.5)}, 1e-4, "white");
  must_fail(&(abbe_display_desc){.white = {0.9, 0.9}}, ABBE_INVALID_ARGUMENT, "0.9, 0.9");
  must_fail(&(abbe_display_desc){.white = {0, 0.3}}, ABBE_INVALID_ARGUMENT, "0, 0.3");
  must_fail(&(abbe_display_desc){.white = {-0.1, 0.3}}, ABBE_INVALID_ARGUMENT, "-0.1, 0.3");
  must_fail(&(abbe_display_desc){.white = {0.3, 0.005}}, ABBE_INVALID_ARGUMENT, "0.3, 0.005");
  must_fail(&(abbe_display_desc){.gamut = ABBE_GAMUT_MAP_CLIP, .view = "Raw"}, ABBE_COLOUR,
            "the display's primaries");
}

/* A configuration that is too young is refused with the version that would be right. */
TEST(versions) {
  static const char path[] = "/tmp/abbe_test_version.ocio";
  static const char young[] = "# of a studio\nocio_profile_version: 2.99\nroles: {}\n";
  OK(abbe_file_write(path, young, strlen(young), &error));
  must_fail(&(abbe_display_desc){.config = path}, ABBE_COLOUR,
            "is a configuration of version 2.99; the OpenColorIO here is 2.");
  unlink(path);
  must_fail(&(abbe_display_desc){.config = "ocio://cg-config-v9.0.0_aces-v3.0_ocio-v2.99"},
            ABBE_COLOUR, "built into OpenColorIO 2.99 and later; the OpenColorIO here is 2.");
  abbe_display *display = NULL;
  abbe_error why = {0};
  const abbe_display_desc built_in = {.config = "ocio://cg-config-v1.0.0_aces-v1.3_ocio-v2.1",
                                      .view = "Un-tone-mapped"};
  const abbe_result result = abbe_display_make(&built_in, &display, &why);
  abbe_display_free(display);
  if (result != ABBE_OK) {
    assert_non_null(
        strstr(why.text, "built into OpenColorIO 2.2 and later; the OpenColorIO here is 2."));
  } else {
    double grey[3] = {0.18, 0.18, 0.18};
    show(&built_in, grey);
    for (int k = 0; k < 3; k++) assert_near(grey[k], srgb_encode(0.18), 1e-5);
  }
}

/* Greys stay grey and follow the curve that the view states; 0.18 is kept. */
TEST(looking_greys) {
  static const char *const displays[] = {"sRGB", "Display P3"};
  for (int d = 0; d < 2; d++) {
    double before = -1;
    for (double stops = -9; stops <= 6.5; stops += 0.25) {
      double x = 0.18 * exp2(stops), u = pow(x, 1.25), grey[3] = {x, x, x};
      const abbe_display_desc desc = {.display = displays[d]};
      show(&desc, grey);
      double y = srgb_decode(grey[1]), curve = 1.0166495 * u / (u + 0.5449563);
      if (fabs(y - curve) > 0.01 * curve + 2e-4)
        fail_msg("%s: %g stops come out as %.5f, not %.5f", displays[d], stops, y, curve);
      assert_true(fabs(grey[0] - grey[1]) < 2e-4 && fabs(grey[2] - grey[1]) < 2e-4);
      assert_true(grey[1] > before);
      before = grey[1];
    }
    double black[3] = {0, 0, 0}, mid[3] = {0.18, 0.18, 0.18}, zero[3] = {0};
    const abbe_display_desc desc = {.display = displays[d]};
    show(&desc, black);
    near(black, zero, 1e-4, "black");
    show(&desc, mid);
    assert_true(fabs(srgb_decode(mid[1]) - 0.18) < 0.002);
  }
}

static double luminance(const double encoded[3]) {
  return 0.2126 * srgb_decode(encoded[0]) + 0.7152 * srgb_decode(encoded[1]) +
         0.0722 * srgb_decode(encoded[2]);
}

/* The spectrum at any exposure: in the cube but for half a step of 16 bits, brighter with more
 * light, never a patch that clips to a corner, never a jump between wavelengths a nanometre apart.
 */
TEST(looking_at_the_spectrum) {
  enum { FIRST = 400, LAST = 700, COUNT = LAST - FIRST + 1, STEPS = 24 };
  const double half_a_step = 0.5 / 65535;
  MADE(abbe_image, image, abbe_image_make(COUNT, STEPS, 3, names, &image, &error));
  double matrix[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_ACESCG, matrix);
  for (int i = 0; i < COUNT * STEPS; i++) {
    double xyz[3];
    abbe_observer_xyz(FIRST + i % COUNT, xyz);
    abbe_rgb_space_apply(matrix, xyz, xyz);
    double scale = exp2(-8 + i / COUNT * 0.75);
    for (int k = 0; k < 3; k++) image.data[3 * i + k] = (float)(scale * xyz[k]);
  }
  HELD(abbe_display, display) = make(&(abbe_display_desc){0});
  OK(abbe_display_apply(display, &image, &error));
  for (int i = 0; i < COUNT * STEPS; i++) {
    const float *p = image.data + 3 * i;
    double c[3] = {(double)p[0], (double)p[1], (double)p[2]};
    double least = fmin(c[0], fmin(c[1], c[2])), most = fmax(c[0], fmax(c[1], c[2]));
    int nm = FIRST + i % COUNT, step = i / COUNT;
    if (!(least >= -half_a_step && most <= 1 + half_a_step))
      fail_msg("%d nm, step %d: outside the cube", nm, step);
    if (most > 0.995 && least < 0.3) fail_msg("%d nm, step %d: neon", nm, step);
    if (step > 0) {
      const float *q = p - 3 * COUNT;
      const double darker[3] = {(double)q[0], (double)q[1], (double)q[2]};
      if (luminance(c) < luminance(darker) - 1e-6) fail_msg("%d nm, step %d: darker", nm, step);
    }
    for (int k = 0; k < 3 && nm < LAST; k++)
      if (fabs((double)p[3 + k] - c[k]) > 0.05) fail_msg("%d nm, step %d: a jump", nm, step);
  }
}

TEST(other_channels_stay) {
  HELD(abbe_display, display) = make(&(abbe_display_desc){0});
  MADE(abbe_image, image, abbe_image_make(3, 2, 5, names, &image, &error));
  for (int i = 0; i < 30; i++) image.data[i] = 0.18f;
  OK(abbe_display_apply(display, &image, &error));
  for (int i = 0; i < 30; i++)
    assert_true(i % 5 < 3 ? image.data[i] > 0.4f : image.data[i] == 0.18f);
  MADE(abbe_image, two, abbe_image_make(1, 1, 2, names, &two, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_display_apply(display, &two, &error));
}

TEST(unknown_names_list_the_known) {
  must_fail(&(abbe_display_desc){.display = "sRBG"}, ABBE_COLOUR, "sRGB, Display P3");
  must_fail(&(abbe_display_desc){.view = "Plane"}, ABBE_COLOUR, "Looking, Plain, Raw");
  must_fail(&(abbe_display_desc){.source_space = "acescgg"}, ABBE_COLOUR, "ACEScg");
  must_fail(&(abbe_display_desc){.exposure = NAN}, ABBE_INVALID_ARGUMENT, "nan");
  must_fail(&(abbe_display_desc){.exposure = 1e9}, ABBE_INVALID_ARGUMENT, "1e+09");
}

TEST(broken_configurations) {
  static const char *const texts[] = {
      "",
      "not: [a, config",
      "ocio_profile_version: 99\n",
      "\x89PNG\r\n",
      "ocio_profile_version: 2\nroles: {default: Missing}\ncolorspaces: []\n",
      "ocio_profile_version: 2\nroles: {default: a, scene_linear: a}\ndisplays:\n  d:\n"
      "    - !<View> {name: v, colorspace: nowhere}\ncolorspaces:\n"
      "  - !<ColorSpace> {name: a}\n"};
  char path[128];
  snprintf(path, sizeof path, "/tmp/abbe_test_config_%ld.ocio", (long)getpid());
  for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
    OK(abbe_file_write(path, texts[i], strlen(texts[i]), &error));
    must_fail(&(abbe_display_desc){.config = path}, ABBE_COLOUR, path);
    char *list = NULL;
    assert_int_equal(abbe_display_list(path, &list, NULL), ABBE_COLOUR);
    assert_null(list);
  }
  assert_int_equal(setenv("OCIO", path, 1), 0);
  must_fail(&(abbe_display_desc){0}, ABBE_COLOUR, path);
  assert_int_equal(setenv("OCIO", "/no/such.ocio", 1), 0);
  must_fail(&(abbe_display_desc){0}, ABBE_COLOUR, "/no/such.ocio");
  assert_int_equal(setenv("OCIO", "", 1), 0);
  abbe_display_free(make(&(abbe_display_desc){0}));
  assert_int_equal(unsetenv("OCIO"), 0);
  must_fail(&(abbe_display_desc){.config = "/no/such.ocio"}, ABBE_COLOUR, "/no/such.ocio");
  unlink(path);
  /* a name that leaves no room in the message for a reason */
  char endless[1500] = "/no/";
  memset(endless + 4, 'a', sizeof endless - 5);
  must_fail(&(abbe_display_desc){.config = endless}, ABBE_COLOUR, "/no/aaa");
}

/* The shipped file also loads by its path, with $OCIO pointing at it. */
TEST(list) {
  static const char *const expected =
      "sRGB / Looking\nsRGB / Plain\nsRGB / Raw\n"
      "Display P3 / Looking\nDisplay P3 / Plain\nDisplay P3 / Raw\n"
      "Rec.709 / Looking\nRec.709 / Plain\nRec.709 / Raw\n"
      "Rec.2020 / Looking\nRec.2020 / Plain\nRec.2020 / Raw\n"
      "Rec.2100 PQ / Plain\nRec.2100 PQ / Raw\nRec.2100 HLG / Plain\nRec.2100 HLG / Raw\n";
  FREED char *list = NULL;
  OK(abbe_display_list(NULL, &list, &error));
  assert_string_equal(list, expected);
  free(list);
  assert_int_equal(setenv("OCIO", ABBE_SOURCE_DIR "/colorimetry/image/config.ocio", 1), 0);
  OK(abbe_display_list(NULL, &list, &error));
  assert_string_equal(list, expected);
  assert_int_equal(unsetenv("OCIO"), 0);
}

/* What the display says of its numbers: 's' sRGB, 'p' Display P3, '4' a power of 2.4, 'q' PQ and
 * 'h' HLG of Rec.2020's primaries, '-' nothing. */
static char encoding_of(const abbe_display_desc *desc) {
  HELD(abbe_display, display) = make(desc);
  double p3[8], curve[5];
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, names, &image, &error));
  image.xy[0] = 0.7; /* of the scene-linear picture */
  OK(abbe_display_apply(display, &image, &error));
  abbe_rgb_encoding_display_p3(p3, curve);
  char kind = '?';
  if (!abbe_rgb_encoding_is_known(image.xy, image.curve)) kind = image.xy[0] == 0 ? '-' : '?';
  if (abbe_rgb_encoding_is_srgb(image.xy, image.curve)) kind = 's';
  if (fabs(image.curve[0] - 2.4) < 1e-3 && image.curve[4] == 0) kind = '4';
  if (image.transfer != 0) {
    assert_int_equal(abbe_rgb_encoding_primaries_code(image.xy), 9);
    kind = image.transfer == 16 ? 'q' : image.transfer == 18 ? 'h' : '?';
  }
  if (kind == '?' && fabs(image.xy[0] - p3[0]) < 1e-4 && image.curve[0] == curve[0]) kind = 'p';
  return kind;
}

TEST(what_the_numbers_mean) {
  static const struct {
    const char *display, *view;
    char kind;
  } shipped[] = {
      {"sRGB", "Looking", 's'},       {"sRGB", "Plain", 's'},       {"sRGB", "Raw", '-'},
      {"Display P3", "Looking", 'p'}, {"Display P3", "Plain", 'p'}, {"Display P3", "Raw", '-'},
      {"Rec.709", "Plain", '4'},      {"Rec.2020", "Looking", '4'}, {"Rec.2100 PQ", "Plain", 'q'},
      {"Rec.2100 HLG", "Plain", 'h'}, {"Rec.2100 PQ", "Raw", '-'}};
  for (int i = 0; i < 11; i++) {
    const abbe_display_desc desc = {.display = shipped[i].display, .view = shipped[i].view};
    assert_int_equal(encoding_of(&desc), shipped[i].kind);
  }
}

/* A configuration of another maker: displays by formula, by name alone, and by neither. */
TEST(what_other_configurations_tell) {
  static const char path[] = "/tmp/abbe_test_other.ocio";
  static const char text[] =
      "ocio_profile_version: 2\n"
      "roles: {scene_linear: ap0%s}\n"
      "file_rules:\n  - !<Rule> {name: Default, colorspace: ap0}\n"
      "displays:\n"
      "  Monitor:\n    - !<View> {name: Film, colorspace: video}\n"
      "    - !<View> {name: Toned, colorspace: toned}\n"
      "  sRGB:\n    - !<View> {name: Toned, colorspace: toned}\n"
      "  Display P3 - Display:\n    - !<View> {name: Toned, colorspace: toned}\n"
      "colorspaces:\n"
      "  - !<ColorSpace> {name: ap0}\n"
      "  - !<ColorSpace>\n    name: video\n    from_scene_reference: !<GroupTransform>\n"
      "      children:\n"
      "        - !<BuiltinTransform> {style: UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD}\n"
      "        - !<MatrixTransform> {matrix: [3.24096994190452, -1.53738317757009, "
      "-0.498610760293004, 0, -0.96924363628088, 1.87596750150772, 0.0415550574071756, 0, "
      "0.0556300796969936, -0.203976958888976, 1.05697151424288, 0, 0, 0, 0, 1]}\n"
      "        - !<ExponentTransform> {value: 2.4, direction: inverse}\n"
      "  - !<ColorSpace>\n    name: toned\n    from_scene_reference: !<GroupTransform>\n"
      "      children:\n"
      "        - !<MatrixTransform> {matrix: [0.9, 0.1, 0, 0, 0.2, 0.8, 0, 0, 0, 0.3, 0.7, 0, 0, "
      "0, 0, 1]}\n"
      "        - !<LogTransform> {base: 10}\n";
  static const struct {
    const char *display, *view;
    char with_roles, without;
  } cases[] = {{"Monitor", "Film", '4', '-'},
               {"Monitor", "Toned", '-', '-'},
               {"sRGB", "Toned", 's', 's'},
               {"Display P3 - Display", "Toned", 'p', 'p'}};
  for (int roles = 0; roles < 2; roles++) {
    const char *config = printed(text, roles ? ", aces_interchange: ap0" : "");
    OK(abbe_file_write(path, config, strlen(config), &error));
    for (int i = 0; i < 4; i++) {
      const abbe_display_desc desc = {
          .config = path, .display = cases[i].display, .view = cases[i].view};
      const char kind = encoding_of(&desc), right = roles ? cases[i].with_roles : cases[i].without;
      if (kind != right)
        fail_msg("%s, %s: '%c', not '%c'", cases[i].display, cases[i].view, kind, right);
    }
  }
  unlink(path);
}

/* Without a space that Abbe knows neither a white nor a map can be: data and a display's space of
 * that name are none, nor is sRGB where the configuration has no light to come from. */
TEST(spaces_that_anchor_nothing) {
  static const char path[] = "/tmp/abbe_test_anchor.ocio";
  static const char *const spaces[] = {
      "  - !<ColorSpace> {name: a}\n  - !<ColorSpace> {name: ACEScg, isdata: true}\n",
      "  - !<ColorSpace> {name: a}\n  - !<ColorSpace> {name: sRGB}\n",
      "  - !<ColorSpace> {name: a, isdata: true}\n  - !<ColorSpace> {name: sRGB}\n",
      "  - !<ColorSpace> {name: a}\ndisplay_colorspaces:\n  - !<ColorSpace> {name: ACEScg}\n"
      "view_transforms:\n  - !<ViewTransform>\n    name: t\n"
      "    from_scene_reference: !<MatrixTransform> {}\n"};
  for (int i = 0; i < 4; i++) {
    const char *text = printed("ocio_profile_version: 2\nroles: {scene_linear: a}\n"
                               "file_rules:\n  - !<Rule> {name: Default, colorspace: a}\n"
                               "displays:\n  d:\n    - !<View> {name: v, colorspace: a}\n"
                               "colorspaces:\n%s",
                               spaces[i]);
    OK(abbe_file_write(path, text, strlen(text), &error));
    must_fail(&(abbe_display_desc){.config = path, .white = {0.3127, 0.329}}, ABBE_COLOUR,
              "it has no role aces_interchange");
    abbe_display_free(make(&(abbe_display_desc){.config = path}));
  }
  unlink(path);
}

/* A profile of Adobe RGB (1998) by Little CMS: its primaries, D65 and the power 563/256. */
TEST(a_monitors_profile_is_a_display) {
  const char *path = printed("/tmp/abbe_test_monitor_%ld.icc", (long)getpid());
  const double xy[8] = {0.64, 0.33, 0.21, 0.71, 0.15, 0.06, 0.3127, 0.329}, power = 563.0 / 256;
  const cmsCIExyYTRIPLE primaries = {{xy[0], xy[1], 1}, {xy[2], xy[3], 1}, {xy[4], xy[5], 1}};
  cmsToneCurve *tone = cmsBuildGamma(NULL, power), *const tones[3] = {tone, tone, tone};
  cmsHPROFILE profile = cmsCreateRGBProfile(&(cmsCIExyY){xy[6], xy[7], 1}, &primaries, tones);
  assert_true(cmsSaveProfileToFile(profile, path));
  cmsCloseProfile(profile);
  cmsFreeToneCurve(tone);
  HELD(abbe_display, display) = make(&(abbe_display_desc){
      .display = path, .view = "Plain", .source_space = "Linear Rec.709 (sRGB)"});
  /* Rec.709's red is 0.71512 of Adobe's red alone, for they share it; white and grey stay */
  static const float light[3][3] = {{1, 0, 0}, {1, 1, 1}, {0.18F, 0.18F, 0.18F}};
  const double linear[3][3] = {{0.715119, 0, 0}, {1, 1, 1}, {0.18, 0.18, 0.18}};
  MADE(abbe_image, image, abbe_image_make(3, 1, 3, names, &image, &error));
  memcpy(image.data, light, sizeof light);
  OK(abbe_display_apply(display, &image, &error));
  for (int i = 0; i < 9; i++)
    assert_near(pow((double)image.data[i], power), linear[i / 3][i % 3], 1e-4);
  for (int i = 0; i < 8; i++) assert_near(image.xy[i], xy[i], 1e-3);
  const char *other = printed("/tmp/abbe_test_monitor_%ld.icm", (long)getpid());
  assert_int_equal(rename(path, other), 0); /* is a profile by that ending too */
  abbe_display_free(make(&(abbe_display_desc){.display = other, .view = "Plain"}));
  assert_int_equal(rename(other, path), 0);
  image.channels = 2;
  assert_int_equal(abbe_display_apply(display, &image, NULL), ABBE_INVALID_ARGUMENT);
  image.channels = 3;
  assert_int_equal(abbe_display_apply(display, &(abbe_image){.channels = 3}, NULL),
                   ABBE_INVALID_ARGUMENT);
  must_fail(&(abbe_display_desc){.display = path, .view = "Plane"}, ABBE_COLOUR,
            "Looking, Plain, Raw");
  OK(abbe_file_write(path, "none", 4, &error));
  must_fail(&(abbe_display_desc){.display = path}, ABBE_COLOUR, printed("%s: OpenColorIO 2", path));
  must_fail(&(abbe_display_desc){.display = path}, ABBE_COLOUR, "--display sRGB needs none");
  unlink(path);
  must_fail(&(abbe_display_desc){.display = path}, ABBE_COLOUR, path);
}
