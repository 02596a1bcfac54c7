// TINTS: what takes light by wavelength tints it. A photon's path keeps how much of each stuff it passed, of so many
// stuffs, and so does its hit: attenuation at all wavelengths follows (gl/plan/examine/examine.h).
#ifdef TINTS
struct Tints {
  float amount[TINTS];
  int of[TINTS];  // the first refractor of that stuff; -1: none yet
};

Tints no_tints() {
  Tints t;
  for (int k = 0; k < TINTS; k++) {
    t.amount[k] = 0.0;
    t.of[k] = -1;
  }
  return t;
}

// False where the capacity is used up.
bool add_tint(inout Tints t, int of, float amount) {
  bool added = of < 0;
  for (int k = 0; k < TINTS; k++) {
    bool here = !added && (t.of[k] < 0 || t.of[k] == of);
    t.of[k] = here ? of : t.of[k];
    t.amount[k] += here ? amount : 0.0;
    added = added || here;
  }
  return added && of >= 0;
}

// An amount in 24 bits, and whose it is in eight; as abbe_photon_attenuate() reads them.
uint pack_tint(Tints t, int k) {
  uint amount = (floatBitsToUint(t.amount[k]) << 1) + 128u & ~255u;
  return t.of[k] < 0 ? 0u : amount | uint(t.of[k]);
}

// A hit's signature and tints, as storage holds them, and as textures give them.
#if TINTS == 1
#define Signature uvec2
uvec2 pack_signature(uint path, Tints t) { return uvec2(path, pack_tint(t, 0)); }
uvec4 wide_signature(Signature s) { return uvec4(s, 0u, 0u); }
uint tint_word(uvec4 signature, int k) { return signature.y; }
#else
#define Signature uvec4
uvec4 pack_signature(uint path, Tints t) {
  return uvec4(path, pack_tint(t, 0), pack_tint(t, 1), TINTS > 2 ? pack_tint(t, TINTS - 1) : 0u);
}
uvec4 wide_signature(Signature s) { return s; }
uint tint_word(uvec4 signature, int k) { return signature[k + 1]; }
#endif

Tints tints_of(uvec4 signature) {
  Tints t;
  for (int k = 0; k < TINTS; k++) {
    uint word = tint_word(signature, k);
    t.of[k] = int(word & 255u);
    t.amount[k] = uintBitsToFloat((word & ~255u) >> 1);
  }
  return t;
}

// Tints between two hits of one path at that place between them.
Tints tints_between(Tints a, Tints b, float t) {
  for (int k = 0; k < TINTS; k++) a.amount[k] = mix(a.amount[k], b.amount[k], a.of[k] == b.of[k] ? t : 0.0);
  return a;
}

bool has_tint(Tints t, int of) {
  bool has = false;
  for (int k = 0; k < TINTS; k++) has = has || (t.amount[k] > 0.0 && t.of[k] == of);  // an empty one is the first's
  return has;
}

// Tables of what tints: two texels each at [node][surface] (spectral_tables.h). Attenuation of
// two parts of a band below its node, and of two above it, each of a half's brightness; then by how
// much it differs within a half, and whose tint it is.
uniform samplerBuffer tints;
const int TINT_TEXELS = 2;

// The depths of the two parts of a half.
vec2 depth_of(Tints t, int texel, bool above) {
  vec2 depth = vec2(0);
  for (int k = 0; k < TINTS; k++) {
    vec4 parts = texelFetch(tints, texel + TINT_TEXELS * t.of[k]);
    depth += t.amount[k] * (above ? parts.zw : parts.xy);
  }
  return depth;
}

float left_after(vec2 depth) { return 0.5 * (exp(-depth.x) + exp(-depth.y)); }

// By how much optical depth ranges within a half, at the most.
float range_of(Tints t, int texel) {
  float range = 0.0;
  for (int k = 0; k < TINTS; k++) range += t.amount[k] * texelFetch(tints, texel + TINT_TEXELS * t.of[k] + 1).x;
  return range;
}
#else
#define Signature uint
#endif
