/* view_files.h: the files that a scene is read from, and whether they have changed on disk since.
 * Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_WORK_VIEW_FILES_H
#define ABBE_CLI_VIEW_WORK_VIEW_FILES_H

#include "cli/view/work/view_scene.h"

/* Zeroed: none. */
typedef struct abbe_view_files {
  size_t count;
  char **path;
  long long *changed; /* when, as far as is known; below 0: there was no such file */
} abbe_view_files;
void abbe_view_files_free(abbe_view_files *files);

/* Takes those of a scene that was just read, in place of others. Of what was there before the time
 * stays as it was: somebody else may have read it then. Without memory all stay. */
void abbe_view_files_take(abbe_view_files *files, abbe_view_scene_news *news);
/* Whether one of them is another than before; each change is reported once. One that is gone is
 * not. */
bool abbe_view_files_changed(abbe_view_files *files);

#endif
