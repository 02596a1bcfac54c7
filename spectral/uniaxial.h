/* uniaxial.h: light in uniaxial crystals and at their faces, in double precision.
 *
 * A uniaxial medium carries two waves of its own linear polarisation: the ordinary one, of index
 * n_o and with its field across the optic axis, and the extraordinary one, whose index depends on
 * the angle between its normal and the axis, and whose ray (its energy) leaves its normal. At a
 * face a wave becomes up to two reflected and two transmitted ones: four amplitudes that make the
 * tangential electric and magnetic fields the same on both sides [BornWolf1999] [Lekner1991].
 * Not magnetic, not optically active; plane waves and plane faces, at which it counts as clear.
 *
 * Directions are unit vectors in which the light travels; n is the unit normal of the face on the
 * side that the light comes from. */
#ifndef ABBE_SPECTRAL_UNIAXIAL_H
#define ABBE_SPECTRAL_UNIAXIAL_H

#include <stdbool.h>

/* Both indices alike: isotropic. */
typedef struct abbe_uniaxial {
  double n_o, n_e; /* principal indices, above 0 */
  double axis[3];  /* unit; of no meaning in an isotropic medium */
} abbe_uniaxial;

/* In an isotropic medium the first is polarised across the plane of incidence (s), the second in it
 * (p). */
typedef enum abbe_uniaxial_mode {
  ABBE_UNIAXIAL_ORDINARY,
  ABBE_UNIAXIAL_EXTRAORDINARY
} abbe_uniaxial_mode;

/* Index of the extraordinary wave whose normal makes the angle of that cosine with the axis: n_o
 * along it, n_e across. */
double abbe_uniaxial_index(double n_o, double n_e, double cos_axis);

/* Angle in radians, at least 0, between ray and normal of that wave: 6.2 degrees in calcite at 45
 * degrees. */
double abbe_uniaxial_walk_off(double n_o, double n_e, double cos_axis);

/* Natural attenuation a metre of ray of the extraordinary wave whose ray makes the angle of that
 * cosine with the axis, in a crystal whose fields across the axis and along it lose a_o and a_e a
 * metre: k0 E* Im(permittivity) E / |Re E x H*| with Im of each principal permittivity n a / k0.
 * Exact to the first order in the imaginary part of the index. a_o along the axis, a_e across. */
double abbe_uniaxial_attenuation(double n_o, double n_e, double a_o, double a_e, double cos_ray);

/* From a wave's normal to its ray and back; they are the same but for the extraordinary wave. out
 * may be the other. */
void abbe_uniaxial_ray(const abbe_uniaxial *medium, abbe_uniaxial_mode mode, const double normal[3],
                       double ray[3]);
void abbe_uniaxial_normal(const abbe_uniaxial *medium, abbe_uniaxial_mode mode, const double ray[3],
                          double normal[3]);

/* A wave that leaves a face. */
typedef struct abbe_uniaxial_wave {
  double
      share; /* its share of the power that came to the face; 0 for one that clings to the face */
  double index;        /* along its normal; the fields below hold where share > 0 or it travels */
  double normal[3];    /* the wave's normal */
  double ray[3];       /* the direction of its energy */
  double field[3];     /* the unit direction of its electric field */
  double amplitude[2]; /* real and imaginary part along it, for an incident field of 1 */
  bool travels;        /* false: evanescent */
} abbe_uniaxial_wave;

/* By abbe_uniaxial_mode. The shares of all four add up to 1. */
typedef struct abbe_uniaxial_split {
  abbe_uniaxial_wave reflected[2], transmitted[2];
  double field[3]; /* the unit direction of the incident electric field */
} abbe_uniaxial_split;

/* What becomes of a wave whose ray comes from one medium (dot(ray, n) < 0) to the face of another.
 * Where it grazes (within 1e-6) all of it goes on along the mirror direction. */
void abbe_uniaxial_meet(const abbe_uniaxial *from, const abbe_uniaxial *to, const double n[3],
                        abbe_uniaxial_mode mode, const double ray[3], abbe_uniaxial_split *out);

/* The same for s and p of an isotropic medium, each of which leaves as the same waves. */
void abbe_uniaxial_meet_both(const abbe_uniaxial *from, const abbe_uniaxial *to, const double n[3],
                             const double ray[3], abbe_uniaxial_split out[2]);

/* The same for unpolarised light in an isotropic medium: shares are the means over s and p, and
 * the amplitudes those of p. */
void abbe_uniaxial_meet_unpolarised(const abbe_uniaxial *from, const abbe_uniaxial *to,
                                    const double n[3], const double ray[3],
                                    abbe_uniaxial_split *out);

#endif
