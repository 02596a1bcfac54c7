#include "validation/trace/walks/eye_walk.h"

#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/walks/eye_shading.h"

#include <stddef.h>
#include <string.h>

enum { FILM_BANDS = 64 }; /* that tint a film's mirror image */
enum { HEROES = 4, MAX_STEPS = 10000, BRANCHES_ROOM = 16, TURNS_ROOM = 64, IDS = 8 };
/* Golden ratios of three dimensions, 2^32 each: places of a pixel's samples and their wavelengths
 * [Roberts2018]. */
static const uint32_t golden[3] = {3518319155u, 2882110345u, 2360945575u};

/* ---- paths ---- */

typedef struct crossing {
  abbe_media_set before, after;
  abbe_wave_face face; /* the normal on the path's side */
  float cos_i;
  bool crystal; /* on either side, or the light is polarised */
} crossing;

static void cross(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                  crossing *x) {
  float along = abbe_eye_dot(p->d, hit->ng), shaded = abbe_eye_dot(p->d, hit->n);
  x->face.entering = along < 0;
  const float *outside = (shaded < 0) == x->face.entering ? hit->n : hit->ng;
  for (int k = 0; k < 3; k++) x->face.n[k] = x->face.entering ? outside[k] : -outside[k];
  float cosine = -abbe_eye_dot(p->d, x->face.n);
  x->cos_i = cosine < 1 ? cosine : 1;
  abbe_media_cross(p->inside, hit->surface->index, x->face.entering, &x->before, &x->after);
  x->face.from = abbe_media_of(x->before);
  x->face.to = abbe_media_of(x->after);
  x->face.film = abbe_media_film(c->w->media, x->face.from, x->face.to, hit);
  x->face.rough = abbe_media_roughness(c->w->media, x->face.from, x->face.to, hit);
  x->face.stokes = c->w->physics.polarised ? p->stokes : NULL;
  x->crystal = x->face.stokes != NULL || abbe_media_is_crystal(c->w->media, x->face.from) ||
               abbe_media_is_crystal(c->w->media, x->face.to);
  memcpy(x->face.d, p->d, sizeof x->face.d);
  x->face.wave = p->wave;
}

/* way: eta, the cosine beyond, and what a film does not absorb; of the latter a share. */
static float reflectance_at(const abbe_eye_context *c, const crossing *x, uint32_t step,
                            float within, float way[3]) {
  const abbe_media *m = c->w->media;
  if (x->crystal) {
    abbe_wave_ways ways;
    abbe_media_ways(c->w->media, &x->face, step, within, &ways);
    way[0] = way[1] = 1;
    way[2] = ways.passes;
    return ways.reflected;
  }
  const float n[2] = {abbe_media_n(m, x->face.from, step, within),
                      abbe_media_n(m, x->face.to, step, within)};
  way[0] = n[0] / n[1];
  way[2] = 1;
  const float bare = abbe_interface_reflectance(x->cos_i, way[0], &way[1]);
  return x->face.film < 0 ? bare
                          : abbe_films_reflectance(&m->films, x->face.film, x->face.entering, n[0],
                                                   n[1], x->cos_i, step, within, &way[2]);
}

/* Sends the path on, mirrored or refracted. */
static void send(abbe_eye_path *p, const abbe_hit *hit, const crossing *x, bool reflects, float eta,
                 float cos_t) {
  float d[3];
  if (reflects)
    abbe_interface_reflect(p->d, x->face.n, x->cos_i, d);
  else
    abbe_interface_refract(p->d, x->face.n, eta, x->cos_i, cos_t, d);
  abbe_interface_keep_side(hit->ng, x->face.entering == reflects ? 1 : -1, d);
  memcpy(p->d, d, sizeof d);
  p->inside = reflects ? x->before : x->after;
  abbe_geometry_leave(hit, d, p->o);
}

