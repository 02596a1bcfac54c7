/* view_serve.h: the viewer as a page for a browser, for those who work on a server: the window that
 * nobody sees, over HTTP on the loopback, for who has the token. Internal to cli/view/. */
#ifndef ABBE_CLI_VIEW_VIEW_SERVE_H
#define ABBE_CLI_VIEW_VIEW_SERVE_H

#include "cli/view/view_app.h"

#include <pthread.h>
#include <stdbool.h>

/* Prints the address with its token on standard output and serves until SIGINT, SIGTERM or SIGHUP
 * come. port 0: any free one. ABBE_UNSUPPORTED in a build without libmicrohttpd, ABBE_IO where the
 * port is taken; errors of abbe_view_hidden_begin.
 *
 *   GET  /?token=T                    the page
 *   GET  /picture?token=T&after=N     the window as PNG, its number in X-Abbe-Frame; 204 where none
 *                                     later than N has come within a second
 *   POST /events?token=T              lines, at most 64 KiB: move X Y; down B [shift] [control]; up
 *                                     B; wheel CLICKS; key NAME down|up [shift] [control]; size W H
 *
 * Moves that follow each other are one, and sizes; turns of the wheel are added up. Signals are
 * obeyed within a second whatever waits. 403 without the token, with a Host that is not this
 * machine's or an Origin that is not this page's; the connection ends then, or where there is no
 * request within 5 s, and of nine such connections the oldest. 404 and 405 elsewhere, 400 with the
 * line that is wrong, 413, and 503 while too many events wait. */
abbe_result abbe_view_serve_run(unsigned port, const abbe_view_app_desc *desc, size_t width,
                                size_t height, abbe_error *error);

/* Who may speak with the viewer's page, and for how long those may who have not shown its token
 * yet: so that they cannot keep the connections that its owner needs.
 *
 * It knows sockets and texts. All functions may be called by any thread. */

enum {
  ABBE_VIEW_GUARD_MOST = 32,     /* connections */
  ABBE_VIEW_GUARD_STRANGERS = 8, /* of these without a token */
  ABBE_VIEW_GUARD_HEAD_S = 5     /* from a connection to the token in the head of its request */
};

typedef struct abbe_view_connection {
  bool used, trusted, shut;
  int socket;
  double since_s;
} abbe_view_connection;

typedef struct abbe_view_guard {
  pthread_mutex_t lock;
  abbe_view_connection connection[2 * ABBE_VIEW_GUARD_MOST];
} abbe_view_guard;

void abbe_view_guard_begin(abbe_view_guard *guard);
void abbe_view_guard_end(abbe_view_guard *guard);

/* A connection is there; the oldest of one stranger too many is shut down. NULL: there are more
 * than there can be, and this one is. */
abbe_view_connection *abbe_view_guard_enter(abbe_view_guard *guard, int socket);
/* It has shown the token. connection may be NULL, here and below. */
void abbe_view_guard_trust(abbe_view_guard *guard, abbe_view_connection *connection);
/* Before its socket is closed. */
void abbe_view_guard_leave(abbe_view_guard *guard, abbe_view_connection *connection);
/* Shuts down strangers that have been there too long, now_s by abbe_clock_seconds. */
void abbe_view_guard_look(abbe_view_guard *guard, double now_s);

/* Whether a request's Host, which may be NULL, is this machine by a name that no name server has:
 * localhost, 127.0.0.1 or [::1], with or without a port. */
bool abbe_view_guard_is_host(const char *host);
/* Whether a request's Origin is that of a page of this Host; NULL: it says none. */
bool abbe_view_guard_is_origin(const char *origin, const char *host);

#endif
