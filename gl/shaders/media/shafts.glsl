// Light in media, cell by cell (gl/beams/beam_list.h): what of it is scattered along a ray that the camera's has
// become, in SHAFT_STEPS steps.
uniform sampler2DArray shaft_light;  // what is scattered, W/m3; then light's direction
// For each medium: its box, m; the share of the texture's width and height that it has, its first
// layer and cells upwards; the refractor, or -1: the air, and the mean cosine.
uniform vec3 shaft_low[SHAFTS], shaft_high[SHAFTS];
uniform vec4 shaft_place[SHAFTS];
uniform vec4 shaft_medium[SHAFTS];

// A refractor's, or the air's; -1: there is none.
int shaft_of(int refractor) {
  int found = -1;
  for (int k = 0; k < SHAFTS; k++) found = int(shaft_medium[k].x) == refractor ? k : found;
  return found;
}

// The light of medium k over length_m from p, where it takes so much a metre.
vec3 shafts_along(int k, vec3 p, vec3 d, float length_m, vec3 per_m) {
  vec3 sum = vec3(0), low_at = shaft_low[k], box = shaft_high[k] - low_at;
  vec4 place = shaft_place[k];
  vec2 half_texel = 0.5 / vec2(textureSize(shaft_light, 0).xy);
  float step_m = length_m / float(SHAFT_STEPS), layers = place.w;
  for (int i = 0; i < SHAFT_STEPS; i++) {
    float t = (float(i) + 0.5) * step_m;
    vec3 at = (p + t * d - low_at) / box;
    vec2 on = clamp(at.xy * place.xy, half_texel, place.xy - half_texel);
    float layer = clamp(at.z * layers - 0.5, 0.0, layers - 1.0), low = floor(layer);
    float high = min(low + 1.0, layers - 1.0), part = layer - low, behind = place.z + layers;
    vec3 light = mix(textureLod(shaft_light, vec3(on, place.z + low), 0.0).rgb,
                     textureLod(shaft_light, vec3(on, place.z + high), 0.0).rgb, part);
    vec3 way = mix(textureLod(shaft_light, vec3(on, behind + low), 0.0).rgb,
                   textureLod(shaft_light, vec3(on, behind + high), 0.0).rgb, part);
    float turned = -dot(way, d) / max(length(way), 1e-30);
    sum += light * (haze_phase(shaft_medium[k].y, turned) * exp(-per_m * t));
  }
  return step_m * sum;
}
