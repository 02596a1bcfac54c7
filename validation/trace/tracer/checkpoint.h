/* checkpoint.h: a trace put aside and taken up again.
 *
 * Holds the sums over passes exactly, so that a trace that is taken up gives the very image that
 * an unbroken one gives, and passes that were traced in parts the image of one run. It belongs to
 * one scene, one request and one kind of processor: anything else is refused by name. Written
 * beside its target and renamed.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_CHECKPOINT_H
#define ABBE_VALIDATION_TRACE_TRACER_CHECKPOINT_H

#include "base/error.h"
#include "validation/trace/tracer/tracer.h"

#include <stdbool.h>

/* ABBE_IO where the file cannot be written. */
abbe_result abbe_checkpoint_save(const abbe_tracer *tracer, const char *path, abbe_error *error);

/* Puts the sums of the file into a tracer that was made from the same scene and request; on
 * failure the tracer is as it was. ABBE_IO, ABBE_PARSE for a file that is no checkpoint, broken,
 * cut off or of another version; ABBE_INVALID_ARGUMENT names what of scene or request differs. */
abbe_result abbe_checkpoint_load(abbe_tracer *tracer, const char *path, abbe_error *error);

/* What there is to be put together. A zeroed one is a valid request. */
typedef struct abbe_checkpoint_merging {
  size_t whole;    /* passes, from 0 on; 0: as many as the files state or hold */
  bool incomplete; /* go on where some are missing; then they cannot be gone on with as a part */
  char lacks[512]; /* out: the first passes that are missing, and how many; "": none are */
} abbe_checkpoint_merging;

/* Puts the passes of all the files together, which may stand in any order: they must begin at pass
 * 0 and leave none out, and none may be in two files. how may be NULL. *tracer is made from the
 * same scene and request; what it holds is replaced. It is as it was where a head is refused, and
 * empty after other errors. ABBE_INVALID_ARGUMENT names the passes that are missing or twice there,
 * and in which files, or a file that changed meanwhile; errors of abbe_checkpoint_load. */
abbe_result abbe_checkpoint_merge(abbe_tracer *tracer, const char *const *path, size_t count,
                                  abbe_checkpoint_merging *how, abbe_error *error);

/* Whether the file begins as a checkpoint does, of whatever version. */
bool abbe_checkpoint_is(const char *path);

#endif
