/* studio_stone.h: what is known of a stone by its file: kind, size and what it is made of.
 * Internal to scenes/. */
#ifndef ABBE_SCENES_STUDIO_STUDIO_STONE_H
#define ABBE_SCENES_STUDIO_STUDIO_STONE_H

#include "scenes/studio/studio.h"
#include "spectral/materials/material_table.h"

typedef struct abbe_studio_stone {
  const char *path;
  bool design;        /* planes; else a mesh */
  double size[3];     /* m, x, y and z */
  double width;       /* m, the smaller of x and y */
  double girdle;      /* share of the height that is below the girdle's middle; a mesh: 0.6 */
  char material[128]; /* of the table, or "from-file" */
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
