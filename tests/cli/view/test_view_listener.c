/* What a thread takes from programs that send pictures, by sockets of the loopback: packets in
 * their order, no more than there are places for, and a sentence in place of what is none. */
#include "tests/check.h"

#include "cli/view/view_app.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { QUEUED = 64, SENDERS = 8 };

static abbe_view_listener *listener;
static unsigned port;

static void begin(void) {
  port = 0;
  OK(abbe_view_listen_begin(&port, &listener, &error));
  OK(abbe_view_listen_start(listener, NULL, &error));
}

static void finish(void) {
  abbe_view_listen_end(listener);
}

EACH(begin, finish);

static int come(void) {
  struct sockaddr_in place = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int s = socket(AF_INET, SOCK_STREAM, 0);
  assert_true(s >= 0);
  assert_int_equal(connect(s, (struct sockaddr *)&place, sizeof place), 0);
  return s;
}

static void say(int to, const char *bytes, size_t size) {
  assert_int_equal(send(to, bytes, size, MSG_NOSIGNAL), size);
}

/* It closes the picture of that name of one letter. */
static void say_close(int to, char name) {
  say(to, (const char[]){7, 0, 0, 0, 2, name, 0}, 7);
}

static void rest(void) {
  nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

/* The next that has come, waited for; malloc'd. *size 0: a sentence. */
static char *taken(size_t *size) {
  unsigned char *bytes = NULL;
  while (!abbe_view_listen_take(listener, &bytes, size)) rest();
  return (char *)bytes;
}

static void take_close(char name) {
  size_t size = 0;
  FREED char *bytes = taken(&size);
  assert_int_equal(size, 7);
  assert_int_equal(bytes[5], name);
}

static bool has_ended(int socket, int wait_ms) {
  char byte;
  struct pollfd look = {.fd = socket, .events = POLLIN};
  return poll(&look, 1, wait_ms) == 1 && recv(socket, &byte, 1, 0) <= 0;
}

TEST(packets_come_in_their_order) {
  const int s = come();
  for (char name = 'a'; name <= 'z'; name++) say_close(s, name);
  say(s, "\7\0\0", 3); /* and one in pieces */
  for (char name = 'a'; name <= 'z'; name++) take_close(name);
  say(s, "\0\2Z", 3);
  say(s, "\0", 1);
  take_close('Z');
  close(s);
}

TEST(what_is_no_packet_ends_its_connection) {
  static const struct {
    const char *bytes;
    size_t size;
    const char *says;
  } cases[] = {{"\4\0\0\0", 4, "a packet of 4 bytes is refused; 5 to 268435456 are right"},
               {"\1\0\0\20", 4, "a packet of 268435457 bytes is refused"},
               {"\7\0\0\0\12a\0", 7, "its kind is not known"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    size_t size = 1;
    const int other = come(), s = come();
    say(s, cases[i].bytes, cases[i].size);
    FREED char *sentence = taken(&size);
    assert_int_equal(size, 0);
    assert_contains(sentence, cases[i].says);
    assert_true(has_ended(s, 60000));
    say_close(other, 'b');
    take_close('b');
    close(s);
    close(other);
  }
}

/* Room comes with what has come, and goes again. */
TEST(a_long_packet_has_short_ones_behind_it) {
  enum { LONG = 1 << 20 };
  const int s = come();
  size_t size = 0;
  FREED char *bytes = calloc(LONG, 1);
  memcpy(bytes, (const char[]){0, 0, 16, 0, 2, 'l'}, 6);
  for (size_t at = 0; at < LONG; at += LONG / 16) say(s, bytes + at, LONG / 16);
  for (char name = 'a'; name <= 'z'; name++) say_close(s, name);
  FREED char *taken_bytes = taken(&size);
  assert_int_equal(size, LONG);
  assert_memory_equal(taken_bytes, bytes, LONG);
  for (char name = 'a'; name <= 'z'; name++) take_close(name);
  close(s);
}

/* One that breaks off amid a packet is forgotten; what nobody takes goes with the listener. */
TEST(who_breaks_off_is_forgotten) {
  const struct linger at_once = {.l_onoff = 1};
  const int s = come(), other = come();
  say_close(s, 'a');
  say(s, "\7\0\0", 3);
  take_close('a');
  setsockopt(s, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  close(s);
  for (int i = 0; i < 20; i++) rest();
  say_close(other, 'b');
  take_close('b');
  say_close(other, 'c');
  for (int i = 0; i < 100; i++) rest();
  close(other);
}

/* Where the window takes none they wait, in the queue and in the socket; all come in the end. */
TEST(more_than_the_queue_holds_wait) {
  const int s = come();
  for (int i = 0; i < 3 * QUEUED; i++) say_close(s, (char)('a' + i % 26));
  for (int i = 0; i < 200; i++) rest();
  for (int i = 0; i < 3 * QUEUED; i++) take_close((char)('a' + i % 26));
  close(s);
}

TEST(a_stop_drops_what_waits) {
  const int s = come();
  unsigned char *bytes = NULL;
  size_t size = 0, left = 0;
  for (int i = 0; i < 3 * QUEUED; i++) say_close(s, 'a');
  for (int i = 0; i < 200; i++) rest();
  abbe_view_listen_stop(listener);
  abbe_view_listen_stop(listener); /* once more is of no matter */
  for (; abbe_view_listen_take(listener, &bytes, &size); left++) free(bytes);
  assert_int_equal(left, QUEUED);
  close(s);
}

/* The ninth waits until one of eight goes. */
TEST(eight_may_send_at_once) {
  int s[SENDERS];
  for (int i = 0; i < SENDERS; i++) {
    s[i] = come();
    say_close(s[i], 'a');
    take_close('a');
  }
  const int ninth = come();
  unsigned char *bytes = NULL;
  size_t size;
  say_close(ninth, 'z');
  for (int i = 0; i < 100; i++) {
    rest();
    assert_false(abbe_view_listen_take(listener, &bytes, &size));
  }
  close(s[3]);
  take_close('z');
  for (int i = 0; i < SENDERS; i++)
    if (i != 3) close(s[i]);
  close(ninth);
}

TEST(a_port_is_listened_at_once) {
  abbe_view_listener *second = NULL;
  REFUSED(ABBE_IO, "may be in use", abbe_view_listen_begin(&port, &second, &error));
  abbe_view_listen_end(second);
  abbe_view_listen_end(NULL);
}

TEST(a_program_without_sockets_says_so) {
  struct rlimit files, none;
  abbe_view_listener *second = NULL;
  unsigned any = 0;
  getrlimit(RLIMIT_NOFILE, &files);
  none = files;
  none.rlim_cur = 0;
  setrlimit(RLIMIT_NOFILE, &none);
  abbe_error why = {0};
  const abbe_result result = abbe_view_listen_begin(&any, &second, &why);
  setrlimit(RLIMIT_NOFILE, &files);
  assert_int_equal(result, ABBE_IO);
  assert_contains(why.text, "no socket to listen");
  abbe_view_listen_end(second);
}
