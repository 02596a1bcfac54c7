#include "validation/walks/eye_walk.h"

#include "scenes/geometry/vector.h"
#include "validation/transport/interface.h"
#include "validation/transport/random.h"

#include <string.h>

enum {
  HEROES = 4,
  MIRROR_BANDS = 8,
  MAX_STEPS = 10000,
  BRANCHES_ROOM = 16,
  IDS = 8,
  SALT = 0x657965
};
static const float inverse_pi = 0.318309886f;
/* Golden ratios of three dimensions, 2^32 each: places of a pixel's samples and their wavelengths
 * [Roberts2018]. */
static const uint32_t golden[3] = {3518319155u, 2882110345u, 2360945575u};

/* A path from the eye. Where it is not dispersed it carries the whole spectrum, else one
 * wavelength. */
typedef struct eye_path {
  float o[3], d[3];
  float share;   /* of its light, all wavelengths alike */
  float branch;  /* that part of it which interfaces inside the glass left */
  float tint[3]; /* a colour on top of that */
  bool dispersed;
  uint32_t step;
  float within;
  abbe_media_set inside;
  float carried; /* matched: what a splitting path would carry */
  uint32_t walls, steps, id;
} eye_path;

typedef struct context {
  const abbe_eye_walk *w;
  uint32_t pixel, pass;
  abbe_eye_sample *out;
} context;

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void random4(const context *c, uint32_t a, uint32_t b, float out[4]) {
  abbe_random4(c->pixel, c->pass, a, (c->w->seed ^ SALT) + b * 0x9e3779b1u, out);
}

/* ---- light into the sample ---- */

/* Radiance of a light's spectrum times share; reflectance NULL: none. */
static void add_light(const context *c, const eye_path *p, size_t light, float share,
                      const float reflectance[3], const float rec709[3]) {
  const abbe_eye_walk *w = c->w;
  size_t steps = w->sampling->steps;
  const float *colour = p->dispersed ? w->colour[light * steps + p->step] : w->white[light];
  share *= p->share;
  for (int k = 0; k < 3; k++)
    c->out->rgb[k] += share * p->tint[k] * colour[k] * (reflectance ? reflectance[k] : 1);
  const abbe_bands *b = w->bands;
  for (size_t i = 0; i < b->count; i++) {
    float power = b->power[light * b->count + i];
    if (p->dispersed) {
      if (b->of_step[p->step] != i) continue;
      power = w->sampling->power[light * steps + p->step] / (float)b->width_nm;
    }
    float kept = rec709 ? abbe_reflectance_band(rec709, b->middle_nm[i]) : 1;
    c->out->band[i] += share * kept * power;
  }
}

/* Ambient light and background: white in the picture's space, with the first light's spectrum. */
static void add_white(const context *c, const eye_path *p, float share, const float reflectance[3],
                      const float rec709[3]) {
  const abbe_eye_walk *w = c->w;
  float before[3];
  memcpy(before, c->out->rgb, sizeof before);
  add_light(c, p, 0, share, reflectance, rec709);
  for (int k = 0; k < 3; k++)
    c->out->rgb[k] = before[k] + (c->out->rgb[k] - before[k]) / w->white[0][k];
}

/* Radiance of the environment, RGB relative to its illuminant, times share. */
static void add_environment(const context *c, const eye_path *p, const float rgb[3], float share,
                            const float reflectance[3], const float rec709[3]) {
  const abbe_eye_walk *w = c->w;
  const abbe_environment_light *e = w->environment;
  if (p->dispersed) {
    const float *lift = e->lift[p->step];
    add_light(c, p, e->light, share * dot(lift, rgb), reflectance, rec709);
    return;
  }
  share *= p->share;
  for (int k = 0; k < 3; k++)
    c->out->rgb[k] +=
        share * p->tint[k] * dot(&e->to_colour[3 * k], rgb) * (reflectance ? reflectance[k] : 1);
  const abbe_bands *b = w->bands;
  for (size_t i = 0; i < b->count; i++) {
    float kept = rec709 ? abbe_reflectance_band(rec709, b->middle_nm[i]) : 1;
    c->out->band[i] += share * kept * dot(e->band[i], rgb) * b->power[e->light * b->count + i];
  }
}

