/* specular.h: light of one wavelength on specular paths, in double precision and without chance:
 * the same place on the light's window sends the same paths, so that two scenes that differ by a
 * little can be compared path by path.
 *
 * From a light, or from the camera, through smooth refractors and off smooth mirrors to receivers,
 * both paths at each interface, up to a number of interfaces. Spheres are spheres and convex solids
 * planes; other surfaces are their triangles. Paths may be followed once more in another scene over
 * the surfaces that they have met, without a search for them. What it has no path for is refused by
 * name: crystals, rough faces, films, media, fluorescence, polarisers. It uses nothing of the
 * tracer. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_MEASURE_DERIVE_SPECULAR_H
#define ABBE_VALIDATION_MEASURE_DERIVE_SPECULAR_H

#include "base/error.h"
#include "scenes/mesh/bvh.h"
#include "scenes/scene.h"

#include <stddef.h>
#include <stdint.h>

/* By how much a material differs from the table's. Zeroed: by nothing. */
typedef struct abbe_specular_shift {
  const char *material; /* NULL: of none */
  double n;             /* added to every index */
  double b_um2;         /* and so much over the wavelength's square, um2: Cauchy's B */
  double v;             /* added to the Abbe number, n_d held */
  double absorption;    /* added to the attenuation, 1/m */
} abbe_specular_shift;

typedef struct abbe_specular_surface {
  const abbe_object *object;
  uint32_t refractor;    /* its number among refractors */
  uint32_t *plane;       /* [exact.count] of a convex solid: numbers of its planes; owned */
  uint32_t *numbered;    /* [exact.count] and the planes of the numbers; owned */
  double (*triangle)[9]; /* [triangles] of all others but spheres, owned */
  abbe_bvh bvh;
  uint32_t *sheet; /* [triangles] of a mesh with smooth normals, owned: those that share vertices
                      have one number, and light is bent alike over them; NULL: each its own */
} abbe_specular_surface;

/* Whether it is met as planes. */
static inline bool abbe_specular_has_planes(const abbe_specular_surface *s) {
  return s->object->exact.kind == ABBE_EXACT_CONVEX &&
         abbe_object_kind_of(s->object) == ABBE_OBJECT_REFRACTOR;
}

enum { ABBE_SPECULAR_REFRACTORS = 64 };

typedef struct abbe_specular {
  const abbe_scene *scene;
  const abbe_light *light;
  abbe_specular_shift shift;
  size_t count;
  abbe_specular_surface *surface; /* [count], one an object */
  double across[3], up[3];        /* of the light's window, before they are turned to the light */
  double centre[3], radius;       /* of what the light's window holds: refractors and mirrors */
  double window[2][2];            /* along both: from where to where it is looked through, of 1 */
  double far;                     /* longer than any path, m */
} abbe_specular;

/* The scene outlives it. ABBE_UNSUPPORTED, with the object's name, for what there are no such paths
 * for, and for a light among the refractors. light: ABBE_SPECULAR_NO_LIGHT for paths of the camera
 * alone. */
abbe_result abbe_specular_make(const abbe_scene *scene, size_t light,
                               const abbe_specular_shift *shift, abbe_specular *out,
                               abbe_error *error);
void abbe_specular_free(abbe_specular *s);

/* Narrows the light's window to what lands, by 256 x 256 trials over the wavelengths, and two of
 * their distances more. What is smaller than a trial may be lost. Errors of
 * abbe_specular_wave_make. */
abbe_result abbe_specular_narrow(abbe_specular *s, double min_nm, double max_nm, size_t interfaces,
                                 abbe_error *error);

/* Gives the light's window and the numbers of planes the meaning that they have in `base`.
 * ABBE_UNSUPPORTED, with `key` in the sentence, where the surfaces are not the same ones. */
abbe_result abbe_specular_match(abbe_specular *s, const abbe_specular *base, const char *key,
                                abbe_error *error);

/* A material's index and attenuation (1/m) at a wavelength; shift: of it or of another, or NULL.
 * Errors of abbe_material_n. */
abbe_result abbe_specular_index(const abbe_material *material, const abbe_specular_shift *shift,
                                double lambda_nm, double *n, double *attenuation,
                                abbe_error *error);

/* Indices and attenuations (1/m) of the refractors at a wavelength. */
typedef struct abbe_specular_wave {
  double lambda_nm, n[ABBE_SPECULAR_REFRACTORS], a[ABBE_SPECULAR_REFRACTORS];
} abbe_specular_wave;
/* Errors of abbe_material_n. */
abbe_result abbe_specular_wave_make(const abbe_specular *s, double lambda_nm,
                                    abbe_specular_wave *out, abbe_error *error);

enum {
  ABBE_SPECULAR_HITS = 128,
  ABBE_SPECULAR_STEPS = 2048,
  ABBE_SPECULAR_SHADOWS = 512,
  ABBE_SPECULAR_MOST_INTERFACES = 32
};
#define ABBE_SPECULAR_NO_LIGHT SIZE_MAX
/* In place of an object: nothing is met; a light that has a size, by its index. */
#define ABBE_SPECULAR_NOTHING UINT32_MAX
#define ABBE_SPECULAR_LAMP 0x80000000u

