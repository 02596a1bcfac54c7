#include "validation/walks/eye_shading.h"

#include "scenes/geometry/vector.h"

#include <string.h>

enum { STRAIGHT_SAMPLES = 4 };
static const float inverse_pi = 0.318309886f;

/* Radiance of a light's spectrum times share; reflected NULL: all of it. */
static void add_light(const abbe_eye_context *c, const abbe_eye_path *p, size_t light, float share,
                      const abbe_reflected *reflected) {
  const abbe_eye_walk *w = c->w;
  size_t steps = w->sampling->steps;
  const float *colour = p->dispersed ? w->colour[light * steps + p->step] : w->white[light];
  float of_white[3], kept = 1;
  share *= p->share;
  if (reflected && p->dispersed)
    kept = abbe_reflectance_at_step(w->reflectance, reflected, p->step);
  else if (reflected)
    abbe_reflectance_of_white(w->reflectance, reflected, light, of_white), colour = of_white;
  for (int k = 0; k < 3; k++) c->out->rgb[k] += share * kept * p->tint[k] * colour[k];
  const abbe_bands *b = w->bands;
  for (size_t i = 0; i < b->count; i++) {
    float power = b->power[light * b->count + i];
    if (p->dispersed) {
      if (b->of_step[p->step] != i) continue;
      power = kept * w->sampling->power[light * steps + p->step] / (float)b->width_nm;
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

typedef struct gathering {
  const abbe_eye_context *c;
  const abbe_eye_path *p;
  const abbe_reflected *reflected;
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
  flux *= abbe_reflectance_at_step(w->reflectance, g->reflected, (uint32_t)step);
  for (int k = 0; k < 3; k++) g->sum[k] += flux * w->colour[photon->colour][k];
  if (w->bands->count > 0)
    g->band[w->bands->of_step[step]] +=
        flux * w->sampling->power[photon->colour] / (float)w->bands->width_nm;
}

static void add_caustic(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                        float side, const abbe_reflected *reflected) {
  const abbe_eye_walk *w = c->w;
  if (w->grid == NULL) return;
  gathering g = {.c = c, .p = p, .reflected = reflected};
  abbe_photon_grid_gather(w->grid, hit->p, w->radius,
                          (uint32_t)(hit->surface - w->geometry->surface), side, take_photon, &g);
  float unit = (float)w->geometry->unit, r = w->radius * unit;
  float scale = p->share * inverse_pi * inverse_pi / (r * r);
  for (int k = 0; k < 3; k++) {
    float add = scale * p->tint[k] * g.sum[k];
    c->out->rgb[k] += add;
    c->out->caustic[k] += add;
  }
  for (size_t i = 0; i < w->bands->count; i++) c->out->band[i] += scale * g.band[i];
}

/* Irradiance of a light at the hit on the viewer's side, W/m2, seen past everything. n faces the
 * viewer. */
static float irradiance(const abbe_eye_context *c, const abbe_light *light, const abbe_hit *hit,
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
    } else if (light->kind == ABBE_LIGHT_RECTANGLE) {
      const float x = 2 * random[0] - 1, y = 2 * random[1] - 1, unit = (float)g->unit;
      for (int k = 0; k < 3; k++)
        from[k] += (x * (float)light->edge[0][k] + y * (float)light->edge[1][k]) / unit;
      power *= (float)abbe_light_area(light);
    }
    for (int k = 0; k < 3; k++) d[k] = from[k] - hit->p[k];
    limit = sqrtf(abbe_eye_dot(d, d));
    for (int k = 0; k < 3; k++) d[k] /= limit;
    falloff = 1 / (limit * limit * (float)(g->unit * g->unit));
  }
  float facing = abbe_eye_dot(n, d);
  if (!(facing > 0)) return 0;
  double away[3] = {-(double)d[0], -(double)d[1], -(double)d[2]};
  abbe_vector_normalise(away); /* a narrow cone's cosine asks for more than single precision */
  float e = power * falloff * facing * (float)abbe_light_profile(light, away);
  if (!(e > 0)) return 0;
  abbe_geometry_leave(hit, d, o);
  c->out->rays++;
  unsigned mask = ABBE_GEOMETRY_OBJECTS;
  return abbe_geometry_occluded(g, mask, o, d, limit) ? 0 : e;
}

/* Whether the environment is seen from the hit along d, on the side of n. */
static bool sees_out(const abbe_eye_context *c, const abbe_hit *hit, const float n[3],
                     const float d[3]) {
  float o[3];
  if (!(abbe_eye_dot(n, d) > 0)) return false;
  abbe_geometry_leave(hit, d, o);
  c->out->rays++;
  unsigned mask = ABBE_GEOMETRY_OBJECTS;
  return !abbe_geometry_occluded(c->w->geometry, mask, o, d, INFINITY);
}

/* One direction drawn by the environment's radiance, one by the cosine, weighted by the balance
 * heuristic [VeachGuibas1995]: u in [0, 1)^5. Adds irradiance over pi, RGB. */
static void sample_surroundings(const abbe_eye_context *c, const abbe_hit *hit, const float n[3],
                                const double u[5], float out[3]) {
  const abbe_environment_light *e = c->w->environment;
  float d[3], pdf, rgb[3], x[3], y[3];
  abbe_environment_light_sample(e, u, d, &pdf, rgb);
  float cosine = abbe_eye_dot(n, d) * inverse_pi;
  if (sees_out(c, hit, n, d))
    for (int k = 0; k < 3; k++) out[k] += rgb[k] * cosine / (pdf + cosine);
  abbe_geometry_across(n, x, y);
  float r = sqrtf((float)u[3]), angle = 6.28318531f * (float)u[4];
  for (int k = 0; k < 3; k++)
    d[k] = r * (cosf(angle) * x[k] + sinf(angle) * y[k]) + sqrtf(1 - (float)u[3]) * n[k];
  if (!sees_out(c, hit, n, d)) return;
  cosine = abbe_eye_dot(n, d) * inverse_pi;
  abbe_environment_light_seen(e, d, rgb);
  const float weight = cosine / (abbe_environment_light_pdf(e, d) + cosine);
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
  float random[8];
  double u[5];
  abbe_eye_random4(c, ~p->id ^ 0x736b79u, p->steps, random);
  abbe_eye_random4(c, ~p->id ^ 0x68656d69u, p->steps, random + 4);
  memset(out, 0, 3 * sizeof *out);
  for (uint32_t i = 0; i < count; i++) {
    for (int k = 0; k < 5; k++)
      u[k] = (double)abbe_random_shift(abbe_random_float(i * golden[k]), random[k]);
    u[0] += 0x1p-24 * (double)random[5]; /* as texels may be many */
    sample_surroundings(c, hit, n, u, out);
  }
  for (int k = 0; k < 3; k++) out[k] /= (float)count;
}

static void shade(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                  bool straight) {
  const abbe_eye_walk *w = c->w;
  const abbe_scene *scene = w->geometry->scene;
  float albedo[3], n[3], random[4];
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
    float e = irradiance(c, &scene->light[l], hit, n, random);
    if (e > 0) add_light(c, p, l, e * inverse_pi, &reflected);
  }
  if (w->environment->environment != NULL) {
    float rgb[3];
    surrounding_light(c, p, hit, n, straight, rgb);
    add_environment(c, p, rgb, 1, &reflected);
  }
  if (scene->ambient > 0) add_white(c, p, (float)scene->ambient * inverse_pi, &reflected);
  if (!straight) add_caustic(c, p, hit, side, &reflected);
}

