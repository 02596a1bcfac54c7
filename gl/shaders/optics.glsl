// Snell and Fresnel; the float twins of spectral/optics.c, and as careful. eta = n_i / n_t.

// Square of the cosine of refraction, (1 - eta^2) + (eta cos_i)^2 = 1 - (eta sin_i)^2, by the form
// whose terms are smaller; 0 or less at and beyond the critical angle.
float cos2_refracted(float cos_i, float eta) {
  float along = eta * cos_i;
  return eta <= 1.0 || along < 1.0 ? (1.0 - eta) * (1.0 + eta) + along * along
                                   : 1.0 - eta * eta * ((1.0 - cos_i) * (1.0 + cos_i));
}

// Unpolarised reflectance; 1 at and beyond the critical angle. The differences of the amplitudes
// r_s = (eta c - t) / (eta c + t) and r_p = (eta t - c) / (eta t + c), which cancel near eta = 1, are
// multiplied out by Snell's law.
float fresnel(float cos_i, float eta) {
  float c = clamp(cos_i, 0.0, 1.0), t2 = cos2_refracted(c, eta);
  if (eta == 1.0) return 0.0;
  if (t2 <= 0.0 || c == 0.0) return 1.0;
  float t = sqrt(min(t2, 1.0)), s = eta * c + t, p = eta * t + c;
  float contrast = (eta - 1.0) * (eta + 1.0);
  float r_s = contrast / (s * s);
  float r_p = contrast / (p * p) * (c * c * (1.0 + eta * eta) - eta * eta);
  return min(0.5 * (r_s * r_s + r_p * r_p), 1.0);
}

#ifdef MIRRORS
// Unpolarised reflectance of a metal of complex index n + i k, met from air.
float fresnel_conductor(float cos_i, float n, float k) {
  float c = clamp(cos_i, 0.0, 1.0), s2 = (1.0 - c) * (1.0 + c), twice = 2.0 * n * k;
  float below = (n - k) * (n + k) - s2, size = length(vec2(below, twice));
  // a + i b is the root of below + i twice: the smaller of both by their product, n k
  float larger = sqrt(0.5 * (size + abs(below))), smaller = 0.5 * twice / max(larger, 1e-20);
  vec2 root = below < 0.0 ? vec2(smaller, larger) : vec2(larger, smaller);
  float t1 = size + c * c, t2 = 2.0 * c * root.x;
  float s = (t1 - t2) / (t1 + t2), q = c * c * size + s2 * s2, p = (q - t2 * s2) / (q + t2 * s2);
  return c == 0.0 ? 1.0 : clamp(0.5 * s * (1.0 + p), 0.0, 1.0);
}
#endif

// d travels; n is unit on the side that d comes from. False at total internal reflection.
bool refract_direction(vec3 d, vec3 n, float eta, out vec3 t) {
  float cos_i = clamp(-dot(d, n), 0.0, 1.0), cos2_t = eta == 1.0 ? 1.0 : cos2_refracted(cos_i, eta);
  t = d;
  if (cos2_t <= 0.0) return false;
  if (eta == 1.0) return true;
  // eta cos_i - cos_t, without its cancellation
  float bend = (eta - 1.0) * ((eta + 1.0) / (eta * cos_i + sqrt(min(cos2_t, 1.0))));
  t = normalize(eta * d + bend * n);
  return true;
}
