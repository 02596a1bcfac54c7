#include "scenes/volume/light_exits.h"

#include "base/maths.h"
#include "colorimetry/weights.h"
#include "scenes/volume/half.h"

#include <stdlib.h>
#include <string.h>

/* Cosine from which on a point faces the light: the same for who writes a table and who reads it.
 */
static const double least_cosine = 1e-3;
static const double least_weight = 1e-9; /* for a node */
static const double least_part = 0.15;   /* the share of wavelengths' probabilities that is even */
static const float most_apart = 0.1f;    /* directions of rays that become one, about rad */
static const float most_turn = 0.5f;     /* that a ray alone is moved by, about rad */
static const double on_surface = 2e-3;   /* in radii */

/* ---- the table ---- */

static void unpack(const uint16_t *half, double scale, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = scale * abbe_half_value(half[k]);
}

/* Indices of exits, in the order of nodes and points; returns their number. */
static size_t number_exits(const abbe_light_nodes *nodes, abbe_light_exits *e) {
  size_t count = 0;
  for (size_t i = 0; i < nodes->count; i++)
    for (size_t k = 0; k < e->points; k++) {
      double n[3];
      unpack(&e->point[k][ABBE_EXIT_NORMAL], 1, n);
      if (abbe_vector_dot(n, nodes->direction[i]) > least_cosine)
        e->at[i * e->points + k] = (uint32_t)++count;
    }
  return count;
}

abbe_result abbe_light_exits_make(const abbe_light_nodes *nodes, size_t points,
                                  const abbe_exit_halves *point, const abbe_body_symmetry *symmetry,
                                  double radius, double area, size_t cells, abbe_light_exits *out,
                                  abbe_error *error) {
  static const double unit_map[1][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  *out = (abbe_light_exits){.points = points, .radius = radius, .area = area, .cells = cells};
  if (points < 1 || points > ABBE_LIGHT_EXITS_MOST || !(radius > 0) || !(area > 0) || cells == 0 ||
      nodes->count < 2)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "exits of %zu points of a surface of %g m2 for %zu nodes; points may be 1 "
        "to %d, and nodes 12 and more",
        points, area, nodes->count, ABBE_LIGHT_EXITS_MOST);
  const bool plain = symmetry == NULL;
  abbe_result result = abbe_body_symmetry_make(plain ? 1 : symmetry->count,
                                               plain ? unit_map : (const double(*)[9])symmetry->map,
                                               &out->symmetry, error);
  if (result != ABBE_OK) return result;
  out->point = malloc(points * sizeof *out->point);
  out->at = calloc(nodes->count * points, sizeof *out->at);
  out->space = calloc(cells, sizeof *out->space);
  if (out->point == NULL || out->at == NULL || out->space == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", points);
  if (result == ABBE_OK) {
    memcpy(out->point, point, points * sizeof *point);
    out->count = number_exits(nodes, out);
    if (out->count > ABBE_LIGHT_EXITS_MOST_EXITS)
      result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%zu exits are more than a table holds, %zu: ask for fewer nodes or "
                              "points",
                              out->count, ABBE_LIGHT_EXITS_MOST_EXITS);
  }
  if (result == ABBE_OK) out->exit = calloc(out->count + 1, sizeof *out->exit);
  if (result == ABBE_OK && out->exit == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu exits", out->count);
  if (result != ABBE_OK) abbe_light_exits_free(out);
  return result;
}

void abbe_light_exits_free(abbe_light_exits *e) {
  if (e == NULL) return;
  abbe_body_symmetry_free(&e->symmetry);
  free(e->space);
  free(e->point);
  free(e->exit);
  free(e->at);
  *e = (abbe_light_exits){0};
}

size_t abbe_light_exits_bytes(const abbe_light_exits *e) {
  return (e->points + e->count) * sizeof *e->exit + e->cells * sizeof *e->space;
}

void abbe_light_exits_chances(double min_nm, double max_nm, double chance[ABBE_LIGHT_EXITS_BINS]) {
  const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E};
  abbe_weights_range range;
  double sum = 0;
  abbe_weights_range_make(&even, min_nm, max_nm, &range);
  for (size_t i = 0; i < ABBE_LIGHT_EXITS_BINS; i++) {
    const double step = (max_nm - min_nm) / ABBE_LIGHT_EXITS_BINS;
    double xyz[3];
    abbe_weights_range_xyz(&range, min_nm + (double)i * step, min_nm + ((double)i + 1) * step, xyz);
    chance[i] = xyz[0] + xyz[1] + xyz[2];
    sum += chance[i];
  }
  for (size_t i = 0; i < ABBE_LIGHT_EXITS_BINS; i++)
    chance[i] = sum > 0 ? least_part / ABBE_LIGHT_EXITS_BINS + (1 - least_part) * chance[i] / sum
                        : 1.0 / ABBE_LIGHT_EXITS_BINS;
}

