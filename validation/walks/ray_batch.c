#include "validation/walks/ray_batch.h"

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

static void trace_packet(RTCScene scene, struct RTCRayHit16 *packet, size_t lanes, bool coherent) {
  struct RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  _Alignas(64) int valid[LANES];
  for (size_t k = 0; k < LANES; k++) valid[k] = k < lanes ? -1 : 0;
  rtcIntersect16(valid, scene, &context, packet);
}

void abbe_ray_batch_trace(struct RTCRayHit16 *packets, size_t count, bool coherent, RTCScene scene,
                          abbe_ray_record *record) {
  for (size_t first = 0; first < count; first += LANES) {
    size_t lanes = count - first < LANES ? count - first : LANES;
    abbe_ray_reset(&packets[first / LANES]);
    if (record->packet != NULL)
      abbe_ray_record_keep(record, &packets[first / LANES], lanes, coherent);
    trace_packet(scene, &packets[first / LANES], lanes, coherent);
  }
}

void abbe_ray_record_make(size_t packets, abbe_ray_record *out) {
  struct RTCRayHit16 *room = packets > 0 ? aligned_alloc(64, packets * sizeof *room) : NULL;
  *out = (abbe_ray_record){.packet = room, .room = room != NULL ? packets : 0};
}

void abbe_ray_record_free(abbe_ray_record *record) {
  free(record->packet);
  *record = (abbe_ray_record){0};
}

bool abbe_ray_record_replay(abbe_ray_record *r, RTCScene scene, double *seconds, uint64_t *rays) {
  if (r->count == 0) return false;
  *rays = 0;
  const double start_s = abbe_clock_seconds();
  for (size_t i = 0; i < r->count; i++) {
    struct RTCRayHit16 *packet = &r->packet[i];
    bool coherent = (packet->ray.flags[0] & KEPT_COHERENT) != 0;
    size_t lanes = 0;
    for (size_t k = 0; k < LANES; k++) {
      lanes += packet->ray.flags[k] & KEPT;
      packet->ray.flags[k] = 0;
    }
    trace_packet(scene, packet, lanes, coherent);
    *rays += lanes;
  }
  *seconds = abbe_clock_seconds() - start_s;
  r->count = 0;
  return true;
}
