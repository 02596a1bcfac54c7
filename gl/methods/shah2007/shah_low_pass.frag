// A Gaussian of `sigma` texels along one axis of the map. What it lays past the map's edge is lost there.
#ifdef PLACES_CUBE
uniform sampler2DArray map;
uniform int face;
#else
uniform sampler2D map;
#endif
uniform ivec2 along;
uniform float sigma;
layout(location = 0) out vec4 light;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), size = textureSize(map, 0).xy;
  int reach = int(ceil(3.0 * sigma));
  float sum = 0.0;
  light = vec4(0);
  for (int k = -reach; k <= reach; k++) {
    ivec2 there = at + k * along;
    float weight = exp(-0.5 * float(k * k) / (sigma * sigma));
    sum += weight;
    if (all(greaterThanEqual(there, ivec2(0))) && all(lessThan(there, size)))
#ifdef PLACES_CUBE
      light += weight * texelFetch(map, ivec3(there, face), 0);
#else
      light += weight * texelFetch(map, there, 0);
#endif
  }
  light /= sum;
}
