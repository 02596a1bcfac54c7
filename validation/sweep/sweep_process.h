/* sweep_process.h: what a person waits for: a whole process of the program that makes one picture,
 * from its start to its end.
 *
 * `abbe render` or `abbe trace` with a row's setting, run with an empty cache of shaders (cold) and
 * with the one that this filled (warm), by the clock. What the process prints is dropped; its
 * picture goes to a temporary folder, which is removed.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_PROCESS_H
#define ABBE_VALIDATION_SWEEP_SWEEP_PROCESS_H

#include "base/error.h"
#include "validation/tradeoff/sweep_table.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_sweep_process_desc {
  const char *program;   /* a path that can be run */
  const char *scene;     /* path */
  const char *materials; /* a table instead of the scene's, or NULL */
  const char *backend;   /* as --gl has it; or NULL */
  size_t width, height;  /* pixels; 0: the scene's */
  size_t runs;           /* warm ones behind the median; 0: 3 */
} abbe_sweep_process_desc;

/* Sets warm_ms and cold_ms of the row. Once cold, so that figure is of one run. ABBE_IO where the
 * program cannot be started or does not end well, with the words of its command;
 * ABBE_CANCELLED where it was interrupted. */
abbe_result abbe_sweep_process_measure(const abbe_sweep_process_desc *desc, abbe_sweep_row *row,
                                       abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
