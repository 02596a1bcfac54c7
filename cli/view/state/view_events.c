#include "cli/view/state/view_events.h"

#include "base/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MOST_WORDS = 6 };

static bool number(const char *text, double least, double most, double *out) {
  const char *end;
  return text != NULL && abbe_number_read(text, &end, out) && *end == '\0' && *out >= least &&
         *out <= most;
}

static bool read_words(char *const word[MOST_WORDS], size_t words, abbe_view_event *e) {
  const double far = 4.0 * ABBE_VIEW_EVENT_MOST_PIXELS, most = ABBE_VIEW_EVENT_MOST_PIXELS;
  double button = 0;
  for (size_t i = 2; i < words; i++) {
    if (strcmp(word[i], "shift") == 0) e->shift = true;
    if (strcmp(word[i], "control") == 0) e->control = true;
  }
  if (strcmp(word[0], "move") == 0) {
    e->kind = ABBE_VIEW_EVENT_MOVE;
    return number(word[1], -far, far, &e->x) && number(word[2], -far, far, &e->y);
  }
  if (strcmp(word[0], "size") == 0) {
    e->kind = ABBE_VIEW_EVENT_SIZE;
    return number(word[1], 1, most, &e->x) && number(word[2], 1, most, &e->y);
  }
  if (strcmp(word[0], "wheel") == 0) {
    e->kind = ABBE_VIEW_EVENT_WHEEL;
    return number(word[1], -ABBE_VIEW_EVENT_MOST_CLICKS, ABBE_VIEW_EVENT_MOST_CLICKS, &e->x);
  }
  if (strcmp(word[0], "down") == 0 || strcmp(word[0], "up") == 0) {
    e->kind = ABBE_VIEW_EVENT_BUTTON;
    e->down = word[0][0] == 'd';
    if (!number(word[1], 0, 2, &button)) return false;
    e->button = (int)button;
    return true;
  }
  if (strcmp(word[0], "key") != 0 || words < 3) return false;
  e->kind = ABBE_VIEW_EVENT_KEY;
  e->down = strcmp(word[2], "down") == 0;
  if (!e->down && strcmp(word[2], "up") != 0) return false;
  return snprintf(e->key, sizeof e->key, "%s", word[1]) < (int)sizeof e->key;
}

abbe_result abbe_view_event_read(char *line, abbe_view_event *out, abbe_error *error) {
  char whole[81], *word[MOST_WORDS] = {0}, *rest = line;
  size_t words = 0;
  snprintf(whole, sizeof whole, "%s", line);
  *out = (abbe_view_event){0};
  while (words < MOST_WORDS && (word[words] = strtok_r(rest, " \t\r", &rest)) != NULL) words++;
  if (words > 0 && read_words(word, words, out)) return ABBE_OK;
  return abbe_error_set(error, ABBE_PARSE,
                        "'%s' is no event; write move X Y, down 0, up 0, wheel 1, key z down "
                        "control or size 900 560",
                        whole);
}

/* ---- the queue ---- */

static abbe_view_event *last_of(abbe_view_events *q, size_t before) {
  return before < q->count ? &q->event[q->first + q->count - 1 - before] : NULL;
}

/* What waits makes the event one of it. */
static bool merge(abbe_view_events *q, const abbe_view_event *e) {
  abbe_view_event *last = last_of(q, 0), *other = last_of(q, 1);
  if (last == NULL) return false;
  if (last->kind == e->kind &&
      (e->kind == ABBE_VIEW_EVENT_MOVE || e->kind == ABBE_VIEW_EVENT_SIZE)) {
    *last = *e;
    return true;
  }
  if (last->kind != ABBE_VIEW_EVENT_WHEEL) return false;
  if (e->kind == ABBE_VIEW_EVENT_WHEEL) {
    last->x = fmax(-ABBE_VIEW_EVENT_MOST_CLICKS, fmin(last->x + e->x, ABBE_VIEW_EVENT_MOST_CLICKS));
    return true;
  }
  /* pages say where the pointer is before each turn of the wheel */
  return e->kind == ABBE_VIEW_EVENT_MOVE && other != NULL && other->kind == ABBE_VIEW_EVENT_MOVE &&
         !(fabs(other->x - e->x) > 0) && !(fabs(other->y - e->y) > 0);
}

bool abbe_view_events_add(abbe_view_events *q, const abbe_view_event *e) {
  if (merge(q, e)) return true;
  if (q->count == ABBE_VIEW_MOST_EVENTS) return false;
  if (q->first + q->count == ABBE_VIEW_MOST_EVENTS) {
    memmove(q->event, q->event + q->first, q->count * sizeof *q->event);
    q->first = 0;
  }
  q->event[q->first + q->count++] = *e;
  return true;
}

bool abbe_view_events_take(abbe_view_events *q, abbe_view_event *out) {
  if (q->count == 0) return false;
  *out = q->event[q->first++];
  if (--q->count == 0) q->first = 0;
  return true;
}
