#include "cli/view/view_app.h"

#include "cli/view/state/view_guard.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { MOST = 8, QUEUE = 64, LEAST_ROOM = 1 << 16, LOOK_MS = 200 };
#define MOST_PACKET ((size_t)256 << 20)
#define MOST_WAITING ((size_t)256 << 20) /* bytes of packets that nobody has taken */
#define MOST_ROOM ((size_t)512 << 20)    /* bytes of all packets that are not whole */

typedef struct sender {
  int socket; /* below 0: none */
  unsigned char *bytes;
  size_t size, room;
} sender;

struct abbe_view_listener {
  int socket;
  pthread_t thread;
  bool begun;
  void (*wake)(void);
  sender from[MOST];    /* the thread's own */
  pthread_mutex_t lock; /* guards what follows: */
  pthread_cond_t taken;
  bool ended;
  struct {
    unsigned char *bytes;
    size_t size;
  } queue[QUEUE];
  size_t first, count, waiting;
};

/* Waits where the window does not keep up. */
static void push(abbe_view_listener *l, unsigned char *bytes, size_t size) {
  pthread_mutex_lock(&l->lock);
  while (!l->ended && l->count > 0 && (l->count == QUEUE || l->waiting + size > MOST_WAITING))
    pthread_cond_wait(&l->taken, &l->lock);
  const size_t at = (l->first + l->count) % QUEUE;
  if (l->ended) {
    free(bytes);
  } else {
    l->queue[at].bytes = bytes;
    l->queue[at].size = size;
    l->count++;
    l->waiting += size;
  }
  pthread_mutex_unlock(&l->lock);
  if (l->wake != NULL) l->wake();
}

static void drop(sender *s) {
  if (s->socket >= 0) close(s->socket);
  free(s->bytes);
  *s = (sender){.socket = -1};
}

/* What it sent is no packet: what follows would be none either. */
static void refuse(abbe_view_listener *l, sender *s, const char *sentence) {
  drop(s);
  push(l, (unsigned char *)strdup(sentence), 0);
}

static size_t packet_length(const sender *s, size_t at) {
  if (s->size - at < 4) return 0;
  const unsigned char *c = s->bytes + at;
  return (size_t)c[0] | (size_t)c[1] << 8 | (size_t)c[2] << 16 | (size_t)c[3] << 24;
}

/* As far as the packet needs that has begun. False: all together would need too much. */
static bool grow(const abbe_view_listener *l, sender *s) {
  const size_t length = packet_length(s, 0), twice = 2 * s->size;
  const size_t room = (length > twice ? twice : length) + LEAST_ROOM;
  size_t all = room;
  for (size_t i = 0; i < MOST; i++) all += &l->from[i] == s ? 0 : l->from[i].room;
  if (s->room > s->size && room <= s->room && s->room < 2 * room) return true;
  unsigned char *bytes = all <= MOST_ROOM ? realloc(s->bytes, room) : NULL;
  if (bytes == NULL) return false;
  s->bytes = bytes;
  s->room = room;
  return true;
}

/* The packets that are whole; false: one is none. */
static bool take_packets(abbe_view_listener *l, sender *s, abbe_error *why) {
  size_t at = 0;
  while (s->size - at >= 4) {
    const size_t length = packet_length(s, at);
    if (length < 5 || length > MOST_PACKET) {
      abbe_error_set(why, ABBE_PARSE, "a packet of %zu bytes is refused; 5 to %zu are right",
                     length, MOST_PACKET);
      return false;
    }
    if (s->size - at < length) break;
    if (abbe_inspect_take_packet(NULL, s->bytes + at, length, NULL, why) != ABBE_OK) return false;
    unsigned char *own = malloc(length);
    if (own != NULL) push(l, memcpy(own, s->bytes + at, length), length);
    at += length;
  }
  s->size -= at;
  if (at > 0) memmove(s->bytes, s->bytes + at, s->size);
  return true;
}

