// What is left of a photon's light, of its band below and above the node. TINTS: what attenuates does so by
// wavelength, and a path keeps how much it passed of what (tints.glsl); the ledger takes the halves' means.

#ifdef TINTS
#define Shares vec2

int below_texel, above_texel;  // texels of the first refractor's node
bool below_is_above, above_is_below;  // a half of another set's band stands for it

// Attenuation by a refractor or mirror, by amount, in two parts below the node and two above it;
// the least of these; and whose tint it is, -1: it has none.
struct Attenuation {
  vec4 parts;
  float least;
  int tint;
};

Attenuation attenuation_of(int r) {
  int of_below = below_texel + TINT_TEXELS * r, of_above = above_texel + TINT_TEXELS * r;
  vec4 below = texelFetch(tints, of_below), above = texelFetch(tints, of_above);
  Attenuation a;
  a.parts = vec4(below_is_above ? below.zw : below.xy, above_is_below ? above.xy : above.zw);
  a.least = min(min(a.parts.x, a.parts.y), min(a.parts.z, a.parts.w));
  a.tint = int(texelFetch(tints, of_below + 1).y);
  return a;
}

vec2 left_after(vec4 depth) { return vec2(left_after(depth.xy), left_after(depth.zw)); }

// What a path has passed. What exceeds the capacity is not kept: it is taken off at once.
struct Passed {
  Tints tints;
  vec4 depth;  // depth of the tints, in the parts of the band
};

Passed none_passed() { return Passed(no_tints(), vec4(0)); }
#else
#define Shares float
#endif
