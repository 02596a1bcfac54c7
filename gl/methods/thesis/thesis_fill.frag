// The thesis's gap fill: a dark texel takes the mean of what lies within 20 steps to both sides.
uniform sampler2D spectral_map;
layout(location = 0) out vec4 filled;
const int STEPS_OUT = 20;
#ifdef CIE
const float BRIGHTNESS = 1.0 / float(STEPS_OUT - 1);  // a mean
#else
const float BRIGHTNESS = 0.2;
#endif

vec3 gather(ivec2 at, ivec2 direction) {
  vec3 sum = vec3(0);
  ivec2 size = textureSize(spectral_map, 0);
  for (int i = 1; i < STEPS_OUT; i++) {
    ivec2 t = at + i * direction;
    if (all(greaterThanEqual(t, ivec2(0))) && all(lessThan(t, size)))
      sum += texelFetch(spectral_map, t, 0).rgb;
  }
  return sum;
}

vec3 between(ivec2 at, ivec2 axis) {
  vec3 a = gather(at, axis), b = gather(at, -axis);
  if (all(lessThanEqual(a, vec3(0.1))) || all(lessThanEqual(b, vec3(0.1)))) return vec3(0);
  return mix(a, b, 0.5) * BRIGHTNESS;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 here = texelFetch(spectral_map, at, 0);
  filled = here;
  if (all(lessThan(here.rgb, vec3(0.3))))
    filled = vec4(mix(between(at, ivec2(0, 1)), between(at, ivec2(1, 0)), 0.5), 1.0);
}
