/* scene_input.h: the scene that a command works on: found and read, and descriptions of its objects
 * for people on stderr, in a table, and as JSON. It judges nothing; what was mended stands with the
 * objects. Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_SCENE_INPUT_H
#define ABBE_CLI_OPTIONS_SCENE_INPUT_H

#include "cli/base/arguments.h"
#include "scenes/scene.h"
#include "scenes/studio/studio.h"

struct cJSON;

enum { ABBE_SCENE_INPUT_MOST = 64 };

/* The changes by --material, --set, --tilt and --at; and, for the scene that is made of a stone's
 * file (scenes/studio/studio.h), by --look, --with, --width and --save-scene. */
typedef struct abbe_scene_input_changes {
  abbe_studio studio;
  const char *more[ABBE_STUDIO_MOST_STONES]; /* the studio's */
  const char *look, *save;                   /* as given; NULL: not */
  bool alpha;
  const char *stone; /* NULL: as the scene says */
  const char *set[ABBE_SCENE_INPUT_MOST];
  size_t set_count;
  double tilt_deg, axis_deg; /* tilt of the refractors (scenes/object_motion.h) */
  bool timed;                /* at `time` s and not when the scene says */
  double time;
} abbe_scene_input_changes;

/* Options whose request is an abbe_scene_input_changes: those of any scene, and those of a stone's
 * file. What is too much, or a tilt that is none, ends the program. */
extern const abbe_parser abbe_scene_input_options, abbe_studio_options;
#define ABBE_SCENE_INPUT_ALPHA_HELP                                                                \
  "nothing behind the objects, and how much of each pixel they cover as alpha: premultiplied in "  \
  "the EXR (channel A), straight in a PNG or WebP"
/* As --set does. */
void abbe_scene_input_set(abbe_scene_input_changes *changes, const char *text, const char *program);

/* Takes ARGP_KEY_ARG: the scene, or a stone's file, behind which more of these may follow. */
void abbe_scene_input_take_file(abbe_scene_input_changes *changes, const char **scene,
                                const char *text, struct argp_state *state);

/* The PNG of a stone's file for which no other is named: the stone's name, in this folder, held to
 * the rules of what is written (cli/base/arguments.h). NULL for a scene. */
const char *abbe_scene_input_picture(const char *program, const char *scene);

/* abbe_scene_load with that table of materials (NULL: the scene's own) of the scene with those
 * changes in it. A path that leads nowhere and is found in the share folder that came with the
 * program is taken there, with a note. Ends the program with ABBE_EXIT_USAGE where a file of the
 * scene is one that is to be written. */
abbe_result abbe_scene_input_load_with(const char *program, const char *path, const char *materials,
                                       const abbe_scene_input_changes *changes, abbe_scene *out,
                                       abbe_error *error);

/* The same scene at another time, s; its files are named already. */
abbe_result abbe_scene_input_at(const abbe_scene *scene, const char *materials,
                                const abbe_scene_input_changes *changes, double time,
                                abbe_scene *out, abbe_error *error);

/* The number of `key` in the scene, as abbe_scene_number has it. */
abbe_result abbe_scene_input_number(const abbe_scene *scene, const char *materials,
                                    const abbe_scene_input_changes *changes, const char *key,
                                    double *value, abbe_error *error);

enum { ABBE_SCENE_INPUT_ALPHA_SAMPLES = 8 }; /* for a traced picture */
/* Before a picture is traced: with --alpha its camera has no aperture, else ABBE_UNSUPPORTED. */
abbe_result abbe_scene_input_check_alpha(const abbe_scene *scene, abbe_error *error);
/* Appends channel A to a picture of the scene, of whose pixels so many samples a side are taken. */
abbe_result abbe_scene_input_add_alpha(const abbe_scene *scene, size_t samples, abbe_image *picture,
                                       abbe_error *error);

/* To stderr: what was mended, what is not whole still, and what is hardly meant. */
void abbe_scene_input_note(const abbe_scene *scene);

/* To stdout: each object with its size and place. */
void abbe_scene_input_list(const abbe_scene *scene);

/* The same as an array under "objects". */
void abbe_scene_input_list_json(const abbe_scene *scene, struct cJSON *root);

#endif
