/* trace_results.h: what `abbe trace` writes of a trace, and says of it. */
#ifndef ABBE_CLI_TRACE_TRACE_RESULTS_H
#define ABBE_CLI_TRACE_TRACE_RESULTS_H

#include "cli/trace/trace_request.h"

/* All files that are asked for; notes the time of the filter in the request. */
abbe_result abbe_trace_write(abbe_trace_request *q, const abbe_tracer *tracer, abbe_error *error);

/* A line on stderr, unless it is to be quiet. */
void abbe_trace_summarise(const abbe_trace_request *q, const abbe_tracer *tracer);

#endif
