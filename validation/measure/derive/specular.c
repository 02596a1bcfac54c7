#include "validation/measure/derive/specular.h"

#include "base/maths.h"
#include "spectral/optics.h"

#include <math.h>
#include <string.h>

/* A path begins this share of its surroundings' size off the face that it leaves. */
#define LEAVE 1e-10
/* Paths with less of the light than that end. */
#define FAINT 1e-4

/* ---- the nearest surface on a ray ---- */

typedef struct meeting {
  double t, n[3]; /* the normal outwards, or the face's */
  uint32_t object, face;
} meeting;

static void meet_sphere(const abbe_exact *e, const double o[3], const double d[3], bool inside,
                        double least, meeting *m) {
  double r[3];
  abbe_vector_subtract(o, e->centre, r);
  const double along = abbe_vector_dot(r, d);
  double off[3];
  for (int k = 0; k < 3; k++) off[k] = r[k] - along * d[k];
  const double square = e->radius * e->radius - abbe_vector_dot(off, off);
  if (square <= 0 || (!inside && along >= 0)) return;
  const double t = inside ? -along + sqrt(square) : -along - sqrt(square);
  if (!(t > (inside ? 0 : least)) || t >= m->t) return;
  m->t = t;
  m->face = 0;
  for (int k = 0; k < 3; k++) m->n[k] = (r[k] + t * d[k]) / e->radius;
}

static void meet_planes(const abbe_specular_surface *s, const double o[3], const double d[3],
                        bool inside, double least, meeting *m) {
  double in = -INFINITY, out = INFINITY;
  size_t face_in = 0, face_out = 0;
  for (size_t i = 0; i < s->object->exact.count; i++) {
    const double *n = s->object->exact.plane[i];
    const double along = abbe_vector_dot(n, d), above = abbe_vector_dot(n, o) - n[3];
    if (along == 0) {
      if (above > 0 && !inside) return;
      continue;
    }
    const double t = -above / along;
    if (along > 0 && t < out) out = t, face_out = i;
    if (along < 0 && t > in) in = t, face_in = i;
  }
  if (!inside && (in >= out || in <= least)) return;
  const double t = inside ? fmax(out, 0) : in;
  if (t >= m->t) return;
  m->t = t;
  memcpy(m->n, s->object->exact.plane[inside ? face_out : face_in], sizeof m->n);
  m->face = s->plane[inside ? face_out : face_in];
}

static void meet_triangles(const abbe_specular_surface *s, const double o[3], const double d[3],
                           double least, meeting *m) {
  const abbe_mesh *mesh = &s->object->mesh;
  abbe_bvh_hit hit;
  if (!abbe_bvh_trace(&s->bvh, (const double(*)[9])s->triangle, o, d, 0, least, m->t, &hit)) return;
  const uint32_t *v = mesh->face[hit.index];
  m->t = hit.t;
  const bool receiver = abbe_object_kind_of(s->object) == ABBE_OBJECT_RECEIVER;
  const bool whole = receiver ? mesh->face_count <= 2 : !s->flat;
  m->face = whole ? 0 : (uint32_t)hit.index;
  for (int k = 0; k < 3; k++)
    m->n[k] = (1 - hit.u - hit.v) * mesh->normal[v[0]][k] + hit.u * mesh->normal[v[1]][k] +
              hit.v * mesh->normal[v[2]][k];
  abbe_vector_normalise(m->n);
}

static bool meet(const abbe_specular *s, const double o[3], const double d[3], uint64_t inside,
                 bool receivers_alone, meeting *m) {
  const double least = LEAVE * s->far;
  m->t = 4 * s->far;
  bool any = false;
  for (size_t i = 0; i < s->count; i++) {
    const abbe_specular_surface *of = &s->surface[i];
    const abbe_object_kind kind = abbe_object_kind_of(of->object);
    const bool within = kind == ABBE_OBJECT_REFRACTOR && (inside >> of->refractor & 1) != 0;
    const double before = m->t;
    if (receivers_alone && kind != ABBE_OBJECT_RECEIVER) continue;
    if (of->object->exact.kind == ABBE_EXACT_SPHERE)
      meet_sphere(&of->object->exact, o, d, within, least, m);
    else if (abbe_specular_has_planes(of))
      meet_planes(of, o, d, within, least, m);
    else
      meet_triangles(of, o, d, least, m);
    if (m->t < before) m->object = (uint32_t)i, any = true;
  }
  return any;
}

/* ---- paths ---- */

typedef struct path {
  double o[3], d[3], flux;
  uint64_t inside; /* refractors that it is in, a bit each */
  size_t met;
} path;

typedef struct walk {
  const abbe_specular *s;
  const abbe_specular_wave *wave;
  size_t interfaces, waiting;
  path stack[2 * ABBE_SPECULAR_MOST_INTERFACES];
  double faint;
  double origin[3]; /* of the light, where it is near */
  abbe_specular_tree *out;
} walk;

static void sign(walk *w, uint64_t what) {
  uint64_t x = (w->out->signature ^ what) * 0x9e3779b97f4a7c15u;
  w->out->signature = x ^ (x >> 29);
}

