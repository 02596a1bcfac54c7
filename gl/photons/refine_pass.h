/* refine_pass.h: intervals between wavelengths of the coarse set whose photons ask for all of
 * theirs, listed and traced, a chunk at a time. Internal to gl/.
 */
#ifndef ABBE_GL_PHOTONS_REFINE_PASS_H
#define ABBE_GL_PHOTONS_REFINE_PASS_H

#include "gl/photons/trace_pass.h"

typedef struct abbe_refine_pass {
  abbe_trace_pass *trace;
  GLuint select;       /* program */
  GLuint wants, pairs; /* intervals that ask: a bit each; those of a chunk, listed */
  abbe_hits hits;
  size_t pair_room, chunks;
  size_t fine_nodes; /* wavelengths of an interval at the most, with both ends */
} abbe_refine_pass;

/* After the trace's own decisions. */
abbe_result abbe_refine_pass_make(abbe_trace_pass *trace, abbe_refine_pass *out, abbe_error *error);
/* For the photons that the trace has room for now; for `pairs` of intervals, in as many chunks as
 * that takes, and never for fewer or in fewer chunks than before. */
abbe_result abbe_refine_pass_make_room(abbe_refine_pass *pass, abbe_error *error);
abbe_result abbe_refine_pass_make_pairs(abbe_refine_pass *pass, size_t pairs, abbe_error *error);
/* Chunks of photons for lists of `room`, if all together come to `count`. */
size_t abbe_refine_pass_chunks(size_t count, size_t room);
void abbe_refine_pass_free(abbe_refine_pass *pass);
abbe_result abbe_refine_pass_compile(abbe_refine_pass *pass, const abbe_shader_variant *variant,
                                     abbe_error *error);

/* Traces the coarse set; then nobody asks. */
void abbe_refine_pass_coarse(abbe_refine_pass *pass, size_t light);
/* How many intervals ask, of all photons; then nobody asks. The coarse set is
 * traced by then. Waits for the device. */
size_t abbe_refine_pass_count(abbe_refine_pass *pass, size_t light);
/* Lists and traces one chunk's intervals. */
void abbe_refine_pass_run(abbe_refine_pass *pass, size_t light, size_t chunk);

#endif
