// Caustics that were computed beforehand, looked up at a place (scenes/volume/caustic_volume.h): VOLUME_GRID,
// VOLUME_OCTAHEDRAL or VOLUME_GEODESIC; VOLUME_PRINTED: as the method was published.
uniform usamplerBuffer volume_cells;
uniform vec3 volume_centre;
uniform mat3 volume_turn[3 * LIGHTS];  // turn of places into a node's light
uniform float volume_weight[3 * LIGHTS];
uniform float volume_strength[LIGHTS];  // irradiance of unit power at the centre
uniform float volume_inner, volume_outer;
uniform float volume_shells;  // shells for a factor e of the radius
uniform float volume_byte;    // what a full byte stands for
uniform int volume_side, volume_row, volume_rows, volume_table;

#ifdef VOLUME_PRINTED
const int VOLUME_WORDS = 1;
#else
const int VOLUME_WORDS = 5;
#endif

uint volume_word(int at) { return texelFetch(volume_cells, at).x; }

int volume_block(int sight) { return sight * volume_row * volume_rows * VOLUME_WORDS; }

// How far p is from the rim, in parts of its own distance: above 1 it is within.
float volume_reach(vec3 p) {
#ifdef VOLUME_GRID
  float size = max(max(abs(p.x), abs(p.y)), abs(p.z));
#else
  float size = length(p);
#endif
  return volume_outer * (1.0 - 1e-6) / max(size, 1e-30);
}

vec2 volume_octahedral(vec3 p) {
  p /= abs(p.x) + abs(p.y) + abs(p.z);
  vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  return 0.5 + 0.5 * (p.z < 0.0 ? folded : p.xy);
}

float volume_shell(vec3 p) { return volume_shells * log(max(length(p) / volume_inner, 1.0)); }

#ifdef VOLUME_GEODESIC
int volume_face(vec3 p) {
  ivec2 at = clamp(ivec2(volume_octahedral(p) * float(volume_table)), ivec2(0), ivec2(volume_table - 1));
  return int(volume_word(volume_block(3 * LIGHTS) + at.y * volume_table + at.x));
}
#endif

#ifdef VOLUME_PRINTED
// The cell that holds p.
int volume_cell(vec3 p) {
#ifdef VOLUME_GRID
  ivec3 at = clamp(ivec3((p / volume_outer + 1.0) * 0.5 * float(volume_side)), ivec3(0), ivec3(volume_side - 1));
  return (at.z * volume_side + at.y) * volume_side + at.x;
#else
  int shell = min(int(volume_shell(p)), volume_rows - 1);
#ifdef VOLUME_OCTAHEDRAL
  ivec2 at = min(ivec2(volume_octahedral(p) * float(volume_side)), ivec2(volume_side - 1));
  return shell * volume_row + at.y * volume_side + at.x;
#else
  return shell * volume_row + volume_face(p);
#endif
#endif
}

// rgb irradiance of unit power on a receiver at p, of a light with that white.
vec3 volume_irradiance(int light, vec3 p, vec3 n, vec3 white) {
  vec3 q = p - volume_centre, sum = vec3(0);
  float facing = max(dot(n, -q) / max(length(q), 1e-30), 0.0);
  q *= min(volume_reach(q), 1.0);
  for (int k = 3 * light; k < 3 * light + 3; k++) {
    if (volume_weight[k] == 0.0) continue;
    sum += volume_weight[k] *
           unpackUnorm4x8(volume_word(volume_block(k) + volume_cell(volume_turn[k] * q))).rgb;
  }
  return white * sum * (volume_byte * facing * volume_strength[light]);
}
#else
// Vector irradiance of X, Y and Z.
mat3 volume_value(int at) {
  vec2 a = unpackHalf2x16(volume_word(at)), b = unpackHalf2x16(volume_word(at + 1)),
       c = unpackHalf2x16(volume_word(at + 2)), d = unpackHalf2x16(volume_word(at + 3)),
       e = unpackHalf2x16(volume_word(at + 4));
  return mat3(a, b, c, d, e.x);
}

