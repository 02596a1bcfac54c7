#include "base/maths.h"

#include <gsl/gsl_errno.h>
#include <pthread.h>
#include <stddef.h>

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static size_t inside;
static gsl_error_handler_t *previous;

void abbe_gsl_guard_enter(void) {
  pthread_mutex_lock(&mutex);
  if (inside++ == 0) previous = gsl_set_error_handler_off();
  pthread_mutex_unlock(&mutex);
}

void abbe_gsl_guard_leave(void) {
  pthread_mutex_lock(&mutex);
  if (--inside == 0) gsl_set_error_handler(previous);
  pthread_mutex_unlock(&mutex);
}
