#include "spectral/dispersion/povray_index.h"

#include <math.h>

/* 1/2 at the violet end, -1/2 at the red one. */
static double along(double lambda_nm) {
  return ((ABBE_POVRAY_VIOLET_NM + ABBE_POVRAY_RED_NM) / 2 - lambda_nm) /
         (ABBE_POVRAY_RED_NM - ABBE_POVRAY_VIOLET_NM);
}

double abbe_povray_index_at(const abbe_povray_index *index, double lambda_nm) {
  return index->ior * pow(index->dispersion, along(lambda_nm));
}

abbe_povray_index abbe_povray_index_fit(const double *lambda_nm, const double *n,
                                        const double *weight, size_t count) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < count; i++) {
    double w = weight != NULL ? weight[i] : 1, x = along(lambda_nm[i]), y = log(n[i]);
    s += w;
    sx += w * x;
    sy += w * y;
    sxx += w * x * x;
    sxy += w * x * y;
  }
  double spread = s * sxx - sx * sx;
  double slope = spread > 1e-12 * s * s ? (s * sxy - sx * sy) / spread : 0;
  if (fabs(slope) < 1e-12) slope = 0; /* rounding errors of a constant index */
  return (abbe_povray_index){exp((sy - slope * sx) / s), exp(slope)};
}
