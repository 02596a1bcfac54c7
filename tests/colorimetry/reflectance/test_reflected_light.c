#include "tests/check.h"

#include "colorimetry/observer.h"
#include "colorimetry/reflectance/reflected_light.h"
#include "colorimetry/rgb_space.h"
#include "tests/random.h"

HOLDS(abbe_spectrum);
HOLDS(abbe_reflected_light);

static abbe_reflected_light *make(const char *name, double min_nm, double max_nm,
                                  abbe_illuminant *illuminant) {
  abbe_reflected_light *light = NULL;
  OK(abbe_illuminant_make(name, illuminant, &error));
  OK(abbe_reflected_light_make(illuminant, min_nm, max_nm, &light, &error));
  return light;
}

/* A sum over tenths of a nanometre, written down here alone. */
static void integrate(const abbe_illuminant *illuminant, const abbe_spectrum *measured,
                      double xyz[3]) {
  double white = 0;
  for (int k = 0; k < 3; k++) xyz[k] = 0;
  for (double nm = 380.05; nm < 780; nm += 0.1) {
    double observer[3];
    const double power = abbe_illuminant_power(illuminant, nm);
    abbe_observer_xyz(nm, observer);
    white += power * observer[1];
    for (int k = 0; k < 3; k++) xyz[k] += power * observer[k] * abbe_spectrum_at(measured, nm);
  }
  for (int k = 0; k < 3; k++) xyz[k] /= white;
}

TEST(measured_patches_are_integrals) {
  static const char *const lights[] = {"D65", "A", "F11", "LED-RGB1"};
  for (size_t l = 0; l < 4; l++) {
    OWNED(abbe_illuminant, illuminant);
    HELD(abbe_reflected_light, light) = make(lights[l], 380, 780, &illuminant);
    for (size_t p = 0; p < ABBE_COLOUR_CHECKER_COUNT; p++) {
      HELD(abbe_spectrum, patch) = NULL;
      double wanted[3], xyz[3][3], matrix[3][9], white[3], seen[3];
      OK(abbe_colour_checker_make(abbe_colour_checker_name(p), &patch, &error));
      integrate(&illuminant, patch, wanted);
      abbe_reflected_light_xyz(light, patch, xyz);
      abbe_reflected_light_matrices(light, patch, matrix);
      abbe_reflected_light_white(light, white);
      abbe_rgb_space_apply(matrix[0], white, seen);
      for (int k = 0; k < 3; k++) {
        assert_near(xyz[0][k], wanted[k], 3e-5);
        assert_near(seen[k], xyz[0][k], 1e-9);
        assert_near(xyz[1][k], 0, 0);
      }
    }
  }
}

/* Under D65 a Rec.709 colour reflects that colour, as near as the table's white is to the nominal
 * one; greys are grey under any light. */
TEST(rec709_under_d65_is_itself) {
  OWNED(abbe_illuminant, illuminant);
  HELD(abbe_reflected_light, light) = make("D65", 380, 780, &illuminant);
  double xyz[3][3], to_xyz[9], white[3];
  abbe_reflected_light_xyz(light, NULL, xyz);
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) assert_near(xyz[j][k], to_xyz[3 * k + j], 5.5e-4);
  abbe_reflected_light_free(light);
  light = make("F11", 380, 780, &illuminant);
  abbe_reflected_light_xyz(light, NULL, xyz);
  abbe_reflected_light_white(light, white);
  for (int k = 0; k < 3; k++) assert_near(xyz[0][k] + xyz[1][k] + xyz[2][k], white[k], 1e-12);
}

/* The matrices of red, green and blue add up to no change at all. */
TEST(white_changes_no_light) {
  abbe_illuminant illuminant;
  HELD(abbe_reflected_light, light) = make("A", 400, 700, &illuminant);
  double matrix[3][9];
  abbe_reflected_light_matrices(light, NULL, matrix);
  for (int i = 0; i < 9; i++)
    assert_near(matrix[0][i] + matrix[1][i] + matrix[2][i], i % 4 == 0, 1e-9);
}

