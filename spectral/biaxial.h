/* biaxial.h: light in crystals of three indices and at their faces, in double precision.
 *
 * A medium has an index along each of three axes at right angles. Two waves belong to every normal:
 * their electric displacements lie along the axes of the section of the index ellipsoid across it.
 * Two belong to every ray: their electric fields lie along the axes of such a section of the
 * permittivity's ellipsoid. At a face a wave becomes up to two reflected and two transmitted ones:
 * the normal parts of their wave vectors solve a quartic, and four amplitudes make the tangential
 * fields the same on both sides [BornWolf1999, 15] [Berreman1972]. Media of two indices and of one
 * are special cases. A face may have films on it (spectral/film.h). Not magnetic, not optically
 * active, clear at faces.
 *
 * Directions are unit vectors of the way the light travels; n is the unit normal of the face on the
 * side that the light comes from.
 */
#ifndef ABBE_SPECTRAL_BIAXIAL_H
#define ABBE_SPECTRAL_BIAXIAL_H

#include "spectral/film.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct abbe_biaxial {
  double n[3];       /* along each axis, above 0, in any order */
  double axis[3][3]; /* unit, at right angles */
} abbe_biaxial;

/* One of two waves. Where all indices are alike the first is polarised across the plane of
 * incidence (s), the second in it (p). */
typedef enum abbe_biaxial_mode { ABBE_BIAXIAL_FAST, ABBE_BIAXIAL_SLOW } abbe_biaxial_mode;

/* A wave by itself. */
typedef struct abbe_biaxial_state {
  double index;     /* along its normal */
  double normal[3]; /* the wave's normal */
  double ray[3];    /* the direction of its energy */
  double field[3];  /* the unit direction of its electric field, across the ray */
} abbe_biaxial_state;

/* The wave of that normal that is the faster or the slower one of the two. Along an optic axis any
 * pair at right angles stands for all. */
void abbe_biaxial_of_normal(const abbe_biaxial *medium, abbe_biaxial_mode mode,
                            const double normal[3], abbe_biaxial_state *out);
/* The wave of that ray, faster or slower along it; along an axis of single ray velocity any pair.
 */
void abbe_biaxial_of_ray(const abbe_biaxial *medium, abbe_biaxial_mode mode, const double ray[3],
                         abbe_biaxial_state *out);

/* Half the angle between the optic axes, in radians, seen from the axis of the largest index;
 * n ascends. Below 45 degrees the crystal is positive. */
double abbe_biaxial_half_angle(const double n[3]);

/* Natural attenuation a metre of ray of a wave with that field, in a crystal whose fields along its
 * axes lose a[3] a metre: k0 E* Im(permittivity) E / |Re E x H*|. */
double abbe_biaxial_attenuation(const abbe_biaxial *medium, const double a[3],
                                const double field[3]);

/* A wave that leaves a face. */
typedef struct abbe_biaxial_wave {
  double share;             /* its share of the power that came to the face */
  abbe_biaxial_state state; /* holds where it travels */
  double amplitude[2];      /* real and imaginary part along the field, for an incident one of 1 */
  abbe_biaxial_mode mode;   /* which of its rays it is, for abbe_biaxial_of_ray */
  bool travels;             /* false: evanescent */
} abbe_biaxial_wave;

/* Films on a face, from outside in; reversed: the light comes from inside. */
typedef struct abbe_biaxial_film {
  const abbe_film_layer *layer;
  size_t count;
  bool reversed;
  double lambda_nm;
} abbe_biaxial_film;

/* The shares of all four add up to 1, or to what films do not absorb: to 1e-7, and from inside a
 * crystal to 5e-16 / cosine^2 where that of the incident ray is below 1e-4. In isotropic media s
 * and p, in this order. */
typedef struct abbe_biaxial_split {
  abbe_biaxial_wave reflected[2], transmitted[2];
  double field[3]; /* the unit direction of the incident electric field */
} abbe_biaxial_split;

/* What becomes of a wave whose ray comes from one medium (dot(ray, n) < 0) to the face of another.
 * film: on the face, or NULL.
 * Where it grazes (within 1e-6) all of it goes on along the mirror direction. */
void abbe_biaxial_meet(const abbe_biaxial *from, const abbe_biaxial *to, const double n[3],
                       abbe_biaxial_mode mode, const double ray[3], const abbe_biaxial_film *film,
                       abbe_biaxial_split *out);

/* The same for s and p of an isotropic medium, each of which leaves as the same waves. */
void abbe_biaxial_meet_both(const abbe_biaxial *from, const abbe_biaxial *to, const double n[3],
                            const double ray[3], const abbe_biaxial_film *film,
                            abbe_biaxial_split out[2]);

/* The same for unpolarised light in an isotropic medium: shares are the means over s and p. */
void abbe_biaxial_meet_unpolarised(const abbe_biaxial *from, const abbe_biaxial *to,
                                   const double n[3], const double ray[3],
                                   const abbe_biaxial_film *film, abbe_biaxial_split *out);

#endif
