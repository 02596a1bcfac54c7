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
  vec4 a = texelFetch(receivers, ivec3(low, 0), 0), b = texelFetch(receivers, ivec3(high.x, low.y, 0), 0);
  vec4 c = texelFetch(receivers, ivec3(low.x, high.y, 0), 0), d = texelFetch(receivers, ivec3(high, 0), 0);
  bvec2 nearer_high = greaterThanEqual(f, vec2(0.5));
  vec2 distances = nearer_high.x ? vec2(b.w, d.w) : vec2(a.w, c.w);
  picture = vec4(mix(mix(a.rgb, b.rgb, f.x), mix(c.rgb, d.rgb, f.x), f.y), nearer_high.y ? distances.y : distances.x);
}
