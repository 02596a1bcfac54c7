// A Gaussian that ends at three standard deviations, half of the splat's size.
flat in vec2 centre;
flat in vec3 peak;
uniform float map_side;
uniform float splat_size;
layout(location = 0) out vec4 splat;

void main() {
  vec2 d = (gl_FragCoord.xy - centre * map_side) * (6.0 / splat_size);
  float r2 = dot(d, d);
  splat = vec4(r2 < 9.0 ? peak * exp(-0.5 * r2) : vec3(0), 1);
}
