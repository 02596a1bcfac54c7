// Photons of the last frames with this one's. As printed, counts alone are kept: what a photon carries is this
// frame's, in its pixel or in the neighbourhood, and where that has none, the kept frames'. Else light is kept.
uniform sampler2D photon_sums, photon_direction_sums, kept[3];
uniform int frames;  // that are kept
layout(location = 0) out vec4 sum;
layout(location = 1) out vec4 directions;
const int RADIUS = 3;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 own = texelFetch(photon_sums, pixel, 0);
  sum = own;
  if (frames > 0) sum += texelFetch(kept[0], pixel, 0);
  if (frames > 1) sum += texelFetch(kept[1], pixel, 0);
  if (frames > 2) sum += texelFetch(kept[2], pixel, 0);
  sum /= float(frames + 1);
  directions = vec4(0);
#ifdef AS_PRINTED
  vec4 near = own, near_directions = texelFetch(photon_direction_sums, pixel, 0);
  ivec2 most = textureSize(photon_sums, 0) - 1;
  if (sum.w > 0.0 && own.w <= 0.0)
    for (int y = max(-RADIUS, -pixel.y); y <= min(RADIUS, most.y - pixel.y); y++)
      for (int x = max(-RADIUS, -pixel.x); x <= min(RADIUS, most.x - pixel.x); x++) {
        near += texelFetch(photon_sums, pixel + ivec2(x, y), 0);
        near_directions += texelFetch(photon_direction_sums, pixel + ivec2(x, y), 0);
      }
  if (near.w > 0.0) {
    sum.rgb = near.rgb * (sum.w / near.w);
    directions = near_directions * (sum.w / near.w);
  }
#endif
}
