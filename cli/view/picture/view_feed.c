#include "cli/view/picture/view_feed.h"

#include "scenes/geometry/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SAME_PLANE 1e-6 /* of normals, and of places over the object's size */

/* A photon that lands there. */
typedef struct abbe_view_landed {
  double origin[3], direction[3], flux;
} landed;

/* The first refractor on a ray. */
typedef struct met {
  const abbe_object *object;
  size_t index, face;
  double distance;
} met;

void abbe_view_feed_begin(const double point[3], double radius, abbe_view_feed *out) {
  *out = (abbe_view_feed){.radius = radius};
  memcpy(out->point, point, sizeof out->point);
}

/* The flux that a photon brings near the point, over its wavelengths and slots. */
static double flux_near(const abbe_view_feed *feed, const abbe_view_hits *h, size_t photon) {
  const size_t each = h->slots * h->samples;
  double flux = 0;
  for (size_t i = photon * each; i < (photon + 1) * each; i++) {
    const float *at = h->at + 4 * i;
    const double to[3] = {(double)at[0] - feed->point[0], (double)at[1] - feed->point[1],
                          (double)at[2] - feed->point[2]};
    if (at[3] > 0 && abbe_vector_length(to) <= feed->radius) flux += (double)at[3];
  }
  return flux / (double)h->samples;
}

