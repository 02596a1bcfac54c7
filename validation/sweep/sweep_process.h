/* sweep_process.h: what a person waits for: a whole process of the program that makes one picture,
 * from its start to its end.
 *
 * `abbe render` or `abbe trace` with a row's setting, by the clock: cold, with an empty cache of
 * shaders, and warm, with one that such a process has filled. What the process prints is dropped;
 * its picture and the caches are in a temporary folder, which goes with the measuring.
 * Internal to validation/sweep/.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_PROCESS_H
#define ABBE_VALIDATION_SWEEP_SWEEP_PROCESS_H

#include "base/error.h"
#include "validation/tradeoff/sweep_table.h"

#include <stdbool.h>

typedef struct abbe_sweep_process_desc {
  const char *program;   /* a path that can be run */
  const char *scene;     /* path */
  const char *materials; /* a table instead of the scene's, or NULL */
  const char *backend;   /* as --gl has it; or NULL */
  size_t width, height;  /* pixels; 0: the scene's */
  size_t runs;           /* warm ones behind the median, at most 99; 0: 1 */
} abbe_sweep_process_desc;

typedef struct abbe_sweep_process abbe_sweep_process;

/* The texts of desc outlive it. ABBE_IO where there is no place for temporary files,
 * ABBE_NO_MEMORY. */
abbe_result abbe_sweep_process_make(const abbe_sweep_process_desc *desc, abbe_sweep_process **out,
                                    abbe_error *error);
void abbe_sweep_process_free(abbe_sweep_process *process);

/* Sets warm_ms of the row, and cold_ms (of one run) where that is requested. ABBE_IO where the
 * program cannot be started or does not end well, with the words of its command; ABBE_CANCELLED
 * where it was interrupted. */
abbe_result abbe_sweep_process_measure(abbe_sweep_process *process, bool cold, abbe_sweep_row *row,
                                       abbe_error *error);

#endif
