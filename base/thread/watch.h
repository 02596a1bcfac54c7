/* watch.h: whether what a thread does is still wanted.
 *
 * Who has something done that he may lose interest in, such as a picture of a scene that is being
 * dragged, sets a watch for the thread that does it. Routines that take longer than some
 * milliseconds ask it now and then, and end with ABBE_CANCELLED where it is over. Of other threads
 * it knows nothing, those of a parallel loop included; nobody watches at first.
 */
#ifndef ABBE_BASE_THREAD_WATCH_H
#define ABBE_BASE_THREAD_WATCH_H

#include "base/error.h"

#include <stdbool.h>

typedef struct abbe_watch {
  bool (*goes_on)(void *user);
  void *user;
  bool over; /* it was told so; stays */
} abbe_watch;

/* Of this thread from now on; it lives until another one is set. NULL: nobody watches. */
void abbe_watch_set(abbe_watch *watch);
/* Asks, unless it is over. */
bool abbe_watch_goes_on(void);
/* The same: ABBE_OK or ABBE_CANCELLED. */
abbe_result abbe_watch_check(abbe_error *error);

#endif
