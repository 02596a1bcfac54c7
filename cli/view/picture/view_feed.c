#include "cli/view/picture/view_feed.h"

#include "base/maths.h"
#include "spectral/optics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Along a ray to a triangle [MollerTrumbore1997], or infinity. */
static double distance_to(const double origin[3], const double direction[3], const double a[3],
                          const double b[3], const double c[3]) {
  double u[3], v[3], across[3], from[3], q[3];
  abbe_vector_subtract(b, a, u);
  abbe_vector_subtract(c, a, v);
  abbe_vector_cross(direction, v, across);
  const double whole = abbe_vector_dot(u, across);
  if (whole == 0) return INFINITY;
  abbe_vector_subtract(origin, a, from);
  const double s = abbe_vector_dot(from, across) / whole;
  abbe_vector_cross(from, u, q);
  const double t = abbe_vector_dot(direction, q) / whole;
  const double distance = abbe_vector_dot(v, q) / whole;
  return s >= 0 && t >= 0 && s + t <= 1 ? distance : INFINITY;
}

/* The nearest surface on a ray (unit direction) beyond `from` m; bending: of refractors and mirrors
 * alone. */
static void view_meet(const abbe_scene *scene, const double origin[3], const double direction[3],
                      double from, bool bending, abbe_view_met *out) {
  *out = (abbe_view_met){.distance = INFINITY};
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    const abbe_mesh *m = &object->mesh;
    const bool may =
        !object->cloud && (!bending || abbe_object_kind_of(object) != ABBE_OBJECT_RECEIVER);
    for (size_t f = 0; may && f < m->face_count; f++) {
      const uint32_t *at = m->face[f];
      const double d = distance_to(origin, direction, m->position[at[0]], m->position[at[1]],
                                   m->position[at[2]]);
      if (d > from && d < out->distance) *out = (abbe_view_met){object, i, f, d};
    }
  }
}

/* Outward, of the triangle; unit. */
static void view_met_normal(const abbe_object *object, size_t face, double out[3]) {
  const abbe_mesh *m = &object->mesh;
  const uint32_t *at = m->face[face];
  abbe_vector_triangle(m->position[at[0]], m->position[at[1]], m->position[at[2]], out);
  abbe_vector_normalise(out);
}

/* On the side that the ray comes from. True: the ray enters the object. */
static bool face_ray(const abbe_view_met *met, const double place[3], const double direction[3],
                     double n[3]) {
  const abbe_exact *exact = &met->object->exact;
  view_met_normal(met->object, met->face, n);
  if (exact->kind == ABBE_EXACT_SPHERE) {
    abbe_vector_subtract(place, exact->centre, n);
    abbe_vector_normalise(n);
  }
  const bool enters = abbe_vector_dot(direction, n) < 0;
  for (int k = 0; k < 3 && !enters; k++) n[k] = -n[k];
  return enters;
}

/* The stronger of the two ways on. */
static bool turn(const abbe_view_met *met, const double place[3], double nm, double direction[3]) {
  double n[3], back[3], index = 1, on[3];
  const bool enters = face_ray(met, place, direction, n);
  for (int k = 0; k < 3; k++) back[k] = -direction[k];
  if (met->object->material != NULL &&
      abbe_material_n(met->object->material, nm, &index, NULL) != ABBE_OK)
    return false;
  const double eta = enters ? 1 / index : index;
  const bool reflects =
      met->object->mirror || abbe_optics_fresnel(abbe_vector_dot(back, n), eta) > 0.5;
  if (reflects || !abbe_optics_refract(back, n, eta, on)) abbe_optics_reflect(back, n, on);
  memcpy(direction, on, 3 * sizeof *direction);
  return true;
}

