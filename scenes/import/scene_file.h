/* scene_file.h: scenes from YAML files. docs/scene-files.md documents the format. */
#ifndef ABBE_SCENES_IMPORT_SCENE_FILE_H
#define ABBE_SCENES_IMPORT_SCENE_FILE_H

#include "scenes/scene.h"
#include "scenes/studio/studio.h"

/* Zeroed: as the file says. */
typedef struct abbe_scene_options {
  const char *materials;  /* table to use instead of the file's: a path, "default" or "thesis" */
  const char *const *set; /* set_count of "PATH=VALUE": keys with dots between them, of a list's
                             item its number from 0 or its name, and one line of YAML; in order */
  size_t set_count;
  const char *stone;         /* "STONE", what all refractors are made of instead of one material; or
                                "NAME=STONE", of a material or an object; before set; NULL: as it is */
  const abbe_studio *studio; /* how a stone's file is shown (scenes/studio); NULL: by default */
} abbe_scene_options;

/* Loads, tessellates, checks and fixes. A stone's file in the place of a scene's is shown as
 * scenes/studio has it; its scene stands in the stone's folder. Paths in the file are relative to
 * it. Errors name file, line, key and value; ABBE_CANCELLED by the thread's watch
 * (base/thread/watch.h). On failure *out is zeroed. options may be NULL. */
abbe_result abbe_scene_load(const char *path, const abbe_scene_options *options, abbe_scene *out,
                            abbe_error *error);
/* Reads the lights of a scene that abbe_scene_load has made: its lights, ambient light and
 * background as they are with these options, which differ from those that it was made with in
 * values of these alone. All else stays as it is, so that no mesh is read again. On failure the
 * scene is unchanged; errors as of abbe_scene_load. */
abbe_result abbe_scene_load_lights(const char *path, const abbe_scene_options *options,
                                   abbe_scene *scene, abbe_error *error);
/* As abbe_scene_load, from text; name stands for the path, in messages and for relative paths. */
abbe_result abbe_scene_parse(const char *text, size_t size, const char *name,
                             const abbe_scene_options *options, abbe_scene *out, abbe_error *error);

/* The file's text with the changes of `set` and `stone` in it, every other byte as it was: what the
 * file would have to be for the scene that abbe_scene_load makes with them. *out is malloc'd and
 * ended by a zero byte that *size does not count. It is not read as a scene. */
abbe_result abbe_scene_text(const char *path, const abbe_scene_options *options, char **out,
                            size_t *size, abbe_error *error);

/* The number at a path of `set` as it stands in that text, lengths in m. ABBE_INVALID_ARGUMENT
 * where there is none, with one that is near. */
abbe_result abbe_scene_number(const char *path, const abbe_scene_options *options, const char *key,
                              double *value, abbe_error *error);

/* What in a scene can be rendered and is hardly meant: sentences for people.
 *
 * Two of one name, a camera so far away that nothing is seen, a thing sunk into its table, a light
 * that a table hides. What cannot be rendered is abbe_scene_check's. */

enum { ABBE_SCENE_MOST_DOUBTS = 16 }; /* more are left out */

typedef struct abbe_scene_doubts {
  size_t count;
  char text[ABBE_SCENE_MOST_DOUBTS][320];
} abbe_scene_doubts;

void abbe_scene_doubt(const abbe_scene *scene, abbe_scene_doubts *out);

#endif