TEST(narrow_lights_and_bad_ranges) {
  abbe_illuminant illuminant;
  abbe_reflected_light *light = make("D65", 640, 640.5, &illuminant);
  double matrix[3][9];
  abbe_reflected_light_matrices(light, NULL, matrix);
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 9; i++) assert_true(isfinite(matrix[j][i]));
  assert_true(matrix[0][4] > 0.5 && matrix[2][4] < 0.1);
  abbe_reflected_light_free(light);
  light = make("D65", 900, 1000, &illuminant);
  abbe_reflected_light_matrices(light, NULL, matrix);
  for (int i = 0; i < 9; i++) assert_near(matrix[0][i], 0, 0);
  abbe_reflected_light_free(light);
  static const double bad[][2] = {{500, 500}, {700, 400}, {0, 700}, {NAN, 700}, {400, INFINITY}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_int_equal(abbe_reflected_light_make(&illuminant, bad[i][0], bad[i][1], &light, NULL),
                     ABBE_INVALID_ARGUMENT);
    assert_null(light);
  }
}

static abbe_spectrum *colour_checker_make(const char *name) {
  abbe_spectrum *spectrum = NULL;
  OK(abbe_colour_checker_make(name, &spectrum, &error));
  return spectrum;
}

/* x, y, Y under C as the chart's makers printed them [McCamy1976]; the chart that was measured is
 * another one, so a patch may be off by what charts differ: a tenth of the distance between any two
 * chromatic patches. */
TEST(colours_are_near_the_printed_ones) {
  static const double printed[ABBE_COLOUR_CHECKER_COUNT][3] = {
      {0.4002, 0.3504, 0.1005}, {0.3773, 0.3446, 0.3582}, {0.2470, 0.2514, 0.1933},
      {0.3372, 0.4220, 0.1329}, {0.2651, 0.2400, 0.2427}, {0.2608, 0.3430, 0.4306},
      {0.5060, 0.4070, 0.3005}, {0.2110, 0.1750, 0.1200}, {0.4533, 0.3058, 0.1977},
      {0.2845, 0.2020, 0.0656}, {0.3800, 0.4887, 0.4429}, {0.4729, 0.4375, 0.4306},
      {0.1866, 0.1285, 0.0611}, {0.3046, 0.4782, 0.2339}, {0.5385, 0.3129, 0.1200},
      {0.4480, 0.4703, 0.5910}, {0.3635, 0.2325, 0.1977}, {0.1958, 0.2519, 0.1977},
      {0.3101, 0.3163, 0.9001}, {0.3101, 0.3163, 0.5910}, {0.3101, 0.3163, 0.3620},
      {0.3101, 0.3163, 0.1977}, {0.3101, 0.3163, 0.0900}, {0.3101, 0.3163, 0.0313}};
  HELD(abbe_reflected_light, light) = NULL;
  MADE(abbe_illuminant, c, abbe_illuminant_make("C", &c, &error));
  OK(abbe_reflected_light_make(&c, 360, 830, &light, &error));
  for (size_t i = 0; i < ABBE_COLOUR_CHECKER_COUNT; i++) {
    HELD(abbe_spectrum, spectrum) = colour_checker_make(abbe_colour_checker_name(i));
    double xyz[3][3];
    abbe_reflected_light_xyz(light, spectrum, xyz);
    const double sum = xyz[0][0] + xyz[0][1] + xyz[0][2];
    const double off[3] = {xyz[0][0] / sum - printed[i][0], xyz[0][1] / sum - printed[i][1],
                           xyz[0][1] - printed[i][2]};
    if (fabs(off[0]) > 0.0085 || fabs(off[1]) > 0.0055 || fabs(off[2]) > 0.0135)
      fail_msg("%s: off by %.4f, %.4f, %.4f", abbe_colour_checker_name(i), off[0], off[1], off[2]);
  }
}

/* The mean of 30 charts, thousandths from 380 nm on in steps of 10 nm, and its own x, y, Y under
 * D50 as its maker printed both [BabelColor]: what is computed here of the one is the other, but
 * for the third decimal of the reflectances. */
