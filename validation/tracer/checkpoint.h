/* checkpoint.h: a trace put aside and taken up again.
 *
 * Holds the sums over passes exactly, so that a trace that is taken up gives the very image that
 * an unbroken one gives. It belongs to one scene and one request: anything else is refused by
 * name. Written beside its target and renamed.
 */
#ifndef ABBE_VALIDATION_TRACER_CHECKPOINT_H
#define ABBE_VALIDATION_TRACER_CHECKPOINT_H

#include "base/error.h"
#include "validation/tracer/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ABBE_IO where the file cannot be written. */
abbe_result abbe_checkpoint_save(const abbe_tracer *tracer, const char *path, abbe_error *error);

/* Puts the sums of the file into a tracer that was made from the same scene and request; on
 * failure the tracer is as it was. ABBE_IO, ABBE_PARSE for a file that is no checkpoint, broken,
 * cut off or of another version; ABBE_INVALID_ARGUMENT names what of scene or request differs. */
abbe_result abbe_checkpoint_load(abbe_tracer *tracer, const char *path, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
