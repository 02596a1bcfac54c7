#include "colorimetry/image/rgb_encoding.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/difference.h"
#include "colorimetry/gamut.h"
#include "colorimetry/rgb_space.h"

#include <lcms2.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double srgb_curve[5] = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};

void abbe_rgb_encoding_srgb(double xy[8], double curve[5]) {
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, xy);
  memcpy(curve, srgb_curve, sizeof srgb_curve);
}

void abbe_rgb_encoding_display_p3(double xy[8], double curve[5]) {
  static const double p3[8] = {0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.3290};
  memcpy(xy, p3, sizeof p3);
  memcpy(curve, srgb_curve, sizeof srgb_curve);
}

bool abbe_rgb_encoding_is_known(const double xy[8], const double curve[5]) {
  return xy[7] > 0 && curve[0] > 0;
}

static bool same(const double *a, const double *b, int count, double tolerance) {
  for (int i = 0; i < count; i++)
    if (!(fabs(a[i] - b[i]) <= tolerance)) return false;
  return true;
}

bool abbe_rgb_encoding_is_srgb(const double xy[8], const double curve[5]) {
  double right[8], srgb[5];
  abbe_rgb_encoding_srgb(right, srgb);
  return same(xy, right, 8, 1e-3) && same(curve, srgb, 5, 1e-6);
}

double abbe_rgb_encoding_light(const double curve[5], double value) {
  return value < curve[4] ? curve[3] * value : pow(fmax(curve[1] * value + curve[2], 0), curve[0]);
}

/* Probes: black, red, green, blue, white, each primary at half its number, then greys. */

enum { WHITE = 4, HALVES = 5, GREYS = 8, LAST = ABBE_RGB_ENCODING_PROBES - 1 };

static float grey(int probe) {
  return (float)(probe - GREYS) / (LAST - GREYS);
}

void abbe_rgb_encoding_probes(float rgb[ABBE_RGB_ENCODING_PROBES][3]) {
  memset(rgb, 0, ABBE_RGB_ENCODING_PROBES * sizeof *rgb);
  for (int c = 0; c < 3; c++) {
    rgb[1 + c][c] = rgb[WHITE][c] = 1;
    rgb[HALVES + c][c] = 0.5f;
    for (int i = GREYS; i <= LAST; i++) rgb[i][c] = grey(i);
  }
}

/* The curve, sRGB's or a power, that the greys follow. */
static bool fit_curve(const float xyz[ABBE_RGB_ENCODING_PROBES][3], double curve[5]) {
  const double middle = (double)xyz[(GREYS + LAST) / 2][1], at = (double)grey((GREYS + LAST) / 2);
  const double power[5] = {middle > 0 && middle < 1 ? log(middle) / log(at) : 0, 1, 0, 0, 0};
  const double *const form[] = {srgb_curve, power};
  for (int f = 0; f < 2; f++) {
    bool follows = form[f][0] > 0;
    for (int i = GREYS; follows && i <= LAST; i++)
      follows = fabs(abbe_rgb_encoding_light(form[f], (double)grey(i)) - (double)xyz[i][1]) < 5e-4;
    if (follows) memcpy(curve, form[f], 5 * sizeof *curve);
    if (follows) return true;
  }
  return false;
}

bool abbe_rgb_encoding_of_probes(const float xyz[ABBE_RGB_ENCODING_PROBES][3], double xy[8],
                                 double curve[5]) {
  memset(xy, 0, 8 * sizeof *xy);
  memset(curve, 0, 5 * sizeof *curve);
  double fitted[5];
  bool sound = fabs((double)xyz[WHITE][1] - 1) < 5e-3 && fit_curve(xyz, fitted);
  const double half = sound ? abbe_rgb_encoding_light(fitted, 0.5) : 0;
  for (int k = 0; sound && k < 3; k++) {
    sound =
        fabs((double)xyz[0][k]) < 1e-3 && fabs((double)xyz[1][k] + (double)xyz[2][k] +
                                               (double)xyz[3][k] - (double)xyz[WHITE][k]) < 2e-3;
    for (int c = 0; c < 3; c++)
      sound = sound && fabs((double)xyz[HALVES + c][k] - half * (double)xyz[1 + c][k]) < 1e-3;
  }
  if (!sound) return false;
  for (int c = 0; c < 4; c++) {
    const float *v = xyz[1 + c];
    const double sum = (double)v[0] + (double)v[1] + (double)v[2];
    if (!(sum > 0)) {
      memset(xy, 0, 8 * sizeof *xy);
      return false;
    }
    xy[2 * c] = (double)v[0] / sum;
    xy[2 * c + 1] = (double)v[1] / sum;
  }
  memcpy(curve, fitted, sizeof fitted);
  return true;
}

/* Light of a grey of the number, relative to the greatest, by [BT2100]. */
static double pq_share(double value) {
  return abbe_difference_pq_light(value) / 10000;
}

static double hlg_scene(double value) {
  const double a = 0.17883277, b = 0.28466892, c = 0.55991073;
  return value <= 0.5 ? value * value / 3 : (exp((value - c) / a) + b) / 12;
}

