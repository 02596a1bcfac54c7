/* bounded_trace.h: a traced picture whose passes go on until its own error keeps a bound.
 *
 * Presets promise what other scenes had; a scene with light of another kind is found out here, by
 * its own passes (pass_error.h), and traced for longer. It compares with no reference.
 */
#ifndef ABBE_VALIDATION_TRACE_BOUNDED_TRACE_H
#define ABBE_VALIDATION_TRACE_BOUNDED_TRACE_H

#include "validation/trace/pass_error.h"
#include "validation/trace/tracer/tracer.h"

/* A bound may take up to so many times the passes that were requested. */
#define ABBE_BOUNDED_TRACE_MOST_TIMES 64

typedef struct abbe_bounded_trace_desc {
  abbe_trace_desc trace; /* its guides are set where the picture is to be filtered */
  size_t passes;         /* at least 1, of a filtered picture 2 */
  bool filtered;
  double max_error; /* mean CIEDE2000 in the caustic, by pass_error's bound; 0: none is requested */
  bool (*progress)(void *user, double done); /* progress of the passes; false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops a pass midway; or NULL */
} abbe_bounded_trace_desc;

typedef struct abbe_bounded_trace {
  size_t passes;       /* that were traced */
  abbe_pass_error own; /* NaN: of one pass, of a filtered picture without max_error, and where
                          nothing is lit through refractors */
} abbe_bounded_trace;

/* Traces the passes; with max_error two at least, four of a filtered picture, and then more until
 * own.bound keeps it. Ends with own.bound above max_error where that would take more than
 * ABBE_BOUNDED_TRACE_MOST_TIMES times the passes, as soon as that shows. ABBE_INVALID_ARGUMENT for
 * too few passes; ABBE_CANCELLED; errors of abbe_tracer_make, abbe_tracer_pass and
 * abbe_denoise_picture. */
abbe_result abbe_bounded_trace_make(const abbe_scene *scene, const abbe_bounded_trace_desc *desc,
                                    abbe_image *picture, abbe_bounded_trace *out,
                                    abbe_error *error);

#endif
