/* Light that no screen takes, and configurations that do not call Abbe's spaces by their names. */
#include "tests/colorimetry/image/one_colour.h"

#include "base/file.h"
#include "colorimetry/rgb_space.h"

#include <unistd.h>

/* Infinite light is as bright as light gets, whatever the exposure, and what is not a number is
 * dark; the ACES view of OpenColorIO makes infinities black by itself. */
TEST(infinite_light) {
  static const char path[] = "/tmp/abbe_test_aces.ocio";
  static const char aces[] =
      "ocio_profile_version: 2\n"
      "roles: {scene_linear: ap0, aces_interchange: ap0}\n"
      "file_rules:\n  - !<Rule> {name: Default, colorspace: ap0}\n"
      "displays:\n  Monitor:\n    - !<View> {name: ACES, colorspace: aces}\n"
      "colorspaces:\n  - !<ColorSpace> {name: ap0}\n"
      "  - !<ColorSpace>\n    name: aces\n    from_scene_reference: !<GroupTransform>\n"
      "      children:\n"
      "        - !<BuiltinTransform> {style: ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - "
      "SDR-VIDEO_1.0}\n"
      "        - !<BuiltinTransform> {style: DISPLAY - CIE-XYZ-D65_to_sRGB}\n";
  const abbe_display_desc views[] = {{.view = "Looking"},
                                     {.view = "Plain"},
                                     {.view = "Plain", .exposure = 60},
                                     {.view = "Looking", .exposure = -60},
                                     {.view = "Plain", .exposure = -60, .white = {0.4476, 0.4074}},
                                     {.view = "Plain", .gamut = ABBE_GAMUT_MAP_WHITE},
                                     {.config = path},
                                     {.config = path, .exposure = 20}};
  static const float lights[] = {INFINITY, 3e38f, 65504};
  OK(abbe_file_write(path, aces, strlen(aces), &error));
  for (size_t i = 0; i < sizeof views / sizeof views[0]; i++)
    for (int l = 0; l < 3; l++) {
      double v[3] = {(double)lights[l], (double)lights[l], (double)lights[l]};
      if (l == 2 && views[i].exposure < 0) continue;
      show(&views[i], v);
      if (!(v[1] > 0.98)) fail_msg("view %zu shows %g as %.3f", i, (double)lights[l], v[1]);
    }
  double nan[3] = {NAN, NAN, NAN}, dark[3] = {-INFINITY, -INFINITY, -INFINITY};
  show(&views[1], nan);
  near(nan, (double[]){0, 0, 0}, 1e-4, "NaN");
  show(&views[1], dark);
  near(dark, (double[]){0, 0, 0}, 1e-4, "-inf");
  unlink(path);
}

/* An exposure of any stops is that factor: white of 2^-e at e stops is white, and not tinted. */
TEST(far_exposures) {
  static const double stops[] = {-60, -40, -30, -20, -10, 20, 60};
  for (size_t i = 0; i < sizeof stops / sizeof *stops; i++) {
    abbe_display_desc desc = {
        .source_space = "Linear Rec.709 (sRGB)", .view = "Plain", .exposure = stops[i]};
    double v[3], want[3] = {0.2, 0.4, 0.1};
    for (int k = 0; k < 3; k++) v[k] = want[k] * exp2(-stops[i]);
    show(&desc, v);
    desc.exposure = 0;
    show(&desc, want);
    near(v, want, 1e-5, "exposed");
  }
}

/* Abbe's spaces are reached in configurations that do not have their names: by a role, by a name
 * that tells the primaries, and by what sRGB is; and not in one that tells nothing. */
TEST(spaces_that_have_no_name) {
  static const char path[] = "/tmp/abbe_test_nameless.ocio";
  static const char head[] =
      "ocio_profile_version: %s\nroles: {scene_linear: %s%s}\n%sactive_displays: [sRGB, None]\n"
      "displays:\n  sRGB:\n    - !<View> {name: Film, colorspace: %s}\n"
      "colorspaces:\n  - !<ColorSpace> {name: %s}\n%s";
  static const char rules[] =
      "file_rules:\n  - !<Rule> {name: Default, colorspace: scene_linear}\n";
  static const char of_rec709[] =
      "  - !<ColorSpace>\n    name: sRGB OETF\n    from_reference: !<ExponentTransform> {value: "
      "[2.2, 2.2, 2.2, 1], direction: inverse}\n";
  static const char of_ap0[] =
      "  - !<ColorSpace>\n    name: video\n    from_scene_reference: !<GroupTransform>\n"
      "      children:\n"
      "        - !<BuiltinTransform> {style: UTILITY - ACES-AP0_to_CIE-XYZ-D65_BFD}\n"
      "        - !<MatrixTransform> {matrix: [3.24096994190452, -1.53738317757009, "
      "-0.498610760293004, 0, -0.96924363628088, 1.87596750150772, 0.0415550574071756, 0, "
      "0.0556300796969936, -0.203976958888976, 1.05697151424288, 0, 0, 0, 0, 1]}\n"
      "        - !<ExponentTransform> {value: 2.2, direction: inverse}\n";
  static const struct {
    const char *version, *linear, *roles, *view, *rest;
    bool known;
  } cases[] = {{"2", "mine", ", aces_interchange: mine", "video", of_ap0, true},
               {"2", "Linear BT.709", "", "sRGB OETF", of_rec709, true},
               {"1", "Linear", "", "sRGB OETF", of_rec709, true},
               {"2", "mine", "", "video", of_ap0, false}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    const char *text = printed(head, cases[i].version, cases[i].linear, cases[i].roles,
                               cases[i].version[0] == '2' ? rules : "", cases[i].view,
                               cases[i].linear, cases[i].rest);
    OK(abbe_file_write(path, text, strlen(text), &error));
    for (int s = 0; s < ABBE_RGB_SPACE_COUNT; s++) {
      abbe_display_desc desc = {.config = path,
                                .source_space = abbe_rgb_space_ocio_name((abbe_rgb_space)s)};
      if (!cases[i].known) {
        abbe_display *display = NULL;
        REFUSED(ABBE_COLOUR, desc.source_space, abbe_display_make(&desc, &display, &error));
        continue;
      }
      const double colour[3] = {0.3, 0.4, 0.25};
      double to_xyz[9], to_709[9], expected[3], got[3];
      abbe_rgb_space_to_xyz((abbe_rgb_space)s, to_xyz);
      abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, to_709);
      abbe_rgb_space_apply(to_xyz, colour, expected);
      abbe_rgb_space_apply(to_709, expected, expected);
      for (int k = 0; k < 3; k++) expected[k] = pow(expected[k], 1 / 2.2);
      memcpy(got, colour, sizeof got);
      show(&desc, got);
      near(got, expected, 3e-5, desc.source_space);
      /* and a white is what it is without one */
      desc.white[0] = 0.3127, desc.white[1] = 0.3290;
      memcpy(got, colour, sizeof got);
      show(&desc, got);
      near(got, expected, 3e-5, "under D65");
    }
  }
  unlink(path);
}
