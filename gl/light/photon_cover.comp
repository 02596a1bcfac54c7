// What of each cell is lit and shows a refractor: a photon carries the light of that part, and starts
// in its middle. Cells without any become no photons.
layout(local_size_x = 256) in;
#define COPIES_TABLES
#include "refractor.glsl"
#include "receiver.glsl"

#include "pass_light.glsl"
uniform ivec2 grid;
#include "photon_start.glsl"
#define MAKES_PHOTONS
#include "photons.glsl"

layout(std430, binding = BINDING_CELLS) readonly buffer Cells {
  uint in_count, in_x, in_y, in_z;
  uint in_draw[4];
  uint in_cell[];
};
layout(std430, binding = BINDING_PHOTON_OF_CELL) writeonly buffer Slots { uint slot[]; };  // photon + 1, by cell

const int SIDE = 8;  // rays a side of a cell that an edge crosses

// Flux at the offset (in cells) from the cell's middle; zero where nothing starts.
float flux_at(vec2 cell, vec2 offset) {
  vec3 o, d;
  Hit front;
  float flux;
  bool starts = photon_start((cell + 0.5 + offset) / vec2(grid), o, d, front, flux);
  return starts ? flux : 0.0;
}

vec2 ray_offset(int k) {
  return (vec2(k % SIDE, k / SIDE) + 0.5) / float(SIDE) - 0.5;
}

void main() {
  copy_tables();
  copy_light();
  uint i = gl_GlobalInvocationID.x;
  if (i >= in_count) return;
  uint packed_cell = in_cell[i];
  ivec2 c = ivec2(packed_cell & 0xffffu, packed_cell >> 16);
  vec2 cell = vec2(c);
  vec2 start = vec2(0), extent = vec2(1);
  float flux = flux_at(cell, vec2(0));
  float least = flux, most = flux;
  for (int k = 0; k < 4; k++) {
    float corner = flux_at(cell, vec2(k & 1, k >> 1) - 0.5);
    least = min(least, corner);
    most = max(most, corner);
  }
  if (least < 0.9 * most || most == 0.0) {
    float total = 0.0;
    vec2 mean = vec2(0), square = vec2(0);
    for (int k = 0; k < SIDE * SIDE; k++) {
      vec2 at = ray_offset(k);
      float f = flux_at(cell, at);
      total += f;
      mean += f * at;
      square += f * at * at;
    }
    flux = total / float(SIDE * SIDE);
    mean /= max(total, 1e-37);
    square /= max(total, 1e-37);
    start = unpackSnorm2x16(packSnorm2x16(mean));
    // A bar of even light is as wide as the root of twelve times its variance.
    extent = min(sqrt(12.0 * max(square - mean * mean, vec2(0)) + 1.0 / float(SIDE * SIDE)), vec2(1));
    if (total > 0.0 && flux_at(cell, start) == 0.0) {  // in a gap: beside it
      float nearest = 1e9;
      vec2 other = start;
      for (int k = 0; k < SIDE * SIDE; k++) {
        vec2 at = ray_offset(k), off = at - mean;
        bool nearer = dot(off, off) < nearest && flux_at(cell, at) > 0.0;
        nearest = nearer ? dot(off, off) : nearest;
        other = nearer ? at : other;
      }
      start = other;
    }
  }
  uint at = 0xffffffffu;
  if (flux > 0.0) {
    at = atomicAdd(photon_count, 1u);
    photon_at[at] = Photon(packed_cell, flux, packSnorm2x16(start), packUnorm2x16(extent));
  }
  slot[c.y * grid.x + c.x] = at + 1u;
}
