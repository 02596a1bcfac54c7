/* polarisation.h: the polarisation of light: Stokes vectors, and what faces make of them.
 *
 * Light goes as exp(-i w t). S = (I, Q, U, V) in a frame x, y, k, right-handed, k the way the light
 * travels: Q = |Ex|^2 - |Ey|^2, U = 2 Re Ex Ey*, V = 2 Im Ex Ey*. V above 0 is right-handed as in
 * [BornWolf1999]: clockwise to one who looks into the light. The IEEE and the IAU have the other
 * sign. At a face x = s = k x n / |k x n| and y = p = k x s, on each ray with its own k and one s.
 *
 * Light that runs the other way through a chain of faces, from the state that the chain's end lets
 * pass, has the same share: so a camera's path carries a vector as a photon's does.
 */
#ifndef ABBE_SPECTRAL_POLARISATION_H
#define ABBE_SPECTRAL_POLARISATION_H

#include "spectral/film.h"

#include <complex.h>

/* Amplitudes along x and y of light that goes on, of that which comes: m[to][from]. A size of 1
 * keeps the power. */
typedef struct abbe_jones {
  double complex m[2][2];
} abbe_jones;

/* From s and p to s and p. */
abbe_jones abbe_jones_of_face(const abbe_film_light *light, bool reflected);

/* out = M in, M the Mueller matrix; out may be in. */
void abbe_jones_apply(const abbe_jones *jones, const double in[4], double out[4]);

/* The vector in a frame whose x is turned towards y by the angle of that cosine and sine; out may
 * be in. */
void abbe_stokes_turn(const double in[4], double cosine, double sine, double out[4]);

/* Degree of polarisation, 0 to 1; 0 of no light. */
double abbe_stokes_degree(const double stokes[4]);

#endif
