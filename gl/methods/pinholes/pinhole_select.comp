// Lists the texels of a tile that are to be filled: every `stride`th. One in the midst of others that are, and lie on
// a smooth line, takes what lies between them.
layout(local_size_x = 32, local_size_y = 16) in;
#include "thread.glsl"
#include "pinhole_sky.glsl"
#include "page_texels.glsl"
uniform int stride;           // texels are so far apart
uniform ivec2 first;          // and the first is there
uniform float smooth_share;   // share of its light by which three texels may be off a line

// The cubic's middle of four in a row, and whether they lie on a line nearly: on no step either.
bool lies_between(ivec2 at, ivec2 step, vec3 open, out vec3 middle) {
  ivec2 size = imageSize(pages).xy, low = min(at - 3 * step, at + 3 * step), high = max(at - 3 * step, at + 3 * step);
  bool held = all(greaterThanEqual(low, ivec2(0))) && all(lessThan(high, size));
  vec3 a = imageLoad(pages, ivec3(at - 3 * step, page)).rgb, b = imageLoad(pages, ivec3(at - step, page)).rgb;
  vec3 c = imageLoad(pages, ivec3(at + step, page)).rgb, d = imageLoad(pages, ivec3(at + 3 * step, page)).rgb;
  vec3 bend = max(abs(a - 2.0 * b + c), abs(b - 2.0 * c + d)), most = 0.25 * (abs(a) + abs(b) + abs(c) + abs(d));
  middle = (9.0 * (b + c) - a - d) / 16.0;
  return held && all(lessThanEqual(bend, smooth_share * (most + open)));
}

// What is around over a hemisphere, in the mean.
vec3 open_light() {
  float top = log2(sky_side);
  vec3 sum = cube_at(pinhole_sky, vec3(1, 0, 0), top).rgb + cube_at(pinhole_sky, vec3(-1, 0, 0), top).rgb;
  sum += cube_at(pinhole_sky, vec3(0, 1, 0), top).rgb + cube_at(pinhole_sky, vec3(0, -1, 0), top).rgb;
  sum += cube_at(pinhole_sky, vec3(0, 0, 1), top).rgb + cube_at(pinhole_sky, vec3(0, 0, -1), top).rgb;
  return 0.5235987756 * sum;
}

// Whether it follows from others that are taken already. first.x, first.y: half a stride off their rows, columns.
bool is_between(ivec2 at, out vec3 light) {
  vec3 other;
  ivec2 along = first.x > 0 && first.y > 0 ? first : first.x > 0 ? ivec2(first.x, 0) : ivec2(0, first.y);
  light = vec3(0);
  if (first == ivec2(0)) return false;
  vec3 open = open_light();
  if (!lies_between(at, along, open, light)) return false;
  if (first.x == 0 || first.y == 0) return true;
  bool both = lies_between(at, ivec2(along.x, -along.y), open, other);
  light = 0.5 * (light + other);
  return both;
}

void main() {
  ivec2 at = first + stride * ivec2(texel_number());
  vec3 light;
  if (any(greaterThanEqual(at, imageSize(pages).xy)) || !is_place(at)) return;
  if (is_between(at, light))
    imageStore(pages, ivec3(at, page), vec4(light, DONE));
  else
    unfinished[atomicAdd(unfinished_count, 1u)] = uint(at.x) | uint(at.y) << 16;
}
