// A map's texels: the mean of this frame's light and of that of frames before, those of another state of the
// scene no farther from this frame's than its texels nearby reach.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
uniform sampler2DArray kept[4];  // this frame's, the one before, ...
layout(rgba32f, binding = 0) writeonly uniform image2DArray map;
uniform int layer, map_size, rows;
uniform int before;  // frames
uniform int fresh;   // so many of these are of the scene as it is
const int REACH = 1;  // texels

void main() {
  ivec2 texel = ivec2(texel_number());
  if (texel.x >= map_size || texel.y >= rows) return;
  vec3 sum = texelFetch(kept[0], ivec3(texel, layer), 0).xyz, least = sum, most = sum;
  int reach = before > fresh ? REACH : 0;
  for (int y = max(texel.y - reach, 0); y <= min(texel.y + reach, rows - 1); y++)
    for (int x = max(texel.x - reach, 0); x <= min(texel.x + reach, map_size - 1); x++) {
      vec3 there = texelFetch(kept[0], ivec3(x, y, layer), 0).xyz;
      least = min(least, there);
      most = max(most, there);
    }
  vec3 past[3] = vec3[3](vec3(0), vec3(0), vec3(0));
  if (before > 0) past[0] = texelFetch(kept[1], ivec3(texel, layer), 0).xyz;
  if (before > 1) past[1] = texelFetch(kept[2], ivec3(texel, layer), 0).xyz;
  if (before > 2) past[2] = texelFetch(kept[3], ivec3(texel, layer), 0).xyz;
  for (int k = 0; k < 3; k++) sum += k < fresh ? past[k] : k < before ? clamp(past[k], least, most) : vec3(0);
  imageStore(map, ivec3(texel, layer), vec4(sum / float(before + 1), 1));
}
