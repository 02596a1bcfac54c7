/* view_script.h: the viewer led by a script, without a display: events, waiting, pictures of the
 * whole window, and assertions. docs/view.md has the commands.
 */
#ifndef ABBE_CLI_VIEW_VIEW_SCRIPT_H
#define ABBE_CLI_VIEW_VIEW_SCRIPT_H

#include "cli/view/view_app.h"

/* Runs the script in a window of that size that nobody sees. Errors name file, line and command:
 * ABBE_PARSE for what is no command, ABBE_TOLERANCE for what was asserted and is not so; and those
 * of abbe_context_make, abbe_view_app_begin. */
abbe_result abbe_view_script_run(const char *path, const abbe_view_app_desc *desc, size_t width,
                                 size_t height, abbe_error *error);

#endif
