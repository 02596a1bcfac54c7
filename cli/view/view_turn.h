/* view_turn.h: the turntable of the viewer: pictures from all around, kept as PNG, and one PNG that
 * moves. */
#ifndef ABBE_CLI_VIEW_VIEW_TURN_H
#define ABBE_CLI_VIEW_VIEW_TURN_H

#include "cli/view/view_session.h"

enum { ABBE_VIEW_TURN_FRAMES = 36 };
#define ABBE_VIEW_TURN_PER_SECOND 12.0

/* Begins: KEEP-turn-0001.png and so on, and KEEP-turn.png at the end; a note says how far it is. A
 * change of anything ends it. ABBE_INVALID_ARGUMENT where no picture has come to rest. */
abbe_result abbe_view_turn_begin(abbe_view_session *session, abbe_error *error);
/* The next frame as a request; false where none is wanted. */
bool abbe_view_turn_wants(const abbe_view_session *session, abbe_view_request *out);
/* Keeps a frame that was asked for. */
void abbe_view_turn_take(abbe_view_session *session, const abbe_view_result *result);

#endif
