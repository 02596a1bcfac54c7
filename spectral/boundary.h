/* boundary.h: four amplitudes from four equations, of the waves that leave a face, and fields on
 * their way through films. Internal to spectral/.
 */
#ifndef ABBE_SPECTRAL_BOUNDARY_H
#define ABBE_SPECTRAL_BOUNDARY_H

#include "spectral/film.h"

#include <complex.h>
#include <math.h>

/* Most waves that come at once: s and p. */
enum { ABBE_BOUNDARY_COME = 2 };

/* Tangential fields E and H of s (field[0]) and p (field[1]), of light of lambda_nm whose N sin is
 * kappa, taken from behind layers to their front, times exp(-*decay). H is n_t cos_t E for s, and
 * n_t / cos_t E for p, of a wave that goes on behind them. */
void abbe_film_fields(const abbe_film_layer *layer, size_t count, bool reversed, double kappa,
                      double lambda_nm, double complex field[2][2], double *decay);

static inline double abbe_boundary_size(double complex z) {
  return fabs(creal(z)) + fabs(cimag(z));
}

/* Gauss with the largest pivot; m[row][0..3] x = m[row][4 + i] for each of `count` right sides,
 * whose solutions take their place. */
static inline void abbe_boundary_solve(double complex m[4][4 + ABBE_BOUNDARY_COME], int count) {
  const int end = 4 + count;
  for (int c = 0; c < 4; c++) {
    int best = c;
    for (int r = c + 1; r < 4; r++)
      if (abbe_boundary_size(m[r][c]) > abbe_boundary_size(m[best][c])) best = r;
    if (best != c)
      for (int k = c; k < end; k++) {
        const double complex swapped = m[c][k];
        m[c][k] = m[best][k];
        m[best][k] = swapped;
      }
    /* two waves that cling to the face may be one: any split between them is right */
    if (abbe_boundary_size(m[c][c]) < 1e-30) m[c][c] = 1e-30;
    const double complex inverse = 1 / m[c][c];
    for (int r = c + 1; r < 4; r++) {
      const double complex times = m[r][c] * inverse;
      for (int k = c + 1; k < end; k++) m[r][k] -= times * m[c][k];
    }
    for (int k = 4; k < end; k++) m[c][k] *= inverse;
    for (int k = c + 1; k < 4; k++) m[c][k] *= inverse;
  }
  for (int r = 3; r >= 0; r--)
    for (int i = 4; i < end; i++)
      for (int k = r + 1; k < 4; k++) m[r][i] -= m[r][k] * m[k][i];
}

#endif
