#include "validation/lab/exit_fill.h"

#include "base/maths.h"
#include "scenes/volume/half.h"
#include "validation/lab/volume_sums.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { LINES = 1 << 18, TABLE = 4 * (ABBE_EXIT_MOST_FACETS + 1) };

/* What the light turns by to find a ray's change; rad. */
static const double turned = 2e-3;
/* More change than that is not stored, a radian or radius for a radian of the light. */
static const double most_change = 30;

/* Sequences of facets by the order in which they came first. */
typedef struct sequences {
  uint32_t key[TABLE];
  uint16_t number[TABLE]; /* 0: free */
  size_t count;
} sequences;

typedef struct fill {
  const abbe_lone_object *lone;
  const abbe_exit_fill_desc *desc;
  abbe_caustic_volume *volume;
  abbe_exit_fill_statistics *statistics;
  abbe_body_symmetry symmetry;
  abbe_exit_points points;
  abbe_exit_space space;
  abbe_media media;
  abbe_mirrors mirrors;
  uint32_t *facet; /* NULL: its faces are not separated */
  uint32_t *found; /* [points] of a node: facets' key, 0 for none */
  sequences *sequences;
} fill;

/* ---- what it takes ---- */

static abbe_result make_materials(fill *f, abbe_error *error) {
  double lambda_nm[ABBE_LIGHT_EXITS_BINS + 1];
  const double step = (f->desc->max_nm - f->desc->min_nm) / ABBE_LIGHT_EXITS_BINS;
  for (size_t i = 0; i <= ABBE_LIGHT_EXITS_BINS; i++)
    lambda_nm[i] = i < ABBE_LIGHT_EXITS_BINS ? f->desc->min_nm + (double)i * step : f->desc->max_nm;
  const abbe_geometry *g = &f->lone->geometry;
  ABBE_TRY(abbe_media_make(g, lambda_nm, ABBE_LIGHT_EXITS_BINS, &f->media, error));
  ABBE_TRY(abbe_mirrors_make(g, lambda_nm, ABBE_LIGHT_EXITS_BINS, &f->mirrors, error));
  if (g->refractor_count > 0 && abbe_media_is_crystal(&f->media, 0))
    ABBE_TRY(
        abbe_error_set(error, ABBE_UNSUPPORTED,
                       "the object '%s' is a crystal, which a ray leaves as two: take a volume "
                       "without exits",
                       f->lone->body.name));
  if (f->lone->object.medium != NULL)
    ABBE_TRY(abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the object '%s' scatters light, so that no ray leaves it as it came: "
                            "take a volume without rays",
                            f->lone->body.name));
  if (f->media.films.count > 0)
    ABBE_TRY(abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the object '%s' has a coating, which stored rays do not see: take a "
                            "volume without rays",
                            f->lone->body.name));
  return ABBE_OK;
}

