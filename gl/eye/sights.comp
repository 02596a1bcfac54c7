// What the camera's rays through refractors show (sights.glsl), in the light as it is.
layout(local_size_x = 256) in;
#include "thread.glsl"
#define COPIES_TABLES
#include "refractor.glsl"
#include "receiver.glsl"
#define SIGHTS_ACCESS readonly
#include "sights.glsl"
#include "band_colours.glsl"
layout(std430, binding = BINDING_PIXELS) readonly buffer PixelList {
  uint pixel_count, pixel_groups[3];
  uint pixel[];  // x | y << 16
};
layout(rgba32f, binding = 0) writeonly uniform image2D picture;  // rgb, distance from the camera
uniform uint pixel_first, pixel_end;  // those of the list that are looked at
uniform mat3 xyz_from_rgb;
mat3 own_xyz_from_rgb;

void choose_sheet(int i, Receiver r, int sheet, inout Receiver chosen) {
  if (i == sheet) chosen = r;
}

// XYZ that a chain shows.
vec3 chain_light(uint first) {
  vec3 sum = vec3(0);
  uint i = first;
  while (i != 0u) {
    uint word = SIGHT * (i - 1u), last = sights[word + 5u];
    vec2 place = uintBitsToFloat(uvec2(sights[word], sights[word + 1u]));
    vec3 weight = uintBitsToFloat(uvec3(sights[word + 2u], sights[word + 3u], sights[word + 4u]));
    int sheet = int(last >> 24);
    Receiver r = RECEIVER(0);
#define CHOOSE(k) choose_sheet(k, RECEIVER(k), sheet >> 1, r);
    OF_RECEIVERS(CHOOSE)
    vec3 p = r.anchor.xyz + place.x * r.u.xyz + place.y * r.v.xyz;
    vec3 n = (sheet & 1) != 0 ? -r.normal.xyz : r.normal.xyz;
    Shading s = shade(p, n, int(r.anchor.w), place + vec2(r.du.w, r.dv.w), sheet);
    int band = int(sights[word + 6u]) - 1;
    vec3 xyz = own_xyz_from_rgb * (s.direct + s.caustic + s.fill);
    sum += weight * (band < 0 ? xyz : band_colour(band) * xyz);
    i = last & SIGHT_NEXT;
  }
  return sum;
}

void main() {
  copy_tables();
  copy_surroundings();
  own_xyz_from_rgb = read_now(xyz_from_rgb);
  uint listed = thread_number(), at = pixel_first + listed;
  if (at >= min(pixel_count, pixel_end)) return;
  uint word = listed * SIGHT_WORDS;
  float far = uintBitsToFloat(sight_pixels[word + 3u]);
  vec3 sum = uintBitsToFloat(uvec3(sight_pixels[word], sight_pixels[word + 1u], sight_pixels[word + 2u]));
  vec3 mirror = uintBitsToFloat(uvec3(sight_pixels[word + 4u], sight_pixels[word + 5u], sight_pixels[word + 6u]));
  for (uint k = 0u; k <= uint(PIXEL_THREADS); k++) {
    vec3 light = chain_light(sight_pixels[word + 7u + k]);
    sum += k == 0u ? mirror * light : light;
  }
  // At the rim an exact surface may miss the pixel that its triangles cover: what lies behind shows.
  if (far > 0.0)
    imageStore(picture, ivec2(pixel[at] & 0xffffu, pixel[at] >> 16), vec4(rgb_from_xyz * sum, far));
}
