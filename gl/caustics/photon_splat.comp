// Adds listed splats to the map, part by part. A part is a rectangle that gives each of the four texels at most
// what of it lies there, so parts side by side make an even light, however they lie against the texels. All
// of a splat is given, to the last unit. Where light has edges parts lie by their bounds, and a splat of few parts
// goes to the level below its own: then little of it lands beside the area that it lights. X and Z lie beside Y,
// however little.
layout(local_size_x = 256) in;
#include "splat_list.glsl"
#include "wide_sum.glsl"
#include "thread.glsl"
#include "receiver_atlas.glsl"
// Levels one after another, each texel X, Y, Z; WIDE: lo, hi of each. TILES: then the same of their
// layer.
layout(std430, binding = BINDING_MAP_SUMS) buffer MapSums { uint map_sum[]; };
#include "light_number.glsl"
uniform int map_size;
uniform uint most;
uniform uint map_texels;  // texels of all levels
uniform bool has_edges;    // light has, where refractors have facets

uint level_offset(int level) {
  // side^2 (1 + 1/4 + ...), level terms.
  uint texels = uint(map_size) * uint(map_size);
  return (texels - (texels >> (2 * level))) / 3u * 4u;
}

const float LEAST_SIDE = 0.25;  // least side of a part, in texels
const int MOST_IN_ROWS = 60;
const float MOST_WIDE = 0.84;  // in texels: what lies turned is wider, and more than a texel leaves gaps
const int MOST_PARTS = 16;  // parts of a splat in the level below its own, or it stays in its own

void add(uint texel, int channel, uint v) {
#ifdef WIDE
  uint at = texel * 6u + 2u * uint(channel);
  WIDE_ADD(map_sum, at, at + 1u, v)
#else
  if (v > 0u) atomicAdd(map_sum[texel * 3u + uint(channel)], v);
#endif
}

// As listed (splat_list.glsl), texels.
struct ListedSplat {
  uvec3 units;
  vec2 centre, across, shift, skew;
  vec2 beside;  // its other side, square to `across`
  vec2 off[3];  // X, Y and Z, off the middle
  vec3 slope;   // along the shift X, Y and Z grow or fall evenly, as their means show
  int level;
  float next_share;
  uint tile;  // and one more; 0: the map
  vec4 rect;  // the tile's rectangle
};

ListedSplat splat_at(uint word) {
  ListedSplat s;
  uint y_level = splat[word + 1u];
  s.units = uvec3(splat[word + 3u], splat[word + 4u], splat[word + 5u]);
  s.across = unpackHalf2x16(splat[word + 2u]);
  s.shift = unpackHalf2x16(splat[word + 9u]);
  s.skew = unpackHalf2x16(splat[word + 10u]);
  vec2 rest = unpackHalf2x16(splat[word + 11u]);
  s.beside = rest.x * vec2(-s.across.y, s.across.x) / max(length(s.across), 1e-20);
  s.level = int(y_level & 7u);
  s.next_share = clamp(2.0 * rest.y - 1.0, 0.0, 1.0);
  if (!has_edges && rest.y > 0.0) {  // over a whole level, and as coarse in the mean
    s.level -= rest.y < 0.25 ? 1 : 0;
    s.next_share = smoothstep(0.0, 1.0, fract(rest.y + 0.75));
  }
  s.centre = vec2(splat[word] >> 5, y_level >> 5) / 32768.0;
  s.tile = (splat[word] & 31u) << 2 | y_level >> 3 & 3u;
  s.rect = vec4(0);
#ifdef TILES
  s.rect = tile_rect(light, max(int(s.tile), 1) - 1);
#endif
  for (int c = 0; c < 3; c++) s.off[c] = unpackHalf2x16(splat[word + 6u + uint(c)]);
  vec3 leads = vec3(dot(s.off[0], s.shift), dot(s.off[1], s.shift), dot(s.off[2], s.shift));
  s.slope = clamp(leads / max(dot(s.shift, s.shift), 1e-20), -1.0 / 6.0, 1.0 / 6.0);
  return s;
}

// The parts of a splat in one level.
struct Grid {
  int level, beside, across, along;
  float size;
};

