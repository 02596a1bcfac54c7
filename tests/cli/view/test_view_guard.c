/* Who waits at the door of the viewer's page, and who enters: by sockets of the loopback. */
#include "tests/check.h"

#include "cli/view/state/view_guard.h"

#include <arpa/inet.h>
#include <errno.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#define TOKEN "0123456789abcdef"
#define RIGHT "GET /picture?after=3&token=" TOKEN " HTTP/1.1\r\nHost: localhost\r\n"

enum { MOST = 4 * ABBE_VIEW_GUARD_WAITING };

static abbe_view_guard guard;
static int stranger[MOST], entered;
static size_t strangers;
static char said[512];

static void enter(void *user, int socket) {
  const ssize_t size = recv(socket, said, sizeof said - 1, 0);
  assert_ptr_equal(user, &guard);
  assert_true(size > 0);
  said[size] = '\0';
  close(socket);
  entered++;
}

static int come(const char *text) {
  struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons((uint16_t)guard.port)};
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  assert_true(s >= 0);
  assert_int_equal(connect(s, (struct sockaddr *)&place, sizeof place), 0);
  assert_int_equal(send(s, text, strlen(text), MSG_NOSIGNAL), strlen(text));
  return s;
}

static void come_strangers(size_t count, const char *text) {
  for (size_t i = 0; i < count; i++) stranger[strangers++] = come(text);
}

static void look(void) {
  for (int i = 0; i < 20; i++) abbe_view_guard_look(&guard, 0);
}

/* What the guard has sent, with its end; NULL: it has not ended. */
static const char *answer(int socket) {
  static char text[1024];
  size_t size = 0;
  for (;;) {
    const ssize_t more = recv(socket, text + size, sizeof text - 1 - size, MSG_DONTWAIT);
    if (more < 0 && errno == EAGAIN) return NULL;
    if (more <= 0) break;
    size += (size_t)more;
  }
  text[size] = '\0';
  return text;
}

static void begin(void) {
  struct rlimit files;
  getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
  guard = (abbe_view_guard){.token = TOKEN, .enter = enter, .user = &guard};
  OK(abbe_view_guard_begin(&guard, 0, &error));
  entered = 0;
  strangers = 0;
}

static void finish(void) {
  while (strangers > 0) close(stranger[--strangers]);
  abbe_view_guard_end(&guard);
}

EACH(begin, finish);

TEST(who_shows_the_token_enters) {
  const int s = come(RIGHT);
  look();
  assert_int_equal(entered, 1);
  assert_string_equal(said, RIGHT);
  close(s);
}

/* Its owner comes amid many who say nothing, or never end what they say. */
TEST(many_strangers_keep_nobody_out) {
  for (int i = 0; i < 3; i++) {
    come_strangers(200, i == 1 ? "GET / HTTP/1.1\r\nX: " : "GE");
    const int s = come(RIGHT);
    come_strangers(100, "");
    look();
    assert_int_equal(entered, i + 1);
    close(s);
  }
  assert_non_null(answer(stranger[0]));
  assert_null(answer(stranger[strangers - 1]));
}

/* The first line comes in pieces, and others meanwhile. */
TEST(a_slow_line_is_waited_for) {
  const int s = come("GET /?token=0123456");
  look();
  come_strangers(ABBE_VIEW_GUARD_WAITING - 1, "");
  look();
  assert_int_equal(entered, 0);
  assert_int_equal(send(s, "789abcdef HTTP/1.1\r\n", 20, MSG_NOSIGNAL), 20);
  look();
  assert_int_equal(entered, 1);
  close(s);
}

TEST(others_are_told_and_go) {
  static const char *const wrong[] = {
      "GET / HTTP/1.1\r\n",
      "GET /?token=" TOKEN "0 HTTP/1.1\r\n",
      "GET /?token=0123456789abcdee HTTP/1.1\r\n",
      "GET /?mytoken=" TOKEN " HTTP/1.1\r\n",
      "GET /token=" TOKEN " HTTP/1.1\r\n",
      "GET /?token= HTTP/1.1\r\nX: ?token=" TOKEN " \r\n",
      "\r\n",
  };
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    const int s = come(wrong[i]);
    look();
    const char *text = answer(s);
    assert_non_null(text);
    assert_contains(text, "HTTP/1.1 403 ");
    assert_contains(text, "the token is missing or another");
    close(s);
  }
  assert_int_equal(entered, 0);
}

TEST(a_line_without_an_end_is_refused) {
  char line[4000];
  memset(line, 'x', sizeof line - 1);
  line[sizeof line - 1] = '\0';
  const int s = come(line);
  look();
  const char *text = answer(s);
  assert_non_null(text);
  assert_contains(text, "HTTP/1.1 403 ");
  close(s);
}

