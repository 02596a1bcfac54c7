#include "validation/trace/medium/glow.h"
#include "validation/trace/walks/eye_shading.h"

#include <string.h>

/* From inside a solid: where the path leaves it. */
static bool leave_solid(const abbe_geometry *g, const abbe_eye_path *p, abbe_hit *hit,
                        float *length) {
  int refractor = abbe_media_of(p->inside);
  if (refractor < 0 || !abbe_solid_is(&g->solid[refractor])) return false;
  *hit = (abbe_hit){.surface = &g->surface[g->refractor_object[refractor]]};
  *length = abbe_solid_leave(&g->solid[refractor], p->o, p->d, hit->p, hit->n);
  memcpy(hit->ng, hit->n, sizeof hit->ng);
  return true;
}

bool abbe_eye_trace(const abbe_eye_context *c, const abbe_eye_path *p, abbe_hit *hit,
                    float *length) {
  c->out->rays++;
  if (leave_solid(c->w->geometry, p, hit, length)) return true;
  if (!abbe_geometry_hit(c->w->geometry, ABBE_GEOMETRY_ALL, p->o, p->d, INFINITY, hit))
    return false;
  float square = 0;
  for (int k = 0; k < 3; k++) square += (hit->p[k] - p->o[k]) * (hit->p[k] - p->o[k]);
  *length = sqrtf(square);
  return true;
}

static float extinction_at(const abbe_media *m, int medium, const abbe_eye_path *p, uint32_t step,
                           float within) {
  return abbe_haze_is(&m->haze) ? abbe_media_extinction(m, medium, step, within, p->d, p->wave)
                                : abbe_media_loss(m, medium, step, within, p->d, p->wave);
}

/* The step that has the wavelength, or the nearest. */
static uint32_t step_of(const abbe_spectral_sampling *s, double nm, float *within) {
  size_t low = 0, high = s->steps;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    *(s->lambda_nm[middle] <= nm ? &low : &high) = middle;
  }
  const double from = s->lambda_nm[low], to = s->lambda_nm[low + 1];
  *within = (float)fmin(fmax((nm - from) / (to - from), 0), 1);
  return (uint32_t)low;
}

/* What light of the wavelengths around the path's own is weakened more than it on that length in
 * the medium, and turned less where haze turns it at the end. */
static void weigh_beside(const abbe_eye_context *c, abbe_eye_path *p, int medium, float length,
                         bool turns) {
  const abbe_eye_walk *w = c->w;
  const abbe_media *m = w->media;
  if (!p->dispersed || w->grid == NULL || (medium < 0 && !abbe_haze_is_coloured(&m->haze, medium)))
    return;
  p->weighed = true;
  const float whole = extinction_at(m, medium, p, p->step, p->within);
  const float off = turns ? abbe_haze_scattering(&m->haze, medium, p->step, p->within) : 1;
  const double own = abbe_spectral_sampling_lambda(w->sampling, p->step, p->within);
  for (int k = 0; k < ABBE_EYE_BEYOND; k++) {
    float within;
    const double by = 2.0 * k / (ABBE_EYE_BEYOND - 1) - 1;
    const uint32_t step = step_of(w->sampling, own + by * w->window_nm, &within);
    p->beyond[k] += length * (extinction_at(m, medium, p, step, within) - whole);
    if (turns) /* not by nothing, which has no logarithm */
      p->beyond[k] -=
          logf(fmaxf(abbe_haze_scattering(&m->haze, medium, step, within) / off, 1e-30f));
  }
}

void abbe_eye_settle(const abbe_eye_context *c, abbe_eye_path *p) {
  if (p->owed > 0) weigh_beside(c, p, p->owed_in, p->owed, false);
  p->owed = 0;
}

void abbe_eye_weaken(const abbe_eye_context *c, abbe_eye_path *p, float length) {
  const abbe_media *m = c->w->media;
  const int medium = abbe_media_of(p->inside);
  p->share *= expf(-length * extinction_at(m, medium, p, p->step, p->within));
  if (abbe_haze_is(&m->haze) ||
      m->pleochroism != NULL) { /* its depths depend on more than length */
    weigh_beside(c, p, medium, length, false);
    return;
  }
  if (p->owed_in != medium) abbe_eye_settle(c, p);
  p->owed_in = medium;
  p->owed += length;
}

