// Deferred refraction over the whole picture: one fetch of the lit receivers a wavelength.
#include "thesis_common.glsl"
uniform sampler2DArray normals;
uniform sampler2DArray depths;
uniform sampler2D receiver_depth;
uniform sampler2D receivers;
uniform vec2 picture_size;
uniform float index[WAVELENGTHS];
uniform vec3 colour[WAVELENGTHS];
uniform vec3 light_position;  // view space
uniform vec3 spot_colour;
uniform float attenuation;
layout(location = 0) out vec4 radiance;
const float SCENE_AMBIENT = 0.1;

void main() {
  vec2 uv = gl_FragCoord.xy / picture_size;
  vec4 front = texture(normals, vec3(uv, 0));
  vec4 behind = texture(receivers, uv);
  radiance = behind;
  if (front.w == 0.0) return;
  if (texture(receiver_depth, uv).x < texture(depths, vec3(uv, 0)).x) return;
  vec3 p1 = front.w * direction_at(uv), n1 = normalize(front.xyz), v = normalize(p1);
  float one_minus = 1.0 - dot(-v, n1);
  float mirror = 0.05 + 0.95 * pow(one_minus, 5.0);
  vec3 half_vector = normalize(normalize(light_position - p1) - v);
  vec3 highlight = pow(max(0.0, dot(n1, half_vector)), 50.0) * spot_colour;
  vec3 sum = mirror * (20.0 * highlight + 2.0 * SCENE_AMBIENT);
  float d_v = -length(p1) - to_z(texture(depths, vec3(uv, 1)).x);
  for (int i = 0; i < WAVELENGTHS; i++) {
    bool total;
    vec4 hit = find_receiver(p1, n1, d_v, index[i], normals, receiver_depth, 10, total);
    vec3 seen = exp(-d_v * attenuation) * texture(receivers, to_texture(vec4(hit.xyz, 1))).rgb;
    sum += seen * colour[i] * (1.0 - mirror);
  }
  radiance = vec4(sum, front.w);
}
