#include "validation/trace/tracer/tracer_state.h"

#include "validation/trace/medium/glow.h"
#include "validation/trace/transport/random.h"

#include <stdlib.h>
#include <string.h>

/* ---- to the camera ---- */

void abbe_shaft_photons_flush(abbe_shaft_photons *s) {
  if (s->waiting == 0) return;
  abbe_embree_occluded_16(s->geometry->embree, &s->packet, s->waiting);
  for (size_t k = 0; k < s->waiting; k++)
    if (!(s->packet.tfar[k] < 0)) s->add(s->user, &s->splat[k]);
  s->rays += s->waiting;
  s->waiting = 0;
}

static void aim_at_eye(abbe_shaft_photons *s, const float o[3], const float d[3], float distance) {
  struct RTCRay16 *r = &s->packet;
  const size_t k = s->waiting++;
  r->org_x[k] = o[0];
  r->org_y[k] = o[1];
  r->org_z[k] = o[2];
  r->dir_x[k] = d[0];
  r->dir_y[k] = d[1];
  r->dir_z[k] = d[2];
  r->tnear[k] = 0;
  r->tfar[k] = distance;
  r->mask[k] = ABBE_GEOMETRY_ALL;
  r->flags[k] = 0;
}

static void splat(abbe_shaft_photons *s, const abbe_light_stretch *from, const float p[3],
                  float flux) {
  float d[3], distance, per_pixel;
  size_t pixel;
  if (from->medium != s->eye_medium) return;
  if (!abbe_trace_camera_pixel(s->camera, p, &pixel, &distance, d, &per_pixel)) return;
  if (!(distance > s->near)) return;
  float cosine = 0;
  for (int k = 0; k < 3; k++) {
    d[k] = -d[k];
    cosine += d[k] * from->d[k];
  }
  const float metres = distance * (float)s->geometry->unit;
  const float value =
      flux * abbe_haze_phase(&s->media->haze, from->medium, cosine) * per_pixel /
      (metres * metres) *
      abbe_haze_left(&s->media->haze, from->medium, p, d, 0, distance, from->step, from->within);
  if (!(value > 0)) return;
  s->splat[s->waiting] = (abbe_shaft_splat){pixel, from->step, from->glows, value};
  aim_at_eye(s, p, d, distance);
  if (s->waiting == ABBE_SHAFT_LANES) abbe_shaft_photons_flush(s);
}

/* ---- to gathers ---- */

static void keep(abbe_shaft_photons *s, const abbe_light_stretch *from, const float p[3],
                 float flux, float glow) {
  if (s->count == s->room) {
    const size_t room = s->room > 0 ? 2 * s->room : 4096;
    abbe_haze_photon *all = realloc(s->photon, room * sizeof *all);
    s->full = s->full || all == NULL;
    if (all == NULL) return;
    s->photon = all;
    s->room = room;
  }
  abbe_haze_photon *to = &s->photon[s->count++];
  *to = (abbe_haze_photon){.flux = flux,
                           .glow = glow,
                           .colour = (from->glows ? s->glow : s->colour) + from->step,
                           .medium = (int32_t)from->medium};
  memcpy(to->p, p, sizeof to->p);
  memcpy(to->d, from->d, sizeof to->d);
}

/* ---- near faces ---- */

enum { PROBES = 14, FACES = 3 };

/* A face near a place: its normal, outwards, and how far away its plane is, frame. */
typedef struct near_face {
  float n[3], distance;
} near_face;

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The face that the medium ends at along unit d, within the limit; d may be out->n. */
static bool look(const abbe_shaft_photons *s, int medium, const float p[3], const float d[3],
                 float limit, near_face *out) {
  abbe_hit hit;
  float way[3];
  if (!abbe_geometry_hit(s->geometry, ABBE_GEOMETRY_REFRACTORS, p, d, limit, &hit) ||
      hit.surface->index != (uint32_t)medium)
    return false;
  const float side = dot(d, hit.ng) < 0 ? -1 : 1;
  for (int k = 0; k < 3; k++) {
    way[k] = hit.p[k] - p[k];
    out->n[k] = side * hit.ng[k];
  }
  out->distance = dot(way, out->n);
  return true;
}

