#include "validation/trace/walks/eye_shading.h"

#include "base/maths.h"
#include "validation/trace/medium/air_light.h"
#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/lamp_place.h"

#include <string.h>

enum { STRAIGHT_SAMPLES = 4 };
static const float inverse_pi = 0.318309886f;

void abbe_eye_walk_band(const abbe_eye_walk *w, uint32_t bands, uint32_t b, float out[3]) {
  const uint32_t size = (uint32_t)w->sampling->steps / bands, parts = ABBE_EYE_PARTS / bands;
  for (int k = 0; k < 3; k++) {
    out[k] = 0;
    for (uint32_t i = b * size; i < (b + 1) * size; i += size / parts)
      out[k] += w->colour[i][k] / (float)parts;
  }
}

void abbe_eye_walk_prepare(abbe_eye_walk *w) {
  const uint32_t steps = (uint32_t)w->sampling->steps;
  for (uint32_t b = 0; b < ABBE_EYE_MIRRORED; b++)
    abbe_eye_walk_band(w, ABBE_EYE_MIRRORED, b, w->mirrored[b]);
  for (int k = 0; k < 3; k++) {
    w->sampled[k] = 0;
    for (uint32_t i = 0; i < steps; i += steps / ABBE_EYE_PARTS)
      w->sampled[k] += w->colour[i][k] / ABBE_EYE_PARTS;
  }
}

/* Radiance of a light's spectrum times share; reflected NULL: all of it. */
static void add_light(const abbe_eye_context *c, const abbe_eye_path *p, size_t light, float share,
                      const abbe_reflected *reflected) {
  const abbe_eye_walk *w = c->w;
  size_t steps = w->sampling->steps;
  const float *colour = p->dispersed ? w->colour[light * steps + p->step] : w->white[light];
  float of_white[3], kept = 1;
  share *= p->share;
  size_t seen = light * steps + p->step;
  if (p->glows) {
    share *= w->sampling->power[seen];
    seen = (w->sampling->lights + light) * steps + p->shown;
    colour = w->colour[seen];
  }
  if (reflected && p->dispersed)
    kept = abbe_reflectance_at_step(w->reflectance, reflected, p->step);
  else if (reflected)
    abbe_reflectance_of_white(w->reflectance, reflected, light, of_white), colour = of_white;
  for (int k = 0; k < 3; k++) c->out->rgb[k] += share * kept * p->tint[k] * colour[k];
  const abbe_bands *b = w->bands;
  for (size_t i = 0; i < b->count; i++) {
    float power = b->power[light * b->count + i];
    if (p->dispersed) {
      if (b->of_step[seen % steps] != i) continue;
      power = kept * w->sampling->power[seen] / (float)b->width_nm;
    } else if (reflected) {
      power *= abbe_reflectance_in_band(w->reflectance, reflected, light, i);
    }
    c->out->band[i] += share * power;
  }
}

/* Ambient light and background: the first light's spectrum, whose colour becomes white. */
static void add_white(const abbe_eye_context *c, const abbe_eye_path *p, float share,
                      const abbe_reflected *reflected) {
  float before[3], add[3];
  memcpy(before, c->out->rgb, sizeof before);
  add_light(c, p, 0, share, reflected);
  for (int k = 0; k < 3; k++) add[k] = c->out->rgb[k] - before[k];
  abbe_reflectance_whiten(c->w->reflectance, add, add);
  for (int k = 0; k < 3; k++) c->out->rgb[k] = before[k] + add[k];
}

