/* trace_run.h: pass after pass until enough are done: by number, by time, or by error; with a
 * checkpoint now and then.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_TRACE_RUN_H
#define ABBE_VALIDATION_TRACE_TRACER_TRACE_RUN_H

#include "validation/trace/tracer/tracer.h"

typedef struct abbe_trace_run_desc {
  size_t passes; /* in all; 0: any number */
  size_t whole;  /* passes of all parts together, which the checkpoint keeps; 0: it is not known */
  double
      seconds;  /* duration of this run, after which it ends with two passes or more; 0: any time */
  double error; /* abbe_tracer_error, below which it ends with four passes or more; 0: any */
  const char *checkpoint;                    /* a file; or NULL */
  double checkpoint_s;                       /* how often it is written */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops a pass midway; or NULL */
} abbe_trace_run_desc;

/* Ends with what comes first. ABBE_CANCELLED where it was stopped: the tracer has the passes that
 * are done. Errors of abbe_tracer_pass and abbe_checkpoint_save. */
abbe_result abbe_trace_run(abbe_tracer *tracer, const abbe_trace_run_desc *desc, abbe_error *error);

/* Writes the checkpoint, if there is one to be and a pass to be in it. */
abbe_result abbe_trace_keep(const abbe_tracer *tracer, const abbe_trace_run_desc *desc,
                            abbe_error *error);

#endif
