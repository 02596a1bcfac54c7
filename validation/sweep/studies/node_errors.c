#include "validation/sweep/studies/node_errors.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PLACES = ABBE_NODE_ERRORS_PLACES, ALL = ABBE_NODE_ERRORS_ALL };

void abbe_node_errors_free(abbe_node_errors *known) {
  if (known == NULL) return;
  for (size_t i = 0; i < known->count; i++)
    for (int k = 0; k < ALL; k++) abbe_image_free(&known->set[i].truth[k]);
  *known = (abbe_node_errors){0};
}

/* ---- where the light stands ---- */

/* Into a list of those nearest to the light, the nearest first; cosine[k] is below -1 where there
 * is none yet. */
static void insert(const double d[3], const double to_light[3], double cosine[PLACES],
                   double list[PLACES][3]) {
  const double c = abbe_vector_dot(d, to_light);
  int at = PLACES;
  for (; at > 0 && c > cosine[at - 1]; at--)
    if (at < PLACES) {
      cosine[at] = cosine[at - 1];
      memcpy(list[at], list[at - 1], sizeof list[at]);
    }
  if (at == PLACES) return;
  cosine[at] = c;
  memcpy(list[at], d, sizeof list[at]);
}

bool abbe_node_errors_places(const abbe_light_nodes *nodes, const double to_light[3],
                             double place[ALL][3]) {
  double cosine[ALL];
  for (int k = 0; k < ALL; k++) cosine[k] = -2;
  if (nodes->count < 12) return false;
  for (size_t i = 0; i < nodes->count; i++) insert(nodes->direction[i], to_light, cosine, place);
  for (size_t i = 0; i < nodes->mesh.face_count; i++) {
    double middle[3] = {0};
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) middle[k] += nodes->mesh.corner[nodes->mesh.face[i][c]][k];
    abbe_vector_normalise(middle);
    insert(middle, to_light, cosine + PLACES, place + PLACES);
  }
  return true;
}

static bool find_light(const abbe_light *light, const double middle[3], double to_light[3]) {
  for (int k = 0; k < 3; k++)
    to_light[k] = light->kind == ABBE_LIGHT_DIRECTIONAL ? -light->direction[k]
                                                        : light->position[k] - middle[k];
  return (light->kind == ABBE_LIGHT_DIRECTIONAL || light->kind == ABBE_LIGHT_POINT) &&
         abbe_vector_normalise(to_light);
}

bool abbe_node_errors_move(const abbe_light *light, const double middle[3],
                           const double to_light[3], abbe_light *out) {
  double from[3];
  if (!find_light(light, middle, from)) return false;
  *out = *light;
  abbe_vector_subtract(light->position, middle, from);
  const double far = abbe_vector_length(from);
  for (int k = 0; k < 3; k++) {
    if (light->kind == ABBE_LIGHT_DIRECTIONAL)
      out->direction[k] = -to_light[k];
    else
      out->position[k] = middle[k] + far * to_light[k];
  }
  return true;
}

/* ---- pictures ---- */

typedef struct work {
  const abbe_sweep *sweep;
  abbe_scene moved;
  double middle[3], place[ALL][3];
} work;

static void move_to(work *w, int place) {
  abbe_node_errors_move(&w->sweep->scene->light[0], w->middle, w->place[place], &w->moved.light[0]);
}

/* What photons show by default in each light, with its caustic apart. */
static abbe_result draw_photons(work *w, abbe_image truth[ALL], abbe_error *error) {
  const abbe_render_desc desc = {
      .width = w->sweep->picture->width, .height = w->sweep->picture->height, .aovs = true};
  abbe_renderer *renderer = NULL;
  move_to(w, 0);
  abbe_result result = abbe_renderer_make(w->sweep->context, &w->moved, &desc, &renderer, error);
  for (int k = 0; k < ALL && result == ABBE_OK; k++) {
    move_to(w, k);
    result = abbe_renderer_change(renderer, &w->moved, &desc, error);
    if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
    if (result == ABBE_OK) result = abbe_renderer_read(renderer, true, &truth[k], error);
  }
  abbe_renderer_free(renderer);
  return result;
}

