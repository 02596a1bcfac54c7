/* scene_doubts.h: what in a scene can be rendered and is hardly meant: sentences for people.
 *
 * Two of one name, a camera so far away that nothing is seen, a thing sunk into its table, a light
 * that a table hides. What cannot be rendered is abbe_scene_check's. */
#ifndef ABBE_SCENES_CHECK_SCENE_DOUBTS_H
#define ABBE_SCENES_CHECK_SCENE_DOUBTS_H

#include "scenes/scene.h"

enum { ABBE_SCENE_MOST_DOUBTS = 16 }; /* more are left out */

typedef struct abbe_scene_doubts {
  size_t count;
  char text[ABBE_SCENE_MOST_DOUBTS][320];
} abbe_scene_doubts;

void abbe_scene_doubt(const abbe_scene *scene, abbe_scene_doubts *out);

#endif
