/* trace_pass.h: photons through refractors to receivers, a hit a wavelength and slot. Internal to
 * gl/.
 */
#ifndef ABBE_GL_PHOTONS_TRACE_PASS_H
#define ABBE_GL_PHOTONS_TRACE_PASS_H

#include "gl/light/photon_start.h"
#include "gl/light/receiver_atlas.h"
#include "gl/photons/photon_ledger.h"
#include "gl/photons/photon_spectra.h"
#include "gl/scene/shader_variant.h"

#include <stdbool.h>
#include <stddef.h>

/* Which wavelengths: some of all, those that every photon takes, those of intervals that need
 * more. */
typedef enum abbe_trace_set {
  ABBE_TRACE_ALL,
  ABBE_TRACE_COARSE,
  ABBE_TRACE_REFINED
} abbe_trace_set;

/* Hits of so many photons or intervals: [items][slots][stride]. */
typedef struct abbe_hits {
  GLuint hits, signatures; /* [stride] side by side */
  GLuint marks, paths;     /* [items][slots] that hit anywhere, and their list */
  size_t stride;           /* capacity for wavelengths */
} abbe_hits;

typedef struct abbe_trace_pass {
  abbe_photon_start *start;
  abbe_photon_spectra *spectra;
  const abbe_receiver_atlas *atlas;
  abbe_photon_ledger *ledger;
  GLuint program, list_paths;
  bool here; /* the processor's own threads follow photons, and there is no program */
  abbe_hits hits;
  size_t most_photons; /* the capacity */
} abbe_trace_pass;

/* Decides for the photons that lights have now how many wavelengths a batch has, and whether every
 * photon takes all. ABBE_UNSUPPORTED for more than the device takes. */
abbe_result abbe_trace_pass_make(abbe_photon_start *start, abbe_photon_spectra *spectra,
                                 const abbe_receiver_atlas *atlas, abbe_photon_ledger *ledger,
                                 abbe_trace_pass *out, abbe_error *error);
void abbe_trace_pass_free(abbe_trace_pass *pass);
/* Capacity for the photons that lights have now, fewer than at first or as many. */
abbe_result abbe_trace_pass_make_room(abbe_trace_pass *pass, abbe_error *error);
/* Also where the variant has changed. */
abbe_result abbe_trace_pass_compile(abbe_trace_pass *pass, const abbe_shader_variant *variant,
                                    abbe_error *error);

abbe_result abbe_hits_make(abbe_gpu *gpu, size_t items, size_t slots, size_t stride,
                           size_t signature_bytes, abbe_hits *out, abbe_error *error);
void abbe_hits_free(abbe_gpu *gpu, abbe_hits *hits);

/* Wavelengths first .. first + count - 1 of all photons of the light; those below ledger_first are
 * in the ledger already. */
void abbe_trace_pass_batch(abbe_trace_pass *pass, size_t light, size_t first, size_t count,
                           size_t ledger_first);
/* The same, but for hits their segments through media that scatter (photon_path.glsl), and no
 * ledger. */
void abbe_trace_pass_ways(abbe_trace_pass *pass, size_t light, size_t first, size_t count);
void abbe_trace_pass_coarse(abbe_trace_pass *pass, size_t light);

/* All wavelengths of listed intervals, at most so many; each has at most `count`. */
void abbe_trace_pass_pairs(abbe_trace_pass *pass, size_t light, GLuint pairs, size_t most_pairs,
                           const abbe_hits *hits, size_t count);

/* The hits of the last batch, from wavelength `first` on:
 * [photons][slots][stride] x 4 floats, place (on tiles: texels and number) and flux of unit power
 * of the light, zero where there is none, and their paths (may be NULL); malloc'd. Waits for the
 * device.
 */
abbe_result abbe_trace_pass_read(abbe_trace_pass *pass, size_t light, size_t first, float **hits,
                                 GLuint **paths, abbe_error *error);
size_t abbe_trace_pass_hit_count(const abbe_trace_pass *pass, size_t light);

#endif
