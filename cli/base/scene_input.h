/* scene_input.h: the scene that a command works on: found and read, and what is to be said of its
 * objects to people on stderr, in a table, and as JSON. It judges nothing; what was mended stands
 * with the objects.
 */
#ifndef ABBE_CLI_BASE_SCENE_INPUT_H
#define ABBE_CLI_BASE_SCENE_INPUT_H

#include "scenes/scene.h"

struct cJSON;

/* abbe_scene_load with that table of materials (NULL: the scene's own). A path that leads nowhere
 * and is found in the share folder that came with the program is taken there, with a note. Ends the
 * program with ABBE_EXIT_USAGE where a file of the scene is one that is to be written. */
abbe_result abbe_scene_input_load(const char *program, const char *path, const char *materials,
                                  abbe_scene *out, abbe_error *error);

/* To stderr: what was mended, and what is not whole still. */
void abbe_scene_input_note(const abbe_scene *scene);

/* To stdout: each object with its size and place. */
void abbe_scene_input_list(const abbe_scene *scene);

/* The same as an array under "objects". */
void abbe_scene_input_list_json(const abbe_scene *scene, struct cJSON *root);

#endif
