/* povray_index.h: an index as POV-Ray has it: two numbers.
 *
 * n(lambda) = ior dispersion^((555 nm - lambda)
 * 350 nm) [PovRay37]. Here are the law and its fit by least squares; its users choose samples and
 * weights. It writes nothing. */
#ifndef ABBE_SPECTRAL_DISPERSION_POVRAY_INDEX_H
#define ABBE_SPECTRAL_DISPERSION_POVRAY_INDEX_H

#include <stddef.h>

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
