/* scene_input.h: the scene that a command works on: found and read, and descriptions of its objects
 * for people on stderr, in a table, and as JSON. It judges nothing; what was mended stands with the
 * objects. Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_SCENE_INPUT_H
#define ABBE_CLI_OPTIONS_SCENE_INPUT_H

#include "cli/base/arguments.h"
#include "scenes/scene.h"
#include "scenes/studio/studio.h"

#include <argp.h>

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

/* Rows of a command's options, and in *changes what they say. */
enum {
  ABBE_SCENE_INPUT_MATERIAL = 0x7f00,
  ABBE_SCENE_INPUT_SET,
  ABBE_SCENE_INPUT_TILT,
  ABBE_SCENE_INPUT_AT,
  ABBE_SCENE_INPUT_LOOK,
  ABBE_SCENE_INPUT_WITH,
  ABBE_SCENE_INPUT_SETTING,
  ABBE_SCENE_INPUT_METAL,
  ABBE_SCENE_INPUT_WIDTH,
  ABBE_SCENE_INPUT_SAVE,
  ABBE_SCENE_INPUT_ALPHA
};
#define ABBE_SCENE_INPUT_ALPHA_OPTION(group)                                                       \
  {                                                                                                \
    "alpha", ABBE_SCENE_INPUT_ALPHA, NULL, 0,                                                      \
        "nothing behind the objects, and how much of each pixel they cover as alpha: "             \
        "premultiplied in the EXR (channel A), straight in a PNG or WebP",                         \
        group                                                                                      \
  }
#define ABBE_SCENE_INPUT_STUDIO_OPTIONS(group)                                                     \
  {"look",                                                                                         \
   ABBE_SCENE_INPUT_LOOK,                                                                          \
   "NAME",                                                                                         \
   0,                                                                                              \
   "of a stone's file: white, for a catalogue; black, for pale stones; velvet, for a window; "     \
   "daylight, for its colour; darkfield, for what is inside; lightbox, for its pattern; "          \
   "dispersion and fire, for its sparks; backdrop, for a poster (white)",                          \
   group},                                                                                         \
      {"with",                                                                                     \
       ABBE_SCENE_INPUT_WITH,                                                                      \
       "WHAT",                                                                                     \
       0,                                                                                          \
       "what a stone's file is shown with: table, ring, none (table)",                             \
       group},                                                                                     \
      {"setting",                                                                                  \
       ABBE_SCENE_INPUT_SETTING,                                                                   \
       "KIND",                                                                                     \
       0,                                                                                          \
       "metal around each stone of a file: prongs, bezel, channel, band, pave (none)",             \
       group},                                                                                     \
      {"metal",                                                                                    \
       ABBE_SCENE_INPUT_METAL,                                                                     \
       "NAME",                                                                                     \
       0,                                                                                          \
       "of a ring or a setting: gold, silver, platinum, rhodium, palladium, gold-18k, "            \
       "rose-gold-18k … (gold)",                                                                   \
       group},                                                                                     \
      {"width",                                                                                    \
       ABBE_SCENE_INPUT_WIDTH,                                                                     \
       "LENGTH",                                                                                   \
       0,                                                                                          \
       "of a stone's file, its smaller extent, such as 6.5mm or 0.2in; a bare number is of mm "    \
       "(as its file has it, else 6.5mm)",                                                         \
       group},                                                                                     \
  {                                                                                                \
    "save-scene", ABBE_SCENE_INPUT_SAVE, "FILE.yaml", ABBE_ARGUMENT_WRITES,                        \
        "write the scene that is made of a stone's file, to be edited", group                      \
  }
#define ABBE_SCENE_INPUT_OPTIONS(group)                                                            \
  {"material",                                                                                     \
   ABBE_SCENE_INPUT_MATERIAL,                                                                      \
   "[NAME=]STONE",                                                                                 \
   0,                                                                                              \
   "make the refractors of STONE; where they are of several materials, those of the material or "  \
   "object NAME",                                                                                  \
   group},                                                                                         \
      {"set",                                                                                      \
       ABBE_SCENE_INPUT_SET,                                                                       \
       "KEY=VALUE",                                                                                \
       0,                                                                                          \
       "another value in the scene, such as camera.fov=30 or lights.lamp.intensity=2; may be "     \
       "repeated",                                                                                 \
       group},                                                                                     \
      {"tilt",                                                                                     \
       ABBE_SCENE_INPUT_TILT,                                                                      \
       "DEG[,AXIS]",                                                                               \
       0,                                                                                          \
       "tilt the refractors about their middle, about the horizontal axis of azimuth AXIS (0: "    \
       "+x)",                                                                                      \
       group},                                                                                     \
  {                                                                                                \
    "at", ABBE_SCENE_INPUT_AT, "SECONDS", 0,                                                       \
        "the scene at that time, of its waves and keyframes (its own 'time', else 0)", group       \
  }
/* ARGP_ERR_UNKNOWN where key is none of them; ends the program where there are too many,
 * or where a tilt is none. */
error_t abbe_scene_input_take(abbe_scene_input_changes *changes, int key, const char *text,
                              const char *program);

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
