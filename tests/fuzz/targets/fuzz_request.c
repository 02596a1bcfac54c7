/* Requests to the viewer's page, as a stranger's connection brings them. Input: the request's
 * bytes; the guard judges its first line, then Host, Origin and lines of events are read from it.
 */
#include "tests/fuzz/fuzz.h"

#include "cli/view/state/view_events.h"
#include "cli/view/state/view_guard.h"

#include <math.h>
#include <string.h>
#include <strings.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#define TOKEN "0123456789abcdef0123456789abcdef"
#define WHOLE "GET /?token=" TOKEN " HTTP/1.1\r\n"

const char *const fuzz_words[] = {WHOLE,
                                  "POST /events?token=" TOKEN " HTTP/1.1\r\n",
                                  "token=" TOKEN,
                                  "&token=",
                                  "Host: localhost:8080\r\n",
                                  "Host: 127.0.0.1\r\n",
                                  "Host: [::1]:1\r\n",
                                  "Origin: http://localhost:8080\r\n",
                                  "\r\n\r\n",
                                  "move 10 20\n",
                                  "size 900 560\n",
                                  "wheel -1\n",
                                  "down 0 shift\n",
                                  "key z down control\n",
                                  NULL};

enum { LINES = 8, LINE = 200, FIRST = 2048 };

static abbe_view_guard guard = {.token = TOKEN};
static struct sockaddr_un place = {.sun_family = AF_UNIX};
static socklen_t place_size = sizeof(sa_family_t); /* a name without a file */
static int entered;

static void enter(void *user, int socket) {
  (void)user;
  entered++;
  close(socket);
}

/* It listens without a network, which would run out of ports. */
static void prepare(void) {
  struct epoll_event event = {.events = EPOLLIN, .data.u64 = ABBE_VIEW_GUARD_WAITING};
  guard.enter = enter;
  FUZZ_PROMISE(abbe_view_guard_begin(&guard, 0, NULL) == ABBE_OK);
  close(guard.listening);
  guard.listening = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
  FUZZ_PROMISE(bind(guard.listening, (struct sockaddr *)&place, place_size) == 0);
  place_size = sizeof place;
  FUZZ_PROMISE(getsockname(guard.listening, (struct sockaddr *)&place, &place_size) == 0);
  FUZZ_PROMISE(listen(guard.listening, 8) == 0);
  FUZZ_PROMISE(epoll_ctl(guard.epoll, EPOLL_CTL_ADD, guard.listening, &event) == 0);
}

static bool holds(const char *text, size_t size, const char *part) {
  const size_t length = strlen(part);
  for (size_t i = 0; i + length <= size; i++)
    if (memcmp(text + i, part, length) == 0) return true;
  return false;
}

/* Nobody comes in whose first line lacks the token; a whole one does; another is answered or
 * waits. */
static void knock(const char *text, size_t size) {
  char answer[16] = "";
  const int stranger = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0);
  FUZZ_PROMISE(stranger >= 0 && connect(stranger, (struct sockaddr *)&place, place_size) == 0);
  FUZZ_PROMISE(size == 0 || send(stranger, text, size, MSG_NOSIGNAL) == (ssize_t)size);
  entered = 0;
  abbe_view_guard_look(&guard, 0);
  const char *end = memchr(text, '\n', size < FIRST ? size : FIRST);
  const size_t line = end != NULL ? (size_t)(end - text) : 0;
  FUZZ_PROMISE(entered == 0 || holds(text, line, "token=" TOKEN));
  FUZZ_PROMISE(entered == 1 || size < sizeof WHOLE - 1 || memcmp(text, WHOLE, sizeof WHOLE - 1));
  const ssize_t got = recv(stranger, answer, sizeof answer - 1, 0);
  FUZZ_PROMISE(entered > 0 || (end == NULL && size < FIRST) ||
               (got > 0 && strncmp(answer, "HTTP/1.1 403 ", 13) == 0));
  close(stranger);
  abbe_view_guard_look(&guard, 0);
}

/* What stands behind a header's name, as text; NULL: it is not there. */
static const char *header(const char *text, const char *name, char value[LINE]) {
  const char *at = strstr(text, name);
  if (at == NULL) return NULL;
  snprintf(value, LINE, "%.*s", (int)strcspn(at + strlen(name), "\r\n"), at + strlen(name));
  return value;
}

static void judge(const char *text) {
  static const char *const names[] = {"localhost", "127.0.0.1", "[::1]"};
  char space[2][LINE];
  const char *host = header(text, "Host: ", space[0]), *origin = header(text, "Origin: ", space[1]);
  bool ours = false;
  for (int i = 0; i < 3 && host != NULL; i++) {
    const char *rest = host + strlen(names[i]);
    ours = ours || (strncasecmp(host, names[i], strlen(names[i])) == 0 &&
                    strspn(rest, ":0123456789") == strlen(rest));
  }
  const bool taken = abbe_view_guard_is_host(host);
  FUZZ_PROMISE(!taken || ours);
  if (taken && origin != NULL && abbe_view_guard_is_origin(origin, host))
    FUZZ_PROMISE(strcasecmp(strrchr(origin, '/') + 1, host) == 0);
}

static void read_events(const char *text) {
  static abbe_view_events queue;
  char line[LINE];
  const char *body = strstr(text, "\r\n\r\n"), *rest = body != NULL ? body + 4 : text;
  size_t added = 0;
  for (int i = 0; i < LINES && *rest != '\0'; i++) {
    abbe_view_event e;
    abbe_error error = {0};
    const size_t length = strcspn(rest, "\n");
    snprintf(line, sizeof line, "%.*s", (int)length, rest);
    rest += length + (rest[length] == '\n');
    const abbe_result result = FUZZED(abbe_view_event_read(line, &e, &error), &error);
    FUZZ_PROMISE(result == ABBE_OK || error.text[0] != '\0');
    if (result != ABBE_OK) continue;
    fuzz_same(&e, sizeof e);
    FUZZ_PROMISE(fabs(e.x) <= 4.0 * ABBE_VIEW_EVENT_MOST_PIXELS &&
                 fabs(e.y) <= 4.0 * ABBE_VIEW_EVENT_MOST_PIXELS);
    FUZZ_PROMISE(e.button >= 0 && e.button <= 2 && memchr(e.key, '\0', sizeof e.key) != NULL);
    FUZZ_PROMISE(e.kind != ABBE_VIEW_EVENT_SIZE || (e.x >= 1 && e.y >= 1));
    FUZZ_PROMISE(abbe_view_events_add(&queue, &e));
    added++;
  }
  for (abbe_view_event e; abbe_view_events_take(&queue, &e);) FUZZ_PROMISE(added-- > 0);
}

int fuzz_input(const uint8_t *data, size_t size) {
  char text[4096];
  if (guard.enter == NULL) prepare();
  if (size >= sizeof text) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  knock(text, size);
  judge(text);
  read_events(text);
  return 0;
}
