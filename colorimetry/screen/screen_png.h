/* screen_png.h: a scene-linear picture as a file for a screen, through OpenColorIO.
 *
 * It finds which of the picture's channels are colour and in which space they are; what the
 * transform does is display_ocio.h's.
 */
#ifndef ABBE_COLORIMETRY_SCREEN_SCREEN_PNG_H
#define ABBE_COLORIMETRY_SCREEN_SCREEN_PNG_H

#include "colorimetry/image/display_ocio.h"

/* Notes about a picture that was shown. */
typedef struct abbe_screen_png_notes {
  bool space_assumed; /* its R, G, B are of no stated space, and Rec.709's were taken */
  abbe_image_odd odd; /* odd values of the channels that are shown */
  double white;       /* the share of its pixels that are the display's white, without detail */
  bool chosen;        /* the picture's light chose the exposure */
  double exposure;    /* stops, that were taken */
  double stops;       /* by which more exposure a tenth of its finite pixels would be brighter than
                         0.8; 0: none is finite, or they are dark */
} abbe_screen_png_notes;

/* What a picture says of its exposure, as an attribute: "auto", or stops as a number. */
#define ABBE_SCREEN_EXPOSURE "abbe:exposure"

/* Zeroed: the picture's own channels in the space that it states, the default view, 8 bits. */
typedef struct abbe_screen_png_desc {
  bool exposed;              /* not by display.exposure but by notes' stops */
  bool stated;               /* by display.exposure, whatever the picture says of its exposure */
  abbe_display_desc display; /* its source_space NULL: what the picture states */
  const char *layer;         /* channels LAYER.R, LAYER.G, LAYER.B; NULL: R, G, B */
  bool alpha;                /* its channel A goes into the file, straight: colours are those
                                before they were multiplied by it */
  const char *name;          /* the picture's name, for sentences; NULL: "the picture" */
  int bits;                  /* of abbe_screen_file_write */
  double glare_deg; /* the eye's glare of a picture seen so many degrees high (screen_file.h); 0: none */
  abbe_screen_png_notes *notes; /* filled; may be NULL */
} abbe_screen_png_desc;

/* Stops that a picture's attribute wants, of channels R, G, B where that is "auto"; 0 without. */
double abbe_screen_png_exposure(const abbe_image *image);

/* Writes the kind of file that path's ending names (screen_file.h). Shows R, G, B, else X, Y, Z,
 * else Y, in the space of abbe_picture_space_find. ABBE_NOT_FOUND without such channels; errors of
 * abbe_picture_space_find, abbe_display_make, abbe_display_apply and
 * abbe_screen_file_write. */
abbe_result abbe_screen_png_write(const char *path, const abbe_image *image,
                                  const abbe_screen_png_desc *desc, abbe_error *error);

#endif
