#include "tests/check.h"
#include "tests/random.h"

#include "colorimetry/difference.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <lcms2.h>

static const char *const names[] = {"R", "G", "B"};

static abbe_image one_pixel(double r, double g, double b) {
  abbe_image image = {0};
  OK(abbe_image_make(1, 1, 3, names, &image, &error));
  image.data[0] = (float)r;
  image.data[1] = (float)g;
  image.data[2] = (float)b;
  return image;
}

static void pixel_is(abbe_image *image, double r, double g, double b, double tolerance) {
  assert_near((double)image->data[0], r, tolerance);
  assert_near((double)image->data[1], g, tolerance);
  assert_near((double)image->data[2], b, tolerance);
  assert_true(abbe_rgb_encoding_is_srgb(image->xy, image->curve));
  abbe_image_free(image);
}

TEST(curves) {
  double xy[8], curve[5];
  const double none[8] = {0};
  abbe_rgb_encoding_srgb(xy, curve);
  assert_near(abbe_rgb_encoding_light(curve, 0.5), 0.21404114048, 1e-10); /* [IEC61966] */
  assert_near(abbe_rgb_encoding_light(curve, 0.02), 0.02 / 12.92, 1e-15);
  assert_near(abbe_rgb_encoding_light(curve, 1), 1, 1e-15);
  assert_true(abbe_rgb_encoding_is_known(xy, curve) && abbe_rgb_encoding_is_srgb(xy, curve));
  abbe_rgb_encoding_display_p3(xy, curve);
  assert_true(abbe_rgb_encoding_is_known(xy, curve) && !abbe_rgb_encoding_is_srgb(xy, curve));
  assert_false(abbe_rgb_encoding_is_known(none, curve));
  assert_false(abbe_rgb_encoding_is_known(xy, none));
}

/* What a display of this encoding would make of the probes. */
static void answer(const double xy[8], const double curve[5], float xyz[][3]) {
  double to_xyz[9];
  abbe_rgb_encoding_probes(xyz);
  OK(abbe_rgb_space_chromaticities_to_xyz(xy, to_xyz, &error));
  for (int i = 0; i < ABBE_RGB_ENCODING_PROBES; i++) {
    double v[3];
    for (int c = 0; c < 3; c++) v[c] = abbe_rgb_encoding_light(curve, (double)xyz[i][c]);
    abbe_rgb_space_apply(to_xyz, v, v);
    for (int c = 0; c < 3; c++) xyz[i][c] = (float)v[c];
  }
}

TEST(probes_find_the_encoding) {
  double xy[3][8], curve[3][5] = {{0}, {0}, {2.4, 1, 0, 0, 0}};
  abbe_rgb_encoding_srgb(xy[0], curve[0]);
  abbe_rgb_encoding_display_p3(xy[1], curve[1]);
  memcpy(xy[2], xy[0], sizeof xy[2]);
  for (int i = 0; i < 3; i++) {
    float xyz[ABBE_RGB_ENCODING_PROBES][3];
    double found_xy[8], found_curve[5];
    answer(xy[i], curve[i], xyz);
    assert_true(abbe_rgb_encoding_of_probes((const float(*)[3])xyz, found_xy, found_curve));
    for (int k = 0; k < 8; k++) assert_near(found_xy[k], xy[i][k], 1e-5);
    for (int k = 0; k < 5; k++) assert_near(found_curve[k], curve[i][k], 1e-4);
  }
}

