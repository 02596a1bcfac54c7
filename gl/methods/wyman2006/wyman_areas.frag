// The area of receivers that a pixel shows, m2, by its neighbours' places; 0: it shows none. Across an edge the
// nearer neighbour counts.
uniform sampler2D drawn_places;
layout(location = 0) out vec4 area;

vec3 side(ivec2 pixel, ivec2 step, vec3 middle) {
  ivec2 most = textureSize(drawn_places, 0) - 1;
  vec4 a = texelFetch(drawn_places, clamp(pixel - step, ivec2(0), most), 0);
  vec4 b = texelFetch(drawn_places, clamp(pixel + step, ivec2(0), most), 0);
  vec3 before = middle - a.xyz, behind = b.xyz - middle;
  float la = a.w > 0.5 ? dot(before, before) : 0.0, lb = b.w > 0.5 ? dot(behind, behind) : 0.0;
  if (la == 0.0) return lb == 0.0 ? vec3(0) : behind;
  if (lb == 0.0) return before;
  if (max(la, lb) < 4.0 * min(la, lb)) return 0.5 * (before + behind);
  return la < lb ? before : behind;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 middle = texelFetch(drawn_places, pixel, 0);
  area = vec4(0);
  if (middle.w < 0.5) return;
  area.x = length(cross(side(pixel, ivec2(1, 0), middle.xyz), side(pixel, ivec2(0, 1), middle.xyz)));
}
