// What a cube map with levels shows in the mean over a range of directions.
const float CUBE_TEXEL = 1.4472025;  // rad, of a face of one texel: the root of its solid angle

// As wide as a and b around r, none of them of a length to count on: taps along the longer, at the most
// `most` of them, in the level whose texels are as wide as the shorter; texel: that of level 0, rad. None
// where nothing is `wanted`.
vec3 cube_mean(samplerCube cube, float texel, vec3 r, vec3 a, vec3 b, float most, bool wanted) {
  bool first = dot(a, a) > dot(b, b);
  vec3 longer = first ? a : b, shorter = first ? b : a;
  float wide = length(longer);
  float narrow = max(length(shorter), wide / most);
  float level = max(log2(max(narrow, 1e-9) / texel), 0.0);
  float taps = clamp(ceil(wide / max(narrow, texel) - 1e-3), 1.0, most), tap = 1.0 / taps;
  float k = wanted ? 0.5 * tap : 2.0;
  vec3 sum = vec3(0);
  while (k < 1.0) {
    sum += textureLod(cube, r + longer * (k - 0.5), level).rgb;
    k += tap;
  }
  return sum * tap;
}
