#include "validation/measure/derive/specular.h"

#include "base/maths.h"
#include "spectral/optics.h"
#include "validation/measure/derive/specular_meet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Paths with less of the light than that end. */
#define FAINT 1e-4

/* ---- paths ---- */

typedef struct path {
  double o[3], d[3], flux;
  uint64_t inside; /* refractors that it is in, a bit each */
  size_t met;
  uint32_t from; /* its last step */
  uint8_t how;   /* what it did there */
} path;

typedef struct walk {
  const abbe_specular *s;
  const abbe_specular_wave *wave;
  const abbe_specular_tree *known; /* or NULL */
  size_t interfaces, waiting;
  path stack[2 * ABBE_SPECULAR_MOST_INTERFACES];
  bool seen; /* paths of the camera */
  uint16_t root;
  abbe_specular_tree *out;
} walk;

enum {
  REFRACTED = ABBE_SPECULAR_REFRACTED,
  REFLECTED = ABBE_SPECULAR_REFLECTED,
  PASSED = ABBE_SPECULAR_PASSED
};

/* The refractor that counts among those that a place is in: the later object. */
static int medium_of(uint64_t inside) {
  return inside != 0 ? 63 - __builtin_clzll(inside) : -1;
}

static void push(walk *w, const path *p, uint8_t how) {
  const size_t last = w->out->steps - 1;
  abbe_specular_step *from = &w->out->step[last];
  if (how == PASSED) {
    from->on |= how;
  } else if (w->known == NULL) {
    if (!(p->flux > 0)) return;
    const bool ends = p->flux < w->out->faint || p->met >= w->interfaces ||
                      w->waiting == sizeof w->stack / sizeof *w->stack;
    abbe_specular_sign(w->out, ends);
    from->on |= ends ? 0 : how;
  } else
    from->on |= w->known->step[last].on & how;
  if ((from->on & how) == 0) {
    w->out->left += p->flux;
    return;
  }
  path *to = &w->stack[w->waiting++];
  *to = *p;
  to->from = (uint32_t)last;
  to->how = how;
}

bool abbe_specular_hides(const abbe_specular *s, abbe_specular_what what, const double o[3],
                         const double d[3], uint64_t inside, double limit, uint32_t but,
                         const abbe_specular_tree *known, abbe_specular_tree *tree) {
  abbe_meeting m = {.object = ABBE_SPECULAR_NOTHING};
  const size_t i = tree->shadows;
  if (known != NULL && i < known->shadows && !known->checks) {
    m.object = known->shadow[i].object;
    m.face = known->shadow[i].face;
  } else if (limit > 0) {
    abbe_specular_meet(s, o, d, inside, what == ABBE_SPECULAR_RECEIVERS, but,
                       what == ABBE_SPECULAR_ALL, &m);
    if (m.t >= limit - ABBE_SPECULAR_LEAVE * s->far) m.object = ABBE_SPECULAR_NOTHING;
  }
  const bool hidden = m.object != ABBE_SPECULAR_NOTHING;
  if (limit > 0) abbe_specular_sign(tree, hidden);
  if (i == ABBE_SPECULAR_SHADOWS) {
    tree->whole = false;
    return hidden;
  }
  abbe_specular_shadow *to = &tree->shadow[tree->shadows++];
  memcpy(to->o, o, sizeof to->o);
  memcpy(to->d, d, sizeof to->d);
  to->flux = tree->lit;
  to->object = m.object;
  to->face = m.face;
  if (known != NULL && known->checks && i < known->shadows)
    tree->failed |= hidden != (known->shadow[i].object != ABBE_SPECULAR_NOTHING);
  return hidden;
}

