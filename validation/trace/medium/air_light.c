#include "validation/trace/medium/air_light.h"

#include "base/maths.h"
#include "validation/trace/transport/lamp_place.h"

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* ---- the cone of a spot ---- */

/* In the frame of the tip: whether the place is in the cone. */
static bool is_inside(const double from_tip[3], const double axis[3], double cosine) {
  const double along = abbe_vector_dot(from_tip, axis);
  return along > 0 && along >= cosine * abbe_vector_length(from_tip);
}

bool abbe_air_light_cone(const double tip[3], const double axis[3], double half_angle,
                         const double o[3], const double d[3], double *from, double *to) {
  double v[3], cut[4] = {*from, *from, *to, *to};
  abbe_vector_subtract(o, tip, v);
  const double c = cos(half_angle), c2 = c * c;
  const double da = abbe_vector_dot(d, axis), va = abbe_vector_dot(v, axis);
  const double a = da * da - c2, b = da * va - c2 * abbe_vector_dot(v, d);
  const double e = va * va - c2 * abbe_vector_dot(v, v);
  /* the roots of a t^2 + 2 b t + e, also where a is nearly 0; where there are none, a cut more */
  const double q = -(b + copysign(sqrt(fmax(b * b - a * e, 0)), b)), t[2] = {q / a, e / q};
  for (int k = 0; k < 2; k++)
    if (isfinite(t[k])) cut[1 + k] = fmin(fmax(t[k], *from), *to);
  if (cut[1] > cut[2]) {
    const double swap = cut[1];
    cut[1] = cut[2];
    cut[2] = swap;
  }
  /* a cone is convex: what is inside of it is in one piece */
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < 3; k++) {
    const double middle = 0.5 * (cut[k] + cut[k + 1]);
    double place[3];
    for (int i = 0; i < 3; i++) place[i] = v[i] + middle * d[i];
    if (!(cut[k + 1] > cut[k]) || !is_inside(place, axis, c)) continue;
    low = fmin(low, cut[k]);
    high = fmax(high, cut[k + 1]);
  }
  *from = low;
  *to = high;
  return low < high;
}

static bool clip_to_cone(const abbe_air_ray *r, const abbe_light *light, float *from, float *to) {
  double o[3], d[3], tip[3], low = (double)*from, high = (double)*to;
  float place[3];
  abbe_geometry_to_frame(r->geometry, light->position, place);
  for (int k = 0; k < 3; k++) {
    o[k] = (double)r->o[k];
    d[k] = (double)r->d[k];
    tip[k] = (double)place[k];
  }
  if (!abbe_air_light_cone(tip, light->direction, light->cone_rad, o, d, &low, &high)) return false;
  *from = (float)low;
  *to = (float)high;
  return *from < *to;
}

/* ---- lights ---- */

/* Along the ray, by equal angles about the light: the place t and its density. */
static float place_about(const abbe_air_ray *r, const float lamp[3], float from, float to, float u,
                         float *density) {
  float v[3], square = 0;
  for (int k = 0; k < 3; k++) v[k] = lamp[k] - r->o[k];
  const float middle = dot(v, r->d);
  for (int k = 0; k < 3; k++) square += (v[k] - middle * r->d[k]) * (v[k] - middle * r->d[k]);
  const float height = fmaxf(sqrtf(square), 1e-6f * (1 + fabsf(middle)));
  const float a = atanf((from - middle) / height), b = atanf((to - middle) / height);
  const float angle = a + u * (b - a), off = height * tanf(angle);
  *density = height / ((b - a) * (height * height + off * off));
  return fminf(fmaxf(middle + off, from), to);
}

/* What is scattered at t towards the ray's origin, of light from the unit direction `to` over that
 * distance of air, before shadows; x: the place. */
