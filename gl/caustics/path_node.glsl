// A path at one wavelength, and what of its light is left after its path inside.

struct Node {
  uint path;  // signature; 0: no hit
  float index, flux;
  vec2 at;
  int tile;
  Segment left;
#ifdef TINTS
  Tints tints;
#endif
};

Node node_at(int at, bool there, float index, vec2 elsewhere) {
  Node n;
  vec4 to = texelFetch(node_hits, HIT_TEXELS * at);
  vec4 interface_at = texelFetch(node_hits, HIT_TEXELS * at + 1);
  n.path = there ? texelFetch(node_signatures, at).x : 0u;
  n.index = index;
  n.left = segment_of(to, interface_at, index);
  n.tile = n.path != 0u ? interface_tile(interface_at.w) : NO_TILE;
  n.at = n.path != 0u ? map_position(to.xyz, n.tile) : elsewhere;
  n.flux = n.path != 0u ? to.w : 0.0;
#ifdef TINTS
  n.tints = tints_of(there ? texelFetch(node_signatures, at) : uvec4(0));
#endif
  return n;
}

// What varies so evenly with the index that three nodes define it.
vec4 smooth_of(Node n) { return vec4(n.left.along, n.left.arrives); }

// What is left in all of the light of a's half of an interval and of b's, and in how many parts it
// is to be laid.
struct Left {
  float a, b;
  int parts;
};

#ifdef TINTS
uniform int tints_first;  // first tint of these hits' set

// Light is laid in parts whose optical depth ranges by no more.
const float EVEN = 0.25;
const float MOST_PARTS = 16.0;

// Nothing is left of what is less.
const float LEAST_LEFT = 1e-4;

float unevenness(Node n, vec2 depth, int texel) {
  float range = range_of(n.tints, texel);
  return n.flux > 0.0 && exp(min(range - min(depth.x, depth.y), 0.0)) > LEAST_LEFT ? range : 0.0;
}

Left left_at_nodes(Node a, Node b, int interval) {
  int at_a = tints_first + TINT_TEXELS * PART_SURFACES * clamp(interval, 0, nodes - 1);
  int at_b = tints_first + TINT_TEXELS * PART_SURFACES * max(interval - 1, 0);
  vec2 depth_a = depth_of(a.tints, at_a, false), depth_b = depth_of(b.tints, at_b, true);
  float uneven = max(unevenness(a, depth_a, at_a), unevenness(b, depth_b, at_b));
  float needed = clamp(2.0 * uneven / EVEN, 1.0, MOST_PARTS);
  return Left(left_after(depth_a), left_after(depth_b), 1 << int(ceil(log2(needed))));
}

#else
Left left_at_nodes(Node a, Node b, int interval) { return Left(1.0, 1.0, 1); }
#endif
