// BAND_PARTS: attenuation or reflectance varies by wavelength. A path of the camera then keeps its optical depth in each
// part of its band of wavelengths (band_parts.h), so that of the band its mean transmittance is left at any length, and
// not that at one wavelength.
#ifdef BAND_PARTS
#define Depth mat2x4

Depth left_after(Depth depth) { return Depth(exp(-depth[0]), exp(-depth[1])); }

float least_of(Depth depth) {
  vec4 least = min(depth[0], depth[1]);
  return min(min(least.x, least.y), min(least.z, least.w));
}

// What weights of the parts sum to.
float sum_of(Depth weight, Depth part) { return dot(weight[0], part[0]) + dot(weight[1], part[1]); }

#ifdef MIRRORS
// The depth of a reflection: factors as mirror_reflectance() takes one, and what the metal itself
// reflects at that angle.
Depth mirror_depth(Depth factor, float metal) {
  return Depth(-log(max(1.0 - factor[0] * (1.0 - metal), 1e-30)), -log(max(1.0 - factor[1] * (1.0 - metal), 1e-30)));
}
#endif
#endif
