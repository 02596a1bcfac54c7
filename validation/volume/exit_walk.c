#include "validation/volume/exit_walk.h"

#include "validation/transport/interface.h"

#include <string.h>

/* How far before its place a ray sets out, frame units: from outside of the object. */
static const float before = 4;
/* And how far off the place what it meets first may lie. */
static const float near_place = 1e-4f;

/* A ray under way. */
typedef struct walk {
  const abbe_exit_space *space;
  uint32_t step;
  float o[3], d[3], carried;
  bool inside;
  uint32_t facets;
} walk;

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* FNV's prime [FowlerNollVo]. */
static void note(walk *w, const abbe_hit *hit, bool reflects) {
  const uint32_t facet = w->space->facet != NULL ? w->space->facet[hit->face] : 0;
  w->facets = (w->facets ^ (2 * facet + reflects + 1)) * 16777619u;
}

/* The normals on the side that the ray comes from, interpolated and the face's own. */
static float face_normals(const walk *w, const abbe_hit *hit, float n[3], float ng[3]) {
  const bool entering = dot(w->d, hit->ng) < 0;
  const float side = entering ? 1 : -1;
  const float *outside = (dot(w->d, hit->n) < 0) == entering ? hit->n : hit->ng;
  for (int k = 0; k < 3; k++) {
    n[k] = side * outside[k];
    ng[k] = side * hit->ng[k];
  }
  return fminf(fmaxf(-dot(w->d, n), 0), 1);
}

static void go_on(walk *w, const abbe_hit *hit, const float out[3]) {
  memcpy(w->d, out, sizeof w->d);
  abbe_geometry_leave(hit, out, w->o);
}

static void meet_mirror(walk *w, const abbe_hit *hit) {
  float n[3], ng[3], out[3];
  const float cos_i = face_normals(w, hit, n, ng);
  w->carried *= abbe_mirrors_reflect(w->space->mirrors, hit->surface->index, cos_i, w->step, 0.5f);
  abbe_interface_reflect(w->d, n, cos_i, out);
  abbe_interface_keep_side(ng, 1, out);
  note(w, hit, true);
  go_on(w, hit, out);
}

static void meet_interface(walk *w, const abbe_hit *hit, float chance) {
  float n[3], ng[3], out[3], cos_t;
  const bool entering = dot(w->d, hit->ng) < 0;
  const float cos_i = face_normals(w, hit, n, ng);
  const float index = abbe_media_n(w->space->media, (int)hit->surface->index, w->step, 0.5f);
  const float eta = entering ? 1 / index : index;
  const bool reflects = chance < abbe_interface_reflectance(cos_i, eta, &cos_t);
  if (reflects)
    abbe_interface_reflect(w->d, n, cos_i, out);
  else
    abbe_interface_refract(w->d, n, eta, cos_i, cos_t, out);
  abbe_interface_keep_side(ng, reflects ? 1 : -1, out);
  w->inside = entering != reflects;
  note(w, hit, reflects);
  go_on(w, hit, out);
}

/* The decision's number: those that are given, and then others that only look like chance. */
static float decide(const abbe_exit_start *start, size_t met) {
  if (met < ABBE_EXIT_WALK_CHANCES) return start->chance[met];
  const float x = start->chance[ABBE_EXIT_WALK_CHANCES - 1] +
                  0.6180340f * (float)(met - ABBE_EXIT_WALK_CHANCES + 1);
  return x - floorf(x);
}

static bool meets_place(const abbe_exit_start *start, const abbe_hit *hit) {
  float square = 0;
  for (int k = 0; k < 3; k++)
    square += (hit->p[k] - start->place[k]) * (hit->p[k] - start->place[k]);
  return square < near_place * near_place;
}

void abbe_exit_walk(const abbe_exit_space *space, const abbe_exit_start *start,
                    abbe_exit_end *end) {
  walk w = {.space = space, .step = start->step, .carried = 1, .facets = 2166136261u};
  *end = (abbe_exit_end){0};
  memcpy(w.d, start->way, sizeof w.d);
  for (int k = 0; k < 3; k++) w.o[k] = start->place[k] - before * start->way[k];
  for (size_t met = 0; met <= ABBE_EXIT_WALK_MOST; met++) {
    abbe_hit hit;
    if (!abbe_geometry_hit(space->geometry, ABBE_GEOMETRY_SPECULAR, w.o, w.d, INFINITY, &hit)) {
      if (met == 0 || w.inside) return;
      memcpy(end->place, w.o, sizeof end->place);
      memcpy(end->way, w.d, sizeof end->way);
      end->carried = w.carried;
      end->facets = w.facets;
      return;
    }
    if (met == 0 && !meets_place(start, &hit)) return;
    if (w.inside) {
      float way[3];
      for (int k = 0; k < 3; k++) way[k] = hit.p[k] - w.o[k];
      const float attenuation =
          abbe_media_attenuation(space->media, (int)hit.surface->index, start->step, 0.5f);
      w.carried *= expf(-attenuation * sqrtf(dot(way, way)));
    }
    if (hit.surface->kind == ABBE_GEOMETRY_MIRRORS)
      meet_mirror(&w, &hit);
    else
      meet_interface(&w, &hit, decide(start, met));
  }
}
