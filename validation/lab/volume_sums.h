/* volume_sums.h: segments of light's paths added up over the cells of a region, pass by pass, with
 * standard errors.
 *
 * Of vector irradiance a cell's is the flux of every segment in it, times its length and direction,
 * over the cell's space. As the method was printed a segment counts once in every cell that it
 * comes to, with the cosine to where the cell lies from the centre, over what the beam alone would
 * bring there. Internal to validation/lab/.
 */
#ifndef ABBE_VALIDATION_LAB_VOLUME_SUMS_H
#define ABBE_VALIDATION_LAB_VOLUME_SUMS_H

#include "base/error.h"
#include "scenes/volume/caustic_volume.h"
#include "validation/trace/tracer/accumulator.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct abbe_volume_sums {
  const abbe_volume_region *region;
  bool printed;
  size_t channels; /* 9, of X, Y and Z in turn; printed 3 */
  double *weight;  /* [cells] 1 / m3; printed 1 / m2 */
  abbe_accumulator sums;
  abbe_region_piece *piece; /* [threads][ABBE_REGION_MOST_PIECES] */
} abbe_volume_sums;

/* A cell with less of its space left than that holds nothing. */
#define ABBE_VOLUME_SUMS_LEAST_SPACE 0.02f

/* share[cells]: of each that is empty (exit_fill.h), NULL: all; not read of a printed one, which
 * reads the unit direction of the beam instead. The region outlives it. ABBE_NO_MEMORY. */
abbe_result abbe_volume_sums_make(const abbe_volume_region *region, bool printed,
                                  const float *share, const double beam[3], size_t threads,
                                  abbe_volume_sums *out, abbe_error *error);
void abbe_volume_sums_free(abbe_volume_sums *sums);

/* A segment from o (from the region's centre, m) along unit d, of length m or INFINITY, with the
 * flux of each colour, W, of light with an irradiance of 1 across its beam. */
void abbe_volume_sums_add(abbe_volume_sums *sums, size_t thread, const double o[3],
                          const double d[3], double length, const float flux[3]);
/* Ends the pass: abbe_accumulator_end_pass(&sums->sums). Mean of a cell's value and its standard
 * error, infinite before two passes. */
double abbe_volume_sums_mean(const abbe_volume_sums *sums, size_t cell, size_t channel);
double abbe_volume_sums_error(const abbe_volume_sums *sums, size_t cell, size_t channel);

/* Root mean square of the standard errors of Y's (G's) values over that of the values. */
double abbe_volume_sums_relative_error(const abbe_volume_sums *sums);
/* Flux of Y that goes out through a shell, W: of F's radial part, times the cells' solid angles at
 * their middles. Of shells, not printed. */
double abbe_volume_sums_outflow(const abbe_volume_sums *sums, size_t shell);

/* A volume that is being filled, put aside after whole nodes and taken up
 * again: it becomes the very volume that an unbroken run makes.
 *
 * It belongs to one object, one request and one kind of processor; anything else is refused.
 * Written beside its target and renamed. */

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
