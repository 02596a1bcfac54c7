/* path_light.h: the light between two wavelengths of a photon's path, laid in parts that are
 * collected to splats; and what path_splats.c shares with that. Functions and numbers that are
 * photon_deposit.comp's, or its includes', have their names. Internal to gl/caustics/.
 */
#ifndef ABBE_GL_CAUSTICS_PATH_LIGHT_H
#define ABBE_GL_CAUSTICS_PATH_LIGHT_H

#include "gl/caustics/path_splats.h"
#include "gl/device/shader_maths.h"

#define NO_TILE (-1)

static inline float transmission(bool transmits, float cosine, float index) {
  return transmits ? 1 - fresnel(cosine, 1 / index) : 1;
}

/* outgoing_segment.glsl */
typedef struct light_segment {
  v3 place, interface_at, along, n;
  float passes, arrives;
  bool transmits, far;
} light_segment;

typedef struct light_fan {
  bool bends;
  v3 facing, curve;
} light_fan;

static inline v3 along_between(const light_segment *a, const light_segment *b, const light_fan *f,
                               float s) {
  return plus(mix3(a->along, b->along, s), times(s * (s - 1), f->curve));
}

static inline float cosine_between(const light_segment *a, const light_segment *b,
                                   const light_fan *f, float s) {
  const v3 along = along_between(a, b, f, s);
  return sqrtf(most(1 - dot(along, along), 0));
}

static inline v3 place_between(const light_segment *a, const light_segment *b, const light_fan *f,
                               float s) {
  if (!f->bends) return mix3(a->place, b->place, s);
  const v3 along = along_between(a, b, f, s), mean = mix3(a->n, b->n, s),
           interface_at = mix3(a->interface_at, b->interface_at, s);
  const float cosine = sqrtf(most(1 - dot(along, along), 0)) / length(mean);
  const v3 d = plus(along, times(cosine, mean));
  const float facing = dot(f->facing, d);
  if (!(facing > 0)) return mix3(a->place, b->place, s);
  return plus(interface_at, times(dot(f->facing, off(a->place, interface_at)) / facing, d));
}

/* map_position.glsl */
static inline v2 map_position(const abbe_path_splats *p, v3 at, int tile) {
  if (tile >= 0) {
    const float *to = p->tile[tile];
    return (v2){dot(vector_at(to), at) + to[3], dot(vector_at(to + 4), at) + to[7]};
  }
  const float *v = p->view;
  const v3 d = off(at, vector_at(v));
  float xy[2] = {dot(d, vector_at(v + 4)), dot(d, vector_at(v + 8))};
  const float z = dot(d, vector_at(v + 12));
  for (int i = 0; i < 2; i++) {
    if (v[3] > 0.5f) xy[i] /= z;
    const float uv = (xy[i] - v[16 + 2 * i]) / (v[17 + 2 * i] - v[16 + 2 * i]);
    const float s = clamp(uv, 0, 1) * (float)p->warp_steps; /* what is no number becomes 0 */
    const int k = s < (float)(p->warp_steps - 1) ? (int)s : p->warp_steps - 1;
    xy[i] = mix(p->warp[k][i], p->warp[k][2 + i], s - (float)k) * (float)p->map_size;
  }
  return (v2){xy[0], xy[1]};
}

typedef struct footprint {
  v2 across, skew;
  float narrow, to_next;
  int level;
} footprint;

/* interval_table.glsl */
typedef struct light_sums {
  float xyz[3], moment[3], along, index;
} light_sums;

static inline const float (*texel_at(const abbe_path_splats *p, size_t row, int step))[4] {
  return p->intervals + p->interval_texels * (row * (size_t)(p->steps + 1) + (size_t)step);
}

static inline light_sums sums_at(const abbe_path_splats *p, size_t row, int step) {
  const float(*t)[4] = texel_at(p, row, step);
  return (light_sums){{t[0][0], t[0][1], t[0][2]}, {t[1][0], t[1][1], t[1][2]}, t[0][3], t[1][3]};
}

/* path_node.glsl and tints.glsl */
typedef struct path_node {
  uint32_t path;
  float index, flux;
  v2 at;
  int tile;
  light_segment left;
  uint32_t of[ABBE_PATH_TINTS];
  float amount[ABBE_PATH_TINTS];
} path_node;

typedef struct left_over {
  float a, b;
  int parts;
} left_over;

typedef struct light_span {
  const path_node *z, *a, *b, *from, *to;
  bool bridges, follows;
  float curve[4];
  light_fan fan;
  float per_index, index_b, half_y;
  size_t owed_row, row;
  left_over owed_left, left;
  uint32_t first;
  int owed, parts, steps;
} light_span;

/* splat_collect.glsl */
typedef struct splat {
  float flux[3], x[3], y[3];
  v2 from, shift, middle;
  int tile;
  float weight;
} splat;

typedef struct splat_list {
  uint32_t *word;
  size_t count;
} splat_list;

/* Lays a span's light; entry grows by what of it the ledger is to know, W. */
void abbe_path_light_lay(const abbe_path_splats *p, const light_span *s, const footprint *f,
                         splat *collected, float entry[3], splat_list *to);
/* Lists what is collected. */
void abbe_path_light_list(const abbe_path_splats *p, const splat *s, const footprint *f,
                          splat_list *to);

#endif