/* Faces within the radius, of those that lean to each other by less than 45 degrees the nearest. */
static int find_faces(const abbe_shaft_photons *s, int medium, const float p[3],
                      near_face out[FACES]) {
  const float third = 0.577350269f;
  int count = 0;
  for (int i = 0; i < PROBES; i++) {
    float d[3] = {0};
    if (i < 6) d[i / 2] = i % 2 ? 1 : -1;
    for (int k = 0; i >= 6 && k < 3; k++) d[k] = (i - 6) >> k & 1 ? third : -third;
    near_face f;
    int at = 0;
    /* no direction is more than 37 degrees from a probe's */
    if (!look(s, medium, p, d, 1.26f * s->radius, &f) || !look(s, medium, p, f.n, s->radius, &f))
      continue;
    while (at < count && dot(out[at].n, f.n) < 0.7f) at++;
    if (at < FACES && (at == count || f.distance < out[at].distance)) out[at] = f;
    if (at == count && at < FACES) count++;
  }
  return count;
}

/* Mirrored at a face, and at two or three that stand at right angles, about: what a gather lacks
 * behind them. Light goes the way that it had, for it stands for the light before the face. */
static void keep_mirrored(abbe_shaft_photons *s, const abbe_light_stretch *from, const float p[3],
                          float flux, float glow) {
  near_face face[FACES];
  const int count = find_faces(s, from->medium, p, face);
  for (int set = 1; set < 1 << count; set++) {
    float q[3] = {p[0], p[1], p[2]}, square = 0;
    bool right = true;
    for (int i = 0; i < count; i++) {
      if (!(set >> i & 1)) continue;
      for (int j = 0; j < i; j++) right &= !(set >> j & 1) || dot(face[i].n, face[j].n) < 0.3f;
      float way[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
      const float beyond = 2 * (face[i].distance - dot(way, face[i].n));
      for (int k = 0; k < 3; k++) q[k] += beyond * face[i].n[k];
      square += face[i].distance * face[i].distance;
    }
    if (right && square < s->radius * s->radius) keep(s, from, q, flux, glow);
  }
}

void abbe_shaft_photons_take(void *user, const abbe_light_stretch *from) {
  abbe_shaft_photons *s = user;
  const abbe_haze *h = &s->media->haze;
  float near = 0, far = from->length, random[4], density, p[3];
  const bool glows = abbe_haze_glows(h, from->medium);
  if ((glows || abbe_haze_turns(h, from->medium)) && (s->found || from->known)) return;
  if ((!glows && !abbe_haze_scatters(h, from->medium)) ||
      !abbe_haze_clip(h, from->medium, from->o, from->d, &near, &far) || !(far < INFINITY))
    return;
  const float extinction =
      abbe_media_extinction(s->media, from->medium, from->step, from->within, from->d, from->wave);
  abbe_random4(from->id, from->steps, s->pass, s->seed ^ 0x73686674u, random);
  const float t = abbe_haze_place(extinction, far - near, random[0], &density);
  const float there = from->flux * expf(-t * extinction) / density;
  const float flux = there * abbe_haze_scattering(h, from->medium, from->step, from->within);
  const float glow =
      there * abbe_glow_rate(s->media, from->medium, from->step, from->within, from->d, from->wave);
  if (!(flux > 0 || glow > 0)) return;
  for (int k = 0; k < 3; k++) p[k] = from->o[k] + (near + t) * from->d[k];
  splat(s, from, p, flux);
  keep(s, from, p, flux, glow);
  if (from->medium >= 0) keep_mirrored(s, from, p, flux, glow);
}

void abbe_shaft_photons_free(abbe_shaft_photons *s) {
  if (s == NULL) return;
  free(s->photon);
  s->photon = NULL;
  s->count = s->room = 0;
}
