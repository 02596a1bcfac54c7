/* deposit_pass.h: photon hits to light in the spectral map: splats between wavelengths and between
 * cells, listed, then added, a chunk at a time. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_DEPOSIT_PASS_H
#define ABBE_GL_CAUSTICS_DEPOSIT_PASS_H

#include "gl/caustics/spectral_map.h"
#include "gl/photons/refine_pass.h"

/* Hits that lie in the buffers now. */
typedef struct abbe_hit_batch {
  abbe_trace_set set;
  size_t first, count;                 /* wavelengths */
  size_t interval_first, interval_end; /* between them, that are deposited */
} abbe_hit_batch;

typedef struct abbe_deposit_pass {
  const abbe_trace_pass *trace;
  const abbe_refine_pass *refine;
  abbe_spectral_map *map;
  GLuint list, add; /* programs; add: where the device is no processor (splat_sums.h) */
  GLuint splats;
  size_t splat_room, chunks; /* splats that are listed at a time; chunks of the photons */
  size_t most_splats;        /* the capacity before there are more chunks */
} abbe_deposit_pass;

/* photons: the variant of the trace. */
abbe_result abbe_deposit_pass_make(const abbe_trace_pass *trace, const abbe_refine_pass *refine,
                                   abbe_spectral_map *map, const abbe_shader_variant *photons,
                                   const abbe_shader_variant *scene, abbe_deposit_pass *out,
                                   abbe_error *error);
void abbe_deposit_pass_free(abbe_deposit_pass *pass);
/* Deposits a batch. measures: it waits for the device and makes capacity for what it finds; a batch
 * of the same photons that is deposited anew finds the same, so that no frame has to measure it
 * again. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_deposit_pass_run(abbe_deposit_pass *pass, size_t light,
                                  const abbe_hit_batch *batch, bool measures, abbe_error *error);

#endif