/* Radiance of the environment, RGB relative to its illuminant, times share. */
static void add_environment(const abbe_eye_context *c, const abbe_eye_path *p, const float rgb[3],
                            float share, const abbe_reflected *reflected) {
  const abbe_eye_walk *w = c->w;
  const abbe_environment_light *e = w->environment;
  if (p->dispersed) {
    const float *lift = e->lift[p->step];
    add_light(c, p, e->light, share * abbe_eye_dot(lift, rgb), reflected);
    return;
  }
  float colour[3];
  for (int k = 0; k < 3; k++) colour[k] = abbe_eye_dot(&e->to_colour[3 * k], rgb);
  if (reflected) abbe_reflectance_of_lifted(w->reflectance, reflected, rgb, colour);
  share *= p->share;
  for (int k = 0; k < 3; k++) c->out->rgb[k] += share * p->tint[k] * colour[k];
  const abbe_bands *b = w->bands;
  for (size_t i = 0; i < b->count; i++) {
    float kept = reflected ? abbe_reflectance_in_band(w->reflectance, reflected, e->light, i) : 1;
    c->out->band[i] +=
        share * kept * abbe_eye_dot(e->band[i], rgb) * b->power[e->light * b->count + i];
  }
}

/* What haze in the air leaves of light that comes straight along -d over that distance. */
static float left_of(const abbe_eye_context *c, const abbe_eye_path *p, const float o[3],
                     const float d[3], float distance) {
  return abbe_haze_left(&c->w->media->haze, -1, o, d, 0, distance, p->step, p->within);
}

/* Irradiance of a light at the hit on the viewer's side, W/m2, seen past everything; d: unit,
 * towards it. n faces the viewer. */
static float irradiance(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_light *light,
                        const abbe_hit *hit, const float n[3], const float random[2], float d[3]) {
  const abbe_geometry *g = c->w->geometry;
  float from[3], o[3], limit = INFINITY, power = (float)light->power, falloff = 1;
  for (int k = 0; k < 3; k++) d[k] = -(float)light->direction[k];
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    power = abbe_lamp_place(g, light, random, from);
    abbe_lamp_clear(light, hit->p, from);
    for (int k = 0; k < 3; k++) d[k] = from[k] - hit->p[k];
    limit = sqrtf(abbe_eye_dot(d, d));
    for (int k = 0; k < 3; k++) d[k] /= limit;
    falloff = 1 / (limit * limit * (float)(g->unit * g->unit));
  }
  float facing = abbe_eye_dot(n, d);
  if (!(facing > 0)) return 0;
  double away[3] = {-(double)d[0], -(double)d[1], -(double)d[2]};
  abbe_vector_normalise(away); /* a narrow cone's cosine needs more than single precision */
  float e = power * falloff * facing * (float)abbe_light_profile(light, away);
  if (!(e > 0)) return 0;
  abbe_geometry_leave(hit, d, o);
  c->out->rays++;
  unsigned mask = ABBE_GEOMETRY_ALL;
  return abbe_geometry_occluded(g, mask, o, d, limit) ? 0 : e * left_of(c, p, o, d, limit);
}

/* How much of the environment is seen from the hit along d, on the side of n: 0 where something
 * hides it. */
static float sees_out(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                      const float n[3], const float d[3]) {
  float o[3];
  if (!(abbe_eye_dot(n, d) > 0)) return 0;
  abbe_geometry_leave(hit, d, o);
  c->out->rays++;
  unsigned mask = ABBE_GEOMETRY_ALL;
  const bool hidden = abbe_geometry_occluded(c->w->geometry, mask, o, d, INFINITY);
  return hidden ? 0 : left_of(c, p, o, d, INFINITY);
}

/* One direction drawn by the environment's radiance, one by the cosine, weighted by the balance
 * heuristic [VeachGuibas1995]: u in [0, 1)^5. Adds irradiance over pi, RGB. */
