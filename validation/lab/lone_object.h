/* lone_object.h: an object of a scene alone in one directional light of unit power, as caustics
 * that are computed beforehand have it, and its surfaces for the tracer.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_LAB_LONE_OBJECT_H
#define ABBE_VALIDATION_LAB_LONE_OBJECT_H

#include "scenes/volume/volume_body.h"
#include "scenes/volume/volume_region.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/media.h"
#include "validation/trace/transport/mirrors.h"

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

#endif
