// For each band, of all sets, the columns of a matrix that makes of XYZ what the band has of it, by
// its weight (gl/scene/spectra/camera_bands.h). BAND_PARTS: then two texels a band and refractor,
// of each part: attenuation, 1/m, or a mirror's factors; then six a band: X, Y and Z.
layout(binding = UNIT_BAND_TEXELS) uniform samplerBuffer band_texels;

mat3 band_colour(int band) {
  int at = 3 * band;
  return mat3(texelFetch(band_texels, at).xyz, texelFetch(band_texels, at + 1).xyz, texelFetch(band_texels, at + 2).xyz);
}
