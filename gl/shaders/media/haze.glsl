// Haze: what it leaves of light on its way, and how it turns it. The air's fills a box; around an eye that is
// in water its own is all around.
const float HAZE_FAR = 1e9;  // beyond every box, m
uniform vec3 haze_low, haze_high;  // of the air's, m
uniform vec3 haze_air;             // scattering and extinction, 1/m, and the mean cosine
// Of the medium that the eye is in, of red, green and blue: scattering and extinction, 1/m; the mean cosine.
uniform vec3 haze_scatters, haze_takes;
uniform float haze_g;

// Metres of the part [from, to] of the way o + t d in the air's haze; where it begins.
float haze_way(vec3 o, vec3 d, float from, float to, out float first) {
  vec3 slope = 1.0 / mix(d, vec3(1e-20), equal(d, vec3(0)));
  vec3 a = (haze_low - o) * slope, b = (haze_high - o) * slope;
  vec3 near = min(a, b), far = max(a, b);
  first = max(max(near.x, near.y), max(near.z, from));
  return max(min(min(far.x, far.y), min(far.z, to)) - first, 0.0);
}

float haze_left(vec3 o, vec3 d, float from, float to) {
  float first;
  return exp(-haze_air.y * haze_way(o, d, from, to, first));
}

// A share a steradian, where light turns by the angle of that cosine [HenyeyGreenstein1941].
float haze_phase(float g, float cosine) {
  float square = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (4.0 * PI * square * sqrt(square));
}
