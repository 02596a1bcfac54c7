/* geometry.h: a scene's surfaces in Embree, for the reference tracer.
 *
 * Triangles, spheres as spheres and disk lights as disks, in a frame of their own: the origin lies
 * in the middle of the refractors and they are about one unit in size, so that single precision
 * serves a scene of any size and place. Faces and interpolated normals point outwards. It finds
 * hits; what light does there is the walks' business. A geometry is read-only once made, by any
 * number of threads; the scene must outlive it. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_GEOMETRY_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_GEOMETRY_H

#include "base/error.h"
#include "scenes/scene.h"
#include "validation/trace/transport/embree.h"
#include "validation/trace/transport/solid.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#define ABBE_GEOMETRY_MAX_REFRACTORS 64 /* a bit each in the set of those around a path */

/* Kinds of surfaces, as bits of ray masks. */
enum {
  ABBE_GEOMETRY_REFRACTORS = 1,
  ABBE_GEOMETRY_RECEIVERS = 2,
  ABBE_GEOMETRY_LAMPS = 4,
  ABBE_GEOMETRY_MIRRORS = 8,
  ABBE_GEOMETRY_SPECULAR = ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_MIRRORS,
  ABBE_GEOMETRY_OBJECTS = ABBE_GEOMETRY_SPECULAR | ABBE_GEOMETRY_RECEIVERS,
  ABBE_GEOMETRY_ALL = ABBE_GEOMETRY_OBJECTS | ABBE_GEOMETRY_LAMPS /* all that stops light */
};

/* A face in one line of the cache, padded for the compiler: its first corner, the ways to the
 * others, and its normal. */
typedef struct abbe_plane_face {
  __attribute__((aligned(64))) float corner[4], second[4], third[4], normal[4];
} abbe_plane_face;

/* The same of normals that are interpolated: the first corner's, and what the others' are more. */
typedef struct abbe_bent_face {
  __attribute__((aligned(64))) float corner[4], second[4], third[4];
} abbe_bent_face;

/* The surface behind one of Embree's geometry identifiers; frame units. */
typedef struct abbe_surface {
  unsigned kind;   /* one of the bits above */
  uint32_t index;  /* among its kind: refractor, receiver, mirror; of the light for lights */
  uint32_t object; /* in the scene; of the light for lights */
  bool sphere;     /* centre and radius hold; else triangles */
  bool flat;       /* every face has one normal: its own */
  float centre[3], radius;
  float (*position)[3];   /* [vertices + 1] */
  float (*normal)[3];     /* flat: [faces]; else [vertices] */
  const double (*uv)[2];  /* [vertices] of the mesh, or NULL */
  uint32_t (*face)[3];    /* [faces] */
  abbe_plane_face *plane; /* [faces], or NULL: no triangles */
  abbe_bent_face *bent;   /* [faces] of triangles that are not flat, or NULL */
} abbe_surface;

typedef struct abbe_geometry {
  const abbe_scene *scene;
  double origin[3], unit; /* world = origin + unit * frame, metres */
  size_t surface_count;
  abbe_surface *surface; /* [surface_count], by geometry identifier */
  size_t refractor_count, receiver_count, mirror_count;
  uint32_t *refractor_object; /* [refractor_count] */
  uint32_t *mirror_object;    /* [mirror_count] */
  abbe_solid *solid;          /* [refractor_count] */
  RTCDevice device;
  RTCScene embree;
  /* On what the last bits of a trace depend: the instructions that Embree takes of this processor
   * ("avx512", "avx2", "sse", "other"), and Embree's version: "avx2, Embree 3.13.5". */
  char instructions[48];
} abbe_geometry;

/* ABBE_UNSUPPORTED for more than 64 refractors, or for one thinner than eight times what a ray
 * starts off the face that it leaves (2^-15 of its largest coordinate); ABBE_NO_MEMORY where Embree
 * has none. */
abbe_result abbe_geometry_make(const abbe_scene *scene, abbe_geometry *out, abbe_error *error);
void abbe_geometry_free(abbe_geometry *geometry);
void abbe_geometry_to_frame(const abbe_geometry *g, const double world[3], float frame[3]);
void abbe_geometry_to_world(const abbe_geometry *g, const float frame[3], double world[3]);

