/* screen_options.h: how a picture is shown, for every command that writes one for a display:
 * --ocio, --display, --view, --exposure, --gamut, --white, --glare and --bits. Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_SCREEN_OPTIONS_H
#define ABBE_CLI_OPTIONS_SCREEN_OPTIONS_H

#include "colorimetry/image/display_ocio.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/screen/screen_png.h"

#include <argp.h>

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
extern const struct argp abbe_screen_options_argp;

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

#endif
