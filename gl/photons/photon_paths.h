/* photon_paths.h: follows photons through refractors on the processor's own threads, as
 * photon_trace.comp does on the device, where the device is that processor: through the meshes of
 * mesh_walk.h. Internal to gl/photons/.
 */
#ifndef ABBE_GL_PHOTONS_PHOTON_PATHS_H
#define ABBE_GL_PHOTONS_PHOTON_PATHS_H

#include "gl/photons/trace_pass.h"

/* What photon_trace.comp would be told, by its names. */
typedef struct abbe_photon_batch {
  size_t light, sample_first, sample_count, ledger_first;
  abbe_trace_set set;
  GLuint pairs; /* of ABBE_TRACE_REFINED: the list, and its capacity */
  size_t most_pairs;
} abbe_photon_batch;

bool abbe_photon_paths_serve(const abbe_trace_pass *pass, const abbe_shader_variant *variant);
/* Clears the hits' signatures and marks first. */
void abbe_photon_paths_follow(const abbe_trace_pass *pass, const abbe_photon_batch *batch,
                              const abbe_hits *hits);

#endif
