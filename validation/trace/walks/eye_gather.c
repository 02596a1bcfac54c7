#include "validation/trace/medium/glow.h"
#include "validation/trace/walks/eye_shading.h"

#include <string.h>

static const float inverse_pi = 0.318309886f;

typedef struct gathering {
  const abbe_eye_context *c;
  const abbe_eye_path *p;
  abbe_eye_path settled;           /* the same, once a photon asks */
  const abbe_reflected *reflected; /* table of a receiver */
  int medium;                      /* medium that scatters */
  float from;                      /* where the haze begins on the path */
  double own_nm, density;          /* of a dispersed path, and of paths by wavelength there, 1/nm */
  float sum[3];
  float band[ABBE_BANDS_MAX];
} gathering;

/* Most of its room stays unused. */
static void begin(gathering *g, const abbe_eye_context *c, const abbe_eye_path *p) {
  const abbe_spectral_sampling *s = c->w->sampling;
  const double *nm = s->lambda_nm + p->step;
  g->c = c;
  g->p = p;
  g->own_nm = abbe_spectral_sampling_lambda(s, p->step, p->within);
  g->density = 1 / ((double)s->steps * (nm[1] - nm[0]));
  memset(g->sum, 0, sizeof g->sum);
  memset(g->band, 0, c->w->bands->count * sizeof *g->band);
}

/* What the path's media leave of light so many windows beside its own wavelength, -1 to 1, by what
 * they leave of that. */
static float left_beside(const abbe_eye_path *p, double off) {
  const float at = (float)(0.5 * (off + 1) * (ABBE_EYE_BEYOND - 1));
  int k = (int)roundf(at);
  k = k < 1 ? 1 : k < ABBE_EYE_BEYOND - 1 ? k : ABBE_EYE_BEYOND - 2;
  const float *d = p->beyond + k, f = at - (float)k;
  const float bend = d[1] - 2 * d[0] + d[-1]; /* a parabola by the three nearest */
  return expf(-(d[0] + 0.5f * f * (d[1] - d[-1] + f * bend)));
}

/* How much a photon of that step counts for the path: of one wavelength, in a window of wavelengths
 * around it, cut at the ends of the range. The path is weakened as light of the photon's own
 * wavelength: a coloured stone lets pass what it has let in, and the window would mix that with
 * what it takes. */
static float window(gathering *g, size_t step) {
  const abbe_eye_walk *w = g->c->w;
  const abbe_eye_path *p = g->p;
  if (!p->dispersed) return 1;
  const size_t steps = w->sampling->steps;
  const double *nm = w->sampling->lambda_nm, own = g->own_nm;
  double other = 0.5 * (nm[step] + nm[step + 1]);
  if (fabs(own - other) > w->window_nm) return 0;
  if (p->owed > 0) {
    g->settled = *p;
    abbe_eye_settle(g->c, &g->settled);
    g->p = p = &g->settled;
  }
  const double low = other - w->window_nm, high = other + w->window_nm;
  double span = (high < nm[steps] ? high : nm[steps]) - (low > nm[0] ? low : nm[0]);
  const float share = (float)(1 / (span * g->density));
  return p->weighed ? share * left_beside(p, (other - own) / w->window_nm) : share;
}

/* As what glows within a step in light of that colour. */
static size_t glow_of(const abbe_spectral_sampling *s, size_t colour, uint32_t shown) {
  const size_t row = colour / s->steps;
  return (row < s->lights ? row + s->lights : row) * s->steps + shown;
}

static void add_photon(gathering *g, size_t colour, float flux) {
  const abbe_eye_walk *w = g->c->w;
  if (g->p->glows) {
    flux *= w->sampling->power[colour];
    colour = glow_of(w->sampling, colour, g->p->shown);
  }
  for (int k = 0; k < 3; k++) g->sum[k] += flux * w->colour[colour][k];
  if (w->bands->count > 0)
    g->band[w->bands->of_step[colour % w->sampling->steps]] +=
        flux * w->sampling->power[colour] / (float)w->bands->width_nm;
}

static void take_photon(void *user, const abbe_grid_photon *photon) {
  gathering *g = user;
  const abbe_eye_walk *w = g->c->w;
  const size_t step = photon->colour % w->sampling->steps;
  const float flux = fabsf(photon->flux) * window(g, step);
  if (flux > 0)
    add_photon(g, photon->colour,
               flux * abbe_reflectance_at_step(w->reflectance, g->reflected, (uint32_t)step));
}

/* What was gathered, times scale, into the sample. */
static void add_gathered(const gathering *g, float scale, bool caustic) {
  abbe_eye_sample *out = g->c->out;
  for (int k = 0; k < 3; k++) {
    const float add = scale * g->p->tint[k] * g->sum[k];
    out->rgb[k] += add;
    if (caustic) out->caustic[k] += add;
  }
  for (size_t i = 0; i < g->c->w->bands->count; i++) out->band[i] += scale * g->band[i];
}

void abbe_eye_gather_caustic(const abbe_eye_context *c, const abbe_eye_path *p, const abbe_hit *hit,
                             float side, const abbe_reflected *reflected) {
  const abbe_eye_walk *w = c->w;
  if (w->grid == NULL) return;
  gathering g;
  begin(&g, c, p);
  g.reflected = reflected;
  abbe_photon_grid_gather(w->grid, hit->p, w->radius,
                          (uint32_t)(hit->surface - w->geometry->surface), side, take_photon, &g);
  float unit = (float)w->geometry->unit, r = w->radius * unit;
  add_gathered(&g, p->share * inverse_pi * inverse_pi / (r * r), true);
}

/* What a photon that ends there makes glow, at the path's own wavelength. */
static void take_glow(gathering *g, const abbe_haze_photon *photon, float t) {
  const abbe_spectral_sampling *s = g->c->w->sampling;
  const abbe_haze *h = &g->c->w->media->haze;
  const uint32_t shown = g->p->step, step = (uint32_t)(photon->colour % s->steps);
  const float yield = abbe_glow_yield(h->glow, g->medium, step, shown);
  const float left = expf(-(t - g->from) * abbe_haze_extinction(h, g->medium, shown, g->p->within));
  add_photon(g, glow_of(s, photon->colour, shown),
             0.0795774715f * photon->glow * s->power[photon->colour] * yield * left);
}

static void take_scattered(void *user, const abbe_haze_photon *photon, float t) {
  gathering *g = user;
  const abbe_eye_walk *w = g->c->w;
  const abbe_haze *h = &w->media->haze;
  const uint32_t step = (uint32_t)(photon->colour % w->sampling->steps);
  if (photon->glow > 0) take_glow(g, photon, t);
  float flux = photon->flux * window(g, step);
  if (!(flux > 0)) return;
  flux *= abbe_haze_phase(h, g->medium, -abbe_eye_dot(photon->d, g->p->d));
  add_photon(g, photon->colour,
             flux * expf(-(t - g->from) * abbe_haze_extinction(h, g->medium, step, 0.5f)));
}

void abbe_eye_gather_shafts(const abbe_eye_context *c, const abbe_eye_path *p, int medium,
                            float from, float to, float radius) {
  const abbe_eye_walk *w = c->w;
  gathering g;
  begin(&g, c, p);
  g.medium = medium;
  g.from = from;
  abbe_haze_grid_gather(w->shafts, p->o, p->d, from, to, radius, medium, take_scattered, &g);
  const float r = radius * (float)w->geometry->unit;
  add_gathered(&g, p->share * inverse_pi / (r * r), false);
}
