#include "validation/trace/tracer/tracer_state.h"

#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

enum { TRIALS = 65536 };

/* Window coordinates of a trial's photons, along right (0) and up (1); their number. */
static size_t try_photons(const abbe_tracer *t, abbe_light_walk *walk, const abbe_view *view,
                          const abbe_emission *e, double *at[2], double *near, double *far) {
  abbe_light_walk_room *room = abbe_light_walk_get_room(walk);
  abbe_photon *photon = room->photon;
  abbe_photon_hit *hit = room->hit;
  abbe_light_ledger ledger = {0};
  size_t found = 0;
  for (uint32_t j = 0; j < e->count; j += ABBE_LIGHT_WALK_BATCH) {
    size_t count = abbe_emission_batch(e, j, (uint32_t)e->count, photon);
    size_t landed =
        abbe_light_walk_run(walk, &t->scene->light[e->light], e->pass, photon, count, hit, &ledger);
    for (size_t i = 0; i < landed; i++) {
      double p[3], from[3], z;
      if (hit[i].hidden) continue;
      abbe_geometry_to_world(&t->geometry, hit[i].p, p);
      abbe_vector_subtract(p, view->origin, from);
      z = abbe_vector_dot(from, view->forward);
      double scale = view->orthographic ? 1 : z;
      if (!(z > 0)) continue;
      double x = abbe_vector_dot(from, view->right) / scale;
      double y = abbe_vector_dot(from, view->up) / scale;
      if (!view->orthographic && fmax(fabs(x), fabs(y)) > ABBE_VIEW_MAX_TANGENT) continue;
      at[0][found] = x;
      at[1][found++] = y;
      *near = fmin(*near, z);
      *far = fmax(*far, z);
    }
  }
  return found;
}

abbe_result abbe_tracer_fit_layout(abbe_tracer *t, abbe_error *error) {
  const abbe_light *light = &t->scene->light[t->desc.map_light];
  const abbe_projection_map *map = &t->projection[t->desc.map_light];
  bool parallel = light->kind == ABBE_LIGHT_DIRECTIONAL;
  double origin[3], way[3], up[3] = {0, 0, 1};
  abbe_geometry_to_world(&t->geometry, map->origin, origin);
  for (int k = 0; k < 3; k++) way[k] = (double)map->way[k];
  /* From the very place of the light: the renderer takes a map of no other. */
  memcpy(parallel ? way : origin, parallel ? light->direction : light->position, sizeof way);
  abbe_view view;
  abbe_view_look(origin, way, up, parallel, &view);
  double middle[3];
  memcpy(middle, t->geometry.origin, sizeof middle);
  abbe_view_fit(&view, (const double(*)[3]) & middle, 1);
  double *at[2] = {malloc(TRIALS * sizeof **at), malloc(TRIALS * sizeof **at)};
  abbe_emission e = {0};
  abbe_light_walk *walk = NULL;
  /* no seed but this one: maps of other seeds are to have the same layout */
  abbe_result result = abbe_emission_make(t, t->desc.map_light, TRIALS, 0, 0, &e, error);
  if (result == ABBE_OK)
    result = abbe_light_walk_make(&t->geometry, &t->media, &t->mirrors, &t->desc.physics, 0, &walk,
                                  error);
  if (result == ABBE_OK && (at[0] == NULL || at[1] == NULL))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for trial photons");
  if (result == ABBE_OK) {
    double near = view.near, far = view.far;
    size_t found = try_photons(t, walk, &view, &e, at, &near, &far);
    for (int k = 0; k < 2 && found > 0; k++) {
      qsort(at[k], found, sizeof *at[k], abbe_order_ascending);
      view.window[2 * k] = at[k][found / 1000];
      view.window[2 * k + 1] = at[k][found - 1 - found / 1000];
    }
    view.near = near;
    view.far = far;
    abbe_view_pad(&view, 0.05);
    abbe_map_layout_make(&view, &t->layout);
    result = abbe_map_layout_check(&t->layout, error);
  }
  abbe_light_walk_free(walk);
  abbe_emission_free(&e);
  free(at[0]);
  free(at[1]);
  return result;
}
