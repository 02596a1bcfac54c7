/* scene_notes.h: what is to be said of a scene's objects once they are read: to people on stderr,
 * in a table, and as JSON. It judges nothing; what was mended stands with the objects.
 */
#ifndef ABBE_CLI_SCENE_NOTES_H
#define ABBE_CLI_SCENE_NOTES_H

#include "scenes/scene.h"

struct cJSON;

/* To stderr: what was mended, and what is not whole still. */
void abbe_scene_notes(const abbe_scene *scene);

/* To stdout: each object with its size and place. */
void abbe_scene_list(const abbe_scene *scene);

/* The same as an array under "objects". */
void abbe_scene_list_json(const abbe_scene *scene, struct cJSON *root);

#endif
