// A path at one wavelength, and what of its light is left after its path inside.

struct Node {
  uint path;  // signature; 0: no hit
  float index, flux;
  vec2 at;
  int tile;
  Segment left;
#ifdef BAND_PARTS
  vec4 left_below, left_above;  // of its light, in the parts of its band's halves
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
#ifdef BAND_PARTS
  uvec3 depth = there ? texelFetch(node_signatures, at).yzw : uvec3(0);
  n.left_below = exp(-depth_below(depth));
  n.left_above = exp(-depth_above(depth));
#endif
  return n;
}

// What varies so evenly with the index that three nodes tell it.
vec4 smooth_of(Node n) { return vec4(n.left.along, n.left.arrives); }

// Of an interval's light what is left: of a's half and b's in all, in its eight parts from a to b, and in how many
// parts each half is to be laid.
struct Left {
  float a, b;
#ifdef BAND_PARTS
  mat2x4 part;
#endif
  int parts;
};

#ifdef BAND_PARTS
// Of each light and node of these hits' set, what of a half's Y its parts are (photon_depth.glsl).
uniform samplerBuffer band_attenuation;
uniform int share_first;

// A half of a band is laid in parts where what is left of it varies by more.
const float EVEN = 0.1;

bool is_even(vec4 left) {
  float least = min(min(left.x, left.y), min(left.z, left.w)), most = max(max(left.x, left.y), max(left.z, left.w));
  return most - least < EVEN * most || most < 1e-4;
}

Left left_at_nodes(Node a, Node b, int interval) {
  int at_a = share_first + 2 * (light * nodes + clamp(interval, 0, nodes - 1));
  int at_b = share_first + 2 * (light * nodes + max(interval - 1, 0)) + 1;
  bool even = (a.flux == 0.0 || is_even(a.left_below)) && (b.flux == 0.0 || is_even(b.left_above));
  // Where the path ends before b, a's last part goes on.
  vec4 beyond = b.flux > 0.0 ? b.left_above.wzyx : vec4(a.left_below.x);
  return Left(dot(a.left_below, texelFetch(band_attenuation, at_a)), dot(b.left_above, texelFetch(band_attenuation, at_b)),
              mat2x4(a.left_below.wzyx, beyond), even ? 1 : 8);
}

// Of the light between two places of the interval, from 0 at a to 1 at b.
float left_between(Left left, float from, float to) {
  vec4 begins = vec4(0, 1, 2, 3), low = vec4(8.0 * from), high = vec4(8.0 * to);
  vec4 first = clamp(min(high, begins + 1.0) - max(low, begins), 0.0, 1.0);
  vec4 second = clamp(min(high, begins + 5.0) - max(low, begins + 4.0), 0.0, 1.0);
  float all = dot(first + second, vec4(1));
  return all > 0.0 ? (dot(first, left.part[0]) + dot(second, left.part[1])) / all : 0.0;
}
#else
Left left_at_nodes(Node a, Node b, int interval) { return Left(1.0, 1.0, 1); }

float left_between(Left left, float from, float to) { return 1.0; }
#endif
