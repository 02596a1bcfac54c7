#include "cli/base/screen_options.h"

#include "cli/base/command.h"

#include "colorimetry/colour_temperature.h"

#include <stdio.h>
#include <stdlib.h>

void abbe_screen_options_gamut(const char *program, const char *text, abbe_display_desc *desc) {
  const char *names[ABBE_GAMUT_MAP_COUNT];
  for (int i = 0; i < ABBE_GAMUT_MAP_COUNT; i++)
    names[i] = abbe_gamut_map_name((abbe_gamut_map_kind)i);
  desc->gamut = (abbe_gamut_map_kind)abbe_command_choice(program, "--gamut", text, names,
                                                         ABBE_GAMUT_MAP_COUNT);
}

void abbe_screen_options_white(const char *program, const char *text, abbe_display_desc *desc) {
  if (abbe_colour_temperature_read_white(text, desc->white)) return;
  fprintf(stderr,
          "%s: --white '%s' is no chromaticity such as 0.4476,0.4074, nor a temperature of %g to "
          "%g K such as 2856\n",
          program, text, ABBE_COLOUR_TEMPERATURE_MIN, ABBE_COLOUR_TEMPERATURE_MAX_DAYLIGHT);
  exit(ABBE_EXIT_USAGE);
}