// Below and above x, cells' middles being at 0.5, 1.5 ...; z: the share of the second.
vec3 volume_split(float x, int count) {
  float y = clamp(x - 0.5, 0.0, float(count - 1)), low = floor(y);
  return vec3(low, min(low + 1.0, float(count - 1)), y - low);
}

#if defined(VOLUME_GRID)
mat3 volume_flux(int block, vec3 p) {
  vec3 at = (p / volume_outer + 1.0) * 0.5 * float(volume_side);
  vec3 x = volume_split(at.x, volume_side), y = volume_split(at.y, volume_side), z = volume_split(at.z, volume_side);
  mat3 sum = mat3(0);
  for (int i = 0; i < 8; i++) {
    bvec3 second = bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0);
    int cell = (int(second.z ? z.y : z.x) * volume_side + int(second.y ? y.y : y.x)) * volume_side +
               int(second.x ? x.y : x.x);
    float weight = (second.x ? x.z : 1.0 - x.z) * (second.y ? y.z : 1.0 - y.z) * (second.z ? z.z : 1.0 - z.z);
    sum += weight * volume_value(block + VOLUME_WORDS * cell);
  }
  return sum;
}
#else
mat3 volume_flux(int block, vec3 p) {
  vec3 shell = volume_split(volume_shell(p), volume_rows);
  mat3 sum = mat3(0);
#ifdef VOLUME_OCTAHEDRAL
  vec2 at = volume_octahedral(p) * float(volume_side) - 0.5, low = floor(at), part = at - low;
  for (int i = 0; i < 4; i++) {
    ivec2 texel = ivec2(low) + ivec2(i & 1, i >> 1);
    float weight = ((i & 1) != 0 ? part.x : 1.0 - part.x) * ((i & 2) != 0 ? part.y : 1.0 - part.y);
    // one beyond the rim: folded onto it
    ivec2 most = ivec2(volume_side - 1);
    if (texel.x < 0 || texel.x > most.x) texel = ivec2(clamp(texel.x, 0, most.x), most.y - texel.y);
    if (texel.y < 0 || texel.y > most.y) texel = ivec2(most.x - texel.x, clamp(texel.y, 0, most.y));
    int in_row = texel.y * volume_side + texel.x;
#else
  {
    const float weight = 1.0;
    int in_row = volume_face(p);
#endif
    int a = int(shell.x) * volume_row + in_row, b = int(shell.y) * volume_row + in_row;
    sum += weight * (1.0 - shell.z) * volume_value(block + VOLUME_WORDS * a);
    sum += weight * shell.z * volume_value(block + VOLUME_WORDS * b);
  }
  return sum;
}
#endif

// XYZ irradiance of unit power on the side of a receiver at p that n points from.
vec3 volume_irradiance(int light, vec3 p, vec3 n) {
  vec3 q = p - volume_centre;
  float reach = min(volume_reach(q), 1.0);
  mat3 flux = mat3(0);
  for (int k = 3 * light; k < 3 * light + 3; k++) {
    if (volume_weight[k] == 0.0) continue;
    flux += (volume_weight[k] * reach * reach) *
            (transpose(volume_turn[k]) * volume_flux(volume_block(k), volume_turn[k] * (q * reach)));
  }
  // What stands in the direction that most of it comes from.
  float bright = length(flux[1]), far = length(q);
  vec3 towards = -flux[1] / max(bright, 1e-30);
#ifdef RECEIVER_SHADOWS
  if (bright > 0.0 && receiver_between(p, towards, 1e-4 * far, far)) return vec3(0);
#endif
  if (bright > 0.0 && area_light_between(p, towards, 0.0, far, -1)) return vec3(0);
  return max(-(n * flux), vec3(0)) * volume_strength[light];
}
#endif
