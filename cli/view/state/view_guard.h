/* view_guard.h: who may speak with the viewer's page. Connections wait here until they have shown
 * the token, so that those who have none take nothing that its owner needs. Internal to cli/view/.
 *
 * It knows sockets and texts. One thread looks; any may close it. */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_GUARD_H
#define ABBE_CLI_VIEW_STATE_VIEW_GUARD_H

#include "base/error.h"

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

enum {
  ABBE_VIEW_GUARD_MOST = 32,     /* connections that have shown the token */
  ABBE_VIEW_GUARD_WAITING = 512, /* that have not: of one too many the oldest ends */
  ABBE_VIEW_GUARD_HEAD_S = 5 /* from a connection to the token, in the first line of its request */
};

typedef struct abbe_view_guard {
  int listening, epoll;
  unsigned port; /* port of 127.0.0.1 */
  const char *token;
  /* Takes a connection whose request has the token, and closes its socket. */
  void (*enter)(void *user, int socket);
  void *user;
  struct {
    int socket; /* -1: none */
    bool refused;
    double since_s;
  } waiting[ABBE_VIEW_GUARD_WAITING]; /* by their order */
  size_t next;
  pthread_mutex_t lock; /* guards what is done with connections, and this: */
  bool closed;
} abbe_view_guard;

/* Listens at that port of 127.0.0.1, 0: any free one; token, enter and user are given, all else is
 * 0. ABBE_IO where the port is taken. */
abbe_result abbe_view_guard_begin(abbe_view_guard *guard, unsigned port, abbe_error *error);
/* A socket that listens at that port of 127.0.0.1 and does not wait; the caller closes it, also
 * after an error where it is not below 0. *port 0 becomes a free one. ABBE_IO as above. */
abbe_result abbe_view_guard_listen(unsigned *port, int *socket, abbe_error *error);
/* Waits for connections and what they bring for so many seconds at most, and does with it what is
 * right; ends those that have waited too long. */
void abbe_view_guard_look(abbe_view_guard *guard, double seconds);
/* Nobody enters any more. */
void abbe_view_guard_close(abbe_view_guard *guard);
/* After the last look. A guard that did not begin may be ended. */
void abbe_view_guard_end(abbe_view_guard *guard);

/* Whether they are equal, in a time that does not depend on how much of it is right. */
bool abbe_view_guard_is_token(const char *token, const char *given, size_t length);
/* Whether a request's Host, which may be NULL, is this machine by a name that no name server has:
 * localhost, 127.0.0.1 or [::1], with or without a port. */
bool abbe_view_guard_is_host(const char *host);
/* Whether a request's Origin is that of a page of this Host; NULL: it says none. */
bool abbe_view_guard_is_origin(const char *origin, const char *host);

#endif
