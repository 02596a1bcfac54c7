#include "validation/trace/walks/route.h"

#include "base/maths.h"
#include "spectral/optics.h"
#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/media.h"

#include <string.h>

typedef struct walker {
  const abbe_geometry *g;
  double lambda_nm;
  abbe_media_set inside;
  float o[3], d[3];
  uint8_t wave; /* in a crystal */
} walker;

static abbe_result index_of(const walker *w, abbe_media_set set, double *n, abbe_error *error) {
  int medium = abbe_media_of(set);
  *n = 1;
  if (medium < 0) return ABBE_OK;
  uint32_t object = w->g->refractor_object[medium];
  return abbe_material_n(w->g->scene->object[object].material, w->lambda_nm, n, error);
}

static abbe_result medium_of(const walker *w, abbe_media_set set, abbe_uniaxial *out,
                             abbe_error *error) {
  *out = (abbe_uniaxial){1, 1, {0, 0, 1}};
  const int medium = abbe_media_of(set);
  if (medium < 0) return ABBE_OK;
  const abbe_object *object = &w->g->scene->object[w->g->refractor_object[medium]];
  memcpy(out->axis, object->axis, sizeof out->axis);
  abbe_result result = abbe_material_n(object->material, w->lambda_nm, &out->n_o, error);
  return result == ABBE_OK
             ? abbe_material_n_extraordinary(object->material, w->lambda_nm, &out->n_e, error)
             : result;
}

