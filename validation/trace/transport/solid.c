#include "validation/trace/transport/solid.h"

#include "base/maths.h"
#include "validation/trace/transport/geometry.h"

#include <math.h>
#include <stdlib.h>

/* ---- which refractors ---- */

/* What a solid is held against; frame units. */
typedef struct body {
  const abbe_geometry *g;
  const abbe_surface *surface;
  const abbe_solid *solid; /* its planes or sphere */
  const abbe_object *object;
  double gap; /* least distance that separates it from others */
} body;

static const abbe_object *object_of(const abbe_geometry *g, const abbe_surface *s) {
  return &g->scene->object[s->object];
}

static bool boxes_apart(const double a_min[3], const double a_max[3], const double b_min[3],
                        const double b_max[3], double gap) {
  for (int k = 0; k < 3; k++)
    if (a_min[k] > b_max[k] + gap || b_min[k] > a_max[k] + gap) return true;
  return false;
}

static double from_box(const double min[3], const double max[3], const double p[3]) {
  double square = 0;
  for (int k = 0; k < 3; k++) {
    double off = fmax(fmax(min[k] - p[k], p[k] - max[k]), 0);
    square += off * off;
  }
  return sqrt(square);
}

/* All of n points beyond one plane of the solid, or beyond its sphere's box. */
static bool beyond_a_plane(const body *b, const double (*point)[3], size_t n, double radius) {
  const abbe_exact *e = &b->object->exact;
  for (size_t j = 0; e->kind == ABBE_EXACT_CONVEX && j < e->count; j++) {
    const double *plane = e->plane[j];
    bool all = true;
    for (size_t i = 0; i < n && all; i++)
      all = plane[0] * point[i][0] + plane[1] * point[i][1] + plane[2] * point[i][2] - plane[3] -
                radius >
            b->gap;
    if (all) return true;
  }
  return false;
}

/* All of the solid on one side of a triangle's plane. */
static bool beyond_triangle(const body *b, const double p[3][3]) {
  double u[3], v[3], n[3];
  for (int k = 0; k < 3; k++) {
    u[k] = p[1][k] - p[0][k];
    v[k] = p[2][k] - p[0][k];
  }
  for (int k = 0; k < 3; k++)
    n[k] = u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3];
  double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), least = INFINITY, most = -INFINITY;
  if (!(length > 0)) return false;
  const abbe_object *o = b->object;
  const bool sphere = b->solid->sphere;
  for (size_t i = 0; i < (sphere ? 1 : o->mesh.vertex_count); i++) {
    const double *x = sphere ? o->exact.centre : o->mesh.position[i];
    double at = 0;
    for (int k = 0; k < 3; k++) at += n[k] / length * (x[k] - p[0][k]);
    least = fmin(least, at);
    most = fmax(most, at);
  }
  const double radius = sphere ? o->exact.radius : 0;
  return least - radius > b->gap || most + radius < -b->gap;
}

static bool triangle_apart(const body *b, const double p[3][3]) {
  double min[3], max[3];
  for (int k = 0; k < 3; k++) {
    min[k] = fmin(p[0][k], fmin(p[1][k], p[2][k]));
    max[k] = fmax(p[0][k], fmax(p[1][k], p[2][k]));
  }
  const abbe_object *o = b->object;
  if (boxes_apart(o->min, o->max, min, max, b->gap)) return true;
  if (b->solid->sphere && from_box(min, max, o->exact.centre) > o->exact.radius + b->gap)
    return true;
  return beyond_a_plane(b, p, 3, 0) || beyond_triangle(b, p);
}

/* A receiver may stand around the solid; another refractor would be the medium there. */
static bool stands_apart(const body *b, const abbe_surface *other) {
  const abbe_object *o = object_of(b->g, other), *own = b->object;
  if (boxes_apart(own->min, own->max, o->min, o->max, b->gap)) return true;
  if (other->sphere) {
    if (b->solid->sphere) {
      double square = 0;
      for (int k = 0; k < 3; k++) square += pow(own->exact.centre[k] - o->exact.centre[k], 2);
      return sqrt(square) > own->exact.radius + o->exact.radius + b->gap;
    }
    return beyond_a_plane(b, (const double(*)[3]) & o->exact.centre, 1, o->exact.radius);
  }
  const abbe_mesh *m = &o->mesh;
  if (beyond_a_plane(b, (const double(*)[3])m->position, m->vertex_count, 0)) return true;
  if (other->kind == ABBE_GEOMETRY_REFRACTORS) return false;
  for (size_t i = 0; i < m->face_count; i++) {
    double p[3][3];
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) p[c][k] = m->position[m->face[i][c]][k];
    if (!triangle_apart(b, (const double(*)[3])p)) return false;
  }
  return true;
}

static bool is_alone(const body *b) {
  for (size_t i = 0; i < b->g->surface_count; i++) {
    const abbe_surface *other = &b->g->surface[i];
    if (other == b->surface || other->kind == ABBE_GEOMETRY_LAMPS) continue;
    if (!stands_apart(b, other)) return false;
  }
  return true;
}

