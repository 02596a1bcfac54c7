/* lamp_rays.h: whether the lamp would see the places where its photons land past other receivers.
 *
 * The map of a light holds only those: the others are marked as hidden. Refractors and mirrors hide
 * nothing: what lands in their shadow has its place in the map. Rays to the lamp wait until there
 * is a packet of them.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_WALKS_LAMP_RAYS_H
#define ABBE_VALIDATION_WALKS_LAMP_RAYS_H

#include "validation/walks/photon.h"
#include "validation/walks/ray_batch.h"

/* Whether a receiver may hide a place on another from the lamp: those that are the walls of a
 * convex room around it hide nothing, and no ray need be traced. */
bool abbe_lamp_is_hidden(const abbe_geometry *g, const abbe_light *light);

/* Photon hits that wait for their ray to the lamp, of one light. A zeroed one has none. */
typedef struct abbe_lamp_rays {
  struct RTCRay16 ray;
  size_t count;
  uint64_t traced; /* so far */
  const abbe_light *light;
  float p[3][ABBE_RAY_LANES], ng[3][ABBE_RAY_LANES], size[ABBE_RAY_LANES];
  abbe_photon_hit *photon[ABBE_RAY_LANES];
  double flux[ABBE_RAY_LANES]; /* W, for the ledger */
} abbe_lamp_rays;

/* One more; a full packet is traced. */
void abbe_lamp_rays_add(abbe_lamp_rays *rays, const abbe_geometry *g, const abbe_light *light,
                        const abbe_hit *hit, abbe_photon_hit *photon, double flux,
                        abbe_light_ledger *ledger, abbe_ray_record *record);
/* Traces those that wait, marks what is hidden and adds it to the ledger. */
void abbe_lamp_rays_trace(abbe_lamp_rays *rays, const abbe_geometry *g, abbe_light_ledger *ledger,
                          abbe_ray_record *record);

#endif
