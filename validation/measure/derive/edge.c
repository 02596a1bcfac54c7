#include "validation/measure/derive/line.h"
#include "validation/measure/derive/specular_meet.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

typedef struct ray {
  double o[3], d[3];
  uint64_t inside;
  uint32_t object, face;
} ray;

static ray ray_of_step(const abbe_specular_step *s) {
  ray r = {.inside = s->inside, .object = s->object, .face = s->face};
  memcpy(r.o, s->o, sizeof r.o);
  memcpy(r.d, s->d, sizeof r.d);
  return r;
}

static ray ray_of_shadow(const abbe_specular_shadow *s) {
  ray r = {.object = s->object, .face = s->face};
  memcpy(r.o, s->o, sizeof r.o);
  memcpy(r.d, s->d, sizeof r.d);
  return r;
}

static double way_to(const abbe_specular *s, const ray *r) {
  abbe_meeting m;
  return abbe_specular_meet_face(s, r->object, r->face, r->o, r->d, r->inside, &m) ? m.t : INFINITY;
}

/* The side of a triangle or of a light beyond which the ray lies. */
static int side_beyond(const abbe_specular *s, uint32_t object, uint32_t face, const ray *past) {
  abbe_meeting m;
  if (!abbe_specular_meet_face(s, object, face, past->o, past->d, past->inside, &m)) return 0;
  if (object >= ABBE_SPECULAR_LAMP) return fabs(m.side[0]) > fabs(m.side[1]) ? 0 : 1;
  const double third = 1 - m.side[0] - m.side[1];
  if (third < m.side[0] && third < m.side[1]) return 2;
  return m.side[0] < m.side[1] ? 0 : 1;
}

/* Of an object that one ray meets and another misses. */
static void outline(const abbe_specular *s, const ray *met, const ray *past, abbe_edge *e) {
  e->object[0] = e->object[1] = met->object;
  e->face[0] = e->face[1] = met->face;
  if (met->object >= ABBE_SPECULAR_LAMP) {
    e->kind = ABBE_EDGE_LAMP;
    e->side = side_beyond(s, met->object, 0, past);
    return;
  }
  const abbe_specular_surface *of = &s->surface[met->object];
  double t[2];
  if (of->object->exact.kind == ABBE_EXACT_SPHERE)
    e->kind = ABBE_EDGE_OUTLINE;
  else if (abbe_specular_has_planes(of)) {
    e->kind = ABBE_EDGE_CROSSING;
    abbe_specular_cross(of, met->o, met->d, t, e->face);
  } else {
    e->kind = ABBE_EDGE_SIDE;
    e->side = side_beyond(s, met->object, met->face, past);
  }
}

static void between_rays(const abbe_specular *s, const ray *a, const ray *b, abbe_edge *e) {
  const double to_a = way_to(s, a), to_b = way_to(s, b);
  const bool same = a->object == b->object && a->object < ABBE_SPECULAR_LAMP;
  if (same && s->surface[a->object].triangle != NULL) {
    outline(s, a, b, e);
  } else if (same || fabs(to_a - to_b) < 1e-6 * s->far) {
    e->kind = ABBE_EDGE_CROSSING;
    e->object[0] = a->object;
    e->object[1] = b->object;
    e->face[0] = a->face;
    e->face[1] = b->face;
  } else if (to_a < to_b)
    outline(s, a, b, e);
  else
    outline(s, b, a, e);
}

/* In a corner a path may leave one surface nearer to another than rays begin: what jumps there is
 * which of the two is met first. */
static bool is_corner(const abbe_specular *s, const abbe_specular_step *from, const ray *to,
                      abbe_edge *e) {
  if (to->object >= ABBE_SPECULAR_LAMP || way_to(s, to) > 2 * ABBE_SPECULAR_LEAVE * s->far)
    return false;
  e->kind = ABBE_EDGE_CROSSING;
  e->object[0] = from->object;
  e->object[1] = to->object;
  e->face[0] = from->face;
  e->face[1] = to->face;
  return true;
}

/* ---- two trees side by side ---- */

typedef struct comparison {
  const abbe_specular *s;
  const abbe_specular_tree *tree[2];
  size_t next[2];
  double flux, most; /* of all paths that differ, and of the one that is the edge */
  size_t at[2];      /* the edge's steps */
} comparison;

/* Everything behind a step that the other tree has no like of. */
static void skip(comparison *c, int side) {
  const abbe_specular_tree *t = c->tree[side];
  if (c->next[side] >= t->steps) return;
  const unsigned on = t->step[c->next[side]++].on;
  for (int i = __builtin_popcount(on); i > 0; i--) skip(c, side);
}