/* With the system gamma of a display of 1000 cd/m2. */
#define HLG_GAMMA 1.2
static double hlg_share(double value) {
  return pow(hlg_scene(value), HLG_GAMMA);
}

void abbe_rgb_encoding_hdr_light(int transfer, const double luminance[3], double rgb[3]) {
  const double white = 203;
  double y = 0;
  for (int k = 0; k < 3; k++) {
    rgb[k] = transfer == 16 ? abbe_difference_pq_light(rgb[k]) / white : hlg_scene(rgb[k]);
    y += luminance[k] * rgb[k];
  }
  for (int k = 0; k < 3 && transfer != 16; k++)
    rgb[k] *= y > 0 ? pow(y, HLG_GAMMA - 1) * 1000 / white : 0;
}

static bool follows(const float xyz[ABBE_RGB_ENCODING_PROBES][3], double (*share)(double)) {
  const double white = (double)xyz[WHITE][1];
  for (int i = GREYS; i <= LAST; i++) {
    const double expected = share((double)grey(i)), got = (double)xyz[i][1] / white;
    if (!(fabs(got - expected) <= 0.01 * expected + 1e-6)) return false;
  }
  return white > 0;
}

bool abbe_rgb_encoding_of_hdr_probes(const float xyz[ABBE_RGB_ENCODING_PROBES][3], double xy[8],
                                     int *transfer) {
  memset(xy, 0, 8 * sizeof *xy);
  *transfer = follows(xyz, pq_share) ? 16 : follows(xyz, hlg_share) ? 18 : 0;
  for (int c = 0; c < 4 && *transfer != 0; c++) {
    const double v[3] = {(double)xyz[1 + c][0], (double)xyz[1 + c][1], (double)xyz[1 + c][2]};
    if (abbe_chromaticity_xy(v, xy + 2 * c)) continue;
    memset(xy, 0, 8 * sizeof *xy);
    *transfer = 0;
  }
  return *transfer != 0;
}

int abbe_rgb_encoding_primaries_code(const double xy[8]) {
  static const struct {
    abbe_gamut gamut;
    int code;
  } codes[] = {{ABBE_GAMUT_REC709, 1}, {ABBE_GAMUT_REC2020, 9}, {ABBE_GAMUT_P3, 12}};
  for (int i = 0; i < 3; i++) {
    double known[8];
    abbe_gamut_chromaticities(codes[i].gamut, known);
    if (same(xy, known, 8, 1e-3)) return codes[i].code;
  }
  return 0;
}

bool abbe_rgb_encoding_of_codes(int primaries, int transfer, double xy[8], double curve[5]) {
  static const abbe_gamut gamuts[] = {
      [1] = ABBE_GAMUT_REC709, [9] = ABBE_GAMUT_REC2020, [12] = ABBE_GAMUT_P3};
  static const struct {
    int code;
    double curve[5];
  } transfers[] = {{1, {1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081}},
                   {4, {2.2, 1, 0, 0, 0}},
                   {5, {2.8, 1, 0, 0, 0}},
                   {8, {1, 1, 0, 0, 0}},
                   {13, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}}};
  const int code = transfer == 6 || transfer == 14 || transfer == 15 ? 1 : transfer;
  bool found = code == 16 || code == 18;
  if (primaries != 1 && primaries != 9 && primaries != 12) return false;
  abbe_gamut_chromaticities(gamuts[primaries], xy);
  for (size_t i = 0; i < sizeof transfers / sizeof *transfers; i++) {
    if (transfers[i].code != code) continue;
    memcpy(curve, transfers[i].curve, sizeof transfers[i].curve);
    found = true;
  }
  return found;
}

/* Profiles */

static abbe_result no_profile(abbe_error *error) {
  return abbe_error_set(error, ABBE_COLOUR, "Little CMS makes no ICC profile of an encoding");
}

static cmsHPROFILE make_profile(const double xy[8], const double curve[5]) {
  double p3_xy[8], p3_curve[5];
  abbe_rgb_encoding_display_p3(p3_xy, p3_curve);
  const bool p3 = same(xy, p3_xy, 8, 1e-3) && same(curve, p3_curve, 5, 1e-6);
  const cmsCIExyY white = {xy[6], xy[7], 1};
  const cmsCIExyYTRIPLE primaries = {{xy[0], xy[1], 1}, {xy[2], xy[3], 1}, {xy[4], xy[5], 1}};
  cmsToneCurve *one = cmsBuildParametricToneCurve(NULL, 4, curve);
  cmsToneCurve *const all[3] = {one, one, one};
  cmsHPROFILE profile = one == NULL ? NULL : cmsCreateRGBProfile(&white, &primaries, all);
  cmsFreeToneCurve(one);
  if (profile == NULL) return NULL;
  cmsMLU *text = cmsMLUalloc(NULL, 1);
  if (text == NULL) cmsCloseProfile(profile);
  if (text == NULL) return NULL;
  cmsMLUsetASCII(text, "en", "US", p3 ? "Display P3" : "RGB of a display");
  cmsWriteTag(profile, cmsSigProfileDescriptionTag, text);
  cmsMLUsetASCII(text, "en", "US", "No copyright, use freely");
  cmsWriteTag(profile, cmsSigCopyrightTag, text);
  cmsMLUfree(text);
  return profile;
}