/* Two unit vectors x and y across the unit vector z; x, y, z right-handed. */
static inline void abbe_geometry_across(const float z[3], float x[3], float y[3]) {
  const float e[2] = {fabsf(z[0]) < 0.6f ? 1.0f : 0.0f, fabsf(z[0]) < 0.6f ? 0.0f : 1.0f},
              along = e[0] * z[0] + e[1] * z[1];
  float length = 0;
  for (int k = 0; k < 3; k++) {
    x[k] = (k < 2 ? e[k] : 0) - along * z[k];
    length += x[k] * x[k];
  }
  length = 1 / sqrtf(length);
  for (int k = 0; k < 3; k++) x[k] *= length;
  y[0] = z[1] * x[2] - z[2] * x[1];
  y[1] = z[2] * x[0] - z[0] * x[2];
  y[2] = z[0] * x[1] - z[1] * x[0];
}

/* A place on a surface, frame units. */
typedef struct abbe_hit {
  const abbe_surface *surface;
  uint32_t face;
  float u, v; /* barycentric, of the second and third corner */
  float p[3];
  float n[3];  /* unit, outwards, interpolated */
  float ng[3]; /* unit, outwards, of the face */
} abbe_hit;

/* The place (u, v) on a face of triangles. */
static inline void abbe_geometry_place_on_face(const abbe_surface *s, uint32_t face, float u,
                                               float v, abbe_hit *hit) {
  const abbe_plane_face *f = &s->plane[face];
  float p[4], n[4];
  hit->surface = s;
  hit->face = face;
  hit->u = u;
  hit->v = v;
  for (int k = 0; k < 4; k++) p[k] = f->corner[k] + u * f->second[k] + v * f->third[k];
  for (int k = 0; k < 3; k++) {
    hit->p[k] = p[k];
    hit->ng[k] = hit->n[k] = f->normal[k];
  }
  if (s->bent == NULL) return;
  const abbe_bent_face *b = &s->bent[face];
  for (int k = 0; k < 4; k++) n[k] = b->corner[k] + u * b->second[k] + v * b->third[k];
  const float square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  if (!(square > 0)) return;
  const float scale = 1 / sqrtf(square);
  for (int k = 0; k < 3; k++) hit->n[k] = n[k] * scale;
}

/* Where a ray that Embree found to hit (geometry, face, u, v) meets the surface. Spheres: the
 * point nearest to o + t d on the sphere. */
static inline void abbe_geometry_place(const abbe_surface *s, uint32_t face, float u, float v,
                                       const float o[3], const float d[3], float t, abbe_hit *hit) {
  if (s->plane != NULL) {
    abbe_geometry_place_on_face(s, face, u, v, hit);
    return;
  }
  hit->surface = s;
  hit->face = face;
  hit->u = u;
  hit->v = v;
  if (!s->sphere) {
    for (int k = 0; k < 3; k++) {
      hit->p[k] = o[k] + t * d[k];
      hit->ng[k] = hit->n[k] = s->normal[0][k];
    }
    return;
  }
  float r[3], length = 0;
  for (int k = 0; k < 3; k++) r[k] = (o[k] - s->centre[k]) + t * d[k];
  length = sqrtf(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  for (int k = 0; k < 3; k++) {
    hit->ng[k] = hit->n[k] = r[k] / length;
    hit->p[k] = s->centre[k] + s->radius * hit->n[k];
  }
}

/* How far a ray starts off the face that it leaves, as a share of its coordinates. */
#define ABBE_GEOMETRY_OFFSET 0x1p-18f

/* p moved off the face to the side that d points to, by more than the rounding of p, so that a ray
 * from there does not meet the face that it leaves. */
static inline void abbe_geometry_leave(const abbe_hit *hit, const float d[3], float out[3]) {
  const float share = ABBE_GEOMETRY_OFFSET;
  float side = d[0] * hit->ng[0] + d[1] * hit->ng[1] + d[2] * hit->ng[2];
  float size = hit->surface->sphere ? hit->surface->radius : 0;
  for (int k = 0; k < 3; k++) size = fabsf(hit->p[k]) > size ? fabsf(hit->p[k]) : size;
  float offset = side < 0 ? -share * size : share * size;
  for (int k = 0; k < 3; k++) out[k] = hit->p[k] + offset * hit->ng[k];
}

/* First hit of the ray from o along unit d among the kinds of the mask; false where there is none.
 * o and d in the frame, limit its length there. */
bool abbe_geometry_hit(const abbe_geometry *g, unsigned mask, const float o[3], const float d[3],
                       float limit, abbe_hit *hit);

/* Whether anything of the mask's kinds stands on the ray within its length limit. */
bool abbe_geometry_occluded(const abbe_geometry *g, unsigned mask, const float o[3],
                            const float d[3], float limit);

#endif
