// What is left of a photon's light, in the parts of its wavelength's band below and above the node. BAND_PARTS: what
// attenuates does so by wavelength, and a path keeps its optical depth in four parts of each half, in order of
// wavelength (gl/scene/spectra/band_attenuation.h); else all shares are the node's own.

#include "optical_depth.glsl"
#include "packed_depth.glsl"

#ifdef BAND_PARTS
#define Shares vec2

// Of the coarse set, then of all wavelengths: two texels a node and refractor, of the half below the node and the
// half above, attenuation, 1/m, or a mirror's factors; then two a light and node, what of the half's Y each part is.
uniform samplerBuffer band_attenuation;

int below_texel, above_texel;  // of the first refractor's halves
Depth part_of_half;

// Where the set begins, of the coarse one or of all wavelengths.
int band_set_texel(bool coarse) {
  return coarse || counts.nodes == counts.wavelengths ? 0 : 2 * counts.nodes * (REFRACTORS + LIGHTS);
}

int half_texel(bool coarse, int node, int half_number) {
  return band_set_texel(coarse) + 2 * node * REFRACTORS + half_number;
}

int share_texel(bool coarse, int node, int half_number) {
  int nodes = coarse ? counts.nodes : counts.wavelengths;
  return band_set_texel(coarse) + 2 * nodes * REFRACTORS + 2 * (light * nodes + node) + half_number;
}

Depth attenuation_of(int r) {
  return Depth(texelFetch(band_attenuation, below_texel + 2 * r), texelFetch(band_attenuation, above_texel + 2 * r));
}

// Of both halves, what is left.
Shares left_of(Depth depth) {
  Depth left = left_after(depth);
  return vec2(dot(part_of_half[0], left[0]), dot(part_of_half[1], left[1]));
}
#else
#define Shares float
#endif
