// What is left of a photon's light after its path inside, in the parts of its wavelength's band below
// and above the node. TINTING: what attenuates does so by wavelength, and hits keep the length of
// their path inside, which has it at all wavelengths; else all shares are the node's own.

#ifdef TINTING
#define Shares vec2

// Of the halves of a node's band, below it and above, at 2 * (2 * ((light * REFRACTORS + refractor) *
// nodes + node) + (above ? 1 : 0)), the coarse set's before those of all wavelengths: attenuation of
// four parts, 1/m, in order of wavelength, and what of the half's Y each is.
uniform samplerBuffer band_attenuation;

vec4 attenuation[2], part_of_half[2];

// The first of all wavelengths'.
int all_bands(int row) {
  return (counts.nodes < counts.wavelengths ? LIGHTS * REFRACTORS * counts.nodes : 0) + row * counts.wavelengths;
}

void load_halves(int below, int above) {
  attenuation = vec4[2](texelFetch(band_attenuation, 2 * below), texelFetch(band_attenuation, 2 * above));
  part_of_half = vec4[2](texelFetch(band_attenuation, 2 * below + 1),
                         texelFetch(band_attenuation, 2 * above + 1));
}

vec2 left_after(float path_m) {
  return vec2(dot(part_of_half[0], exp(-path_m * attenuation[0])),
              dot(part_of_half[1], exp(-path_m * attenuation[1])));
}

// What a stretch inside takes of light, of which so much was left before; path_m: all of the path.
Shares absorb(float metres, float per_m, inout float share, inout float path_m, inout Shares left) {
  Shares before = left;
  path_m += metres;
  left = left_after(path_m);
  return share * (before - left);
}

// At the node itself.
float left_at_node(float share, float per_m, float path_m) { return share * exp(-per_m * path_m); }
#else
#define Shares float

Shares absorb(float metres, float per_m, inout float share, inout float path_m, inout Shares left) {
#ifdef ABSORBING
  float before = share, passed = exp(-per_m * metres);
  share *= passed;
  return before * (1.0 - passed);
#else
  return 0.0;
#endif
}

float left_at_node(float share, float per_m, float path_m) { return share; }
#endif
