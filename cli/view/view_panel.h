/* view_panel.h: the panel beside the picture: scene, settings, errors, plan, ledger, a pixel. */
#ifndef ABBE_CLI_VIEW_VIEW_PANEL_H
#define ABBE_CLI_VIEW_VIEW_PANEL_H

#include "cli/view/view_session.h"

/* Within an open panel. What it changes goes into the session's state. */
void abbe_view_panel_draw(abbe_view_session *session, double now_s);

#endif
