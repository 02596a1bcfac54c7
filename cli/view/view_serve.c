#include "cli/view/view_app.h"

#ifdef ABBE_HAVE_SERVE

#include "base/clock.h"
#include "cli/view/state/view_events.h"
#include "cli/view/state/view_guard.h"

#include <arpa/inet.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <microhttpd.h>
#include <png.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

enum { MOST_BYTES = 65536, TOKEN_BYTES = 16, LONGEST_WAIT_S = 1 };
#define APPLY_S 0.25 /* events at most, before the next picture */
#define LOOK_S 0.1   /* how long the keeper waits for connections */
#define LAST_S 0.6   /* for an end in order; then the process ends whatever it does */

extern const unsigned char abbe_embedded_view_page[];
extern const size_t abbe_embedded_view_page_size;

typedef struct server {
  abbe_view_hidden hidden; /* the main thread's */
  unsigned char *pixels;   /* pixels of the last picture */
  size_t width, height;
  char token[2 * TOKEN_BYTES + 1];
  abbe_view_guard guard;
  struct MHD_Daemon *daemon;
  atomic_uint entered, left; /* connections that have shown the token */
  pthread_mutex_t lock;      /* guards what follows: */
  pthread_cond_t called, drawn;
  bool woken, ended;
  abbe_view_events events;
  unsigned char *png;
  size_t png_size;
  unsigned long frame; /* its number; 0: none yet */
} server;

/* What a request has brought so far, and room for the events of it. */
typedef struct body {
  char text[MOST_BYTES + 1];
  size_t size;
  bool too_long;
  abbe_view_events events;
} body;

static server *served; /* whom wake means */
static volatile sig_atomic_t stopped;

static void stop(int number) {
  (void)number;
  stopped = 1;
}

static void wake(void) {
  pthread_mutex_lock(&served->lock);
  served->woken = true;
  pthread_cond_signal(&served->called);
  pthread_mutex_unlock(&served->lock);
}

static void wait_for(pthread_cond_t *signal, pthread_mutex_t *lock, double seconds) {
  struct timespec until;
  clock_gettime(CLOCK_REALTIME, &until);
  const double nanoseconds = (double)until.tv_nsec + 1e9 * seconds;
  until.tv_sec += (time_t)(nanoseconds / 1e9);
  until.tv_nsec = (long)fmod(nanoseconds, 1e9);
  pthread_cond_timedwait(signal, lock, &until);
}

/* ---- requests, on threads of the library's ---- */

/* In a frame's place: the connection goes. */
#define CLOSES ((unsigned long)-1)

