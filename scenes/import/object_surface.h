/* object_surface.h: an object's surface in the world: fixed, placed, told apart, known exactly
 * where it can be.
 *
 * A part of object_file.h, which reads what is asked for. Here a refractor's mesh becomes a closed
 * surface, shells that cross become solids of their own, and the surface gets its size and place.
 */
#ifndef ABBE_SCENES_IMPORT_OBJECT_SURFACE_H
#define ABBE_SCENES_IMPORT_OBJECT_SURFACE_H

#include "base/error.h"
#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_object_surface {
  double matrix[16]; /* from its own coordinates to the world */
  double radius;     /* of a sphere, in its own coordinates; 0: it is none */
  bool rectangles;   /* its mesh is made of them, four vertices each */
  bool file;         /* its mesh is a file's */
  abbe_mesh_normals normals;
  bool repair;
  double flatten; /* share of its size by which it is made a convex solid of planes, or 0 */
  double fit;     /* the longest side of its bounds, m, or 0: as it is */
  double width;   /* the smaller of their sides along x and y, m, or 0 */
  bool centred, stands;
  double centre[3]; /* where the middle of its bounds comes to stand, or of their lower side */
} abbe_object_surface;

/* From out->mesh, in its own coordinates, and out's material and name, all the rest. Shells that
 * cross become further objects behind out, *count in all, for which there is room (zeroed before).
 * ABBE_GEOMETRY for what cannot be a surface, of a refractor: in the mesh's own coordinates;
 * ABBE_UNSUPPORTED for more objects than there is room for. */
abbe_result abbe_object_place(const abbe_object_surface *surface, abbe_object *out, size_t room,
                              size_t *count, abbe_error *error);

#endif