static void send_as(abbe_eye_path *p, const abbe_hit *hit, const crossing *x,
                    const abbe_wave_way *way) {
  memcpy(p->d, way->d, sizeof p->d);
  abbe_interface_keep_side(hit->ng, x->face.entering == way->reflected ? 1 : -1, p->d);
  p->inside = way->reflected ? x->before : x->after;
  p->wave = way->wave;
  memcpy(p->stokes, way->stokes, sizeof p->stokes);
  if (x->face.stokes != NULL && memcmp(p->d, way->d, sizeof p->d) != 0)
    abbe_polarised_bend(way->d, p->d, p->stokes);
  abbe_geometry_leave(hit, p->d, p->o);
}

/* Matched physics: whether the renderer would follow the path any further. */
static bool matched_rules(const abbe_eye_context *c, abbe_eye_path *p, bool reflects, float share) {
  const abbe_physics *physics = &c->w->physics;
  if (!physics->matched) return true;
  p->walls++;
  p->carried *= reflects ? share : 1 - share;
  return !reflects || (p->walls < physics->orders && (double)p->carried >= physics->energy_share);
}

static bool disperses(const abbe_eye_context *c, const crossing *x) {
  const bool *d = c->w->media->dispersive;
  return c->w->bands->count > 0 || x->face.film >= 0 || (x->face.from >= 0 && d[x->face.from]) ||
         (x->face.to >= 0 && d[x->face.to]);
}

static bool is_coloured_haze(const abbe_eye_context *c, const abbe_eye_path *p) {
  return abbe_haze_is_coloured(&c->w->media->haze, abbe_media_of(p->inside));
}

/* ---- branches ---- */

/* Paths that wait for their turn. The smaller branch is followed first, so that few wait. */
typedef struct branches {
  abbe_eye_path path[TURNS_ROOM];
  uint32_t count;
  float least; /* share below which absorption ends a path by roulette */
} branches;

/* One of the two ways on from an interface; false where it ends there. */
static bool branch_off(const abbe_eye_context *c, abbe_eye_path *p, const abbe_hit *hit,
                       const crossing *x, bool reflects, float share, const float way[3],
                       float random) {
  if (!matched_rules(c, p, reflects, share)) return false;
  float part = reflects ? share : 1 - share, least = c->w->least_branch;
  p->share *= part;
  p->branch *= part;
  if (p->branch < least) {
    if (!(random * least < p->branch)) return false;
    p->share *= least / p->branch;
    p->branch = least;
  }
  p->id = p->id * 0x9e3779b1u + (reflects ? 0x85ebca6bu : 0xc2b2ae35u);
  send(p, hit, x, reflects, way[0], way[1]);
  return true;
}

/* Both ways on from an interface: one of them in p, the other among those that wait; false where
 * none goes on. */
static bool scatter(const abbe_eye_context *c, branches *b, abbe_eye_path *p, const abbe_hit *hit,
                    const crossing *x, float random) {
  float way[3], share = reflectance_at(c, x, p->step, p->within, way);
  p->share *= way[2];
  if (share <= 0 || share >= 1 || b->count >= BRANCHES_ROOM) {
    bool reflects = random < share;
    if (!matched_rules(c, p, reflects, share)) return false;
    send(p, hit, x, reflects, way[0], way[1]);
    return true;
  }
  /* one number for both: where one branch ends the other is likely to go on */
  abbe_eye_path other = *p;
  bool goes = branch_off(c, p, hit, x, share < 0.5f, share, way, random);
  bool also = branch_off(c, &other, hit, x, !(share < 0.5f), share, way, 1 - random);
  if (goes && also) b->path[b->count++] = other;
  if (!goes && also) *p = other;
  return goes || also;
}

/* All ways on from a crystal's face, as scatter. Those of which little is left share one number, so
 * that about as many go on as there is light for. Matched physics follows all of them. */