static void sample_surroundings(const abbe_eye_context *c, const abbe_eye_path *p,
                                const abbe_hit *hit, const float n[3], const double u[5],
                                float out[3]) {
  const abbe_environment_light *e = c->w->environment;
  float d[3], pdf, rgb[3], x[3], y[3];
  abbe_environment_light_sample(e, u, d, &pdf, rgb);
  float cosine = abbe_eye_dot(n, d) * inverse_pi;
  float seen = sees_out(c, p, hit, n, d);
  for (int k = 0; seen > 0 && k < 3; k++) out[k] += seen * rgb[k] * cosine / (pdf + cosine);
  abbe_geometry_across(n, x, y);
  float r = sqrtf((float)u[3]), angle = 6.28318531f * (float)u[4];
  for (int k = 0; k < 3; k++)
    d[k] = r * (cosf(angle) * x[k] + sinf(angle) * y[k]) + sqrtf(1 - (float)u[3]) * n[k];
  seen = sees_out(c, p, hit, n, d);
  if (!(seen > 0)) return;
  cosine = abbe_eye_dot(n, d) * inverse_pi;
  abbe_environment_light_seen(e, d, rgb);
  const float weight = seen * cosine / (abbe_environment_light_pdf(e, d) + cosine);
  for (int k = 0; k < 3; k++) out[k] += rgb[k] * weight;
}

/* Irradiance of the environment at the hit on the side of n, over pi, RGB; on what the camera sees
 * straight by more samples, multiples of golden ratios of five dimensions [Roberts2018], for there
 * the path behind is cheap. */
static void surrounding_light(const abbe_eye_context *c, const abbe_eye_path *p,
                              const abbe_hit *hit, const float n[3], bool straight, float out[3]) {
  static const uint32_t golden[5] = {3785032107u, 3335640777u, 2939605023u, 2590590015u,
                                     2283013049u};
  const uint32_t count = straight ? STRAIGHT_SAMPLES : 1;
  uint32_t shift[8];
  double u[5];
  abbe_eye_random_bits(c, ~p->id ^ 0x736b79u, p->steps, shift);
  abbe_eye_random_bits(c, ~p->id ^ 0x68656d69u, p->steps, shift + 4);
  memset(out, 0, 3 * sizeof *out);
  for (uint32_t i = 0; i < count; i++) {
    u[0] = abbe_random_double(i * golden[0] + shift[0], shift[5]);
    for (int k = 1; k < 5; k++) u[k] = (double)abbe_random_float(i * golden[k] + shift[k]);
    sample_surroundings(c, p, hit, n, u, out);
  }
  for (int k = 0; k < 3; k++) out[k] /= (float)count;
}

static void shade(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                  bool straight) {
  const abbe_eye_walk *w = c->w;
  const abbe_scene *scene = w->geometry->scene;
  float albedo[3], n[3], random[4], to[3];
  abbe_reflected reflected;
  uint32_t surface = (uint32_t)(hit->surface - w->geometry->surface);
  abbe_reflectance_find(w->reflectance, surface, hit->face, hit->u, hit->v, &reflected);
  abbe_reflectance_of_white(w->reflectance, &reflected, 0, albedo);
  abbe_reflectance_whiten(w->reflectance, albedo, albedo);
  for (int k = 0; k < 3; k++) c->out->albedo[k] += p->share * p->tint[k] * albedo[k];
  float side = abbe_eye_dot(p->d, hit->ng) < 0 ? 1 : -1;
  const float *normal = abbe_eye_dot(hit->n, p->d) * side < 0 ? hit->n : hit->ng;
  for (int k = 0; k < 3; k++) n[k] = side * normal[k];
  for (size_t l = 0; l < scene->light_count; l++) {
    abbe_eye_random4(c, ~p->id, (uint32_t)(p->steps * ABBE_SCENE_MAX_LIGHTS + l), random);
    float e = irradiance(c, p, &scene->light[l], hit, n, random, to);
    if (e > 0) add_light(c, p, l, e * inverse_pi, &reflected);
  }
  if (w->environment->environment != NULL) {
    float rgb[3];
    surrounding_light(c, p, hit, n, straight, rgb);
    add_environment(c, p, rgb, 1, &reflected);
  }
  if (scene->ambient > 0) add_white(c, p, (float)scene->ambient * inverse_pi, &reflected);
  if (!straight) abbe_eye_gather_caustic(c, p, hit, side, &reflected);
}

/* Radiance over the squared index is the same on both sides of an interface [BornWolf1999, 4.8]:
 * what a path of the camera brings of what is shown at its end. */
