/* view_events.h: what a page's pointer and keys do, as lines of text, and a queue of it in which
 * what follows takes the place of what nobody would see. Internal to cli/.
 */
#ifndef ABBE_CLI_VIEW_STATE_VIEW_EVENTS_H
#define ABBE_CLI_VIEW_STATE_VIEW_EVENTS_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_VIEW_EVENT_MOST_PIXELS 4096  /* pixels of a window's side */
#define ABBE_VIEW_EVENT_MOST_CLICKS 100.0 /* clicks of a wheel */
enum { ABBE_VIEW_MOST_EVENTS = 4096 };    /* that wait */

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

/* A line as cli/view/view_app.h lists them; it is taken apart in place. ABBE_PARSE says what is
 * wrong. */
abbe_result abbe_view_event_read(char *line, abbe_view_event *out, abbe_error *error);

/* Zeroed it is empty. */
typedef struct abbe_view_events {
  abbe_view_event event[ABBE_VIEW_MOST_EVENTS];
  size_t first, count;
} abbe_view_events;

/* Puts the event behind the others. Of moves, and of sizes, that follow each other the last is
 * kept, turns of the wheel at one place are added up. False where the queue is full. */
bool abbe_view_events_add(abbe_view_events *events, const abbe_view_event *event);
/* Takes the oldest; false where there is none. */
bool abbe_view_events_take(abbe_view_events *events, abbe_view_event *out);

#endif
