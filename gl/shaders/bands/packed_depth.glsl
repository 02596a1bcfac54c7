// BAND_PARTS: how hits keep the optical depths of their paths: twelve bits each, by their roots. As
// abbe_photon_attenuate() reads them.
#ifdef BAND_PARTS
const float MOST_DEPTH = 64.0;

uint depth_bits(float depth) {
  return uint(sqrt(clamp(depth / MOST_DEPTH, 0.0, 1.0)) * 4095.0 + 0.5);
}

uvec3 pack_depth(mat2x4 d) {
  uint a = depth_bits(d[0].x), b = depth_bits(d[0].y), c = depth_bits(d[0].z), e = depth_bits(d[0].w);
  uint f = depth_bits(d[1].x), g = depth_bits(d[1].y), h = depth_bits(d[1].z), i = depth_bits(d[1].w);
  return uvec3(a | b << 12 | c << 24, c >> 8 | e << 4 | f << 16 | g << 28, g >> 4 | h << 8 | i << 20);
}

vec4 depths_of(uint a, uint b, uint c, uint d) {
  vec4 root = vec4(uvec4(a, b, c, d) & 4095u) / 4095.0;
  return MOST_DEPTH * root * root;
}

// Below the node, and above it.
vec4 depth_below(uvec3 w) { return depths_of(w.x, w.x >> 12, w.x >> 24 | w.y << 8, w.y >> 4); }

vec4 depth_above(uvec3 w) { return depths_of(w.y >> 16, w.y >> 28 | w.z << 4, w.z >> 8, w.z >> 20); }
#endif
