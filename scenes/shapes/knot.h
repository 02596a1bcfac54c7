/* knot.h: a tube along a knot, with spines on its back: a curled solid with as many faces as
 * wanted.
 *
 * Its middle line winds around a torus that stands around z, centred, and comes back to itself.
 * Smooth normals are those of the surface itself. Lengths in metres. Internal to scenes/.
 */
#ifndef ABBE_SCENES_SHAPES_KNOT_H
#define ABBE_SCENES_SHAPES_KNOT_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>

#define ABBE_KNOT_MAX_SEGMENTS 4096
#define ABBE_KNOT_MAX_WINDINGS 16
#define ABBE_KNOT_MAX_SPINES 1024

typedef struct abbe_knot {
  double major, minor;  /* the torus: around z, and of its own tube */
  double radius;        /* radius of the tube along the knot, where it has no spine */
  size_t turns, coils;  /* around z, and through the torus's hole; 0: 2, 3; no common divisor */
  size_t spines;        /* on the side away from the torus; 0: none */
  double spine;         /* how far they stand out, of the radius, 0 to 2 */
  size_t along, across; /* segments; 0: 1250, 100: 250,000 faces */
} abbe_knot;

/* 2 along across faces, closed. ABBE_INVALID_ARGUMENT where the tube would meet itself: it may be
 * as wide as the middle line's global radius of curvature [GonzalezMaddocks1999]. ABBE_NO_MEMORY.
 */
abbe_result abbe_knot_make(const abbe_knot *knot, abbe_mesh *out, abbe_error *error);

/* The radius of the widest tube along the middle line, m. */
double abbe_knot_room(const abbe_knot *knot);

#endif
