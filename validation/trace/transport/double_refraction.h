/* double_refraction.h: light at the faces of crystals, for the walks.
 *
 * Inside a crystal a path carries one of its two waves, with that wave's own linear polarisation;
 * at a face it goes on as up to two waves a side. Waves are added by power, not by amplitude: there
 * is no interference of the two. Light in isotropic media counts as unpolarised. Directions are
 * those of the rays; n is the unit normal on the side that the light comes from.
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
} abbe_wave_face;

/* The same between two media at a wavelength of the tables. */
void abbe_media_ways(const abbe_media *media, const abbe_wave_face *face, uint32_t step,
                     float within, abbe_wave_ways *out);

/* One of the ways by two numbers: reflection below the reflected share, as far as there is any,
 * and then one of both waves. */
const abbe_wave_way *abbe_wave_ways_choose(const abbe_wave_ways *ways, float chance, float which);

#endif
