// What a cube of surroundings with levels shows, and its mean over a range of directions. The cube lies in one plain
// texture: each face with a border of its neighbours' texels, the six faces of a level side by side, level 0 below,
// all others above it (gl/scene/gpu_environment.c). A driver's own seamless cubes are not used: in Mesa 22's llvmpipe
// what a thread finds in one changes in its last bits with what the threads beside it look up.
const float CUBE_TEXEL = 1.4472025;  // rad, of a face of one texel: the root of its solid angle

float cube_side(sampler2D cube) { return float((2 * (textureSize(cube, 0).y - 4) + 2) / 3); }

// face: its number and the place in it, 0 to 1.
vec3 face_at(sampler2D cube, float side, vec3 face, float level) {
  float here = side * exp2(-level);
  vec2 first = level > 0.0 ? vec2(6.0 * (side - 2.0 * here + 2.0 * (level - 1.0)), side + 2.0) : vec2(0);
  vec2 at = first + vec2(face.x * (here + 2.0), 0) + 1.0 + face.yz * here;
  return textureLod(cube, at / vec2(textureSize(cube, 0)), 0.0).rgb;
}

vec3 cube_at(sampler2D cube, vec3 d, float level) {
  vec3 m = abs(d);
  bool x = m.x >= m.y && m.x >= m.z, y = !x && m.y >= m.z;
  float major = x ? d.x : y ? d.y : d.z, sense = major < 0.0 ? -1.0 : 1.0;
  vec2 place = x ? vec2(-sense * d.z, -d.y) : y ? vec2(d.x, sense * d.z) : vec2(sense * d.x, -d.y);
  vec3 face = vec3((x ? 0.0 : y ? 2.0 : 4.0) + (major < 0.0 ? 1.0 : 0.0), 0.5 * place / max(abs(major), 1e-30) + 0.5);
  float side = cube_side(cube), low = floor(min(level, log2(side)));
  vec3 light = face_at(cube, side, face, low);
  return level > low ? mix(light, face_at(cube, side, face, min(low + 1.0, log2(side))), level - low) : light;
}

// As wide as a and b around r, none of them of a length to count on: taps along the longer, at the most
// `most` of them, in the level whose texels are as wide as the shorter; texel: that of level 0, rad. None
// where nothing is `wanted`.
vec3 cube_mean(sampler2D cube, float texel, vec3 r, vec3 a, vec3 b, float most, bool wanted) {
  bool first = dot(a, a) > dot(b, b);
  vec3 longer = first ? a : b, shorter = first ? b : a;
  float wide = length(longer);
  float narrow = max(length(shorter), wide / most);
  float level = max(log2(max(narrow, 1e-9) / texel), 0.0);
  float taps = clamp(ceil(wide / max(narrow, texel) - 1e-3), 1.0, most), tap = 1.0 / taps;
  float k = wanted ? 0.5 * tap : 2.0;
  vec3 sum = vec3(0);
  while (k < 1.0) {
    sum += cube_at(cube, r + longer * (k - 0.5), level);
    k += tap;
  }
  return sum * tap;
}