enum { MEAN_POINTS = 36 };
static const unsigned short mean[ABBE_COLOUR_CHECKER_COUNT][MEAN_POINTS] = {
    {55, 58,  61,  62,  62,  62,  62,  62,  62,  62,  62,  63,  65,  70,  76,  79,  81,  84,
     91, 103, 119, 134, 143, 147, 151, 158, 168, 179, 188, 190, 186, 181, 182, 187, 196, 209},
    {117, 143, 175, 191, 196, 199, 204, 213, 228, 251, 280, 309, 329, 333, 315, 286, 273, 276,
     277, 289, 339, 420, 488, 525, 546, 562, 578, 595, 612, 625, 638, 656, 678, 700, 717, 734},
    {130, 177, 251, 306, 324, 330, 333, 331, 323, 311, 298, 285, 269, 250, 231, 214, 199, 185,
     169, 157, 149, 145, 142, 141, 141, 141, 143, 147, 152, 154, 150, 144, 136, 132, 135, 147},
    {51,  54,  56,  57,  58,  59,  60,  61,  62,  63,  65,  67,  75,  101, 145, 178, 184, 170,
     149, 133, 122, 115, 109, 105, 104, 106, 109, 112, 114, 114, 112, 112, 115, 120, 125, 130},
    {144, 198, 294, 375, 408, 421, 426, 426, 419, 403, 379, 346, 311, 281, 254, 229, 214, 208,
     202, 194, 193, 200, 214, 230, 241, 254, 279, 313, 348, 366, 366, 359, 358, 365, 377, 398},
    {136, 179, 247, 297, 320, 337, 355, 381, 419, 466, 510, 546, 567, 574, 569, 551, 524, 488,
     445, 400, 350, 299, 252, 221, 204, 196, 191, 188, 191, 199, 212, 223, 232, 233, 229, 229},
    {54,  54,  53,  54,  54,  55,  55,  55,  56,  57,  58,  61,  68,  89,  125, 154, 174, 199,
     248, 335, 444, 538, 587, 595, 591, 587, 584, 584, 590, 603, 620, 639, 655, 663, 663, 667},
    {122, 164, 229, 286, 327, 361, 388, 400, 392, 362, 316, 260, 209, 168, 138, 117, 104, 96,
     90,  86,  84,  84,  84,  84,  84,  85,  90,  98,  109, 123, 143, 169, 205, 244, 287, 332},
    {96, 115, 131, 135, 133, 132, 130, 128, 125, 120, 115, 110, 105, 100, 95,  93,  92,  93,
     96, 108, 156, 265, 399, 500, 556, 579, 588, 591, 593, 594, 598, 602, 607, 609, 609, 610},
    {92, 116, 146, 169, 178, 173, 158, 139, 119, 101, 87,  75,  66,  60,  56,  53,  51,  51,
     52, 52,  51,  52,  58,  73,  96,  119, 141, 166, 194, 227, 265, 309, 355, 396, 436, 478},
    {61,  61,  62,  63,  64,  66,  69,  75,  85,  105, 139, 192, 271, 376, 476, 531, 549, 546,
     528, 504, 471, 428, 381, 347, 327, 318, 312, 310, 314, 327, 345, 363, 376, 381, 378, 379},
    {63,  63,  63,  64,  64,  64,  65,  66,  67,  68,  71,  76,  87,  125, 206, 305, 383, 431,
     469, 518, 568, 607, 628, 637, 640, 642, 645, 648, 651, 653, 657, 664, 673, 680, 684, 688},
    {66, 79, 102, 146, 200, 244, 282, 309, 308, 278, 231, 178, 130, 94, 70, 54, 46, 42,
     39, 38, 38,  38,  38,  39,  39,  40,  41,  42,  44,  45,  46,  46, 48, 52, 57, 65},
    {52,  53,  54,  55,  57,  59,  61,  66, 75, 93, 125, 178, 246, 307, 337, 334, 317, 293,
     262, 230, 198, 165, 135, 115, 104, 98, 94, 92, 93,  97,  102, 108, 113, 115, 114, 114},
    {50, 49, 48, 47,  47,  47,  47,  47,  46,  45,  44,  44,  45,  46,  47,  48,  49,  50,
     54, 60, 72, 104, 178, 312, 467, 581, 644, 675, 690, 698, 706, 715, 724, 730, 734, 738},
    {58,  54,  52,  52,  53,  54,  56,  59,  67,  81,  107, 152, 225, 336, 462, 559, 616, 650,
     672, 694, 710, 723, 731, 739, 746, 752, 758, 764, 769, 771, 776, 782, 790, 796, 799, 804},
    {145, 195, 283, 346, 362, 354, 334, 306, 276, 248, 218, 190, 168, 149, 127, 107, 100, 102,
     104, 109, 137, 200, 290, 400, 516, 615, 687, 732, 760, 774, 783, 793, 803, 812, 817, 825},
    {108, 141, 192, 236, 261, 286, 317, 353, 390, 426, 446, 444, 423, 385, 337, 283, 231, 185,
     146, 118, 101, 90,  82,  76,  74,  73,  73,  74,  76,  77,  76,  75,  73,  72,  74,  79},
    {189, 255, 423, 660, 811, 862, 877, 884, 891, 896, 899, 904, 907, 909, 911, 910, 911, 914,
     913, 916, 915, 916, 914, 915, 918, 919, 921, 923, 924, 922, 922, 925, 927, 930, 930, 933},
    {171, 232, 365, 507, 567, 583, 588, 590, 591, 590, 588, 588, 589, 589, 591, 590, 590, 590,
     589, 591, 590, 590, 587, 585, 583, 580, 578, 576, 574, 572, 571, 569, 568, 568, 566, 566},
    {144, 192, 272, 331, 350, 357, 361, 363, 363, 361, 359, 358, 358, 359, 360, 360, 361, 361,
     360, 362, 362, 361, 359, 358, 355, 352, 350, 348, 345, 343, 340, 338, 335, 334, 332, 331},
    {105, 131, 163, 180, 186, 190, 193, 194, 194, 192, 191, 191, 191, 192, 192, 192, 192, 192,
     192, 193, 192, 192, 191, 189, 188, 186, 184, 182, 181, 179, 178, 176, 174, 173, 172, 171},
    {68, 77, 84, 87, 89, 90, 92, 92, 91, 90, 90, 90, 90, 90, 90, 90, 90, 90,
     90, 90, 90, 89, 89, 88, 87, 86, 86, 85, 84, 84, 83, 83, 82, 81, 81, 81},
    {31, 32, 32, 33, 33, 33, 33, 33, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32,
     32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 32, 33}};
