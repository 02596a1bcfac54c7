/* exit_fill.h: tables of the rays that leave an object (scenes/volume/light_exits.h), filled by
 * following them: for each node's light a ray from each point that faces it, and two beside it,
 * which give how it changes with the light.
 *
 * Same request, same table, on any number of threads. Internal to validation/lab/.
 */
#ifndef ABBE_VALIDATION_LAB_EXIT_FILL_H
#define ABBE_VALIDATION_LAB_EXIT_FILL_H

#include "scenes/volume/caustic_volume.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/volume_body.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"

/* An object of a scene alone in one directional light of unit power, as caustics
 * that are computed beforehand have it, and its surfaces for the tracer. */

typedef struct abbe_lone_object {
  abbe_scene scene; /* a shallow copy */
  abbe_object object;
  abbe_light light;
  abbe_volume_body body;
  abbe_volume_place place;
  abbe_geometry geometry;
} abbe_lone_object;

/* It points into itself: it is not copied. The scene outlives it. ABBE_INVALID_ARGUMENT for an
 * object or light that there is not and for a receiver; errors of abbe_geometry_make. */
abbe_result abbe_lone_object_make(const abbe_scene *scene, size_t object, size_t light,
                                  abbe_lone_object *out, abbe_error *error);
void abbe_lone_object_free(abbe_lone_object *lone);
/* FNV-1a, on from h, of what light meets of it, in the tables of its materials too
 * (volume_checkpoint.h). */
uint64_t abbe_lone_object_key(const abbe_lone_object *lone, const abbe_media *media,
                              const abbe_mirrors *mirrors, uint64_t h);
/* From its centre to its surface, m. */
double abbe_lone_object_depth(const abbe_lone_object *lone);

/* How much of each cell of a region lies outside the object that stands in it.
 *
 * Straight lines from all sides, evenly spread, are cut by the object's surface: what lies outside
 * of it, of all that lies in a cell. It follows no light. */

/* share[region->cells], 0 to 1; of cells beyond `radius` (m, that bounds the object around
 * `centre`) 1. Of a geometry with that object alone. An open mirror takes no space. ABBE_NO_MEMORY.
 */
abbe_result abbe_volume_space_measure(const abbe_geometry *geometry,
                                      const abbe_volume_region *region, const double centre[3],
                                      double radius, size_t lines, float *share, abbe_error *error);

typedef struct abbe_exit_fill_desc {
  size_t points;   /* on all of the surface */
  bool asymmetric; /* its symmetry is not looked for */
  double min_nm, max_nm;
  uint32_t seed;
  size_t threads;                            /* at least 1 */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops; or NULL */
  const char *checkpoint;   /* kept there (volume_checkpoint.h); NULL: none is */
  double checkpoint_s;
  bool resume;
} abbe_exit_fill_desc;

typedef struct abbe_exit_fill_statistics {
  uint64_t rays;    /* that were followed */
  double carried;   /* share of the light that met the object and left it */
  double alone;     /* share of exits whose change with the light is not known */
  size_t sequences; /* sequences of facets that differ */
  size_t maps;      /* that bring it onto itself */
} abbe_exit_fill_statistics;

/* Into a volume whose body, region and nodes are there. ABBE_UNSUPPORTED for a crystal, which a ray
 * leaves as two, for a medium and for a coating; ABBE_CANCELLED; errors of abbe_light_exits_make,
 * of checkpoints and of the tracer's tables. */
abbe_result abbe_exit_fill(const abbe_lone_object *lone, const abbe_exit_fill_desc *desc,
                           abbe_caustic_volume *volume, abbe_exit_fill_statistics *statistics,
                           abbe_error *error);

/* Points that light first meets an object at, spread evenly over its surface, each with a
 * wavelength and with the numbers that decide for its ray [Roberts2018]. */

/* One ray through an object that stands alone, to where it leaves it for good: the tracer's
 * surfaces, media and laws, with the decisions between reflection and transmission given from
 * outside, so that rays side by side decide alike.
 * */

#define ABBE_EXIT_WALK_CHANCES                                                                     \
  8                            /* of decisions that are given; those after follow from the last    \
                                */
#define ABBE_EXIT_WALK_MOST 64 /* interfaces; what is longer is dropped */

/* What is the same for all rays. */
typedef struct abbe_exit_space {
  const abbe_geometry *geometry;
  const abbe_media *media;
  const abbe_mirrors *mirrors;
  const uint32_t *facet; /* [faces] of the object: in which of its planes each lies; NULL: one */
} abbe_exit_space;

typedef struct abbe_exit_start {
  float place[3];      /* frame: where it should meet the surface first */
  float way[3];        /* unit, into it */
  uint32_t step;       /* step of the media's wavelengths */
  const float *chance; /* [ABBE_EXIT_WALK_CHANCES] in [0, 1) */
} abbe_exit_start;

typedef struct abbe_exit_end {
  float place[3], way[3]; /* frame; unit */
  float carried;   /* share of its light that gets there; 0: something stood before the place,
                      or none of it came out */
  uint32_t facets; /* a digest of what it met and whether it was reflected there: the same for the
                      same sequence */
} abbe_exit_end;

void abbe_exit_walk(const abbe_exit_space *space, const abbe_exit_start *start, abbe_exit_end *end);

typedef struct abbe_exit_point {
  float place[3], normal[3]; /* frame; of the face, outwards */
  uint32_t bin;              /* one of ABBE_LIGHT_EXITS_BINS */
  float chance[ABBE_EXIT_WALK_CHANCES];
} abbe_exit_point;

typedef struct abbe_exit_points {
  size_t count;
  abbe_exit_point *point; /* [count] */
  double area;            /* area of the whole surface, m2: of an open mirror both sides */
} abbe_exit_points;

/* Keeps, of `count` points on all of the surface, those that lie where the symmetry brings them, at
 * least one. Wavelengths by abbe_light_exits_chances. ABBE_GEOMETRY for a surface without area,
 * ABBE_NO_MEMORY. */
abbe_result abbe_exit_points_make(const abbe_lone_object *lone, const abbe_body_symmetry *symmetry,
                                  size_t count, double min_nm, double max_nm, uint32_t seed,
                                  abbe_exit_points *out, abbe_error *error);
void abbe_exit_points_free(abbe_exit_points *points);

#endif
