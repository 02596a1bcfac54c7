/* media.h: what a path is in, and what its wavelength sees of it.
 *
 * Refractors may overlap: where they do, the one listed last in the scene file is there. So the
 * set of refractors around a point is enough to know its medium, and a surface that another,
 * later refractor covers is no interface, nor is one between two of the same material. The tables
 * hold index and attenuation of every refractor at the sampler's wavelengths. Air (n = 1) is where
 * no refractor is. A crystal has two indices and an axis, or three of each (double_refraction.h);
 * two of one material are one medium where their axes are alike. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_MEDIA_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_MEDIA_H

#include "base/error.h"
#include "scenes/coating/coating.h"
#include "spectral/biaxial.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/haze.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef uint64_t abbe_media_set; /* bit i: inside refractor i */

/* The refractor that the point is in, or -1: air. */
static inline int abbe_media_of(abbe_media_set set) {
  return set != 0 ? 63 - __builtin_clzll(set) : -1;
}

/* Sets on both sides of refractor i's surface for a ray that comes from set; entering: it runs
 * against the outward normal. */
static inline void abbe_media_cross(abbe_media_set set, uint32_t i, bool entering,
                                    abbe_media_set *before, abbe_media_set *after) {
  abbe_media_set bit = (abbe_media_set)1 << i;
  *before = entering ? set & ~bit : set | bit;
  *after = entering ? set | bit : set & ~bit;
}

/* What films on faces make of unpolarised light: layers at the sampler's steps; shares are computed
 * where they are asked for, in double precision (spectral/film.h).
 * A zeroed one is of no films. */
typedef struct abbe_films {
  size_t count, steps;
  double *lambda_nm;                               /* [steps + 1] */
  size_t *layers;                                  /* [count] */
  abbe_film_layer (*layer)[ABBE_FILM_MOST_LAYERS]; /* [count][steps + 1] */
  const abbe_coatings **on; /* [refractors] or NULL; the films of each follow one another: */
  size_t *first;            /* [refractors] */
  uint64_t key; /* a digest of all that, of rough facets and of glow; 0: none of it is there */
} abbe_films;

/* Errors as abbe_coating_at. */
abbe_result abbe_films_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                            abbe_films *out, abbe_error *error);
void abbe_films_free(abbe_films *films);

/* The film on a refractor's face, or -1. */
static inline int abbe_films_on(const abbe_films *f, uint32_t refractor, uint32_t face) {
  if (f->count == 0 || f->on[refractor] == NULL) return -1;
  const abbe_coatings *c = f->on[refractor];
  const int number = c->face == NULL ? 1 : c->face[face];
  return number == 0 ? -1 : (int)f->first[refractor] + number - 1;
}

/* The layers of a film within step k at the share `within` of it, of which it has layers[film], and
 * the wavelength there. */
double abbe_films_at(const abbe_films *films, int film, uint32_t k, float within,
                     abbe_film_layer layer[ABBE_FILM_MOST_LAYERS]);

/* Light that comes from index n_from to n_to, from outside where it is entering, within step k at
 * the share `within` of it. *passes: what is not absorbed, 0 to 1; returns the share of that which
 * is reflected. */
float abbe_films_reflectance(const abbe_films *films, int film, bool entering, float n_from,
                             float n_to, float cos_i, uint32_t k, float within, float *passes);

typedef struct abbe_media {
  size_t refractors, steps;
  float *n;              /* [refractors][steps + 1] at the steps' edges */
  float *attenuation;    /* the same, a frame unit; NULL where all are clear */
  bool *dispersive;      /* [refractors] the index varies over the steps */
  uint32_t *stuff;       /* [refractors] the first refractor of the same material */
  float *extraordinary;  /* the other index of crystals, as n; NULL where there are none */
  bool *crystal;         /* [refractors] */
  double (*axis)[3];     /* [refractors] unit, of crystals */
  float *principal;      /* [refractors][steps + 1][3] indices of crystals along x, y, z; NULL where
                            none has three */
  double (*frame)[3][3]; /* [refractors] x, y, z of crystals, unit */
  bool *biaxial, *pleochroic; /* [refractors] */
  float *pleochroism; /* [refractors][steps + 1][3] attenuation along x, y, z, a frame unit; NULL
                         where no crystal absorbs by direction */
  abbe_haze haze;     /* what scatters in them and in the air */
  abbe_films films;   /* on their surfaces */
  const abbe_coatings **rough; /* [refractors] their rough facets, or NULL; NULL: none has any */
} abbe_media;