/* A step of both, and what is behind it, in the order in which paths are followed. */
static void compare(comparison *c) {
  static const uint8_t hows[] = {ABBE_SPECULAR_PASSED, ABBE_SPECULAR_REFLECTED,
                                 ABBE_SPECULAR_REFRACTED};
  if (c->next[0] >= c->tree[0]->steps || c->next[1] >= c->tree[1]->steps) return;
  const abbe_specular_step *a = &c->tree[0]->step[c->next[0]], *b = &c->tree[1]->step[c->next[1]];
  if (a->object != b->object || abbe_specular_face(c->s, a->object, a->face) !=
                                    abbe_specular_face(c->s, b->object, b->face)) {
    const double flux = fmax(a->flux, b->flux);
    c->flux += flux;
    if (flux > c->most) {
      c->most = flux;
      for (int i = 0; i < 2; i++) c->at[i] = c->next[i];
    }
    for (int i = 0; i < 2; i++) skip(c, i);
    return;
  }
  const uint8_t on[2] = {a->on, b->on};
  for (int i = 0; i < 2; i++) c->next[i]++;
  for (int i = 0; i < 3; i++) {
    if ((on[0] & on[1] & hows[i]) != 0) {
      compare(c);
    } else if (((on[0] ^ on[1]) & hows[i]) != 0) {
      const int side = (on[1] & hows[i]) != 0;
      const size_t next = c->next[side];
      if (next < c->tree[side]->steps) c->flux += c->tree[side]->step[next].flux;
      skip(c, side);
    }
  }
}

static void compare_shadows(const comparison *c, abbe_edge *e) {
  const abbe_specular_tree *below = c->tree[0], *above = c->tree[1];
  double most = 0;
  for (size_t i = 0; i < below->shadows && i < above->shadows; i++) {
    const ray a = ray_of_shadow(&below->shadow[i]), b = ray_of_shadow(&above->shadow[i]);
    const bool hidden[2] = {a.object != ABBE_SPECULAR_NOTHING, b.object != ABBE_SPECULAR_NOTHING};
    if (hidden[0] == hidden[1]) continue;
    const double flux = fmax(below->shadow[i].flux, above->shadow[i].flux);
    e->flux += flux;
    if (!(flux > most)) continue;
    most = flux;
    e->index = i;
    e->shadow = true;
    outline(c->s, hidden[0] ? &a : &b, hidden[0] ? &b : &a, e);
  }
}

abbe_edge abbe_edge_between(const abbe_specular *s, const abbe_specular_tree *below,
                            const abbe_specular_tree *above) {
  abbe_edge e = {.kind = ABBE_EDGE_NONE, .flux = INFINITY};
  if (!below->whole || !above->whole) return e;
  comparison c = {.s = s, .tree = {below, above}};
  while (c.next[0] < below->steps && c.next[1] < above->steps) compare(&c);
  e.flux = c.flux;
  if (c.most > 0) {
    const ray a = ray_of_step(&below->step[c.at[0]]), b = ray_of_step(&above->step[c.at[1]]);
    const uint32_t from = below->step[c.at[0]].from;
    if (from != ABBE_SPECULAR_NOTHING &&
        (is_corner(s, &below->step[from], &a, &e) || is_corner(s, &below->step[from], &b, &e))) {
      e.index = from;
      return e;
    }
    e.index = c.at[0];
    between_rays(s, &a, &b, &e);
    return e;
  }
  compare_shadows(&c, &e);
  if (e.kind != ABBE_EDGE_NONE) return e;
  if (c.next[0] < below->steps || c.next[1] < above->steps)
    e.flux = INFINITY;
  else
    e.kind = ABBE_EDGE_FAINT;
  return e;
}

static double sphere_value(const abbe_exact *e, const ray *r) {
  double off[3];
  abbe_vector_subtract(r->o, e->centre, off);
  const double along = abbe_vector_dot(off, r->d);
  return e->radius * e->radius - (abbe_vector_dot(off, off) - along * along);
}

double abbe_edge_value(const abbe_specular *s, const abbe_edge *e, const abbe_specular_tree *tree) {
  /* The ray to a step that fails is there, and no more. */
  if (e->shadow ? e->index >= tree->shadows
                : e->index > tree->steps || (e->index == tree->steps && !tree->failed))
    return NAN;
  const ray r =
      e->shadow ? ray_of_shadow(&tree->shadow[e->index]) : ray_of_step(&tree->step[e->index]);
  if (e->kind == ABBE_EDGE_OUTLINE)
    return sphere_value(&s->surface[e->object[0]].object->exact, &r);
  abbe_meeting m[2];
  for (int i = 0; i < 2; i++)
    if (!abbe_specular_meet_face(s, e->object[i], e->face[i], r.o, r.d, r.inside, &m[i]))
      return NAN;
  switch (e->kind) {
  case ABBE_EDGE_CROSSING:
    return m[0].t - m[1].t;
  case ABBE_EDGE_SIDE:
    return e->side == 2 ? 1 - m[0].side[0] - m[0].side[1] : m[0].side[e->side];
  case ABBE_EDGE_LAMP:
    if (s->scene->light[e->object[0] - ABBE_SPECULAR_LAMP].kind == ABBE_LIGHT_DISK)
      return 1 - m[0].side[0] * m[0].side[0] - m[0].side[1] * m[0].side[1];
    return 1 - fabs(m[0].side[e->side]);
  default:
    return NAN;
  }
}
