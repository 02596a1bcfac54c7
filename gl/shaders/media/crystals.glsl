// CRYSTALS: the two waves of crystals, and their faces. UNIAXIAL: of two indices all of them, along z the other one. A wave's vector k, which is its normal times its index, keeps its
// part along a face; light goes along the ray, at right angles to the surface of all such vectors [BornWolf1999, 15].
// Faces reflect by Fresnel's formulas for the wave's own index, field by field: shares are right to the first order of
// the difference of indices, directions are exact. Who includes this gives
// crystal_of(r), of the band or wavelength that is followed.

struct Crystal {
  vec3 one, other;         // optic axes
  float mean, difference;  // half the sum of the inverse squares of the outer indices, and half that of x's less z's
  vec3 x, z;
  vec3 inverse;  // squares of the indices along x, y and z
};

Crystal crystal_of(int r);

// row: as camera_bands.h has it.
Crystal make_crystal(vec3 z, vec3 x, vec4 row) {
  float a = row.x + row.y, c = row.x - row.y;
  return Crystal(row.w * z + row.z * x, row.w * z - row.z * x, row.x, row.y, x, z,
                 vec3(a, a * row.w * row.w + c * row.z * row.z, c));
}

// Glass has no axes.
bool is_crystal(Crystal c) { return c.z != vec3(0); }

#ifdef UNIAXIAL
// The wave that leaves a face along u, of so much of its vector along the face; false: it does not travel. Wave 0 is
// the ordinary one. The vectors of each end on an ellipsoid about z.
bool wave_from(Crystal c, int wave, vec3 along, vec3 u, out vec3 k, out vec3 ray) {
  float all = wave == 0 ? c.inverse.x : c.inverse.z, on_z = c.inverse.x - all, u_z = dot(u, c.z), along_z = dot(along, c.z);
  float squared = all + on_z * u_z * u_z, half_linear = on_z * u_z * along_z;
  float left = half_linear * half_linear - squared * (all * dot(along, along) + on_z * along_z * along_z - 1.0);
  k = along + (sqrt(max(left, 0.0)) - half_linear) / squared * u;
  ray = normalize(all * k + on_z * dot(k, c.z) * c.z);
  return left > 0.0 && dot(ray, u) > 1e-4;
}
#else
// 1 for vectors of that wave: 0 or 1, of two indices the ordinary and the extraordinary one. slope: the way in which it
// grows, along the ray.
float wave_surface(Crystal c, int wave, vec3 k, out vec3 slope) {
  float a = dot(k, c.one), b = dot(k, c.other), side = wave == 0 ? c.difference : -c.difference;
  vec3 p = k - a * c.one, q = k - b * c.other;
  float across = length(p), other = length(q);
  float ratio = min(across, other) > 1e-5 ? other / across : 1.0;
  slope = 2.0 * c.mean * k + c.difference * (b * c.one + a * c.other) + side * (ratio * p + q / ratio);
  return c.mean * dot(k, k) + c.difference * a * b + side * across * other;
}

// The wave that leaves a face along u, of so much of its vector along the face; false: it does not travel.
bool wave_from(Crystal c, int wave, vec3 along, vec3 u, out vec3 k, out vec3 ray) {
  float q = sqrt(max(1.0 / (c.mean - abs(c.difference)) - dot(along, along), 1e-4)), value;
  vec3 slope;
  for (int turn = 0; turn < 4; turn++) {  // by Newton's method from outside
    value = wave_surface(c, wave, along + q * u, slope);
    q -= (value - 1.0) / max(dot(slope, u), 1e-3);
  }
  k = along + q * u;
  value = wave_surface(c, wave, k, slope);
  ray = normalize(slope);
  return dot(ray, u) > 1e-4 && abs(value - 1.0) < 1e-3;
}
#endif

vec3 across_of(vec3 v) { return normalize(cross(v, abs(v.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0))); }

// The wave's electric displacement.
vec3 displacement(Crystal c, int wave, vec3 k) {
  vec3 s = normalize(k), u = cross(s, c.one), v = cross(s, c.other);
  float across = length(u), other = length(v);
  if (max(across, other) < 1e-5) return wave == 0 ? across_of(s) : cross(s, across_of(s));
  u = across < 1e-5 ? v / other : u / across;
  v = other < 1e-5 ? u : v / other;
  vec3 sum = u + v;
  vec3 d = dot(sum, sum) > 2.0 ? normalize(sum) : normalize(cross(s, u - v));
  return wave == 0 ? d : cross(s, d);
}

vec3 across_incidence(vec3 k, vec3 n) {
  vec3 across = cross(k, n);
  return dot(across, across) > 1e-10 ? normalize(across) : across_of(n);
}

