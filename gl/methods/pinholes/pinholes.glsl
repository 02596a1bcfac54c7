// Samples of surfaces as pinholes through which receivers see what is around [WandStrasser2003]; rows as
// gl/methods/pinholes/pinhole_samples.h has them.
uniform samplerBuffer pinholes;
#include "pinhole_sky.glsl"

struct Pinhole {
  vec3 p, n;              // n towards who looks
  float area, half_width;  // m2; half of the samples' spacing, m
  vec3 u, v;               // unit tangents
  vec2 turn;               // change of the normal along them, 1/m
  vec3 colour;
};

// As seen from a place: of a sheet the side that is seen.
Pinhole pinhole_at(int i, vec3 from) {
  vec4 place = texelFetch(pinholes, 4 * i), normal = texelFetch(pinholes, 4 * i + 1);
  vec4 along = texelFetch(pinholes, 4 * i + 2), rest = texelFetch(pinholes, 4 * i + 3);
  float side = normal.w < 0.0 && dot(normal.xyz, from - place.xyz) < 0.0 ? -1.0 : 1.0;
  vec3 v = normalize(cross(normal.xyz, along.xyz));
  return Pinhole(place.xyz, side * normal.xyz, place.w, abs(normal.w), along.xyz, v, side * vec2(along.w, rest.w),
                 rest.rgb);
}

// Where light comes from that a mirror at p of a normal sends to a place.
vec3 mirrored(vec3 from, vec3 p, vec3 n) { return reflect(normalize(p - from), normalize(n)); }

// By how much that differs half a spacing away along u, and along v.
void footprint(Pinhole s, vec3 from, vec3 r, out vec3 by_u, out vec3 by_v) {
  vec3 u = s.half_width * s.u, v = s.half_width * s.v;
  by_u = mirrored(from, s.p + u, s.n + s.turn.x * u) - r;
  by_v = mirrored(from, s.p + v, s.n + s.turn.y * v) - r;
}
