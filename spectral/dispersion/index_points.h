/* index_points.h: refractive indices at wavelengths: measured ones from a file, or a formula's.
 *
 * The file is CSV: a wavelength, an index and, if known, the index's standard uncertainty a line.
 * It is what fits start from and what distances between glasses are taken to; it makes no
 * material, and no curve through its points.
 */
#ifndef ABBE_SPECTRAL_DISPERSION_INDEX_POINTS_H
#define ABBE_SPECTRAL_DISPERSION_INDEX_POINTS_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_INDEX_POINTS_MAX_COUNT 200000

typedef struct abbe_index_points {
  size_t count;
  double *lambda_nm;   /* [count] ascending, nm; measurements may repeat a wavelength */
  double *n;           /* [count] */
  double *uncertainty; /* [count] standard uncertainty of n, > 0; NULL: not known */
  bool exact;          /* n of a formula, so that residuals are the form's and not noise */
} abbe_index_points;

/* Reads a file of columns as spectral/dispersion/csv_points.h has it, strictly: a line that is not
 * a point is an error, because a measurement with holes is another one. Lines may come in any
 * order. ABBE_IO for the file; ABBE_PARSE for a line, or a unit that is not clear; ABBE_SCHEMA for
 * no points, points outside 1 nm to 1 mm, and uncertainties on some lines only. */
abbe_result abbe_index_points_load(const char *path, abbe_index_points *out, abbe_error *error);
/* The same from text; name stands for the path in messages. */
abbe_result abbe_index_points_parse(const char *text, size_t size, const char *name,
                                    abbe_index_points *out, abbe_error *error);

/* n of a formula over [min_nm, max_nm], ends included, at steps of 1 nm or, where those are fewer
 * than at_least or more than at_most, at steps that give as many. ABBE_INVALID_ARGUMENT for a
 * range that is not one, counts outside [2, ABBE_INDEX_POINTS_MAX_COUNT], or where the formula
 * has no real index. */
abbe_result abbe_index_points_sample(const abbe_dispersion *dispersion, double min_nm,
                                     double max_nm, size_t at_least, size_t at_most,
                                     abbe_index_points *out, abbe_error *error);

void abbe_index_points_free(abbe_index_points *points);

/* How far two dispersion curves lie apart over a range. */

typedef struct abbe_index_difference {
  double rms;    /* root of the mean square of n_a - n_b */
  double mean;   /* mean of n_a - n_b: what a shift of the whole curve would take away */
  double max;    /* largest |n_a - n_b| */
  double max_nm; /* where that is */
} abbe_index_difference;

/* a - b over [min_nm, max_nm] at steps of 1 nm (401 to 4001 of them, evenly, on shorter or longer
 * ranges). ABBE_INVALID_ARGUMENT where the range is not one or a formula has no real index. */
abbe_result abbe_index_difference_of_curves(const abbe_dispersion *a, const abbe_dispersion *b,
                                            double min_nm, double max_nm,
                                            abbe_index_difference *out, abbe_error *error);

/* a - the points' n, at those of the points that lie within [min_nm, max_nm]; an infinite end is
 * no limit. ABBE_INVALID_ARGUMENT where there are none, or a has no real index at one. */
abbe_result abbe_index_difference_of_points(const abbe_dispersion *a,
                                            const abbe_index_points *points, double min_nm,
                                            double max_nm, abbe_index_difference *out,
                                            abbe_error *error);

/* An index as POV-Ray has it: two numbers.
 *
 * n(lambda) = ior dispersion^((555 nm - lambda)
 * 350 nm) [PovRay37]. Here are the law and its fit by least squares; its users choose samples and
 * weights. It writes nothing. */

/* Between these the ratio of the indices is `dispersion`; POV-Ray's spectrum ends there. */
#define ABBE_POVRAY_VIOLET_NM 380.0
#define ABBE_POVRAY_RED_NM 730.0

typedef struct abbe_povray_index {
  double ior;        /* n at 555 nm */
  double dispersion; /* n(380 nm) / n(730 nm); 1 where the index is constant */
} abbe_povray_index;

/* n at lambda_nm. */
double abbe_povray_index_at(const abbe_povray_index *index, double lambda_nm);

/* The two numbers nearest to count samples of n > 0: least squares in log n, each sample weighted
 * by weight[i] >= 0 (NULL: alike). Samples at one wavelength alone have the dispersion 1. */
abbe_povray_index abbe_povray_index_fit(const double *lambda_nm, const double *n,
                                        const double *weight, size_t count);

#endif
