// Snell and Fresnel; the float twins of spectral/optics.c. eta = n_i / n_t.

// Unpolarised reflectance; 1 at and beyond the critical angle.
float fresnel(float cos_i, float eta) {
  cos_i = clamp(cos_i, 0.0, 1.0);
  if (eta == 1.0) return 0.0;
  float sin2_t = eta * eta * (1.0 - cos_i * cos_i);
  if (sin2_t >= 1.0) return 1.0;
  float cos_t = sqrt(1.0 - sin2_t);
  float s = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  float p = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return cos_i + cos_t == 0.0 ? 1.0 : 0.5 * (s * s + p * p);
}

// d travels; n is unit on the side that d comes from. False at total internal reflection.
bool refract_direction(vec3 d, vec3 n, float eta, out vec3 t) {
  float cos_i = clamp(-dot(d, n), 0.0, 1.0);
  float sin2_t = eta * eta * (1.0 - cos_i * cos_i);
  t = d;
  if (sin2_t >= 1.0) return false;
  t = normalize(eta * d + (eta * cos_i - sqrt(1.0 - sin2_t)) * n);
  return true;
}
