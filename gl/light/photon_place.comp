// One level of the photon hierarchy: a cell that holds part of a refractor is split in four, or,
// on the last level, becomes a photon [WymanNichols2009]. The coverage is what the light's view
// of the refractors' front shows, grown by a texel: exact surfaces reach a little beyond their
// triangles.
layout(local_size_x = 256) in;
#include "thread.glsl"
#include "photon_list.glsl"
layout(std430, binding = BINDING_COARSER_CELLS) readonly buffer InputList {
  uint in_count, in_x, in_y, in_z;
  uint in_draw[4];
  uint in_cell[];
};

uniform sampler2DArray coverage;  // front layer: distance in w
uniform int coverage_layer;
uniform ivec2 grid;   // the last level's cells, across and down
uniform int cell;     // side of this level's cells, in last-level cells
uniform bool first;   // the input is the whole level

bool covered(ivec2 from) {
  ivec2 size = textureSize(coverage, 0).xy;
  ivec2 lo = from * size / grid - 1, hi = (from + cell) * size / grid + 1;
  lo = max(lo, ivec2(0));
  hi = min(hi, size);
  for (int y = lo.y; y < hi.y; y++)
    for (int x = lo.x; x < hi.x; x++)
      if (texelFetch(coverage, ivec3(x, y, coverage_layer), 0).w > 0.0) return true;
  return false;
}

void main() {
  uint i = thread_number();
  ivec2 side = (grid + cell - 1) / cell;
  uint total = first ? uint(side.x * side.y) : in_count;
  if (i >= total) return;
  ivec2 c = first ? ivec2(int(i) % side.x, int(i) / side.x)
                  : ivec2(in_cell[i] & 0xffffu, in_cell[i] >> 16);
  ivec2 from = c * cell;
  if (!covered(from)) return;
  if (cell == 1) {
    uint at = atomicAdd(photon_count, 1u);
    photon_cell[at] = uint(c.x) | uint(c.y) << 16;
    return;
  }
  for (int k = 0; k < 4; k++) {
    ivec2 child = 2 * c + ivec2(k & 1, k >> 1);
    if (any(greaterThanEqual(child * (cell / 2), grid))) continue;
    uint at = atomicAdd(photon_count, 1u);
    photon_cell[at] = uint(child.x) | uint(child.y) << 16;
  }
}
