/* coating.h: thin films on an object that refracts, on all of it or on named facets, and how rough
 * such facets are.
 *
 * A stack of isotropic layers, from outside in, or a table of what a film was measured to do
 * (spectral/film.h). It is the same film from either side. Files of coatings are read here as well.
 */
#ifndef ABBE_SCENES_COATING_COATING_H
#define ABBE_SCENES_COATING_COATING_H

#include "base/error.h"
#include "spectral/film.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_COATINGS_MOST 16 /* of one object */

typedef struct abbe_coating_layer {
  const abbe_material *material; /* of the scene's table, or NULL: */
  abbe_spectrum *n, *k;          /* of a coating file, owned; or NULL: */
  abbe_film_table *table;        /* of a file, owned, the coating's one layer; or NULL: */
  double index[2];               /* n and k at all wavelengths */
  double nm;                     /* thickness */
} abbe_coating_layer;

typedef struct abbe_coating {
  size_t count;
  abbe_coating_layer layer[ABBE_FILM_MOST_LAYERS];
  double alpha; /* of facets that are rough, which have no layers; 0: of a film */
  char *path;   /* the file that it is of, or NULL */
  char *faces; /* names of facets, each ends with a zero, an empty one is behind the last; NULL: the
                  whole object */
} abbe_coating;

typedef struct abbe_coatings {
  size_t count;
  abbe_coating coating[ABBE_COATINGS_MOST];
  uint8_t *face;     /* [face_count] of the object's mesh: 0: bare, else the number of the coating,
                        from 1; NULL: the first is on all of it */
  size_t face_count; /* 0 without */
} abbe_coatings;

/* Safe on NULL. */
void abbe_coatings_free(abbe_coatings *coatings);

/* The coating on that face of the mesh, or NULL: it is bare. */
const abbe_coating *abbe_coatings_on(const abbe_coatings *coatings, size_t face);

/* Its layers at lambda_nm. A file's points are joined by straight lines, and held beyond their
 * ends. Errors of abbe_material_n and abbe_material_nk. */
abbe_result abbe_coating_at(const abbe_coating *coating, double lambda_nm,
                            abbe_film_layer layer[ABBE_FILM_MOST_LAYERS], abbe_error *error);

/* Mixes into the digest h what the coating is at lambda_nm. */
uint64_t abbe_coating_digest(uint64_t h, const abbe_coating *coating, double lambda_nm);

/* Unpolarised shares of light at normal incidence on an object of index n in air, from outside or
 * inside. */
abbe_result abbe_coating_straight(const abbe_coating *coating, double n, bool inside,
                                  double lambda_nm, double *reflected, double *transmitted,
                                  abbe_error *error);

/* The named coating of a COATING.DAT, which is text: MATE, COAT and TABLE; thicknesses that are
 * waves count at primary_nm, and are refused where it is 0. A material that the file lacks is
 * looked for in the table. Or the one coating of a file .coated, where name may be NULL.
 * ABBE_NOT_FOUND lists the names; ABBE_UNSUPPORTED by name for ideal coatings, loops, tapers and
 * encrypted files; ABBE_PARSE with the line. */
abbe_result abbe_coating_file_read(const char *path, const char *name, double primary_nm,
                                   const abbe_material_table *table, abbe_coating *out,
                                   abbe_error *error);

/* Adds a layer of that material; one that is a crystal is refused by name, as is one too many. */
abbe_result abbe_coating_add(abbe_coating *coating, const abbe_coating_layer *layer,
                             abbe_error *error);

#endif
