// What haze leaves of the picture, to multiply it by; or what it scatters, to add.
uniform sampler2D scattered;  // w: metres in haze
uniform vec3 haze_takes;      // haze.glsl
uniform bool adds;
layout(location = 0) out vec4 over;

void main() {
  vec4 at = texelFetch(scattered, ivec2(gl_FragCoord.xy), 0);
  over = vec4(adds ? at.rgb : exp(-haze_takes * at.w), 1);
}
