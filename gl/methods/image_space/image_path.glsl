// The ray by which light leaves what a view sees at a pixel of its objects, at a wavelength: through two
// interfaces by the distance between front and back along the view's ray [Wyman2005], through one (INTERFACES
// 1), or off a mirror. Positions and directions in the scene's own coordinates.
#include "optics.glsl"

struct Ray {
  vec3 o, r;
  float share;   // share of its light
  float inside;  // attenuation along its path, 1/m: of what follows, where light stays in the refractor
  float n;       // index of what it goes on in: 1 is air
  bool total;    // it was totally reflected at the back, and goes on in the mirror direction
};

uniform int object_face;   // whose pixels these are
uniform vec2 grid_shift;  // shift of the objects' pixels, as a share of the window

#ifdef MIRRORS
float mirrored_share(vec4 spectrum, float c) {
  float lost = spectrum.w < 0.0 ? spectrum.y : spectrum.y * (1.0 - fresnel_conductor(c, spectrum.z, spectrum.w));
  return 1.0 - clamp(lost, 0.0, 1.0);
}
#endif

// n of the back where the ray comes out of the front at p along t; the silhouette where none is seen there.
vec3 normal_behind(vec3 p, vec3 t) {
#if OBJECT_FACES > 1
  int face = cube_face(p - seen_from[0].xyz);
#else
  int face = 0;
#endif
  View v = object_view(face);
  vec3 uvz, n = vec3(0);
  bool before = project(v, p, uvz);
  uvz.xy -= grid_shift;
  if (before && inside(uvz.xy)) n = textureLod(object_normals, vec3(uvz.xy, 2 * face + 1), 0.0).xyz;
  if (dot(n, n) < 1e-6) n = t - dot(t, v.forward.xyz) * v.forward.xyz;
  return normalize(n);
}

// False where nothing is seen.
bool leave_object(ivec2 pixel, int wavelength, out Ray ray) {
  ivec3 texel = ivec3(pixel, 2 * object_face);
  vec4 front = texelFetch(object_places, texel, 0), normal = texelFetch(object_normals, texel, 0);
  int refractor = int(normal.w + 0.5) - 1;
  ray = Ray(front.xyz, vec3(0), 1.0, 0.0, 1.0, false);
  if (front.w < 0.5 || refractor < 0) return false;
  vec4 spectrum = spectra[refractor * counts.wavelengths + wavelength];
  vec3 d = seen_direction(front.xyz), n = normal.xyz;
#ifdef MIRRORS
  if (refractors[refractor].info.z == -1) {
    n = dot(n, d) > 0.0 ? -n : n;
    ray.r = reflect(d, n);
    ray.share = mirrored_share(spectrum, -dot(d, n));
    return true;
  }
#endif
  vec3 inner;
  float index = spectrum.x;
  refract_direction(d, n, 1.0 / index, inner);
#ifndef AS_PRINTED
  ray.share = 1.0 - fresnel(-dot(d, n), 1.0 / index);
#endif
  vec4 back = texelFetch(object_places, texel + ivec3(0, 0, 1), 0);
  ray.r = inner;
#if INTERFACES == 1
  ray.inside = spectrum.y;
  ray.n = index;
  return true;
#else
  float way = back.w > 0.5 ? distance(back.xyz, front.xyz) : 0.0;
  ray.o = front.xyz + way * inner;
  vec3 n2 = normal_behind(ray.o, inner);
  ray.share *= exp(-spectrum.y * way);
  ray.total = !refract_direction(inner, -n2, index, ray.r);
  if (ray.total) ray.r = reflect(inner, n2);
#ifndef AS_PRINTED
  if (!ray.total) ray.share *= 1.0 - fresnel(dot(inner, n2), index);
#endif
  return true;
#endif
}
