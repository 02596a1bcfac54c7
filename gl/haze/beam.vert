// A line for each hit of a batch: light on its way from its last interface to a receiver.
#include "common.glsl"
uniform samplerBuffer hits;         // [photons][slots][hit_stride] of HIT_TEXELS (outgoing_segment.glsl)
uniform usamplerBuffer signatures;  // 0: no hit
uniform samplerBuffer beam_colours; // [light views][wavelengths] of unit power, in the picture's space
uniform mat4 view_projection;
uniform int light, stride, sample_count, sample_first;
out vec3 at;          // a place of the line
flat out vec3 power;  // W at its end
flat out vec3 end;    // where it lands
flat out vec3 way;    // unit

void main() {
  int line = gl_VertexID >> 1, path = line / sample_count, own = line - path * sample_count;
  int hit = path * stride + own;
  vec4 landed = texelFetch(hits, 2 * hit), left = texelFetch(hits, 2 * hit + 1);
  bool there = texelFetch(signatures, hit).x != 0u && landed.w > 0.0;
  vec3 along = landed.xyz - left.xyz;
  float length_m = length(along);
  there = there && length_m > 0.0;
  power = texelFetch(beam_colours, light * counts.wavelengths + sample_first + own).rgb * landed.w;
  end = landed.xyz;
  way = along / max(length_m, 1e-30);
  at = (gl_VertexID & 1) == 0 ? left.xyz : landed.xyz;
  gl_Position = there ? view_projection * vec4(at, 1) : vec4(2, 2, 2, 1);
}
