#include "validation/trace/walks/inner_walk.h"

#include "base/maths.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/random.h"

#include <string.h>

enum { LANES = ABBE_SOLID_LANES, IDLE = -1 };
static const float least = 0.05f; /* share of its light, below which the roulette decides */

/* glibc's own, for many numbers side by side. */
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && defined(NDEBUG)
__attribute__((simd("notinbranch"))) extern float expf(float);
#endif

/* Sixteen paths, an array of a lane each. */
typedef struct lanes {
  __attribute__((aligned(64))) float p[3][LANES];
  float d[3][LANES], eta[LANES], attenuation[LANES], flux[LANES], full[LANES], y[LANES];
  uint32_t id[LANES], steps[LANES];
  /* for the bounce */
  float n[3][LANES], t[LANES], share[LANES], left[LANES];
  float absorbed[LANES], second[LANES];
  float out[3][LANES], from[3][LANES];
  int32_t reflects[LANES], looked_at[LANES];
} lanes;

/* Compares off / ahead by products: both are above 0. */
static inline __attribute__((always_inline)) void meet_planes(const abbe_solid *s, lanes *l) {
  float best[LANES], best_ahead[LANES], n[3][LANES];
  for (int k = 0; k < LANES; k++) {
    best[k] = 1;
    best_ahead[k] = n[0][k] = n[1][k] = n[2][k] = 0;
  }
  for (size_t j = 0; j < s->count; j++) {
    const float x = s->plane[0][j], y = s->plane[1][j], z = s->plane[2][j], w = s->plane[3][j];
    for (int k = 0; k < LANES; k++) {
      float ahead = x * l->d[0][k] + y * l->d[1][k] + z * l->d[2][k];
      float off = w - (x * l->p[0][k] + y * l->p[1][k] + z * l->p[2][k]);
      off = off > 0 ? off : 0;
      bool nearer = (ahead > 0) & (off * best_ahead[k] < best[k] * ahead);
      best[k] = nearer ? off : best[k];
      best_ahead[k] = nearer ? ahead : best_ahead[k];
      n[0][k] = nearer ? x : n[0][k];
      n[1][k] = nearer ? y : n[1][k];
      n[2][k] = nearer ? z : n[2][k];
    }
  }
  for (int k = 0; k < LANES; k++) {
    float t = best[k] / best_ahead[k];
    l->t[k] = t;
    for (int i = 0; i < 3; i++) {
      l->n[i][k] = n[i][k];
      l->p[i][k] += t * l->d[i][k];
    }
  }
}

static inline __attribute__((always_inline)) void meet_sphere(const abbe_solid *s, lanes *l) {
  const float radius = s->radius, x = s->centre[0], y = s->centre[1], z = s->centre[2];
  for (int k = 0; k < LANES; k++) {
    float a = l->p[0][k] - x, b = l->p[1][k] - y, c = l->p[2][k] - z;
    float along = a * l->d[0][k] + b * l->d[1][k] + c * l->d[2][k];
    float root = along * along + radius * radius - (a * a + b * b + c * c);
    float t = sqrtf(root > 0 ? root : 0) - along;
    t = t > 0 ? t : 0;
    a += t * l->d[0][k];
    b += t * l->d[1][k];
    c += t * l->d[2][k];
    float scale = 1 / sqrtf(a * a + b * b + c * c);
    l->t[k] = t;
    l->n[0][k] = a * scale;
    l->n[1][k] = b * scale;
    l->n[2][k] = c * scale;
    l->p[0][k] = x + radius * l->n[0][k];
    l->p[1][k] = y + radius * l->n[1][k];
    l->p[2][k] = z + radius * l->n[2][k];
  }
}

/* Absorption on the way. */
static inline __attribute__((always_inline)) void absorb(lanes *l) {
  for (int k = 0; k < LANES; k++) l->left[k] = expf(-l->attenuation[k] * l->t[k]);
  for (int k = 0; k < LANES; k++) {
    l->absorbed[k] += l->y[k] * l->flux[k] * (1 - l->left[k]);
    l->flux[k] *= l->left[k];
  }
}

