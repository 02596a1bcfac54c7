/* view_events.h: what a page's pointer and keys do, as lines of text, and their way into the
 * window that nobody sees. */
#ifndef ABBE_CLI_VIEW_VIEW_EVENTS_H
#define ABBE_CLI_VIEW_VIEW_EVENTS_H

#include "cli/view/view_hidden.h"

typedef enum abbe_view_event_kind {
  ABBE_VIEW_EVENT_MOVE,
  ABBE_VIEW_EVENT_BUTTON,
  ABBE_VIEW_EVENT_WHEEL,
  ABBE_VIEW_EVENT_KEY,
  ABBE_VIEW_EVENT_SIZE
} abbe_view_event_kind;

typedef struct abbe_view_event {
  abbe_view_event_kind kind;
  double x, y;  /* pixels; wheel: clicks in x */
  int button;   /* 0 left, 1 right, 2 middle */
  char key[16]; /* a character, or Enter, Backspace, Escape */
  bool down, shift, control;
} abbe_view_event;

#define ABBE_VIEW_EVENT_MOST_PIXELS 4096 /* of a window's side */

/* A line as view_serve.h lists them; it is taken apart in place. ABBE_PARSE says what is wrong. */
abbe_result abbe_view_event_read(char *line, abbe_view_event *out, abbe_error *error);
/* Gives it to the window and draws what the next one must find drawn. */
void abbe_view_event_apply(const abbe_view_event *event, abbe_view_hidden *hidden);

#endif
