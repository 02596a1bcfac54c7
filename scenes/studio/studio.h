/* studio.h: the scene that is made where the file of a stone stands in the place of a scene's.
 *
 * A design (.asc, .gem, .gcs) or a mesh (.stl, .obj, .ply, .gltf, .glb), or several in rows, stand
 * on a table under one of the looks (scenes/looks), which are scenes that have a table and a stone
 * of their own. What is made is the text of a scene file, that the reader of scenes reads as any
 * other.
 */
#ifndef ABBE_SCENES_STUDIO_STUDIO_H
#define ABBE_SCENES_STUDIO_STUDIO_H

#include "base/error.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>

/* X(name): scenes/looks/NAME.yaml. The first is the default. */
#define ABBE_STUDIO_LOOKS(X)                                                                       \
  X(white) X(black) X(velvet) X(daylight) X(darkfield) X(lightbox) X(dispersion) X(fire) X(backdrop)
/* X(code, name): what a stone is shown with. The first is the default. */
#define ABBE_STUDIO_WITHS(X) X(TABLE, table) X(RING, ring) X(NONE, none)

typedef enum abbe_studio_look {
#define ABBE_STUDIO_LOOK_ENUM(name) ABBE_STUDIO_LOOK_##name,
  ABBE_STUDIO_LOOKS(ABBE_STUDIO_LOOK_ENUM)
#undef ABBE_STUDIO_LOOK_ENUM
      ABBE_STUDIO_LOOK_COUNT
} abbe_studio_look;

typedef enum abbe_studio_with {
#define ABBE_STUDIO_WITH_ENUM(code, name) ABBE_STUDIO_WITH_##code,
  ABBE_STUDIO_WITHS(ABBE_STUDIO_WITH_ENUM)
#undef ABBE_STUDIO_WITH_ENUM
      ABBE_STUDIO_WITH_COUNT
} abbe_studio_with;

enum { ABBE_STUDIO_MOST_STONES = 64 };
#define ABBE_STUDIO_WIDTH_M 0.0065 /* for a design, or a mesh that cannot be meant as it is */

/* Zeroed: one stone, the default look, on a table. */
typedef struct abbe_studio {
  abbe_studio_look look;
  abbe_studio_with with;
  const char *metal;    /* metal of a ring or a setting, a conductor of the table; NULL: gold */
  int setting;          /* 1 + an abbe_setting_kind, around each stone; 0: none */
  size_t columns, rows; /* pixels of the picture; 0: its own */
  double width_m;       /* the smaller extent of each stone's outline; 0: as its file has it */
  const char *material; /* material of all stones; NULL: the file's, or the one that its index is
                           nearest to */
  const char *folder; /* where the scene is to stand, with its slash; NULL: where it is read from */
  const char *table;  /* table of materials: a path, "default", "thesis"; NULL: default */
  const char *const *more; /* [more_count], further stones' files */
  size_t more_count;
} abbe_studio;

/* Name of a studio's setting, which is not 0. */
const char *abbe_studio_setting_name(int setting);

/* Whether a path ends like a stone's file. */
bool abbe_studio_is_stone(const char *path);

/* The scene of the stone at path and those behind it; studio may be NULL. Files in `folder` (which
 * ends with a slash, or "") are named as from there, others by their whole path. *out is malloc'd
 * and ended by a zero byte that *size does not count. Errors of the files' readers; ABBE_NOT_FOUND
 * for a material that the table lacks. */
abbe_result abbe_studio_scene(const char *path, const abbe_studio *studio, const char *folder,
                              char **out, size_t *size, abbe_error *error);

/* What is known of a stone by its file: kind, size and what it is made of. */

typedef struct abbe_studio_stone {
  const char *path;
  bool design;        /* planes; else a mesh */
  double size[3];     /* m, x, y and z */
  double width;       /* m, the smaller of x and y */
  double girdle;      /* share of the height that is below the girdle's middle; a mesh: 0.6 */
  char material[128]; /* name in the table, or "from-file" */
  char note[256];     /* how that and the size were found; may be empty */
} abbe_studio_stone;

/* Errors of the file's readers. */
abbe_result abbe_studio_stone_read(const char *path, const abbe_studio *studio,
                                   abbe_studio_stone *out, abbe_error *error);

/* The clear stone of the table whose index at the d line is nearest to n, if by 0.015 or less; else
 * a coloured stone so near, else the nearest clear one. Stones are those that designs are made for,
 * by their names in the shipped table; NULL where the table has none. */
const abbe_material *abbe_studio_nearest(const abbe_material_table *table, double n);

#endif
