/* photon.h: photons on their way from a light, where they land, and where their light went.
 * Internal to validation/. */
#ifndef ABBE_VALIDATION_TRACE_WALKS_PHOTON_H
#define ABBE_VALIDATION_TRACE_WALKS_PHOTON_H

#include <stdbool.h>
#include <stdint.h>

#define ABBE_PHOTON_SPLITS 2 /* first interfaces that a path may be split at */

typedef struct abbe_photon {
  float o[3], d[3]; /* frame; d unit */
  float flux;       /* W */
  float y;          /* Y of a watt at its wavelength, for the ledger; mean 1 */
  uint32_t step;    /* step of the spectral sampling */
  float within;     /* place in the step, [0, 1) */
  uint32_t id;      /* its random numbers; unique in its pass, and next to its neighbours' */
} abbe_photon;

/* A segment of a path that has met a refractor or a mirror: from o along unit d, frame units. */
typedef struct abbe_light_stretch {
  float o[3], d[3];
  float length; /* INFINITY where it meets nothing more */
  float flux;   /* as it sets out, W */
  uint32_t step;
  float within;
  uint32_t id, steps; /* number of the photon; interfaces met so far */
  int medium;         /* the refractor that it is in, or -1: the air */
  bool known;         /* paths of the camera that a refractor's haze turns find such light: haze has
                         scattered it before, or its first interface was a rough face */
  bool glows;         /* it is of the glow of something */
  uint8_t wave;       /* in a crystal: which of its two */
} abbe_light_stretch;

/* Where a photon hit a receiver. */
typedef struct abbe_photon_hit {
  uint32_t surface, face;
  float u, v;
  float p[3]; /* frame */
  float side; /* +1: on the side of the face's normal, -1: on the other */
  float flux; /* W */
  uint32_t step;
  /* Chance with which the first interfaces sent it where they did; 1 where its path was split
   * there, or where there was no choice. */
  float chance[ABBE_PHOTON_SPLITS];
  bool hidden; /* from the light by other receivers, so that its map has no place for it */
  bool glows;  /* it is of the glow of something */
} abbe_photon_hit;

/* Where the light of the photons went: W, each wavelength with its share of Y. The words are those
 * of the renderer's ledger (gl/device/statistics.h). */
typedef struct abbe_light_ledger {
  double reached;   /* brought to a refractor, before anything else */
  double deposited; /* on receivers */
  double contact;   /* the part of it that came from inside a refractor that touches the receiver */
  double hidden;    /* the part of it that other receivers hide from the light, so that its map does
                       not hold it; of the light that a map is made of */
  double absorbed;  /* along inner paths, and by what the air holds */
  double missed;    /* met no receiver; with it what the renderer's ledger has as reflected */
  double trapped;   /* matched physics: the path was as long as the renderer follows one, and still
                       reflected; 0 with full physics */
  double lost;      /* where single precision lost track of inside and outside, or the path was
                       longer than 10000 interfaces; the renderer has no such light */
  double scattered; /* off its path by a medium that scatters once, after its first refractor or
                       mirror */
  double turned;    /* the part of all that which a refractor's haze has scattered, once or more */
  double frosted;   /* the part of all that which has met a rough face */
  double excited;   /* taken by fluorescence, and ended there */
  double glowing;   /* emitted by it, and followed on: reached and glowing go where the rest says */
  double quanta[2]; /* the photons of both, in W nm: taken, and emitted of whatever wavelength */
} abbe_light_ledger;

#endif