/* Which plane each face lies in, of a convex solid of planes. */
static abbe_result find_facets(fill *f, abbe_error *error) {
  const abbe_mesh *mesh = &f->lone->object.mesh;
  abbe_convex convex;
  double(*plane)[4] = malloc(ABBE_SCENE_MAX_PLANES * sizeof *plane);
  f->facet = calloc(mesh->face_count + 1, sizeof *f->facet);
  abbe_result result = ABBE_OK;
  if (plane == NULL || f->facet == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for facets");
  if (result == ABBE_OK && !f->lone->body.ball)
    result = abbe_convex_find(mesh, ABBE_SCENE_MAX_PLANES, plane, f->facet, &convex, error);
  free(plane);
  if (result == ABBE_OK && (f->lone->body.ball || convex.verdict != ABBE_CONVEX_SOLID)) {
    free(f->facet);
    f->facet = NULL;
  }
  return result;
}

static abbe_result find_symmetry(fill *f, abbe_error *error) {
  static const double unit_map[1][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  if (f->desc->asymmetric) return abbe_body_symmetry_make(1, unit_map, &f->symmetry, error);
  return abbe_body_symmetry_find(&f->lone->object, f->lone->place.centre, f->lone->body.radius,
                                 &f->symmetry, error);
}

static void pack(const double *v, uint16_t *half) {
  for (int k = 0; k < 3; k++) half[k] = abbe_half_of(v[k]);
}

/* From the object's centre, in its radii. */
static void to_body(const fill *f, const float frame[3], double out[3]) {
  abbe_geometry_to_world(&f->lone->geometry, frame, out);
  for (int k = 0; k < 3; k++) out[k] = (out[k] - f->lone->place.centre[k]) / f->lone->body.radius;
}

static abbe_result make_table(fill *f, abbe_error *error) {
  const abbe_volume_region *region = &f->volume->region;
  const size_t count = f->points.count;
  ABBE_FREED abbe_exit_halves *half = calloc(count + 1, sizeof *half);
  ABBE_FREED float *share = malloc((region->cells + 1) * sizeof *share);
  if (half == NULL || share == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu points", count);
  for (size_t i = 0; i < count; i++) {
    const abbe_exit_point *p = &f->points.point[i];
    double place[3];
    to_body(f, p->place, place);
    pack(place, &half[i][ABBE_EXIT_POINT]);
    for (int k = 0; k < 3; k++) half[i][ABBE_EXIT_NORMAL + k] = abbe_half_of((double)p->normal[k]);
    half[i][ABBE_EXIT_BIN] = abbe_half_of(p->bin);
  }
  ABBE_TRY(abbe_light_exits_make(&f->volume->nodes, count, (const abbe_exit_halves *)half,
                                 &f->symmetry, f->lone->body.radius, f->points.area, region->cells,
                                 &f->volume->exits, error));
  ABBE_TRY(abbe_volume_space_measure(&f->lone->geometry, region, f->lone->place.centre,
                                     f->lone->body.radius, LINES, share, error));
  for (size_t i = 0; i < region->cells; i++)
    f->volume->exits.space[i] = abbe_half_of((double)share[i]);
  return ABBE_OK;
}

/* ---- the rays of a node ---- */

static void follow(const fill *f, const abbe_exit_point *p, const double to_light[3],
                   abbe_exit_end *end) {
  abbe_exit_start start = {.step = p->bin, .chance = p->chance};
  for (int k = 0; k < 3; k++) {
    start.place[k] = p->place[k];
    start.way[k] = (float)-to_light[k];
  }
  abbe_exit_walk(&f->space, &start, end);
}

/* The change along one axis, from a ray beside it on either side that met the same facets; false
 * where there is none, or too much of it. */
static bool find_change(const fill *f, const abbe_exit_point *p, const double node[3],
                        const double axis[3], const abbe_exit_end *end, double place_by[3],
                        double way_by[3]) {
  for (int side = 1; side >= -1; side -= 2) {
    double to_light[3], a[3], b[3];
    abbe_exit_end beside;
    for (int k = 0; k < 3; k++) to_light[k] = node[k] + side * turned * axis[k];
    abbe_vector_normalise(to_light);
    follow(f, p, to_light, &beside);
    if (!(beside.carried > 0) || beside.facets != end->facets) continue;
    to_body(f, end->place, a);
    to_body(f, beside.place, b);
    for (int k = 0; k < 3; k++) {
      place_by[k] = (b[k] - a[k]) / (side * turned);
      way_by[k] = ((double)beside.way[k] - (double)end->way[k]) / (side * turned);
    }
    return abbe_vector_length(place_by) < most_change && abbe_vector_length(way_by) < most_change;
  }
  return false;
}

/* Bins of wavelengths between two whose indices give a ray's change. */
enum { APART = 24 };

/* The change with the index; none where that does not vary, or facets do. */
static void find_dispersion(const fill *f, const abbe_exit_point *p, const double to_light[3],
                            const abbe_exit_end *end, uint16_t *half) {
  if (f->media.refractors == 0) return;
  abbe_exit_point other = *p;
  abbe_exit_end beside;
  double a[3], b[3], place_by[3], way_by[3];
  other.bin = p->bin < ABBE_LIGHT_EXITS_BINS / 2 ? p->bin + APART : p->bin - APART;
  const double step = (double)abbe_media_n(&f->media, 0, other.bin, 0.5f) -
                      (double)abbe_media_n(&f->media, 0, p->bin, 0.5f);
  if (!(fabs(step) > 1e-5)) return;
  follow(f, &other, to_light, &beside);
  if (!(beside.carried > 0) || beside.facets != end->facets) return;
  to_body(f, end->place, a);
  to_body(f, beside.place, b);
  for (int k = 0; k < 3; k++) {
    place_by[k] = (b[k] - a[k]) / step;
    way_by[k] = ((double)beside.way[k] - (double)end->way[k]) / step;
  }
  if (!(abbe_vector_length(place_by) < most_change && abbe_vector_length(way_by) < most_change))
    return;
  pack(place_by, half + ABBE_EXIT_PLACE_BY_INDEX);
  pack(way_by, half + ABBE_EXIT_WAY_BY_INDEX);
}

static void fill_exit(const fill *f, size_t node, size_t point, uint16_t *half, uint32_t *found) {
  const abbe_exit_point *p = &f->points.point[point];
  const double *to_light = f->volume->nodes.direction[node];
  double axis[2][3], place[3], place_by[3], way_by[3];
  abbe_exit_end end;
  *found = 0;
  memset(half, 0, sizeof(abbe_exit_halves));
  follow(f, p, to_light, &end);
  if (!(end.carried > 0)) return;
  to_body(f, end.place, place);
  pack(place, half + ABBE_EXIT_PLACE);
  for (int k = 0; k < 3; k++) half[ABBE_EXIT_WAY + k] = abbe_half_of((double)end.way[k]);
  half[ABBE_EXIT_CARRIED] = abbe_half_of((double)end.carried);
  find_dispersion(f, p, to_light, &end, half);
  abbe_light_exits_axes(to_light, axis[0], axis[1]);
  for (int a = 0; a < 2; a++) {
    if (!find_change(f, p, to_light, axis[a], &end, place_by, way_by)) {
      memset(half + ABBE_EXIT_PLACE_BY, 0, 12 * sizeof *half);
      return;
    }
    pack(place_by, half + ABBE_EXIT_PLACE_BY + 3 * a);
    pack(way_by, half + ABBE_EXIT_WAY_BY + 3 * a);
  }
  *found = end.facets != 0 ? end.facets : 1;
}

/* Where the key is, or belongs. A place is free, for there are more than sequences may be. */
static size_t place_of(const sequences *s, uint32_t key) {
  size_t at = key % TABLE;
  while (s->number[at] != 0 && s->key[at] != key) at = (at + 1) % TABLE;
  return at;
}

/* The key's number, given to it where it is new; 0 where there are too many. */
static unsigned number_of(sequences *s, uint32_t key) {
  const size_t at = place_of(s, key);
  if (s->number[at] != 0) return s->number[at];
  if (s->count >= ABBE_EXIT_MOST_FACETS) return 0;
  s->key[at] = key;
  s->number[at] = (uint16_t)++s->count;
  return s->number[at];
}

static bool is_stopped(const fill *f) {
  return f->desc->stop != NULL && *f->desc->stop;
}

static abbe_result fill_node(fill *f, size_t node, abbe_error *error) {
  abbe_light_exits *e = &f->volume->exits;
  const uint32_t *at = e->at + node * e->points;
#pragma omp parallel for schedule(dynamic, 256) num_threads((int)f->desc->threads)
  for (size_t i = 0; i < e->points; i++)
    if (at[i] != 0 && !is_stopped(f)) fill_exit(f, node, i, e->exit[at[i] - 1], &f->found[i]);
  if (is_stopped(f)) return abbe_error_set(error, ABBE_CANCELLED, "stopped");
  for (size_t i = 0; i < e->points; i++) {
    if (at[i] == 0) continue;
    uint16_t *half = e->exit[at[i] - 1];
    const double carried = abbe_half_value(half[ABBE_EXIT_CARRIED]);
    f->statistics->rays += carried > 0 ? 4 : 1;
    f->statistics->alone += carried > 0 && f->found[i] == 0;
    f->statistics->carried += carried;
    if (f->found[i] != 0)
      half[ABBE_EXIT_FACETS] = abbe_half_of(number_of(f->sequences, f->found[i]));
  }
  const double done = ((double)node + 1) / (double)f->volume->nodes.count;
  if (f->desc->progress != NULL && !f->desc->progress(f->desc->user, done))
    return abbe_error_set(error, ABBE_CANCELLED, "stopped");
  return ABBE_OK;
}

/* A key of all that decides what the table is; media's and mirrors' numbers are of their
 * wavelengths. */
static uint64_t key_of(const fill *f) {
  const abbe_caustic_volume *v = f->volume;
  uint64_t h = abbe_lone_object_key(f->lone, &f->media, &f->mirrors, ABBE_VOLUME_KEY);
  h = abbe_volume_key(h, v->exits.point, v->exits.points * sizeof *v->exits.point);
  return abbe_volume_key(h, &v->nodes.count, sizeof v->nodes.count);
}

/* Whether each number up to the count stands once, where its key leads. */
static bool sequences_hold(const sequences *s) {
  bool seen[ABBE_EXIT_MOST_FACETS + 1] = {false};
  size_t used = 0;
  if (s->count > ABBE_EXIT_MOST_FACETS) return false;
  for (size_t at = 0; at < TABLE; at++) {
    const unsigned number = s->number[at];
    if (number == 0) continue;
    if (number > s->count || seen[number]) return false;
    seen[number] = true;
    used++;
  }
  if (used != s->count) return false;
  for (size_t at = 0; at < TABLE; at++)
    if (s->number[at] != 0 && place_of(s, s->key[at]) != at) return false;
  return true;
}

static bool exit_holds(const fill *f, const uint16_t *half) {
  for (int k = 0; k < ABBE_EXIT_HALVES; k++)
    if (!abbe_half_is_finite(half[k])) return false;
  const double facets = abbe_half_value(half[ABBE_EXIT_FACETS]);
  return abbe_half_value(half[ABBE_EXIT_CARRIED]) >= 0 && facets >= 0 &&
         facets <= (double)f->sequences->count && !(facets < floor(facets)) &&
         !(facets > floor(facets));
}

/* Whether so many nodes can have left that. What others left is made anew. */
static bool holds(const void *user, size_t nodes) {
  const fill *f = user;
  const abbe_light_exits *e = &f->volume->exits;
  const abbe_exit_fill_statistics *s = f->statistics;
  uint64_t rays = 0;
  double carried = 0;
  size_t done = 0;
  for (size_t i = 0; i < nodes * e->points; i++) done = e->at[i] > done ? e->at[i] : done;
  if (!sequences_hold(f->sequences) || !(s->alone >= 0 && s->alone <= (double)done)) return false;
  for (size_t i = 0; i < done; i++) {
    if (!exit_holds(f, e->exit[i])) return false;
    const double share = abbe_half_value(e->exit[i][ABBE_EXIT_CARRIED]);
    rays += share > 0 ? 4 : 1;
    carried += share;
  }
  return s->rays == rays && memcmp(&s->carried, &carried, sizeof carried) == 0;
}

static abbe_result fill_nodes(fill *f, abbe_error *error) {
  const abbe_exit_fill_desc *d = f->desc;
  abbe_light_exits *e = &f->volume->exits;
  size_t node = 0;
  abbe_volume_keeping keeping = {.path = d->checkpoint,
                                 .every_s = d->checkpoint_s,
                                 .resume = d->resume,
                                 .key = key_of(f),
                                 .part = {{e->exit, e->count * sizeof *e->exit},
                                          {f->sequences, sizeof *f->sequences},
                                          {f->statistics, sizeof *f->statistics}},
                                 .parts = 3,
                                 .nodes = f->volume->nodes.count,
                                 .holds = holds,
                                 .user = f,
                                 .stop = d->stop};
  abbe_result result = abbe_volume_keeping_begin(&keeping, &node, error);
  for (; result == ABBE_OK && node < f->volume->nodes.count; node++) {
    const abbe_exit_fill_statistics before = *f->statistics;
    result = fill_node(f, node, error);
    if (result == ABBE_OK) result = abbe_volume_keeping_end_node(&keeping, node + 1, false, error);
    if (result != ABBE_CANCELLED) continue;
    *f->statistics = before; /* the node that was stopped is begun anew */
    abbe_volume_keeping_end_node(&keeping, node, true, NULL);
  }
  return result;
}

static void free_tables(fill *f) {
  abbe_body_symmetry_free(&f->symmetry);
  abbe_exit_points_free(&f->points);
  abbe_media_free(&f->media);
  abbe_mirrors_free(&f->mirrors);
  free(f->facet);
  free(f->found);
  free(f->sequences);
}

abbe_result abbe_exit_fill(const abbe_lone_object *lone, const abbe_exit_fill_desc *desc,
                           abbe_caustic_volume *volume, abbe_exit_fill_statistics *statistics,
                           abbe_error *error) {
  *statistics = (abbe_exit_fill_statistics){0};
  fill f = {.lone = lone, .desc = desc, .volume = volume, .statistics = statistics};
  f.space =
      (abbe_exit_space){.geometry = &lone->geometry, .media = &f.media, .mirrors = &f.mirrors};
  if (desc->points < 1 || desc->points > ABBE_LIGHT_EXITS_MOST || desc->threads < 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "exits of %zu points on %zu threads; points may be 1 to %d", desc->points,
                          desc->threads, ABBE_LIGHT_EXITS_MOST);
  f.found = calloc(desc->points, sizeof *f.found);
  f.sequences = calloc(1, sizeof *f.sequences);
  abbe_result result = f.found != NULL && f.sequences != NULL
                           ? make_materials(&f, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for exits");
  if (result == ABBE_OK) result = find_facets(&f, error);
  f.space.facet = f.facet;
  if (result == ABBE_OK) result = find_symmetry(&f, error);
  if (result == ABBE_OK)
    result = abbe_exit_points_make(lone, &f.symmetry, desc->points, desc->min_nm, desc->max_nm,
                                   desc->seed, &f.points, error);
  if (result == ABBE_OK) result = make_table(&f, error);
  if (result == ABBE_OK) result = fill_nodes(&f, error);
  if (result == ABBE_OK) {
    statistics->carried /= (double)volume->exits.count;
    statistics->alone /= (double)volume->exits.count;
    statistics->sequences = f.sequences->count;
    statistics->maps = f.symmetry.count;
  }
  free_tables(&f);
  return result;
}