// The field's parts across the plane of incidence, and in it; of unpolarised light in glass, as much of both.
vec2 field_parts(Crystal c, int wave, vec3 k, vec3 n) {
  vec3 across = across_incidence(k, n), d = displacement(c, wave, k);
  return is_crystal(c) ? vec2(dot(d, across), dot(d, cross(normalize(k), across))) : vec2(sqrt(0.5));
}

// What a face reflects of the field across the plane of incidence, of that in it, and of both by their phases.
vec3 face_reflects(float cos_i, float n_i, float n_t) {
  float c = clamp(cos_i, 0.0, 1.0), t2 = cos2_refracted(c, n_i / n_t), t = sqrt(min(abs(t2), 1e6));
  if (t2 > 0.0) {
    float s = (n_i * c - n_t * t) / (n_i * c + n_t * t), p = (n_t * c - n_i * t) / (n_t * c + n_i * t);
    return vec3(s * s, p * p, s * p);
  }
  float turn = dot(normalize(vec2(n_i * c, n_t * t + 1e-20)), normalize(vec2(n_t * c, n_i * t + 1e-20)));
  return vec3(1, 1, 2.0 * turn * turn - 1.0);
}

vec2 path_place;  // whole numbers: neighbours' choices fill 0 to 1 evenly [Roberts2018]

// The choice of a path where it is turned back the n-th time.
float wave_choice(int n) {
  vec2 by = (n & 1) == 0 ? vec2(0.7548776662, 0.5698402910) : vec2(0.4142135624, 0.7320508076);
  return fract(dot(path_place, (n & 2) == 0 ? by : by.yx) + 0.6180339887 * float(n));
}

// A wave that a face turns back from its side of the normal n. One of the two that it becomes goes on, each as often
// as its share of the light is.
void turn_wave(Crystal c, vec3 reflects, vec3 n, float choice, inout int wave, inout vec3 k, inout vec3 ray) {
  vec3 along = k - dot(k, n) * n, k_0, ray_0, k_1, ray_1;
  vec2 from = field_parts(c, wave, k, n);
  bool first = wave_from(c, 0, along, -n, k_0, ray_0), second = wave_from(c, 1, along, -n, k_1, ray_1);
  vec2 to = field_parts(c, 0, k_0, n);
  float all = dot(reflects.xy, from * from);
  float share = dot(reflects.xy * from * from, to * to) + 2.0 * reflects.z * from.x * from.y * to.x * to.y;
  bool goes_first = first && (!second || (is_crystal(c) ? choice * all < share : wave == 0));
  vec3 back = reflect(k, n);
  wave = goes_first ? 0 : 1;
  k = goes_first ? k_0 : second ? k_1 : back;
  ray = goes_first ? ray_0 : second ? ray_1 : normalize(back);
}

#ifdef FILMS
// What a film on refractor r, such a crystal, makes of a wave of index n: between its tables for two of the indices.
vec2 wave_film_shares(Crystal c, int r, int film, bool outside, float cos_i, float n) {
  vec2 shares = film_shares(film, outside, cos_i, n);
  if (!is_crystal(c)) return shares;
  vec4 of = texelFetch(film_texels, r);
  float here = inversesqrt(c.inverse.y), other = inversesqrt(of.z > 0.0 ? c.inverse.z : c.inverse.x);
  float part = other == here ? 0.0 : clamp((n - here) / (other - here), -1.0, 1.0);
  // Beyond the two what is mirrored may come out below 0.
  return max(mix(shares, film_shares(film + int(of.y), outside, cos_i, n), part), 0.0);
}
#endif

#ifdef PLEOCHROIC
// Shares of the attenuations along x, y and z in that of a wave, by a metre of its ray.
vec3 axis_shares(Crystal c, int wave, vec3 k) {
#ifdef UNIAXIAL
  float k2 = dot(k, k), k_z = dot(k, c.z), on_z = wave == 0 ? 0.0 : 1.0 - k_z * k_z / k2;
  vec2 field2 = c.inverse.xz * c.inverse.xz * vec2(1.0 - on_z, on_z);
  vec2 shares = sqrt(k2 / (field2.x + field2.y)) * field2 * inversesqrt(c.inverse.xz);
  return vec3(shares.x, 0, shares.y);
#else
  vec3 d = displacement(c, wave, k), field = c.inverse * vec3(dot(d, c.x), dot(d, cross(c.z, c.x)), dot(d, c.z));
  return length(k) / length(field) * field * field * inversesqrt(c.inverse);
#endif
}
#endif
