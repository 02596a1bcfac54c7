/* lib_handles.h: what is behind a picture's handle, for those that make and compare pictures.
 * Internal to cli/library/.
 */
#ifndef ABBE_LIBRARY_LIB_HANDLES_H
#define ABBE_LIBRARY_LIB_HANDLES_H

#include "colorimetry/image/image.h"
#include "cli/library/lib_picture.h"

struct abbe_lib_picture {
  abbe_image image;
};

/* A handle that takes over the image, which is zeroed; on failure, too, the image is freed. */
abbe_result abbe_library_picture_adopt(abbe_image *image, abbe_lib_picture **out,
                                       abbe_error *error);

#endif