static float spread(const abbe_eye_context *c, const abbe_eye_path *p, bool within) {
  const int end = within ? abbe_media_of(p->inside) : -1, eye = abbe_media_of(c->w->inside);
  if (end == eye) return 1;
  const float n = abbe_media_n(c->w->media, eye, p->step, p->within) /
                  abbe_media_n(c->w->media, end, p->step, p->within);
  return n * n;
}

/* ---- haze ---- */

/* Light that lights and surroundings send straight to the haze in the air on the path's way; more
 * samples where the path behind is cheap. */
static void add_air_light(const abbe_eye_context *c, const abbe_eye_path *p,
                          const abbe_air_ray *ray, bool straight) {
  const abbe_scene *scene = c->w->geometry->scene;
  const uint32_t count = straight ? STRAIGHT_SAMPLES : 1;
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t salt = 0x68617a65u + i;
    uint32_t bits[8];
    float u[4];
    for (size_t l = 0; l < scene->light_count; l++) {
      abbe_eye_random_bits(c, ~p->id ^ salt, (uint32_t)(p->steps * ABBE_SCENE_MAX_LIGHTS + l),
                           bits);
      bits[0] = abbe_random_part(bits[0], i, count);
      for (int k = 0; k < 4; k++) u[k] = abbe_random_float(bits[k]);
      const float radiance = abbe_air_light_lamp(ray, l, u, &c->out->rays);
      if (radiance > 0) add_light(c, p, l, radiance / (float)count, NULL);
    }
    if (c->w->environment->environment == NULL) continue;
    abbe_eye_random_bits(c, ~p->id ^ salt ^ 0x736b79u, p->steps, bits);
    abbe_eye_random_bits(c, ~p->id ^ salt ^ 0x68656d69u, p->steps, bits + 4);
    double all[6] = {abbe_random_double(bits[0], bits[7])};
    for (int k = 1; k < 6; k++) all[k] = (double)abbe_random_float(bits[k]);
    float rgb[3];
    abbe_air_light_surroundings(ray, c->w->environment, all, rgb, &c->out->rays);
    add_environment(c, p, rgb, 1 / (float)count, NULL);
  }
}

void abbe_eye_haze(const abbe_eye_context *c, abbe_eye_path *p, float length, bool straight) {
  const abbe_eye_walk *w = c->w;
  const abbe_haze *h = &w->media->haze;
  const int medium = abbe_media_of(p->inside);
  float from = 0, to = length;
  if (!abbe_haze_clip(h, medium, p->o, p->d, &from, &to)) return;
  if (abbe_haze_scatters(h, medium) || abbe_haze_glows(h, medium)) {
    abbe_eye_path own = *p;
    own.share *= spread(c, p, true);
    const abbe_air_ray ray = {.geometry = w->geometry,
                              .haze = h,
                              .o = {p->o[0], p->o[1], p->o[2]},
                              .d = {p->d[0], p->d[1], p->d[2]},
                              .from = from,
                              .to = to,
                              .step = p->step,
                              .within = p->within};
    if (medium < 0) add_air_light(c, &own, &ray, straight);
    /* farther off, photons find a camera that sees them straight by themselves */
    const float end = straight ? fminf(to, w->shaft_near) : to;
    const float radius = straight ? 0.25f * w->shaft_radius : w->shaft_radius;
    if (w->shafts != NULL && end > from && end < INFINITY)
      abbe_eye_gather_shafts(c, &own, medium, from, end, radius);
  }
  abbe_eye_weaken(c, p, to - from);
}

/* Density of a light's even points over its area by solid angle, where unit d meets it at p, 1/sr;
 * 0 of one without size. */
static float lamp_pdf(const abbe_geometry *g, const abbe_light *light, const float from[3],
                      const float d[3], const float p[3]) {
  const float unit = (float)g->unit, area = (float)abbe_light_area(light) / (unit * unit);
  float square = 0, facing = 0;
  if (!abbe_light_has_size(light)) return 0;
  for (int k = 0; k < 3; k++) {
    square += (p[k] - from[k]) * (p[k] - from[k]);
    facing -= d[k] * (float)light->direction[k];
  }
  return facing > 0 ? square / (facing * area) : 0;
}