static bool scatter_waves(const abbe_eye_context *c, branches *b, abbe_eye_path *p,
                          const abbe_hit *hit, const crossing *x, const float random[4]) {
  const abbe_eye_path first = *p;
  const float least = c->w->least_branch;
  abbe_wave_ways ways;
  abbe_media_ways(c->w->media, &x->face, p->step, p->within, &ways);
  if (b->count + 3 > BRANCHES_ROOM) {
    send_as(p, hit, x, abbe_wave_ways_choose(&ways, random[0], random[3]));
    p->share *= ways.passes;
    return true;
  }
  float sum = random[0];
  bool goes = false;
  for (size_t i = 0; i < ways.count; i++) {
    abbe_eye_path next = first;
    next.share *= ways.way[i].share * ways.passes;
    next.branch *= ways.way[i].share;
    if (next.branch < least) {
      const float before = sum;
      sum += next.branch / least;
      if (floorf(sum) == floorf(before)) continue;
      next.share *= least / next.branch;
      next.branch = least;
    }
    next.id = first.id * 0x9e3779b1u + 0x85ebca6bu * (uint32_t)(i + 1);
    send_as(&next, hit, x, &ways.way[i]);
    if (goes)
      b->path[b->count++] = next;
    else
      *p = next;
    goes = true;
  }
  return goes;
}

/* One way on from a rough face; false where nothing is left. */
static bool scatter_rough(const abbe_eye_context *c, abbe_eye_path *p, const abbe_hit *hit,
                          const crossing *x) {
  abbe_wave_way way;
  abbe_eye_roughen(c, p, hit, &x->face, &way);
  p->share *= way.share;
  send_as(p, hit, x, &way);
  return way.share > 0;
}

/* One way on from a rough mirror, d; what it shows of lights is added. Returns the share that goes
 * there of what the facet met reflects. */
static float scatter_off(const abbe_eye_context *c, abbe_eye_path *p, const abbe_hit *hit,
                         const float n[3], float d[3], float *cos_h) {
  abbe_rough_hit rough;
  float random[4];
  abbe_eye_random4(c, p->id ^ 0x6c6f6265u, p->steps, random);
  abbe_mirrors_meet(c->w->mirrors, hit->surface->index, hit->p, n, p->d, &rough);
  abbe_eye_gloss(c, p, hit, n, &rough);
  return abbe_mirrors_scatter(&rough, random, d, &p->lobe, cos_h);
}

/* On from a mirror, with what it reflects. */
static void mirror_on(const abbe_eye_context *c, abbe_eye_path *p, const abbe_hit *hit) {
  const float side = abbe_eye_dot(p->d, hit->ng) < 0 ? 1 : -1;
  const float *outside = abbe_eye_dot(p->d, hit->n) * side < 0 ? hit->n : hit->ng;
  float n[3], d[3];
  for (int k = 0; k < 3; k++) n[k] = side * outside[k];
  float cos_i = fminf(-abbe_eye_dot(p->d, n), 1);
  p->lobe = 0;
  if (abbe_mirrors_is_rough(c->w->mirrors, hit->surface->index))
    p->share *= scatter_off(c, p, hit, n, d, &cos_i);
  else
    abbe_interface_reflect(p->d, n, cos_i, d);
  p->share *= abbe_mirrors_reflect(c->w->mirrors, hit->surface->index, cos_i, p->step, p->within);
  abbe_interface_keep_side(hit->ng, side, d);
  if (c->w->physics.polarised)
    p->share *= abbe_polarised_mirror(c->w->mirrors, hit->surface->index, p->d, d, p->step,
                                      p->within, p->stokes);
  memcpy(p->d, d, sizeof d);
  abbe_geometry_leave(hit, d, p->o);
}

static bool is_coloured_mirror(const abbe_eye_context *c, const abbe_hit *hit) {
  return c->w->bands->count > 0 || !abbe_mirrors_is_grey(c->w->mirrors, hit->surface->index);
}

