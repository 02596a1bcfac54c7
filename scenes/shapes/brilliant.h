/* brilliant.h: the round brilliant cut, the usual shape of a diamond, from its proportions.
 *
 * A crown of a table, 8 stars, 8 bezels and 16 upper halves; a girdle of 16 upright faces; a
 * pavilion of 16 lower halves and 8 mains that meet in a point: 73 flat faces. Other cuts come as
 * meshes. Terms and proportions are those of the trade [Moses2004]. Internal to scenes/.
 */
#ifndef ABBE_SCENES_SHAPES_BRILLIANT_H
#define ABBE_SCENES_SHAPES_BRILLIANT_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

/* Zero means the default in every field but the diameter. */
typedef struct abbe_brilliant {
  double diameter;     /* between opposite corners of the girdle, metres */
  double table;        /* its width between opposite corners, of the diameter; 0: 0.56 */
  double crown_rad;    /* angle of the bezels above the girdle's plane; 0: 34.5 degrees */
  double pavilion_rad; /* angle of the mains below it; 0: 40.75 degrees */
  double star;         /* how far stars reach from the table's edge to the girdle; 0: 0.5 */
  double lower;        /* how far lower halves reach from the girdle to the culet; 0: 0.77 */
  double girdle;       /* its height where it is least, of the diameter; 0: 0.03 */
} abbe_brilliant;

/* Table up, the girdle's middle in z = 0, flat faces with normals of their own.
 * ABBE_INVALID_ARGUMENT for proportions that are out of range or make no convex stone. */
abbe_result abbe_brilliant_make(const abbe_brilliant *cut, abbe_mesh *out, abbe_error *error);

#endif
