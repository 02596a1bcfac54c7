/* view_marks.h: what is drawn over the picture: handles, the picked pixel, and what feeds that. */
#ifndef ABBE_CLI_VIEW_VIEW_MARKS_H
#define ABBE_CLI_VIEW_VIEW_MARKS_H

#include "cli/view/view_session.h"

/* Between abbe_ui_begin and the panel. */
void abbe_view_marks_draw(const abbe_view_session *session);

#endif
