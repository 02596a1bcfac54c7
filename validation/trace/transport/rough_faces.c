#include "base/maths.h"
#include "spectral/microfacets.h"
#include "validation/trace/transport/double_refraction.h"
#include "validation/trace/transport/interface.h"
#include "validation/trace/transport/random.h"

#include <math.h>
#include <string.h>

enum { MOST_FACETS = 1000 };

/* Light between the facets of a face. Its coordinates are those of the side that it is on: x, y and
 * the face's normal there. */
typedef struct between {
  const abbe_media *m;
  abbe_wave_face face; /* of the facet: from where the light is */
  uint32_t step;
  float within;
  abbe_microfacets facets;
  double axis[3][3], w[3];
  double height;   /* share of the surface that is below it, on its side */
  double left;     /* share of the light */
  bool crossed;    /* it is on the other side */
  float stokes[3]; /* of polarised light, to which the face points */
} between;

static void to_world(const between *b, const double v[3], float out[3]) {
  for (int k = 0; k < 3; k++)
    out[k] = (float)(v[0] * b->axis[0][k] + v[1] * b->axis[1][k] + v[2] * b->axis[2][k]);
}

static void to_own(const between *b, const float v[3], double out[3]) {
  for (int i = 0; i < 3; i++) {
    out[i] = 0;
    for (int k = 0; k < 3; k++) out[i] += b->axis[i][k] * (double)v[k];
  }
  abbe_vector_normalise(out);
}

static void begin(const abbe_media *m, const abbe_wave_face *face, uint32_t step, float within,
                  between *b) {
  const double least = 1e-6;
  float x[3], y[3];
  *b = (between){.m = m, .face = *face, .step = step, .within = within, .height = 1, .left = 1};
  b->facets = (abbe_microfacets){(double)face->rough, (double)face->rough};
  if (face->stokes != NULL) memcpy(b->stokes, face->stokes, sizeof b->stokes);
  if (face->stokes != NULL) b->face.stokes = b->stokes;
  abbe_geometry_across(face->n, x, y);
  for (int k = 0; k < 3; k++) {
    b->axis[0][k] = (double)x[k];
    b->axis[1][k] = (double)y[k];
    b->axis[2][k] = (double)face->n[k];
  }
  to_own(b, face->d, b->w);
  b->w[2] = fmin(b->w[2], -least);
  abbe_vector_normalise(b->w);
}

/* Through a facet to the other side, whose coordinates are the negative ones. */
static void cross_over(between *b) {
  const int from = b->face.from;
  b->face.from = b->face.to;
  b->face.to = from;
  b->face.entering = !b->face.entering;
  b->height = 1 - b->height;
  b->crossed = !b->crossed;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) b->axis[i][k] = -b->axis[i][k];
}

/* Or of polarised light. */
static bool between_crystals(const between *b) {
  return b->face.stokes != NULL || abbe_media_is_crystal(b->m, b->face.from) ||
         abbe_media_is_crystal(b->m, b->face.to);
}

/* For glass: the share that the facet reflects, the ratio of indices, and what a film leaves. */
static float reflectance(const between *b, float cos_i, float *eta, float *cos_t, float *passes) {
  const float n[2] = {abbe_media_n(b->m, b->face.from, b->step, b->within),
                      abbe_media_n(b->m, b->face.to, b->step, b->within)};
  *eta = n[0] / n[1];
  *passes = 1;
  const float bare = abbe_interface_reflectance(cos_i, *eta, cos_t);
  return b->face.film < 0 ? bare
                          : abbe_films_reflectance(&b->m->films, b->face.film, b->face.entering,
                                                   n[0], n[1], cos_i, b->step, b->within, passes);
}

/* Puts the facet of normal h in place of the face; the cosine to it. */
static float turn_to(between *b, const double h[3]) {
  to_world(b, h, b->face.n);
  to_world(b, b->w, b->face.d);
  return (float)fmin(-abbe_vector_dot(b->w, h), 1);
}

