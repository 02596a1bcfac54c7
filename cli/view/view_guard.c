#include "cli/view/view_serve.h"

#include "base/clock.h"

#include <string.h>
#include <strings.h>
#include <sys/socket.h>

void abbe_view_guard_begin(abbe_view_guard *g) {
  memset(g->connection, 0, sizeof g->connection);
  pthread_mutex_init(&g->lock, NULL);
}

void abbe_view_guard_end(abbe_view_guard *g) {
  pthread_mutex_destroy(&g->lock);
}

static bool is_stranger(const abbe_view_connection *c) {
  return c->used && !c->trusted;
}

/* Its thread finds nothing more to read, and closes it. */
static void shut(abbe_view_connection *c) {
  c->shut = true;
  shutdown(c->socket, SHUT_RDWR);
}

static void shut_eldest(abbe_view_guard *g) {
  abbe_view_connection *eldest = NULL;
  size_t strangers = 0;
  for (size_t i = 0; i < sizeof g->connection / sizeof *g->connection; i++) {
    abbe_view_connection *c = &g->connection[i];
    if (!is_stranger(c) || c->shut) continue;
    strangers++;
    if (eldest == NULL || c->since_s < eldest->since_s) eldest = c;
  }
  if (strangers > ABBE_VIEW_GUARD_STRANGERS) shut(eldest);
}

abbe_view_connection *abbe_view_guard_enter(abbe_view_guard *g, int socket) {
  abbe_view_connection *free_one = NULL;
  pthread_mutex_lock(&g->lock);
  for (size_t i = 0; i < sizeof g->connection / sizeof *g->connection && !free_one; i++)
    if (!g->connection[i].used) free_one = &g->connection[i];
  if (free_one != NULL) {
    *free_one =
        (abbe_view_connection){.used = true, .socket = socket, .since_s = abbe_clock_seconds()};
    shut_eldest(g);
  } else {
    shutdown(socket, SHUT_RDWR);
  }
  pthread_mutex_unlock(&g->lock);
  return free_one;
}

void abbe_view_guard_trust(abbe_view_guard *g, abbe_view_connection *c) {
  if (c == NULL) return;
  pthread_mutex_lock(&g->lock);
  c->trusted = true;
  pthread_mutex_unlock(&g->lock);
}

void abbe_view_guard_leave(abbe_view_guard *g, abbe_view_connection *c) {
  if (c == NULL) return;
  pthread_mutex_lock(&g->lock);
  c->used = false;
  pthread_mutex_unlock(&g->lock);
}

void abbe_view_guard_look(abbe_view_guard *g, double now_s) {
  pthread_mutex_lock(&g->lock);
  for (size_t i = 0; i < sizeof g->connection / sizeof *g->connection; i++) {
    abbe_view_connection *c = &g->connection[i];
    if (is_stranger(c) && now_s - c->since_s > ABBE_VIEW_GUARD_HEAD_S) shut(c);
  }
  pthread_mutex_unlock(&g->lock);
}

bool abbe_view_guard_is_host(const char *host) {
  static const char *const names[] = {"localhost", "127.0.0.1", "[::1]"};
  for (size_t i = 0; host != NULL && i < sizeof names / sizeof *names; i++) {
    const size_t length = strlen(names[i]);
    if (strncasecmp(host, names[i], length) != 0) continue;
    const char *rest = host + length;
    if (*rest == '\0') return true;
    return *rest == ':' && strspn(rest + 1, "0123456789") == strlen(rest + 1);
  }
  return false;
}

bool abbe_view_guard_is_origin(const char *origin, const char *host) {
  static const char scheme[] = "http://";
  if (origin == NULL) return true;
  return strncasecmp(origin, scheme, sizeof scheme - 1) == 0 &&
         strcasecmp(origin + sizeof scheme - 1, host) == 0;
}