/* Radiance over the squared index is the same on both sides of an interface [BornWolf1999, 4.8]:
 * what a path of the eye brings of what is shown at its end. */
static float spread(const abbe_eye_context *c, const abbe_eye_path *p, bool within) {
  const int end = within ? abbe_media_of(p->inside) : -1, eye = abbe_media_of(c->w->inside);
  if (end == eye) return 1;
  const float n = abbe_media_n(c->w->media, eye, p->step, p->within) /
                  abbe_media_n(c->w->media, end, p->step, p->within);
  return n * n;
}

/* What ends a path: a receiver, a lamp, or nothing at all. */
void abbe_eye_arrive(const abbe_eye_context *c, const abbe_eye_path *path, bool met,
                     const abbe_hit *hit, bool straight) {
  const abbe_scene *scene = c->w->geometry->scene;
  const bool received = met && hit->surface->kind == ABBE_GEOMETRY_RECEIVERS;
  abbe_eye_path own = *path;
  const abbe_eye_path *p = &own;
  own.share *= spread(c, path, received);
  if (!met) {
    if (scene->background > 0) add_white(c, p, (float)scene->background, NULL);
    if (c->w->environment->environment == NULL) return;
    float rgb[3];
    abbe_environment_light_seen(c->w->environment, p->d, rgb);
    add_environment(c, p, rgb, 1, NULL);
  } else if (received) {
    shade(c, p, hit, straight);
  } else if (abbe_eye_dot(p->d, hit->n) < 0) {
    size_t l = hit->surface->index;
    add_light(c, p, l, (float)scene->light[l].power, NULL);
  }
}