static float scattered(const abbe_air_ray *r, float t, const float to[3], float distance,
                       float x[3]) {
  const abbe_haze *h = r->haze;
  for (int k = 0; k < 3; k++) x[k] = r->o[k] + t * r->d[k];
  return abbe_haze_scattering(h, -1, r->step, r->within) * abbe_haze_phase(h, -1, dot(to, r->d)) *
         expf(-(t - r->from) * abbe_haze_extinction(h, -1, r->step, r->within)) *
         abbe_haze_left(h, -1, x, to, 0, distance, r->step, r->within);
}

static float sun(const abbe_air_ray *r, const abbe_light *light, float u, uint32_t *rays) {
  float to[3], x[3], density;
  for (int k = 0; k < 3; k++) to[k] = -(float)light->direction[k];
  const float extinction = abbe_haze_extinction(r->haze, -1, r->step, r->within);
  const float t = r->from + abbe_haze_place(extinction, r->to - r->from, u, &density);
  const float share = scattered(r, t, to, INFINITY, x) / density;
  if (!(share > 0)) return 0;
  ++*rays;
  return abbe_geometry_occluded(r->geometry, ABBE_GEOMETRY_ALL, x, to, INFINITY)
             ? 0
             : share * (float)light->power;
}

float abbe_air_light_lamp(const abbe_air_ray *r, size_t index, const float u[3], uint32_t *rays) {
  const abbe_geometry *g = r->geometry;
  const abbe_light *light = &g->scene->light[index];
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) return sun(r, light, u[0], rays);
  float lamp[3], to[3], x[3], from = r->from, end = r->to, density;
  float power = abbe_lamp_place(g, light, u + 1, lamp);
  if (light->kind == ABBE_LIGHT_SPOT && !clip_to_cone(r, light, &from, &end)) return 0;
  const float t = place_about(r, lamp, from, end, u[0], &density);
  for (int k = 0; k < 3; k++) x[k] = r->o[k] + t * r->d[k];
  abbe_lamp_clear(light, x, lamp);
  for (int k = 0; k < 3; k++) to[k] = lamp[k] - x[k];
  const float distance = sqrtf(dot(to, to));
  double away[3];
  for (int k = 0; k < 3; k++) {
    to[k] /= distance;
    away[k] = -(double)to[k];
  }
  if (!abbe_vector_normalise(away)) return 0; /* in the light itself */
  const float metres = distance * (float)g->unit;
  power *= (float)abbe_light_profile(light, away) / (metres * metres);
  if (!(power > 0)) return 0;
  power *= scattered(r, t, to, distance, x) / density;
  ++*rays;
  return abbe_geometry_occluded(g, ABBE_GEOMETRY_ALL, x, to, distance) ? 0 : power;
}

/* ---- surroundings ---- */

void abbe_air_light_surroundings(const abbe_air_ray *r, const abbe_environment_light *e,
                                 const double u[6], float rgb[3], uint32_t *rays) {
  float density, to[2][3], radiance[2][3], pdf[2];
  const float extinction = abbe_haze_extinction(r->haze, -1, r->step, r->within);
  const float t = r->from + abbe_haze_place(extinction, r->to - r->from, (float)u[5], &density);
  abbe_environment_light_sample(e, u, to[0], &pdf[0], radiance[0]);
  abbe_haze_turn(r->haze, -1, r->d, (float)u[3], (float)u[4], to[1]);
  abbe_environment_light_seen(e, to[1], radiance[1]);
  pdf[1] = abbe_environment_light_pdf(e, to[1]);
  for (int k = 0; k < 3; k++) rgb[k] = 0;
  for (int i = 0; i < 2; i++) {
    float x[3];
    const float phase = abbe_haze_phase(r->haze, -1, dot(to[i], r->d));
    const float share = scattered(r, t, to[i], INFINITY, x) / (density * (pdf[i] + phase));
    ++*rays;
    if (abbe_geometry_occluded(r->geometry, ABBE_GEOMETRY_ALL, x, to[i], INFINITY)) continue;
    for (int k = 0; k < 3; k++) rgb[k] += share * radiance[i][k];
  }
}