// Parts whose bounds are no wider than a texel; of light with edges, which lie by their bounds, hardly wider.
Grid grid_of(int level, ListedSplat s) {
  Grid g;
  g.level = level;
  g.size = exp2(float(level));
  float across = length(s.across), wide = (across + length(s.skew)) / g.size, part = MOST_WIDE;
  vec2 axis = across > 0.0 && !has_edges ? abs(s.across) / across : vec2(1, 0);
  float narrow = max(length(s.beside) / g.size, LEAST_SIDE);
  g.beside = clamp(int(ceil(has_edges ? narrow / part : narrow * (axis.x + axis.y))), 1, MOST_IN_ROWS);
  vec2 room = (1.0 - narrow / float(g.beside) * axis.yx) / max(axis, 1e-3);
  part = has_edges ? part : min(room.x, room.y);
  g.across = clamp(int(ceil(wide / part)), 1, MOST_IN_ROWS);
  g.along = clamp(int(ceil(max(abs(s.shift.x), abs(s.shift.y)) / g.size - 0.25)), 1, MOST_IN_ROWS);
  return g;
}

int parts_of(Grid g) { return g.beside * g.across * g.along; }

// A cell of a grid: its number beside, along and across, from 0.
struct Cell {
  float beside, row, column;
};

Cell cell_of(Grid g, int k) {
  float rows = floor((float(k) + 0.5) / float(g.across)), beside = floor((rows + 0.5) / float(g.along));
  return Cell(beside, rows - beside * float(g.along), float(k) - rows * float(g.across));
}

// Shares of X, Y and Z that have been given when the cell is.
vec3 given_of_row(ListedSplat s, Grid g, Cell c) {
  if (g.along == 1) return vec3((c.column + 1.0) / float(g.across));
  float per_row = 1.0 / float(g.along), t = c.row * per_row;
  vec3 upto = t + 6.0 * s.slope * t * (t - 1.0);
  return upto +
         (c.column + 1.0) / float(g.across) * per_row * (1.0 + 6.0 * s.slope * (2.0 * t + per_row - 1.0));
}

vec3 given_upto(ListedSplat s, Grid g, Cell c) {
  return (c.beside + given_of_row(s, g, c)) / float(g.beside);
}

// A rectangle in texels of its level: its middle and halves of its sides. Its bounds are no wider than a
// texel, so it covers four of them at the most.
struct Part {
  vec2 middle, across, beside;
};

// The rectangle of the cell's Y. Its sides, and longer and wider by what its light is shifted;
// where light has edges, its bounds: a rectangle is not the image of a slanted cell, and thin ones
// side by side show that as stripes.
Part part_of(ListedSplat s, Grid g, Cell c, vec2 off_y) {
  float at_part = (c.column + 0.5) / float(g.across) - 0.5, per_row = 1.0 / float(g.along);
  vec2 across = (s.across + sign(at_part) * s.skew) / float(g.across) / g.size;
  vec2 beside = s.beside / float(g.beside) / g.size, shift = s.shift * per_row / g.size;
  float wide = length(across);
  vec2 axis = wide > 0.0 ? across / wide : vec2(1, 0), axis_beside = vec2(-axis.y, axis.x);
  vec2 sides = max(vec2(wide, length(beside)) + abs(vec2(dot(axis, shift), dot(axis_beside, shift))), LEAST_SIDE);
  vec2 bounds = sides.x * abs(axis) + sides.y * abs(axis_beside);
  sides *= min(1.0, 1.0 / max(bounds.x, bounds.y));
  vec2 box = max(clamp(abs(beside) + abs(across) + abs(shift), LEAST_SIDE, 1.0), abs(shift));
  Part p;
  p.middle = s.centre + off_y + s.beside * ((c.beside + 0.5) / float(g.beside) - 0.5) +
             s.across * at_part + s.skew * abs(at_part) + s.shift * ((c.row + 0.5) * per_row - 0.5);
  p.middle /= g.size;
  p.across = 0.5 * (has_edges ? vec2(box.x, 0) : sides.x * axis);
  p.beside = 0.5 * (has_edges ? vec2(0, box.y) : sides.y * axis_beside);
  return p;
}

// The mean of what lies below 0 on a line from a to b.
float mean_below(float a, float b) {
  vec2 below = min(vec2(a, b), vec2(0));
  return 0.5 * (below.x + below.y) * (abs(below.x - below.y) + 1e-6) / (abs(a - b) + 1e-6);
}

// What an edge of an area adds to how much of that lies below 0 in x, in y, and in both (Green's theorem).
vec3 below_edge(vec2 a, vec2 b) {
  vec2 y = min(vec2(a.y, b.y), vec2(0));
  float rise = b.y - a.y;
  vec2 x = a.x + (y - a.y) * (abs(rise) < 1e-7 ? 0.0 : (b.x - a.x) / rise);
  return vec3(rise * mean_below(a.x, b.x), (y.y - y.x) * vec2(0.5 * (x.x + x.y), mean_below(x.x, x.y)));
}

// Where light is to lie so that its bilinear weights give the texels what a part covers of them to the right
// and above; and how much more the one to the right and above gets.
struct Place {
  vec2 at;  // place in the level's texels
  float lean;
};

