// Snell and Fresnel; the float versions of spectral/optics.c, and as careful. eta = n_i / n_t.

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
  // squares of root -+ c and of c root -+ s2, which cancel nowhere
  vec2 less = root - vec2(c, 0), more = root + vec2(c, 0);
  vec2 less_p = c * root - vec2(s2, 0), more_p = c * root + vec2(s2, 0);
  float s = dot(less, less) / dot(more, more), p = dot(less_p, less_p) / dot(more_p, more_p);
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

// An interpolated normal may send light to the wrong side of its face, of unit normal `face_n`: it
// is bent until it runs just along the side wanted.
vec3 keep_side(vec3 face_n, vec3 d) {
  float along = dot(d, face_n);
  return along > 0.0 ? d : normalize(d + (1e-3 - along) * face_n);
}

#ifdef ROUGH
// GGX's facets, as spectral/microfacets.h has them: a is their roughness along x and y; directions away from
// the surface, z its normal.

float facets_density(vec2 a, vec3 h) {
  vec2 s = h.xy / a;
  float square = dot(s, s) + h.z * h.z;
  return h.z > 0.0 ? 1.0 / (PI * a.x * a.y * square * square) : 0.0;
}

float facets_hidden(vec2 a, vec3 w) {
  vec2 s = a * w.xy / w.z;
  return 0.5 * (sqrt(1.0 + dot(s, s)) - 1.0);
}

float facets_visible(vec2 a, vec3 w) { return w.z > 0.0 ? 1.0 / (1.0 + facets_hidden(a, w)) : 0.0; }

float facets_from_both(vec2 a, vec3 wi, vec3 wo) {
  return min(wi.z, wo.z) > 0.0 ? 1.0 / (1.0 + facets_hidden(a, wi) + facets_hidden(a, wo)) : 0.0;
}

// Radiance by irradiance, 1/sr, of facets that reflect all.
float facets_reflect(vec2 a, vec3 wi, vec3 wo) {
  float both = facets_from_both(a, wi, wo);
  return both > 0.0 ? facets_density(a, normalize(wi + wo)) * both / (4.0 * wi.z * wo.z) : 0.0;
}

// The density of what facets_sample draws, 1/sr.
float facets_pdf(vec2 a, vec3 wo, vec3 wi) {
  return facets_density(a, normalize(wi + wo)) * facets_visible(a, wo) / (4.0 * wo.z);
}

// A facet that wo sees, and where it reflects wo to; returns the share that no other facet takes.
float facets_sample(vec2 a, vec3 wo, vec2 u, out vec3 h, out vec3 wi) {
  vec3 v = normalize(vec3(a * wo.xy, wo.z));
  float across = length(v.xy), radius = sqrt(u.x), turn = 2.0 * PI * u.y;
  vec3 t = across > 0.0 ? vec3(-v.y, v.x, 0.0) / across : vec3(1, 0, 0), b = cross(v, t);
  float x = radius * cos(turn), share = 0.5 * (1.0 + v.z);
  float y = (1.0 - share) * sqrt(max(1.0 - x * x, 0.0)) + share * radius * sin(turn);
  vec3 top = x * t + y * b + sqrt(max(1.0 - x * x - y * y, 0.0)) * v;
  h = normalize(vec3(a * top.xy, max(top.z, 1e-6)));
  wi = reflect(-wo, h);
  float seen = facets_visible(a, wo);
  return seen > 0.0 ? facets_from_both(a, wi, wo) / seen : 0.0;
}
#endif
