// What a receiver in colours reflects of light that refractors have spread: the share of X, Y and Z by the
// band of the light's spectrum that has that chromaticity (colorimetry/reflectance/reflected_light.h).

// For each receiver and light its white x, y and where its tables begin (0: it has none); then the
// tables, ring by ring of each direction: shares, and how far the spectral locus lies there.
uniform samplerBuffer band_reflections;

// The share between the directions a and b next to it, so far between them, and so many rings from
// the white.
vec3 band_share(int first, ivec2 turn, float part, float ring) {
  int inner = min(int(ring), BAND_RINGS - 1);
  ivec2 at = first + turn * (BAND_RINGS + 1) + inner;
  float above = ring - float(inner);
  vec3 a = mix(texelFetch(band_reflections, at.x).xyz, texelFetch(band_reflections, at.x + 1).xyz, above);
  vec3 b = mix(texelFetch(band_reflections, at.y).xyz, texelFetch(band_reflections, at.y + 1).xyz, above);
  return mix(a, b, part);
}

vec3 reflect_caustic(int surface, vec3 share, int light, mat3 reflection, vec3 xyz) {
  vec4 row = texelFetch(band_reflections, surface * LIGHTS + light);
  int first = int(row.z);
  vec2 off = xyz.xy / max(xyz.x + xyz.y + xyz.z, 1e-30) - row.xy;
  float size = abs(off.x) + abs(off.y), up = off.y / max(size, 1e-20);
  float turn = (off.x < 0.0 ? 2.0 - up : up < 0.0 ? 4.0 + up : up) * (float(BAND_TURNS) / 4.0);
  ivec2 next = (ivec2(turn) + ivec2(0, 1)) % BAND_TURNS;
  float part = fract(turn);
  float most = mix(texelFetch(band_reflections, first + next.x * (BAND_RINGS + 1)).w,
                   texelFetch(band_reflections, first + next.y * (BAND_RINGS + 1)).w, part);
  float ring = float(BAND_RINGS) * min(length(off) / max(most, 1e-6), 1.0);
  vec3 kept = band_share(first, next, part, ring);
#ifdef TEXTURED
  const int cells = BAND_TURNS * (BAND_RINGS + 1);
  kept = share.r * kept + share.g * band_share(first + cells, next, part, ring) +
         share.b * band_share(first + 2 * cells, next, part, ring);
#endif
  return first > 0 ? rgb_from_xyz * (kept * xyz) : reflection * (rgb_from_xyz * xyz);
}