/* What facets where it is send towards the look, past all others: 1/sr. */
static double seen(between *b, const float to[3], float stokes[3]) {
  double t[3], wave[3], h[3], q = 0, back[3];
  float eta, cos_t, passes = 1, share, ray[3];
  to_own(b, to, t);
  const bool through = t[2] < 0;
  if ((through ? b->face.to : b->face.from) >= 0) return 0;
  to_world(b, b->w, ray);
  const double world[3] = {(double)ray[0], (double)ray[1], (double)ray[2]};
  abbe_media_wave_vector(b->m, b->face.from, b->step, b->within, b->face.wave, world, wave);
  for (int i = 0; i < 3; i++) {
    h[i] = through ? abbe_vector_dot(b->axis[i], wave) - t[i] : t[i] - b->w[i];
    q += h[i] * h[i];
    back[i] = -b->w[i];
  }
  const double side = h[2] < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++) h[i] *= side / sqrt(q);
  const double along = abbe_vector_dot(h, t);
  if (!(q > 0) || !(abbe_vector_dot(back, h) > 0) || !(through ? along < 0 : along > 0)) return 0;
  const float cos_i = turn_to(b, h);
  if (between_crystals(b)) {
    abbe_wave_ways ways;
    abbe_media_ways(b->m, &b->face, b->step, b->within, &ways);
    share = ways.reflected;
    passes = ways.passes;
    for (size_t i = 0; i < ways.count; i++)
      if (ways.way[i].reflected != through) memcpy(stokes, ways.way[i].stokes, 3 * sizeof *stokes);
  } else {
    share = reflectance(b, cos_i, &eta, &cos_t, &passes);
  }
  const double spread = through ? fabs(along) / q : 1 / (4 * along);
  const double up[3] = {through ? -t[0] : t[0], through ? -t[1] : t[1], fabs(t[2])};
  return b->left * (double)(passes * (through ? 1 - share : share)) * spread *
         abbe_microfacets_normals(&b->facets, back, h) *
         abbe_microfacets_escape(&b->facets, up, through ? 1 - b->height : b->height);
}

/* At a facet of normal h: on as chance and which decide. */
static void meet(between *b, const double h[3], float chance, float which) {
  const float cos_i = turn_to(b, h);
  float d[3], eta, cos_t, passes;
  bool reflects;
  if (between_crystals(b)) {
    abbe_wave_ways ways;
    abbe_media_ways(b->m, &b->face, b->step, b->within, &ways);
    const abbe_wave_way *way = abbe_wave_ways_choose(&ways, chance, which);
    memcpy(d, way->d, sizeof d);
    b->face.wave = way->wave;
    memcpy(b->stokes, way->stokes, sizeof b->stokes);
    passes = ways.passes;
    reflects = way->reflected;
  } else {
    reflects = chance < reflectance(b, cos_i, &eta, &cos_t, &passes);
    if (reflects)
      abbe_interface_reflect(b->face.d, b->face.n, cos_i, d);
    else
      abbe_interface_refract(b->face.d, b->face.n, eta, cos_i, cos_t, d);
  }
  b->left *= (double)passes;
  if (!reflects) cross_over(b);
  to_own(b, d, b->w);
}

uint32_t abbe_media_roughen(const abbe_media *m, const abbe_wave_face *face, uint32_t step,
                            float within, const uint32_t key[4], abbe_rough_look *look,
                            size_t looks, abbe_wave_way *out) {
  between b;
  begin(m, face, step, within, &b);
  for (size_t i = 0; i < looks; i++)
    look[i] = (abbe_rough_look){.to = {look[i].to[0], look[i].to[1], look[i].to[2]}};
  for (uint32_t facet = 0; facet < MOST_FACETS; facet++) {
    float random[8];
    for (uint32_t i = 0; i < 2; i++)
      abbe_random4(key[0], key[1], key[2], key[3] + (2 * facet + i) * 0x9e3779b1u, random + 4 * i);
    if (!abbe_microfacets_travel(&b.facets, b.w, (double)random[0], &b.height)) {
      *out = (abbe_wave_way){.share = (float)b.left, .wave = b.face.wave, .reflected = !b.crossed};
      memcpy(out->stokes, b.stokes, sizeof out->stokes);
      to_world(&b, b.w, out->d);
      return facet;
    }
    for (size_t i = 0; i < looks; i++) {
      float stokes[3] = {0, 0, 0};
      const float density = (float)seen(&b, look[i].to, stokes);
      look[i].density += density;
      for (int k = 0; k < 3; k++) look[i].stokes[k] += density * stokes[k];
    }
    const double back[3] = {-b.w[0], -b.w[1], -b.w[2]},
                 u[2] = {(double)random[1], (double)random[2]};
    double h[3], ignored[3];
    abbe_microfacets_sample(&b.facets, back, u, h, ignored);
    meet(&b, h, random[3], random[4]);
  }
  *out = (abbe_wave_way){.reflected = true};
  to_world(&b, (double[]){0, 0, 1}, out->d);
  return MOST_FACETS;
}
