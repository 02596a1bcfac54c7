// Refractors as the eye sees them: one direction a wavelength, each exit that carries enough
// energy followed to what it shows, and the reflection on the outside. Opaque things in front win
// by the depth test.
#include "refractor.glsl"
#include "receiver.glsl"
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;

layout(std140, binding = 6) uniform EyeWeights { vec4 eye_weight[WAVELENGTHS]; };  // rgb, sum 1
uniform vec3 eye;
uniform int refractor;
uniform float share_limit;
#ifdef LAYERS
uniform sampler2DArray eye_layers;  // 0: front, 1: back
#endif
#if defined(LAYERS) || !defined(EXACT_RECEIVERS)
uniform vec4 eye_view[6];
#endif
#ifndef EXACT_RECEIVERS
uniform sampler2DArray eye_receivers;  // lit receivers; distance in w
#endif
layout(location = 0) out vec4 radiance;  // w: distance from the eye

#if defined(LAYERS) || !defined(EXACT_RECEIVERS)
View eye_as_view() {
  return View(eye_view[0], eye_view[1], eye_view[2], eye_view[3], eye_view[4], eye_view[5]);
}
#endif

// Radiance along the ray from p, refractors taken away.
vec3 seen(vec3 p, vec3 d) {
  float t;
#ifdef EXACT_RECEIVERS
  int r = receiver_hit(p, d, scene_size * 1e-6, 1e30, t);
  if (r < 0) return background;
  Receiver rc = receivers[r];
  vec3 x = p + t * d, n = rc.normal.xyz;
  vec2 uv = vec2(dot(x - rc.corner.xyz, rc.du.xyz), dot(x - rc.corner.xyz, rc.dv.xyz));
  Shading s = shade(x, dot(n, d) > 0.0 ? -n : n, int(rc.corner.w), uv);
  return s.direct + s.caustic + s.fill;
#else
  View v = eye_as_view();
  float start = max(distance(refractor_bounds.xyz, p), 0.1 * scene_size);
  if (!march(v, eye_receivers, 0.0, p, d, start, 2.0 * scene_size, t)) return background;
  vec3 uvz;
  if (!project(v, p + t * d, uvz) || !inside(uvz.xy)) return background;
  return textureLod(eye_receivers, vec3(uvz.xy, 0), 0.0).rgb;
#endif
}

void main() {
  vec3 d = normalize(world - eye);
  Hit front;
  front.t = 1e30;
  front.refractor = refractor;
  if (refractors[refractor].info.x == MODEL_LAYERS) {
    front.p = world;
    front.n = normalize(world_normal);
    float c = dot(front.n, d);
    if (c > -1e-3) front.n = normalize(front.n - (c + 1e-3) * d);
    front.t = distance(world, eye);
    front.facet = -1;
  } else if (!exact_front(eye, d, front) || front.refractor != refractor) {
    discard;
  }

  vec3 sum = vec3(0), mirror = vec3(0);
  for (int i = 0; i < WAVELENGTHS; i++) {
    vec2 spectrum = spectra[refractor * WAVELENGTHS + i].xy;
    float n = spectrum.x;
    float reflected = fresnel(-dot(d, front.n), 1.0 / n);
    mirror += reflected * eye_weight[i].rgb;
    vec3 inner, p = front.p;
    if (!refract_direction(d, front.n, 1.0 / n, inner)) continue;
    float share = 1.0 - reflected;
    int facet = front.facet;
    vec3 light = vec3(0);
    for (int order = 0; order < ORDERS; order++) {
      vec3 wall, wall_n, outer;
      int next;
      inner_hit(refractor, facet, p, inner,
#ifdef LAYERS
                eye_as_view(), eye_layers, 1.0,
#endif
                wall, wall_n, next);
#ifdef ABSORBING
      share *= exp(-spectrum.y * distance(wall, p));
#endif
      float kept = fresnel(dot(inner, wall_n), n);
      float out_share = share * (1.0 - kept);
      bool leaves = refract_direction(inner, -wall_n, n, outer);
      if (leaves && out_share > 0.5 * share_limit) light += out_share * seen(wall, outer);
      share *= leaves ? kept : 1.0;
      if (share < share_limit) break;
      p = wall;
      facet = next;
      inner = reflect(inner, wall_n);
    }
    sum += light * eye_weight[i].rgb;
  }
  sum += mirror * seen(front.p, reflect(d, front.n));
  radiance = vec4(sum, front.t);
}