/* To the next interface that is one; false where the path ends. */
static bool follow_step(const abbe_eye_context *c, branches *b, abbe_eye_path *p) {
  abbe_hit hit;
  uint32_t bits[4];
  float length = 0, random[4];
  bool met = abbe_eye_trace(c, p, &hit, &length);
  abbe_eye_random_bits(c, p->id, p->steps, bits);
  for (int k = 0; k < 4; k++) random[k] = abbe_random_float(bits[k]);
  if (abbe_haze_is(&c->w->media->haze)) {
    if (is_coloured_haze(c, p)) abbe_eye_disperse(p, bits[1]);
    const float far = met ? length : INFINITY;
    abbe_eye_path turned, glow;
    const bool glows = abbe_eye_glow(c, p, far, &glow);
    const bool turns = abbe_eye_turn(c, p, far, &turned);
    abbe_eye_haze(c, p, far, false);
    if (turns && b->count < TURNS_ROOM)
      b->path[b->count++] = turned;
    else if (turns && abbe_eye_chooses(c, p, &turned))
      return true;
    if (glows && b->count < TURNS_ROOM)
      b->path[b->count++] = glow;
    else if (glows && abbe_eye_chooses(c, p, &glow))
      return true;
  } else if (met && p->inside != 0 && c->w->media->attenuation != NULL) {
    abbe_eye_disperse(p, bits[1]);
    abbe_eye_weaken(c, p, length);
  }
  if (p->share < b->least) {
    if (!(random[2] * b->least < p->share)) return false;
    p->share = b->least;
  }
  if (!met || (hit.surface->kind & ABBE_GEOMETRY_SPECULAR) == 0) {
    abbe_eye_arrive(c, p, met, &hit, false);
    return false;
  }
  if (hit.surface->kind == ABBE_GEOMETRY_MIRRORS) {
    if (is_coloured_mirror(c, &hit)) abbe_eye_disperse(p, bits[1]);
    mirror_on(c, p, &hit);
    return p->share > 0;
  }
  p->lobe = 0;
  crossing x;
  cross(c, p, &hit, &x);
  if (x.face.film < 0 && abbe_media_same(c->w->media, x.face.from, x.face.to)) {
    p->inside = x.after;
    abbe_geometry_leave(&hit, p->d, p->o);
    return true;
  }
  if (disperses(c, &x)) abbe_eye_disperse(p, bits[1]);
  if (x.face.rough > 0) return scatter_rough(c, p, &hit, &x);
  if (x.crystal) return scatter_waves(c, b, p, &hit, &x, random);
  return scatter(c, b, p, &hit, &x, random[0]);
}

/* Follows a path that may be inside, and all that it splits into, to their ends. */
static void follow(const abbe_eye_context *c, const abbe_eye_path *first) {
  branches b; /* of which most is never used */
  b.count = 1;
  b.least = first->share * 0.02f;
  b.path[0] = *first;
  while (b.count > 0) {
    abbe_eye_path p = b.path[--b.count];
    while (p.steps < MAX_STEPS && follow_step(c, &b, &p)) p.steps++;
  }
}

/* The mirror image on the outside: the whole spectrum, tinted by Fresnel's law; bands need single
 * wavelengths. */
static void follow_mirror(const abbe_eye_context *c, const abbe_eye_path *first,
                          const abbe_hit *hit, const crossing *x, uint32_t wave) {
  const abbe_eye_walk *w = c->w;
  abbe_eye_path p = *first;
  p.id++;
  float way[3];
  if (w->bands->count > 0 || p.dispersed) {
    abbe_eye_disperse(&p, wave);
    const float share = reflectance_at(c, x, p.step, p.within, way);
    p.share *= share * way[2];
  } else {
    float sum[3] = {0};
    const bool bare = x->face.film < 0;
    const uint32_t bands = bare ? ABBE_EYE_MIRRORED : FILM_BANDS;
    const uint32_t size = (uint32_t)w->sampling->steps / bands;
    for (uint32_t b = 0; b < bands; b++) {
      const float part = reflectance_at(c, x, b * size + size / 2, 0, way), share = part * way[2];
      float of_film[3];
      if (!bare) abbe_eye_walk_band(w, bands, b, of_film);
      const float *colour = bare ? w->mirrored[b] : of_film;
      for (int k = 0; k < 3; k++) sum[k] += share * colour[k] / (float)bands;
    }
    /* by the sampled colours' own sum, so that a constant reflectance has no tint */
    for (int k = 0; k < 3; k++) p.tint[k] *= sum[k] / w->sampled[k];
  }
  p.carried = reflectance_at(c, x, (uint32_t)w->sampling->steps / 2, 0, way);
  send(&p, hit, x, true, way[0], way[1]);
  follow(c, &p);
}