void abbe_view_sight_follow(const abbe_scene *scene, const double eye[3], const double direction[3],
                            double nm, abbe_view_sight *out) {
  double at[3], along[3], from = 0;
  memcpy(at, eye, sizeof at);
  memcpy(along, direction, sizeof along);
  *out = (abbe_view_sight){.nm = nm};
  while (out->count < ABBE_VIEW_SIGHT_PLACES) {
    abbe_view_met met;
    view_meet(scene, at, along, from, false, &met);
    if (met.object == NULL) return;
    for (int k = 0; k < 3; k++) at[k] += met.distance * along[k];
    out->length += met.distance;
    memcpy(out->place[out->count++], at, sizeof at);
    out->lands = abbe_object_kind_of(met.object) == ABBE_OBJECT_RECEIVER;
    if (out->lands || !turn(&met, at, nm, along)) return;
    from = 1e-9 * out->length; /* not the place where it is again */
  }
}

#define SAME_PLANE 1e-6 /* difference of normals, and of places over the object's size */

/* A photon that hits there. */
typedef struct abbe_view_landed {
  double origin[3], direction[3], flux;
} landed;

void abbe_view_feed_begin(const double point[3], double radius, abbe_view_feed *out) {
  *out = (abbe_view_feed){.radius = radius};
  memcpy(out->point, point, sizeof out->point);
}

/* ---- which photons ---- */

/* What a photon lights at one wavelength: a cell's image on the receiver, and on to the next
 * wavelength's. Sides that are longer than so many times the radius are tears. */
#define MOST_ACROSS 24.0
enum { ASIDE, ABOVE, ONWARD, SIDES };

