#include "validation/trace/walks/ray_batch.h"

#include "base/clock.h"

#include <stdlib.h>

/* Kept packets say in a lane's flags whether it holds a ray, and how packets were traced. */
enum { LANES = ABBE_RAY_LANES, KEPT = 1, KEPT_COHERENT = 2 };

void abbe_ray_record_keep(abbe_ray_record *r, const struct RTCRayHit16 *packet, size_t lanes,
                          bool coherent) {
  if (r->count == r->room) return;
  struct RTCRayHit16 *to = &r->packet[r->count++];
  *to = *packet;
  for (size_t k = 0; k < LANES; k++)
    to->ray.flags[k] = k < lanes ? KEPT | (coherent ? KEPT_COHERENT : 0) : 0;
}

static void ray_record_keep_shadow(abbe_ray_record *r, const struct RTCRay16 *packet,
                                   size_t lanes) {
  if (r->shadows == r->room) return;
  struct RTCRay16 *to = &r->shadow[r->shadows++];
  *to = *packet;
  for (size_t k = 0; k < LANES; k++) to->flags[k] = k < lanes ? KEPT : 0;
}

void abbe_ray_batch_trace(struct RTCRayHit16 *packets, size_t count, bool coherent, RTCScene scene,
                          abbe_ray_record *record) {
  for (size_t first = 0; first < count; first += LANES) {
    size_t lanes = count - first < LANES ? count - first : LANES;
    abbe_ray_reset(&packets[first / LANES]);
    if (record->packet != NULL)
      abbe_ray_record_keep(record, &packets[first / LANES], lanes, coherent);
    abbe_embree_intersect_16(scene, &packets[first / LANES], lanes, coherent);
  }
}

void abbe_ray_batch_occlude(struct RTCRay16 *packet, size_t lanes, RTCScene scene,
                            abbe_ray_record *record) {
  if (record->packet != NULL) ray_record_keep_shadow(record, packet, lanes);
  abbe_embree_occluded_16(scene, packet, lanes);
}

void abbe_ray_record_make(size_t packets, abbe_ray_record *out) {
  *out = (abbe_ray_record){.room = packets};
  if (packets == 0) return;
  out->packet = aligned_alloc(64, packets * sizeof *out->packet);
  out->shadow = aligned_alloc(64, packets * sizeof *out->shadow);
  if (out->packet == NULL || out->shadow == NULL) abbe_ray_record_free(out);
}

void abbe_ray_record_free(abbe_ray_record *record) {
  free(record->packet);
  free(record->shadow);
  *record = (abbe_ray_record){0};
}

/* How many lanes held a ray, whose flags are taken away. */
static size_t lanes_kept(unsigned *flags) {
  size_t lanes = 0;
  for (size_t k = 0; k < LANES; k++) {
    lanes += flags[k] & KEPT;
    flags[k] = 0;
  }
  return lanes;
}

bool abbe_ray_record_replay(abbe_ray_record *r, RTCScene scene, double *seconds, uint64_t *rays) {
  if (r->count == 0) return false;
  *rays = 0;
  const double start_s = abbe_clock_seconds();
  for (size_t i = 0; i < r->count; i++) {
    struct RTCRayHit16 *packet = &r->packet[i];
    const bool coherent = (packet->ray.flags[0] & KEPT_COHERENT) != 0;
    const size_t lanes = lanes_kept(packet->ray.flags);
    abbe_embree_intersect_16(scene, packet, lanes, coherent);
    *rays += lanes;
  }
  for (size_t i = 0; i < r->shadows; i++) {
    const size_t lanes = lanes_kept(r->shadow[i].flags);
    abbe_embree_occluded_16(scene, &r->shadow[i], lanes);
    *rays += lanes;
  }
  *seconds = abbe_clock_seconds() - start_s;
  r->count = r->shadows = 0;
  return true;
}