/* The curves of the codes of [H273]: a grey's light by each standard's own formula. */
TEST(codes_say_primaries_and_curve) {
  static const struct {
    int transfer;
    double low, middle; /* the light of 0.04 and of 0.5; below 0: no such code */
  } rows[] = {{1, 0.04 / 4.5, 0.25959},
              {6, 0.04 / 4.5, 0.25959},
              {14, 0.04 / 4.5, 0.25959},
              {15, 0.04 / 4.5, 0.25959},
              {4, 8.4049e-4, 0.21764},
              {5, 1.2184e-4, 0.14359},
              {8, 0.04, 0.5},
              {13, 0.04 / 12.92, 0.21404},
              {2, -1, 0},
              {3, -1, 0},
              {7, -1, 0},
              {17, -1, 0}};
  static const int primaries[] = {1, 9, 12, 2, 0, 13};
  static const double red[] = {0.64, 0.708, 0.68};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    for (int p = 0; p < 6; p++) {
      double xy[8] = {0}, curve[5] = {0};
      const bool known = p < 3 && rows[i].low > 0;
      assert_int_equal(abbe_rgb_encoding_of_codes(primaries[p], rows[i].transfer, xy, curve),
                       known);
      if (!known) continue;
      assert_near(xy[0], red[p], 1e-12);
      assert_int_equal(abbe_rgb_encoding_primaries_code(xy), primaries[p]);
      assert_near(abbe_rgb_encoding_light(curve, 0.04), rows[i].low, 1e-7);
      assert_near(abbe_rgb_encoding_light(curve, 0.5), rows[i].middle, 1e-5);
    }
}

/* Greys by PQ or HLG, and primaries; a primary without light is none, in whatever curve. */
TEST(hdr_probes_find_the_transfer) {
  static const double bt2020[8] = {0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329};
  for (int kind = 0; kind < 5; kind++) {
    float xyz[ABBE_RGB_ENCODING_PROBES][3], probe[ABBE_RGB_ENCODING_PROBES][3];
    const double linear[5] = {1, 1, 0, 0, 0}, white[3] = {0.9505, 1, 1.089};
    double xy[8], curve[5];
    int transfer = -1;
    answer(bt2020, linear, xyz);
    abbe_rgb_encoding_probes(probe);
    for (int i = 8; i < ABBE_RGB_ENCODING_PROBES && kind < 4; i++) {
      const double v = (double)probe[i][0];
      const double hlg =
          v <= 0.5 ? v * v / 3 : (exp((v - 0.55991073) / 0.17883277) + 0.28466892) / 12;
      const double pq = abbe_difference_pq_light(v) / 1e4;
      for (int c = 0; c < 3; c++)
        xyz[i][c] = (float)(white[c] * (kind % 2 == 0 ? pq : pow(hlg, 1.2)));
    }
    for (int c = 0; c < 3 && kind >= 2; c++) { /* red has no light, and green has all */
      xyz[1][c] = xyz[3][c] = xyz[5][c] = xyz[7][c] = 0;
      xyz[2][c] = xyz[4][c];
      xyz[6][c] = 0.5F * xyz[4][c];
    }
    const float(*probes)[3] = (const float(*)[3])xyz;
    assert_int_equal(abbe_rgb_encoding_of_hdr_probes(probes, xy, &transfer), kind < 2);
    assert_int_equal(transfer, kind == 0 ? 16 : kind == 1 ? 18 : 0);
    for (int i = 0; i < 8; i++) assert_near(xy[i], kind < 2 ? bt2020[i] : 0, 1e-4);
    if (kind == 4) assert_false(abbe_rgb_encoding_of_probes(probes, xy, curve));
  }
}

/* [BT2100]: 58 % of PQ is reference white, and so is 75 % of HLG on a display of 1000 cd/m2; black
 * is black. */
TEST(light_of_hdr_numbers) {
  static const double luminance[3] = {0.2627, 0.678, 0.0593};
  for (int transfer = 16; transfer <= 18; transfer += 2) {
    double rgb[3] = {0.5807, 0.5807, 0.5807}, black[3] = {0};
    if (transfer == 18) rgb[0] = rgb[1] = rgb[2] = 0.75;
    abbe_rgb_encoding_hdr_light(transfer, luminance, rgb);
    abbe_rgb_encoding_hdr_light(transfer, luminance, black);
    for (int k = 0; k < 3; k++) {
      assert_near(rgb[k], 1, 5e-3);
      assert_near(black[k], 0, 1e-9);
    }
  }
}

