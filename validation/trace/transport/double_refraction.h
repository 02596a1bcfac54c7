/* double_refraction.h: light at the faces of crystals, and polarised light at any, for the walks.
 *
 * Inside a crystal a path carries one of its two waves, with that wave's own linear polarisation;
 * at a face it goes on as up to two waves a side. Waves are added by power, not by amplitude: there
 * is no interference of the two. Light in isotropic media counts as unpolarised, or has its Q, U, V
 * over I (spectral/polarisation.h) in a frame that its ray's direction tells (polarised.c). A path
 * of the camera has those of light that runs its way. Directions are those of the rays; n is the
 * unit normal on the side that the light comes from.
 *
 * The physics is spectral/uniaxial.h's, where a face has a crystal of three indices at one side
 * spectral/biaxial.h's, in double precision.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_DOUBLE_REFRACTION_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_DOUBLE_REFRACTION_H

#include "spectral/uniaxial.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One way on from a face. */
typedef struct abbe_wave_way {
  float d[3];   /* unit */
  float share;  /* share of the light that came, above 0 */
  uint8_t wave; /* abbe_uniaxial_mode or abbe_biaxial_mode of the crystal that it goes on in; 0 in
                   isotropic media */
  bool reflected;
  float stokes[3]; /* of polarised light: Q, U, V over I; 0 in crystals */
} abbe_wave_way;

/* Reflected ways first; the shares add up to 1. */
typedef struct abbe_wave_ways {
  size_t count; /* 1 to 4 */
  abbe_wave_way way[4];
  float reflected; /* shares of the reflected ways together; 1 where there are no others */
  float passes;    /* what a film on the face does not absorb; those are shares of it */
} abbe_wave_ways;

/* wave: of the light that comes, as above. */
void abbe_wave_ways_find(const abbe_uniaxial *from, const abbe_uniaxial *to, const float n[3],
                         const float d[3], uint8_t wave, abbe_wave_ways *out);

/* The same where one of the media has three indices, or the face a film (or NULL); one of two has
 * its ordinary one twice, first.
 */
void abbe_wave_ways_find_biaxial(const abbe_biaxial *from, const abbe_biaxial *to, const float n[3],
                                 const float d[3], uint8_t wave, const abbe_biaxial_film *film,
                                 abbe_wave_ways *out);

/* The medium as a crystal or, with both indices alike, as what is none; -1: air. */
void abbe_media_crystal(const abbe_media *media, int medium, uint32_t step, float within,
                        abbe_uniaxial *out);

/* A wave that comes to a face between two media, -1: air. */
typedef struct abbe_wave_face {
  int from, to;
  int film; /* on the face, or -1 */
  bool entering;
  float n[3], d[3];
  uint8_t wave;
  const float *stokes; /* [3] of polarised light; NULL: it counts as unpolarised */
  float rough;         /* how rough it is, by GGX's alpha; 0: smooth */
} abbe_wave_face;

/* The same between two media at a wavelength of the tables. */
void abbe_media_ways(const abbe_media *media, const abbe_wave_face *face, uint32_t step,
                     float within, abbe_wave_ways *out);

/* Any medium with its axes. */
void abbe_media_place(const abbe_media *media, int medium, uint32_t step, float within,
                      abbe_biaxial *out);

/* From the faster and the slower wave to the ordinary and the other one of a crystal of two
 * indices, and back; of others as it is. */
int abbe_wave_ways_rename(const abbe_biaxial *medium, int wave);

/* Shares that add up to 1, of which the first `reflected` ways are reflected, and their sum. */
void abbe_wave_ways_balance(size_t reflected, bool film, abbe_wave_ways *out);

/* abbe_media_ways of light that counts as unpolarised. */
void abbe_unpolarised_ways(const abbe_media *media, const abbe_wave_face *face, uint32_t step,
                           float within, abbe_wave_ways *out);

/* Off a mirror from unit d to unit out: turns the light's stokes, and returns its share over that
 * of unpolarised light. A mirror of one reflectance counts as an ideal conductor. */
float abbe_polarised_mirror(const abbe_mirrors *mirrors, size_t mirror, const float d[3],
                            const float out[3], uint32_t step, float within, float stokes[3]);

/* Where a direction is bent a little. */
void abbe_polarised_bend(const float from[3], const float to[3], float stokes[3]);

/* What a light's polariser, or the camera's, passes along unit d or against it. */
void abbe_polarised_lamp(const abbe_light *light, const float d[3], float stokes[3]);
void abbe_polarised_camera(const abbe_polariser *sheet, const float right[3], const float up[3],
                           const float d[3], float stokes[3]);

/* One of the ways by two numbers: reflection below the reflected share, as far as there is any,
 * and then one of both waves. */
const abbe_wave_way *abbe_wave_ways_choose(const abbe_wave_ways *ways, float chance, float which);

/* The wave's normal times its index, for that unit ray in a medium (-1: air). */
void abbe_media_wave_vector(const abbe_media *media, int medium, uint32_t step, float within,
                            uint8_t wave, const double ray[3], double out[3]);

/* How much of the light of a rough face goes towards a light without size. */
typedef struct abbe_rough_look {
  float to[3];     /* unit, away from the face, in air */
  float density;   /* out: share of the light, 1/sr, estimated */
  float stokes[3]; /* out: of polarised light, times the density */
} abbe_rough_look;

/* One way on from a rough face. Light is followed from facet to facet until it leaves to one side:
 * what one facet sends to another is not lost, and shares are 1 but for what films absorb
 * [Heitz2016]. Facets are GGX's [Walter2007]; each reflects and refracts as a smooth face does, and
 * turns a crystal's wave into one by its share. Of the first facet alone it has reflection by the
 * height-correlated masking and refraction by Euler's beta function of both sides'. key: of the
 * random numbers. out->share is 0 of light that is still between facets after a thousand. Returns
 * how many it has met. */
uint32_t abbe_media_roughen(const abbe_media *media, const abbe_wave_face *face, uint32_t step,
                            float within, const uint32_t key[4], abbe_rough_look *look,
                            size_t looks, abbe_wave_way *out);

#endif
