// What haze leaves of the picture, to multiply it by; or what it scatters, to add.
#include "common.glsl"
#include "haze.glsl"
uniform sampler2D scattered;  // w: metres in haze
uniform bool adds;
layout(location = 0) out vec4 over;

void main() {
  vec4 at = texelFetch(scattered, ivec2(gl_FragCoord.xy), 0);
  over = vec4(adds ? at.rgb : haze_eye_tint(at.w), 1);
}