/* Both waves into a crystal; of polarised light what the outside mirrors too. */
static void follow_waves(const abbe_eye_context *c, const abbe_eye_path *first, const abbe_hit *hit,
                         const crossing *x) {
  abbe_wave_ways ways;
  abbe_media_ways(c->w->media, &x->face, first->step, first->within, &ways);
  for (size_t i = 0; i < ways.count; i++) {
    const bool mirrored = ways.way[i].reflected;
    if (mirrored && x->face.stokes == NULL) continue;
    abbe_eye_path p = *first;
    p.id += HEROES * (mirrored ? 2 : (uint32_t)ways.way[i].wave) * 0x10000u;
    p.share *= ways.way[i].share * ways.passes;
    send_as(&p, hit, x, &ways.way[i]);
    follow(c, &p);
  }
}

static void follow_through(const abbe_eye_context *c, const abbe_eye_path *first,
                           const abbe_hit *hit, const crossing *x, uint32_t wave) {
  const bool takes = disperses(c, x) || c->w->media->attenuation != NULL;
  const uint32_t count = takes && !first->dispersed ? HEROES : 1;
  for (uint32_t i = 0; i < count; i++) {
    abbe_eye_path p = *first;
    p.id += 2 + i;
    p.share /= (float)count;
    if (takes) abbe_eye_disperse(&p, abbe_random_part(wave, i, count));
    if (x->crystal) {
      follow_waves(c, &p, hit, x);
      continue;
    }
    float way[3], share = reflectance_at(c, x, p.step, p.within, way);
    if (share >= 1) continue;
    p.share *= (1 - share) * way[2];
    p.carried = 1 - share;
    send(&p, hit, x, false, way[0], way[1]);
    follow(c, &p);
  }
}

/* What the camera sees straight in a mirror or, where x is not NULL, a rough face: wavelengths of
 * their own where it has a colour. */
static void follow_off(const abbe_eye_context *c, const abbe_eye_path *first, const abbe_hit *hit,
                       const crossing *x, uint32_t wave) {
  const bool takes = x != NULL ? disperses(c, x) : is_coloured_mirror(c, hit);
  const bool spreads = x != NULL || abbe_mirrors_is_rough(c->w->mirrors, hit->surface->index);
  const uint32_t count = spreads || (takes && !first->dispersed) ? HEROES : 1;
  for (uint32_t i = 0; i < count; i++) {
    abbe_eye_path p = *first;
    p.id += 2 + i;
    p.share /= (float)count;
    if (takes) abbe_eye_disperse(&p, abbe_random_part(wave, i, count));
    if (x == NULL)
      mirror_on(c, &p, hit);
    else
      scatter_rough(c, &p, hit, x);
    p.steps += spreads; /* the next facet needs other numbers */
    if (p.share > 0) follow(c, &p);
  }
}

static void add_first(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                      float length) {
  float side = abbe_eye_dot(p->d, hit->ng) < 0 ? p->share : -p->share;
  for (int k = 0; k < 3; k++) c->out->normal[k] += side * hit->n[k];
  c->out->depth += p->share * length;
}

