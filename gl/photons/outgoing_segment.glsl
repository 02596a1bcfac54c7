// The interface at which light left its last refractor, kept with every hit: behind it light of any
// wavelength between two nodes is known nearly exactly, for it follows the index so evenly before.

// Texels of a hit: its place and flux, of unit power of its light; then the place on the interface
// and interface_word().
const int HIT_TEXELS = 2;

// The interface's normal along the path out (11 bits each of its two octahedral coordinates, and the sign
// of z), whether its transmission is part of the flux, and the tile on which the light lands (-1:
// none), as a float that no device takes for a NaN or rounds to zero.
float interface_word(vec3 n, bool transmits, int tile) {
  vec3 a = n / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-20);
  uvec2 xy = uvec2(round((a.xy * 0.5 + 0.5) * 2046.0));
  uint exponent = 1u + uint(tile + 1) + (transmits ? 80u : 0u);
  return uintBitsToFloat((n.z < 0.0 ? 0x80000000u : 0u) | exponent << 23 | xy.x << 11 | xy.y);
}

vec3 interface_normal(float word) {
  uint bits = floatBitsToUint(word);
  vec2 xy = vec2(bits >> 11 & 2047u, bits & 2047u) / 2046.0 * 2.0 - 1.0;
  float z = 1.0 - abs(xy.x) - abs(xy.y);
  return normalize(vec3(xy, (bits >> 31) != 0u ? -z : z));
}

bool interface_transmits(float word) { return (floatBitsToUint(word) >> 23 & 255u) > 80u; }

int interface_tile(float word) { return int(((floatBitsToUint(word) >> 23 & 255u) - 1u) % 80u) - 1; }

#ifdef FOLLOWS_SEGMENTS
// What of a hit varies smoothly with the index: light's direction along the interface follows from that
// before it by Snell's law without a root, so even next to the critical angle, where directions and places
// do not.
struct Segment {
  vec3 place;         // place of the hit
  vec3 interface_at;  // where it leaves
  vec3 along;         // part of its unit direction along the interface
  vec3 n;             // normal of the interface, along its direction
  float passes;       // share that the interface lets through
  float arrives;      // flux before that, of unit power
  bool transmits, far;  // far: place and interface define its direction
};

float transmission(bool transmits, float cosine, float index) {
  return transmits ? 1.0 - fresnel(cosine, 1.0 / index) : 1.0;
}

Segment segment_of(vec4 landed, vec4 left, float index) {
  Segment e;
  e.place = landed.xyz;
  e.interface_at = left.xyz;
  e.n = interface_normal(left.w);
  vec3 outward = e.place - e.interface_at;
  float length_m = length(outward);
  e.far = length_m > 1e-4 * (length(e.place) + length(e.interface_at));
  e.transmits = e.far && interface_transmits(left.w);
  vec3 d = outward / max(length_m, 1e-30);
  float cosine = dot(d, e.n);
  e.along = d - cosine * e.n;
  e.passes = max(transmission(e.transmits, cosine, index), 1e-6);
  e.arrives = landed.w / e.passes;
  return e;
}

// The light between two hits of one path.
struct Fan {
  bool bends;
  vec3 facing;  // normal of the plane that holds both places, as square to the light as can be
  vec3 curve;   // second difference of `along`
};

Fan fan_between(Segment a, Segment b, vec3 curve) {
  Fan f;
  vec3 chord = b.place - a.place;
  vec3 d = normalize(a.place - a.interface_at) + normalize(b.place - b.interface_at);
  f.facing = d - chord * (dot(d, chord) / max(dot(chord, chord), 1e-30));
  f.bends = a.far && b.far && chord != vec3(0) && dot(f.facing, f.facing) > 1e-4;
  f.curve = curve;
  return f;
}

// The cosine of light's direction to the interface's normal, for light that is so far along from a
// to b, by the index; 0 where the interface reflects all of it.
float cosine_between(Segment a, Segment b, Fan f, float s) {
  vec3 along = mix(a.along, b.along, s) + (s * (s - 1.0)) * f.curve;
  return sqrt(max(1.0 - dot(along, along), 0.0));
}

// And where it lands.
vec3 place_between(Segment a, Segment b, Fan f, float s) {
  vec3 along = mix(a.along, b.along, s) + (s * (s - 1.0)) * f.curve;
  vec3 n = normalize(mix(a.n, b.n, s)), interface_at = mix(a.interface_at, b.interface_at, s);
  vec3 d = along + cosine_between(a, b, f, s) * n;
  float facing = dot(f.facing, d), reach = dot(f.facing, a.place - interface_at) / facing;
  vec3 straight = mix(a.place, b.place, s);
  return f.bends && facing > 0.0 ? interface_at + reach * d : straight;
}
#endif
