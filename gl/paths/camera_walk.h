/* camera_walk.h: paths of the camera's rays from interface to interface of clear meshes, several
 * side by side: neighbours meet the same boxes and triangles. The functions and numbers that are
 * the shaders' have their names. Internal to gl/paths/.
 */
#ifndef ABBE_GL_PATHS_CAMERA_WALK_H
#define ABBE_GL_PATHS_CAMERA_WALK_H

#include "gl/device/shader_maths.h"
#include "gl/paths/camera_paths.h"
#include "gl/scene/spectra/camera_bands.h"

enum { PENDING = 4, RAYS = ABBE_RAYS };

typedef struct path_state {
  v3 p, d;
  float share;
  uint32_t inside;
  int interfaces;
} path_state;

typedef struct interface {
  v3 p, n, face_n;
  float t;
  int refractor;
} interface;

/* Refractor and Receiver of common.glsl. */
typedef struct path_refractor {
  float sphere[4];
  int model, root, planes, first_same;
} path_refractor;
typedef struct path_receiver {
  float anchor[4], u[4], v[4], normal[4], du[4], dv[4];
} path_receiver;

/* What all pixels share. */
typedef struct tables {
  const abbe_camera_paths *told;
  const float (*triangles)[4], (*corners)[4], (*band_texels)[4];
  const path_refractor *refractors;
  const path_receiver *receivers;
  const abbe_camera_band *bands;
  const uint32_t *pixel;
  uint32_t *sights, *sight_pixels;
  size_t sight_room;
  float refractor_radius;
  int refractor_count, receiver_count, wavelengths, band_count, band_levels;
  uint32_t eye_inside;
} tables;

/* A thread's places of those of all threads, and where its block of them ends. */
typedef struct places {
  uint32_t *found;
  uint32_t next, end;
} places;

/* What is followed for a pixel: one path, whose places are a chain. */
typedef struct walker {
  const tables *c;
  places *to;
  path_state at, pending[PENDING];
  v3 sight;
  interface first;
  int refractor, band_set, band_at, segments;
  uint32_t sight_chain, chain_end;
  float of_background, seen_share, left, mirrored;
} walker;

static inline v3 by_parts(v3 a, v3 b) {
  return (v3){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline int first_band(const walker *w, int r) {
  return (r * ABBE_CAMERA_BAND_SETS + w->band_set) * w->c->band_count;
}

static inline int medium_of(uint32_t inside) {
  return 31 - __builtin_clz(inside);
}

static inline int stuff_of(const walker *w, uint32_t inside) {
  return inside == 0 ? -1 : w->c->refractors[medium_of(inside)].first_same;
}

static inline float medium_n(const walker *w, uint32_t inside) {
  if (inside == 0) return 1;
  return w->c->bands[first_band(w, medium_of(inside)) + w->band_at].weight_n[3];
}

static inline v3 band_weight(const walker *w) {
  return vector_at(w->c->bands[w->band_set * w->c->band_count + w->band_at].weight_n);
}

/* The next interface on the path of each of so many walkers, at most RAYS, that goes on; returns a
 * bit for each that meets one. */
unsigned abbe_camera_next_interfaces(walker *const *w, int count, interface *h);
/* What a band shows through the first interface, or by unit share what it shows mirrored there. */
void abbe_camera_path_begin(walker *w, bool in_mirror, int band_at);
/* Follows so many paths, at most RAYS, to their ends. */
void abbe_camera_walk(walker *const *w, int count);
/* XYZ of what is no receiver; what a path has left shows what the rest of it has shown. */
v3 abbe_camera_path_end(walker *w);

#endif
