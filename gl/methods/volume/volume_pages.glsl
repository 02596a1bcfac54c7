// Caustics of rays that leave an object, on maps of receivers (scenes/volume/exits/exit_pages.h): for each light
// and each side of each parallelogram a layer of the whole and one of a window.
uniform sampler2DArray volume_pages;
uniform vec4 volume_window[VOLUME_PAGES * LIGHTS];

// How far a place is from a parallelogram, in parts of its edges.
float volume_off(Receiver r, vec3 p, out vec2 uv) {
  uv = receiver_uv(r, p);
  vec2 over = max(abs(uv - 0.5) - 0.5, vec2(0));
  return over.x + over.y + abs(dot(r.normal.xyz, p) - r.normal.w) * (length(r.du.xyz) + length(r.dv.xyz));
}

// area: of what p stands for, in parts of the parallelogram.
void volume_nearer(int i, Receiver r, vec3 p, vec3 n, vec3 right, vec3 above, inout float least, inout vec3 place,
                   inout float area) {
  vec2 uv;
  float off = volume_off(r, p, uv);
  bool nearer = off < least;
  place = nearer ? vec3(uv, 2 * i + (dot(n, r.normal.xyz) > 0.0 ? 0 : 1)) : place;
  float own = dot(right, r.du.xyz) * dot(above, r.dv.xyz) - dot(above, r.du.xyz) * dot(right, r.dv.xyz);
  area = nearer ? abs(own) : area;
  least = nearer ? off : least;
}

// XYZ irradiance of unit power on the side of a receiver at p that n points from: of all that p stands for, by
// the level whose texels are about as large.
vec3 volume_irradiance(int light, vec3 p, vec3 n) {
#if defined(SEEN_BY_PIXELS)
  vec3 right = dFdx(p), above = dFdy(p);
#elif defined(SEEN_BY_AREAS)
  vec3 right = area_right, above = area_above;
#else
  const vec3 right = vec3(0), above = vec3(0);
#endif
  vec3 place = vec3(0);
  float least = 1e30, area = 0.0;
#define VOLUME_NEARER(i) volume_nearer(i, RECEIVER(i), p, n, right, above, least, place, area);
  OF_RECEIVERS(VOLUME_NEARER)
  int page = light * VOLUME_PAGES + int(place.z);
  vec4 window = volume_window[page];
  if (window.z == 0.0) return vec3(0);
  vec2 at = (place.xy - window.xy) * window.zw;
  bool fine = min(at.x, at.y) >= 0.0 && max(at.x, at.y) <= 1.0;
  float side = float(textureSize(volume_pages, 0).x), texels = area * side * side * (fine ? window.z * window.w : 1.0);
  float level = texels > 2.0 ? floor(0.5 * log2(texels) + 0.5) : 0.0;
  return textureLod(volume_pages, vec3(fine ? at : place.xy, 2 * page + (fine ? 1 : 0)), level).rgb;
}
