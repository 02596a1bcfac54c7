/* picture_options.h: --observer, --lit-by and --illuminant: how a spectral picture is looked at.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_PICTURE_OPTIONS_H
#define ABBE_CLI_OPTIONS_PICTURE_OPTIONS_H

#include "cli/base/arguments.h"
#include "colorimetry/image/display_ocio.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/screen/screen_png.h"
#include "colorimetry/spectral_picture/spectral_channels.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Zeroed but for program. */
typedef struct abbe_spectral_options {
  const char *program;
  bool given; /* one of them is */
  const char *illuminant, *lit_by;
  abbe_illuminant from, to;
  abbe_spectral_view view; /* once they are loaded; it points into this */
} abbe_spectral_options;

/* A child parser whose input is the options. */
extern const abbe_parser abbe_spectral_options_argp;

/* Help of the option --observer of what makes pictures. */
#define ABBE_OBSERVER_HELP                                                                         \
  "whose colours they are: 1931, 1964, 2015-2 (CIE 2006), 2015-10; bands serve all (1931)"

/* The observer of that name; an unknown one ends the program with ABBE_EXIT_USAGE. */
abbe_observer abbe_spectral_options_observer(const char *program, const char *text);

/* Makes the view. Errors of abbe_illuminant_make; abbe_spectral_options_free also then. */
abbe_result abbe_spectral_options_load(abbe_spectral_options *options, abbe_error *error);
void abbe_spectral_options_free(abbe_spectral_options *options);

/* Says on stderr which of the picture's channels are of a spectrum and are left out. */
void abbe_spectral_options_note_unread(const abbe_image *image, const char *layer,
                                       const char *name);

/* What commands that follow many rays are asked alike: which wavelengths, random numbers and
 * threads, and that they go on from a checkpoint. */

enum { ABBE_WORK_MOST_THREADS = 256 };
/* Zeroed but for every_s. */
typedef struct abbe_work_options {
  double min_nm, max_nm; /* 0: not given */
  size_t seed, threads;  /* threads 0: all cores */
  bool resume;
  double every_s; /* between two checkpoints */
} abbe_work_options;

/* Rows of a command's options. */
#define ABBE_WORK_OPTIONS(request, field, group, keeping)                                          \
  {"range",                                                                                        \
   0,                                                                                              \
   "FROM:TO",                                                                                      \
   0,                                                                                              \
   "wavelengths in nm (380:780)",                                                                  \
   group,                                                                                          \
   ABBE_TAKE_RANGE(request, field.min_nm, field.max_nm)},                                          \
      {"seed",                                                                                     \
       0,                                                                                          \
       "N",                                                                                        \
       0,                                                                                          \
       "of the random numbers (0)",                                                                \
       group,                                                                                      \
       ABBE_TAKE_COUNT(request, field.seed, 0, UINT32_MAX)},                                       \
      {"threads",                                                                                  \
       0,                                                                                          \
       "N",                                                                                        \
       0,                                                                                          \
       "all cores without; the result is the same",                                                \
       group,                                                                                      \
       ABBE_TAKE_COUNT(request, field.threads, 1, ABBE_WORK_MOST_THREADS)},                        \
      {"resume",                                                                                   \
       0,                                                                                          \
       NULL,                                                                                       \
       0,                                                                                          \
       "go on from the checkpoint, where there is one",                                            \
       keeping,                                                                                    \
       ABBE_TAKE_FLAG(request, field.resume)},                                                     \
  {                                                                                                \
    "checkpoint-every", 0, "SECONDS", 0, "how often it is written (30)", keeping,                  \
        ABBE_TAKE_NUMBER(request, field.every_s, 0, 1e9)                                           \
  }

/* How a picture is shown, for every command that writes one for a display:
 * --ocio, --display, --view, --exposure, --gamut, --white, --glare and --bits. */

/* Zeroed but for program. */
typedef struct abbe_screen_options {
  const char *program;
  const char *given; /* one of them, as it was given: a picture must be shown */
  abbe_display_desc display;
  bool exposed, stated; /* --exposure auto, --exposure STOPS */
  int bits;
  double glare_deg;
  bool alpha; /* the picture has channel A, and its file for a display shall have it */
} abbe_screen_options;

/* An argp child; its input is an abbe_screen_options. */
extern const abbe_parser abbe_screen_options_argp;

/* At the end of the arguments: what is given needs a picture, and its bits are such as that has.
 * Ends the program with ABBE_EXIT_USAGE. */
void abbe_screen_options_end(const abbe_screen_options *options, const char *png,
                             struct argp_state *state);

/* A view that the configuration does not have, or that the file at png does not hold, is found out
 * before the work: that of a picture in that space. Errors of abbe_display_make and
 * abbe_screen_file_check. */
abbe_result abbe_screen_options_check(const abbe_screen_options *options, const char *png,
                                      abbe_rgb_space space, abbe_error *error);

/* Shows it. `layer` and `name` as of abbe_screen_png_desc. */
abbe_result abbe_screen_options_write(const abbe_screen_options *options, const char *path,
                                      const abbe_image *image, const char *layer, const char *name,
                                      abbe_error *error);

/* The options of commands that make a receiver map: of which light, where to, laid
 * out how. */

typedef struct abbe_map_options {
  const char *save;  /* file, or NULL */
  const char *light; /* name or number, or NULL */
  const char *like;  /* file whose layout is taken, or NULL */
  /* After abbe_map_options_resolve: */
  size_t light_index;
  abbe_map_layout layout; /* layout of like; else zeroed */
  size_t side;            /* side of like's map; else 0 */
} abbe_map_options;

/* An argp child: --save-map, --map-light, --map-like. Its input is an abbe_map_options. */
extern const abbe_parser abbe_map_options_argp;

/* Reads like and finds the light: --map-light's, else the one that like names, else the first.
 * With `sized` like's map must be square, for its side is taken. */
abbe_result abbe_map_options_resolve(abbe_map_options *options, const abbe_scene *scene, bool sized,
                                     abbe_error *error);

#endif