/* Where the ray from p along unit d meets the light's plane. */
static void on_lamp(const abbe_geometry *g, const abbe_light *light, const float p[3],
                    const float d[3], float out[3]) {
  float centre[3], along = 0, away = 0;
  abbe_geometry_to_frame(g, light->position, centre);
  for (int k = 0; k < 3; k++) {
    away += (centre[k] - p[k]) * (float)light->direction[k];
    along += d[k] * (float)light->direction[k];
  }
  for (int k = 0; k < 3; k++) out[k] = p[k] + away / along * d[k];
}

/* How much more of a light's own radiance the path brings than of unpolarised light. */
static float analysed(const abbe_eye_context *c, size_t light, const float d[3],
                      const float stokes[3]) {
  float own[3];
  if (!c->w->physics.polarised) return 1;
  abbe_polarised_lamp(&c->w->geometry->scene->light[light], d, own);
  return 1 + abbe_eye_dot(own, stokes);
}

/* What the facet reflects towards d, and what the path is polarised to there. */
static float glossed(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                     const float d[3], float cos_h, float stokes[3]) {
  const abbe_mirrors *m = c->w->mirrors;
  const float share = abbe_mirrors_reflect(m, hit->surface->index, cos_h, p->step, p->within);
  if (!c->w->physics.polarised) return share;
  memcpy(stokes, p->stokes, sizeof p->stokes);
  return share * abbe_polarised_mirror(m, hit->surface->index, p->d, d, p->step, p->within, stokes);
}

static void gloss_of_surroundings(const abbe_eye_context *c, const abbe_eye_path *p,
                                  const abbe_hit *hit, const float n[3],
                                  const abbe_rough_hit *rough) {
  const abbe_environment_light *e = c->w->environment;
  uint32_t bits[4];
  float d[3], rgb[3], pdf, lobe_pdf, cos_h, stokes[3];
  abbe_eye_random_bits(c, ~p->id ^ 0x676c6f73u, p->steps, bits);
  const double u[3] = {abbe_random_double(bits[0], bits[3]), (double)abbe_random_float(bits[1]),
                       (double)abbe_random_float(bits[2])};
  abbe_environment_light_sample(e, u, d, &pdf, rgb);
  const float f = abbe_mirrors_lobe(rough, d, &lobe_pdf, &cos_h);
  const float seen = f > 0 ? sees_out(c, p, hit, n, d) : 0;
  if (!(seen > 0)) return;
  const float share = seen * f * abbe_eye_dot(n, d) / (pdf + lobe_pdf);
  add_environment(c, p, rgb, share * glossed(c, p, hit, d, cos_h, stokes), NULL);
}

void abbe_eye_gloss(const abbe_eye_context *c, const abbe_eye_path *path, const abbe_hit *hit,
                    const float n[3], const abbe_rough_hit *rough) {
  const abbe_eye_walk *w = c->w;
  const abbe_scene *scene = w->geometry->scene;
  abbe_eye_path own = *path;
  own.share *= spread(c, path, true);
  for (size_t l = 0; l < scene->light_count; l++) {
    const abbe_light *light = &scene->light[l];
    float random[4], d[3], p[3], lobe_pdf, cos_h, weight = 1, stokes[3];
    abbe_eye_random4(c, ~path->id ^ 0x6c616d70u,
                     (uint32_t)(path->steps * ABBE_SCENE_MAX_LIGHTS + l), random);
    const float e = irradiance(c, path, light, hit, n, random, d);
    const float f = e > 0 ? abbe_mirrors_lobe(rough, d, &lobe_pdf, &cos_h) : 0;
    if (!(f > 0)) continue;
    if (abbe_light_has_size(light)) {
      on_lamp(w->geometry, light, hit->p, d, p);
      const float pdf = lamp_pdf(w->geometry, light, hit->p, d, p);
      weight = pdf / (pdf + lobe_pdf);
    }
    weight *= glossed(c, &own, hit, d, cos_h, stokes);
    if (w->physics.polarised) weight *= analysed(c, l, d, stokes);
    add_light(c, &own, l, e * f * weight, NULL);
  }
  if (w->environment->environment != NULL) gloss_of_surroundings(c, &own, hit, n, rough);
}

