/* setting.h: the metal that holds a stone, as closed meshes around its outline.
 *
 * It is made in the stone's own coordinates, whose z points up through the table. It
 * touches a convex stone nowhere: it keeps ABBE_SETTING_GAP of the stone's width away and does not
 * enter it. Its own parts overlap one another. It knows nothing of materials.
 */
#ifndef ABBE_SCENES_STUDIO_SETTING_H
#define ABBE_SCENES_STUDIO_SETTING_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stddef.h>

/* X(code, name): claws over the crown on two rails; a wall around the outline with a lip over the
 * crown; two walls along x with lips; the ring of a finger, upright, below the stone; a plate
 * flush with the girdle and beads that hold the stone. Channels and plates side by side
 * (abbe_setting_pitch) make a row. */
#define ABBE_SETTING_KINDS(X)                                                                      \
  X(PRONGS, prongs) X(BEZEL, bezel) X(CHANNEL, channel) X(BAND, band) X(PAVE, pave)

typedef enum abbe_setting_kind {
#define ABBE_SETTING_ENUM(code, name) ABBE_SETTING_##code,
  ABBE_SETTING_KINDS(ABBE_SETTING_ENUM)
#undef ABBE_SETTING_ENUM
      ABBE_SETTING_COUNT
} abbe_setting_kind;

#define ABBE_SETTING_GAP 1e-3   /* share of the stone's width, the smaller extent along x and y */
#define ABBE_SETTING_THICK 0.13 /* the same, where no thickness is given */
#define ABBE_SETTING_FINGER 0.0085 /* m, the inner radius of a band */
#define ABBE_SETTING_FACES 200000  /* of the stone, at the most */
#define ABBE_SETTING_LEAST 2       /* prongs or beads */
#define ABBE_SETTING_MOST 24

/* Zeroed: four prongs. */
typedef struct abbe_setting {
  abbe_setting_kind kind;
  size_t count;  /* prongs, or beads of a plate; 0: 4 */
  double thick;  /* thickness of prongs, walls, a band, m; 0: by the width */
  double radius; /* inner radius of a band, m; 0: ABBE_SETTING_FINGER */
  double unit;   /* m, one unit of the stone's mesh; 0: 1 */
} abbe_setting;

/* Around the stone's mesh. ABBE_GEOMETRY for a stone that is flat, ABBE_INVALID_ARGUMENT for values
 * out of range, ABBE_UNSUPPORTED for more than ABBE_SETTING_FACES, ABBE_CANCELLED by the thread's
 * watch, ABBE_NO_MEMORY. */
abbe_result abbe_setting_make(const abbe_mesh *stone, const abbe_setting *setting, abbe_mesh *out,
                              abbe_error *error);

/* From the middle of one stone to that of the next in a row, m: length is the outline's
 * extent along the row, width the stone's, both m after placing. */
double abbe_setting_pitch(const abbe_setting *setting, double length, double width);

#endif