/* ---- between nodes ---- */

void abbe_light_exits_axes(const double node[3], double x[3], double y[3]) {
  const double other[3] = {fabs(node[0]) < 0.6, fabs(node[0]) >= 0.6, 0};
  abbe_vector_cross(other, node, x);
  abbe_vector_normalise(x);
  abbe_vector_cross(node, x, y);
}

void abbe_light_exits_aim(const abbe_light_nodes *nodes, const double to_light[3],
                          abbe_exit_aim *out) {
  double along[3] = {0}, axis[2][3];
  abbe_light_nodes_blend(nodes, to_light, &out->blend);
  for (int k = 0; k < 3; k++)
    for (size_t i = 0; i < out->blend.count; i++)
      along[k] += out->blend.weight[i] * nodes->direction[out->blend.node[i]][k];
  for (size_t i = 0; i < out->blend.count; i++) {
    abbe_light_exits_axes(nodes->direction[out->blend.node[i]], axis[0], axis[1]);
    for (int a = 0; a < 2; a++) out->far[i][a] = abbe_vector_dot(axis[a], along);
  }
}

bool abbe_light_exits_faces(const abbe_light_exits *e, size_t point, const double to_light[3]) {
  double n[3];
  unpack(&e->point[point][ABBE_EXIT_NORMAL], 1, n);
  return abbe_vector_dot(n, to_light) > 0;
}

void abbe_light_exits_point(const abbe_light_exits *e, size_t point, double place[3],
                            double normal[3], size_t *bin) {
  const uint16_t *p = e->point[point];
  unpack(p + ABBE_EXIT_POINT, e->radius, place);
  unpack(p + ABBE_EXIT_NORMAL, 1, normal);
  abbe_vector_normalise(normal);
  const double at = abbe_half_value(p[ABBE_EXIT_BIN]);
  *bin = at > 0 ? (size_t)fmin(at, ABBE_LIGHT_EXITS_BINS - 1) : 0;
}

/* An exit of a node for light from the aim's direction. */
typedef struct candidate {
  float weight, carried;
  float far[2];                  /* reach of the emission sampling, along the node's axes */
  float value[ABBE_EXIT_HALVES]; /* at the node */
  float step[3], turn[3];        /* to where light from the aim goes, to first order */
  unsigned facets;
} candidate;

/* All at once: a processor has instructions for several numbers. */
static void read_halves(const uint16_t half[ABBE_EXIT_HALVES], float out[ABBE_EXIT_HALVES]) {
  for (size_t k = 0; k < ABBE_EXIT_HALVES; k++) {
    const uint32_t bits = (uint32_t)(half[k] & 0x7fff) << 13 | (uint32_t)(half[k] & 0x8000) << 16;
    memcpy(&out[k], &bits, sizeof bits); /* exponents are 112 too small */
    out[k] *= 0x1p112f;
  }
}

static void read_candidate(const double far[2], const uint16_t *half, candidate *c) {
  float *v = c->value;
  read_halves(half, v);
  c->carried = v[ABBE_EXIT_CARRIED];
  c->facets = v[ABBE_EXIT_FACETS] > 0 ? (unsigned)v[ABBE_EXIT_FACETS] : 0;
  for (int a = 0; a < 2; a++) c->far[a] = (float)far[a];
  for (int k = 0; k < 3; k++) {
    c->step[k] = c->far[0] * v[ABBE_EXIT_PLACE_BY + k] + c->far[1] * v[ABBE_EXIT_PLACE_BY + 3 + k];
    c->turn[k] = c->far[0] * v[ABBE_EXIT_WAY_BY + k] + c->far[1] * v[ABBE_EXIT_WAY_BY + 3 + k];
  }
}

