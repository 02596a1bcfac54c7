// A path at one wavelength, and what of its light is left after its path inside.

struct Node {
  uint path;  // signature; 0: no hit
  float index, flux;
  vec2 at;
  int tile;
  Segment left;
  float path_m;  // TINTING: its length inside
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
  n.path_m = 0.0;
#ifdef TINTING
  n.path_m = there ? uintBitsToFloat(texelFetch(node_signatures, at).y) : 0.0;
#endif
  return n;
}

// What varies so evenly with the index that three nodes tell it.
vec4 smooth_of(Node n) { return vec4(n.left.along, n.left.arrives); }

// What is left at the nodes of an interval, and in how many parts the half of each is to be laid.
struct Left {
  float a, b;
  int parts;
};

#ifdef TINTING
// As in photon_absorption.glsl; band_first: where the set of these hits begins.
uniform samplerBuffer band_attenuation;
uniform int band_first;

// A half of a band is laid in parts where the logarithm of what is left of it varies by more.
const float EVEN = 0.25;

bool is_even(vec4 taken, vec4 left) {
  float least = min(min(taken.x, taken.y), min(taken.z, taken.w));
  float most = max(max(taken.x, taken.y), max(taken.z, taken.w));
  return most - least < EVEN || max(max(left.x, left.y), max(left.z, left.w)) < 1e-4;
}

// In eight parts of the interval, four to each node.
Left left_at_nodes(Node a, Node b, uint signature, int interval) {
  int bands = band_first + (light * REFRACTORS + int(signature & 255u)) * nodes;
  int half_a = 4 * (bands + clamp(interval, 0, nodes - 1)), half_b = 4 * (bands + max(interval - 1, 0)) + 2;
  vec4 taken_a = a.path_m * texelFetch(band_attenuation, half_a), left_a = exp(-taken_a);
  vec4 taken_b = b.path_m * texelFetch(band_attenuation, half_b), left_b = exp(-taken_b);
  bool even = (a.flux == 0.0 || is_even(taken_a, left_a)) && (b.flux == 0.0 || is_even(taken_b, left_b));
  return Left(dot(left_a, texelFetch(band_attenuation, half_a + 1)),
              dot(left_b, texelFetch(band_attenuation, half_b + 1)), even ? 1 : 8);
}
#else
Left left_at_nodes(Node a, Node b, uint signature, int interval) { return Left(1.0, 1.0, 1); }
#endif
