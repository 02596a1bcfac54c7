// Adds listed beams to the grid of a medium, in each of the layers that a beam crosses, square to the axis along
// which it crosses most. There its light lies over its cell's parallelogram.
layout(local_size_x = 256) in;
#include "thread.glsl"
#include "beam.glsl"
layout(std430, binding = BINDING_SPLATS) readonly buffer Beams {
  uint beam_count, beam_groups[3];
  vec4 beam[];
};
// For each cell red, green and blue of the light times its length there, in unit; and the sum of
// these along the beam's direction.
layout(std430, binding = BINDING_MAP_SUMS) buffer Sums { int sum[]; };
uniform uint most;     // beams that the list holds
uniform vec3 cells;      // along each axis
uniform vec3 low, cell;  // m
uniform float unit;      // W m

const int MOST_A_SIDE = 6;  // places over which a cell's side is laid

// Evenly from 0 to 1: sums of what is rounded stay right.
float dither(uint n) {
  n = (n ^ 61u) ^ (n >> 16);
  n *= 9u;
  n = (n ^ n >> 4) * 0x27d4eb2du;
  return float((n ^ n >> 15) >> 8) / 16777216.0;
}

void add(ivec3 at, vec3 light, vec3 way, float share, uint seed) {
  if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, ivec3(cells)))) return;
  int first = ((at.z * int(cells.y) + at.y) * int(cells.x) + at.x) * 6;
  vec3 along = way * dot(light, vec3(1));
  for (int c = 0; c < 3; c++) {
    float round_up = dither(seed + uint(c));
    atomicAdd(sum[first + c], int(floor(share * light[c] + round_up)));
    atomicAdd(sum[first + 3 + c], int(floor(share * along[c] + round_up)));
  }
}

void main() {
  uint listed = thread_number();
  if (listed >= min(beam_count, most)) return;
  uint at = listed * uint(BEAM_TEXELS);
  vec4 first = beam[at], last = beam[at + 1u], u0 = beam[at + 2u], u1 = beam[at + 3u], v0 = beam[at + 4u],
       v1 = beam[at + 5u];
  vec3 along = last.xyz - first.xyz, crossed = abs(along) / cell;
  float length_m = length(along);
  if (length_m <= 0.0) return;
  int a = crossed.x >= max(crossed.y, crossed.z) ? 0 : crossed.y >= crossed.z ? 1 : 2, b = (a + 1) % 3, c = (a + 2) % 3;
  vec3 way = along / length_m, grows = vec3(u1.w, v0.w, v1.w);
  vec3 light_at_end = vec3(first.w, last.w, u0.w) * (cell[a] / abs(way[a]) / unit);
  // Layers whose middles lie between its ends.
  float from = (first[a] - low[a]) / cell[a] - 0.5, to = (last[a] - low[a]) / cell[a] - 0.5;
  int layer = max(int(ceil(min(from, to))), 0), end = min(int(ceil(max(from, to))), int(cells[a]));
  for (; layer < end; layer++) {
    float t = clamp((float(layer) - from) / (to - from), 0.0, 1.0);
    vec3 p = mix(first.xyz, last.xyz, t), u = mix(u0.xyz, u1.xyz, t), v = mix(v0.xyz, v1.xyz, t);
    u -= way * (u[a] / way[a]);
    v -= way * (v[a] / way[a]);
    vec3 light = light_at_end * exp(grows * (1.0 - t) * length_m);
    int nu = clamp(int(ceil(length(u / cell))), 1, MOST_A_SIDE), nv = clamp(int(ceil(length(v / cell))), 1, MOST_A_SIDE);
    for (int k = 0; k < nu * nv; k++) {
      vec3 place = p + u * ((float(k % nu) + 0.5) / float(nu) - 0.5) + v * ((float(k / nu) + 0.5) / float(nv) - 0.5);
      vec3 exact = (place - low) / cell;
      if (any(lessThan(exact, vec3(0))) || any(greaterThan(exact, cells))) continue;
      // At the edges it stays within.
      exact = clamp(exact - 0.5, vec3(0), cells - 1.0);
      exact[a] = float(layer);
      vec3 whole = floor(exact), part = exact - whole;
      uint seed = (listed * 256u + uint(layer)) * 64u + uint(k);
      for (int corner = 0; corner < 4; corner++) {
        ivec3 cell_at = ivec3(whole);
        int on_b = corner & 1, on_c = corner >> 1;
        cell_at[b] += on_b;
        cell_at[c] += on_c;
        float share = (on_b == 1 ? part[b] : 1.0 - part[b]) * (on_c == 1 ? part[c] : 1.0 - part[c]);
        if (share > 0.0) add(cell_at, light, way, share / float(nu * nv), seed * 4u + uint(corner));
      }
    }
  }
}