/* Whether all of them met the same facets and, moved to the aim, take much the same path: a smooth
 * surface may be met far apart without another facet. */
static bool is_one(const candidate *c, size_t count) {
  for (size_t i = 0; i < count; i++) {
    if (c[i].facets == 0 || c[i].facets != c[0].facets || !(c[i].carried > 0)) return false;
    float square = 0;
    for (int k = 0; k < 3; k++) {
      const float off = c[i].value[ABBE_EXIT_WAY + k] + c[i].turn[k] -
                        c[0].value[ABBE_EXIT_WAY + k] - c[0].turn[k];
      square += off * off;
    }
    if (!(square < most_apart * most_apart)) return false;
  }
  return count > 0;
}

/* A ray of that place and direction, moved by so much of a step and a turn. */
static void make_ray(const float *value, const float *step, const float *turn, float part,
                     double radius, abbe_exit_ray *ray) {
  for (int k = 0; k < 3; k++) {
    ray->place[k] = radius * (double)(value[ABBE_EXIT_PLACE + k] + part * step[k]);
    ray->way[k] = (double)(value[ABBE_EXIT_WAY + k] + part * turn[k]);
    ray->place_by[k] = radius * (double)value[ABBE_EXIT_PLACE_BY_INDEX + k];
    ray->way_by[k] = (double)value[ABBE_EXIT_WAY_BY_INDEX + k];
  }
  abbe_vector_normalise(ray->way);
}

/* Nodes' values by weight err by half the second derivative to one side, values moved to first
 * order by as much to the other: half of both by the third alone. */
static void join(const candidate *c, size_t count, double radius, abbe_exit_ray *ray) {
  float sum[ABBE_EXIT_HALVES] = {0}, step[3] = {0}, turn[3] = {0};
  for (size_t i = 0; i < count; i++) {
    for (size_t k = 0; k < ABBE_EXIT_HALVES; k++) sum[k] += c[i].weight * c[i].value[k];
    for (int k = 0; k < 3; k++) {
      step[k] += c[i].weight * c[i].step[k];
      turn[k] += c[i].weight * c[i].turn[k];
    }
  }
  make_ray(sum, step, turn, count > 1 ? 0.5f : 1, radius, ray);
  ray->share = (double)sum[ABBE_EXIT_CARRIED];
  ray->weight = 1;
  ray->facets = c[0].facets;
}

static void move(const candidate *c, double radius, abbe_exit_ray *ray) {
  const float square = c->turn[0] * c->turn[0] + c->turn[1] * c->turn[1] + c->turn[2] * c->turn[2];
  const float part = square > most_turn * most_turn ? most_turn / sqrtf(square) : 1;
  make_ray(c->value, c->step, c->turn, part, radius, ray);
  ray->facets = c->facets;
}

static bool is_within(const double p[3], const double (*plane)[4], size_t planes, double within) {
  for (size_t i = 0; i < planes; i++)
    if (abbe_vector_dot(plane[i], p) > plane[i][3] + within) return false;
  return true;
}

/* Each for itself, of those that may be. */
static size_t go_alone(const candidate *c, size_t count, const double (*plane)[4], size_t planes,
                       double radius, abbe_exit_ray ray[3]) {
  abbe_exit_ray all[3];
  bool may[3];
  double sum = 0;
  size_t used = 0;
  for (size_t i = 0; i < count; i++) {
    move(&c[i], radius, &all[i]);
    may[i] = !(c[i].carried > 0) || is_within(all[i].place, plane, planes, on_surface * radius);
    sum += may[i] ? (double)c[i].weight : 0;
  }
  for (size_t i = 0; i < count; i++) {
    if ((!may[i] && sum > 0) || !(c[i].carried > 0)) continue;
    ray[used] = all[i];
    ray[used].weight = (double)c[i].weight / (sum > 0 ? sum : 1);
    ray[used].share = ray[used].weight * (double)c[i].carried;
    used++;
  }
  return used;
}

