/* refine_pass.h: more wavelengths where a photon's hits need them. Every photon is traced at the
 * wavelengths of the coarse set. An interval between two of these may need, for one photon, to be
 * traced at all the plan's wavelengths that lie in it. Such intervals are listed, and traced a
 * chunk of the list at a time. Internal to gl/.
 */
#ifndef ABBE_GL_PHOTONS_REFINE_PASS_H
#define ABBE_GL_PHOTONS_REFINE_PASS_H

#include "gl/photons/trace_pass.h"

typedef struct abbe_refine_pass {
  abbe_trace_pass *trace;
  GLuint select;       /* program */
  GLuint wants;        /* for each photon: its intervals that want more wavelengths, a bit each */
  GLuint asked, pairs; /* lists of photon and interval: all that need more, of a light; a chunk's */
  abbe_hits hits;      /* hits of a chunk */
  size_t asked_room, pair_room; /* elements of the two lists */
  size_t most_pairs;            /* pairs of a chunk, at the most */
  size_t
      count[ABBE_SCENE_MAX_LIGHTS]; /* intervals that need more, of each light, as last measured */
  size_t fine_nodes;                /* wavelengths of an interval at the most, with both ends */
} abbe_refine_pass;

/* After abbe_trace_pass_make, which may decide that every photon takes all wavelengths: then there
 * is nothing to refine. */
void abbe_refine_pass_make(abbe_trace_pass *trace, abbe_refine_pass *out);
/* For the photons that the trace has capacity for now. */
abbe_result abbe_refine_pass_make_room(abbe_refine_pass *pass, abbe_error *error);
void abbe_refine_pass_free(abbe_refine_pass *pass);
abbe_result abbe_refine_pass_compile(abbe_refine_pass *pass, const abbe_shader_variant *variant,
                                     abbe_error *error);

/* Traces the light's photons at the coarse set, then lists the intervals that need more. measures:
 * it waits for the device, reads how many there are, and makes capacity for them. That is needed
 * once: until something is fitted anew the same intervals do in every frame. ABBE_GL,
 * ABBE_NO_MEMORY. */
abbe_result abbe_refine_pass_list(abbe_refine_pass *pass, size_t light, bool measures,
                                  abbe_error *error);
/* Chunks of the light's list, as last measured; 0: no interval needs more. The list's order differs
 * from frame to frame, and so does what each of several chunks holds. */
size_t abbe_refine_pass_chunks(const abbe_refine_pass *pass, size_t light);
/* Traces one chunk's intervals, at all their wavelengths. */
void abbe_refine_pass_run(abbe_refine_pass *pass, size_t light, size_t chunk);

#endif
