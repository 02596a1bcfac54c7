/* display_ocio.h: from scene-linear pictures to a display, by an OpenColorIO configuration.
 *
 * The configuration is the file given, else $OCIO, else the one that ships with Abbe (compiled
 * in). A broken configuration is an error, never a silent pass-through. The implementation is
 * the C++ bridge display_ocio.cpp; no exception leaves it.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_DISPLAY_OCIO_H
#define ABBE_COLORIMETRY_IMAGE_DISPLAY_OCIO_H

#include "base/error.h"
#include "colorimetry/gamut.h"
#include "colorimetry/image/image.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_display abbe_display;

#define ABBE_DISPLAY_MAX_EXPOSURE 60.0 /* stops, up or down */

/* Zeroed: the configuration as found, its default display and view, exposure 0. */
typedef struct abbe_display_desc {
  const char *config;        /* path of a configuration; NULL: $OCIO, else the shipped one */
  const char *source_space;  /* colour space of the pictures: one of the configuration, or what
                                abbe_rgb_space_ocio_name calls it; NULL: role scene_linear */
  const char *display;       /* or an ICC profile (.icc, .icm) of a matrix and curves, which gets
                                the views of the configuration's virtual display; NULL: the default */
  const char *view;          /* NULL: the display's default view */
  double exposure;           /* stops */
  double white[2];           /* x, y of what shall look white, by Bradford; 0: D65 */
  abbe_gamut_map_kind gamut; /* how colours that the display lacks are brought inside, before the
                               view; 0: as the view does it */
} abbe_display_desc;

/* A space of Abbe's that the configuration has no name for is reached by its roles aces_interchange
 * or cie_xyz_d65_interchange, else by a name that states its primaries, else where its sRGB shows
 * that its role scene_linear is Rec.709. ABBE_COLOUR with OCIO's reason and, for an unknown
 * display, view or space, the known ones; for a configuration of a version that the library does
 * not know, with both versions; for a gamut map where the display's primaries are not known.
 * ABBE_INVALID_ARGUMENT for a white that is none. */
abbe_result abbe_display_make(const abbe_display_desc *desc, abbe_display **out, abbe_error *error);
void abbe_display_free(abbe_display *display);
ABBE_HOLDS(abbe_display)

/* Replaces the first three channels of the image by display-encoded values, and the image's xy and
 * curve by what they mean: found from the configuration where it states how the view's colour space
 * relates to CIE XYZ (interchange roles), else by the name of a display "sRGB" or "Display P3";
 * zeros where that is not known and where the view's numbers are no colours ("Raw"). Infinite
 * components count as the brightest light that no view overflows at, 2^60 after exposure, and NaN
 * as 0. */
abbe_result abbe_display_apply(const abbe_display *display, abbe_image *image, abbe_error *error);

/* One line a display and view, malloc'd, newline separated ("sRGB / Plain"); caller frees. */
abbe_result abbe_display_list(const char *config, char **out, abbe_error *error);

/* Where OpenColorIO's messages go, for the whole process, that are no errors, such as keys of a
 * configuration that it does not know; without this it writes to standard error. The message ends
 * with a newline. */
void abbe_display_set_log(void (*log)(const char *message));

#ifdef __cplusplus
}
#endif
#endif