size_t abbe_light_exits_at(const abbe_light_exits *e, const abbe_exit_aim *aim, size_t point,
                           const double (*plane)[4], size_t planes, abbe_exit_ray ray[3]) {
  candidate c[3];
  size_t count = 0, asked = 0;
  float sum = 0;
  for (size_t i = 0; i < aim->blend.count; i++) {
    const size_t node = aim->blend.node[i];
    if (!(aim->blend.weight[i] > least_weight)) continue;
    asked++;
    const uint32_t at = e->at[node * e->points + point];
    if (at == 0) continue; /* what faces away says nothing about light that comes from the front */
    read_candidate(aim->far[i], e->exit[at - 1], &c[count]);
    c[count].weight = (float)aim->blend.weight[i];
    sum += c[count++].weight;
  }
  for (size_t i = 0; i < count; i++) c[i].weight /= sum;
  if (count < asked || !is_one(c, count)) return go_alone(c, count, plane, planes, e->radius, ray);
  join(c, count, e->radius, ray);
  return 1;
}

static abbe_result make_one(const double axis[3], abbe_light_nodes *out, abbe_error *error) {
  out->direction = malloc(sizeof *out->direction);
  if (out->direction == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a node");
  memcpy(out->direction[0], axis, sizeof out->direction[0]);
  out->count = 1;
  if (abbe_vector_normalise(out->direction[0])) return ABBE_OK;
  abbe_light_nodes_free(out);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a node's direction has no length");
}

abbe_result abbe_light_nodes_make(size_t count, const double axis[3], abbe_light_nodes *out,
                                  abbe_error *error) {
  *out = (abbe_light_nodes){0};
  if (count == 1) return make_one(axis, out, error);
  for (size_t levels = 0; levels <= 4; levels++) {
    if (count != ((size_t)10 << 2 * levels) + 2) continue;
    abbe_result result = abbe_sphere_mesh_geodesic(levels, &out->mesh, error);
    out->count = result == ABBE_OK ? count : 0;
    out->direction = out->mesh.corner;
    return result;
  }
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%zu light nodes; it may be 1, 12, 42, 162, 642 or 2562", count);
}

void abbe_light_nodes_free(abbe_light_nodes *nodes) {
  if (nodes == NULL) return;
  if (nodes->direction != nodes->mesh.corner) free(nodes->direction);
  abbe_sphere_mesh_free(&nodes->mesh);
  *nodes = (abbe_light_nodes){0};
}

void abbe_light_nodes_blend(const abbe_light_nodes *nodes, const double to_light[3],
                            abbe_node_blend *out) {
  *out = (abbe_node_blend){.count = 1, .weight = {1}};
  if (nodes->count < 2) return;
  const size_t face = abbe_sphere_mesh_find(&nodes->mesh, to_light);
  out->count = 3;
  for (int k = 0; k < 3; k++) out->node[k] = nodes->mesh.face[face][k];
  abbe_sphere_mesh_weights(&nodes->mesh, face, to_light, out->weight);
}

void abbe_light_nodes_nearest(const abbe_light_nodes *nodes, const double to_light[3],
                              abbe_node_blend *out) {
  abbe_node_blend three;
  abbe_light_nodes_blend(nodes, to_light, &three);
  /* triangles of the geodesic are acute: the nearest corner of all is one of the triangle's */
  size_t best = three.node[0];
  for (size_t k = 1; k < three.count; k++)
    if (abbe_vector_dot(nodes->direction[three.node[k]], to_light) >
        abbe_vector_dot(nodes->direction[best], to_light))
      best = three.node[k];
  *out = (abbe_node_blend){.count = 1, .node = {best}, .weight = {1}};
}

void abbe_light_nodes_turn(const double from[3], const double to[3], double turn[9]) {
  double axis[3], c = abbe_vector_dot(from, to);
  abbe_vector_cross(from, to, axis);
  double s = abbe_vector_length(axis);
  if (!(s > 1e-12)) {
    const double other[3] = {fabs(from[0]) < 0.6, fabs(from[0]) >= 0.6, 0};
    abbe_vector_cross(from, other, axis);
    c = c < 0 ? -1 : 1;
    s = 0;
  }
  abbe_vector_normalise(axis);
  const double x = axis[0], y = axis[1], z = axis[2], v = 1 - c;
  const double rows[9] = {c + x * x * v,     x * y * v - z * s, x * z * v + y * s,
                          x * y * v + z * s, c + y * y * v,     y * z * v - x * s,
                          x * z * v - y * s, y * z * v + x * s, c + z * z * v};
  memcpy(turn, rows, sizeof rows);
}
