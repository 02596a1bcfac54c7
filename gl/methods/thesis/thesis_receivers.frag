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
uniform vec3 planes;  // near * far, far - near, far
uniform vec3 reflectance;
uniform vec3 texture_info;  // layer or -1, repeats
layout(location = 0) out vec4 radiance;
#ifdef CIE
uniform mat3 rgb_from_xyz;
uniform vec3 forward;   // axis of the light's view
uniform vec3 white;     // XYZ of the light
uniform float power;    // W/sr
uniform float ambient;  // W/m2
const float PI = 3.14159265358979;

// Radiance: irradiance straight, through refractors, and from all around.
vec3 lit(vec3 n, vec3 to_light, vec3 caustic, float beam, bool shaded) {
  float d2 = dot(light_position - world, light_position - world), c = dot(-to_light, forward);
  vec3 straight = shaded ? vec3(0) : white * (max(0.0, dot(n, to_light)) * beam);
  vec3 xyz = straight + caustic * (abs(dot(n, to_light)) / (c * c * c));
  return (rgb_from_xyz * xyz * (power / d2) + ambient) * reflectance / PI;
}
#else
const float SCENE_AMBIENT = 0.1;
#endif

float to_distance(float depth) { return planes.x / (planes.z - depth * planes.y); }

void main() {
  vec3 n = normalize(world_normal);
  if (dot(n, eye - world) < 0.0) n = -n;
  vec3 to_light = normalize(light_position - world);
  vec4 clip = light_matrix * vec4(world, 1);
  vec3 at = 0.5 * clip.xyz / clip.w + 0.5;
  bool seen = clip.w > 0.0 && all(equal(at, clamp(at, vec3(0), vec3(1))));
  float c = dot(-to_light, spot.xyz);
  float beam = spot_inner > spot.w ? smoothstep(spot.w, spot_inner, c) : step(spot.w, c);
  float nearest = min(texture(shadow_map, at.xy).x, texture(refractor_depths, vec3(at.xy, 0)).x);
  // The bias is a share of the range: depth-buffer values are not even in it.
  bool shaded = to_distance(nearest) < to_distance(at.z) - 0.005 * planes.z;
#ifdef CIE
  vec3 through = seen ? texture(spectral_map, at.xy).rgb : vec3(0);
  vec3 sum = lit(n, to_light, through, beam, shaded);
#else
  float shade = shaded ? 0.0 : 1.0, diffuse = max(0.0, dot(n, to_light));
  vec3 colour = min(1.0, 1.0 / 1.5 + diffuse / 3.0) * reflectance;
  vec3 light = seen ? (shade * 0.25 + 0.75) * colour * beam * spot_colour * 0.7 : vec3(0);
  light += colour * SCENE_AMBIENT;
  vec3 caustic = seen ? texture(spectral_map, at.xy).rgb * diffuse : vec3(0);
  vec3 sum = light + caustic * 3.0;
#endif
  if (texture_info.x >= 0.0)
    sum *= textureLod(surface_texture, vec3(surface_uv * texture_info.yz, texture_info.x), 0.0).rgb;
  radiance = vec4(sum, distance(eye, world));
}
