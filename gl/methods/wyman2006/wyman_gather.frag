// The light of photons in 7 x 7 pixels by the area that these show, both with Gaussian weights.
uniform sampler2D photon_sums, photon_direction_sums, areas;
layout(location = 0) out vec4 sum;
layout(location = 1) out vec4 directions;
const int RADIUS = 3;
const float SIGMA = 1.5, FEWEST = 3.0;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), most = textureSize(photon_sums, 0) - 1;
  float own = texelFetch(areas, pixel, 0).x, area = 0.0, count = 0.0;
  sum = vec4(0);
  directions = vec4(0);
  if (own <= 0.0) return;
  for (int y = max(-RADIUS, -pixel.y); y <= min(RADIUS, most.y - pixel.y); y++)
    for (int x = max(-RADIUS, -pixel.x); x <= min(RADIUS, most.x - pixel.x); x++) {
      ivec2 there = pixel + ivec2(x, y);
      float a = texelFetch(areas, there, 0).x;
      if (a <= 0.0) continue;
      float weight = exp(-0.5 * float(x * x + y * y) / (SIGMA * SIGMA));
      vec4 light = texelFetch(photon_sums, there, 0);
      area += weight * a;
      count += light.w;
      sum += weight * light;
#ifdef DIRECTIONS
      vec3 d = texelFetch(photon_direction_sums, there, 0).xyz;
#ifdef MEAN_DIRECTION
      d = dot(d, d) > 0.0 ? light.y * normalize(d) : vec3(0);
#endif
      directions.xyz += weight * d;
#endif
    }
#ifdef AS_PRINTED
  if (count < FEWEST) {
    sum = vec4(0);
    directions = vec4(0);
  }
#endif
  sum *= own / area;
  directions *= own / area;
}
