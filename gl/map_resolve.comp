// Fixed-point sums to flux over window area, XYZ: one level of the map, with what the coarser
// levels hold laid over it bilinearly, which keeps their sum.
layout(local_size_x = 64) in;
#include "common.glsl"
layout(std430, binding = 13) readonly buffer MapSums { uint map_sum[]; };
layout(std430, binding = 9) buffer Densities { vec4 density[]; };  // the coarser levels' results
layout(rgba32f, binding = 0) writeonly uniform image2DArray map;
uniform int light;
uniform int map_size;
uniform int level;
uniform int levels;

float wide(uint at) { return float(map_sum[at + 1u]) * 4294967296.0 + float(map_sum[at]); }

uint level_offset(int l) {
  // side^2 (1 + 1/4 + ...), l terms.
  uint texels = uint(map_size) * uint(map_size);
  return (texels - (texels >> (2 * l))) / 3u * 4u;
}

vec3 coarser(ivec2 texel) {
  int side = map_size >> (level + 1);
  // Level 0 keeps its result in the map alone.
  uint offset = level_offset(level + 1) - level_offset(1);
  ivec2 base = (texel - 1) >> 1;
  vec2 f = 0.25 + 0.5 * vec2((texel & 1) ^ 1);
  vec3 sum = vec3(0);
  for (int k = 0; k < 4; k++) {
    ivec2 o = ivec2(k & 1, k >> 1), c = clamp(base + o, ivec2(0), ivec2(side - 1));
    float w = (o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y);
    sum += w * density[offset + uint(c.y * side + c.x)].xyz;
  }
  return sum;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  int side = map_size >> level;
  if (texel.x >= side || texel.y >= side) return;
  uint at = level_offset(level) + uint(texel.y * side + texel.x);
  vec3 flux = vec3(wide(at * 6u), wide(at * 6u + 2u), wide(at * 6u + 4u)) * lights[light].misc.y;
  // A coarser texel covers four times the area.
  vec3 sum = flux * (lights[light].misc.w * exp2(-2.0 * float(level)));
  if (level + 1 < levels) sum += coarser(texel);
  if (level == 0)
    imageStore(map, ivec3(texel, light), vec4(sum, 1));
  else
    density[at - level_offset(1)] = vec4(sum, 1);
}
