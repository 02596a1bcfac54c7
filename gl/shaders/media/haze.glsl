// Haze: what it leaves of light along a path, and how it turns it. The air's fills a box; around a camera that is in water its own is all around.
const float HAZE_FAR = 1e9;  // beyond every box, m
uniform vec3 haze_low, haze_high;  // box of the air's medium, m
uniform float haze_air_g;          // mean cosine
// The medium that the camera is in, which may be the air.
uniform float haze_g;
// By bands of the spectrum: what the air takes, what it scatters, and what the medium around the camera takes, 1/m;
// rgb of each light of unit power in them, and last of the scene's illuminant.
uniform vec4 haze_bands[HAZE_BANDS];
uniform vec3 haze_white[(LIGHTS + 1) * HAZE_BANDS];

// Metres of the part [from, to] of the ray o + t d in the air's medium; where it begins.
float haze_way(vec3 o, vec3 d, float from, float to, out float first) {
  vec3 slope = 1.0 / mix(d, vec3(1e-20), equal(d, vec3(0)));
  vec3 a = (haze_low - o) * slope, b = (haze_high - o) * slope;
  vec3 near = min(a, b), far = max(a, b);
  first = max(max(near.x, near.y), max(near.z, from));
  return max(min(min(far.x, far.y), min(far.z, to)) - first, 0.0);
}

// The light of one wavelength that is left, of which a medium takes so much a metre.
float haze_left(vec3 o, vec3 d, float from, float to, float per_m) {
  float first;
  return exp(-per_m * haze_way(o, d, from, to, first));
}

// What so many metres of the air's haze leave of a light of unit power, rgb; and of that what is scattered there a metre.
vec3 haze_light(int light, float metres) {
  vec3 sum = vec3(0);
  for (int k = 0; k < HAZE_BANDS; k++) sum += haze_white[light * HAZE_BANDS + k] * exp(-metres * haze_bands[k].x);
  return sum;
}

vec3 haze_scattered(int light, float metres) {
  vec3 sum = vec3(0);
  for (int k = 0; k < HAZE_BANDS; k++)
    sum += haze_white[light * HAZE_BANDS + k] * (haze_bands[k].y * exp(-metres * haze_bands[k].x));
  return sum;
}

// What is left of white light that is seen through so many metres, of each of red, green and blue: of the medium around the camera, and of the air.
vec3 haze_tint(float metres, bool of_eye) {
  vec3 left = vec3(0), all = vec3(0);
  for (int k = 0; k < HAZE_BANDS; k++) {
    vec3 white = haze_white[LIGHTS * HAZE_BANDS + k];
    left += white * exp(-metres * (of_eye ? haze_bands[k].z : haze_bands[k].x));
    all += white;
  }
  return max(left, vec3(0)) / max(all, vec3(1e-9));
}

vec3 haze_eye_tint(float metres) { return haze_tint(metres, true); }

vec3 haze_air_tint(float metres) { return haze_tint(metres, false); }

// A share a steradian, where light turns by the angle of that cosine [HenyeyGreenstein1941].
float haze_phase(float g, float cosine) {
  float square = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (4.0 * PI * square * sqrt(square));
}
