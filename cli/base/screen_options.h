/* screen_options.h: options of how pictures are shown, for every command that writes a PNG. */
#ifndef ABBE_CLI_BASE_SCREEN_OPTIONS_H
#define ABBE_CLI_BASE_SCREEN_OPTIONS_H

#include "colorimetry/image/display_ocio.h"

#define ABBE_SCREEN_GAMUT_HELP                                                                     \
  "bring colours that the screen lacks inside, before the view: clip, white (towards it at "       \
  "constant Oklab hue) or compress (as ACES 1.3); without it, as the view does"
#define ABBE_SCREEN_WHITE_HELP                                                                     \
  "what shall look white, by Bradford: a chromaticity or a temperature (daylight's from 4000 K "   \
  "on)"

/* The value of --gamut, of --white. A wrong one ends the program with ABBE_EXIT_USAGE. */
void abbe_screen_options_gamut(const char *program, const char *text, abbe_display_desc *desc);
void abbe_screen_options_white(const char *program, const char *text, abbe_display_desc *desc);

#endif
