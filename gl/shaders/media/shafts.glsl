// Light in the medium of a refractor, cell by cell (gl/beams/shaft_grid.h): what of it is scattered along a ray
// that the camera's has become.
uniform sampler2DArray shaft_light;  // what is scattered, W/m3; then light's direction
uniform vec3 shaft_low, shaft_high;  // m
uniform int shaft_layers;
uniform int shaft_refractor;
uniform float shaft_g;

const int SHAFT_STEPS = 40;

// Over length_m from p, where the medium takes so much a metre.
vec3 shafts_along(vec3 p, vec3 d, float length_m, float per_m) {
  vec3 sum = vec3(0);
  float step_m = length_m / float(SHAFT_STEPS);
  for (int k = 0; k < SHAFT_STEPS; k++) {
    float t = (float(k) + 0.5) * step_m;
    vec3 at = (p + t * d - shaft_low) / (shaft_high - shaft_low);
    float layer = clamp(at.z * float(shaft_layers) - 0.5, 0.0, float(shaft_layers - 1)), low = floor(layer);
    float high = min(low + 1.0, float(shaft_layers - 1)), part = layer - low, behind = float(shaft_layers);
    vec3 light = mix(textureLod(shaft_light, vec3(at.xy, low), 0.0).rgb,
                     textureLod(shaft_light, vec3(at.xy, high), 0.0).rgb, part);
    vec3 way = mix(textureLod(shaft_light, vec3(at.xy, behind + low), 0.0).rgb,
                   textureLod(shaft_light, vec3(at.xy, behind + high), 0.0).rgb, part);
    float turned = -dot(way, d) / max(length(way), 1e-30);
    sum += light * (haze_phase(shaft_g, turned) * exp(-per_m * t));
  }
  return step_m * sum;
}