static void receive(abbe_view_listener *l, sender *s) {
  abbe_error why = {0};
  if (!grow(l, s)) {
    refuse(l, s, "no memory for a packet, or more than 512 MiB of packets at once");
    return;
  }
  const ssize_t n = recv(s->socket, s->bytes + s->size, s->room - s->size, MSG_DONTWAIT);
  if (n < 0 && errno == EAGAIN) return;
  if (n <= 0) {
    drop(s);
    return;
  }
  s->size += (size_t)n;
  if (!take_packets(l, s, &why)) refuse(l, s, why.text);
}

static bool has_ended(abbe_view_listener *l) {
  pthread_mutex_lock(&l->lock);
  const bool ended = l->ended;
  pthread_mutex_unlock(&l->lock);
  return ended;
}

static void *listen_to_all(void *user) {
  abbe_view_listener *l = user;
  while (!has_ended(l)) {
    struct pollfd look[MOST + 1];
    size_t none = MOST;
    for (size_t i = 0; i < MOST; i++) {
      look[i] = (struct pollfd){.fd = l->from[i].socket, .events = POLLIN};
      if (l->from[i].socket < 0) none = i;
    }
    look[MOST] = (struct pollfd){.fd = none < MOST ? l->socket : -1, .events = POLLIN};
    if (poll(look, MOST + 1, LOOK_MS) <= 0) continue;
    for (size_t i = 0; i < MOST; i++)
      if (look[i].fd >= 0 && look[i].revents != 0) receive(l, &l->from[i]);
    if (look[MOST].fd >= 0 && (look[MOST].revents & POLLIN) != 0)
      l->from[none].socket = accept(l->socket, NULL, NULL);
  }
  return NULL;
}

abbe_result abbe_view_listen_begin(unsigned *port, abbe_view_listener **out, abbe_error *error) {
  abbe_view_listener *l = calloc(1, sizeof *l);
  *out = l;
  if (l == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to listen");
  for (size_t i = 0; i < MOST; i++) l->from[i].socket = -1;
  pthread_mutex_init(&l->lock, NULL);
  pthread_cond_init(&l->taken, NULL);
  return abbe_view_guard_listen(port, &l->socket, error);
}

abbe_result abbe_view_listen_start(abbe_view_listener *l, void (*wake)(void), abbe_error *error) {
  l->wake = wake;
  l->begun = pthread_create(&l->thread, NULL, listen_to_all, l) == 0;
  return l->begun ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no thread to listen");
}

bool abbe_view_listen_take(abbe_view_listener *l, unsigned char **bytes, size_t *size) {
  pthread_mutex_lock(&l->lock);
  const bool some = l->count > 0;
  if (some) {
    *bytes = l->queue[l->first].bytes;
    *size = l->queue[l->first].size;
    l->first = (l->first + 1) % QUEUE;
    l->count--;
    l->waiting -= *size;
    pthread_cond_signal(&l->taken);
  }
  pthread_mutex_unlock(&l->lock);
  return some;
}

void abbe_view_listen_stop(abbe_view_listener *l) {
  pthread_mutex_lock(&l->lock);
  l->ended = true;
  pthread_cond_signal(&l->taken);
  pthread_mutex_unlock(&l->lock);
  if (l->begun) pthread_join(l->thread, NULL);
  l->begun = false;
}

void abbe_view_listen_end(abbe_view_listener *l) {
  unsigned char *bytes;
  size_t size;
  if (l == NULL) return;
  abbe_view_listen_stop(l);
  while (abbe_view_listen_take(l, &bytes, &size)) free(bytes);
  for (size_t i = 0; i < MOST; i++) drop(&l->from[i]);
  if (l->socket >= 0) close(l->socket);
  pthread_cond_destroy(&l->taken);
  pthread_mutex_destroy(&l->lock);
  free(l);
}
