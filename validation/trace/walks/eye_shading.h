/* eye_shading.h: what the paths of the camera find at their ends: receivers with the light on them,
 * the environment, the background, lights.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_EYE_SHADING_H
#define ABBE_VALIDATION_TRACE_WALKS_EYE_SHADING_H

#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/random.h"
#include "validation/trace/walks/eye_walk.h"

enum { ABBE_EYE_BEYOND = 7 };

/* A path from the camera. Where it is not dispersed it carries the whole spectrum, else one
 * wavelength. */
typedef struct abbe_eye_path {
  float o[3], d[3];
  float share;   /* share of its light, all wavelengths alike */
  float branch;  /* that part of it which interfaces inside the glass left */
  float tint[3]; /* a colour on top of that */
  bool dispersed;
  uint32_t step;
  float within;
  float beyond[ABBE_EYE_BEYOND]; /* optical depths at wavelengths from one window of gathers below
                                    its own, evenly, to one above, less its own depth */
  bool weighed;                  /* not all of them are 0 */
  float owed;                    /* its way in owed_in that is not in beyond yet */
  int owed_in;
  bool glows;     /* it has gone back from a glow to what excites it: */
  uint32_t shown; /* the step in which the camera sees that */
  abbe_media_set inside;
  float carried; /* matched: what a splitting path would carry */
  uint32_t walls, steps, id;
  uint8_t wave;    /* in a crystal: which of its two */
  float lobe;      /* density with which the rough mirror that it comes from sent it on, 1/sr; 0: it
                      comes from none */
  float stokes[3]; /* of polarised light, outside of crystals: of what the camera would see, as if
                      it shone */
} abbe_eye_path;

typedef struct abbe_eye_context {
  const abbe_eye_walk *w;
  uint32_t pixel, pass;
  abbe_eye_sample *out;
} abbe_eye_context;

static inline float abbe_eye_dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void abbe_eye_random_bits(const abbe_eye_context *c, uint32_t a, uint32_t b,
                                        uint32_t out[4]) {
  abbe_random_bits(c->pixel, c->pass, a, (c->w->seed ^ 0x657965u) + b * 0x9e3779b1u, out);
}

static inline void abbe_eye_random4(const abbe_eye_context *c, uint32_t a, uint32_t b,
                                    float out[4]) {
  uint32_t bits[4];
  abbe_eye_random_bits(c, a, b, bits);
  for (int k = 0; k < 4; k++) out[k] = abbe_random_float(bits[k]);
}

/* wave: a fraction of 2^32 of the spectrum. */
static inline void abbe_eye_disperse(abbe_eye_path *p, uint32_t wave) {
  if (p->dispersed) return;
  p->dispersed = true;
  p->step = abbe_spectral_sampling_step(wave, &p->within);
}

/* What the path meets next, and how far off; false: nothing. */
bool abbe_eye_trace(const abbe_eye_context *context, const abbe_eye_path *path, abbe_hit *hit,
                    float *length);

/* Takes what the medium absorbs and scatters of the path on its way of that length. */
void abbe_eye_weaken(const abbe_eye_context *context, abbe_eye_path *path, float length);
/* Puts the way that is owed into beyond, which photons alone ask for: most paths meet none. */
void abbe_eye_settle(const abbe_eye_context *context, abbe_eye_path *path);

/* What a refractor that scatters more than once turns of the path on its way of that length, before
 * it is weakened: as *turned where that goes on. Shares of both branches are those of what came. */
bool abbe_eye_turn(const abbe_eye_context *context, abbe_eye_path *path, float length,
                   abbe_eye_path *turned);

/* What a refractor glows on the path's way of that length: *from goes back from there to what
 * excites it, at another wavelength; false: there is none. */
bool abbe_eye_glow(const abbe_eye_context *context, const abbe_eye_path *path, float length,
                   abbe_eye_path *from);

/* One of both goes on for both, by chance of their shares: true where that is the other, now in
 * *path. */
bool abbe_eye_chooses(const abbe_eye_context *context, abbe_eye_path *path,
                      const abbe_eye_path *other);

/* What ends a path goes into the sample: a receiver, a light, or nothing at all. straight: the
 * camera's own ray, whose caustic the photons bring. */
void abbe_eye_arrive(const abbe_eye_context *context, const abbe_eye_path *path, bool met,
                     const abbe_hit *hit, bool straight);

/* The caustic at a receiver that a path meets, on that side, and light that refractors and mirrors
 * send to the haze on [from, to] of its way: from the photons around, into the sample. */
void abbe_eye_gather_caustic(const abbe_eye_context *context, const abbe_eye_path *path,
                             const abbe_hit *hit, float side, const abbe_reflected *reflected);
void abbe_eye_gather_shafts(const abbe_eye_context *context, const abbe_eye_path *path, int medium,
                            float from, float to, float radius);

/* What haze on the path's way of that length, or INFINITY, adds to the sample and takes of the
 * path. Where its coefficients vary over wavelength the path is dispersed. straight: as above. */
void abbe_eye_haze(const abbe_eye_context *context, abbe_eye_path *path, float length,
                   bool straight);

/* What a rough face shows of lights without size, which no path meets; *way: one way on from it. */
void abbe_eye_roughen(const abbe_eye_context *context, const abbe_eye_path *path,
                      const abbe_hit *hit, const abbe_wave_face *face, abbe_wave_way *way);
/* What a rough mirror shows of lights and the environment that it sees straight: of what comes to
 * it by other paths a path's next ray brings, and of these, too, where their weights allow
 * [VeachGuibas1995]. n: on the path's side. */
void abbe_eye_gloss(const abbe_eye_context *context, const abbe_eye_path *path, const abbe_hit *hit,
                    const float n[3], const abbe_rough_hit *rough);

#endif
