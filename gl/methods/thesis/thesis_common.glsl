// The thesis's own shading functions [Blanchette2012], kept as they are described there: view space
// of the light or the camera, depths unprojected from the depth buffer, the brightness factors of its
// appendix. window is left, right, bottom, top on the plane at distance 1; planes is
// near * far, far - near, far.
uniform mat4 projection;
uniform vec4 window;
uniform vec3 planes;

#ifdef CIE
#include "optics.glsl"
const float OUTSIDE = 1.0;  // indices are relative to the air
#else
const float OUTSIDE = 1.0003;
#endif

vec2 to_texture(vec4 p) {
  vec4 c = projection * p;
  return 0.5 * c.xy / c.w + 0.5;
}

vec3 direction_at(vec2 uv) { return normalize(vec3(mix(window.xz, window.yw, uv), -1.0)); }

// Depth-buffer value to view-space z, negative.
float to_z(float depth) { return planes.x / (depth * planes.y - planes.z); }

// Refraction that answers total internal reflection with the mirror direction and w = -1.
vec4 refraction(vec3 incident, vec3 normal, float ni_nt) {
  float c = dot(-incident, normal);
  float cos_sqr = 1.0 - ni_nt * ni_nt * (1.0 - c * c);
  if (cos_sqr <= 0.0) return vec4(normalize(reflect(incident, normal)), -1.0);
  return vec4(normalize(ni_nt * incident + (ni_nt * c - sqrt(cos_sqr)) * normal), 1.0);
}

// Two interfaces by the distance between front and back along the view; the receiver by
// `iterations` steps of the image-space search. Position in view space. passes: the share of the
// light that the two interfaces let through.
vec4 find_receiver(vec3 p1, vec3 n1, float d_v, float n, sampler2DArray normals,
                   sampler2D receiver_depth, int iterations, out float passes) {
  vec3 t1 = refract(normalize(p1), n1, OUTSIDE / n);
  vec4 p2 = vec4(t1 * d_v + p1, 1.0);
  vec3 n2 = texture(normals, vec3(to_texture(p2), 1.0)).xyz;
  if (dot(n2, n2) == 0.0) n2 = normalize(vec3(t1.xy, 0.0));
  vec4 t2 = refraction(t1, -n2, n);
  passes = 1.0;
#ifdef CIE
  // Where all light is reflected it goes on as in the thesis, and none is taken off.
  passes = 1.0 - fresnel(dot(-normalize(p1), n1), 1.0 / n);
  if (t2.w > 0.0) passes *= 1.0 - fresnel(dot(t1, n2), n);
#endif
  t2.w = 0.0;
  vec4 step_ = t2 / -t2.z;
  float at = 1000.0, nearest = 1000.0;
  for (float guess = 0.0; guess < 2.0; guess += 1.0) {
    float d = -to_z(texture(receiver_depth, to_texture(p2 + step_ * guess)).x) + p2.z;
    if (abs(d - guess) < nearest) {
      nearest = abs(d - guess);
      at = guess;
    }
  }
  for (int i = 0; i < iterations; i++)
    at = -to_z(texture(receiver_depth, to_texture(p2 + at * step_)).x) + p2.z;
  return p2 + at * step_;
}