/* By the share that is turned on all of the way, at a place that the scattering draws; roulette
 * takes what is faint. */
bool abbe_eye_turn(const abbe_eye_context *c, abbe_eye_path *p, float length,
                   abbe_eye_path *turned) {
  const abbe_media *m = c->w->media;
  const abbe_haze *h = &m->haze;
  const int medium = abbe_media_of(p->inside);
  const float least = c->w->least_branch;
  if (!abbe_haze_turns(h, medium) || !(length < INFINITY)) return false;
  const float off = abbe_haze_scattering(h, medium, p->step, p->within);
  const float whole = abbe_media_extinction(m, medium, p->step, p->within, p->d, p->wave);
  const float part = -expm1f(-off * length);
  *turned = *p;
  p->branch *= 1 - part;
  turned->branch *= part;
  turned->share *= part;
  float random[4], density;
  if (turned->branch < least) {
    abbe_eye_random4(c, p->id ^ 0x6661696eu, p->steps, random);
    if (!(random[0] * least < turned->branch)) return false;
    turned->share *= least / turned->branch;
    turned->branch = least;
  }
  abbe_eye_random4(c, p->id ^ 0x7475726eu, p->steps, random);
  const float t = abbe_haze_place(off, length, random[0], &density);
  turned->share *= expf(-t * (whole - off));
  weigh_beside(c, turned, medium, t, true);
  for (int k = 0; k < 3; k++) turned->o[k] += t * p->d[k];
  abbe_haze_turn(h, medium, p->d, random[1], random[2], turned->d);
  turned->wave = random[3] < 0.5f;
  turned->lobe = 0;
  memset(turned->stokes, 0, sizeof turned->stokes);
  turned->steps++;
  turned->id = p->id * 0x9e3779b1u + 0x27d4eb2fu;
  return true;
}

bool abbe_eye_glow(const abbe_eye_context *c, const abbe_eye_path *p, float length,
                   abbe_eye_path *from) {
  const abbe_media *m = c->w->media;
  const abbe_haze *h = &m->haze;
  const int medium = abbe_media_of(p->inside);
  float random[4], density, kind[4];
  if (!abbe_haze_glows(h, medium) || !p->dispersed || !(length < INFINITY)) return false;
  abbe_eye_random4(c, p->id ^ 0x676c6f77u, p->steps, random);
  *from = *p;
  from->share *= abbe_glow_excite(h->glow, medium, random[0], &from->step, &from->within);
  if (!(from->share > 0)) return false;
  abbe_eye_random4(c, p->id ^ 0x6b696e64u, p->steps, kind);
  const float whole = abbe_media_extinction(m, medium, p->step, p->within, p->d, p->wave);
  const float t = abbe_haze_place(whole, length, random[1], &density);
  abbe_glow_turn(random[2], random[3], from->d);
  for (int k = 0; k < 3; k++) from->o[k] += t * p->d[k];
  from->wave = kind[0] < 0.5f;
  /* radiance over the squared index is kept, and indices differ */
  const float n = abbe_media_n(m, medium, from->step, from->within) /
                  abbe_media_n(m, medium, p->step, p->within);
  from->share *= n * n * expf(-t * whole) / density *
                 abbe_glow_rate(m, medium, from->step, from->within, from->d, from->wave);
  from->shown = p->glows ? p->shown : p->step;
  from->glows = true;
  memset(from->beyond, 0, sizeof from->beyond);
  from->weighed = false;
  from->lobe = 0;
  memset(from->stokes, 0, sizeof from->stokes);
  from->steps++;
  from->id = p->id * 0x9e3779b1u + 0x165667b1u;
  return from->share > 0;
}

bool abbe_eye_chooses(const abbe_eye_context *c, abbe_eye_path *p, const abbe_eye_path *other) {
  const float both = p->share + other->share;
  float random[4];
  abbe_eye_random4(c, p->id ^ 0x726f6f6du, p->steps, random);
  const bool stays = random[0] * both < p->share;
  if (!stays) *p = *other;
  p->share = both;
  return !stays;
}