typedef struct gathering {
  const context *c;
  const eye_path *p;
  float sum[3];
  float band[ABBE_BANDS_MAX];
} gathering;

static void take_photon(void *user, const abbe_grid_photon *photon) {
  gathering *g = user;
  const abbe_eye_walk *w = g->c->w;
  size_t steps = w->sampling->steps, step = photon->colour % steps;
  float flux = fabsf(photon->flux);
  if (g->p->dispersed) {
    /* a window of wavelengths around the path's, cut at the ends of the range */
    const double *nm = w->sampling->lambda_nm;
    double own = nm[g->p->step] + (double)g->p->within * (nm[g->p->step + 1] - nm[g->p->step]);
    double other = 0.5 * (nm[step] + nm[step + 1]);
    if (fabs(own - other) > w->window_nm) return;
    double span = fmin(other + w->window_nm, nm[steps]) - fmax(other - w->window_nm, nm[0]);
    double density = 1 / ((double)steps * (nm[g->p->step + 1] - nm[g->p->step]));
    flux *= (float)(1 / (span * density));
  }
  for (int k = 0; k < 3; k++) g->sum[k] += flux * w->colour[photon->colour][k];
  if (w->bands->count > 0)
    g->band[w->bands->of_step[step]] +=
        flux * w->sampling->power[photon->colour] / (float)w->bands->width_nm;
}

static void add_caustic(const context *c, const eye_path *p, const abbe_hit *hit, float side,
                        const float reflectance[3], const float rec709[3]) {
  const abbe_eye_walk *w = c->w;
  if (w->grid == NULL) return;
  gathering g = {.c = c, .p = p};
  abbe_photon_grid_gather(w->grid, hit->p, w->radius,
                          (uint32_t)(hit->surface - w->geometry->surface), side, take_photon, &g);
  float unit = (float)w->geometry->unit, r = w->radius * unit;
  float scale = p->share * inverse_pi * inverse_pi / (r * r);
  for (int k = 0; k < 3; k++) {
    float add = scale * p->tint[k] * reflectance[k] * g.sum[k];
    c->out->rgb[k] += add;
    c->out->caustic[k] += add;
  }
  for (size_t i = 0; i < w->bands->count; i++)
    c->out->band[i] += scale * g.band[i] * abbe_reflectance_band(rec709, w->bands->middle_nm[i]);
}

/* Irradiance of a light at the hit on the viewer's side, W/m2, seen past everything. n faces the
 * viewer. */
static float irradiance(const context *c, const abbe_light *light, const abbe_hit *hit,
                        const float n[3], const float random[2]) {
  const abbe_geometry *g = c->w->geometry;
  float from[3], d[3], o[3], limit = INFINITY, power = (float)light->power, falloff = 1;
  for (int k = 0; k < 3; k++) d[k] = -(float)light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    abbe_geometry_to_frame(g, light->position, from);
    if (light->kind == ABBE_LIGHT_DISK) {
      float a[3], b[3], r = (float)(light->radius / g->unit) * sqrtf(random[0]);
      float angle = 6.28318531f * random[1];
      abbe_geometry_across(d, a, b);
      for (int k = 0; k < 3; k++) from[k] += r * (cosf(angle) * a[k] + sinf(angle) * b[k]);
      power *= (float)(3.14159265358979 * light->radius * light->radius);
    }
    for (int k = 0; k < 3; k++) d[k] = from[k] - hit->p[k];
    limit = sqrtf(dot(d, d));
    for (int k = 0; k < 3; k++) d[k] /= limit;
    falloff = 1 / (limit * limit * (float)(g->unit * g->unit));
  }
  float facing = dot(n, d);
  if (!(facing > 0)) return 0;
  double away[3] = {-(double)d[0], -(double)d[1], -(double)d[2]};
  abbe_vector_normalise(away); /* a narrow cone's cosine asks for more than single precision */
  float e = power * falloff * facing * (float)abbe_light_profile(light, away);
  if (!(e > 0)) return 0;
  abbe_geometry_leave(hit, d, o);
  c->out->rays++;
  unsigned mask = ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS;
  return abbe_geometry_occluded(g, mask, o, d, limit) ? 0 : e;
}

