/* convex.h: whether a closed mesh is a convex solid of few faces, as gems and prisms are: its
 * planes, or why it is none, by how much and where.
 *
 * Triangles that lie in one plane, to the digits of the file, make one of its faces. A solid whose
 * normals are rounded is none, for light would be bent by them and not by its faces. It reads a
 * mesh and changes nothing. Internal to scenes/. */
#ifndef ABBE_SCENES_SHAPES_CONVEX_H
#define ABBE_SCENES_SHAPES_CONVEX_H

#include "base/error.h"
#include "base/maths.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>
#include <stdint.h>

/* How far the corners of a triangle may lie off its plane, and in front of others, of the diagonal
 * of the mesh's bounds: the least that makes a solid of it is taken. Above the first, what is
 * beside a plane lies ABBE_CONVEX_CLEAR times as far off or meets it at ABBE_CONVEX_CLEAR_RAD, so
 * that a gentle curve is not taken for planes. */
#define ABBE_CONVEX_TOLERANCES                                                                     \
  { 1e-6, 1e-5, 1e-4 }
#define ABBE_CONVEX_CLEAR 10
#define ABBE_CONVEX_CLEAR_RAD (1.5 * ABBE_PI / 180)
/* And a normal of a corner off its face, rad. */
#define ABBE_CONVEX_FLAT_RAD ABBE_DEGREE

typedef enum abbe_convex_verdict {
  ABBE_CONVEX_UNASKED,
  ABBE_CONVEX_SOLID,
  ABBE_CONVEX_PARTS,  /* it is not one closed surface with its faces outwards */
  ABBE_CONVEX_MANY,   /* it takes more planes than asked for */
  ABBE_CONVEX_CURVED, /* its planes cannot be separated */
  ABBE_CONVEX_DENTED, /* a corner lies in front of a face */
  ABBE_CONVEX_ROUNDED /* normals are not those of its faces */
} abbe_convex_verdict;

typedef struct abbe_convex {
  abbe_convex_verdict verdict;
  size_t planes;    /* SOLID: so many; MANY: more than */
  double tolerance; /* SOLID: that made it one, of its size */
  double size;      /* the diagonal of its bounds, m */
  double off;       /* DENTED: m; ROUNDED, and SOLID, of thin faces too: rad; at the most */
  double place[3];  /* and where */
} abbe_convex;

/* plane[max_planes]: unit outward normal and offset, n . x <= d. plane_of[face_count] (may be
 * NULL): which of them each face lies in. Both hold where the verdict is SOLID. ABBE_NO_MEMORY. */
abbe_result abbe_convex_find(const abbe_mesh *mesh, size_t max_planes, double (*plane)[4],
                             uint32_t *plane_of, abbe_convex *out, abbe_error *error);

/* The greatest share of its size that a mesh may be flattened by. */
#define ABBE_CONVEX_MOST_FLATTENED 0.02

/* Makes the mesh the convex solid of few planes that it nearly is: triangles within `share` of its
 * size of one plane become one, by their mean, and the solid is what lies behind all planes. Its
 * faces are new, with normals of their own. *moved: how far a corner of the mesh lies off the solid
 * at the most, a share of its size. ABBE_GEOMETRY where more than max_planes are left, or a corner
 * lies off by more than three times the share, with how far and where; the mesh is then as it was.
 * ABBE_INVALID_ARGUMENT for a share of 0 or above ABBE_CONVEX_MOST_FLATTENED, ABBE_NO_MEMORY. */
abbe_result abbe_convex_flatten(abbe_mesh *mesh, double share, size_t max_planes, double *moved,
                                abbe_error *error);

/* The verdict as a part of a sentence whose subject is "it". */
void abbe_convex_reason(const abbe_convex *convex, char *text, size_t size);

#endif
