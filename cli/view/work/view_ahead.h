/* view_ahead.h: compiles ahead: what a stage draws with is compiled by a second worker, which draws
 * the same small, so that neither what moves nor a cancel waits for the compiler.
 *
 * Compiled programs come back through the driver's cache on disk (Mesa keeps one); without a cache
 * the stage compiles them once more itself. The second worker is made when it is needed first.
 */
#ifndef ABBE_CLI_VIEW_WORK_VIEW_AHEAD_H
#define ABBE_CLI_VIEW_WORK_VIEW_AHEAD_H

#include "cli/view/work/view_worker.h"

/* Zeroed: nobody compiles yet. */
typedef struct abbe_view_ahead {
  abbe_view_worker *worker;
  abbe_view_result taken; /* while it is freed */
} abbe_view_ahead;

/* Takes over a request that ended with ABBE_VIEW_UNCOMPILED; only while idle. What it was given
 * `materials`, `volume` and `wake` (may be NULL) are as of abbe_view_worker_make, whose errors
 * these are; the request is freed then. */
abbe_result abbe_view_ahead_give(abbe_view_ahead *ahead, const char *materials,
                                 const abbe_caustic_volume *volume, void (*wake)(void),
                                 abbe_view_request *request, abbe_error *error);
bool abbe_view_ahead_idle(const abbe_view_ahead *ahead);
/* Whether what was given is compiled now; true once. */
bool abbe_view_ahead_take(abbe_view_ahead *ahead);
/* Stops it between two programs. */
void abbe_view_ahead_free(abbe_view_ahead *ahead);

#endif