/* Photon + 1 of each cell; 0: none. */
static abbe_result index_cells(const abbe_view_hits *h, uint32_t **out, abbe_error *error) {
  uint32_t *of = calloc(h->grid[0] * h->grid[1] + 1, sizeof *of);
  if (of == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for photons' cells");
  for (size_t i = 0; i < h->count; i++) {
    const size_t x = h->cell[i] & 0xffffU, y = h->cell[i] >> 16;
    if (x < h->grid[0] && y < h->grid[1]) of[y * h->grid[0] + x] = (uint32_t)(i + 1);
  }
  *out = of;
  return ABBE_OK;
}

/* To another hit of the same path; false where there is none, or too far away. */
static bool step_to(const abbe_view_hits *h, size_t from, size_t to, double most, double out[3]) {
  if (h->path[from] != h->path[to] || !(h->at[4 * to + 3] > 0)) return false;
  for (int k = 0; k < 3; k++) out[k] = (double)h->at[4 * to + k] - (double)h->at[4 * from + k];
  return abbe_vector_length(out) <= most;
}

/* The cell's image along an axis: the mean of the steps to both neighbours, where they are. */
static void side_of(const abbe_view_hits *h, const uint32_t *photon_of, size_t photon, size_t hit,
                    int axis, double most, double out[3]) {
  const size_t each = h->slots * h->samples;
  const size_t cell[2] = {h->cell[photon] & 0xffffU, h->cell[photon] >> 16};
  size_t found = 0;
  memset(out, 0, 3 * sizeof *out);
  for (int next = 0; next < 2; next++) {
    size_t at[2] = {cell[0], cell[1]};
    double step[3];
    if (next == 0 && at[axis] == 0) continue;
    at[axis] += next == 0 ? (size_t)-1 : 1;
    const uint32_t other = at[axis] < h->grid[axis] ? photon_of[at[1] * h->grid[0] + at[0]] : 0;
    if (other == 0 || !step_to(h, hit, (other - 1) * each + hit - photon * each, most, step))
      continue;
    for (int k = 0; k < 3; k++) out[k] += next == 0 ? -step[k] : step[k];
    found++;
  }
  for (int k = 0; found > 1 && k < 3; k++) out[k] *= 0.5;
}

/* How far from what the sides span around the hit: least squares within bounds, side by side. */
static double distance_from(const double to[3], double side[SIDES][3]) {
  enum { TURNS = 12 };
  double part[SIDES] = {0}, left[3];
  memcpy(left, to, sizeof left);
  for (int turn = 0; turn < TURNS; turn++)
    for (int i = 0; i < SIDES; i++) {
      const double square = abbe_vector_dot(side[i], side[i]);
      if (!(square > 0)) continue;
      const double least = i == ONWARD ? 0 : -0.5, most = i == ONWARD ? 1 : 0.5;
      const double wanted = part[i] + abbe_vector_dot(left, side[i]) / square;
      const double now = fmin(fmax(wanted, least), most);
      for (int k = 0; k < 3; k++) left[k] -= (now - part[i]) * side[i][k];
      part[i] = now;
    }
  return abbe_vector_length(left);
}

static bool lights(const abbe_view_feed *feed, const abbe_view_hits *h, const uint32_t *photon_of,
                   size_t photon, size_t hit) {
  const double most = MOST_ACROSS * feed->radius;
  const float *at = h->at + 4 * hit;
  const double to[3] = {feed->point[0] - (double)at[0], feed->point[1] - (double)at[1],
                        feed->point[2] - (double)at[2]};
  const size_t sample = hit % h->samples;
  double side[SIDES][3] = {{0}};
  if (!(at[3] > 0) || abbe_vector_length(to) > 2 * most + feed->radius) return false;
  if (sample + 1 == h->samples && !h->last) return false; /* the next batch has it */
  side_of(h, photon_of, photon, hit, 0, most, side[ASIDE]);
  side_of(h, photon_of, photon, hit, 1, most, side[ABOVE]);
  if (sample + 1 < h->samples && !step_to(h, hit, hit + 1, most, side[ONWARD]))
    memset(side[ONWARD], 0, sizeof side[ONWARD]);
  return distance_from(to, side) <= feed->radius;
}

static abbe_result add_landed(abbe_view_feed *feed, const abbe_view_hits *h, size_t photon,
                              double flux, abbe_error *error) {
  const double uv[2] = {((h->cell[photon] & 0xffffU) + 0.5) / (double)h->grid[0],
                        ((h->cell[photon] >> 16) + 0.5) / (double)h->grid[1]};
  double origin[3], direction[3];
  abbe_view_ray(&h->view, uv, origin, direction);
  landed *all = feed->landed;
  for (size_t i = 0; i < feed->photons; i++) /* photons of a batch before */
    if (memcmp(all[i].origin, origin, sizeof origin) == 0 &&
        memcmp(all[i].direction, direction, sizeof direction) == 0) {
      all[i].flux += flux;
      return ABBE_OK;
    }
  const size_t n = feed->photons;
  if ((n & (n - 1)) == 0) { /* capacity for twice as many */
    landed *more = realloc(feed->landed, (n > 0 ? 2 * n : 1) * sizeof *more);
    if (more == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for photons");
    feed->landed = more;
  }
  landed *l = &feed->landed[feed->photons++];
  memcpy(l->origin, origin, sizeof origin);
  memcpy(l->direction, direction, sizeof direction);
  l->flux = flux;
  return ABBE_OK;
}

static bool is_wanted(const volatile int *stop) {
  return stop == NULL || !*stop;
}

abbe_result abbe_view_feed_add(abbe_view_feed *feed, const abbe_view_hits *h, abbe_error *error) {
  const size_t each = h->slots * h->samples;
  ABBE_FREED uint32_t *photon_of = NULL;
  ABBE_TRY(index_cells(h, &photon_of, error));
  for (size_t i = 0; i < h->count && is_wanted(h->stop); i++) {
    double flux = 0;
    for (size_t hit = i * each; hit < (i + 1) * each; hit++)
      if (lights(feed, h, photon_of, i, hit)) flux += (double)h->at[4 * hit + 3];
    if (!(flux > 0)) continue;
    feed->flux += flux;
    ABBE_TRY(add_landed(feed, h, i, flux, error));
  }
  return ABBE_OK;
}

static int by_flux(const void *a, const void *b) {
  const landed *x = a, *y = b;
  return x->flux > y->flux ? -1 : x->flux < y->flux;
}

static void plane_of(const abbe_object *object, size_t face, double normal[3], double *offset) {
  view_met_normal(object, face, normal);
  *offset = abbe_vector_dot(normal, object->mesh.position[object->mesh.face[face][0]]);
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
static void sort_facets(abbe_view_feed *feed, const abbe_scene *scene, const abbe_view_met *of) {
  abbe_view_facet facet[ABBE_VIEW_FEED_RAYS];
  size_t count = 0;
  double whole = 0;
  for (size_t i = 0; i < feed->ray_count; i++) whole += feed->ray[i].share;
  for (size_t i = 0; i < feed->ray_count; i++) {
    abbe_view_facet one = {.object = of[i].index};
    const abbe_object *object = &scene->object[one.object];
    size_t k = 0;
    plane_of(object, of[i].face, one.normal, &one.offset);
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
    plane_of(object, of[i].face, normal, &offset);
    while (k < feed->facet_count && !(feed->facet[k].object == of[i].index &&
                                      in_plane(object, &feed->facet[k], normal, offset)))
      k++;
    feed->ray[i].facet = k;
  }
}

/* Adds an edge, or takes away the one that runs back along it. False: the capacity is used up. */
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
    plane_of(object, f, normal, &offset);
    if (!in_plane(object, facet, normal, offset)) continue;
    for (int k = 0; k < 3; k++)
      if (!add_edge(feed, first, m->position[m->face[f][k]],
                    m->position[m->face[f][(k + 1) % 3]])) {
        feed->edge_count = first; /* a half of it would mislead */
        return;
      }
  }
}

bool abbe_view_feed_look(abbe_view_feed *feed, const abbe_scene *scene, double nm) {
  const double *eye = scene->camera.eye;
  double along[3];
  abbe_view_met first;
  abbe_vector_subtract(feed->point, eye, along);
  const double far = abbe_vector_length(along);
  if (!abbe_vector_normalise(along)) return true;
  view_meet(scene, eye, along, 0, true, &first);
  feed->on_refractor = fabs(first.distance - far) < fmax(feed->radius, 1e-3 * far);
  if (!feed->on_refractor) return true;
  abbe_view_sight_follow(scene, eye, along, nm, &feed->sight);
  if (!feed->sight.lands) return false;
  memcpy(feed->point, feed->sight.place[feed->sight.count - 1], sizeof feed->point);
  feed->radius *= feed->sight.length / far;
  return true;
}

void abbe_view_feed_end(abbe_view_feed *feed, const abbe_scene *scene, const volatile int *stop) {
  abbe_view_met of[ABBE_VIEW_FEED_RAYS];
  if (feed->photons > 0) qsort(feed->landed, feed->photons, sizeof *feed->landed, by_flux);
  for (size_t i = 0; i < feed->photons && i < ABBE_VIEW_FEED_RAYS && is_wanted(stop); i++) {
    const landed *l = &feed->landed[i];
    abbe_view_met best;
    view_meet(scene, l->origin, l->direction, 0, true, &best);
    if (best.object == NULL) continue;
    abbe_view_ray_in *ray = &feed->ray[feed->ray_count];
    of[feed->ray_count++] = best;
    ray->share = l->flux / feed->flux;
    memcpy(ray->light, l->origin, sizeof ray->light);
    for (int k = 0; k < 3; k++) ray->entry[k] = l->origin[k] + best.distance * l->direction[k];
  }
  free(feed->landed);
  feed->landed = NULL;
  if (feed->ray_count > 0 && is_wanted(stop)) sort_facets(feed, scene, of);
  for (size_t i = 0; i < feed->facet_count && is_wanted(stop); i++)
    outline(feed, scene, &feed->facet[i]);
}
