/* view_guard.h: who may speak with the viewer's page, and for how long those may who have not shown
 * its token yet: so that they cannot keep the connections that its owner needs.
 *
 * It knows sockets and texts. All functions may be called by any thread.
 */
#ifndef ABBE_CLI_VIEW_VIEW_GUARD_H
#define ABBE_CLI_VIEW_VIEW_GUARD_H

#include <pthread.h>
#include <stdbool.h>

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
