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

void main() {
  vec2 uv = photon_uv[0];
  vec4 front = texture(normals, vec3(uv, 0));
  if (dot(front.xyz, front.xyz) < 0.5) return;
  vec3 p1 = front.w * direction_at(uv), n1 = normalize(front.xyz);
  float back = to_z(texture(depths, vec3(uv, 1)).x), ahead = to_z(texture(depths, vec3(uv, 0)).x);
  float c = dot(direction_at(uv), spot.xyz);
  float beam = spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
  for (int i = 0; i < WAVELENGTHS; i++) {
    bool total;
    vec4 landing = find_receiver(p1, n1, ahead - back, index[i], normals, receiver_depth, 5, total);
    vec4 clip = projection * vec4(landing.xyz, 1);
    clip /= clip.w;
    gl_Position = clip;
    gl_PointSize = 3.0;
    centre = clip.xy;
    wavelength = i;
    strength = beam;
    EmitVertex();
    EndPrimitive();
  }
}
