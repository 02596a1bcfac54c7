#include "cli/view/view_events.h"

#include "base/clock.h"
#include "base/number.h"

#include <ctype.h>
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
    return number(word[1], -100, 100, &e->x);
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

void abbe_view_event_apply(const abbe_view_event *e, abbe_view_hidden *h) {
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
