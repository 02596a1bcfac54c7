// Where a photon's light is spread on the map: over the parallelogram that its neighbours' hits span.
// Who includes this gives the photons, their hits and signatures, `grid` and map_position.glsl.

const int NO_TILE = -1;
const int MAX_ACROSS = 12;  // texels of its level that a footprint may be long

// A path at the wavelength nearest the middle of those at which it hits something.
struct Reference {
  int order, sample_number;
  uint signature;  // 0: it hits nothing
  int tile;
  vec2 at;  // texels
};

// In texels: along its longer axis, in the level of the map whose texels are about as wide as its
// shorter one; of coarser levels, as that grows, more and more of it in the next, or edges between the
// two would show.
struct Footprint {
  vec2 across, skew;
  float narrow, wide;
  int level;
  float to_next;  // how far that is from its level to the next, 0 to 1
};

// From the hit to that of the neighbouring photon on the same path, in texels, as far as if the
// two started a cell apart; zero if there is none.
vec2 neighbour_step(ivec2 cell, ivec2 to, vec2 start, Reference r) {
  ivec2 c = cell + to;
  bool there = all(greaterThanEqual(c, ivec2(0))) && all(lessThan(c, grid));
  uint at = slot[there ? c.y * grid.x + c.x : 0];
  there = there && at != 0u;
  uint other = there ? at - 1u : 0u;
  uint index = (other * counts.slots + r.order) * counts.hit_stride + r.sample_number;
  there = there && r.signature != 0u && texelFetch(signatures, int(index)).x == r.signature;
  vec4 hit = texelFetch(hits, HIT_TEXELS * int(index));
  vec2 between = vec2(to) + unpackSnorm2x16(photon_at[other].offset) - start;
  float apart = max(dot(between, vec2(to)), 0.25);
  return there ? (map_position(hit.xyz, r.tile) - r.at) / apart : vec2(0);
}

// A cell's image along one axis, from the steps to both neighbours: their mean where both are. skew: by
// how much more the half towards the next is, and the other less.
vec2 image_of_side(vec2 to_next, vec2 to_last, out vec2 skew) {
  skew = vec2(0);
  if (to_next == vec2(0)) return -to_last;
  if (to_last == vec2(0)) return to_next;
  skew = 0.5 * (to_next + to_last);
  return 0.5 * (to_next - to_last);
}

Footprint footprint_of(Photon photon, Reference r) {
  ivec2 cell = ivec2(photon.cell & 0xffffu, photon.cell >> 16);
  vec2 start = unpackSnorm2x16(photon.offset), extent = unpackUnorm2x16(photon.extent);
  vec2 right = vec2(0), left = vec2(0), above = vec2(0), below = vec2(0), skew_a, skew_b;
  int sides = grid.x > 0 ? 4 : 0;  // so that no compiler unrolls this
  for (int k = 0; k < sides; k++) {
    int on = 1 - (k & 2);
    vec2 step = neighbour_step(cell, (k & 1) == 0 ? ivec2(on, 0) : ivec2(0, on), start, r);
    right = k == 0 ? step : right;
    above = k == 1 ? step : above;
    left = k == 2 ? step : left;
    below = k == 3 ? step : below;
  }
  vec2 a = extent.x * image_of_side(right, left, skew_a), b = extent.y * image_of_side(above, below, skew_b);
  // Principal axes of the cell's image: a fold makes it thin, wherever the cell's sides point.
  float xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
  float half_trace = 0.5 * (xx + yy), root = length(vec2(0.5 * (xx - yy), xy));
  float wide = sqrt(half_trace + root), narrow = sqrt(max(half_trace - root, 0.0));
  vec2 axis = xx > yy ? vec2(0.5 * (xx - yy) + root, xy) : vec2(xy, 0.5 * (yy - xx) + root);
  // Nearly square, it has no axes to speak of: then it lies as the cell's sides do.
  bool square = narrow > 0.6 * wide;
  vec2 side_axis = dot(a, a) > dot(b, b) ? a : b;
  float area = wide * narrow;
  axis = square ? side_axis : axis;
  wide = square ? max(length(side_axis), 1e-20) : wide;
  narrow = square ? area / wide : narrow;
  Footprint f;
  f.across = wide * axis / max(length(axis), 1e-20);
  bool by_a = dot(a, a) > dot(b, b);
  f.skew = by_a ? extent.x * skew_a : extent.y * skew_b;
  if (dot(f.across, by_a ? a : b) < 0.0) f.across = -f.across;
  f.skew *= min(1.0, wide / max(length(f.skew), 1e-20));
  float least = max(max(narrow, wide / float(MAX_ACROSS)), 0.5);
  float fine = max(log2(least) + 1.25, 0.0), whole = min(floor(fine), float(counts.map_levels - 1));
  f.level = int(whole);
  bool shares = f.level > 0 && f.level + 1 < counts.map_levels;
  f.to_next = shares ? clamp(fine - whole, 0.0, 1.0) : 0.0;
  // A tear between neighbours is not a footprint: no farther than the texels can cover.
  float most_wide = 2.0 * exp2(whole) * float(MAX_ACROSS);
  f.wide = min(wide, most_wide);
  f.narrow = narrow;
  f.across *= f.wide / max(wide, 1e-20);
  f.skew *= f.wide / max(wide, 1e-20);
  return f;
}