/* Reflection and refraction at the face, and the number that decides. */
static inline __attribute__((always_inline)) void scatter(const abbe_inner_rules *r, float size,
                                                          lanes *l) {
  const uint32_t seed = r->seed, pass = r->pass;
  float chance[LANES];
  for (int k = 0; k < LANES; k++) {
    uint32_t step = l->steps[k], id = l->id[k], bits[4];
    uint32_t even =
        step == 1 ? id * abbe_even_ratio[1] + r->shift[1] : id * abbe_even_ratio[2] + r->shift[2];
    abbe_random_bits(id, step, pass, seed, bits);
    chance[k] = abbe_random_float(step < ABBE_EVEN_STEPS ? even : bits[0]);
  }
  for (int k = 0; k < LANES; k++) {
    float dx = l->d[0][k], dy = l->d[1][k], dz = l->d[2][k];
    float nx = l->n[0][k], ny = l->n[1][k], nz = l->n[2][k], eta = l->eta[k];
    float c = dx * nx + dy * ny + dz * nz, cos_t;
    c = c < 1 ? c : 1;
    float share = abbe_interface_reflectance(c, eta, &cos_t);
    int32_t reflects = chance[k] < share;
    l->share[k] = share;
    l->reflects[k] = reflects;
    l->second[k] = l->steps[k] == 1 ? (reflects ? share : 1 - share) : l->second[k];
    l->steps[k]++;
    float bend = cos_t - eta * c;
    float ox = eta * dx + bend * nx, oy = eta * dy + bend * ny, oz = eta * dz + bend * nz;
    float scale = 1 / sqrtf(ox * ox + oy * oy + oz * oz);
    l->out[0][k] = ox * scale;
    l->out[1][k] = oy * scale;
    l->out[2][k] = oz * scale;
    float far = size, px = l->p[0][k], py = l->p[1][k], pz = l->p[2][k];
    far = fabsf(px) > far ? fabsf(px) : far;
    far = fabsf(py) > far ? fabsf(py) : far;
    far = fabsf(pz) > far ? fabsf(pz) : far;
    float offset = far * ABBE_GEOMETRY_OFFSET;
    l->from[0][k] = px + offset * nx;
    l->from[1][k] = py + offset * ny;
    l->from[2][k] = pz + offset * nz;
    dx -= 2 * c * nx;
    dy -= 2 * c * ny;
    dz -= 2 * c * nz;
    scale = 1 / sqrtf(dx * dx + dy * dy + dz * dz);
    l->d[0][k] = dx * scale;
    l->d[1][k] = dy * scale;
    l->d[2][k] = dz * scale;
    l->looked_at[k] =
        !reflects | (l->flux[k] < least * l->full[k]) | (l->steps[k] >= ABBE_INNER_MAX_STEPS);
  }
}

SIDE_BY_SIDE static void bounce_planes(const abbe_solid *s, const abbe_inner_rules *r, bool absorbs,
                                       lanes *l) {
  meet_planes(s, l);
  if (absorbs) absorb(l);
  scatter(r, 0, l);
}

SIDE_BY_SIDE static void bounce_sphere(const abbe_solid *s, const abbe_inner_rules *r, bool absorbs,
                                       lanes *l) {
  meet_sphere(s, l);
  if (absorbs) absorb(l);
  scatter(r, s->radius, l);
}

/* ---- lanes and paths ---- */

typedef struct walk {
  const abbe_inner_rules *rules;
  abbe_inner_path *path;
  size_t count, next;
  abbe_light_ledger *ledger;
  lanes lanes;
  int owner[LANES]; /* the path of each lane, or IDLE */
  size_t active;
  bool absorbs;
} walk;

static void put(walk *w, size_t k) {
  lanes *l = &w->lanes;
  if (w->next == w->count) {
    w->owner[k] = IDLE;
    l->y[k] = l->attenuation[k] = 0;
    l->steps[k] = 1;
    return;
  }
  const abbe_inner_path *p = &w->path[w->next];
  w->owner[k] = (int)w->next++;
  w->active++;
  for (int i = 0; i < 3; i++) {
    l->p[i][k] = p->p[i];
    l->d[i][k] = p->d[i];
  }
  l->eta[k] = p->eta;
  l->attenuation[k] = p->attenuation;
  l->flux[k] = p->flux;
  l->full[k] = p->full;
  l->y[k] = p->y;
  l->id[k] = p->id;
  l->steps[k] = p->steps;
  l->absorbed[k] = 0;
  l->second[k] = 1;
}

