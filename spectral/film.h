/* film.h: light at a face with thin films on it: characteristic matrices of s and p over complex
 * indices. [BornWolf1999]
 *
 * Light goes as exp(-i w t), so that n + i k with k above 0 absorbs. The films shift nothing and
 * have no width; the medium that the light comes from is clear. Isotropic films on isotropic media.
 */
#ifndef ABBE_SPECTRAL_FILM_H
#define ABBE_SPECTRAL_FILM_H

#include <stdbool.h>
#include <stddef.h>

#define ABBE_FILM_MOST_LAYERS 16
#define ABBE_FILM_MOST_NM 5000 /* thickness of a layer */

typedef struct abbe_film_layer {
  double n, k; /* n above 0, k >= 0 */
  double nm;   /* thickness, >= 0 */
} abbe_film_layer;

enum { ABBE_FILM_S, ABBE_FILM_P };

/* Of s and p. What is neither reflected nor transmitted is absorbed. */
typedef struct abbe_film_light {
  double reflected[2], transmitted[2]; /* shares */
  double r[2][2];                      /* amplitude, real and imaginary part; of p by the magnetic
                                          field: (n2 c1 - n1 c2) / (n2 c1 + n1 c2) at a bare face */
} abbe_film_light;

/* Light of lambda_nm that comes from index n_from, above 0, at the cosine cos_i, 0 to 1, through
 * the layers, first to last, or where `reversed` last to first, into n + i k of `to`. */
void abbe_film_light_at(const abbe_film_layer *layer, size_t count, bool reversed, double n_from,
                        const double to[2], double cos_i, double lambda_nm, abbe_film_light *out);

/* The means of both. */
void abbe_film_unpolarised(const abbe_film_light *light, double *reflected, double *transmitted);

#endif
