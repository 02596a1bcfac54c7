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
#ifdef CIE
uniform mat3 rgb_from_xyz;
uniform mat3 xyz_from_rgb;
uniform float ambient;  // W/m2
uniform float attenuation_of[WAVELENGTHS];
#else
const float SCENE_AMBIENT = 0.1;
#endif

void main() {
  vec2 uv = gl_FragCoord.xy / picture_size;
  vec4 front = texture(normals, vec3(uv, 0));
  vec4 behind = texture(receivers, uv);
  radiance = behind;
  if (front.w == 0.0) return;
  if (texture(receiver_depth, uv).x < texture(depths, vec3(uv, 0)).x) return;
  vec3 p1 = front.w * direction_at(uv), n1 = normalize(front.xyz), v = normalize(p1);
  float d_v = -length(p1) - to_z(texture(depths, vec3(uv, 1)).x);
#ifdef CIE
  vec3 sum = vec3(0);
  for (int i = 0; i < WAVELENGTHS; i++) {
    float passes;
    vec4 hit = find_receiver(p1, n1, d_v, index[i], normals, receiver_depth, 10, passes);
    vec3 seen = texture(receivers, to_texture(vec4(hit.xyz, 1))).rgb;
    sum += xyz_from_rgb * seen * colour[i] * (passes * exp(-d_v * attenuation_of[i]));
    // The outside mirrors what is all around, as in the thesis.
    sum += xyz_from_rgb * vec3(ambient / 3.14159265) * colour[i] *
           fresnel(dot(-v, n1), 1.0 / index[i]);
  }
  radiance = vec4(rgb_from_xyz * sum, front.w);
#else
  float one_minus = 1.0 - dot(-v, n1);
  float mirror = 0.05 + 0.95 * pow(one_minus, 5.0);
  vec3 half_vector = normalize(normalize(light_position - p1) - v);
  vec3 highlight = pow(max(0.0, dot(n1, half_vector)), 50.0) * spot_colour;
  vec3 sum = mirror * (20.0 * highlight + 2.0 * SCENE_AMBIENT);
  for (int i = 0; i < WAVELENGTHS; i++) {
    float passes;
    vec4 hit = find_receiver(p1, n1, d_v, index[i], normals, receiver_depth, 10, passes);
    vec3 seen = exp(-d_v * attenuation) * texture(receivers, to_texture(vec4(hit.xyz, 1))).rgb;
    sum += seen * colour[i] * (1.0 - mirror);
  }
  radiance = vec4(sum, front.w);
#endif
}