/* Whether the environment is seen from the hit along d, on the side of n. */
static bool sees_out(const context *c, const abbe_hit *hit, const float n[3], const float d[3]) {
  float o[3];
  if (!(dot(n, d) > 0)) return false;
  abbe_geometry_leave(hit, d, o);
  c->out->rays++;
  unsigned mask = ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS;
  return !abbe_geometry_occluded(c->w->geometry, mask, o, d, INFINITY);
}

/* Irradiance of the environment at the hit on the side of n, over pi, RGB: one direction drawn by
 * its radiance, one by its cosine, weighted by the balance heuristic [VeachGuibas1995]. */
static void surrounding_light(const context *c, const eye_path *p, const abbe_hit *hit,
                              const float n[3], float out[3]) {
  const abbe_environment_light *e = c->w->environment;
  float random[4], more[4], d[3], pdf, rgb[3], x[3], y[3];
  random4(c, ~p->id ^ 0x736b79u, p->steps, random);
  random4(c, ~p->id ^ 0x68656d69u, p->steps, more);
  memset(out, 0, 3 * sizeof *out);
  abbe_environment_light_sample(e, random, d, &pdf, rgb);
  float cosine = dot(n, d) * inverse_pi;
  if (sees_out(c, hit, n, d))
    for (int k = 0; k < 3; k++) out[k] += rgb[k] * cosine / (pdf + cosine);
  abbe_geometry_across(n, x, y);
  float r = sqrtf(more[0]), angle = 6.28318531f * more[1];
  for (int k = 0; k < 3; k++)
    d[k] = r * (cosf(angle) * x[k] + sinf(angle) * y[k]) + sqrtf(1 - more[0]) * n[k];
  if (!sees_out(c, hit, n, d)) return;
  cosine = dot(n, d) * inverse_pi;
  abbe_environment_light_seen(e, d, rgb);
  const float weight = cosine / (abbe_environment_light_pdf(e, d) + cosine);
  for (int k = 0; k < 3; k++) out[k] += rgb[k] * weight;
}

static void shade(const context *c, const eye_path *p, const abbe_hit *hit, bool straight) {
  const abbe_eye_walk *w = c->w;
  const abbe_scene *scene = w->geometry->scene;
  float reflectance[3], rec709[3], n[3], random[4];
  uint32_t surface = (uint32_t)(hit->surface - w->geometry->surface);
  abbe_reflectance_at(w->reflectance, surface, hit->face, hit->u, hit->v, reflectance);
  if (w->bands->count > 0)
    abbe_reflectance_rec709(w->reflectance, surface, hit->face, hit->u, hit->v, rec709);
  for (int k = 0; k < 3; k++) c->out->albedo[k] += p->share * p->tint[k] * reflectance[k];
  float side = dot(p->d, hit->ng) < 0 ? 1 : -1;
  const float *normal = dot(hit->n, p->d) * side < 0 ? hit->n : hit->ng;
  for (int k = 0; k < 3; k++) n[k] = side * normal[k];
  for (size_t l = 0; l < scene->light_count; l++) {
    random4(c, ~p->id, (uint32_t)(p->steps * ABBE_SCENE_MAX_LIGHTS + l), random);
    float e = irradiance(c, &scene->light[l], hit, n, random);
    if (e > 0) add_light(c, p, l, e * inverse_pi, reflectance, rec709);
  }
  if (w->environment->environment != NULL) {
    float rgb[3];
    surrounding_light(c, p, hit, n, rgb);
    add_environment(c, p, rgb, 1, reflectance, rec709);
  }
  if (scene->ambient > 0) add_white(c, p, (float)scene->ambient * inverse_pi, reflectance, rec709);
  if (!straight) add_caustic(c, p, hit, side, reflectance, rec709);
}

/* ---- paths ---- */

enum { ALL_KINDS = ABBE_GEOMETRY_REFRACTORS | ABBE_GEOMETRY_RECEIVERS | ABBE_GEOMETRY_LAMPS };

/* From inside a solid: where the path leaves it. */
static bool leave_solid(const abbe_geometry *g, const eye_path *p, abbe_hit *hit, float *length) {
  int refractor = abbe_media_of(p->inside);
  if (refractor < 0 || !abbe_solid_is(&g->solid[refractor])) return false;
  *hit = (abbe_hit){.surface = &g->surface[g->refractor_object[refractor]]};
  *length = abbe_solid_leave(&g->solid[refractor], p->o, p->d, hit->p, hit->n);
  memcpy(hit->ng, hit->n, sizeof hit->ng);
  return true;
}

