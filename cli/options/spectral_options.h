/* spectral_options.h: --observer, --lit-by and --illuminant: how a spectral picture is looked at.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_OPTIONS_SPECTRAL_OPTIONS_H
#define ABBE_CLI_OPTIONS_SPECTRAL_OPTIONS_H

#include "colorimetry/spectral_picture/spectral_colour.h"

#include <argp.h>
#include <stdbool.h>

/* Zeroed but for program. */
typedef struct abbe_spectral_options {
  const char *program;
  bool given; /* one of them is */
  const char *illuminant, *lit_by;
  abbe_illuminant from, to;
  abbe_spectral_view view; /* once they are loaded; it points into this */
} abbe_spectral_options;

/* A child parser whose input is the options. */
extern const struct argp abbe_spectral_options_argp;

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

#endif
