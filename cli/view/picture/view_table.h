/* view_table.h: a display's table of colours (colorimetry/image/display_table.h), made on a thread
 * of its own, since that takes as long as some moving pictures. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_TABLE_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_TABLE_H

#include "colorimetry/image/display_table.h"

typedef struct abbe_view_table abbe_view_table;

/* Begins to make it, of a display that lives as long. NULL without memory or a thread. */
abbe_view_table *abbe_view_table_begin(const abbe_display *display);
/* NULL as long as it is not there, and of NULL: the transform itself serves as well, only slower.
 */
const abbe_display_table *abbe_view_table_get(const abbe_view_table *table);
/* Waits for its thread. table may be NULL. */
void abbe_view_table_free(abbe_view_table *table);

#endif