static bool trace(const context *c, const eye_path *p, abbe_hit *hit, float *length) {
  c->out->rays++;
  if (leave_solid(c->w->geometry, p, hit, length)) return true;
  if (!abbe_geometry_hit(c->w->geometry, ALL_KINDS, p->o, p->d, INFINITY, hit)) return false;
  float square = 0;
  for (int k = 0; k < 3; k++) square += (hit->p[k] - p->o[k]) * (hit->p[k] - p->o[k]);
  *length = sqrtf(square);
  return true;
}

/* What ends a path: a receiver, a lamp, or nothing at all. */
static void arrive(const context *c, const eye_path *p, bool met, const abbe_hit *hit,
                   bool straight) {
  const abbe_scene *scene = c->w->geometry->scene;
  if (!met) {
    if (scene->background > 0) add_white(c, p, (float)scene->background, NULL, NULL);
    if (c->w->environment->environment == NULL) return;
    float rgb[3];
    abbe_environment_light_seen(c->w->environment, p->d, rgb);
    add_environment(c, p, rgb, 1, NULL, NULL);
  } else if (hit->surface->kind == ABBE_GEOMETRY_RECEIVERS) {
    shade(c, p, hit, straight);
  } else if (dot(p->d, hit->n) < 0) {
    size_t l = hit->surface->index;
    add_light(c, p, l, (float)scene->light[l].power, NULL, NULL);
  }
}

static void disperse(eye_path *p, float random) {
  if (p->dispersed) return;
  p->dispersed = true;
  p->step = abbe_spectral_sampling_step(random, &p->within);
}

typedef struct crossing {
  abbe_media_set before, after;
  int from, to;
  float n[3], cos_i; /* the normal on the path's side */
  bool entering;
} crossing;

static void cross(const eye_path *p, const abbe_hit *hit, crossing *x) {
  float along = dot(p->d, hit->ng), shaded = dot(p->d, hit->n);
  x->entering = along < 0;
  const float *outside = (shaded < 0) == x->entering ? hit->n : hit->ng;
  for (int k = 0; k < 3; k++) x->n[k] = x->entering ? outside[k] : -outside[k];
  float cosine = -dot(p->d, x->n);
  x->cos_i = cosine < 1 ? cosine : 1;
  abbe_media_cross(p->inside, hit->surface->index, x->entering, &x->before, &x->after);
  x->from = abbe_media_of(x->before);
  x->to = abbe_media_of(x->after);
}

static float reflectance_at(const context *c, const crossing *x, uint32_t step, float within,
                            float *eta, float *cos_t) {
  const abbe_media *m = c->w->media;
  *eta = abbe_media_n(m, x->from, step, within) / abbe_media_n(m, x->to, step, within);
  return abbe_interface_reflectance(x->cos_i, *eta, cos_t);
}

/* Sends the path on, mirrored or refracted. */
static void send(eye_path *p, const abbe_hit *hit, const crossing *x, bool reflects, float eta,
                 float cos_t) {
  float d[3];
  if (reflects)
    abbe_interface_reflect(p->d, x->n, x->cos_i, d);
  else
    abbe_interface_refract(p->d, x->n, eta, x->cos_i, cos_t, d);
  abbe_interface_keep_side(hit->ng, x->entering == reflects ? 1 : -1, d);
  memcpy(p->d, d, sizeof d);
  p->inside = reflects ? x->before : x->after;
  abbe_geometry_leave(hit, d, p->o);
}

/* Matched physics: whether the renderer would follow the path any further. */
static bool matched_rules(const context *c, eye_path *p, bool reflects, float share) {
  const abbe_physics *physics = &c->w->physics;
  if (!physics->matched) return true;
  p->walls++;
  p->carried *= reflects ? share : 1 - share;
  return !reflects || (p->walls < physics->orders && (double)p->carried >= physics->energy_share);
}

static bool disperses(const context *c, const crossing *x) {
  const bool *d = c->w->media->dispersive;
  return c->w->bands->count > 0 || (x->from >= 0 && d[x->from]) || (x->to >= 0 && d[x->to]);
}

