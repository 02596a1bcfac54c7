/* embree.h: Embree's header, and its queries of a scene in the form that versions 3.13 and 4 share.
 * Packets have ABBE_EMBREE_LANES rays, of which the first `lanes` are followed. Internal to
 * validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_EMBREE_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_EMBREE_H

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_EMBREE_LANES = 16 };

/* Makes `query`, what a query of that name takes besides the scene and its rays. */
#if RTC_VERSION_MAJOR >= 4
#define ABBE_EMBREE_QUERY(name, coherent)                                                          \
  struct RTC##name##Arguments query;                                                               \
  rtcInit##name##Arguments(&query);                                                                \
  if (coherent) query.flags = RTC_RAY_QUERY_FLAG_COHERENT
#define ABBE_EMBREE_CALL(function, scene, rays) function(scene, rays, &query)
#define ABBE_EMBREE_CALL_16(function, valid, scene, rays) function(valid, scene, rays, &query)
#else
#define ABBE_EMBREE_QUERY(name, coherent)                                                          \
  struct RTCIntersectContext query;                                                                \
  rtcInitIntersectContext(&query);                                                                 \
  if (coherent) query.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT
#define ABBE_EMBREE_CALL(function, scene, rays) function(scene, &query, rays)
#define ABBE_EMBREE_CALL_16(function, valid, scene, rays) function(valid, scene, &query, rays)
#endif

static inline void abbe_embree_valid(int valid[ABBE_EMBREE_LANES], size_t lanes) {
  for (size_t k = 0; k < ABBE_EMBREE_LANES; k++) valid[k] = k < lanes ? -1 : 0;
}

static inline void abbe_embree_intersect(RTCScene scene, struct RTCRayHit *ray) {
  ABBE_EMBREE_QUERY(Intersect, false);
  ABBE_EMBREE_CALL(rtcIntersect1, scene, ray);
}

static inline void abbe_embree_occluded(RTCScene scene, struct RTCRay *ray) {
  ABBE_EMBREE_QUERY(Occluded, false);
  ABBE_EMBREE_CALL(rtcOccluded1, scene, ray);
}

static inline void abbe_embree_intersect_16(RTCScene scene, struct RTCRayHit16 *rays, size_t lanes,
                                            bool coherent) {
  RTC_ALIGN(64) int valid[ABBE_EMBREE_LANES];
  abbe_embree_valid(valid, lanes);
  ABBE_EMBREE_QUERY(Intersect, coherent);
  ABBE_EMBREE_CALL_16(rtcIntersect16, valid, scene, rays);
}

/* Rays that are near each other: those of one packet all are. */
static inline void abbe_embree_occluded_16(RTCScene scene, struct RTCRay16 *rays, size_t lanes) {
  RTC_ALIGN(64) int valid[ABBE_EMBREE_LANES];
  abbe_embree_valid(valid, lanes);
  ABBE_EMBREE_QUERY(Occluded, true);
  ABBE_EMBREE_CALL_16(rtcOccluded16, valid, scene, rays);
}

#endif
