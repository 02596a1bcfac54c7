/* compare.h: how far a field is from a reference: in light, in colour, and against the noise.
 *
 * Every metric is taken over the whole field and over a mask. Beside it stands what it would be if
 * the field were exact and only the reference's standard errors were at work, so that a
 * difference below the reference's own noise is known as such. Light is compared in X, Y, Z, which
 * are not negative, and band by band; the Z-test in the channels that the files have. Pixels where
 * a side is not finite are counted and left out. It compares pixel by pixel: nothing is moved,
 * blurred or tone-mapped, but by SSIM and FLIP, which look at a pixel's surroundings as an eye
 * does.
 */
#ifndef ABBE_VALIDATION_MEASURE_COMPARE_H
#define ABBE_VALIDATION_MEASURE_COMPARE_H

#include "colorimetry/image/image.h"
#include "validation/measure/field.h"

#include <stddef.h>

/* Which elements of a picture or map are looked at apart from the rest.
 *
 * A mask is a byte an element, 1 inside and 0 outside. It is found from the light itself, the
 * brightest elements that together hold a share of it, or taken from a picture that was drawn for
 * it. It knows nothing of rows and columns, and nothing is smoothed or grown. */

/* The share of a caustic's light that its mask holds, unless another is requested. */
#define ABBE_MASK_CAUSTIC_SHARE 0.95

/* A zeroed mask is empty. */
typedef struct abbe_mask {
  size_t count;      /* elements */
  size_t inside;     /* pixels of them in the mask */
  unsigned char *in; /* [count] 0 or 1 */
} abbe_mask;

/* The smallest set of brightest elements of light[count] (any unit) that holds `share` of the
 * total, 0 < share <= 1. What is negative or not a number holds no light; of equal elements the
 * first ones are taken. ABBE_INVALID_ARGUMENT where there is no light at all, or for a share or
 * count out of range; ABBE_NO_MEMORY. */
abbe_result abbe_mask_make_brightest(const double *light, size_t count, double share,
                                     abbe_mask *out, abbe_error *error);
/* The brightest pixels of a field's caustic: of the map itself (its Y, or the sum of its bands), or
 * of the layers caustic.* of a picture. ABBE_INVALID_ARGUMENT, with `name`, where a picture has no
 * such layers or the caustic is dark. */
abbe_result abbe_mask_make_caustic(const abbe_field *field, const char *name, double share,
                                   abbe_mask *out, abbe_error *error);
/* The pixels whose first channel ("R", then "Y", else the first there is) is above 0.5.
 * ABBE_INVALID_ARGUMENT where there is none. */
abbe_result abbe_mask_make_drawn(const abbe_image *image, abbe_mask *out, abbe_error *error);
void abbe_mask_free(abbe_mask *mask);

/* Whether differences are explained by the standard errors of the two sides.
 *
 * z = difference / standard error, for many independent elements: how often |z| is above 2 and 3,
 * the mean of z^2, and the greatest |z| against what so many elements may show. An element whose
 * standard error is zero cannot be tested (nothing has reached it, or it is exact); those that
 * differ all the same are counted apart. It says nothing of how large differences are. */

/* The chance at which even one of all elements may be above the critical |z| if all is right. */
#define ABBE_ZTEST_LEVEL 0.01

/* A zeroed test is empty. */
typedef struct abbe_ztest {
  size_t count;           /* elements tested */
  size_t over2, over3;    /* samples with |z| above 2, above 3 */
  double sum_square;      /* sum of z^2 */
  double max;             /* greatest |z| */
  size_t untested;        /* elements without a standard error */
  size_t untested_differ; /* untested samples with a difference */
} abbe_ztest;

/* One element: its difference and the variance of that difference. Variance that is not finite or
 * not above zero: untested. */
void abbe_ztest_add(abbe_ztest *test, double difference, double variance);

/* Shares of the tested elements, and the mean of z^2; NaN where nothing was tested. */
double abbe_ztest_share_over2(const abbe_ztest *test);
double abbe_ztest_share_over3(const abbe_ztest *test);
double abbe_ztest_mean_square(const abbe_ztest *test);