static bool copy_planes(const abbe_geometry *g, const abbe_exact *e, abbe_solid *s) {
  size_t count = (e->count + ABBE_SOLID_LANES - 1) / ABBE_SOLID_LANES * ABBE_SOLID_LANES;
  float *room = aligned_alloc(64, 4 * count * sizeof *room);
  if (room == NULL) return false;
  for (int i = 0; i < 4; i++) s->plane[i] = room + (size_t)i * count;
  for (size_t j = 0; j < count; j++) {
    double off = j < e->count ? e->plane[j][3] : 0;
    for (int i = 0; i < 3; i++) {
      double n = j < e->count ? e->plane[j][i] : 0;
      off -= n * g->origin[i];
      s->plane[i][j] = (float)n;
    }
    s->plane[3][j] = j < e->count ? (float)(off / g->unit) : 1;
  }
  s->count = count;
  return true;
}

abbe_result abbe_solids_make(const abbe_geometry *g, abbe_solid **out, abbe_error *error) {
  abbe_solid *solids = calloc(g->refractor_count + 1, sizeof *solids);
  bool made = solids != NULL;
  for (size_t i = 0; i < g->surface_count && made; i++) {
    const abbe_surface *s = &g->surface[i];
    if (s->kind != ABBE_GEOMETRY_REFRACTORS) continue;
    const abbe_object *o = object_of(g, s);
    /* its planes say not which face is coated or rough */
    if (o->coatings != NULL || o->roughness != NULL) continue;
    abbe_solid *solid = &solids[s->index];
    body b = {.g = g, .surface = s, .solid = solid, .object = o};
    for (int k = 0; k < 3; k++)
      b.gap = fmax(b.gap, fmax(fabs(o->min[k] - g->origin[k]), fabs(o->max[k] - g->origin[k])));
    b.gap *= 8 * (double)ABBE_GEOMETRY_OFFSET;
    if (o->exact.kind == ABBE_EXACT_SPHERE) {
      solid->sphere = true;
      solid->sphere = is_alone(&b);
      for (int k = 0; k < 3; k++) solid->centre[k] = s->centre[k];
      solid->radius = s->radius;
    } else if (o->exact.kind == ABBE_EXACT_CONVEX && is_alone(&b)) {
      made = copy_planes(g, &o->exact, solid);
    }
  }
  *out = solids;
  if (made) return ABBE_OK;
  abbe_solids_free(solids, g->refractor_count);
  *out = NULL;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the planes of %zu refractors",
                        g->refractor_count);
}

void abbe_solids_free(abbe_solid *solids, size_t count) {
  for (size_t i = 0; solids != NULL && i < count; i++) free(solids[i].plane[0]);
  free(solids);
}

/* ---- rays ---- */

static float leave_sphere(const abbe_solid *s, const float o[3], const float d[3], float p[3],
                          float n[3]) {
  float r[3], b = 0, c = -s->radius * s->radius;
  for (int k = 0; k < 3; k++) {
    r[k] = o[k] - s->centre[k];
    b += r[k] * d[k];
    c += r[k] * r[k];
  }
  float root = b * b - c, t = sqrtf(root > 0 ? root : 0) - b;
  t = t > 0 ? t : 0;
  float square = 0;
  for (int k = 0; k < 3; k++) {
    n[k] = r[k] + t * d[k];
    square += n[k] * n[k];
  }
  float scale = 1 / sqrtf(square);
  for (int k = 0; k < 3; k++) {
    n[k] *= scale;
    p[k] = s->centre[k] + s->radius * n[k];
  }
  return t;
}

/* The nearest plane ahead, and its distance. Each lane has every sixteenth; off / ahead is compared
 * by products: both are above 0. */
SIDE_BY_SIDE static int nearest_plane(const abbe_solid *s, const float o[3], const float d[3],
                                      float *distance) {
  enum { LANES = ABBE_SOLID_LANES };
  const float *x = s->plane[0], *y = s->plane[1], *z = s->plane[2], *w = s->plane[3];
  const float ox = o[0], oy = o[1], oz = o[2], dx = d[0], dy = d[1], dz = d[2];
  float best[LANES], best_ahead[LANES], t[LANES];
  int at[LANES];
  for (int k = 0; k < LANES; k++) {
    best[k] = 1;
    best_ahead[k] = 0;
    at[k] = 0;
  }
  for (size_t j = 0; j < s->count; j += LANES)
    for (int k = 0; k < LANES; k++) {
      float ahead = x[j + k] * dx + y[j + k] * dy + z[j + k] * dz;
      float off = w[j + k] - (x[j + k] * ox + y[j + k] * oy + z[j + k] * oz);
      off = off > 0 ? off : 0;
      bool nearer = (ahead > 0) & (off * best_ahead[k] < best[k] * ahead);
      best[k] = nearer ? off : best[k];
      best_ahead[k] = nearer ? ahead : best_ahead[k];
      at[k] = nearer ? (int)j + k : at[k];
    }
  for (int k = 0; k < LANES; k++) t[k] = best[k] / best_ahead[k];
  for (int half = LANES / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) {
      bool nearer = t[k + half] < t[k];
      t[k] = nearer ? t[k + half] : t[k];
      at[k] = nearer ? at[k + half] : at[k];
    }
  *distance = t[0];
  return at[0];
}

float abbe_solid_leave(const abbe_solid *s, const float o[3], const float d[3], float p[3],
                       float n[3]) {
  if (s->sphere) return leave_sphere(s, o, d, p, n);
  float t;
  const int at = nearest_plane(s, o, d, &t);
  for (int k = 0; k < 3; k++) {
    n[k] = s->plane[k][at];
    p[k] = o[k] + t * d[k];
  }
  return t;
}