/* Each breaks one thing that an encoding of this form has. */
TEST(probes_of_something_else) {
  for (int broken = 0; broken < 9; broken++) {
    double xy[8], curve[5];
    float xyz[ABBE_RGB_ENCODING_PROBES][3];
    abbe_rgb_encoding_srgb(xy, curve);
    answer(xy, curve, xyz);
    for (int i = 0; i < ABBE_RGB_ENCODING_PROBES; i++)
      for (int c = 0; c < 3; c++) {
        if (broken == 0) xyz[i][c] *= 100;              /* PQ's unit */
        if (broken == 1) xyz[i][c] += 0.01f;            /* black is lit */
        if (broken == 2 && i == 1) xyz[i][c] *= 1.02f;  /* red does not add up */
        if (broken == 3 && i == 20) xyz[i][c] += 2e-3f; /* the greys have a step */
        if (broken == 4 && i == 6) xyz[i][c] *= 1.02f;  /* half a green is another curve's */
        if (broken == 5) xyz[i][c] = NAN;
        if (broken == 6 && i >= 8 && i < 40) xyz[i][c] = 0; /* greys without light */
        if (broken == 7 && i >= 8 && i < 40) xyz[i][c] = 1; /* or with all of it */
        if (broken == 8 && i == 0) xyz[i][c] = 2e-3f;       /* black alone is lit */
      }
    const float(*probes)[3] = (const float(*)[3])xyz;
    assert_false(abbe_rgb_encoding_of_probes(probes, xy, curve));
    assert_false(abbe_rgb_encoding_is_known(xy, curve));
  }
}

/* The profile as another program opens it. */
TEST(the_profile_of_display_p3) {
  double xy[8], curve[5];
  void *icc[2];
  size_t size[2];
  abbe_rgb_encoding_display_p3(xy, curve);
  for (int i = 0; i < 2; i++) OK(abbe_rgb_encoding_profile(xy, curve, &icc[i], &size[i], &error));
  assert_int_equal(size[0], size[1]);
  assert_memory_equal(icc[0], icc[1], size[0]);
  cmsHPROFILE profile = cmsOpenProfileFromMem(icc[0], (cmsUInt32Number)size[0]);
  assert_non_null(profile);
  char text[40];
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text, sizeof text);
  assert_string_equal(text, "Display P3");
  /* as in the profiles that makers of displays ship */
  static const double columns[3][3] = {
      {0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}};
  static const cmsTagSignature tags[] = {cmsSigRedColorantTag, cmsSigGreenColorantTag,
                                         cmsSigBlueColorantTag};
  for (int c = 0; c < 3; c++) {
    const cmsCIEXYZ *v = cmsReadTag(profile, tags[c]);
    assert_near(v->X, columns[c][0], 3e-5);
    assert_near(v->Y, columns[c][1], 3e-5);
    assert_near(v->Z, columns[c][2], 3e-5);
  }
  const cmsToneCurve *tone = cmsReadTag(profile, cmsSigGreenTRCTag);
  assert_near((double)cmsEvalToneCurveFloat(tone, 0.5f), 0.21404114, 1e-5);
  assert_near((double)cmsEvalToneCurveFloat(tone, 0.02f), 0.02 / 12.92, 1e-6);
  cmsCloseProfile(profile);
  free(icc[0]);
  free(icc[1]);
  const double none[8] = {0};
  assert_int_equal(abbe_rgb_encoding_profile(none, none, &icc[0], &size[0], NULL), ABBE_COLOUR);
  assert_null(icc[0]);
}