/* The same if all differences are noise. `freedom` is the degrees of freedom of the standard
 * errors, one less than the estimates they were computed from (Student's t); 0: they are exact
 * (normal distribution). The mean of z^2 is infinite where freedom is at most 2. */
double abbe_ztest_expected_share(double z, double freedom);
double abbe_ztest_expected_mean_square(double freedom);
/* The |z| that the greatest of count elements exceeds with the chance `level`, 0 < level < 1, if
 * all differences are noise; Sidak's correction [Sidak1967]. */
double abbe_ztest_critical(size_t count, double level, double freedom);

/* X(code, name, text). a is the test's value, b the reference's, the mean over pixels and
 * channels. Each is 0 for equal fields, but the energy ratios and SSIM, which are 1. */
#define ABBE_COMPARE_METRICS(X)                                                                    \
  X(RELATIVE_RMSE, "relative_rmse", "relative RMSE") /* root of mean (a-b)^2, over mean b */       \
  X(SQUARED_RELATIVE, "squared_relative",                                                          \
    "(a-b)^2/(b+0.01)^2") /* its mean; a and b in units of REF's mean Y over the whole field */    \
  X(ENERGY_RATIO, "energy_ratio", "energy ratio")         /* sum of a over sum of b, of Y */       \
  X(CIEDE2000_MEAN, "ciede2000_mean", "CIEDE2000 mean")   /* [Sharma2005] */                       \
  X(CIEDE2000_P95, "ciede2000_p95", "CIEDE2000 95 %")     /* 95th percentile */                    \
  X(CIEDE2000_MAX, "ciede2000_max", "CIEDE2000 greatest") /* the largest of one pixel */           \
  X(UV_MEAN, "uv_mean", "u'v' distance")                  /* [CIE15], mean weighted by REF's Y */  \
  X(CIE76_MEAN, "cie76_mean", "CIE76 mean")               /* [CIE15] */                            \
  X(CIE94_MEAN, "cie94_mean", "CIE94 mean")               /* [CIE116], REF the standard */         \
  X(ITP_MEAN, "itp_mean", "ICtCp distance mean")          /* [BT2124]; white is 203 cd/m2 */       \
  X(SSIM, "ssim", "SSIM mean")                       /* [Wang2004], of Y as sRGB encodes it */     \
  X(FLIP_MEAN, "flip_mean", "FLIP mean")             /* [Andersson2020], white is 1 */             \
  X(HDR_FLIP_MEAN, "hdr_flip_mean", "HDR-FLIP mean") /* [Andersson2021] */                         \
  X(BANDS_RELATIVE_RMSE, "bands_relative_rmse", "bands: relative RMSE")                            \
  X(BANDS_SQUARED_RELATIVE, "bands_squared_relative",                                              \
    "bands: (a-b)^2/(b+0.01)^2") /* in units of REF's mean over all bands */                       \
  X(BANDS_ENERGY_RATIO, "bands_energy_ratio", "bands: energy ratio") /* over all bands */          \
  X(Z_OVER_2, "z_over_2", "share of |z| > 2")                                                      \
  X(Z_OVER_3, "z_over_3", "share of |z| > 3")                                                      \
  X(Z_MEAN_SQUARE, "z_mean_square", "mean of z^2")                                                 \
  X(Z_EXCESS, "z_excess", "greatest |z| / critical") /* above 1: not explained by noise */

typedef enum abbe_compare_metric {
#define ABBE_COMPARE_ENUM(code, name, text) ABBE_COMPARE_##code,
  ABBE_COMPARE_METRICS(ABBE_COMPARE_ENUM)
#undef ABBE_COMPARE_ENUM
      ABBE_COMPARE_METRIC_COUNT
} abbe_compare_metric;

const char *abbe_compare_metric_name(abbe_compare_metric metric);
const char *abbe_compare_metric_text(abbe_compare_metric metric);
/* The metric of that name, or ABBE_COMPARE_METRIC_COUNT. */
abbe_compare_metric abbe_compare_metric_find(const char *name);

