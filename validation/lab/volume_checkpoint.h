/* volume_checkpoint.h: a volume that is being filled, put aside after whole nodes and taken up
 * again: it becomes the very volume that an unbroken run makes.
 *
 * It belongs to one object, one request and one kind of processor; anything else is refused.
 * Written beside its target and renamed.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_LAB_VOLUME_CHECKPOINT_H
#define ABBE_VALIDATION_LAB_VOLUME_CHECKPOINT_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes that are kept as they are. */
typedef struct abbe_kept_bytes {
  void *data;
  size_t size;
} abbe_kept_bytes;

/* FNV-1a of more bytes, on from h; ABBE_VOLUME_KEY at first. */
#define ABBE_VOLUME_KEY 14695981039346656037u
uint64_t abbe_volume_key(uint64_t h, const void *data, size_t size);

/* key: of all that decides what the volume is. nodes: that are done. ABBE_IO. */
abbe_result abbe_volume_checkpoint_save(const char *path, uint64_t key, uint64_t nodes,
                                        const abbe_kept_bytes *part, size_t parts,
                                        abbe_error *error);
/* What the parts hold is taken as it is. stop: other than 0 stops; or NULL. ABBE_PARSE for a file
 * that is no such checkpoint, or broken; ABBE_INVALID_ARGUMENT for that of another object or
 * request; ABBE_CANCELLED, ABBE_IO, ABBE_NO_MEMORY. On failure nothing is changed. */
abbe_result abbe_volume_checkpoint_load(const char *path, uint64_t key, uint64_t *nodes,
                                        const abbe_kept_bytes *part, size_t parts,
                                        const volatile int *stop, abbe_error *error);

/* A fill that keeps a checkpoint. */
typedef struct abbe_volume_keeping {
  const char *path; /* NULL: none is kept */
  double every_s;   /* at the least between two */
  bool resume;      /* go on from it, where there is one */
  uint64_t key;
  abbe_kept_bytes part[4];
  size_t parts;
  size_t nodes; /* in all */
  /* Whether so many nodes can have left what the parts hold, which a forged file's need not be. */
  bool (*holds)(const void *user, size_t nodes);
  const void *user;
  const volatile int *stop; /* other than 0 stops; or NULL */
  double saved_s;           /* by abbe_clock_seconds */
} abbe_volume_keeping;

/* *node: the first that is not done yet. Errors of abbe_volume_checkpoint_load, ABBE_PARSE also
 * where nodes or parts do not hold; the parts are of no use then. */
abbe_result abbe_volume_keeping_begin(abbe_volume_keeping *keeping, size_t *node,
                                      abbe_error *error);
/* After whole nodes, of which `nodes` are done; now: whenever the last was saved. */
abbe_result abbe_volume_keeping_end_node(abbe_volume_keeping *keeping, size_t nodes, bool now,
                                         abbe_error *error);

#endif
