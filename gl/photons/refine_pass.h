/* refine_pass.h: intervals between wavelengths of the coarse set whose photons ask for all of
 * theirs, listed, and traced a chunk at a time. Internal to gl/.
 */
#ifndef ABBE_GL_PHOTONS_REFINE_PASS_H
#define ABBE_GL_PHOTONS_REFINE_PASS_H

#include "gl/photons/trace_pass.h"

typedef struct abbe_refine_pass {
  abbe_trace_pass *trace;
  GLuint select;       /* program */
  GLuint wants;        /* intervals that ask, a bit each */
  GLuint asked, pairs; /* the same listed: all of a light; those of a chunk */
  abbe_hits hits;      /* of a chunk */
  size_t asked_room, pair_room;
  size_t most_pairs;                   /* of a chunk */
  size_t count[ABBE_SCENE_MAX_LIGHTS]; /* that ask, of each light, as last found */
  size_t fine_nodes; /* wavelengths of an interval at the most, with both ends */
} abbe_refine_pass;

/* After the trace's own decisions. */
abbe_result abbe_refine_pass_make(abbe_trace_pass *trace, abbe_refine_pass *out, abbe_error *error);
/* For the photons that the trace has room for now. */
abbe_result abbe_refine_pass_make_room(abbe_refine_pass *pass, abbe_error *error);
void abbe_refine_pass_free(abbe_refine_pass *pass);
abbe_result abbe_refine_pass_compile(abbe_refine_pass *pass, const abbe_shader_variant *variant,
                                     abbe_error *error);

/* Traces the coarse set and lists the intervals that ask, once it is known how many there are:
 * where a light is measured, in a frame with statistics, and where they take several chunks, it
 * waits for the device and makes room for as many as it finds. Every time they are the same.
 * ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_refine_pass_list(abbe_refine_pass *pass, size_t light, bool measures,
                                  abbe_error *error);
/* Chunks of the light's list; 0 where nobody asks. In which order it has them is not known, so that
 * one of several holds what another held in the frame before. */
size_t abbe_refine_pass_chunks(const abbe_refine_pass *pass, size_t light);
/* Traces one chunk's intervals. */
void abbe_refine_pass_run(abbe_refine_pass *pass, size_t light, size_t chunk);

#endif
