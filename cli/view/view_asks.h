/* view_asks.h: what a viewer asks of its last picture at rest: the spectral map, and where the
 * picked pixel's light has come in, and its spectrum.
 *
 * Each is asked for once, of the worker that has drawn the picture.
 */
#ifndef ABBE_CLI_VIEW_VIEW_ASKS_H
#define ABBE_CLI_VIEW_VIEW_ASKS_H

#include "cli/view/view_session.h"

/* The next question, into the request; false: there is none. */
bool abbe_view_asks_want(const abbe_view_session *session, abbe_view_request *out);
/* The request has been given to a worker. */
void abbe_view_asks_note(abbe_view_session *session, const abbe_view_request *request);
/* Takes over what the worker has found. */
void abbe_view_asks_take(abbe_view_session *session, abbe_view_result *result);
/* The session's spectrum, if there is one, is that of the picked pixel as it is seen now. */
bool abbe_view_asks_has_spot(const abbe_view_session *session);

#endif
