/* specular_meet.h: the nearest surface on a ray, or where the ray meets a surface that is known.
 *
 * Internal to validation/measure/derive/.
 */
#ifndef ABBE_VALIDATION_MEASURE_DERIVE_SPECULAR_MEET_H
#define ABBE_VALIDATION_MEASURE_DERIVE_SPECULAR_MEET_H

#include "validation/measure/derive/specular.h"

/* A path begins this share of its surroundings' size off the face that it leaves. */
#define ABBE_SPECULAR_LEAVE 1e-10

typedef struct abbe_meeting {
  double t, n[3];  /* the normal outwards, or the face's */
  double side[2];  /* on a triangle, barycentric */
  uint32_t object; /* ABBE_SPECULAR_NOTHING: none */
  uint32_t face;   /* a plane's number or a triangle */
} abbe_meeting;

/* Objects of all kinds, or receivers but for one; lights that have a size as well where `lamps`. */
void abbe_specular_meet(const abbe_specular *s, const double o[3], const double d[3],
                        uint64_t inside, bool receivers_alone, uint32_t but, bool lamps,
                        abbe_meeting *m);

/* That face of that object, beyond its borders too. False where the ray misses it. */
bool abbe_specular_meet_face(const abbe_specular *s, uint32_t object, uint32_t face,
                             const double o[3], const double d[3], uint64_t inside,
                             abbe_meeting *m);

/* What a signature holds of a face: smooth meshes are one. */
uint32_t abbe_specular_face(const abbe_specular *s, uint32_t object, uint32_t face);

/* The planes through which a ray's line goes into a convex solid and out of it; t[0] > t[1]: past
 * it. False: along a plane, outside of it. */
bool abbe_specular_cross(const abbe_specular_surface *s, const double o[3], const double d[3],
                         double t[2], uint32_t face[2]);

#endif
