/* patience.h: who watches a thread in a test: asked so many times before it goes on no more. */
#ifndef ABBE_TESTS_PATIENCE_H
#define ABBE_TESTS_PATIENCE_H

#include "base/thread/watch.h"

#include <stddef.h>

typedef struct patience {
  size_t asked, most;
} patience;

/* user: a patience; for abbe_watch. */
static inline bool patience_lasts(void *user) {
  patience *p = user;
  return p->asked++ < p->most;
}

#endif
