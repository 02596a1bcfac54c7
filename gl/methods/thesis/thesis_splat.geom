// One photon becomes one a wavelength, each refracted twice and brought to the receiver.
layout(points) in;
layout(points, max_vertices = WAVELENGTHS) out;
#include "thesis_common.glsl"
in vec2 photon_uv[];
uniform sampler2DArray normals;
uniform sampler2DArray depths;
uniform sampler2D receiver_depth;
uniform float index[WAVELENGTHS];
uniform vec4 spot;     // direction in light space, cosine of the cone
uniform float spot_inner;
flat out vec2 centre;  // clip coordinates
flat out int wavelength;
flat out float strength;
uniform float attenuation_of[WAVELENGTHS];  // 1/m

void main() {
  vec2 uv = photon_uv[0];
  vec4 front = texture(normals, vec3(uv, 0));
  if (dot(front.xyz, front.xyz) < 0.5) return;
#ifdef CIE
  // Light that a receiver stops before it is no light of the refractor's.
  if (texture(receiver_depth, uv).x < texture(depths, vec3(uv, 0)).x) return;
#endif
  vec3 p1 = front.w * direction_at(uv), n1 = normalize(front.xyz);
  float back = to_z(texture(depths, vec3(uv, 1)).x), ahead = to_z(texture(depths, vec3(uv, 0)).x);
  float c = dot(direction_at(uv), spot.xyz);
  float beam = spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
  for (int i = 0; i < WAVELENGTHS; i++) {
    float passes;
    vec4 hit =
        find_receiver(p1, n1, ahead - back, index[i], normals, receiver_depth, 5, passes);
    vec4 clip = projection * vec4(hit.xyz, 1);
    clip /= clip.w;
    gl_Position = clip;
    gl_PointSize = 3.0;
    centre = clip.xy;
    wavelength = i;
    strength = beam;
#ifdef CIE
    float slant = -direction_at(uv).z;  // share of the solid angle of a cell
    strength *= slant * slant * slant * passes * exp(-attenuation_of[i] * (ahead - back));
#endif
    EmitVertex();
    EndPrimitive();
  }
}
