// The light of an environment on what nothing hides from it; surroundings.glsl comes before.
#ifdef ENVIRONMENT
// rgb irradiance by normal, nodes as scenes/environment/radiance_map.h has them.
layout(std140, binding = BINDING_SOFT_LIGHT) uniform SoftLight { vec4 soft_light[SOFT_ROWS * SOFT_COLUMNS]; };

vec3 soft_irradiance(vec3 n) {
  vec2 angles = sphere_angles(n) / PI;
  float y = angles.y * float(SOFT_ROWS - 1), x = fract(0.5 * angles.x) * float(SOFT_COLUMNS);
  int row = min(int(y), SOFT_ROWS - 2), column = min(int(x), SOFT_COLUMNS - 1);
  int at = row * SOFT_COLUMNS + column, next = row * SOFT_COLUMNS + (column + 1) % SOFT_COLUMNS;
  vec2 part = vec2(x - float(column), y - float(row));
  return environment_scale * mix(mix(soft_light[at], soft_light[next], part.x),
             mix(soft_light[at + SOFT_COLUMNS], soft_light[next + SOFT_COLUMNS], part.x), part.y).rgb;
}
#endif
