// The wavelengths of the camera's rays, grouped, and grouped again by twos (gl/scene/spectra/camera_bands.h): level 0
// holds every one, level k every 2^k as one. Levels one after another, in sets. Who includes this has `xyz_from_rgb`.
struct Band {
  vec4 weight_n;  // XYZ, n
  vec4 surface;   // attenuation, 1/m; then of a mirror as mirror_spectrum()
};
#ifdef BANDS_IN_STORAGE
layout(std430, binding = BINDING_BANDS) readonly buffer Bands { Band bands[]; };
#else
layout(std140, binding = BINDING_BANDS) uniform Bands { Band bands[BAND_ROOM]; };
#endif

#include "band_colours.glsl"

int band_set;  // that is taken
int band_at;   // the band of it that is followed
int band_of_all_sets() { return band_set * counts.bands + band_at; }
int first_band(int r) { return (r * BAND_SETS + band_set) * counts.bands; }

mat3 colour_from_rgb;  // matrix of the band that is taken

#ifdef BAND_PARTS
Depth part_x, part_y, part_z;

Depth parts_at(int texel) {
  int at = 3 * BAND_SETS * counts.bands + texel;
  return Depth(texelFetch(band_texels, at), texelFetch(band_texels, at + 1));
}

Depth attenuation_of(int r) { return parts_at(2 * (first_band(r) + band_at)); }

#ifdef PLEOCHROIC
struct AxisDepths { Depth x, y, z; };  // 1/m, of fields along them

Depth attenuation_along(int axis, int r) {
  return parts_at((2 * REFRACTORS + 6) * BAND_SETS * counts.bands + 2 * (first_band(axis * REFRACTORS + r) + band_at));
}
#endif

void take_band(int set, int at) {
  band_set = set;
  band_at = at;
#ifdef FILMS
  film_row = counts.wavelengths + band_of_all_sets();
#endif
  colour_from_rgb = band_colour(band_of_all_sets()) * xyz_from_rgb;
  int light = 2 * REFRACTORS * BAND_SETS * counts.bands + 6 * (set * counts.bands + at);
  part_x = parts_at(light);
  part_y = parts_at(light + 2);
  part_z = parts_at(light + 4);
}

// Weights of X, Y and Z of what is left of the band.
vec3 band_left(Depth depth) {
  Depth left = left_after(depth);
  return vec3(sum_of(part_x, left), sum_of(part_y, left), sum_of(part_z, left));
}
#else
vec3 band_weight;

void take_band(int set, int at) {
  band_set = set;
  band_at = at;
#ifdef FILMS
  film_row = counts.wavelengths + band_of_all_sets();
#endif
  colour_from_rgb = band_colour(band_of_all_sets()) * xyz_from_rgb;
  band_weight = bands[set * counts.bands + at].weight_n.xyz;  // every refractor's are the same
}
#endif

vec2 refractor_spectrum(int r) {
  Band band = bands[first_band(r) + band_at];
  return vec2(band.weight_n.w, band.surface.x);
}

#ifdef CRYSTALS
Crystal crystal_of(int r) {
  int at = counts.crystals + 2 * r;
  return make_crystal(texelFetch(band_texels, at).xyz, texelFetch(band_texels, at + 1).xyz,
                      texelFetch(band_texels, counts.crystals + 2 * REFRACTORS + first_band(r) + band_at));
}
#endif

#ifdef PLEOCHROIC
AxisDepths axis_depths(int r) {
  return AxisDepths(attenuation_along(0, r), attenuation_along(1, r), attenuation_along(2, r));
}

Depth wave_attenuation(Crystal c, AxisDepths per_m, int wave, vec3 k) {
  vec3 shares = axis_shares(c, wave, k);
#ifdef UNIAXIAL
  return shares.x * per_m.x + shares.z * per_m.z;
#else
  return shares.x * per_m.x + shares.y * per_m.y + shares.z * per_m.z;
#endif
}

Depth wave_attenuation(Crystal c, int r, int wave, vec3 k) {
  return wave_attenuation(c, axis_depths(r), wave, k);
}
#endif

#ifdef GLOWS
#include "glow.glsl"
#endif

// What a path shows in all, of what it has shown: by the weights of that and of what is left, which shows the same.
vec3 tail_of(vec3 shown, vec3 left) { return 1.0 + left / max(shown, 1e-30); }

#ifdef FOLLOWS_PATHS
#ifdef MIRRORS
vec3 mirror_spectrum(int r) { return bands[first_band(r) + band_at].surface.yzw; }
#endif

vec3 left_of(PathState w) {
#ifdef BAND_PARTS
  return w.share * band_left(w.depth);
#else
  return w.share * band_weight;
#endif
}

// What ends at the interface that it comes to, by share: inside, that would have gone on by as much
// as it came.
vec3 left_further(PathState w, Interface h) {
  w.share = 1.0;
#ifdef ABSORBING
  if (w.inside != 0u) absorb_inside(w, h.hit.t);
#endif
  return left_of(w);
}

// XYZ of what the path has of an rgb radiance.
vec3 in_band(PathState w, vec3 radiance) { return left_of(w) * (colour_from_rgb * radiance); }
#endif
