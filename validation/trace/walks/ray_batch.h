/* ray_batch.h: the rays of many paths, sixteen a packet, as Embree traces them side by side.
 *
 * It knows no light: a ray has a place in its batch, and what it meets is read there.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_RAY_BATCH_H
#define ABBE_VALIDATION_TRACE_WALKS_RAY_BATCH_H

#include "validation/trace/transport/geometry.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_RAY_LANES 16 /* rays of a packet */

/* What all rays of the packets have in common; they are zeroed before. */
static inline void abbe_ray_prepare(struct RTCRayHit16 *packets, size_t count) {
  for (size_t i = 0; i < count; i++)
    for (size_t k = 0; k < ABBE_RAY_LANES; k++) packets[i].ray.mask[k] = ABBE_GEOMETRY_ALL;
}

/* Ray i to be traced, of prepared packets: lane i % ABBE_RAY_LANES of its packet. */
static inline void abbe_ray_put(struct RTCRayHit16 *packets, size_t i, const float o[3],
                                const float d[3]) {
  struct RTCRayHit16 *p = &packets[i / ABBE_RAY_LANES];
  size_t k = i % ABBE_RAY_LANES;
  p->ray.org_x[k] = o[0];
  p->ray.org_y[k] = o[1];
  p->ray.org_z[k] = o[2];
  p->ray.dir_x[k] = d[0];
  p->ray.dir_y[k] = d[1];
  p->ray.dir_z[k] = d[2];
}

/* The ray of lane k. */
static inline void abbe_ray_take(const struct RTCRayHit16 *p, size_t k, float o[3], float d[3]) {
  o[0] = p->ray.org_x[k];
  o[1] = p->ray.org_y[k];
  o[2] = p->ray.org_z[k];
  d[0] = p->ray.dir_x[k];
  d[1] = p->ray.dir_y[k];
  d[2] = p->ray.dir_z[k];
}

/* Where the ray of lane k, which Embree has been through, meets the surface. */
static inline void abbe_ray_place(const struct RTCRayHit16 *p, size_t k, const abbe_surface *s,
                                  abbe_hit *out) {
  const uint32_t face = p->hit.primID[k];
  float o[3], d[3];
  if (s->plane != NULL) {
    abbe_geometry_place_on_face(s, face, p->hit.u[k], p->hit.v[k], out);
    return;
  }
  abbe_ray_take(p, k, o, d);
  abbe_geometry_place(s, face, p->hit.u[k], p->hit.v[k], o, d, p->ray.tfar[k], out);
}

/* What tracing has written in a packet, as it was before. */
static inline void abbe_ray_reset(struct RTCRayHit16 *p) {
  for (size_t k = 0; k < ABBE_RAY_LANES; k++) {
    p->ray.tfar[k] = INFINITY;
    p->hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    p->hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

/* Packets that were traced, to be traced again for the sake of the time. A zeroed one keeps none.
 */
typedef struct abbe_ray_record {
  struct RTCRayHit16 *packet;
  struct RTCRay16 *shadow; /* those that test whether anything is in their way */
  size_t count, shadows, room;
} abbe_ray_record;

/* Makes capacity for so many packets of each kind; 0: none from now on. */
void abbe_ray_record_make(size_t packets, abbe_ray_record *out);
void abbe_ray_record_free(abbe_ray_record *record);
/* Seconds that Embree alone takes for what was kept, and the number of rays; forgets them. False
 * where there are none. */
bool abbe_ray_record_replay(abbe_ray_record *record, RTCScene scene, double *seconds,
                            uint64_t *rays);

/* Keeps one packet more, of so many rays, while there is capacity. */
void abbe_ray_record_keep(abbe_ray_record *record, const struct RTCRayHit16 *packet, size_t lanes,
                          bool coherent);

/* Whether anything is on the way of the first rays of a packet: their tfar is below 0 then. */
void abbe_ray_batch_occlude(struct RTCRay16 *packet, size_t lanes, RTCScene scene,
                            abbe_ray_record *record);

/* Traces rays [0, count). coherent: rays of a packet go to neighbouring places. */
void abbe_ray_batch_trace(struct RTCRayHit16 *packets, size_t count, bool coherent, RTCScene scene,
                          abbe_ray_record *record);

#endif
