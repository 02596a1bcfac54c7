/* reference.h: a traced reference from start to end: passes, checkpoints, the picture and the map.
 *
 * What `abbe_tracer` does pass by pass, as one piece of work that can be stopped and taken up
 * again. It compares nothing. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_REFERENCE_H
#define ABBE_VALIDATION_TRACE_TRACER_REFERENCE_H

#include "validation/trace/tracer/tracer.h"

#define ABBE_REFERENCE_PASSES 64

typedef struct abbe_reference_desc {
  abbe_trace_desc trace;
  size_t passes;          /* 0: ABBE_REFERENCE_PASSES */
  const char *checkpoint; /* a file to go on from, kept every 30 s and when stopped; whoever has put
                             away what is given removes it; or NULL */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops a pass midway; or NULL */
} abbe_reference_desc;

/* The picture and the receiver map, as the tracer gives them. ABBE_CANCELLED where it was stopped:
 * then nothing is given, and the checkpoint holds what is done. A checkpoint of another scene or
 * request is an error of abbe_checkpoint_load. */
abbe_result abbe_reference_trace(const abbe_scene *scene, const abbe_reference_desc *desc,
                                 abbe_image *picture, abbe_image *map, abbe_error *error);

#endif
