#include "cli/view/state/view_guard.h"

#include "base/clock.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

enum { LINE_BYTES = 2048, AT_ONCE = 64, LISTENS = ABBE_VIEW_GUARD_WAITING };

static const char refusal[] =
    "the token is missing or another; the viewer has printed the whole address";

abbe_result abbe_view_guard_listen(unsigned *port, int *out, abbe_error *error) {
  const int yes = 1;
  struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons((uint16_t)*port)};
  socklen_t size = sizeof place;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  *out = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (*out < 0) return abbe_error_set(error, ABBE_IO, "no socket to listen: %s", strerror(errno));
  setsockopt(*out, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (bind(*out, (struct sockaddr *)&place, sizeof place) != 0 || listen(*out, SOMAXCONN) != 0 ||
      getsockname(*out, (struct sockaddr *)&place, &size) != 0)
    return abbe_error_set(error, ABBE_IO,
                          "port %u of 127.0.0.1 cannot be served, it may be in use; choose "
                          "another, or 0 for any",
                          *port);
  *port = ntohs(place.sin_port);
  return ABBE_OK;
}

static int watch(const abbe_view_guard *g, int socket, size_t place, unsigned how) {
  struct epoll_event event = {.events = how, .data.u64 = place};
  return epoll_ctl(g->epoll, EPOLL_CTL_ADD, socket, &event);
}

abbe_result abbe_view_guard_begin(abbe_view_guard *g, unsigned port, abbe_error *error) {
  pthread_mutex_init(&g->lock, NULL);
  for (size_t i = 0; i < ABBE_VIEW_GUARD_WAITING; i++) g->waiting[i].socket = -1;
  g->listening = -1;
  g->epoll = epoll_create1(EPOLL_CLOEXEC);
  if (g->epoll < 0)
    return abbe_error_set(error, ABBE_IO, "no socket for the page: %s", strerror(errno));
  g->port = port;
  ABBE_TRY(abbe_view_guard_listen(&g->port, &g->listening, error));
  if (watch(g, g->listening, LISTENS, EPOLLIN) != 0)
    return abbe_error_set(error, ABBE_IO, "no socket for the page: %s", strerror(errno));
  return ABBE_OK;
}

static void end(abbe_view_guard *g, size_t place) {
  if (g->waiting[place].socket >= 0) close(g->waiting[place].socket);
  g->waiting[place].socket = -1;
}

void abbe_view_guard_end(abbe_view_guard *g) {
  if (g->epoll == 0) return; /* it did not begin */
  for (size_t i = 0; i < ABBE_VIEW_GUARD_WAITING; i++) end(g, i);
  if (g->listening >= 0) close(g->listening);
  if (g->epoll >= 0) close(g->epoll);
  pthread_mutex_destroy(&g->lock);
}

void abbe_view_guard_close(abbe_view_guard *g) {
  pthread_mutex_lock(&g->lock);
  g->closed = true;
  pthread_mutex_unlock(&g->lock);
}

bool abbe_view_guard_is_token(const char *token, const char *given, size_t length) {
  unsigned differs = 0;
  if (length != strlen(token)) return false;
  for (size_t i = 0; i < length; i++) differs |= (unsigned)(given[i] ^ token[i]);
  return differs == 0;
}

/* In the query of a request's first line. */
static bool shows_token(const abbe_view_guard *g, const char *line) {
  static const char key[] = "token=";
  for (const char *at = strchr(line, '?'); at != NULL; at = strchr(at + 1, '&')) {
    if (strncmp(at + 1, key, sizeof key - 1) != 0) continue;
    const char *given = at + sizeof key;
    return abbe_view_guard_is_token(g->token, given, strcspn(given, "& \r"));
  }
  return false;
}