/* Tables over the steps + 1 wavelengths lambda_nm, ascending. Errors as abbe_material_n. */
abbe_result abbe_media_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                            abbe_media *out, abbe_error *error);
void abbe_media_free(abbe_media *media);

/* Takes all faces for smooth, as the renderer does. */
void abbe_media_polish(abbe_media *media);

/* Whether the medium (-1: air) has two indices. */
static inline bool abbe_media_is_crystal(const abbe_media *m, int i) {
  return i >= 0 && m->extraordinary != NULL && m->crystal[i];
}

/* Whether it has three. */
static inline bool abbe_media_is_biaxial(const abbe_media *m, int i) {
  return i >= 0 && m->principal != NULL && m->biaxial[i];
}

/* Whether two media (-1: air) are one, so that there is no interface between them. */
static inline bool abbe_media_same(const abbe_media *m, int a, int b) {
  return a == b || (a >= 0 && b >= 0 && m->stuff[a] == m->stuff[b]);
}

/* The film on the surface that is hit between two media, or -1; a covered surface has none. */
static inline int abbe_media_film(const abbe_media *m, int from, int to, const abbe_hit *hit) {
  return from == to ? -1 : abbe_films_on(&m->films, hit->surface->index, hit->face);
}

/* How rough the surface is that is hit between two media, 0: it is smooth, or no interface. */
static inline float abbe_media_roughness(const abbe_media *m, int from, int to,
                                         const abbe_hit *hit) {
  if (m->rough == NULL || abbe_media_same(m, from, to)) return 0;
  const abbe_coating *c = abbe_coatings_on(m->rough[hit->surface->index], hit->face);
  return c != NULL ? (float)c->alpha : 0;
}

/* Index of medium i (-1: air) within step k, at the share f of it. */
static inline float abbe_media_n(const abbe_media *m, int i, uint32_t k, float f) {
  if (i < 0) return 1;
  const float *n = m->n + (size_t)i * (m->steps + 1) + k;
  return n[0] + f * (n[1] - n[0]);
}

/* Attenuation, natural, a frame unit. */
static inline float abbe_media_attenuation(const abbe_media *m, int i, uint32_t k, float f) {
  if (i < 0 || m->attenuation == NULL) return 0;
  const float *a = m->attenuation + (size_t)i * (m->steps + 1) + k;
  return a[0] + f * (a[1] - a[0]);
}

/* Crystal i with its axes; one of two indices has the ordinary one twice. */
void abbe_media_axes(const abbe_media *media, int i, uint32_t k, float f, abbe_biaxial *out);

/* The attenuation of one wave of crystal i along the unit ray d, where some crystal is
 * pleochroic. */
float abbe_media_attenuation_along(const abbe_media *media, int i, uint32_t k, float f,
                                   const float d[3], uint8_t wave);

/* The same of any medium along the unit ray d, of that wave where it is a crystal. */
static inline float abbe_media_loss(const abbe_media *m, int i, uint32_t k, float f,
                                    const float d[3], uint8_t wave) {
  if (m->pleochroism != NULL && i >= 0 && m->pleochroic[i])
    return abbe_media_attenuation_along(m, i, k, f, d, wave);
  return abbe_media_attenuation(m, i, k, f);
}

/* What absorption and scattering take of it where there is haze. */
static inline float abbe_media_extinction(const abbe_media *m, int i, uint32_t k, float f,
                                          const float d[3], uint8_t wave) {
  if (m->pleochroism != NULL && i >= 0 && m->pleochroic[i])
    return abbe_media_attenuation_along(m, i, k, f, d, wave) +
           abbe_haze_scattering(&m->haze, i, k, f);
  return abbe_haze_extinction(&m->haze, i, k, f);
}

#endif
