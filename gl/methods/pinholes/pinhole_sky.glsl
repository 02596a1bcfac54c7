// What is around as pinholes see it. TURNS_SKY: who includes this has environment_from_world.
uniform sampler2D pinhole_sky;  // W/(m2 sr), by the surroundings' own directions
#ifndef TURNS_SKY
uniform mat3 environment_from_world;
#endif
uniform float sky_side;  // texels of a face

#include "cube_mean.glsl"

vec3 sky_at(vec3 d, float level) { return cube_at(pinhole_sky, environment_from_world * d, level); }

// The level whose texels are so wide, rad.
float sky_level(float wide) { return max(log2(wide * sky_side / CUBE_TEXEL), 0.0); }

// The mean over what is as wide as a and b around r; nothing where none is `wanted`.
vec3 sky_over(vec3 r, vec3 a, vec3 b, bool wanted) {
  return cube_mean(pinhole_sky, CUBE_TEXEL / sky_side, environment_from_world * r, environment_from_world * a,
                   environment_from_world * b, 16.0, wanted);
}
