/* watch.h: whether what a thread does is still wanted.
 *
 * A caller that may lose interest in a result, such as a picture of a scene that is being dragged,
 * sets a watch for the thread that makes it. Routines that take longer than some milliseconds poll
 * it now and then, and end with ABBE_CANCELLED once it is over. It knows nothing of other threads,
 * those of a parallel loop included; at first nobody watches. */
#ifndef ABBE_BASE_THREAD_WATCH_H
#define ABBE_BASE_THREAD_WATCH_H

#include "base/error.h"

#include <stdbool.h>

typedef struct abbe_watch {
  bool (*goes_on)(void *user);
  void *user;
  bool over; /* the watch was ended; stays so */
} abbe_watch;

/* Sets the watch of this thread from now on; it lives until another one is set. NULL: nobody
 * watches. */
void abbe_watch_set(abbe_watch *watch);
/* Polls the watch, unless it is over. */
bool abbe_watch_goes_on(void);
/* The same: ABBE_OK or ABBE_CANCELLED. */
abbe_result abbe_watch_check(abbe_error *error);

#endif