static const double of_mean[ABBE_COLOUR_CHECKER_COUNT][3] = {
    {0.4325, 0.3788, 0.1034}, {0.4191, 0.3748, 0.3525}, {0.2761, 0.3004, 0.1847},
    {0.3700, 0.4501, 0.1335}, {0.3020, 0.2877, 0.2324}, {0.2856, 0.3910, 0.4174},
    {0.5291, 0.4075, 0.3117}, {0.2339, 0.2155, 0.1140}, {0.5008, 0.3293, 0.1979},
    {0.3326, 0.2556, 0.0644}, {0.3989, 0.4998, 0.4435}, {0.4962, 0.4428, 0.4358},
    {0.2040, 0.1696, 0.0579}, {0.3270, 0.5033, 0.2307}, {0.5709, 0.3298, 0.1268},
    {0.4694, 0.4732, 0.6081}, {0.4177, 0.2704, 0.2007}, {0.2151, 0.3037, 0.1903},
    {0.3488, 0.3628, 0.9129}, {0.3451, 0.3596, 0.5885}, {0.3446, 0.3590, 0.3595},
    {0.3438, 0.3589, 0.1912}, {0.3423, 0.3576, 0.0893}, {0.3439, 0.3565, 0.0320}};

TEST(a_printed_pair_is_computed) {
  double nm[MEAN_POINTS], value[MEAN_POINTS];
  HELD(abbe_reflected_light, light) = NULL;
  MADE(abbe_illuminant, d50, abbe_illuminant_make("D50", &d50, &error));
  OK(abbe_reflected_light_make(&d50, 380, 780, &light, &error));
  for (size_t i = 0; i < ABBE_COLOUR_CHECKER_COUNT; i++) {
    HELD(abbe_spectrum, spectrum) = NULL;
    double xyz[3][3];
    for (size_t k = 0; k < MEAN_POINTS; k++) {
      nm[k] = 380 + 10 * (double)k;
      value[k] = 1e-3 * mean[i][k];
    }
    OK(abbe_spectrum_make(nm, value, MEAN_POINTS, ABBE_INTERPOLATION_SPLINE, &spectrum, &error));
    abbe_reflected_light_xyz(light, spectrum, xyz);
    const double sum = xyz[0][0] + xyz[0][1] + xyz[0][2], dark = of_mean[i][2] < 0.05 ? 2 : 1;
    const double off[3] = {xyz[0][0] / sum - of_mean[i][0], xyz[0][1] / sum - of_mean[i][1],
                           xyz[0][1] - of_mean[i][2]};
    if (fabs(off[0]) > 0.0005 * dark || fabs(off[1]) > 0.0005 * dark || fabs(off[2]) > 0.0002)
      fail_msg("%s: off by %.5f, %.5f, %.5f", abbe_colour_checker_name(i), off[0], off[1], off[2]);
  }
}