static void refuse(abbe_view_guard *g, size_t place) {
  char text[512];
  const int size = snprintf(text, sizeof text,
                            "HTTP/1.1 403 Forbidden\r\nContent-Type: text/plain; charset=utf-8\r\n"
                            "Cache-Control: no-store\r\nConnection: close\r\n"
                            "Content-Length: %zu\r\n\r\n%s",
                            sizeof refusal - 1, refusal);
  g->waiting[place].refused = true;
  if (send(g->waiting[place].socket, text, (size_t)size, MSG_DONTWAIT | MSG_NOSIGNAL) != size)
    end(g, place);
  else
    shutdown(g->waiting[place].socket, SHUT_WR);
}

/* What one that is refused still sends is read, or it would lose the answer. False: no more is
 * there. */
static bool drop(abbe_view_guard *g, size_t place) {
  char text[LINE_BYTES];
  const ssize_t size = recv(g->waiting[place].socket, text, sizeof text, MSG_DONTWAIT);
  if (size == 0 || (size < 0 && errno != EAGAIN)) end(g, place);
  return size > 0;
}

/* By its first line, which stays there for whom it enters to. */
static void judge(abbe_view_guard *g, size_t place) {
  char line[LINE_BYTES + 1];
  const int socket = g->waiting[place].socket;
  const ssize_t size = recv(socket, line, LINE_BYTES, MSG_PEEK | MSG_DONTWAIT);
  if (size == 0 || (size < 0 && errno != EAGAIN)) end(g, place);
  if (size <= 0) return;
  line[size] = '\0';
  char *last = memchr(line, '\n', (size_t)size);
  if (last == NULL && size < LINE_BYTES) return;
  if (last != NULL) *last = '\0';
  if (last == NULL || !shows_token(g, line)) {
    refuse(g, place);
    return;
  }
  epoll_ctl(g->epoll, EPOLL_CTL_DEL, socket, NULL);
  g->waiting[place].socket = -1;
  g->enter(g->user, socket);
}

static void attend(abbe_view_guard *g, size_t place) {
  if (g->waiting[place].socket >= 0 && !g->waiting[place].refused) judge(g, place);
  for (int i = 0; i < AT_ONCE && g->waiting[place].socket >= 0; i++)
    if (!g->waiting[place].refused || !drop(g, place)) return;
}

/* In the place of the oldest, where all are taken. */
static void admit(abbe_view_guard *g, int socket, double now_s) {
  const size_t place = g->next++ % ABBE_VIEW_GUARD_WAITING;
  end(g, place);
  g->waiting[place].socket = socket;
  g->waiting[place].refused = false;
  g->waiting[place].since_s = now_s;
  if (fcntl(socket, F_SETFD, FD_CLOEXEC) != 0 || fcntl(socket, F_SETFL, O_NONBLOCK) != 0 ||
      watch(g, socket, place, EPOLLIN | EPOLLET) != 0)
    end(g, place);
  else
    attend(g, place);
}

static void admit_all(abbe_view_guard *g, double now_s) {
  for (int i = 0; i < AT_ONCE; i++) {
    const int socket = accept(g->listening, NULL, NULL);
    if (socket >= 0)
      admit(g, socket, now_s);
    else if (errno == EMFILE || errno == ENFILE)
      end(g, g->next++ % ABBE_VIEW_GUARD_WAITING); /* the oldest gives way */
    else
      return; /* what still waits is told again */
  }
}

void abbe_view_guard_look(abbe_view_guard *g, double seconds) {
  struct epoll_event event[AT_ONCE];
  const int count = epoll_wait(g->epoll, event, AT_ONCE, (int)(1e3 * seconds));
  const double now_s = abbe_clock_seconds();
  pthread_mutex_lock(&g->lock);
  for (int i = 0; i < count && !g->closed; i++)
    if (event[i].data.u64 == LISTENS)
      admit_all(g, now_s);
    else
      attend(g, event[i].data.u64);
  for (size_t i = 0; i < ABBE_VIEW_GUARD_WAITING; i++)
    if (now_s - g->waiting[i].since_s > ABBE_VIEW_GUARD_HEAD_S) end(g, i);
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
