/* view_window.h: the viewer in a window, by GLFW. Internal to cli/view/. */
#ifndef ABBE_CLI_VIEW_VIEW_WINDOW_H
#define ABBE_CLI_VIEW_VIEW_WINDOW_H

#include "cli/view/view_app.h"

/* Until the window is closed. ABBE_GL where there is no display, or one without OpenGL 4.5; errors
 * of abbe_view_app_begin. */
abbe_result abbe_view_window_run(const abbe_view_app_desc *desc, size_t width, size_t height,
                                 abbe_error *error);

#endif