TEST(names_are_found_and_refused) {
  abbe_spectrum *spectrum = colour_checker_make("BLUE Sky");
  assert_near(abbe_spectrum_at(spectrum, 380), 0.125, 0.03);
  abbe_spectrum_free(spectrum);
  REFUSED(ABBE_NOT_FOUND, "", abbe_colour_checker_make("blue skies", &spectrum, &error));
  assert_null(spectrum);
  assert_non_null(strstr(last_error.text, "did you mean 'blue sky'"));
  assert_null(abbe_colour_checker_name(ABBE_COLOUR_CHECKER_COUNT));
}

/* What surfaces reflect of light that is spread: of one wavelength and of bands what they do, of
 * white and of tints what the mixture does, of greys always their share. */

static float cell[ABBE_BAND_REFLECTION_CELLS][4];
static const double even[3] = {1, 1, 1};

static abbe_reflected_light *band_reflection_make(const char *name) {
  abbe_reflected_light *light = NULL;
  MADE(abbe_illuminant, illuminant, abbe_illuminant_make(name, &illuminant, &error));
  OK(abbe_reflected_light_make(&illuminant, 380, 780, &light, &error));
  return light;
}

static abbe_spectrum *patch_of(const char *name) {
  abbe_spectrum *patch = NULL;
  OK(abbe_colour_checker_make(name, &patch, &error));
  return patch;
}

static void fill(const abbe_reflected_light *light, const abbe_spectrum *measured,
                 const double rgb[3]) {
  OK(abbe_band_reflection_fill(light, measured, rgb, cell, &error));
}

TEST(greys_keep_their_share) {
  static const double grey[3] = {0.37, 0.37, 0.37};
  HELD(abbe_reflected_light, light) = band_reflection_make("D65");
  double white[3];
  uint64_t random = 7;
  abbe_reflected_light_white(light, white);
  fill(light, NULL, grey);
  for (int i = 0; i < 2000; i++) {
    double xyz[3], out[3];
    for (int k = 0; k < 3; k++) xyz[k] = random_between(&random, 0, 1);
    abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, out);
    for (int k = 0; k < 3; k++) assert_near(out[k], 0.37 * xyz[k], 1e-6);
  }
}

TEST(white_light_is_exact) {
  static const char *const lights[] = {"D65", "A", "F11", "LED-RGB1"};
  for (size_t l = 0; l < 4; l++) {
    HELD(abbe_reflected_light, light) = band_reflection_make(lights[l]);
    double white[3], wanted[3][3], out[3];
    abbe_reflected_light_white(light, white);
    for (size_t p = 0; p < ABBE_COLOUR_CHECKER_COUNT; p++) {
      HELD(abbe_spectrum, patch) = patch_of(abbe_colour_checker_name(p));
      abbe_reflected_light_xyz(light, patch, wanted);
      fill(light, patch, even);
      abbe_band_reflection_apply((const float(*)[4])cell, white, white, out);
      for (int k = 0; k < 3; k++) assert_near(out[k], wanted[0][k], 1e-6);
    }
  }
}

typedef double (*spectrum_of)(double nm, double at);

static double bell(double nm, double at, double width) {
  return exp(-4 * log(2) * pow((nm - at) / width, 2));
}
static double line(double nm, double at) {
  return bell(nm, at, 2);
}
static double narrow(double nm, double at) {
  return bell(nm, at, 30);
}
static double below(double nm, double at) {
  return nm < at;
}
static double soft(double nm, double at) {
  return 1 / (1 + exp((nm - at) / 15));
}
/* From reddish to bluish glass as `at` goes over the range. */
static double tint(double nm, double at) {
  return pow(550 / nm, (at - 555) / 45);
}

/* Of so many lights, |X| + |Y| + |Z| of what is off over what is reflected: by the mixture, and by
 * bands. */
