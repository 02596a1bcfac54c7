/* path_light.h: the light between neighbouring wavelengths of a photon's path, laid in parts that
 * are collected to splats; and what path_splats.c shares with that. Functions and numbers that are
 * photon_deposit.comp's, or its includes', have their names. Internal to gl/caustics/.
 */
#ifndef ABBE_GL_CAUSTICS_PATH_LIGHT_H
#define ABBE_GL_CAUSTICS_PATH_LIGHT_H

#include "gl/caustics/path_splats.h"
#include "gl/device/shader_maths.h"

#define NO_TILE (-1)

/* Paths lie side by side, and so do the parts of a span. */
enum { LANES = ABBE_PATHS, PART_LANES = 144, TILE_BITS = 80 };
#define EACH_LANE _Pragma("omp simd") for (int k = 0; k < LANES; k++)

typedef float lanes[LANES];

static inline v3 vector_of(const float (*of)[LANES], int k) {
  return (v3){of[0][k], of[1][k], of[2][k]};
}

static inline float transmission(bool transmits, float cosine, float index) {
  return transmits ? 1 - fresnel(cosine, 1 / index) : 1;
}

/* interval_table.glsl: X, Y, Z and the moment of each, along, index, and what each tint takes. */
enum { SUM_ALONG = 6, SUM_INDEX, SUM_TAKEN, SUM_ROWS = SUM_TAKEN + 3 * ABBE_PATH_TINTS };

static inline const float (*texel_at(const abbe_path_splats *p, size_t row, int step))[4] {
  return p->intervals + p->interval_texels * (row * (size_t)(p->steps + 1) + (size_t)step);
}

/* map_position.glsl: of the light's own map, and of a tile. */
static inline v2 place_on_map(const abbe_path_splats *p, v3 at) {
  const float *v = p->view;
  const v3 d = off(at, vector_at(v));
  const float z = dot(d, vector_at(p->depth)) + p->depth[3], last = (float)(p->warp_steps - 1);
  const float u = (dot(d, vector_at(v + 4)) / z - v[16]) / (v[17] - v[16]);
  const float w = (dot(d, vector_at(v + 8)) / z - v[18]) / (v[19] - v[18]);
  const float s = clamp(u, 0, 1) * (float)p->warp_steps; /* what is no number becomes 0 */
  const float t = clamp(w, 0, 1) * (float)p->warp_steps;
  const int i = (int)least(s, last), j = (int)least(t, last);
  return (v2){mix(p->warp[i][0], p->warp[i][2], s - (float)i) * (float)p->map_size,
              mix(p->warp[j][1], p->warp[j][3], t - (float)j) * (float)p->map_size};
}

static inline v2 place_on_tile(const float *to, v3 at) {
  return (v2){dot(vector_at(to), at) + to[3], dot(vector_at(to + 4), at) + to[7]};
}

typedef struct footprint {
  v2 across, skew;
  float narrow, to_next;
  int level;
} footprint;

/* outgoing_segment.glsl, of many at once */
enum { SEGMENT_PLACE = 0, SEGMENT_FROM = 3, SEGMENT_ALONG = 6, SEGMENT_N = 9, SEGMENT_ROWS = 12 };

/* splat_collect.glsl */
typedef struct splat_collect {
  float flux[3], x[3], y[3];
  v2 from, shift, middle;
  int tile;
  float weight;
} splat_collect;

static inline int interface_tile(float word) {
  return (int)(((bits_of(word) >> 23 & 255u) - 1u) % TILE_BITS) - 1;
}

/* path_node.glsl and tints.glsl: a node of each path; what is not there has no light. */
typedef struct path_nodes {
  lanes segment[SEGMENT_ROWS], passes, arrives, transmits, index, flux, x,
      y; /* transmits: 0 or 1 */
  lanes amount[ABBE_PATH_TINTS];
  lanes left_below, left_above, range_below, range_above; /* of the halves of its band */
  uint32_t path[LANES], of[ABBE_PATH_TINTS][LANES];
  int32_t tile[LANES], far[LANES];
} path_nodes;

/* A path whose light is laid; node 0 is `node_first`. signature: 0: none. */
typedef struct photon_path {
  const abbe_photon *photon;
  size_t order, hit_first, coarse_first, rows;
  int node_first, node_last, middle_twice, interval_last, intervals;
  uint32_t refined, signature;
  footprint footprint;
  splat_collect collected;
} photon_path;

/* What spans leave to those behind them. */
typedef struct path_trails {
  lanes step[2], moved, curve[4];
  int32_t followed[LANES], owes[LANES], left_parts[LANES];
} path_trails;

/* What arrives along a span and the share that passes, at its begin and what comes to it up to its
 * end; `through`: 1 where the share follows from the direction, 0 where it is `passes`. */
typedef struct span_lights {
  lanes arrives, arrives_more, curve, through, passes, passes_more, flux_b, left_a;
} span_lights;

/* interval_span.glsl: a span of each path, from a to b; z is before a, and c behind b. */
typedef struct path_spans {
  const path_nodes *z, *a, *b, *c;
  lanes from[SEGMENT_ROWS], to[SEGMENT_ROWS], facing[3], curve[4];
  lanes from_index, per_index, half_y, transmits, moved;
  int32_t taken[LANES], bridges[LANES], follows[LANES], followed[LANES], bends[LANES];
  int32_t owes[LANES], parts[LANES], owed[LANES], steps[LANES];
  size_t row[LANES], owed_row[LANES];
  uint32_t first[LANES];
  span_lights own, owing;
} path_spans;

static inline v3 along_between(const path_spans *s, int k, float t) {
  const v3 a = vector_of(s->from + SEGMENT_ALONG, k), b = vector_of(s->to + SEGMENT_ALONG, k);
  return plus(mix3(a, b, t), times(t * (t - 1), vector_of(s->curve, k)));
}

typedef struct splat_list {
  abbe_splat *splat;
  size_t count;
} splat_list;

/* The nodes behind `turn` spans, and the spans from there, whose nodes are set. */
void abbe_path_nodes_read(const abbe_path_splats *p, const photon_path *paths, int turn,
                          path_nodes *to);
void abbe_path_spans_make(const abbe_path_splats *p, const photon_path *paths, int turn,
                          path_trails *t, path_spans *s);
/* Lays the light of spans; entry grows by what of it the ledger is to know, W. */
void abbe_path_light_lay(const abbe_path_splats *p, const path_spans *s, photon_path *paths,
                         float entry[3][LANES], splat_list *to);
/* Lists what is collected of a path. */
void abbe_path_light_list(const abbe_path_splats *p, const photon_path *path, splat_list *to);

#endif
