// The light between two neighbouring nodes of a path. It is laid from a to b where they are of one path, else a's
// half of it goes on from z and a; and before that the half that a still has to lay.

#ifdef BRIDGE
const bool BRIDGES = true;
#else
const bool BRIDGES = false;
#endif
#ifdef DOUBTS_BRIDGES
const bool DOUBTS = true;
#else
const bool DOUBTS = false;
#endif

const float SEGMENT = 2.0;  // length of a span's segment, at the most, in texels of its level

// From node `number` to the one before it, which is b.
struct Interval {
  int number;
  bool taken, last;  // last: there is none, and what is collected is listed
  bool has_b;
  int hit_b, row;
  float index_b;
};

// What an interval leaves to the next.
struct Trail {
  Node z, a;      // the last two nodes
  bool followed;  // they are of one path
  vec2 step;      // from z to a
  float moved;    // the longer of its coordinates
  vec4 curve;     // second differences
  bool owes;      // a's half of the interval before is not laid yet: on that row, with so much left
  int owed_row;
  Left owed_left;
};

struct Span {
  Node z, a, b;
  Node from, to;  // its light lies along the line through these two
  bool bridges;   // from a to b; else a's half alone
  bool follows;
  vec4 curve;
  Fan fan;
  float per_index;
  int owed_row, row, first;  // rows, and the refractor to which they belong
  Left owed_left, left;
  float index_b;
  vec3 half_xyz;           // up to the interval's middle
  int owed, parts, steps;  // parts of the half that is still to be laid and of this light, which takes so many steps
};

Trail trail_from(Node a, int row) {
  return Trail(a, a, false, vec2(0), 0.0, vec4(0), false, row, left_at_nodes(a, a, 0));
}

// Paths through a mesh may be alike and yet part: a long move is a spectrum's where the light moves on
// likewise in the interval before or after it.
bool moves_likewise(Path path, Interval i, Node b, vec2 step, vec2 step_before) {
  bool has_c = i.has_b && i.number - 1 > path.node_first;
  int hit_c = has_c ? i.hit_b - 1 : i.hit_b;
  uint path_c = has_c ? texelFetch(node_signatures, hit_c).x : 0u;
  vec2 at_c = map_position(texelFetch(node_hits, HIT_TEXELS * hit_c).xyz, b.tile);
  vec2 step_after = path_c != 0u && path_c == b.path ? at_c - b.at : vec2(0);
  return min(distance(step, step_before), distance(step, step_after)) < 0.75 * length(step);
}

// A power of two, so that parts end at steps of the interval.
int parts_of(float moved, float size, int least, int most_parts) {
  int needed = int(ceil(log2(max(moved / (SEGMENT * size), 1.0))));
  return min(max(1 << needed, least), most_parts);
}

// How many parts, by how far the light moves and where the path ends.
void divide(inout Span s, Trail t, bool taken, float moved, float size) {
  // Where the interface reflects all before b, the path ends there, and not halfway.
  float cosine = cosine_between(s.from.left, s.to.left, s.fan, (s.index_b - s.from.index) * s.per_index);
  bool ends = s.follows && !s.bridges && s.to.left.transmits && cosine == 0.0;
  float moved_along = s.bridges ? moved : s.follows ? t.moved : 0.0;
  s.steps = s.bridges || ends ? STEPS : STEPS / 2;
  s.parts = taken && s.a.flux > 0.0 ? parts_of(moved_along, size, s.left.parts, s.steps) : 0;
  s.owed = t.owes ? parts_of(s.bridges ? moved : 0.0, size, s.owed_left.parts, STEPS / 2) : 0;
}

Span span_of(inout Trail t, Path path, Interval i, Node b, float size) {
  Span s;
  s.z = t.z;
  s.a = t.a;
  s.b = b;
  s.left = left_at_nodes(t.a, b, i.number);
  vec2 step = b.at - t.a.at;
  float moved = max(abs(step.x), abs(step.y));
  bool one_path = BRIDGES && t.a.path != 0u && t.a.path == b.path;
  bool likewise = !DOUBTS || moves_likewise(path, i, b, step, t.step);
  t.step = one_path ? step : vec2(0);
  one_path = one_path && (moved < float(map_size) / 16.0 || likewise);

  s.bridges = i.taken && one_path;
  s.follows = s.bridges || (i.taken && t.followed);
  s.from = t.z;
  s.to = t.a;
  if (s.bridges) {
    s.from = t.a;
    s.to = b;
  }
  float span = s.to.index - s.from.index;
  s.per_index = span != 0.0 ? 1.0 / span : 0.0;
  float back = (t.z.index - t.a.index) * s.per_index;  // where z lies, below 0
  vec4 bend = smooth_of(t.z) - smooth_of(t.a) - back * (smooth_of(b) - smooth_of(t.a));
  s.curve = !s.bridges ? t.curve : t.followed && back < -0.05 ? bend / (back * (back - 1.0)) : vec4(0);
  s.fan = fan_between(s.from.left, s.to.left, s.curve.xyz);
  s.owed_row = t.owed_row;
  s.owed_left = t.owed_left;
  s.row = i.row;
  s.first = int(path.signature & 255u);
  s.index_b = i.index_b;
  s.half_xyz = sums_at(i.row, STEPS / 2).xyz;
  divide(s, t, i.taken, moved, size);

  t.owes = i.taken && !s.bridges && b.path != 0u;
  t.owed_row = i.row;
  t.owed_left = s.left;
  t.followed = one_path;
  t.curve = s.curve;
  t.moved = moved;
  t.z = t.a;
  t.a = b;
  return s;
}