/* The refractor that counts among those that a place is in: the later object. */
static int medium_of(uint64_t inside) {
  return inside != 0 ? 63 - __builtin_clzll(inside) : -1;
}

static void push(walk *w, const path *p) {
  if (!(p->flux > 0)) return;
  const bool ends = p->flux < w->faint || p->met >= w->interfaces ||
                    w->waiting == sizeof w->stack / sizeof *w->stack;
  sign(w, ends);
  if (ends)
    w->out->left += p->flux;
  else
    w->stack[w->waiting++] = *p;
}

/* Whether a receiver stands between the light and the place, so that its map has no room for it. */
static bool is_hidden(const walk *w, const double p[3], uint32_t object) {
  const abbe_specular *s = w->s;
  double o[3], d[3];
  meeting m;
  if (s->light->kind == ABBE_LIGHT_DIRECTIONAL) {
    memcpy(d, s->light->direction, sizeof d);
    for (int k = 0; k < 3; k++) o[k] = p[k] - s->far * d[k];
  } else {
    memcpy(o, w->origin, sizeof o);
    abbe_vector_subtract(p, o, d);
    if (!abbe_vector_normalise(d)) return false;
  }
  double way[3];
  abbe_vector_subtract(p, o, way);
  return meet(s, o, d, 0, true, &m) && m.object != object &&
         m.t < abbe_vector_length(way) - LEAVE * s->far;
}

static void land(walk *w, const path *p, const meeting *m) {
  abbe_specular_tree *t = w->out;
  sign(w, 3 + m->object * 64 + ((uint64_t)m->face << 32));
  if (p->met == 0 || t->count == ABBE_SPECULAR_HITS) return;
  abbe_specular_hit *hit = &t->hit[t->count];
  for (int k = 0; k < 3; k++) hit->p[k] = p->o[k] + m->t * p->d[k];
  const bool hidden = is_hidden(w, hit->p, m->object);
  sign(w, hidden);
  if (hidden) return;
  memcpy(hit->d, p->d, sizeof hit->d);
  hit->flux = p->flux;
  hit->object = m->object;
  t->count++;
}

static double mirrored(const walk *w, const abbe_object *o, double cosine) {
  double n = 0, k = 0;
  if (o->conductor == NULL) return o->mirror_reflectance;
  abbe_dispersion_nk(&o->conductor->dispersion, w->wave->lambda_nm, &n, &k);
  return abbe_optics_fresnel_conductor(cosine, n, k);
}

/* d + 2 cosine n */
static void reflect(const double d[3], const double n[3], double cosine, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = d[k] + 2 * cosine * n[k];
}

static void interface(walk *w, path *p, const meeting *m, const double n[3], double cosine) {
  const uint32_t bit = w->s->surface[m->object].refractor;
  const uint64_t beyond = p->inside ^ (uint64_t)1 << bit;
  const int from = medium_of(p->inside), to = medium_of(beyond);
  path next = *p;
  next.inside = beyond;
  if (from == to) { /* within a later object: nothing is there */
    w->stack[w->waiting++] = next;
    return;
  }
  const double eta = (from < 0 ? 1 : w->wave->n[from]) / (to < 0 ? 1 : w->wave->n[to]);
  const double share = abbe_optics_fresnel(cosine, eta);
  const double towards[3] = {-p->d[0], -p->d[1], -p->d[2]};
  sign(w, 5 + m->object * 64 + ((uint64_t)m->face << 32));
  next.met = p->met + 1;
  next.flux = p->flux * (1 - share);
  if (share < 1 && abbe_optics_refract(towards, n, eta, next.d)) push(w, &next);
  next = *p;
  next.met = p->met + 1;
  next.flux = p->flux * share;
  reflect(p->d, n, cosine, next.d);
  push(w, &next);
}

static void step(walk *w, path *p) {
  meeting m;
  if (!meet(w->s, p->o, p->d, p->inside, false, &m)) {
    sign(w, 2);
    return;
  }
  const abbe_object *o = w->s->surface[m.object].object;
  const abbe_object_kind kind = abbe_object_kind_of(o);
  const int medium = medium_of(p->inside);
  if (medium >= 0) p->flux *= exp(-w->wave->a[medium] * m.t);
  if (kind == ABBE_OBJECT_RECEIVER) {
    land(w, p, &m);
    return;
  }
  double n[3], cosine = -abbe_vector_dot(m.n, p->d);
  const double side = cosine < 0 ? -1 : 1;
  for (int k = 0; k < 3; k++) {
    n[k] = side * m.n[k];
    p->o[k] += m.t * p->d[k];
  }
  cosine = fmin(fabs(cosine), 1);
  if (kind == ABBE_OBJECT_REFRACTOR) {
    interface(w, p, &m, n, cosine);
    return;
  }
  sign(w, 7 + m.object * 64 + ((uint64_t)m.face << 32));
  p->met++;
  p->flux *= mirrored(w, o, cosine);
  reflect(p->d, n, cosine, p->d);
  push(w, p);
}