/* Any medium with its axes; whether it has three indices. */
static abbe_result axes_of(const walker *w, abbe_media_set set, abbe_biaxial *out, bool *biaxial,
                           abbe_error *error) {
  *out = (abbe_biaxial){{1, 1, 1}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const int medium = abbe_media_of(set);
  if (medium < 0) return ABBE_OK;
  const abbe_object *object = &w->g->scene->object[w->g->refractor_object[medium]];
  *biaxial = *biaxial || abbe_material_is_biaxial(object->material);
  memcpy(out->axis[0], object->axis_x, sizeof object->axis_x);
  memcpy(out->axis[2], object->axis, sizeof object->axis);
  abbe_vector_cross(object->axis, object->axis_x, out->axis[1]);
  for (int axis = 0; axis < 3; axis++)
    ABBE_TRY(abbe_material_n_along(object->material, axis, w->lambda_nm, &out->n[axis], error));
  return ABBE_OK;
}

/* The way that the choice names, or else the strongest. */
static const abbe_wave_way *way_of(const abbe_wave_ways *ways, char choice) {
  const abbe_wave_way *best = &ways->way[0];
  const bool reflected = choice == 'r' || choice == 'R', capital = choice == 'T' || choice == 'R';
  for (size_t i = 0; i < ways->count; i++) {
    const abbe_wave_way *way = &ways->way[i];
    bool alone = true;
    for (size_t k = 0; k < ways->count; k++)
      alone = alone && (k == i || ways->way[k].reflected != way->reflected);
    if (way->reflected == reflected && (alone || way->wave == capital)) return way;
    if (way->share > best->share) best = way;
  }
  return best;
}

/* A face of a crystal. */
static void meet_crystal(walker *w, const abbe_hit *hit, bool entering, const abbe_wave_ways *ways,
                         const char **choice, abbe_route_vertex *out) {
  const abbe_wave_way *way = way_of(ways, **choice != '\0' ? *(*choice)++ : 't');
  abbe_media_set before, after;
  abbe_media_cross(w->inside, hit->surface->index, entering, &before, &after);
  memcpy(w->d, way->d, sizeof w->d);
  w->wave = way->wave;
  w->inside = way->reflected ? before : after;
  out->event = way->reflected ? ABBE_ROUTE_REFLECTED : ABBE_ROUTE_TRANSMITTED;
  out->reflectance = (double)(ways->reflected * ways->passes);
  out->share = (double)(way->share * ways->passes);
  out->extraordinary = way->wave == ABBE_UNIAXIAL_EXTRAORDINARY;
}

static void record(const walker *w, const abbe_hit *hit, abbe_route_event event, double distance,
                   abbe_route_vertex *out) {
  out->event = event;
  out->object = hit->surface->object;
  out->distance = distance;
  abbe_geometry_to_world(w->g, hit->p, out->position);
  for (int k = 0; k < 3; k++) {
    out->normal[k] = (double)hit->n[k];
    out->direction[k] = (double)w->d[k];
  }
}

/* The film on the face that is met, with room for its layers; NULL: none. */
static abbe_result find_film(const walker *w, const abbe_hit *hit, bool covered, bool entering,
                             abbe_film_layer layer[ABBE_FILM_MOST_LAYERS], abbe_biaxial_film *made,
                             const abbe_biaxial_film **out, abbe_error *error) {
  const abbe_coating *coating =
      abbe_coatings_on(w->g->scene->object[hit->surface->object].coatings, hit->face);
  *out = NULL;
  if (covered || coating == NULL) return ABBE_OK;
  *made = (abbe_biaxial_film){layer, coating->count, !entering, w->lambda_nm};
  *out = made;
  return abbe_coating_at(coating, w->lambda_nm, layer, error);
}

/* What a film on glass reflects and passes on. */
static void share_film(const abbe_biaxial_film *film, const double n[2], double cos_i,
                       double shares[2]) {
  abbe_film_light light;
  const double to[2] = {n[1], 0};
  abbe_film_light_at(film->layer, film->count, film->reversed, n[0], to, cos_i, film->lambda_nm,
                     &light);
  abbe_film_unpolarised(&light, &shares[0], &shares[1]);
}

/* The interface at the hit: turns w->d and w->inside. */
static abbe_result meet(walker *w, const abbe_hit *hit, const char **choice, abbe_route_vertex *out,
                        abbe_error *error) {
  float along = w->d[0] * hit->n[0] + w->d[1] * hit->n[1] + w->d[2] * hit->n[2];
  bool entering = along < 0;
  float n[3], cos_i = fminf(fabsf(along), 1), cos_t = 0;
  for (int k = 0; k < 3; k++) n[k] = entering ? hit->n[k] : -hit->n[k];
  abbe_media_set before, after;
  abbe_media_cross(w->inside, hit->surface->index, entering, &before, &after);
  double n_i, n_t;
  ABBE_TRY(index_of(w, before, &n_i, error));
  ABBE_TRY(index_of(w, after, &n_t, error));
  abbe_uniaxial media[2];
  ABBE_TRY(medium_of(w, before, &media[0], error));
  ABBE_TRY(medium_of(w, after, &media[1], error));
  abbe_biaxial axes[2];
  bool biaxial = false;
  ABBE_TRY(axes_of(w, before, &axes[0], &biaxial, error));
  ABBE_TRY(axes_of(w, after, &axes[1], &biaxial, error));
  const bool covered = abbe_media_of(before) == abbe_media_of(after);
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_biaxial_film made;
  const abbe_biaxial_film *film = NULL;
  ABBE_TRY(find_film(w, hit, covered, entering, layer, &made, &film, error));
  out->cos_in = (double)cos_i;
  out->inside_n = n_i;
  if (biaxial || media[0].n_o != media[0].n_e || media[1].n_o != media[1].n_e) {
    abbe_wave_ways ways;
    if (biaxial || film != NULL)
      abbe_wave_ways_find_biaxial(&axes[0], &axes[1], n, w->d, w->wave, film, &ways);
    else
      abbe_wave_ways_find(&media[0], &media[1], n, w->d, w->wave, &ways);
    meet_crystal(w, hit, entering, &ways, choice, out);
    return ABBE_OK;
  }
  float eta = (float)(n_i / n_t), d[3];
  float share = covered ? 0 : abbe_interface_reflectance(cos_i, eta, &cos_t);
  double shares[2] = {(double)share, 1 - (double)share};
  if (film != NULL) share_film(film, (double[]){n_i, n_t}, (double)cos_i, shares);
  bool reflects = share >= 1;
  if (!reflects && **choice != '\0') {
    reflects = **choice == 'r' || **choice == 'R';
    ++*choice;
  }
  if (reflects)
    abbe_interface_reflect(w->d, n, cos_i, d);
  else if (covered)
    memcpy(d, w->d, sizeof d);
  else
    abbe_interface_refract(w->d, n, eta, cos_i, cos_t, d);
  memcpy(w->d, d, sizeof d);
  w->inside = reflects ? before : after;
  out->event = reflects ? ABBE_ROUTE_REFLECTED : ABBE_ROUTE_TRANSMITTED;
  out->reflectance = shares[0];
  out->share = shares[reflects ? 0 : 1];
  return ABBE_OK;
}

/* Off a mirror, whatever the choices are. */
static abbe_result mirror(walker *w, const abbe_hit *hit, abbe_route_vertex *out,
                          abbe_error *error) {
  const abbe_object *object = &w->g->scene->object[hit->surface->object];
  float along = w->d[0] * hit->n[0] + w->d[1] * hit->n[1] + w->d[2] * hit->n[2], n[3], d[3];
  for (int k = 0; k < 3; k++) n[k] = along < 0 ? hit->n[k] : -hit->n[k];
  float cos_i = fminf(fabsf(along), 1);
  abbe_interface_reflect(w->d, n, cos_i, d);
  memcpy(w->d, d, sizeof d);
  out->event = ABBE_ROUTE_REFLECTED;
  out->cos_in = (double)cos_i;
  out->reflectance = object->mirror_reflectance;
  ABBE_TRY(index_of(w, w->inside, &out->inside_n, error));
  if (object->conductor == NULL) return ABBE_OK;
  double nk[2];
  ABBE_TRY(abbe_material_nk(object->conductor, w->lambda_nm, &nk[0], &nk[1], error));
  out->reflectance = abbe_optics_fresnel_conductor((double)cos_i, nk[0], nk[1]);
  return ABBE_OK;
}

static abbe_result step(walker *w, const char **choice, abbe_route_vertex *out, bool *ended,
                        abbe_error *error) {
  *out = (abbe_route_vertex){.event = ABBE_ROUTE_ESCAPED,
                             .object = (size_t)-1,
                             .distance = INFINITY,
                             .inside_n = 1,
                             .share = 1};
  abbe_hit hit;
  unsigned mask = ABBE_GEOMETRY_OBJECTS;
  *ended = !abbe_geometry_hit(w->g, mask, w->o, w->d, INFINITY, &hit);
  if (*ended) {
    abbe_geometry_to_world(w->g, w->o, out->position);
    for (int k = 0; k < 3; k++) out->direction[k] = (double)w->d[k];
    return ABBE_OK;
  }
  double length = 0;
  for (int k = 0; k < 3; k++) length += pow((double)hit.p[k] - (double)w->o[k], 2);
  length = sqrt(length) * w->g->unit;
  *ended = hit.surface->kind == ABBE_GEOMETRY_RECEIVERS;
  abbe_result result = ABBE_OK;
  abbe_route_event event = ABBE_ROUTE_LANDED;
  if (*ended)
    out->cos_in = fabs((double)(w->d[0] * hit.n[0] + w->d[1] * hit.n[1] + w->d[2] * hit.n[2]));
  else if (hit.surface->kind == ABBE_GEOMETRY_MIRRORS)
    result = mirror(w, &hit, out, error);
  else
    result = meet(w, &hit, choice, out, error);
  if (!*ended) event = out->event;
  record(w, &hit, event, length, out);
  abbe_geometry_leave(&hit, w->d, w->o);
  return result;
}

abbe_result abbe_route_follow(const abbe_geometry *geometry, const double from[3],
                              const double direction[3], double lambda_nm, const char *choices,
                              abbe_route_vertex *vertex, size_t room, size_t *count,
                              abbe_error *error) {
  *count = 0;
  size_t known = strspn(choices, "trTR");
  if (choices[known] != '\0')
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "'%c' is no choice at an interface: t (transmit) and r (reflect) are, T and R "
        "of a crystal's extraordinary wave",
        choices[known]);
  walker w = {.g = geometry, .lambda_nm = lambda_nm};
  abbe_geometry_to_frame(geometry, from, w.o);
  for (int k = 0; k < 3; k++) w.d[k] = (float)direction[k];
  bool ended = false;
  while (!ended && *count < room) {
    ABBE_TRY(step(&w, &choices, &vertex[*count], &ended, error));
    ++*count;
  }
  return ABBE_OK;
}