/* Lanes that nothing is left for go on with a copy of another's path, so that they hold numbers. */
static void fill(walk *w) {
  memset(&w->lanes, 0, sizeof w->lanes);
  for (size_t k = 0; k < LANES; k++) {
    const size_t next = w->next;
    if (next == w->count) w->next = 0;
    put(w, k);
    if (next == w->count) {
      w->next = next;
      w->active--;
      put(w, k);
    }
  }
}

static void end_lane(walk *w, size_t k, abbe_inner_end end) {
  lanes *l = &w->lanes;
  abbe_inner_path *p = &w->path[w->owner[k]];
  for (int i = 0; i < 3; i++) {
    p->p[i] = l->from[i][k];
    p->d[i] = l->out[i][k];
  }
  p->flux = l->flux[k];
  p->steps = l->steps[k];
  p->second_chance = l->second[k];
  p->end = end;
  w->ledger->absorbed += (double)l->absorbed[k];
  w->active--;
  put(w, k);
}

/* What the roulette takes from some it gives to others: the mean stays. False: it is gone. */
static bool survives(walk *w, size_t k) {
  lanes *l = &w->lanes;
  const float kept = least * l->full[k], chance = l->flux[k] / kept;
  float random[4];
  abbe_random4(l->id[k], l->steps[k] - 1, w->rules->pass, ~w->rules->seed, random);
  const float before = l->flux[k];
  l->flux[k] = random[0] < chance ? kept : 0;
  l->absorbed[k] += l->y[k] * (before - l->flux[k]);
  return l->flux[k] > 0;
}

/* Matched physics: whether the renderer would still follow the path. */
static bool is_followed(walk *w, size_t k) {
  const abbe_physics *physics = &w->rules->physics;
  if (!physics->matched) return true;
  const lanes *l = &w->lanes;
  abbe_inner_path *p = &w->path[w->owner[k]];
  p->carried *= (w->absorbs ? l->left[k] : 1) * (l->reflects[k] ? l->share[k] : 1 - l->share[k]);
  p->inner++;
  return !l->reflects[k] ||
         (p->inner < physics->orders && (double)p->carried >= physics->energy_share);
}

static void look_at(walk *w, size_t k) {
  const lanes *l = &w->lanes;
  if (l->flux[k] < least * l->full[k] && !survives(w, k))
    end_lane(w, k, ABBE_INNER_GONE);
  else if (l->steps[k] >= ABBE_INNER_MAX_STEPS)
    end_lane(w, k, ABBE_INNER_LOST);
  else if (!is_followed(w, k))
    end_lane(w, k, ABBE_INNER_TRAPPED);
  else if (!l->reflects[k])
    end_lane(w, k, ABBE_INNER_LEFT);
}

/* The rays of the lanes for Embree, which would meet the face that they start at. */
static void keep(const walk *w, abbe_ray_record *record) {
  struct RTCRayHit16 packet;
  size_t count = 0;
  memset(&packet, 0, sizeof packet);
  abbe_ray_prepare(&packet, 1);
  abbe_ray_reset(&packet);
  for (size_t k = 0; k < LANES; k++) {
    if (w->owner[k] == IDLE) continue;
    float o[3], d[3];
    for (int i = 0; i < 3; i++) {
      d[i] = w->lanes.d[i][k];
      o[i] = w->lanes.p[i][k] + 1e-4f * d[i];
    }
    abbe_ray_put(&packet, count++, o, d);
  }
  abbe_ray_record_keep(record, &packet, count, true);
}

void abbe_inner_walk(const abbe_solid *solid, const abbe_inner_rules *rules, abbe_inner_path *path,
                     size_t count, abbe_light_ledger *ledger, abbe_ray_record *record,
                     uint64_t *rays) {
  if (count == 0) return;
  walk w = {.rules = rules, .path = path, .count = count, .ledger = ledger};
  for (size_t i = 0; i < count && !w.absorbs; i++) w.absorbs = path[i].attenuation > 0;
  fill(&w);
  const bool all = rules->physics.matched;
  while (w.active > 0) {
    if (record->packet != NULL) keep(&w, record);
    *rays += w.active;
    if (solid->sphere)
      bounce_sphere(solid, rules, w.absorbs, &w.lanes);
    else
      bounce_planes(solid, rules, w.absorbs, &w.lanes);
    for (size_t k = 0; k < LANES; k++)
      if (w.owner[k] != IDLE && (all || w.lanes.looked_at[k])) look_at(&w, k);
  }
}