/* The time of making is a profile's bytes 24 to 35: that of this form, for equal bytes each time.
 */
static void fix_date(unsigned char *icc) {
  static const unsigned char date[12] = {0x07, 0xe8, 0, 1, 0, 1}; /* 2024-01-01 0:00:00 */
  memcpy(icc + 24, date, sizeof date);
}

abbe_result abbe_rgb_encoding_profile(const double xy[8], const double curve[5], void **icc,
                                      size_t *size, abbe_error *error) {
  *icc = NULL;
  *size = 0;
  cmsHPROFILE profile = abbe_rgb_encoding_is_known(xy, curve) ? make_profile(xy, curve) : NULL;
  if (profile == NULL) return no_profile(error);
  cmsUInt32Number bytes = 0;
  void *made = NULL;
  abbe_result result = cmsSaveProfileToMem(profile, NULL, &bytes) ? ABBE_OK : no_profile(error);
  if (result == ABBE_OK && (made = malloc(bytes)) == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an ICC profile");
  if (result == ABBE_OK && !cmsSaveProfileToMem(profile, made, &bytes)) result = no_profile(error);
  if (result == ABBE_OK) {
    fix_date(made);
    *icc = made;
    *size = bytes;
  } else {
    free(made);
  }
  cmsCloseProfile(profile);
  return result;
}

/* To sRGB */

static void become_srgb(abbe_image *image) {
  const size_t count = image->width * image->height * image->channels;
  for (size_t i = 0; i < count; i++) {
    const float v = image->data[i];
    image->data[i] = v >= 1 ? 1 : v > 0 ? v : 0; /* not-a-number too */
  }
  abbe_rgb_encoding_srgb(image->xy, image->curve);
}

static double srgb_of(double light) {
  return light <= srgb_curve[4] * srgb_curve[3] ? 12.92 * light
                                                : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

abbe_result abbe_rgb_encoding_to_srgb(abbe_image *image, const char *name, abbe_error *error) {
  double to_xyz[9], from_xyz[9];
  abbe_error why = {0};
  if (image->channels != 3 || !abbe_rgb_encoding_is_known(image->xy, image->curve) ||
      abbe_rgb_space_chromaticities_to_xyz(image->xy, to_xyz, &why) != ABBE_OK)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its chromaticities and curve are of no RGB encoding%s%.300s", name,
                          why.text[0] ? ": " : "", why.text);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  for (size_t i = 0; i < image->width * image->height; i++) {
    float *pixel = image->data + 3 * i;
    double v[3];
    for (int c = 0; c < 3; c++) v[c] = abbe_rgb_encoding_light(image->curve, (double)pixel[c]);
    abbe_rgb_space_apply(to_xyz, v, v);
    abbe_rgb_space_apply(from_xyz, v, v);
    for (int c = 0; c < 3; c++) pixel[c] = (float)srgb_of(v[c]);
  }
  become_srgb(image);
  return ABBE_OK;
}

abbe_result abbe_rgb_encoding_profile_to_srgb(abbe_image *image, const void *icc, size_t size,
                                              const char *name, abbe_error *error) {
  const cmsUInt32Number one = FLOAT_SH(1) | CHANNELS_SH(1) | EXTRA_SH(2) | BYTES_SH(4);
  cmsHPROFILE from = cmsOpenProfileFromMem(icc, (cmsUInt32Number)size);
  cmsHPROFILE to = cmsCreate_sRGBProfile();
  const cmsColorSpaceSignature space = from == NULL ? 0 : cmsGetColorSpace(from);
  cmsHTRANSFORM transform = NULL;
  if (to != NULL && image->channels == 3 && (space == cmsSigRgbData || space == cmsSigGrayData))
    transform = cmsCreateTransform(
        from, space == cmsSigRgbData ? TYPE_RGB_FLT : one | COLORSPACE_SH(PT_GRAY), to,
        TYPE_RGB_FLT, INTENT_RELATIVE_COLORIMETRIC, cmsFLAGS_NOCACHE);
  for (size_t y = 0; transform != NULL && y < image->height; y++) {
    float *row = image->data + 3 * image->width * y;
    cmsDoTransform(transform, row, row, (cmsUInt32Number)image->width);
  }
  const bool done = transform != NULL;
  if (done) become_srgb(image);
  if (done) cmsDeleteTransform(transform);
  if (from != NULL) cmsCloseProfile(from);
  if (to != NULL) cmsCloseProfile(to);
  if (done) return ABBE_OK;
  return abbe_error_set(error, ABBE_COLOUR,
                        "%s: its ICC profile cannot be used; one for RGB or grey can, or none for "
                        "sRGB",
                        name);
}
