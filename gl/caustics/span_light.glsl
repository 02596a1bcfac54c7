// Lays the light of a span part by part, each with the colour of its own part of the band.

// How far the light is laid.
struct Front {
  Sums sums;
  vec2 at;
#ifdef TINTS
  vec3 taken[TINTS];  // absorbed part of that light, by amount of each
#endif
};

struct Part {
  bool owed;
  vec3 xyz, middles;  // X, Y and Z have each a middle of its own, along the row
  float middle, index;
  float along;  // from the span's beginning to its end, by the index
};

int last_step(Span s, int k) {
  int step = k < s.owed ? STEPS - (k + 1) * (STEPS / 2) / max(s.owed, 1)
                        : (k + 1 - s.owed) * s.steps / max(s.parts, 1);
  return min(step, STEPS);
}

Part part_of(Span s, bool owed, Sums before, Sums upto) {
  Part p;
  p.owed = owed;
  p.xyz = abs(upto.xyz - before.xyz);
  p.middles = clamp(abs(upto.moment - before.moment) / max(p.xyz, vec3(1e-20)),
                    vec3(min(before.along, upto.along)), vec3(max(before.along, upto.along)));
  p.middle = dot(p.middles, p.xyz) / max(p.xyz.x + p.xyz.y + p.xyz.z, 1e-20);
  float row_index = owed ? s.z.index : s.a.index, row_span = (owed ? s.a.index : s.index_b) - row_index;
  p.index = row_index + p.middle * row_span;
  p.along = (p.index - s.from.index) * s.per_index;
  return p;
}

// What the nodes say of its light, and what they say is left of that.
vec2 said_of(Span s, Part p, Sums before, Sums upto) {
  float first_half = min(upto.xyz.y, s.half_xyz.y) - min(before.xyz.y, s.half_xyz.y);
  float share_a = p.owed ? p.xyz.y : first_half;
  vec2 said = vec2(s.a.flux * share_a, s.bridges ? s.b.flux * (p.xyz.y - share_a) : 0.0);
  return vec2(said.x + said.y, dot(said, vec2(p.owed ? s.owed_left.b : s.left.a, s.left.b)));
}

// Before it is absorbed.
Glint light_of(Span s, Part p, Sums upto, inout Front front) {
  // Where the path changes somewhere between two nodes, its light changes evenly in the mean.
  Segment first = s.a.left, second = s.b.left;
  if (p.owed) {
    first = s.z.left;
    second = s.a.left;
  }
  bool both = (p.owed ? s.z.flux : s.a.flux) > 0.0 && (p.owed ? s.a.flux : s.b.flux) > 0.0;
  vec3 arrives = both ? first.arrives + p.middles * (second.arrives - first.arrives) : vec3(s.a.left.arrives);
  Glint g;
  g.flux = s.a.left.passes * arrives * p.xyz;
  g.at = s.a.at;
  g.shift = vec2(0);
  g.tile = s.a.tile;
  if (s.follows && (s.bridges || !p.owed)) {
    vec2 at_upto = map_position(
        place_between(s.from.left, s.to.left, s.fan, (upto.index - s.from.index) * s.per_index), s.a.tile);
    if (s.bridges && !p.owed) arrives += p.middles * (p.middles - 1.0) * s.curve.w;
    float passes =
        transmission(s.to.left.transmits, cosine_between(s.from.left, s.to.left, s.fan, p.along), p.index);
    vec3 passes_each = passes + (p.middles - p.middle) * (both ? second.passes - first.passes : 0.0);
    g.flux = max(passes_each * arrives, 0.0) * p.xyz;
    g.at = 0.5 * (front.at + at_upto);
    g.shift = at_upto - front.at;
    front.at = at_upto;
  }
  float length = upto.along - front.sums.along;
  g.along = (p.middles - front.sums.along) / (length == 0.0 ? 1.0 : length) - 0.5;
  return g;
}

#ifdef TINTS
// What a tint of the span's first path absorbs in a row up to a step, by amount. A table's rows go
// by the refractor that a path met first.
vec3 taken_at(Span s, int k, int row, int step) {
  int rows = (s.a.tints.of[k] - s.first) * (nodes + 1) * (STEPS + 1);
  return texelFetch(interval_sums, row + INTERVAL_TEXELS * (rows + step) + 2).xyz;
}
#endif

Front front_at(Span s, int row, int step) {
  Front f;
  f.at = s.a.at;
  f.sums = no_sums();
  if (step > 0) f.sums = sums_at(row, step);
#ifdef TINTS
  for (int k = 0; k < TINTS; k++) f.taken[k] = step > 0 ? taken_at(s, k, row, step) : vec3(0);
#endif
  return f;
}

// What its path leaves of a part up to there, of X, Y and Z each: as their means are attenuated.
vec3 left_of(Span s, Part p, int row, int step, inout Front front) {
#ifdef TINTS
  vec3 depth = vec3(0);
  Tints t = s.a.tints;
  if (s.bridges) t = tints_between(t, s.b.tints, clamp(p.along, 0.0, 1.0));
  for (int k = 0; k < TINTS; k++) {
    vec3 upto = taken_at(s, k, row, step);
    depth += t.amount[k] * abs(upto - front.taken[k]);
    front.taken[k] = upto;
  }
  return exp(-depth / max(p.xyz, vec3(1e-30)));
#else
  return vec3(1);
#endif
}

// By how much more than the nodes' own, W: light leaves the last interfaces, and is absorbed (both may be
// below 0); and what would lie beyond the map.
vec3 entry_of(vec2 said, float flux, float left, bool lands) {
  float left_said = said.x > 0.0 ? said.y / said.x : 1.0;
  return vec3(flux * left_said - said.y, flux * (left_said - left), lands ? 0.0 : flux * left);
}

// last: after what was still to be laid nothing follows, and what is collected is listed.
void lay(Span s, bool last, Footprint f, inout Splat collected, inout vec3 entry) {
  Front front = front_at(s, s.owed_row, STEPS);
  int count = s.owed + s.parts + (last ? 1 : 0);
  for (int k = 0; k < count; k++) {
    bool done = last && k == s.owed;
    if (k == s.owed) front = front_at(s, s.row, 0);  // the row's first step has nothing before it
    int row = k < s.owed ? s.owed_row : s.row, step = last_step(s, k);
    Sums upto = sums_at(row, step);
    Part p = part_of(s, k < s.owed, front.sums, upto);
    vec2 said = said_of(s, p, front.sums, upto);
    Glint g = light_of(s, p, upto, front);
    vec3 left = left_of(s, p, row, step, front);
    front.sums = upto;
    bool lands = (p.along >= 0.0 && p.along <= 1.0) || on_the_map(g.at, g.tile);
    if (!done) entry += entry_of(said, g.flux.y, left.y, lands);
    g.flux *= left;
    collect(g, lands, done, f, collected);
  }
}
