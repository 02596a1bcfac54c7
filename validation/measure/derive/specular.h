/* specular.h: light of one wavelength on specular paths, in double precision and without chance:
 * the same place on the light's window sends the same paths, so that two scenes that differ by a
 * little can be compared path by path.
 *
 * From a light through smooth refractors and off smooth mirrors to receivers, both paths at each
 * interface, up to a number of interfaces. Spheres are spheres and convex solids planes; other
 * surfaces are their triangles. What it has no path for is refused by name: crystals, rough faces,
 * films, media, fluorescence, polarisers. It uses nothing of the tracer. Internal to validation/.
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
  double (*triangle)[9]; /* [triangles] of all others but spheres, owned */
  abbe_bvh bvh;
  bool flat; /* triangles have one normal each */
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
 * for, and for a light among the refractors. */
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

/* Indices and attenuations (1/m) of the refractors at a wavelength. */
typedef struct abbe_specular_wave {
  double lambda_nm, n[ABBE_SPECULAR_REFRACTORS], a[ABBE_SPECULAR_REFRACTORS];
} abbe_specular_wave;
/* Errors of abbe_material_n. */
abbe_result abbe_specular_wave_make(const abbe_specular *s, double lambda_nm,
                                    abbe_specular_wave *out, abbe_error *error);

/* Where a path ends on a receiver. */
typedef struct abbe_specular_hit {
  double p[3], d[3]; /* and the direction in which it comes, unit */
  double flux;       /* W, of the light's power over all wavelengths; times the window's measure */
  uint32_t object;
} abbe_specular_hit;

enum { ABBE_SPECULAR_HITS = 128, ABBE_SPECULAR_MOST_INTERFACES = 32 };

/* All paths from one place of the window that met an interface. */
typedef struct abbe_specular_tree {
  size_t count;
  abbe_specular_hit hit[ABBE_SPECULAR_HITS];
  uint64_t signature; /* which surfaces all paths met, in order: the same where nothing jumped */
  double left;        /* W: of paths that are longer than that */
} abbe_specular_tree;

/* at: place on the window, 0 to 1, and on a light that has a size. interfaces: 1 to
 * ABBE_SPECULAR_MOST_INTERFACES. */
void abbe_specular_trace(const abbe_specular *s, const abbe_specular_wave *wave, const double at[4],
                         size_t interfaces, abbe_specular_tree *out);

#endif
