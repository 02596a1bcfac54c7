/* outline_file.h: outlines of pictures and maps in files. */
#ifndef ABBE_VALIDATION_COMPARE_OUTLINE_FILE_H
#define ABBE_VALIDATION_COMPARE_OUTLINE_FILE_H

#include "colorimetry/image/image.h"
#include "validation/compare/outline.h"

/* The outline of the caustic's layers where the picture has them, else of its colour; with `minus`
 * (a picture of the same size and place, or NULL) of its colour less that one's. place[0] gets
 * the picture's display window, for abbe_image_check_place, and which part of its file it is;
 * place[1] the other one's. Errors of abbe_field_load and
 * abbe_outline_make; ABBE_INVALID_ARGUMENT where there is no colour or the two do not match. */
abbe_result abbe_outline_load(const char *path, const char *minus,
                              const abbe_outline_options *options, abbe_outline *out,
                              abbe_image place[2], abbe_error *error);

#endif
