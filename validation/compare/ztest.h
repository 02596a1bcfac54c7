/* ztest.h: whether differences are explained by the standard errors of the two sides.
 *
 * z = difference / standard error, for many independent elements: how often |z| is above 2 and 3,
 * the mean of z^2, and the greatest |z| against what so many elements may show. An element whose
 * standard error is zero cannot be tested (nothing has reached it, or it is exact); those that
 * differ all the same are counted apart. It says nothing of how large differences are.
 */
#ifndef ABBE_VALIDATION_COMPARE_ZTEST_H
#define ABBE_VALIDATION_COMPARE_ZTEST_H

#include <stddef.h>

/* The chance at which even one of all elements may be above the critical |z| if all is right. */
#define ABBE_ZTEST_LEVEL 0.01

/* A zeroed test is empty. */
typedef struct abbe_ztest {
  size_t count;           /* elements tested */
  size_t over2, over3;    /* of them with |z| above 2, above 3 */
  double sum_square;      /* of z */
  double max;             /* greatest |z| */
  size_t untested;        /* elements without a standard error */
  size_t untested_differ; /* of them with a difference */
} abbe_ztest;

/* One element: its difference and the variance of that difference. Variance that is not finite or
 * not above zero: untested. */
void abbe_ztest_add(abbe_ztest *test, double difference, double variance);
void abbe_ztest_merge(abbe_ztest *test, const abbe_ztest *more);

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

#endif