static enum MHD_Result reply(struct MHD_Connection *c, unsigned code, const char *type,
                             const void *data, size_t size, unsigned long frame) {
  static const char policy[] = "default-src 'none'; script-src 'unsafe-inline'; style-src "
                               "'unsafe-inline'; connect-src 'self'; img-src blob:";
  char number[32];
  struct MHD_Response *r =
      MHD_create_response_from_buffer(size, (void *)(uintptr_t)data, MHD_RESPMEM_MUST_COPY);
  if (r == NULL) return MHD_NO;
  MHD_add_response_header(r, MHD_HTTP_HEADER_CONTENT_TYPE, type);
  MHD_add_response_header(r, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  MHD_add_response_header(r, "Content-Security-Policy", policy);
  MHD_add_response_header(r, "Referrer-Policy", "no-referrer");
  MHD_add_response_header(r, "X-Content-Type-Options", "nosniff");
  snprintf(number, sizeof number, "%lu", frame);
  if (frame == CLOSES)
    MHD_add_response_header(r, MHD_HTTP_HEADER_CONNECTION, "close");
  else if (frame > 0)
    MHD_add_response_header(r, "X-Abbe-Frame", number);
  const enum MHD_Result result = MHD_queue_response(c, code, r);
  MHD_destroy_response(r);
  return result;
}

static enum MHD_Result say(struct MHD_Connection *c, unsigned code, const char *text) {
  return reply(c, code, "text/plain; charset=utf-8", text, strlen(text), 0);
}

static bool has_token(const server *s, struct MHD_Connection *c) {
  const char *given = MHD_lookup_connection_value(c, MHD_GET_ARGUMENT_KIND, "token");
  return given != NULL && abbe_view_guard_is_token(s->token, given, strlen(given));
}

static enum MHD_Result send_picture(server *s, struct MHD_Connection *c) {
  const char *text = MHD_lookup_connection_value(c, MHD_GET_ARGUMENT_KIND, "after");
  const unsigned long after = text != NULL ? strtoul(text, NULL, 10) : 0;
  const double until = abbe_clock_seconds() + LONGEST_WAIT_S;
  pthread_mutex_lock(&s->lock);
  while ((s->frame == 0 || s->frame == after) && abbe_clock_seconds() < until && !stopped)
    wait_for(&s->drawn, &s->lock, 0.2);
  const enum MHD_Result result =
      s->frame == 0 || s->frame == after
          ? say(c, MHD_HTTP_NO_CONTENT, "")
          : reply(c, MHD_HTTP_OK, "image/png", s->png, s->png_size, s->frame);
  pthread_mutex_unlock(&s->lock);
  return result;
}

/* All of the lines, or none. */
static enum MHD_Result take_events(server *s, struct MHD_Connection *c, body *b) {
  abbe_view_events *own = &b->events;
  abbe_view_event event;
  abbe_error error = {0};
  bool full = false;
  abbe_result result = ABBE_OK;
  for (char *rest = b->text, *line; result == ABBE_OK && !full;) {
    if ((line = strtok_r(rest, "\n", &rest)) == NULL) break;
    result = abbe_view_event_read(line, &event, &error);
    full = result == ABBE_OK && !abbe_view_events_add(own, &event);
  }
  pthread_mutex_lock(&s->lock);
  full = full || s->events.count + own->count > ABBE_VIEW_MOST_EVENTS;
  if (result == ABBE_OK && !full) {
    while (abbe_view_events_take(own, &event)) abbe_view_events_add(&s->events, &event);
    pthread_cond_signal(&s->called);
  }
  pthread_mutex_unlock(&s->lock);
  if (result != ABBE_OK) return say(c, MHD_HTTP_BAD_REQUEST, error.text);
  if (full) return say(c, MHD_HTTP_SERVICE_UNAVAILABLE, "too many events wait");
  return say(c, MHD_HTTP_NO_CONTENT, "");
}

/* Refuses a request without the token, or in another's name: at once, and the connection goes. */
static enum MHD_Result refuse(struct MHD_Connection *c, const char *why) {
  return reply(c, MHD_HTTP_FORBIDDEN, "text/plain; charset=utf-8", why, strlen(why), CLOSES);
}

/* Once the head of a request is there. */
static const char *why_refused(const server *s, struct MHD_Connection *c) {
  const char *host = MHD_lookup_connection_value(c, MHD_HEADER_KIND, MHD_HTTP_HEADER_HOST);
  const char *origin = MHD_lookup_connection_value(c, MHD_HEADER_KIND, MHD_HTTP_HEADER_ORIGIN);
  if (!abbe_view_guard_is_host(host))
    return "the Host is another machine's; ask 127.0.0.1 or localhost";
  if (!abbe_view_guard_is_origin(origin, host))
    return "the request is another page's, by its Origin";
  if (!has_token(s, c))
    return "the token is missing or another; the viewer has printed the whole address";
  return NULL;
}

static enum MHD_Result answer(void *user, struct MHD_Connection *c, const char *url,
                              const char *method, const char *version, const char *data,
                              size_t *size, void **own) {
  server *s = user;
  body *b = *own;
  (void)version;
  if (b == NULL) {
    const char *why = why_refused(s, c);
    if (why != NULL) return refuse(c, why);
    *own = calloc(1, sizeof *b);
    return *own != NULL ? MHD_YES : MHD_NO;
  }
  if (*size > 0) {
    b->too_long = b->too_long || b->size + *size > MOST_BYTES;
    if (!b->too_long) memcpy(b->text + b->size, data, *size);
    if (!b->too_long) b->size += *size;
    *size = 0;
    return MHD_YES;
  }
  const bool gets = strcmp(method, "GET") == 0, posts = strcmp(method, "POST") == 0;
  const bool page = strcmp(url, "/") == 0, events = strcmp(url, "/events") == 0;
  if (!page && !events && strcmp(url, "/picture") != 0)
    return say(c, MHD_HTTP_NOT_FOUND, "there are /, /picture and /events");
  if (events ? !posts : !gets)
    return say(c, MHD_HTTP_METHOD_NOT_ALLOWED, "GET / and /picture, POST /events");
  if (b->too_long) return say(c, MHD_HTTP_CONTENT_TOO_LARGE, "at most 64 KiB of events at once");
  if (events) return take_events(s, c, b);
  if (page)
    return reply(c, MHD_HTTP_OK, "text/html; charset=utf-8", abbe_embedded_view_page,
                 abbe_embedded_view_page_size, 0);
  return send_picture(s, c);
}

/* A connection that has shown the token. The library may not meet its own limit: 0.9.75 stands
 * still for good where two are handed to it for one place. */
static void enter(void *user, int socket) {
  server *s = user;
  if (s->entered - s->left >= ABBE_VIEW_GUARD_MOST) {
    close(socket);
    return;
  }
  s->entered++;
  struct sockaddr_in from = {0};
  socklen_t size = sizeof from;
  getpeername(socket, (struct sockaddr *)&from, &size);
  MHD_add_connection(s->daemon, socket, (struct sockaddr *)&from, size);
}

static void end_request(void *user, struct MHD_Connection *c, void **own,
                        enum MHD_RequestTerminationCode why) {
  (void)user;
  (void)c;
  (void)why;
  free(*own);
  *own = NULL;
}

static void leave(void *user, struct MHD_Connection *c, void **own,
                  enum MHD_ConnectionNotificationCode what) {
  server *s = user;
  (void)c;
  (void)own;
  if (what == MHD_CONNECTION_NOTIFY_CLOSED) s->left++;
}

/* ---- the window ---- */

static void apply_key(const abbe_view_event *e, abbe_view_hidden *h) {
  const int modifiers = (e->shift ? ABBE_VIEW_SHIFT : 0) | (e->control ? ABBE_VIEW_CONTROL : 0);
  abbe_ui_input *in = &h->input;
  if (strcmp(e->key, "Enter") == 0) in->enter = e->down;
  if (strcmp(e->key, "Backspace") == 0) in->backspace = e->down;
  if (strcmp(e->key, "Escape") == 0) in->escape = e->down;
  if (e->key[1] != '\0') return;
  if (abbe_ui_has_keys()) {
    if (e->down && !e->control) memcpy(in->text, e->key, sizeof e->key);
    return;
  }
  abbe_view_app_key(&h->session, tolower((unsigned char)e->key[0]), e->down, modifiers,
                    abbe_clock_seconds());
}

/* Gives it to the window and draws what the next one must find drawn. */
static void apply(const abbe_view_event *e, abbe_view_hidden *h) {
  abbe_ui_input *in = &h->input;
  switch (e->kind) {
  case ABBE_VIEW_EVENT_MOVE:
    in->mouse[0] = e->x;
    in->mouse[1] = e->y;
    return;
  case ABBE_VIEW_EVENT_SIZE:
    abbe_view_hidden_resize(h, (size_t)e->x, (size_t)e->y);
    return;
  case ABBE_VIEW_EVENT_WHEEL:
    in->wheel += e->x;
    break;
  case ABBE_VIEW_EVENT_KEY:
    apply_key(e, h);
    break;
  case ABBE_VIEW_EVENT_BUTTON:
    /* widgets learn in one frame what is under the pointer, and in the next what it does there */
    abbe_view_hidden_frame(h);
    abbe_view_hidden_frame(h);
    in->button[e->button] = e->down;
    in->shift = e->shift;
    in->control = e->control;
    break;
  }
  abbe_view_hidden_frame(h);
}

/* Hands the window's picture out, where it is another than the last. */
static void publish(server *s) {
  abbe_view_hidden *h = &s->hidden;
  unsigned char *pixels = abbe_view_hidden_read(h);
  if (pixels == NULL) return;
  if (s->pixels != NULL && s->width == h->width && s->height == h->height &&
      memcmp(pixels, s->pixels, 3 * h->width * h->height) == 0) {
    free(pixels);
    return;
  }
  free(s->pixels);
  s->pixels = pixels;
  s->width = h->width;
  s->height = h->height;
  png_image image = {.version = PNG_IMAGE_VERSION,
                     .width = (png_uint_32)h->width,
                     .height = (png_uint_32)h->height,
                     .format = PNG_FORMAT_RGB,
                     .flags = PNG_IMAGE_FLAG_FAST};
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  unsigned char *png = malloc(size);
  if (png == NULL || !png_image_write_to_memory(&image, png, &size, 0, pixels, 0, NULL)) {
    free(png);
    return;
  }
  pthread_mutex_lock(&s->lock);
  free(s->png);
  s->png = png;
  s->png_size = size;
  s->frame++;
  pthread_cond_broadcast(&s->drawn);
  pthread_mutex_unlock(&s->lock);
}

/* One of those that wait, which this thread alone takes. */
static abbe_view_event take_event(server *s) {
  abbe_view_event event = {0};
  pthread_mutex_lock(&s->lock);
  abbe_view_events_take(&s->events, &event);
  pthread_mutex_unlock(&s->lock);
  return event;
}

static void loop(server *s) {
  while (!stopped) {
    const double least = 0.01; /* where something always moves */
    pthread_mutex_lock(&s->lock);
    const size_t count = s->events.count; /* those that come meanwhile see a picture first */
    s->woken = false;
    pthread_mutex_unlock(&s->lock);
    const double until = abbe_clock_seconds() + APPLY_S;
    for (size_t i = 0; i < count && !stopped && abbe_clock_seconds() < until; i++) {
      const abbe_view_event event = take_event(s);
      apply(&event, &s->hidden);
    }
    if (stopped) return;
    abbe_view_hidden_frame(&s->hidden);
    publish(s);
    const double wait = abbe_view_app_wait(&s->hidden.session, abbe_clock_seconds());
    pthread_mutex_lock(&s->lock);
    if (s->events.count == 0 && !s->woken && !stopped)
      wait_for(&s->called, &s->lock, fmax(least, wait));
    pthread_mutex_unlock(&s->lock);
  }
}

/* A thread beside all: has the guard look at connections, and ends the process where it does
 * not end by itself, for a driver that compiles cannot be stopped. Files are whole at any time. */
static void *keep(void *user) {
  server *s = user;
  double since = -1;
  pthread_mutex_lock(&s->lock);
  while (!s->ended) {
    const double now = abbe_clock_seconds();
    if (stopped && since < 0) {
      since = now;
      pthread_cond_broadcast(&s->called);
      pthread_cond_broadcast(&s->drawn);
    }
    if (since >= 0 && now - since > LAST_S) _exit(0);
    pthread_mutex_unlock(&s->lock);
    abbe_view_guard_look(&s->guard, LOOK_S);
    pthread_mutex_lock(&s->lock);
  }
  pthread_mutex_unlock(&s->lock);
  return NULL;
}

static abbe_result make_token(char *out, abbe_error *error) {
  unsigned char random[TOKEN_BYTES];
  if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random)
    return abbe_error_set(error, ABBE_IO, "no random numbers for the token: %s", strerror(errno));
  for (size_t i = 0; i < TOKEN_BYTES; i++) snprintf(out + 2 * i, 3, "%02x", random[i]);
  return ABBE_OK;
}