abbe_result abbe_view_feed_add(abbe_view_feed *feed, const abbe_view_hits *h, abbe_error *error) {
  for (size_t i = 0; i < h->count; i++) {
    const double flux = flux_near(feed, h, i);
    if (!(flux > 0)) continue;
    const size_t n = feed->photons;
    if ((n & (n - 1)) == 0) { /* room for twice as many */
      landed *more = realloc(feed->landed, (n > 0 ? 2 * n : 1) * sizeof *more);
      if (more == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for photons");
      feed->landed = more;
    }
    const double uv[2] = {((h->cell[i] & 0xffffU) + 0.5) / (double)h->grid,
                          ((h->cell[i] >> 16) + 0.5) / (double)h->grid};
    landed *l = &feed->landed[feed->photons++];
    abbe_view_ray(&h->view, uv, l->origin, l->direction);
    l->flux = flux;
    feed->flux += flux;
  }
  return ABBE_OK;
}

static int by_flux(const void *a, const void *b) {
  const landed *x = a, *y = b;
  return x->flux > y->flux ? -1 : x->flux < y->flux;
}

/* Along a ray to a triangle [MollerTrumbore1997], or infinity. */
static double distance_to(const landed *ray, const double a[3], const double b[3],
                          const double c[3]) {
  double u[3], v[3], across[3], from[3], q[3];
  abbe_vector_subtract(b, a, u);
  abbe_vector_subtract(c, a, v);
  abbe_vector_cross(ray->direction, v, across);
  const double whole = abbe_vector_dot(u, across);
  if (whole == 0) return INFINITY;
  abbe_vector_subtract(ray->origin, a, from);
  const double s = abbe_vector_dot(from, across) / whole;
  abbe_vector_cross(from, u, q);
  const double t = abbe_vector_dot(ray->direction, q) / whole;
  const double distance = abbe_vector_dot(v, q) / whole;
  return s >= 0 && t >= 0 && s + t <= 1 && distance > 0 ? distance : INFINITY;
}

static void meet(const landed *ray, const abbe_object *object, size_t index, met *best) {
  const abbe_mesh *m = &object->mesh;
  for (size_t f = 0; f < m->face_count; f++) {
    const uint32_t *at = m->face[f];
    const double d = distance_to(ray, m->position[at[0]], m->position[at[1]], m->position[at[2]]);
    if (d < best->distance) *best = (met){object, index, f, d};
  }
}

static void plane_of(const abbe_mesh *m, size_t face, double normal[3], double *offset) {
  const uint32_t *at = m->face[face];
  double u[3], v[3];
  abbe_vector_subtract(m->position[at[1]], m->position[at[0]], u);
  abbe_vector_subtract(m->position[at[2]], m->position[at[0]], v);
  abbe_vector_cross(u, v, normal);
  abbe_vector_normalise(normal);
  *offset = abbe_vector_dot(normal, m->position[at[0]]);
}

static bool in_plane(const abbe_object *object, const abbe_view_facet *facet,
                     const double normal[3], double offset) {
  double size[3];
  abbe_vector_subtract(object->max, object->min, size);
  return abbe_vector_dot(normal, facet->normal) > 1 - SAME_PLANE &&
         fabs(offset - facet->offset) < SAME_PLANE * abbe_vector_length(size);
}

static int by_share(const void *a, const void *b) {
  const abbe_view_facet *x = a, *y = b;
  return x->share > y->share ? -1 : x->share < y->share;
}

/* Sorts the rays among facets, of which the strongest stay. */
static void sort_facets(abbe_view_feed *feed, const abbe_scene *scene, const met *of) {
  abbe_view_facet facet[ABBE_VIEW_FEED_RAYS];
  size_t count = 0;
  double whole = 0;
  for (size_t i = 0; i < feed->ray_count; i++) whole += feed->ray[i].share;
  for (size_t i = 0; i < feed->ray_count; i++) {
    abbe_view_facet one = {.object = of[i].index};
    const abbe_object *object = &scene->object[one.object];
    size_t k = 0;
    plane_of(&object->mesh, of[i].face, one.normal, &one.offset);
    while (k < count &&
           !(facet[k].object == one.object && in_plane(object, &facet[k], one.normal, one.offset)))
      k++;
    if (k == count) facet[count++] = one;
    facet[k].share += feed->ray[i].share / whole;
  }
  qsort(facet, count, sizeof *facet, by_share);
  feed->facet_count = count < ABBE_VIEW_FEED_FACETS ? count : ABBE_VIEW_FEED_FACETS;
  memcpy(feed->facet, facet, feed->facet_count * sizeof *facet);
  for (size_t i = 0; i < feed->ray_count; i++) {
    double normal[3], offset;
    const abbe_object *object = &scene->object[of[i].index];
    size_t k = 0;
    plane_of(&object->mesh, of[i].face, normal, &offset);
    while (k < feed->facet_count && !(feed->facet[k].object == of[i].index &&
                                      in_plane(object, &feed->facet[k], normal, offset)))
      k++;
    feed->ray[i].facet = k;
  }
}

/* Adds an edge, or takes away the one that runs back along it. False: there is no room. */
static bool add_edge(abbe_view_feed *feed, size_t first, const double a[3], const double b[3]) {
  for (size_t i = first; i < feed->edge_count; i++) {
    if (memcmp(feed->edge[i][0], b, sizeof feed->edge[i][0]) != 0 ||
        memcmp(feed->edge[i][1], a, sizeof feed->edge[i][1]) != 0)
      continue;
    memmove(feed->edge[i], feed->edge[--feed->edge_count], sizeof feed->edge[i]);
    return true;
  }
  if (feed->edge_count == ABBE_VIEW_FEED_EDGES) return false;
  memcpy(feed->edge[feed->edge_count][0], a, sizeof feed->edge[0][0]);
  memcpy(feed->edge[feed->edge_count++][1], b, sizeof feed->edge[0][1]);
  return true;
}

/* What is around a facet: those edges of its triangles that no two of them share. */
static void outline(abbe_view_feed *feed, const abbe_scene *scene, const abbe_view_facet *facet) {
  const abbe_object *object = &scene->object[facet->object];
  const abbe_mesh *m = &object->mesh;
  const size_t first = feed->edge_count;
  for (size_t f = 0; f < m->face_count; f++) {
    double normal[3], offset;
    plane_of(m, f, normal, &offset);
    if (!in_plane(object, facet, normal, offset)) continue;
    for (int k = 0; k < 3; k++)
      if (!add_edge(feed, first, m->position[m->face[f][k]],
                    m->position[m->face[f][(k + 1) % 3]])) {
        feed->edge_count = first; /* a half of it would mislead */
        return;
      }
  }
}

void abbe_view_feed_end(abbe_view_feed *feed, const abbe_scene *scene) {
  met of[ABBE_VIEW_FEED_RAYS];
  if (feed->photons > 0) qsort(feed->landed, feed->photons, sizeof *feed->landed, by_flux);
  for (size_t i = 0; i < feed->photons && i < ABBE_VIEW_FEED_RAYS; i++) {
    const landed *l = &feed->landed[i];
    met best = {.distance = INFINITY};
    for (size_t k = 0; k < scene->object_count; k++)
      if (scene->object[k].material != NULL) meet(l, &scene->object[k], k, &best);
    if (best.object == NULL) continue;
    abbe_view_ray_in *ray = &feed->ray[feed->ray_count];
    of[feed->ray_count++] = best;
    ray->share = l->flux / feed->flux;
    memcpy(ray->light, l->origin, sizeof ray->light);
    for (int k = 0; k < 3; k++) ray->entry[k] = l->origin[k] + best.distance * l->direction[k];
  }
  free(feed->landed);
  feed->landed = NULL;
  if (feed->ray_count > 0) sort_facets(feed, scene, of);
  for (size_t i = 0; i < feed->facet_count; i++) outline(feed, scene, &feed->facet[i]);
}
