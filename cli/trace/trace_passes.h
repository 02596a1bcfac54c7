/* trace_passes.h: the passes of `abbe trace`, by this process alone or by ranks together. */
#ifndef ABBE_CLI_TRACE_TRACE_PASSES_H
#define ABBE_CLI_TRACE_TRACE_PASSES_H

#include "cli/trace/trace_request.h"

#include "validation/tracer/trace_run.h"

/* With a bar. ABBE_CANCELLED where the user stopped it: what is done is to be saved all the same.
 */
abbe_result abbe_trace_passes(const abbe_trace_request *q, const abbe_trace_run_desc *run,
                              abbe_tracer *tracer, abbe_error *error);

/* All of a trace by the request's ranks, once each has made its tracer, or could not. */
abbe_result abbe_trace_together(abbe_trace_request *q, abbe_result made, abbe_tracer *tracer,
                                abbe_error *error);

#endif
