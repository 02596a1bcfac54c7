/* film.h: light at a face with thin films on it: characteristic matrices of s and p over complex
 * indices. [BornWolf1999]
 *
 * Light goes as exp(-i w t), so that n + i k with k above 0 absorbs. The films shift nothing and
 * have no width; the medium that the light comes from is clear. Isotropic films on isotropic media.
 */
#ifndef ABBE_SPECTRAL_FILM_H
#define ABBE_SPECTRAL_FILM_H

#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define ABBE_FILM_MOST_LAYERS 16
#define ABBE_FILM_MOST_NM 5000 /* thickness of a layer */

/* What a film was measured to do, by the angle in the medium of the lesser index: linear in its
 * cosine and in wavelength, and held beyond both. The same from either side, which is exact of a
 * film that absorbs nothing. It has no phases. */
typedef struct abbe_film_table {
  size_t angles, wavelengths; /* above 0 */
  double number[]; /* 1 - cos of the angles, rising; wavelengths, nm, rising; then by angle,
                      wavelength and s, p: shares reflected and transmitted */
} abbe_film_table;

typedef struct abbe_film_layer {
  double n, k;                  /* n above 0, k >= 0 */
  double nm;                    /* thickness, >= 0 */
  const abbe_film_table *table; /* of a film's one layer, instead; or NULL */
} abbe_film_layer;

enum { ABBE_FILM_S, ABBE_FILM_P };

/* For s and p. What is neither reflected nor transmitted is absorbed. */
typedef struct abbe_film_light {
  double reflected[2], transmitted[2]; /* shares */
  double r[2][2];                      /* amplitude, real and imaginary part; of p by the magnetic
                                          field: (n2 c1 - n1 c2) / (n2 c1 + n1 c2) at a bare face */
  double t[2][2]; /* the same of what is transmitted, of the root of its share in size */
} abbe_film_light;

/* Light of lambda_nm that comes from index n_from, above 0, at the cosine cos_i, 0 to 1, through
 * the layers, first to last, or where `reversed` last to first, into n + i k of `to`. */
void abbe_film_light_at(const abbe_film_layer *layer, size_t count, bool reversed, double n_from,
                        const double to[2], double cos_i, double lambda_nm, abbe_film_light *out);

/* The means of both. */
void abbe_film_unpolarised(const abbe_film_light *light, double *reflected, double *transmitted);

/* Four amplitudes from four equations, of the waves that leave a face, and fields on
 * their way through films. */

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
