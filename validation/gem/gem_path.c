#include "validation/gem/gem_path.h"

#include "validation/transport/interface.h"

#include <math.h>

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool abbe_gem_path_enter(const abbe_gem_stone *s, const double o[3], const double d[3], double p[3],
                         double n[3]) {
  double enter = -INFINITY, leave = INFINITY;
  const double *face = NULL;
  for (size_t j = 0; j < s->plane_count; j++) {
    const double *plane = s->plane[j];
    const double ahead = dot(plane, d), off = plane[3] - dot(plane, o);
    if (ahead < 0 && off / ahead > enter) {
      enter = off / ahead;
      face = plane;
    }
    if (ahead > 0) leave = fmin(leave, off / ahead);
    if (ahead == 0 && off < 0) return false;
  }
  if (face == NULL || !(enter < leave)) return false;
  for (int k = 0; k < 3; k++) {
    p[k] = o[k] + enter * d[k];
    n[k] = face[k];
  }
  return true;
}

static void add_exit(abbe_gem_path *path, const float d[3], float share) {
  abbe_gem_exit *e = &path->exit[path->count++];
  for (int k = 0; k < 3; k++) e->d[k] = d[k];
  e->share = share;
}

void abbe_gem_path_follow(const abbe_gem_stone *s, size_t k, const double p0[3], const double n0[3],
                          const double d0[3], abbe_gem_path *out) {
  float p[3], n[3], d[3], way[3], cos_t;
  for (int i = 0; i < 3; i++) {
    p[i] = (float)p0[i];
    n[i] = (float)n0[i];
    d[i] = (float)d0[i];
  }
  out->count = 0;
  out->absorbed = 0;
  float cos_i = fminf(fmaxf(-(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]), 0), 1);
  float reflected = abbe_interface_reflectance(cos_i, 1 / s->n[k], &cos_t);
  abbe_interface_reflect(d, n, cos_i, way);
  add_exit(out, way, reflected);
  abbe_interface_refract(d, n, 1 / s->n[k], cos_i, cos_t, way);
  float share = 1 - reflected;
  for (int face = 1; face < ABBE_GEM_MOST_FACES && out->count < ABBE_GEM_MOST_EXITS &&
                     share >= ABBE_GEM_LEAST_SHARE;
       face++) {
    for (int i = 0; i < 3; i++) d[i] = way[i];
    float q[3], t = abbe_solid_leave(&s->solid, p, d, q, n);
    for (int i = 0; i < 3; i++) p[i] = q[i];
    if (s->attenuation[k] > 0) {
      const float kept = share * expf(-s->attenuation[k] * t);
      out->absorbed += share - kept;
      share = kept;
    }
    /* the normal on the side that the light comes from */
    cos_i = 0;
    for (int i = 0; i < 3; i++) {
      cos_i += d[i] * n[i];
      n[i] = -n[i];
    }
    cos_i = fminf(fmaxf(cos_i, 0), 1);
    reflected = abbe_interface_reflectance(cos_i, s->n[k], &cos_t);
    if (reflected < 1) {
      abbe_interface_refract(d, n, s->n[k], cos_i, cos_t, way);
      add_exit(out, way, share * (1 - reflected));
      share *= reflected;
    }
    abbe_interface_reflect(d, n, cos_i, way);
  }
  out->left = share;
}