/* NaN stands for what is not known: no standard errors, no such channels. */
typedef struct abbe_compare_value {
  double value;
  double noise;      /* expected if TEST were exact, from REF's errors; of a ratio, one standard
                        error; of the Z-test, what noise alone gives */
  double limit;      /* up to here noise alone explains it: two standard deviations above `noise`;
                        NaN for the greatest CIEDE2000, which is one pixel's */
  double both_noise; /* the same from the errors of both; NaN where TEST has none */
  double both_limit;
  double net; /* relative RMSE and squared relative error less all known noise; at least 0 */
} abbe_compare_value;

typedef struct abbe_compare_channel {
  char name[24];    /* "X", "Y", "Z", or "550 nm" */
  double lambda_nm; /* wavelength of a band; 0 for colour */
  double mean_reference, mean_test;
  abbe_compare_value relative_rmse, squared_relative, energy_ratio;
} abbe_compare_channel;

typedef struct abbe_compare_region {
  size_t pixels;            /* compared */
  size_t invalid_reference; /* left out: a value or an error of REF that is not finite */
  size_t invalid_test;      /* left out: of TEST */
  double uv_share;          /* share of REF's Y in pixels where both sides have a chromaticity */
  abbe_compare_value metric[ABBE_COMPARE_METRIC_COUNT];
  abbe_ztest z;      /* over all pixels and channels */
  double z_critical; /* for the greatest |z|, at ABBE_ZTEST_LEVEL */
  size_t channels;
  abbe_compare_channel *channel; /* [channels] X, Y, Z if there is colour, then the bands */
} abbe_compare_region;

typedef struct abbe_comparison {
  double scale;    /* TEST was multiplied by it; 1 unless the best was requested */
  double unit;     /* REF's mean Y (or mean over bands): what 1 is in squared_relative */
  double white[3]; /* XYZ of CIEDE2000's white; 0 without colour */
  bool white_found;
  double freedom; /* degrees of freedom of the standard errors; 0: taken as exact */
  abbe_compare_region whole, mask;
  bool masked;
} abbe_comparison;

/* A zeroed request is valid. */
typedef struct abbe_compare_options {
  const abbe_mask *mask;   /* NULL: the whole field alone */
  double white[3];         /* XYZ; all 0: D65 at the Y that the brightest 1 % of REF's lit pixels
                              reach */
  bool structure;          /* for pictures SSIM and both FLIP too, which take as long as the rest */
  bool best_scale;         /* multiply TEST by the factor of least squares over the whole field */
  unsigned long long seed; /* seed of the noise that stands in for REF's in the colour metrics */
} abbe_compare_options;

/* Compares two fields that abbe_field_align brought together. ABBE_INVALID_ARGUMENT where REF is
 * black, TEST is black and its scale is requested, the mask is of another size, or no pixel is
 * finite on both sides; ABBE_NO_MEMORY. */
abbe_result abbe_compare(const abbe_field *reference, const abbe_field *test,
                         const abbe_compare_options *options, abbe_comparison *out,
                         abbe_error *error);
void abbe_comparison_free(abbe_comparison *comparison);

/* D65 at the Y that the brightest 1 % of the field's lit pixels reach; bad (may be NULL): not of
 * pixels where it is not 0. ABBE_NO_MEMORY. */
abbe_result abbe_compare_white(const abbe_field *field, const uint8_t *bad, double white[3],
                               abbe_error *error);

/* How far from equal: |value - 1| of an energy ratio and of SSIM, else the value. What tolerances
 * bound. */
double abbe_compare_deviation(abbe_compare_metric metric, double value);

typedef enum abbe_compare_verdict {
  ABBE_COMPARE_UNKNOWN,         /* nothing says how noisy REF is */
  ABBE_COMPARE_BELOW_REFERENCE, /* REF's own noise explains the difference */
  ABBE_COMPARE_BELOW_BOTH,      /* the noise of both sides does, REF's alone does not */
  ABBE_COMPARE_ABOVE            /* a difference that noise does not explain */
} abbe_compare_verdict;

abbe_compare_verdict abbe_compare_judge(abbe_compare_metric metric,
                                        const abbe_compare_value *value);

#endif
