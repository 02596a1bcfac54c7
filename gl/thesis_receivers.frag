// Receivers: spot, shadow map and spectral map with the thesis's factors.
in vec3 world;
in vec3 world_normal;
in vec2 surface_uv;
uniform sampler2D spectral_map;
uniform sampler2D shadow_map;
uniform sampler2DArray refractor_depths;  // front in layer 0: refractors cast shadows too
uniform sampler2DArray surface_texture;
uniform mat4 light_matrix;
uniform vec3 light_position;
uniform vec3 eye;
uniform vec4 spot;  // world direction, cosine of the cone
uniform float spot_inner;
uniform vec3 spot_colour;
uniform vec3 reflectance;
uniform vec3 texture_info;  // layer or -1, repeats
layout(location = 0) out vec4 radiance;
const float SCENE_AMBIENT = 0.1;

void main() {
  vec3 n = normalize(world_normal);
  if (dot(n, eye - world) < 0.0) n = -n;
  vec3 to_light = normalize(light_position - world);
  float diffuse = max(0.0, dot(n, to_light));
  vec3 colour = min(1.0, 1.0 / 1.5 + diffuse / 3.0) * reflectance;
  vec4 clip = light_matrix * vec4(world, 1);
  vec3 at = 0.5 * clip.xyz / clip.w + 0.5;
  bool seen = clip.w > 0.0 && all(equal(at, clamp(at, vec3(0), vec3(1))));
  float c = dot(-to_light, spot.xyz);
  float beam = spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
  float nearest = min(texture(shadow_map, at.xy).x, texture(refractor_depths, vec3(at.xy, 0)).x);
  float shade = nearest < at.z - 0.005 ? 0.0 : 1.0;
  vec3 light = seen ? (shade * 0.25 + 0.75) * colour * beam * spot_colour * 0.7 : vec3(0);
  light += colour * SCENE_AMBIENT;
  vec3 caustic = seen ? texture(spectral_map, at.xy).rgb * diffuse : vec3(0);
  vec3 sum = light + caustic * 3.0;
  if (texture_info.x >= 0.0)
    sum *= textureLod(surface_texture, vec3(surface_uv * texture_info.yz, texture_info.x), 0.0).rgb;
  radiance = vec4(sum, distance(eye, world));
}