/* The window's axes, at right angles to where the light goes. */
static void turn(const abbe_specular *s, const double along[3], double x[3], double y[3]) {
  const double off = abbe_vector_dot(s->across, along);
  for (int k = 0; k < 3; k++) x[k] = s->across[k] - off * along[k];
  abbe_vector_normalise(x);
  abbe_vector_cross(along, x, y);
}

static void place_on(const abbe_light *l, const double at[2], double out[3]) {
  double x[3], y[3];
  memcpy(out, l->position, sizeof x);
  if (l->kind == ABBE_LIGHT_DISK) {
    abbe_light_upright(l->direction, x, y);
    const double r = l->radius * sqrt(at[0]), phi = 2 * ABBE_PI * at[1];
    for (int k = 0; k < 3; k++) out[k] += r * (cos(phi) * x[k] + sin(phi) * y[k]);
  } else if (l->kind == ABBE_LIGHT_RECTANGLE)
    for (int k = 0; k < 3; k++)
      out[k] += (2 * at[0] - 1) * l->edge[0][k] + (2 * at[1] - 1) * l->edge[1][k];
}

/* Sets out from that place of the light's window. */
static void emit(walk *w, const double at[4], path *p) {
  const abbe_specular *s = w->s;
  const abbe_light *l = s->light;
  double x[3], y[3], along[3];
  double side[2], share = 4; /* of the window, from -1 to 1 */
  for (int k = 0; k < 2; k++) {
    const double wide = s->window[k][1] - s->window[k][0];
    side[k] = 2 * (s->window[k][0] + wide * at[k]) - 1;
    share *= wide;
  }
  const double u = side[0], v = side[1];
  *p = (path){0};
  if (l->kind == ABBE_LIGHT_DIRECTIONAL) {
    turn(s, l->direction, x, y);
    for (int k = 0; k < 3; k++) {
      p->d[k] = l->direction[k];
      p->o[k] = s->centre[k] + s->radius * (u * x[k] + v * y[k]) - s->far * p->d[k];
    }
    p->flux = l->power * share * s->radius * s->radius;
    return;
  }
  place_on(l, at + 2, p->o);
  memcpy(w->origin, l->position, sizeof w->origin);
  abbe_vector_subtract(s->centre, p->o, along);
  const double away = abbe_vector_length(along);
  const double tangent = s->radius / sqrt(away * away - s->radius * s->radius);
  abbe_vector_normalise(along);
  turn(s, along, x, y);
  for (int k = 0; k < 3; k++) p->d[k] = along[k] + tangent * (u * x[k] + v * y[k]);
  const double length = abbe_vector_length(p->d);
  abbe_vector_normalise(p->d);
  const double area = abbe_light_has_size(l) ? abbe_light_area(l) : 1;
  const double profile = abbe_light_profile(l, p->d);
  p->flux = l->power * area * profile * share * tangent * tangent / (length * length * length);
  sign(w, profile > 0);
}

void abbe_specular_trace(const abbe_specular *s, const abbe_specular_wave *wave, const double at[4],
                         size_t interfaces, abbe_specular_tree *out) {
  walk w = {.s = s, .wave = wave, .interfaces = interfaces, .out = out};
  path p;
  out->count = 0;
  out->signature = 0;
  out->left = 0;
  emit(&w, at, &p);
  w.faint = FAINT * p.flux;
  if (p.flux > 0) w.stack[w.waiting++] = p;
  for (size_t steps = 0; w.waiting > 0 && steps < 4096; steps++) {
    p = w.stack[--w.waiting];
    step(&w, &p);
  }
}

abbe_result abbe_specular_narrow(abbe_specular *s, double min_nm, double max_nm, size_t interfaces,
                                 abbe_error *error) {
  enum { SIDE = 256, COLOURS = 8 };
  abbe_specular_wave wave[COLOURS];
  abbe_specular_tree tree;
  double low[2] = {1, 1}, high[2] = {0, 0};
  for (int i = 0; i < COLOURS; i++)
    ABBE_TRY(abbe_specular_wave_make(s, min_nm + (max_nm - min_nm) * i / (COLOURS - 1), &wave[i],
                                     error));
  for (int i = 0; i < SIDE * SIDE; i++) {
    /* places on the light and colours by multiples of irrational numbers */
    const double at[4] = {(i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE,
                          fmod(i * 0.7548776662466927, 1), fmod(i * 0.5698402909980532, 1)};
    abbe_specular_trace(s, &wave[(i + i / SIDE) % COLOURS], at, interfaces, &tree);
    for (int k = 0; k < 2 && tree.count > 0; k++) {
      low[k] = fmin(low[k], at[k]);
      high[k] = fmax(high[k], at[k]);
    }
  }
  for (int k = 0; k < 2 && low[k] <= high[k]; k++) {
    s->window[k][0] = fmax(low[k] - 2.0 / SIDE, 0);
    s->window[k][1] = fmin(high[k] + 2.0 / SIDE, 1);
  }
  return ABBE_OK;
}
