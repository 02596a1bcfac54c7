// A beam as two triangles, as wide at each end as it reaches; what its fragments share.
#include "common.glsl"
#include "beam.glsl"
uniform samplerBuffer beams;  // behind the head of the list
uniform mat4 view_projection;
uniform vec4 eye_view[6];
uniform vec2 size;  // pixels
flat out vec4 places, last_light;  // at its end: place and red of the light
flat out vec4 depth_length, first_widths, last_widths;  // depths; lengths in pixels and in metres. A cell's; w: unit
flat out vec4 way_light, grows_light;  // its direction and green, as in beam.glsl; and blue

void main() {
  int corner = gl_VertexID % 6, end, k;
  corner = corner > 2 ? corner - 2 : corner;  // 0 1 2, 1 2 3
  end = corner >> 1;
  int beam = 1 + gl_VertexID / 6 * BEAM_TEXELS;
  places = texelFetch(beams, beam);
  vec4 depths = texelFetch(beams, beam + 1), across = texelFetch(beams, beam + 2);
  vec4 first = texelFetch(beams, beam + 3), last = texelFetch(beams, beam + 4);
  grows_light = texelFetch(beams, beam + 5);
  vec2 along = places.zw - places.xy, per_tangent = size / (eye_view[4].yw - eye_view[4].xz);
  float length_m = distance(first.xyz, last.xyz);
  depth_length = vec4(depths.xy, length(along), length_m);
  first_widths = vec4(depths.z, across.xz, per_tangent.x * per_tangent.y);
  last_widths = vec4(depths.w, across.yw, 0);
  last_light = vec4(last.xyz, first.w);
  way_light = vec4((last.xyz - first.xyz) / length_m, last.w);
  vec2 way = normalize(along);
  float side = ((corner & 1) == 0 ? -1.0 : 1.0) * beam_reach((end == 0 ? first_widths : last_widths).xyz);
  vec2 place = (end == 0 ? places.xy : places.zw) + side * vec2(-way.y, way.x);
  vec4 clip = view_projection * vec4(end == 0 ? first.xyz : last.xyz, 1);
  gl_Position = vec4((2.0 * place / size - 1.0) * clip.w, clip.zw);
}
