// A beam as two triangles, as wide at each end as it reaches.
#include "common.glsl"
#include "beam.glsl"
uniform samplerBuffer beams;  // behind the head of the list
uniform mat4 view_projection;
uniform vec2 size;  // pixels
flat out int beam;

void main() {
  int corner = gl_VertexID % 6, end, k;
  corner = corner > 2 ? corner - 2 : corner;  // 0 1 2, 1 2 3
  end = corner >> 1;
  beam = 1 + gl_VertexID / 6 * BEAM_TEXELS;
  vec4 places = texelFetch(beams, beam), depths = texelFetch(beams, beam + 1), across = texelFetch(beams, beam + 2);
  vec4 at = texelFetch(beams, beam + 3 + end);
  vec2 way = normalize(places.zw - places.xy);
  vec3 widths = end == 0 ? vec3(depths.z, across.xz) : vec3(depths.w, across.yw);
  float side = ((corner & 1) == 0 ? -1.0 : 1.0) * beam_reach(widths);
  vec2 place = (end == 0 ? places.xy : places.zw) + side * vec2(-way.y, way.x);
  vec4 clip = view_projection * vec4(at.xyz, 1);
  gl_Position = vec4((2.0 * place / size - 1.0) * clip.w, clip.zw);
}