static abbe_result start(server *s, unsigned port, abbe_error *error) {
  s->guard.token = s->token;
  s->guard.enter = enter;
  s->guard.user = s;
  ABBE_TRY(abbe_view_guard_begin(&s->guard, port, error));
  s->daemon = MHD_start_daemon(MHD_USE_THREAD_PER_CONNECTION | MHD_USE_INTERNAL_POLLING_THREAD |
                                   MHD_USE_ITC | MHD_USE_NO_LISTEN_SOCKET,
                               0, NULL, NULL, answer, s, MHD_OPTION_CONNECTION_LIMIT,
                               2U * ABBE_VIEW_GUARD_MOST, MHD_OPTION_NOTIFY_CONNECTION, leave, s,
                               MHD_OPTION_CONNECTION_TIMEOUT, 30U, MHD_OPTION_NOTIFY_COMPLETED,
                               end_request, NULL, MHD_OPTION_END);
  if (s->daemon == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no thread for the page");
  return ABBE_OK;
}

/* The window, once the page is served. */
static abbe_result show(server *s, const abbe_view_app_desc *desc, size_t width, size_t height,
                        abbe_error *error) {
  const struct sigaction action = {.sa_handler = stop};
  abbe_view_app_desc own = *desc;
  own.wake = wake;
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
  sigaction(SIGHUP, &action, NULL);
  ABBE_TRY(abbe_view_hidden_begin(&s->hidden, &own, width, height, error));
  loop(s);
  abbe_view_hidden_end(&s->hidden);
  return ABBE_OK;
}

static abbe_result serve(server *s, unsigned port, const abbe_view_app_desc *desc, size_t width,
                         size_t height, abbe_error *error) {
  pthread_t keeper;
  abbe_result result = make_token(s->token, error);
  if (result == ABBE_OK) result = start(s, port, error);
  if (result != ABBE_OK) return result;
  if (pthread_create(&keeper, NULL, keep, s) != 0)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no thread for the page's connections");
  printf("http://127.0.0.1:%u/?token=%s\n", s->guard.port, s->token);
  fflush(stdout);
  result = show(s, desc, width, height, error);
  abbe_view_guard_close(&s->guard);
  MHD_stop_daemon(s->daemon);
  s->daemon = NULL;
  pthread_mutex_lock(&s->lock);
  s->ended = true;
  pthread_mutex_unlock(&s->lock);
  pthread_join(keeper, NULL);
  return result;
}

abbe_result abbe_view_serve_run(unsigned port, const abbe_view_app_desc *desc, size_t width,
                                size_t height, abbe_error *error) {
  server *s = calloc(1, sizeof *s);
  if (s == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the viewer");
  pthread_mutex_init(&s->lock, NULL);
  pthread_cond_init(&s->called, NULL);
  pthread_cond_init(&s->drawn, NULL);
  served = s;
  const abbe_result result = serve(s, port, desc, width, height, error);
  if (s->daemon != NULL) MHD_stop_daemon(s->daemon);
  pthread_cond_destroy(&s->drawn);
  pthread_cond_destroy(&s->called);
  pthread_mutex_destroy(&s->lock);
  abbe_view_guard_end(&s->guard);
  free(s->pixels);
  free(s->png);
  free(s);
  return result;
}

#else

abbe_result abbe_view_serve_run(unsigned port, const abbe_view_app_desc *desc, size_t width,
                                size_t height, abbe_error *error) {
  (void)port;
  (void)desc;
  (void)width;
  (void)height;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "this build serves no pages; install libmicrohttpd-dev and build again");
}

#endif
