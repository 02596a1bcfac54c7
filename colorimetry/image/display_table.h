/* display_table.h: a display's transform as a table of colours, for pictures that follow one
 * another: some seven times as fast as abbe_display_apply. Of 255 steps it is off by less than one
 * nearly everywhere, by 7 at the most where a view bends sharply, as at a gamut's boundary.
 *
 * Between its nodes, which lie closer the darker they are, it is linear. Colours beyond it, such as
 * those with a part below 0, and those of cells whose middle is not so, go through the transform
 * itself.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_DISPLAY_TABLE_H
#define ABBE_COLORIMETRY_IMAGE_DISPLAY_TABLE_H

#include "colorimetry/image/display_ocio.h"

typedef struct abbe_display_table abbe_display_table;

/* Makes the table of a display, which it refers to as long as it lives. ABBE_NO_MEMORY, errors of
 * abbe_display_apply. */
abbe_result abbe_display_table_make(const abbe_display *display, abbe_display_table **out,
                                    abbe_error *error);
void abbe_display_table_free(abbe_display_table *table);

/* As abbe_display_apply, of an image of three channels; its xy, curve and transfer stay as they
 * are. */
abbe_result abbe_display_table_apply(const abbe_display_table *table, abbe_image *image,
                                     abbe_error *error);

#endif
