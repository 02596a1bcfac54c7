#include "base/thread/watch.h"

#include <stddef.h>

static _Thread_local abbe_watch *current;

void abbe_watch_set(abbe_watch *watch) {
  current = watch;
}

bool abbe_watch_goes_on(void) {
  if (current == NULL) return true;
  current->over = current->over || !current->goes_on(current->user);
  return !current->over;
}

abbe_result abbe_watch_check(abbe_error *error) {
  return abbe_watch_goes_on() ? ABBE_OK : abbe_error_set(error, ABBE_CANCELLED, "cancelled");
}
