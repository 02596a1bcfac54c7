// What of each cell is lit and shows a refractor: a photon carries the light of that part, and starts
// in its middle. Cells without any become no photons.
layout(local_size_x = 256) in;
#include "thread.glsl"
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
  copy_surroundings();
  copy_light();
  uint i = thread_number();
  if (i >= in_count) return;
  uint packed_cell = in_cell[i];
  ivec2 c = ivec2(packed_cell & 0xffffu, packed_cell >> 16);
  vec2 start = vec2(0), extent = vec2(1);
  float flux = 0.0, least = 1e37, most = 0.0, total = 0.0, nearest = 1e9;
  vec2 mean = vec2(0), square = vec2(0), beside = vec2(0);
  // One loop looks at all of them, for what a ray meets is most of this shader: the middle and the corners;
  // where an edge crosses the cell, its rays, then the start that they lead to, and where that is in a gap
  // the rays once more, for the nearest beside it.
  const int RAYS = 5, START = RAYS + SIDE * SIDE, AGAIN = START + 1, END = AGAIN + SIDE * SIDE;
  bool going = true;
  for (int turn = 0; going; turn++) {
    bool first = turn < RAYS, ray = turn >= RAYS && turn < START, again = turn > START;
    vec2 at = ray_offset(again ? turn - AGAIN : turn - RAYS);
    if (first) at = turn == 0 ? vec2(0) : vec2((turn - 1) & 1, (turn - 1) >> 1) - 0.5;
    if (turn == START) at = start;
    float f = flux_at(vec2(c), at);
    flux = turn == 0 ? f : flux;
    least = first ? min(least, f) : least;
    most = first ? max(most, f) : most;
    total += ray ? f : 0.0;
    mean += ray ? f * at : vec2(0);
    square += ray ? f * at * at : vec2(0);
    vec2 off = at - mean;
    bool nearer = again && dot(off, off) < nearest && f > 0.0;
    nearest = nearer ? dot(off, off) : nearest;
    beside = nearer ? at : turn == START ? start : beside;
    if (turn == RAYS - 1) going = least < 0.9 * most || most == 0.0;
    if (turn == START - 1) {
      flux = total / float(SIDE * SIDE);
      mean /= max(total, 1e-37);
      square /= max(total, 1e-37);
      start = unpackSnorm2x16(packSnorm2x16(mean));
      // A bar of even light is as wide as the root of twelve times its variance.
      extent = min(sqrt(12.0 * max(square - mean * mean, vec2(0)) + 1.0 / float(SIDE * SIDE)), vec2(1));
      going = total > 0.0;
    }
    if (turn == START) going = f == 0.0;
    if (turn == END - 1) {
      start = beside;
      going = false;
    }
  }
  uint at = 0xffffffffu;
  if (flux > 0.0) {
    at = atomicAdd(photon_count, 1u);
    photon_at[at] = Photon(packed_cell, flux, packSnorm2x16(start), packUnorm2x16(extent));
  }
  slot[c.y * grid.x + c.x] = at + 1u;
}