void abbe_eye_roughen(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                      const abbe_wave_face *face, abbe_wave_way *way) {
  const abbe_scene *scene = c->w->geometry->scene;
  abbe_rough_look look[ABBE_SCENE_MAX_LIGHTS];
  float power[ABBE_SCENE_MAX_LIGHTS], random[4];
  size_t of[ABBE_SCENE_MAX_LIGHTS], looks = 0;
  const float away[3] = {-face->n[0], -face->n[1], -face->n[2]};
  for (size_t l = 0; l < scene->light_count; l++) {
    if (abbe_light_has_size(&scene->light[l])) continue;
    abbe_eye_random4(c, ~p->id ^ 0x6c616d70u, (uint32_t)(p->steps * ABBE_SCENE_MAX_LIGHTS + l),
                     random);
    for (int side = 0; side < 2; side++) {
      float *to = look[looks].to;
      const float *n = side == 0 ? face->n : away;
      const float e = (side == 0 ? face->from : face->to) < 0
                          ? irradiance(c, p, &scene->light[l], hit, n, random, to)
                          : 0;
      if (!(e > 0)) continue;
      power[looks] = e / abbe_eye_dot(n, to);
      of[looks++] = l;
      break;
    }
  }
  uint32_t key[4];
  abbe_eye_random_bits(c, p->id ^ 0x66726f73u, p->steps, key);
  abbe_media_roughen(c->w->media, face, p->step, p->within, key, look, looks, way);
  abbe_eye_path own = *p;
  own.share *= spread(c, p, false);
  for (size_t i = 0; i < looks; i++) {
    if (!(look[i].density > 0)) continue;
    for (int k = 0; k < 3; k++) look[i].stokes[k] /= look[i].density;
    const float share = look[i].density * analysed(c, of[i], look[i].to, look[i].stokes);
    add_light(c, &own, of[i], power[i] * share, NULL);
  }
}

/* What is left to a path off a rough mirror, which has looked for what has that density itself. */
static float weight_of(const abbe_eye_path *p, float pdf) {
  return p->lobe > 0 ? p->lobe / (p->lobe + pdf) : 1;
}

/* What ends a path: a receiver, a light, or nothing at all. */
void abbe_eye_arrive(const abbe_eye_context *c, const abbe_eye_path *path, bool met,
                     const abbe_hit *hit, bool straight) {
  const abbe_scene *scene = c->w->geometry->scene;
  const bool received = met && hit->surface->kind == ABBE_GEOMETRY_RECEIVERS;
  abbe_eye_path own = *path;
  const abbe_eye_path *p = &own;
  own.share *= spread(c, path, received);
  if (!met) {
    if (straight && scene->transparent) return;
    if (scene->background > 0) add_white(c, p, (float)scene->background, NULL);
    if (c->w->environment->environment == NULL) return;
    float rgb[3];
    abbe_environment_light_seen(c->w->environment, p->d, rgb);
    const float pdf = p->lobe > 0 ? abbe_environment_light_pdf(c->w->environment, p->d) : 0;
    add_environment(c, p, rgb, weight_of(p, pdf), NULL);
  } else if (received) {
    shade(c, p, hit, straight);
  } else if (abbe_eye_dot(p->d, hit->n) < 0) {
    size_t l = hit->surface->index;
    const float pdf = lamp_pdf(c->w->geometry, &scene->light[l], p->o, p->d, hit->p);
    add_light(c, p, l,
              (float)scene->light[l].power * weight_of(p, pdf) * analysed(c, l, p->d, p->stokes),
              NULL);
  }
}
