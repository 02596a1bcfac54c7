/* maths.h: pi, angles, and three-component vectors in double precision.
 *
 * Small inline functions over double[3]; it has no matrices (scenes/geometry/transform.h) and no
 * physics.
 */
#ifndef ABBE_BASE_MATHS_H
#define ABBE_BASE_MATHS_H

#include <math.h>
#include <stdbool.h>

#define ABBE_PI 3.14159265358979323846
/* A degree in radians. */
#define ABBE_DEGREE (ABBE_PI / 180)

static inline double abbe_vector_dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double abbe_vector_length(const double a[3]) {
  return sqrt(abbe_vector_dot(a, a));
}

/* out = a - b; out may be a or b. */
static inline void abbe_vector_subtract(const double a[3], const double b[3], double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = a[k] - b[k];
}

/* out = a x b; out is neither a nor b. */
static inline void abbe_vector_cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Scales a to length 1; false, a untouched, where its length is zero or not finite. */
static inline bool abbe_vector_normalise(double a[3]) {
  const double length = abbe_vector_length(a), whole = 1e-140; /* below, squares lose digits */
  if (!(length > 0.0) || !isfinite(length)) return false;
  if (length < whole) {
    const double most = fmax(fmax(fabs(a[0]), fabs(a[1])), fabs(a[2]));
    double b[3];
    for (int k = 0; k < 3; k++) b[k] = a[k] / most;
    for (int k = 0; k < 3; k++) a[k] = b[k] / abbe_vector_length(b);
    return true;
  }
  for (int k = 0; k < 3; k++) a[k] /= length;
  return true;
}

static inline bool abbe_vector_finite(const double a[3]) {
  return isfinite(a[0]) && isfinite(a[1]) && isfinite(a[2]);
}

/* (b - a) x (c - a): twice the triangle's area along its normal. */
static inline void abbe_vector_triangle(const double a[3], const double b[3], const double c[3],
                                        double out[3]) {
  double u[3], v[3];
  abbe_vector_subtract(b, a, u);
  abbe_vector_subtract(c, a, v);
  abbe_vector_cross(u, v, out);
}

/* Three unit vectors as the columns of out, row by row, from two directions that are not along each
 * other: along a, across it towards b, and side (1, or -1 for a mirror image) times a x b. */
static inline void abbe_vector_frame(const double a[3], const double b[3], double side,
                                     double out[9]) {
  double x[3] = {a[0], a[1], a[2]}, y[3], z[3];
  abbe_vector_normalise(x);
  abbe_vector_cross(a, b, z);
  abbe_vector_normalise(z);
  abbe_vector_cross(z, x, y);
  for (int k = 0; k < 3; k++) {
    out[3 * k] = x[k];
    out[3 * k + 1] = y[k];
    out[3 * k + 2] = side * z[k];
  }
}

/* Comparisons for qsort. No number may be a NaN. */

/* Compares two doubles. */
static inline int abbe_order_ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static inline int abbe_order_descending(const void *a, const void *b) {
  return abbe_order_ascending(b, a);
}

/* Compares two floats. */
static inline int abbe_order_ascending_floats(const void *a, const void *b) {
  const float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

static inline int abbe_order_descending_floats(const void *a, const void *b) {
  return abbe_order_ascending_floats(b, a);
}

/* Functions that the compiler makes for several processors' vector units.
 *
 * The one that fits is chosen when the program starts. Sanitizers do not bear it, and Clang knows
 * it in another form: there it says nothing. */

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(NDEBUG)
#define SIDE_BY_SIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define SIDE_BY_SIDE
#endif

/* Keeps GSL from ending the program.
 *
 * GSL's default error handler aborts, even where a call only ran out of memory. Between enter and
 * leave it is off, so that GSL returns its code; the host program's own handler comes back with
 * the last leave. Calls nest and may come from several threads. */

void abbe_gsl_guard_enter(void);
void abbe_gsl_guard_leave(void);

#endif