bool abbe_specular_is_dark(const abbe_specular *s, const double p[3], uint32_t object,
                           const abbe_specular_tree *known, abbe_specular_tree *tree) {
  double o[3], d[3], way[3];
  if (s->light->kind == ABBE_LIGHT_DIRECTIONAL) {
    memcpy(d, s->light->direction, sizeof d);
    for (int k = 0; k < 3; k++) o[k] = p[k] - s->far * d[k];
  } else {
    memcpy(o, s->light->position, sizeof o);
    abbe_vector_subtract(p, o, d);
    if (!abbe_vector_normalise(d)) return false;
  }
  abbe_vector_subtract(p, o, way);
  return abbe_specular_hides(s, ABBE_SPECULAR_RECEIVERS, o, d, 0, abbe_vector_length(way), object,
                             known, tree);
}

static void land(walk *w, const path *p, const abbe_meeting *m) {
  abbe_specular_tree *t = w->out;
  if (p->met == 0 && !w->seen) return;
  if (t->count == ABBE_SPECULAR_HITS) {
    t->left += p->flux;
    return;
  }
  abbe_specular_hit *hit = &t->hit[t->count];
  *hit = (abbe_specular_hit){.flux = p->flux,
                             .inside = p->inside,
                             .object = m->object,
                             .face = m->face,
                             .met = (uint16_t)p->met,
                             .root = w->root};
  for (int k = 0; k < 3; k++) hit->p[k] = p->o[k] + (isfinite(m->t) ? m->t : 0) * p->d[k];
  memcpy(hit->d, p->d, sizeof hit->d);
  memcpy(hit->n, m->n, sizeof hit->n);
  memcpy(hit->side, m->side, sizeof hit->side);
  t->lit = p->flux;
  if (!w->seen && abbe_specular_is_dark(w->s, hit->p, m->object, w->known, t)) return;
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

static void interface(walk *w, path *p, const abbe_meeting *m, const double n[3], double cosine) {
  const uint32_t bit = w->s->surface[m->object].refractor;
  const uint64_t beyond = p->inside ^ (uint64_t)1 << bit;
  const int from = medium_of(p->inside), to = medium_of(beyond);
  path next = *p;
  next.inside = beyond;
  if (from == to) { /* within a later object: nothing is there */
    push(w, &next, PASSED);
    return;
  }
  const double eta = (from < 0 ? 1 : w->wave->n[from]) / (to < 0 ? 1 : w->wave->n[to]);
  const double share = abbe_optics_fresnel(cosine, eta);
  const double towards[3] = {-p->d[0], -p->d[1], -p->d[2]};
  next.met = p->met + 1;
  next.flux = p->flux * (1 - share);
  if (share < 1 && abbe_optics_refract(towards, n, eta, next.d))
    push(w, &next, REFRACTED);
  else if (w->known != NULL && (w->known->step[w->out->steps - 1].on & REFRACTED) != 0)
    w->out->failed = true;
  next = *p;
  next.met = p->met + 1;
  next.flux = p->flux * share;
  reflect(p->d, n, cosine, next.d);
  push(w, &next, REFLECTED);
}

/* The next surface, among the steps; false where no path goes on. */
static bool find_next(walk *w, const path *p, abbe_meeting *m) {
  abbe_specular_tree *t = w->out;
  const size_t i = t->steps;
  if (i == ABBE_SPECULAR_STEPS) {
    t->whole = false;
    t->left += p->flux;
    return false;
  }
  abbe_specular_step *step = &t->step[i];
  memcpy(step->o, p->o, sizeof step->o);
  memcpy(step->d, p->d, sizeof step->d);
  step->flux = p->flux;
  step->inside = p->inside;
  step->from = p->from;
  step->root = w->root;
  step->how = p->how;
  if (w->known == NULL || w->known->checks)
    abbe_specular_meet(w->s, p->o, p->d, p->inside, false, ABBE_SPECULAR_NOTHING, w->seen, m);
  else if (i >= w->known->steps ||
           !abbe_specular_meet_face(w->s, w->known->step[i].object, w->known->step[i].face, p->o,
                                    p->d, p->inside, m)) {
    t->failed = true;
    return false;
  }
  t->steps++;
  step->object = m->object;
  step->face = m->face;
  step->on = 0;
  const uint64_t face = abbe_specular_face(w->s, m->object, m->face);
  abbe_specular_sign(t, 3 + (uint64_t)m->object * 64 + (face << 40));
  if (w->known != NULL && w->known->checks)
    t->failed = i >= w->known->steps || w->known->step[i].object != m->object ||
                abbe_specular_face(w->s, m->object, w->known->step[i].face) != face;
  return !t->failed;
}

static void step(walk *w, path *p) {
  abbe_meeting m;
  if (!find_next(w, p, &m)) return;
  if (m.object >= ABBE_SPECULAR_LAMP) {
    if (w->seen) land(w, p, &m);
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
  p->met++;
  p->flux *= mirrored(w, o, cosine);
  reflect(p->d, n, cosine, p->d);
  push(w, p, REFLECTED);
}

/* Where the path goes from there, without its flux. */
static bool go_on(const walk *w, path *p, const abbe_meeting *m, uint8_t how) {
  const uint64_t bit = (uint64_t)1 << w->s->surface[m->object].refractor;
  const uint64_t beyond = p->inside ^ bit;
  const int from = medium_of(p->inside), to = medium_of(beyond);
  double n[3], cosine = -abbe_vector_dot(m->n, p->d);
  const double side = cosine < 0 ? -1 : 1;
  for (int k = 0; k < 3; k++) {
    n[k] = side * m->n[k];
    p->o[k] += m->t * p->d[k];
  }
  cosine = fmin(fabs(cosine), 1);
  if (how == REFLECTED) {
    reflect(p->d, n, cosine, p->d);
    return true;
  }
  p->inside = beyond;
  if (how == PASSED) return true;
  const double towards[3] = {-p->d[0], -p->d[1], -p->d[2]};
  const double eta = (from < 0 ? 1 : w->wave->n[from]) / (to < 0 ? 1 : w->wave->n[to]);
  return abbe_optics_refract(towards, n, eta, p->d);
}

/* The step `known` is followed until, by those before it on its path alone. */
static void follow_one(walk *w, path *p) {
  uint32_t chain[2 * ABBE_SPECULAR_MOST_INTERFACES + ABBE_SPECULAR_REFRACTORS];
  size_t count = 0;
  for (uint32_t i = (uint32_t)w->known->until; i != ABBE_SPECULAR_NOTHING;
       i = w->known->step[i].from) {
    if (count == sizeof chain / sizeof *chain) {
      w->out->failed = true;
      return;
    }
    chain[count++] = i;
  }
  while (count-- > 0) {
    const abbe_specular_step *known = &w->known->step[chain[count]];
    abbe_specular_step *to = &w->out->step[chain[count]];
    memcpy(to->o, p->o, sizeof to->o);
    memcpy(to->d, p->d, sizeof to->d);
    to->inside = p->inside;
    to->object = known->object;
    to->face = known->face;
    w->out->steps = chain[count] + 1;
    abbe_meeting m;
    if (count == 0) return;
    if (!abbe_specular_meet_face(w->s, known->object, known->face, p->o, p->d, p->inside, &m) ||
        !go_on(w, p, &m, w->known->step[chain[count - 1]].how)) {
      w->out->steps = chain[count]; /* no ray comes to the last one */
      w->out->failed = true;
      return;
    }
  }
}

/* Follows all paths that wait. */
static void follow(walk *w) {
  if (w->known != NULL && w->known->until < w->known->steps &&
      w->known->step[w->known->until].root == w->root && w->waiting > 0) {
    follow_one(w, &w->stack[--w->waiting]);
    w->waiting = 0;
  }
  while (w->waiting > 0 && !w->out->failed) {
    path p = w->stack[--w->waiting];
    step(w, &p);
  }
}

/* The window's axes, at right angles to where the light goes. */
static void turn(const abbe_specular *s, const double along[3], double x[3], double y[3]) {
  const double off = abbe_vector_dot(s->across, along);
  for (int k = 0; k < 3; k++) x[k] = s->across[k] - off * along[k];
  abbe_vector_normalise(x);
  abbe_vector_cross(along, x, y);
}

void abbe_specular_place_on(const abbe_light *l, const double at[2], double out[3]) {
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
  abbe_specular_place_on(l, at + 2, p->o);
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
  abbe_specular_sign(w->out, profile > 0);
}

static void clear(abbe_specular_tree *t) {
  t->count = t->steps = t->shadows = 0;
  t->signature = 0;
  t->left = t->lit = 0;
  memset(t->shown, 0, sizeof t->shown);
  t->whole = true;
  t->until = SIZE_MAX;
  t->checks = false;
  t->failed = false;
}

void abbe_specular_trace(const abbe_specular *s, const abbe_specular_wave *wave, const double at[4],
                         size_t interfaces, const abbe_specular_tree *known,
                         abbe_specular_tree *out) {
  walk w = {.s = s, .wave = wave, .interfaces = interfaces, .known = known, .out = out};
  path p;
  clear(out);
  memcpy(out->at, at, sizeof out->at);
  emit(&w, at, &p);
  out->faint = FAINT * p.flux;
  p.from = ABBE_SPECULAR_NOTHING;
  if (p.flux > 0) w.stack[w.waiting++] = p;
  follow(&w);
}

void abbe_specular_view(const abbe_specular *s, const abbe_specular_wave *wave, const double o[3],
                        const double d[3], uint64_t inside, uint16_t root, size_t interfaces,
                        const abbe_specular_tree *known, abbe_specular_tree *out) {
  walk w = {.s = s,
            .wave = wave,
            .interfaces = interfaces,
            .known = known,
            .seen = true,
            .root = root,
            .out = out};
  if (root == 0) clear(out);
  out->faint = FAINT;
  path p = {.flux = 1, .inside = inside, .from = ABBE_SPECULAR_NOTHING};
  memcpy(p.o, o, sizeof p.o);
  memcpy(p.d, d, sizeof p.d);
  w.stack[w.waiting++] = p;
  follow(&w);
}

abbe_result abbe_specular_narrow(abbe_specular *s, double min_nm, double max_nm, size_t interfaces,
                                 abbe_error *error) {
  enum { SIDE = 256, COLOURS = 8 };
  abbe_specular_wave wave[COLOURS];
  ABBE_FREED abbe_specular_tree *tree = malloc(sizeof *tree);
  double low[2] = {1, 1}, high[2] = {0, 0};
  if (tree == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for trial paths");
  for (int i = 0; i < COLOURS; i++)
    ABBE_TRY(abbe_specular_wave_make(s, min_nm + (max_nm - min_nm) * i / (COLOURS - 1), &wave[i],
                                     error));
  for (int k = 0; k < SIDE * SIDE; k++) {
    /* Far apart first: within what is known to be looked through there is nothing to find. */
    const int i = (int)((unsigned)k * 40503u % (SIDE * SIDE));
    /* places on the light and colours by multiples of irrational numbers */
    const double at[4] = {(i % SIDE + 0.5) / SIDE, (i / SIDE + 0.5) / SIDE,
                          fmod(i * 0.7548776662466927, 1), fmod(i * 0.5698402909980532, 1)};
    if (at[0] >= low[0] && at[0] <= high[0] && at[1] >= low[1] && at[1] <= high[1]) continue;
    abbe_specular_trace(s, &wave[(i + i / SIDE) % COLOURS], at, interfaces, NULL, tree);
    for (int axis = 0; axis < 2 && tree->count > 0; axis++) {
      low[axis] = fmin(low[axis], at[axis]);
      high[axis] = fmax(high[axis], at[axis]);
    }
  }
  for (int k = 0; k < 2 && low[k] <= high[k]; k++) {
    s->window[k][0] = fmax(low[k] - 2.0 / SIDE, 0);
    s->window[k][1] = fmin(high[k] + 2.0 / SIDE, 1);
  }
  return ABBE_OK;
}