/* Where a path ends: on a receiver; the camera's also on lights and nowhere. */
typedef struct abbe_specular_hit {
  double p[3], d[3]; /* and the direction in which it comes, unit */
  double n[3];       /* outwards, or the face's */
  double flux;       /* W, of the light's power over all wavelengths; times the window's measure. Of
                        the camera's: the share of the light here that it sees */
  double side[2];    /* on the face, barycentric */
  double film[3];    /* of a light's path: where on the film the place is seen straight, in pixels,
                        and what a watt there adds to a pixel; 0: it is not seen */
  uint64_t inside;   /* the refractors that it is in, a bit each */
  uint32_t object, face;
  uint16_t met, root; /* interfaces; 0, or of paths from an earlier hit its index and 1 */
} abbe_specular_hit;

/* What a path does at a surface: a step's bits have what goes on from it. */
enum { ABBE_SPECULAR_REFRACTED = 1, ABBE_SPECULAR_REFLECTED = 2, ABBE_SPECULAR_PASSED = 4 };

/* What a path met, and the ray to it; in the order in which paths are followed. */
typedef struct abbe_specular_step {
  double o[3], d[3];
  double flux; /* that comes */
  uint64_t inside;
  uint32_t object, face;
  uint32_t from; /* the step before it; ABBE_SPECULAR_NOTHING: it is the first of its root */
  uint16_t root; /* a hit's */
  uint8_t how;   /* what it does at the step before */
  uint8_t on;
} abbe_specular_step;

/* A ray to a place that may be hidden, and what hides it. */
typedef struct abbe_specular_shadow {
  double o[3], d[3];
  double flux; /* of the path whose end it is of */
  uint32_t object, face;
} abbe_specular_shadow;

/* All paths from one place of the window that met an interface. */
typedef struct abbe_specular_tree {
  size_t count, steps, shadows;
  uint64_t signature; /* which surfaces all paths met, in order: the same where nothing jumped */
  double left;        /* W: of paths that are longer than that */
  double faint;       /* flux below which they end */
  bool whole;         /* all steps and shadows are kept */
  bool failed;        /* a surface that was known is not met any more */
  size_t until;       /* where it is known: but for that step and those before it on its path none
                         need be followed; SIZE_MAX: all are */
  bool checks;        /* where it is known: surfaces are searched for, and others are a failure */
  double at[2];       /* on the window or the film */
  double lit;         /* flux of the path whose shadows are asked for */
  double shown[3];    /* of the camera's paths: the colour that it sees */
  abbe_specular_hit hit[ABBE_SPECULAR_HITS];
  abbe_specular_step step[ABBE_SPECULAR_STEPS];
  abbe_specular_shadow shadow[ABBE_SPECULAR_SHADOWS];
} abbe_specular_tree;

/* at: place on the window, 0 to 1, and on a light that has a size. interfaces: 1 to
 * ABBE_SPECULAR_MOST_INTERFACES. known: whole; its surfaces are met, in this scene; or NULL. */
void abbe_specular_trace(const abbe_specular *s, const abbe_specular_wave *wave, const double at[4],
                         size_t interfaces, const abbe_specular_tree *known,
                         abbe_specular_tree *out);

/* The same against the light from o along unit d, inside refractors; added to *out, which is zeroed
 * but for its arrays, or has hits of others: root. */
void abbe_specular_view(const abbe_specular *s, const abbe_specular_wave *wave, const double o[3],
                        const double d[3], uint64_t inside, uint16_t root, size_t interfaces,
                        const abbe_specular_tree *known, abbe_specular_tree *out);

/* Whether something stands on the ray before `limit`, but for the object `but`; lights as well
 * where all do. limit 0: nothing does. Added to the tree's shadows and its signature, or as it is
 * known. */
typedef enum abbe_specular_what { ABBE_SPECULAR_RECEIVERS, ABBE_SPECULAR_ALL } abbe_specular_what;
bool abbe_specular_hides(const abbe_specular *s, abbe_specular_what what, const double o[3],
                         const double d[3], uint64_t inside, double limit, uint32_t but,
                         const abbe_specular_tree *known, abbe_specular_tree *tree);
/* Whether receivers hide the place on an object from the light's middle. */
bool abbe_specular_is_dark(const abbe_specular *s, const double p[3], uint32_t object,
                           const abbe_specular_tree *known, abbe_specular_tree *tree);

/* A place on a light, of two numbers from 0 to 1. */
void abbe_specular_place_on(const abbe_light *light, const double at[2], double out[3]);

static inline void abbe_specular_sign(abbe_specular_tree *tree, uint64_t what) {
  const uint64_t x = (tree->signature ^ what) * 0x9e3779b97f4a7c15u;
  tree->signature = x ^ (x >> 29);
}

#endif