/* Closed so that the other side is told of it as of an error. */
static void break_off(int socket) {
  const struct linger at_once = {.l_onoff = 1};
  setsockopt(socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  close(socket);
}

/* Whenever they go, in order or not, their place is free again: at once, or, where half a line
 * stays unread, when its time is over. */
TEST(who_goes_leaves_nothing) {
  static const struct {
    const char *before, *after; /* what is said before a look, and behind it; NULL: no more */
    bool half;
  } cases[] = {{"", NULL, false},
               {"GE", NULL, true},
               {"GE", "T", true},
               {"GET / HTTP/1.1\r\n", NULL, false},
               {"GET / HTTP/1.1\r\n", "X: more of it", false}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    for (int way = 0; way < 4; way++) {
      const int s = come(cases[i].before);
      const size_t place = guard.next;
      if (way % 2 == 0) look();
      const char *more = cases[i].after;
      if (more != NULL) assert_int_equal(send(s, more, strlen(more), MSG_NOSIGNAL), strlen(more));
      if (way < 2)
        close(s);
      else
        break_off(s);
      look();
      assert_int_equal(guard.next, place + 1);
      if (cases[i].half) guard.waiting[place].since_s -= ABBE_VIEW_GUARD_HEAD_S;
      if (cases[i].half) look();
      assert_int_equal(guard.waiting[place].socket, -1);
    }
  assert_int_equal(entered, 0);
}

/* With no descriptor left the oldest gives way to who comes. */
TEST(without_descriptors_the_oldest_goes) {
  struct rlimit files, fewer;
  getrlimit(RLIMIT_NOFILE, &files);
  come_strangers(3, "");
  look();
  const int s = come(RIGHT), next = dup(s);
  assert_true(next >= 0);
  close(next);
  fewer = files;
  fewer.rlim_cur = (rlim_t)next;
  setrlimit(RLIMIT_NOFILE, &fewer);
  look();
  setrlimit(RLIMIT_NOFILE, &files);
  assert_int_equal(entered, 1);
  assert_non_null(answer(stranger[0]));
  assert_null(answer(stranger[2]));
  close(s);
}

/* As many descriptors as it may have, and what it says of it. */
TEST(a_guard_without_descriptors_says_so) {
  static const char *const says[] = {"no socket for the page", "no socket to listen"};
  struct rlimit files, fewer;
  getrlimit(RLIMIT_NOFILE, &files);
  for (int more = 0; more < 2; more++) {
    abbe_view_guard other = {.token = TOKEN};
    abbe_error why = {0};
    const int next = dup(0);
    close(next);
    fewer = files;
    fewer.rlim_cur = (rlim_t)(next + more);
    setrlimit(RLIMIT_NOFILE, &fewer);
    const abbe_result result = abbe_view_guard_begin(&other, 0, &why);
    setrlimit(RLIMIT_NOFILE, &files);
    assert_int_equal(result, ABBE_IO);
    assert_contains(why.text, says[more]);
    abbe_view_guard_end(&other);
  }
  abbe_view_guard_end(&(abbe_view_guard){.token = TOKEN}); /* which has not begun */
}

TEST(nobody_waits_for_long) {
  come_strangers(1, "GET / HTTP/1.1");
  look();
  assert_null(answer(stranger[0]));
  guard.waiting[0].since_s -= ABBE_VIEW_GUARD_HEAD_S;
  look();
  assert_non_null(answer(stranger[0]));
}

TEST(nobody_enters_what_is_closed) {
  const int s = come(RIGHT);
  abbe_view_guard_close(&guard);
  look();
  assert_int_equal(entered, 0);
  close(s);
}

TEST(a_port_is_taken_once) {
  abbe_view_guard second = {.token = TOKEN};
  REFUSED(ABBE_IO, "may be in use", abbe_view_guard_begin(&second, guard.port, &error));
  abbe_view_guard_end(&second);
}

TEST(hosts_and_origins) {
  static const struct {
    const char *host, *origin;
    bool is_host, is_origin;
  } cases[] = {{"localhost", NULL, true, true},
               {"LocalHost:80", "http://localhost:80", true, true},
               {"127.0.0.1:9", "http://127.0.0.1:8", true, false},
               {"[::1]:9", "null", true, false},
               {"localhost.example", "https://localhost.example", false, false},
               {"127.0.0.1:80x", NULL, false, true},
               {NULL, NULL, false, true}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    assert_int_equal(abbe_view_guard_is_host(cases[i].host), cases[i].is_host);
    assert_int_equal(abbe_view_guard_is_origin(cases[i].origin, cases[i].host), cases[i].is_origin);
  }
}
