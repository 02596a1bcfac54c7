#include "cli/options/own_context.h"

#include <stdatomic.h>
#include <stdio.h>

abbe_result abbe_own_context_make(abbe_context_backend backend, bool quiet, abbe_context **out,
                                  abbe_error *error) {
  static atomic_flag said = ATOMIC_FLAG_INIT;
  ABBE_TRY(abbe_context_make(backend, out, error));
  if (quiet) return ABBE_OK;
  const char *why = abbe_context_refused_gpu(*out);
  if (why[0] != '\0' && !atomic_flag_test_and_set(&said))
    fprintf(stderr, "note: the GPU is not used, and the CPU draws: %s\n", why);
  return ABBE_OK;
}