/* Absorption along the way in the medium; the whole spectrum's goes by wavelength, so the path
 * takes one. */
static void absorb(const context *c, eye_path *p, float length, float random) {
  int medium = abbe_media_of(p->inside);
  if (medium < 0 || c->w->media->attenuation == NULL) return;
  disperse(p, random);
  p->share *= expf(-length * abbe_media_attenuation(c->w->media, medium, p->step, p->within));
}

/* ---- branches ---- */

/* Paths that wait for their turn. The smaller branch is followed first, so that few wait. */
typedef struct branches {
  eye_path path[BRANCHES_ROOM];
  uint32_t count;
  float least; /* share below which absorption ends a path by roulette */
} branches;

/* One of the two ways on from an interface; false where it ends there. */
static bool branch_off(const context *c, eye_path *p, const abbe_hit *hit, const crossing *x,
                       bool reflects, float share, const float way[2], float random) {
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
static bool scatter(const context *c, branches *b, eye_path *p, const abbe_hit *hit,
                    const crossing *x, float random) {
  float way[2], share = reflectance_at(c, x, p->step, p->within, &way[0], &way[1]);
  if (share <= 0 || share >= 1 || b->count == BRANCHES_ROOM) {
    bool reflects = random < share;
    if (!matched_rules(c, p, reflects, share)) return false;
    send(p, hit, x, reflects, way[0], way[1]);
    return true;
  }
  /* one number for both: where one branch ends the other is likely to go on */
  eye_path other = *p;
  bool goes = branch_off(c, p, hit, x, share < 0.5f, share, way, random);
  bool also = branch_off(c, &other, hit, x, !(share < 0.5f), share, way, 1 - random);
  if (goes && also) b->path[b->count++] = other;
  if (!goes && also) *p = other;
  return goes || also;
}

/* To the next interface that is one; false where the path ends. */
static bool follow_step(const context *c, branches *b, eye_path *p) {
  abbe_hit hit;
  float length = 0, random[4];
  bool met = trace(c, p, &hit, &length);
  random4(c, p->id, p->steps, random);
  if (met) absorb(c, p, length, random[1]);
  if (p->share < b->least) {
    if (!(random[2] * b->least < p->share)) return false;
    p->share = b->least;
  }
  if (!met || hit.surface->kind != ABBE_GEOMETRY_REFRACTORS) {
    arrive(c, p, met, &hit, false);
    return false;
  }
  crossing x;
  cross(p, &hit, &x);
  if (abbe_media_same(c->w->media, x.from, x.to)) {
    p->inside = x.after;
    abbe_geometry_leave(&hit, p->d, p->o);
    return true;
  }
  if (disperses(c, &x)) disperse(p, random[1]);
  return scatter(c, b, p, &hit, &x, random[0]);
}

/* Follows a path that may be inside, and all that it splits into, to their ends. */
static void follow(const context *c, const eye_path *first) {
  branches b = {.count = 1, .least = first->share * 0.02f};
  b.path[0] = *first;
  while (b.count > 0) {
    eye_path p = b.path[--b.count];
    while (p.steps < MAX_STEPS && follow_step(c, &b, &p)) p.steps++;
  }
}

/* The mirror image on the outside: the whole spectrum, tinted by Fresnel's law; bands need single
 * wavelengths. */
static void follow_mirror(const context *c, const eye_path *first, const abbe_hit *hit,
                          const crossing *x, float random) {
  const abbe_eye_walk *w = c->w;
  eye_path p = *first;
  p.id++;
  float eta, cos_t;
  if (w->bands->count > 0) {
    disperse(&p, random);
    p.share *= reflectance_at(c, x, p.step, p.within, &eta, &cos_t);
  } else {
    float sum[3] = {0};
    uint32_t steps = (uint32_t)w->sampling->steps, size = steps / MIRROR_BANDS;
    for (uint32_t b = 0; b < MIRROR_BANDS; b++) {
      float share = reflectance_at(c, x, b * size + size / 2, 0, &eta, &cos_t);
      for (int k = 0; k < 3; k++) {
        float colour = 0;
        for (uint32_t i = b * size; i < (b + 1) * size; i += size / 16)
          colour += w->colour[i][k] / 16;
        sum[k] += share * colour / MIRROR_BANDS;
      }
    }
    /* the sampled colours' own sum, so that a constant reflectance has no tint */
    for (int k = 0; k < 3; k++) {
      float all = 0;
      for (uint32_t i = 0; i < steps; i += size / 16) all += w->colour[i][k] / (16 * MIRROR_BANDS);
      p.tint[k] *= sum[k] / all;
    }
  }
  p.carried = reflectance_at(c, x, (uint32_t)w->sampling->steps / 2, 0, &eta, &cos_t);
  send(&p, hit, x, true, eta, cos_t);
  follow(c, &p);
}

static void follow_through(const context *c, const eye_path *first, const abbe_hit *hit,
                           const crossing *x, float random) {
  uint32_t count = disperses(c, x) || c->w->media->attenuation != NULL ? HEROES : 1;
  for (uint32_t i = 0; i < count; i++) {
    eye_path p = *first;
    p.id += 2 + i;
    p.share /= (float)count;
    if (count > 1) disperse(&p, ((float)i + random) / (float)count);
    float eta, cos_t, share = reflectance_at(c, x, p.step, p.within, &eta, &cos_t);
    if (share >= 1) continue;
    p.share *= 1 - share;
    p.carried = 1 - share;
    send(&p, hit, x, false, eta, cos_t);
    follow(c, &p);
  }
}

static void add_first(const context *c, const eye_path *p, const abbe_hit *hit, float length) {
  float side = dot(p->d, hit->ng) < 0 ? p->share : -p->share;
  for (int k = 0; k < 3; k++) c->out->normal[k] += side * hit->n[k];
  c->out->depth += p->share * length;
}

/* Number i of a sequence of multiples of a golden ratio, shifted. */
static float place(uint32_t i, uint32_t ratio, float shift) {
  return abbe_random_shift(abbe_random_float(i * ratio), shift);
}

/* One of the pixel's samples: a path from the eye through the place (x, y) on the film. wave, from
 * 0 to 1, chooses wavelengths. */
static void walk_sample(const context *c, eye_path *p, float x, float y, float wave) {
  abbe_hit hit;
  float length;
  abbe_trace_camera_ray(c->w->camera, x, y, p->d);
  bool met = trace(c, p, &hit, &length);
  if (met) add_first(c, p, &hit, length);
  if (!met || hit.surface->kind != ABBE_GEOMETRY_REFRACTORS) {
    arrive(c, p, met, &hit, true);
    return;
  }
  c->out->refractor = true;
  crossing at;
  cross(p, &hit, &at);
  if (abbe_media_same(c->w->media, at.from, at.to)) {
    p->id++;
    p->inside = at.after;
    abbe_geometry_leave(&hit, p->d, p->o);
    follow(c, p);
    return;
  }
  follow_mirror(c, p, &hit, &at, wave);
  follow_through(c, p, &hit, &at, wave);
}

static void clear(const abbe_eye_walk *w, abbe_eye_sample *out) {
  memset(out->rgb, 0, sizeof out->rgb);
  memset(out->caustic, 0, sizeof out->caustic);
  memset(out->albedo, 0, sizeof out->albedo);
  memset(out->normal, 0, sizeof out->normal);
  out->depth = 0;
  memset(out->band, 0, w->bands->count * sizeof *out->band);
  out->refractor = false;
  out->rays = 0;
}

void abbe_eye_walk_pixel(const abbe_eye_walk *w, size_t pixel, uint32_t pass,
                         abbe_eye_sample *out) {
  context c = {.w = w, .pixel = (uint32_t)pixel, .pass = pass, .out = out};
  uint32_t count = w->samples != NULL ? w->samples[pixel] : 1;
  float shift[4], column = (float)(pixel % w->camera->width);
  float row = (float)(pixel / w->camera->width);
  clear(w, out);
  random4(&c, 0, 0, shift);
  for (uint32_t i = 0; i < count; i++) {
    eye_path p = {
        .share = 1 / (float)count, .branch = 1, .tint = {1, 1, 1}, .carried = 1, .id = i * IDS};
    memcpy(p.o, w->camera->eye, sizeof p.o);
    walk_sample(&c, &p, column + place(i, golden[0], shift[0]), row + place(i, golden[1], shift[1]),
                place(i, golden[2], shift[2]));
  }
}