Place place_of(Part p) {
  vec2 corner = floor(p.middle + 0.5), middle = p.middle - corner;
  vec2 a = middle - p.across - p.beside, b = middle + p.across - p.beside;
  vec2 c = middle + p.across + p.beside, d = middle - p.across + p.beside;
  vec3 below = below_edge(a, b) + below_edge(b, c) + below_edge(c, d) + below_edge(d, a);
  below = clamp(below / (4.0 * length(p.across) * length(p.beside)), 0.0, 1.0);
  return Place(corner + 0.5 - below.xy, below.z - below.x * below.y);
}

// Where in its texels a level takes light, and where it begins.
struct Target {
  vec2 low, high;
  uint first;
  int side;
};

Target target_of(ListedSplat s, Grid g) {
  Target t = Target(vec2(0), vec2(float(map_size) - 0.01), level_offset(g.level), map_size >> g.level);
#ifdef TILES
  t.low = s.tile > 0u ? s.rect.xy + 0.5 * g.size : t.low;
  t.high = s.tile > 0u ? s.rect.zw - 0.5 * g.size : t.high;
  t.first += s.tile > 0u ? map_texels : 0u;
#endif
  return t;
}

// Shares one of X, Y and Z among the four texels around its place, to the last unit.
void add_around(Target t, ListedSplat s, float size, vec2 p, float lean, int channel, uint units) {
#ifdef TILES
  // What would lie beyond a tile's edge, where the receiver ends, is folded back.
  p = s.tile > 0u ? min(max(p, 2.0 * s.rect.xy - p), max(2.0 * s.rect.zw - p, s.rect.xy)) : p;
#endif
  vec2 at = clamp(p, t.low, t.high) / size - 0.5;
  ivec2 base = ivec2(floor(at)), last = ivec2(t.side - 1);
  vec2 f = at - vec2(base), g = 1.0 - f;
  ivec2 lo = clamp(base, ivec2(0), last), hi = clamp(base + 1, ivec2(0), last);
  uint row_lo = t.first + uint(lo.y * t.side), row_hi = t.first + uint(hi.y * t.side);
  lean = clamp(lean, -min(f.x * f.y, g.x * g.y), min(f.x * g.y, g.x * f.y));
  vec3 share = float(units) * vec3(g.x * g.y + lean, f.x * g.y - lean, g.x * f.y - lean);
  uint part_0 = min(uint(max(share.x, 0.0)), units);
  uint part_1 = min(uint(max(share.y, 0.0)), units - part_0);
  uint part_2 = min(uint(max(share.z, 0.0)), units - part_0 - part_1);
  add(row_lo + uint(lo.x), channel, part_0);
  add(row_lo + uint(hi.x), channel, part_1);
  add(row_hi + uint(lo.x), channel, part_2);
  add(row_hi + uint(hi.x), channel, units - part_0 - part_1 - part_2);
}

void main() {
  uint listed = thread_number();
  if (listed >= min(splat_count, most)) return;
  ListedSplat s = splat_at(listed * SPLAT_WORDS);
  Grid fine = grid_of(s.level, s), finer = grid_of(max(s.level - 1, 0), s);
  if (has_edges && parts_of(finer) <= MOST_PARTS) fine = finer;
  Grid next = grid_of(fine.level + 1, s);
  int fine_count = parts_of(fine);
  int count = fine_count + (s.next_share > 0.0 ? parts_of(next) : 0);
  uvec3 given = uvec3(0);
  for (int n = 0; n < count; n++) {
    bool coarse = n >= fine_count;
    Grid g = fine;
    if (coarse) g = next;
    Cell cell = cell_of(g, n - (coarse ? fine_count : 0));
    vec3 upto = given_upto(s, g, cell);
    upto = coarse ? 1.0 - s.next_share * (1.0 - upto) : (1.0 - s.next_share) * upto;
    uvec3 upto_units = n + 1 == count ? s.units : clamp(uvec3(vec3(s.units) * upto), given, s.units);
    uvec3 here = upto_units - given;
    given = upto_units;
    // X and Z lie beside Y, however little.
    float per_row = 1.0 / float(g.along);
    vec2 off[3] = s.off;
    for (int c = 0; c < 3; c++) off[c] -= (1.0 - per_row * per_row) * s.slope[c] * s.shift;
    Place y = place_of(part_of(s, g, cell, off[1]));
    Target target = target_of(s, g);
    for (int c = 0; c < 3; c++)
      add_around(target, s, g.size, y.at * g.size + (off[c] - off[1]), y.lean, c, here[c]);
  }
}