/* By formula and by Little CMS through the profile: the same. */
TEST(to_srgb_in_two_ways) {
  double xy[8], curve[5];
  FREED void *icc = NULL;
  size_t size = 0;
  abbe_rgb_encoding_display_p3(xy, curve);
  OK(abbe_rgb_encoding_profile(xy, curve, &icc, &size, &error));
  uint64_t seed = 7;
  for (int i = 0; i < 200; i++) {
    double v[3];
    for (int c = 0; c < 3; c++) v[c] = random_between(&seed, 0, 1);
    OWNED(abbe_image, a) = one_pixel(v[0], v[1], v[2]);
    abbe_image b = one_pixel(v[0], v[1], v[2]);
    memcpy(a.xy, xy, sizeof xy);
    memcpy(a.curve, curve, sizeof curve);
    OK(abbe_rgb_encoding_to_srgb(&a, "a", &error));
    OK(abbe_rgb_encoding_profile_to_srgb(&b, icc, size, "b", &error));
    pixel_is(&b, (double)a.data[0], (double)a.data[1], (double)a.data[2], 1.5e-3);
  }
  /* Rec.709's red, as published for CSS colours, and a red that sRGB cannot hold */
  abbe_image red = one_pixel(0.91749, 0.20029, 0.13856);
  OK(abbe_rgb_encoding_profile_to_srgb(&red, icc, size, "red", &error));
  pixel_is(&red, 1, 0, 0, 4e-3);
  red = one_pixel(1, 0, 0);
  OK(abbe_rgb_encoding_profile_to_srgb(&red, icc, size, "red", &error));
  pixel_is(&red, 1, 0, 0, 0);
}

static void *saved(cmsHPROFILE profile, cmsUInt32Number *size) {
  assert_true(profile != NULL && cmsSaveProfileToMem(profile, NULL, size));
  void *icc = malloc(*size);
  assert_true(icc != NULL && cmsSaveProfileToMem(profile, icc, size));
  cmsCloseProfile(profile);
  return icc;
}

/* A curve of another display with P3's primaries is not called by its name. */
TEST(a_profile_of_some_display) {
  double xy[8], curve[5] = {2.2, 1, 0, 0, 0}, p3[5];
  FREED void *icc = NULL;
  size_t size = 0;
  char text[40];
  abbe_rgb_encoding_display_p3(xy, p3);
  OK(abbe_rgb_encoding_profile(xy, curve, &icc, &size, &error));
  cmsHPROFILE profile = cmsOpenProfileFromMem(icc, (cmsUInt32Number)size);
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", text, sizeof text);
  cmsCloseProfile(profile);
  assert_string_equal(text, "RGB of a display");
  OWNED(abbe_image, two) = {0};
  OK(abbe_image_make(1, 1, 2, names, &two, &error));
  memcpy(two.xy, xy, sizeof xy);
  memcpy(two.curve, curve, sizeof curve);
  REFUSED(ABBE_INVALID_ARGUMENT, "two.png", abbe_rgb_encoding_to_srgb(&two, "two.png", &error));
  REFUSED(ABBE_COLOUR, "two.png",
          abbe_rgb_encoding_profile_to_srgb(&two, icc, size, "two.png", &error));
}

TEST(other_profiles) {
  cmsUInt32Number size = 0;
  cmsToneCurve *linear = cmsBuildGamma(NULL, 1);
  FREED void *icc = saved(cmsCreateGrayProfile(cmsD50_xyY(), linear), &size);
  cmsFreeToneCurve(linear);
  abbe_image grey = one_pixel(0.5, 0.5, 0.5);
  OK(abbe_rgb_encoding_profile_to_srgb(&grey, icc, size, "grey", &error));
  pixel_is(&grey, 0.73536, 0.73536, 0.73536, 1e-3);
  OWNED(abbe_image, image) = one_pixel(0.5, 0.5, 0.5);
  REFUSED(ABBE_COLOUR, "cut.png",
          abbe_rgb_encoding_profile_to_srgb(&image, icc, 100, "cut.png", &error));
  free(icc);
  icc = saved(cmsCreateLab4Profile(NULL), &size);
  assert_int_equal(abbe_rgb_encoding_profile_to_srgb(&image, icc, size, "lab", NULL), ABBE_COLOUR);
  REFUSED(ABBE_INVALID_ARGUMENT, "unstated.png",
          abbe_rgb_encoding_to_srgb(&image, "unstated.png", &error));
  abbe_rgb_encoding_srgb(image.xy, image.curve);
  image.xy[1] = image.xy[3] = image.xy[5] = 0.3; /* primaries on a line */
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_rgb_encoding_to_srgb(&image, "line.png", &error));
}
