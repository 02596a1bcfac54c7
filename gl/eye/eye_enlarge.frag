// The picture, of more pixels than samples: light between the four samples around a pixel, distance of
// the nearest.
layout(binding = 0) uniform sampler2DArray receivers;  // and refractors over them
uniform int pixels;  // a sample side
layout(location = 0) out vec4 picture;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 at = (vec2(pixel) + 0.5) / float(pixels) - 0.5;
  ivec2 last = textureSize(receivers, 0).xy - 1;
  ivec2 low = max(ivec2(floor(at)), ivec2(0)), high = min(ivec2(floor(at)) + 1, last);
  vec2 f = at - floor(at);
  vec3 below = mix(texelFetch(receivers, ivec3(low, 0), 0).rgb,
                   texelFetch(receivers, ivec3(high.x, low.y, 0), 0).rgb, f.x);
  vec3 above = mix(texelFetch(receivers, ivec3(low.x, high.y, 0), 0).rgb,
                   texelFetch(receivers, ivec3(high, 0), 0).rgb, f.x);
  ivec2 nearest = min(pixel / pixels, last);
  picture = vec4(mix(below, above, f.y), texelFetch(receivers, ivec3(nearest, 0), 0).w);
}
