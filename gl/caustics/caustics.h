/* caustics.h: light through refractors to the spectral map: what is fitted once, and
 * the passes of every frame. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_CAUSTICS_H
#define ABBE_GL_CAUSTICS_CAUSTICS_H

#include "colorimetry/image/image.h"
#include "gl/caustics/deposit_pass.h"
#include "gl/caustics/spectral_map.h"
#include "gl/light/light_layers.h"
#include "gl/light/photon_start.h"
#include "gl/light/receiver_atlas.h"
#include "gl/photons/photon_ledger.h"
#include "gl/photons/photon_spectra.h"
#include "gl/photons/refine_pass.h"
#include "gl/photons/trace_pass.h"

typedef struct abbe_caustics {
  abbe_photon_lights *views;
  abbe_light_layers *layers;
  abbe_receiver_atlas *atlas;
  abbe_spectral_map *map;
  abbe_photon_start start;
  abbe_photon_spectra spectra;
  abbe_photon_ledger ledger;
  abbe_trace_pass trace;
  abbe_refine_pass refine;
  abbe_deposit_pass deposit;
  size_t placed;                        /* the frame of the history that grids are placed for */
  bool measured[ABBE_SCENE_MAX_LIGHTS]; /* lists have the capacity for the light, as a frame has
                                           found */
  abbe_ledger energy[ABBE_SCENE_MAX_LIGHTS]; /* for unit power of each, as the last run found */
  bool energy_known;                         /* it had statistics */
} abbe_caustics;

/* Fits views, maps, tiles and grids by tracing photons, makes the atlas and the map, completes the
 * scene's variant by the tiles that there are. Of a plan with caustics. Reports progress. Errors as
 * of abbe_renderer_make; abbe_caustics_free also then. */
abbe_result abbe_caustics_make(abbe_photon_lights *views, abbe_light_layers *layers,
                               abbe_receiver_atlas *atlas, abbe_spectral_map *map,
                               abbe_shader_variant *variant, abbe_caustics *out, abbe_error *error);
void abbe_caustics_free(abbe_caustics *caustics);

/* Photons of every light to its map; where the frame has statistics, also their ledger. untimed_ms:
 * grows by what reading that took. ABBE_CANCELLED, ABBE_GL. */
abbe_result abbe_caustics_run(abbe_caustics *caustics, double *untimed_ms, abbe_error *error);

/* Gives back the memory of the last run's hits, where it is the process's own: the next run writes
 * them anew. The device has finished with them. */
void abbe_caustics_rest(abbe_caustics *caustics);

/* Where the light went in the last run, of lights as they are now. Known where that run had
 * statistics. */
bool abbe_caustics_know_energy(const abbe_caustics *caustics);
void abbe_caustics_energy(const abbe_caustics *caustics, abbe_ledger *out);

/* Hits of the batch of wavelengths from `first` on, as of abbe_renderer_read_hits; places move by
 * `origin`. What was read is the caller's, also after an error. */
abbe_result abbe_caustics_read_hits(abbe_caustics *caustics, size_t light, size_t first,
                                    const double origin[3], float **at, unsigned **path,
                                    unsigned **cell, size_t *count, abbe_error *error);

/* A light's map in bands of wavelengths, three at a time. */

/* X, Y, Z of the map as it is, and so many bands beside them, in W/nm, times `unit`; photons are
 * followed anew, and once more at the end, so that all is as it was. *out may be made where this
 * fails. */
abbe_result abbe_map_bands_read(abbe_caustics *caustics, size_t light, size_t bands, double unit,
                                abbe_image *out, abbe_error *error);

#endif