/* The set's number; it is drawn where it is not known. */
static abbe_result find_set(abbe_node_errors *known, work *w, size_t nodes, size_t *out,
                            abbe_error *error) {
  for (*out = 0; *out < known->count; ++*out)
    if (known->set[*out].nodes == nodes) return ABBE_OK;
  if (known->count == ABBE_NODE_ERRORS_SETS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "more than %d counts of light nodes",
                          ABBE_NODE_ERRORS_SETS);
  known->set[known->count++].nodes = nodes;
  return draw_photons(w, known->set[*out].truth, error);
}

/* *worst grows to what the renderer is off by in the moved light. */
static abbe_result compare(const work *w, const abbe_render_desc *desc, abbe_renderer *renderer,
                           const abbe_image *truth, double *worst, abbe_error *error) {
  abbe_image picture = {0};
  abbe_sweep_row row;
  abbe_sweep sweep = *w->sweep;
  sweep.picture = truth;
  const bool printed = abbe_method_of(desc->profile)->printed;
  abbe_result result = abbe_renderer_change(renderer, &w->moved, desc, error);
  if (result == ABBE_OK) result = abbe_renderer_frame(renderer, NULL, NULL, NULL, error);
  if (result == ABBE_OK) result = abbe_renderer_read(renderer, false, &picture, error);
  if (result == ABBE_OK)
    result = abbe_sweep_compare_picture(&sweep, &picture, printed, &row, error);
  if (result == ABBE_OK) *worst = fmax(*worst, row.number[ABBE_SWEEP_CAUSTIC_RMSE]);
  abbe_image_free(&picture);
  return result;
}

static abbe_result measure(abbe_node_errors *known, work *w, size_t nodes,
                           const abbe_render_desc *desc, abbe_renderer *renderer, double *at_node,
                           double *between, abbe_error *error) {
  size_t set;
  abbe_result result = find_set(known, w, nodes, &set, error);
  for (int k = 0; k < ALL && result == ABBE_OK; k++) {
    move_to(w, k);
    result = compare(w, desc, renderer, &known->set[set].truth[k], k < PLACES ? at_node : between,
                     error);
  }
  /* the renderer is not to look at lights that are gone */
  const abbe_result back =
      abbe_renderer_change(renderer, w->sweep->scene, desc, result == ABBE_OK ? error : NULL);
  return result == ABBE_OK ? back : result;
}

abbe_result abbe_node_errors_measure(abbe_node_errors *known, const abbe_sweep *sweep,
                                     const abbe_light_nodes *nodes, const abbe_render_desc *desc,
                                     abbe_renderer *renderer, double *at_node, double *between,
                                     abbe_error *error) {
  const abbe_scene *scene = sweep->scene;
  const abbe_plan *plan = abbe_renderer_plan(renderer);
  double to_light[3];
  *at_node = *between = NAN;
  if (scene->light_count == 0 || plan->refractor_count == 0) return ABBE_OK;
  const abbe_object *object = &scene->object[plan->refractor_object[0]];
  work w = {.sweep = sweep, .moved = *scene};
  for (int k = 0; k < 3; k++) w.middle[k] = 0.5 * (object->min[k] + object->max[k]);
  if (!find_light(&scene->light[0], w.middle, to_light) ||
      !abbe_node_errors_places(nodes, to_light, w.place))
    return ABBE_OK;
  w.moved.light = malloc(scene->light_count * sizeof *w.moved.light);
  if (w.moved.light == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for lights");
  memcpy(w.moved.light, scene->light, scene->light_count * sizeof *w.moved.light);
  abbe_result result = measure(known, &w, nodes->count, desc, renderer, at_node, between, error);
  free(w.moved.light);
  return result;
}
