// Fixed-point sums to XYZ flux, and on the finest level to flux over window area: one level of the
// map, with what the coarser levels hold laid over it bilinearly, which keeps their sum. A layer of
// pages comes to irradiance, each page by itself.
layout(local_size_x = 32, local_size_y = 16) in;
#include "common.glsl"
#include "receiver_pages.glsl"
layout(std430, binding = 13) readonly buffer MapSums { uint map_sum[]; };
// Window width of the map's columns, then height of its rows, a light after another.
layout(std430, binding = 9) readonly buffer TexelSizes { float texel_size[]; };
uniform sampler2DArray coarser_map;  // the same texture: its next level is done
layout(rgba32f, binding = 0) writeonly uniform image2DArray map;  // this level
uniform int light;
uniform int layer;  // LIGHTS or more: of the light's pages
uniform uint map_texels;
uniform int map_size;
uniform int level;
uniform int levels;

#ifdef WIDE
float wide(uint at) { return float(map_sum[at + 1u]) * 4294967296.0 + float(map_sum[at]); }

vec3 units_at(uint texel) {
  return vec3(wide(texel * 6u), wide(texel * 6u + 2u), wide(texel * 6u + 4u));
}
#else
vec3 units_at(uint texel) {
  return vec3(map_sum[texel * 3u], map_sum[texel * 3u + 1u], map_sum[texel * 3u + 2u]);
}
#endif

uint level_offset(int l) {
  // side^2 (1 + 1/4 + ...), l terms.
  uint texels = uint(map_size) * uint(map_size);
  return (texels - (texels >> (2 * l))) / 3u * 4u;
}

#ifdef PAGES
void resolve_page(ivec2 texel, vec3 flux) {
  int page = page_of_block(light, (texel << level) / (map_size / PAGE_BLOCKS));
  vec4 rect = page_rect(light, max(page, 0)) * exp2(-float(level));
  // At its edges a page's coarser texels have no neighbours but themselves.
  vec2 at = clamp(0.5 * (vec2(texel) + 0.5), 0.5 * rect.xy + 0.5, 0.5 * rect.zw - 0.5);
  if (level + 1 < levels)
    flux += 0.25 * textureLod(coarser_map, vec3(at / float(map_size >> (level + 1)), layer),
                              float(level + 1)).xyz;
  if (level == 0) flux /= page_across(light, max(page, 0)).w;
  imageStore(map, ivec3(texel, layer), page < 0 ? vec4(0) : vec4(flux, 1));
}
#endif

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  int side = map_size >> level;
  if (texel.x >= side || texel.y >= side) return;
  uint at = level_offset(level) + uint(texel.y * side + texel.x);
#ifdef PAGES
  if (layer >= LIGHTS) {
    resolve_page(texel, units_at(map_texels + at) * lights[light].misc.y);
    return;
  }
#endif
  vec3 flux = units_at(at) * lights[light].misc.y;
  // The filter's weights at a fine texel's centre are the 3/4 and 1/4 of bilinear subdivision; a
  // coarse texel's flux goes to four.
  vec2 uv = (vec2(texel) + 0.5) / float(side);
  if (level + 1 < levels) flux += 0.25 * textureLod(coarser_map, vec3(uv, light), float(level + 1)).xyz;
  if (level == 0) {
    int row = light * 2 * map_size;
    flux /= texel_size[row + texel.x] * texel_size[row + map_size + texel.y];
  }
  imageStore(map, ivec3(texel, light), vec4(flux, 1));
}
