/* transport_study.h: ways for a caustic's light side by side: photons in each frame, volumes that
 * are computed beforehand, pinholes of surroundings; of each the error against a traced picture,
 * the time of a frame with a light that moves, bytes, and after how many frames a volume pays.
 */
#ifndef ABBE_VALIDATION_SWEEP_STUDIES_TRANSPORT_STUDY_H
#define ABBE_VALIDATION_SWEEP_STUDIES_TRANSPORT_STUDY_H

#include "validation/sweep/sweep_measure.h"
#include "validation/volume/volume_fill.h"

/* X(name, code): studies of contestants that are known by a name. */
#define ABBE_TRANSPORT_STUDIES(X) X("volume", VOLUME) X("pinhole", PINHOLE)
#define ABBE_TRANSPORT_STUDY_MOST 48
#define ABBE_TRANSPORT_STUDY_MOVES 8 /* pictures of a light that goes around by a degree each */

/* X(code, column) */
#define ABBE_TRANSPORT_NUMBERS(X)                                                                  \
  X(SAMPLES, "samples") /* samples of surfaces */                                                  \
  X(NODES, "nodes")                                                                                \
  X(CELLS, "cells")                                                                                \
  X(PHOTONS_NODE, "photons_node")                                                                  \
  X(PRECOMPUTE_S, "precompute_s")                                                                  \
  X(BYTES_MEMORY, "bytes_memory")                                                                  \
  X(BYTES_DISK, "bytes_disk")                                                                      \
  X(BYTES_GPU, "bytes_gpu")                                                                        \
  X(FRAME_MS, "frame_ms")   /* median; all passes are drawn anew */                                \
  X(LOOKUP_MS, "lookup_ms") /* part of it beyond that of surfaces alone */                         \
  X(NONE_MS, "none_ms")     /* the same frame, every lamp turned away from the object */           \
  X(OVER_NONE, "over_none") /* frame_ms beyond that, as a share of it */                           \
  X(MOVED_MS, "moved_ms")   /* median; the light has moved */                                      \
  X(CAUSTIC_DE, "caustic_de")                                                                      \
  X(CAUSTIC_DE_NOISE, "caustic_de_noise")                                                          \
  X(CAUSTIC_RMSE, "caustic_rmse")                                                                  \
  X(CAUSTIC_RMSE_NOISE, "caustic_rmse_noise")                                                      \
  X(NODE_ERROR, "node_error") /* the worst with the light at nodes near the scene's */             \
  X(MID_ERROR, "mid_error")   /* and midway between three (node_errors.h) */                       \
  X(LIMIT_RMSE, "limit_rmse") /* to what far more samples show (pinhole_limits.h) */               \
  X(POP, "pop") /* largest change between pictures of the light's way, RMS of theirs */            \
  X(FLUX_DRIFT, "flux_drift") /* through shells: the largest less the least share */               \
  X(PAYS_AFTER, "pays_after") /* frames of moving light; empty: never */

typedef enum abbe_transport_number {
#define ABBE_TRANSPORT_ENUM(code, column) ABBE_TRANSPORT_##code##_NUMBER,
  ABBE_TRANSPORT_NUMBERS(ABBE_TRANSPORT_ENUM)
#undef ABBE_TRANSPORT_ENUM
      ABBE_TRANSPORT_NUMBER_COUNT
} abbe_transport_number;

/* A request whose size is left open, and how the volume that it looks up is filled, whose object is
 * found; without one zeroed. */
typedef struct abbe_transport_contestant {
  abbe_render_desc render;
  abbe_volume_fill_desc fill;
  size_t joined_bytes; /* above 0: cells are joined by the least tolerance, nearly, with which they
                          take no more; the row's fill says which */
} abbe_transport_contestant;

/* Whether it looks up what was computed beforehand. */
bool abbe_transport_looks_up(const abbe_transport_contestant *contestant);

typedef struct abbe_transport_row {
  abbe_transport_contestant contestant;
  double number[ABBE_TRANSPORT_NUMBER_COUNT]; /* NaN: not known */
  bool on_time, on_bytes; /* the fronts of caustic_de by moved_ms, and by bytes_memory */
} abbe_transport_row;

typedef struct abbe_transport_study {
  char scene[256];
  size_t count;
  abbe_transport_row row[ABBE_TRANSPORT_STUDY_MOST];
} abbe_transport_study;

/* The contestants of that name, photons first; 0: there is none. */
size_t abbe_transport_study_contestants(const char *name, abbe_transport_contestant *out);

/* Fills, draws, times and compares each, at the size of the sweep's reference picture, which must
 * be there. Volumes are written to and removed from `file`, to know how large they are. Contestants
 * that the scene cannot be drawn by are left out: *refused counts them, and `why` (may be NULL)
 * says of the first. ABBE_INVALID_ARGUMENT where none remains; ABBE_CANCELLED. */
abbe_result abbe_transport_study_measure(const abbe_sweep *sweep,
                                         const abbe_transport_contestant *contestant, size_t count,
                                         const char *file, abbe_render_progress progress,
                                         void *user, abbe_transport_study *out, size_t *refused,
                                         abbe_error *why, abbe_error *error);

/* Finds the fronts, and finds over_none, and after how many frames each volume pays beside the
 * first row's photons; abbe_transport_study_measure has done so. */
void abbe_transport_study_judge(abbe_transport_study *study);

/* Whether two are the same pinholes but for how many. */
bool abbe_transport_same_but_samples(const abbe_render_desc *a, const abbe_render_desc *b);

/* Slope of log limit_rmse by log samples over the rows that differ from this one in samples alone,
 * by least squares; NaN with fewer than two. */
double abbe_transport_study_slope(const abbe_transport_study *study, size_t row);

#endif
