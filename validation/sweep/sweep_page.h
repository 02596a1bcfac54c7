/* sweep_page.h: one or more sweeps as a Markdown page with pictures beside it.
 *
 * Of each scene: the reference, the cheapest, the middle and the most accurate setting of its
 * front, and the baselines. Scenes and references are read from the paths in the tables; what is
 * gone leaves out its pictures, with a note.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_PAGE_H
#define ABBE_VALIDATION_SWEEP_SWEEP_PAGE_H

#include "gl/device/context.h"
#include "validation/sweep/sweep_reference.h"
#include "validation/tradeoff/sweep_table.h"

#define ABBE_SWEEP_PAGE_PICTURES 6 /* pictures of a table, at the most */

/* Writes the page of tables[count], whose fronts of that time and that error are found, and its
 * pictures. */
abbe_result abbe_sweep_page_write(abbe_context *context, const char *path,
                                  const abbe_sweep_table *tables, size_t count,
                                  abbe_sweep_number time, abbe_sweep_number number,
                                  abbe_error *error);

/* The file of such a picture, for whoever must know what the page will write:
 * "PAGE-SCENE-what.png", and "PAGE-SCENE-2-what.png" for the second table of a scene of that name.
 */
void abbe_sweep_page_picture(const char *path, const abbe_sweep_table *tables, size_t table,
                             size_t picture, char out[ABBE_SWEEP_PATH]);

#endif
