// The light that refractors send to a place on a receiver, as the spectral map and its tiles hold it.

const float MOST_TAPS = 4.0;

// The mean of a layer over what lies between `at` and the neighbouring samples, `a` and `b` away: taps
// along the longer axis, in a level whose texels are half as wide as the shorter one; of nothing outside
// rect: left, bottom, right, top, which the filter keeps to where that is the `whole` layer. All in parts
// of the layer.
vec3 layer_mean(int layer, vec2 at, vec2 a, vec2 b, vec4 rect, const bool whole) {
  // Nothing is known of a neighbour that the layer does not hold.
  a = all(lessThan(abs(a), vec2(1))) ? a : vec2(0);
  b = all(lessThan(abs(b), vec2(1))) ? b : vec2(0);
  vec2 longer = dot(a, a) > dot(b, b) ? a : b, shorter = dot(a, a) > dot(b, b) ? b : a;
  float side = float(textureSize(spectral_map, 0).x);
  float wide = length(longer) * side, narrow = max(length(shorter) * side, wide / MOST_TAPS);
  float level = max(log2(max(narrow, 1e-6)) - 0.8, 0.0);
  float taps = clamp(ceil(wide / max(narrow, 1.0) - 0.2), 1.0, MOST_TAPS);
  vec2 low = vec2(0), high = vec2(1);
  if (!whole) {
    vec2 rim = vec2(0.5 * exp2(ceil(level)) / side), middle = 0.5 * (rect.xy + rect.zw);
    low = min(rect.xy + rim, middle);
    high = max(rect.zw - rim, middle);
  }
  // No compiler knows how often this turns, and so unrolls it: a software rasteriser takes every tap of an unrolled
  // loop for all lanes, and of this one only as many as some lane wants.
  vec3 sum = vec3(0);
  float tap = 1.0 / taps, k = 0.5 * tap;
  do {
    vec2 here = at + longer * (k - 0.5);
    sum += textureLod(spectral_map, vec3(whole ? here : clamp(here, low, high), layer), level).xyz;
    k += tap;
  } while (k < 1.0);
  return sum * tap;
}

// Whether the side of a receiver at p that n points from looks to the refractors. Where its plane cuts
// their bounds, that is also the side that the light is on.
bool is_before(vec3 n, float facing, vec3 p) {
  float before = dot(n, refractor_bounds.xyz - p);
  return before > 0.0 || (before > -refractor_bounds.w && facing > 0.0);
}

// The same of a parallelogram.
bool takes_refracted(vec3 n, float facing, vec3 p) {
#ifdef CUBES
  return is_before(n, facing, p);  // they stand all around the light
#else
  return dot(n, refractor_bounds.xyz - p) > 0.0;
#endif
}

// How far it is in a map to where the neighbouring samples are: PLACE(p) is where p is. SEEN_BY_PIXELS: from neighbouring fragments. SEEN_BY_AREAS: from the area of the receiver for which p stands.
#if defined(SEEN_BY_PIXELS)
#define STEP_RIGHT(PLACE, at) dFdx(at)
#define STEP_ABOVE(PLACE, at) dFdy(at)
#elif defined(SEEN_BY_AREAS)
vec3 area_right, area_above;  // its sides, m
#define STEP_RIGHT(PLACE, at) (PLACE(p + area_right) - at)
#define STEP_ABOVE(PLACE, at) (PLACE(p + area_above) - at)
#else
#define STEP_RIGHT(PLACE, at) vec2(0)
#define STEP_ABOVE(PLACE, at) vec2(0)
#endif

// Part of the light's map.
vec2 place_on_map(int light, vec3 p) {
  vec3 uvz;
  project(LIGHT(light).map_view, p, uvz);
  return warp(light, uvz.xy);
}
#define PLACE_ON_MAP(p) place_on_map(light, p)

#ifdef TILES
// Irradiance, as caustic_colour, of the tile on that side of a chart: it holds what reaches that side, whatever the light
// sees of it. lit: the light meets a refractor.
vec3 tile_irradiance(int light, vec3 p, int side, bool lit) {
  int tile = tile_of_side(light, side);
  vec4 rect = tile_rect(light, max(tile, 0)), across = tile_across(light, max(tile, 0));
  vec2 texels = place_on_tile(light, max(tile, 0), p);
  float layer_side = float(textureSize(spectral_map, 0).x);
#define PLACE_ON_LAYER(p) (place_on_tile(light, max(tile, 0), p) / layer_side)
  vec2 at = texels / layer_side;
  vec2 to_right = STEP_RIGHT(PLACE_ON_LAYER, at), to_above = STEP_ABOVE(PLACE_ON_LAYER, at);
  vec3 irradiance = vec3(0);
  if (lit && tile >= 0 && is_within(rect, texels)) {
#ifdef RECEIVER_HIERARCHY
    float steep = abs(dot(face_n, across.xyz));
#else
    const float steep = 1.0;
#endif
    irradiance = caustic_colour(
        layer_mean(atlas_layer(light), at, to_right, to_above, rect / layer_side, false) * steep);
  }
  return irradiance;
}
#endif
