/* view_scene.h: the scene that a document says, read anew only as far as the document has changed.
 *
 * Objects stay where lights alone have changed, and all but the camera where that has moved: a mesh
 * takes longer to read than light to draw. It keeps one scene, and the one before only until its
 * owner has let go of it. Internal to cli/view/.
 */
#ifndef ABBE_CLI_VIEW_WORK_VIEW_SCENE_H
#define ABBE_CLI_VIEW_WORK_VIEW_SCENE_H

#include "cli/view/state/view_document.h"
#include "cli/view/state/view_outline.h"
#include "scenes/scene.h"

/* Zeroed, but for materials: none yet. */
typedef struct abbe_view_scene {
  const char *materials; /* a table instead of the scene's, or NULL; lives as long */
  abbe_view_document document;
  abbe_scene *now;
  abbe_camera own; /* as the file has it */
  bool relit;      /* its lights are others than before; whoever draws them says so here */
} abbe_view_scene;

/* Zeroed where nothing was read. */
typedef struct abbe_view_scene_news {
  bool outlined;
  abbe_view_outline outline;
  size_t file_count;
  char **file; /* that it was read from */
} abbe_view_scene_news;
void abbe_view_scene_news_free(abbe_view_scene_news *news);

/* Makes the scene that of the document, with the camera turned about its target by so much. reload:
 * the files anew. Where scene->now is another one then, the one before is the caller's, to be
 * dropped. On failure the scene is that of an older document still, but for the camera. Errors of
 * abbe_scene_load. */
abbe_result abbe_view_scene_take(abbe_view_scene *scene, const abbe_view_document *document,
                                 bool reload, double turn_rad, abbe_view_scene_news *out,
                                 abbe_error *error);
void abbe_view_scene_drop(abbe_scene *scene);
void abbe_view_scene_free(abbe_view_scene *scene);

/* The files that a scene is read from, and whether they have changed on disk since. */

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
