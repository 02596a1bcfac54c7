// A splat being collected: light of one path that lies close together or along a line is added up and
// then listed as one. Who includes this gives `light`, `map_size`, `most` and splat_list.glsl.

struct Splat {
  vec3 flux, x, y;  // X, Y and Z; and times how far they lie from there
  vec2 from, shift;  // shift: along which its colours lie, from back to front
  vec2 middle;      // middle of that shift, from there
  int tile;
  float weight;
};

// Light at one place, to be added: X, Y and Z, and where they lie along the shift, from -1/2 to 1/2.
struct Glint {
  vec3 flux, along;
  vec2 at, shift;
  int tile;
};

Splat no_splat() { return Splat(vec3(0), vec3(0), vec3(0), vec2(0), vec2(0), vec2(0), NO_TILE, 0.0); }

vec4 map_rect(int tile) {
  vec4 rect = vec4(0, 0, vec2(map_size));
#ifdef TILES
  if (tile != NO_TILE) rect = tile_rect(light, tile);
#endif
  return rect;
}

bool on_the_map(vec2 at, int tile) {
  vec4 rect = map_rect(tile);
  return all(greaterThanEqual(at, rect.xy)) && all(lessThan(at, rect.zw));
}

// The first two words of a splat (splat_list.glsl).
uvec2 packed_place(vec2 at, int tile, int level) {
  vec4 rect = map_rect(tile);
  uvec2 place = uvec2(clamp(at, rect.xy, rect.zw - 0.01) * 32768.0) << 5;
  uint number = uint(tile + 1);
  return uvec2(place.x | number >> 2, place.y | (number & 3u) << 3 | uint(level));
}

void list_splat(Splat s, Footprint f) {
  vec3 x = s.x / max(s.flux, vec3(1e-30)) - s.middle.x, y = s.y / max(s.flux, vec3(1e-30)) - s.middle.y;
  uvec2 place = packed_place(s.from + s.middle, s.tile, f.level);
  uvec3 units = uvec3(s.flux / pass_light.misc.y + 0.5);
  if (units == uvec3(0)) return;
  uint word = min(atomicAdd(splat_count, 1u), most) * SPLAT_WORDS;
  splat[word] = place.x;
  splat[word + 1u] = place.y;
  splat[word + 2u] = packHalf2x16(f.across);
  splat[word + 3u] = units.x;
  splat[word + 4u] = units.y;
  splat[word + 5u] = units.z;
  splat[word + 6u] = packHalf2x16(vec2(x.x, y.x));
  splat[word + 7u] = packHalf2x16(vec2(x.y, y.y));
  splat[word + 8u] = packHalf2x16(vec2(x.z, y.z));
  splat[word + 9u] = packHalf2x16(s.shift);
  splat[word + 10u] = packHalf2x16(f.skew);
  splat[word + 11u] = packHalf2x16(vec2(f.narrow, f.to_next));
}

// Adds light to the splat; lists it first where the light is of another, or all is `done`.
void collect(Glint g, bool lands, bool done, Footprint f, inout Splat s) {
  float weight = done || !lands ? 0.0 : g.flux.x + g.flux.y + g.flux.z;
  vec2 off = abs(g.at - s.from);
  bool elsewhere = max(off.x, off.y) > 0.75 * exp2(float(f.level)) || g.tile != s.tile;
  if (s.weight > 0.0 && (done || (weight > 0.0 && elsewhere))) {
    list_splat(s, f);
    s.flux = s.x = s.y = vec3(0);
    s.weight = 0.0;
  }
  if (weight > 0.0) {
    if (s.weight == 0.0) {
      s.from = g.at;
      s.shift = s.middle = vec2(0);
      s.tile = g.tile;
    }
    vec2 off_here = g.at - s.from;
    s.flux += g.flux;
    s.x += g.flux * (off_here.x + g.along * g.shift.x);
    s.y += g.flux * (off_here.y + g.along * g.shift.y);
    s.shift += g.shift;
    s.middle += s.weight == 0.0 ? vec2(0) : 0.5 * g.shift;
    s.weight += weight;
  }
}