static void measure(const abbe_reflected_light *light, const abbe_spectrum *patch, spectrum_of of,
                    double off[2]) {
  double matrix[3][9], white[3], all = 0, sum[2] = {0, 0};
  abbe_reflected_light_white(light, white);
  abbe_reflected_light_matrices(light, patch, matrix);
  fill(light, patch, even);
  for (double at = 420; at <= 690; at += 5) {
    double xyz[3] = {0}, kept[3] = {0}, said[2][3];
    for (size_t i = 0; i < abbe_reflected_light_steps(light); i++) {
      double nm, step[3];
      abbe_reflected_light_step(light, i, &nm, step);
      for (int k = 0; k < 3; k++) {
        xyz[k] += of(nm, at) * step[k];
        kept[k] += of(nm, at) * abbe_spectrum_at(patch, nm) * step[k];
      }
    }
    abbe_rgb_space_apply(matrix[0], xyz, said[0]);
    abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, said[1]);
    for (int k = 0; k < 3; k++) {
      all += kept[k];
      for (int who = 0; who < 2; who++) sum[who] += fabs(said[who][k] - kept[k]);
    }
  }
  for (int who = 0; who < 2; who++) off[who] = sum[who] / all;
}

/* The most that may be off by bands: of a line, of 30 nm, of all below an edge, of a soft edge, and
 * of tints, where the mixture is right. */
TEST(light_that_is_spread) {
  static const struct {
    const char *what;
    spectrum_of of;
    double most;
  } lights[] = {{"lines", line, 0.06},
                {"bands of 30 nm", narrow, 0.08},
                {"edges", below, 0.09},
                {"soft edges", soft, 0.12},
                {"tints", tint, 0.03}};
  static const char *const patches[] = {"red", "bluish green", "blue flower", "foliage", "orange"};
  HELD(abbe_reflected_light, light) = band_reflection_make("D65");
  for (size_t p = 0; p < 5; p++) {
    HELD(abbe_spectrum, patch) = patch_of(patches[p]);
    for (size_t l = 0; l < 5; l++) {
      double off[2];
      measure(light, patch, lights[l].of, off);
      print_message("%-13s %-15s mixture %.3f, bands %.3f\n", patches[p], lights[l].what, off[0],
                    off[1]);
      assert_true(off[1] < lights[l].most);
      if (l < 2) assert_true(off[1] < 0.5 * off[0]);
    }
  }
}

TEST(colours_add_up) {
  static const double rgb[3] = {0.7, 0.2, 0.4}, xyz[3] = {0.5, 0.3, 0.1};
  HELD(abbe_reflected_light, light) = band_reflection_make("A");
  double white[3], whole[3], sum[3] = {0}, part[3];
  abbe_reflected_light_white(light, white);
  fill(light, NULL, rgb);
  abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, whole);
  for (int j = 0; j < 3; j++) {
    const double one[3] = {j == 0 ? rgb[0] : 0, j == 1 ? rgb[1] : 0, j == 2 ? rgb[2] : 0};
    fill(light, NULL, one);
    abbe_band_reflection_apply((const float(*)[4])cell, white, xyz, part);
    for (int k = 0; k < 3; k++) sum[k] += part[k];
  }
  for (int k = 0; k < 3; k++) assert_near(sum[k], whole[k], 1e-6);
}

/* A line, or a range that nobody sees, has no colours to tell bands by. */
TEST(lights_of_few_colours) {
  static const double rgb[3] = {0.7, 0.2, 0.4};
  static const abbe_illuminant d65 = {.kind = ABBE_ILLUMINANT_D65};
  static const double ranges[][2] = {{589, 590}, {900, 1000}};
  for (size_t i = 0; i < 2; i++) {
    HELD(abbe_reflected_light, light) = NULL;
    double white[3], of[3][3], out[3];
    OK(abbe_reflected_light_make(&d65, ranges[i][0], ranges[i][1], &light, &error));
    abbe_reflected_light_white(light, white);
    abbe_reflected_light_xyz(light, NULL, of);
    fill(light, NULL, rgb);
    abbe_band_reflection_apply((const float(*)[4])cell, white, white, out);
    for (int k = 0; k < 3; k++)
      assert_near(out[k], rgb[0] * of[0][k] + rgb[1] * of[1][k] + rgb[2] * of[2][k], 1e-3);
  }
}