/* On from what the camera's ray meets first. */
static void walk_on(const abbe_eye_context *c, abbe_eye_path *p, bool met, const abbe_hit *first,
                    uint32_t wave) {
  abbe_hit hit = *first;
  if (!met || (hit.surface->kind & ABBE_GEOMETRY_SPECULAR) == 0) {
    abbe_eye_arrive(c, p, met, &hit, true);
    return;
  }
  c->out->refractor = true;
  if (hit.surface->kind == ABBE_GEOMETRY_MIRRORS) {
    follow_off(c, p, &hit, NULL, wave);
    return;
  }
  crossing at;
  cross(c, p, &hit, &at);
  if (at.face.film < 0 && abbe_media_same(c->w->media, at.face.from, at.face.to)) {
    p->id++;
    p->inside = at.after;
    abbe_geometry_leave(&hit, p->d, p->o);
    follow(c, p);
    return;
  }
  if (at.face.rough > 0) {
    follow_off(c, p, &hit, &at, wave);
    return;
  }
  if (at.face.stokes == NULL) follow_mirror(c, p, &hit, &at, wave);
  follow_through(c, p, &hit, &at, wave);
}

/* One of the pixel's samples: a path from the camera through the place (x, y) on the film. wave, a
 * fraction of 2^32, chooses wavelengths, of their own where haze around the camera has a colour. */
static void walk_sample(const abbe_eye_context *c, const abbe_trace_camera *camera,
                        abbe_eye_path *p, float x, float y, uint32_t wave) {
  abbe_hit hit = {0};
  float length = 0;
  abbe_trace_camera_ray(camera, x, y, p->d);
  if (c->w->physics.polarised)
    abbe_polarised_camera(&c->w->geometry->scene->camera.polariser, camera->right, camera->up, p->d,
                          p->stokes);
  bool met = abbe_eye_trace(c, p, &hit, &length);
  if (met) add_first(c, p, &hit, length);
  const uint32_t count = is_coloured_haze(c, p) ? HEROES : 1;
  for (uint32_t i = 0; i < count; i++) {
    abbe_eye_path own = *p, turned, glow;
    own.id += i << 24;
    own.share /= (float)count;
    if (count > 1) abbe_eye_disperse(&own, abbe_random_part(wave, i, count));
    if (abbe_eye_glow(c, &own, met ? length : INFINITY, &glow)) follow(c, &glow);
    if (abbe_eye_turn(c, &own, met ? length : INFINITY, &turned)) follow(c, &turned);
    abbe_eye_haze(c, &own, met ? length : INFINITY, true);
    walk_on(c, &own, met, &hit, wave);
  }
}

void abbe_eye_walk_pixel(const abbe_eye_walk *w, size_t pixel, uint32_t pass,
                         abbe_eye_sample *out) {
  abbe_eye_context c = {.w = w, .pixel = (uint32_t)pixel, .pass = pass, .out = out};
  uint32_t count = w->samples != NULL ? w->samples[pixel] : 1, shift[4], lens[4];
  const float column = (float)(pixel % w->camera->width), row = (float)(pixel / w->camera->width);
  memset(out, 0, offsetof(abbe_eye_sample, band) + w->bands->count * sizeof *out->band);
  abbe_eye_random_bits(&c, 0, 0, shift);
  for (uint32_t i = 0; i < count; i++) {
    abbe_eye_path p = {.share = 1 / (float)count,
                       .branch = 1,
                       .tint = {1, 1, 1},
                       .inside = w->inside,
                       .carried = 1,
                       .id = i * IDS};
    const abbe_trace_camera *camera = w->camera;
    abbe_trace_camera on_lens;
    if (camera->lens > 0) {
      abbe_eye_random_bits(&c, i, 0x6c656e73u, lens);
      on_lens =
          abbe_trace_camera_at(w->camera, abbe_random_float(lens[0]), abbe_random_float(lens[1]));
      camera = &on_lens;
    }
    memcpy(p.o, camera->eye, sizeof p.o);
    /* multiples of golden ratios, shifted */
    walk_sample(&c, camera, &p, column + abbe_random_float(i * golden[0] + shift[0]),
                row + abbe_random_float(i * golden[1] + shift[1]), i * golden[2] + shift[2]);
  }
}
