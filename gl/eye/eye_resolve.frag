// The picture: refractors over receivers, samples averaged to pixels.
layout(binding = 0) uniform sampler2DArray receivers;
layout(binding = 1) uniform sampler2D refraction;
uniform int samples;  // a pixel side
layout(location = 0) out vec4 picture;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 sum = vec3(0);
  float nearest = 0.0;
  for (int y = 0; y < samples; y++)
    for (int x = 0; x < samples; x++) {
      ivec2 at = pixel * samples + ivec2(x, y);
      vec4 glass = texelFetch(refraction, at, 0);
      vec4 seen = glass.w > 0.0 ? glass : texelFetch(receivers, ivec3(at, 0), 0);
      sum += seen.rgb;
      if (seen.w > 0.0 && (nearest == 0.0 || seen.w < nearest)) nearest = seen.w;
    }
  picture = vec4(sum / float(samples * samples), nearest);
}
