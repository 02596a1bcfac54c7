// Rays to a refractor that glows: what of each band makes it glow is added to its cells; or XYZ of what it sends back along
// each ray. First what comes along each ray is asked.

layout(std430, binding = BINDING_GLOW) buffer Glow {
  vec4 glow[];  // two a ray: where it begins, and 0: light from all around, 1: from a light there, 2: from one far off; its
                // direction; then one a ray and wavelength: its photons, were all of them absorbed; or what it sends back, and
                // whether there is a refractor, or, asked first, what comes along it
};
uniform uint glow_rays;

// Whether the ray meets the refractor first, from outside.
bool meets_refractor() {
  refractor = glow_refractor;
  band_set = 0;
  sight_spread = no_spread();
#ifdef WALK
  start = path_from(eye, sight);
  first.hit.t = 1e30;
  bool met = next_interface(start, first);
  front = first.hit;
#else
  front.t = 1e30;
  bool met = exact_front(eye, sight, front);
#endif
  return met && front.refractor == glow_refractor && dot(sight, front.n) < 0.0;
}

// What comes along the ray in the band that is taken: by its white, or of a light whether it does.
float light_of_ray(float kind) {
  float t_min = -touch * refractor_bounds.w, t_max = kind == 1.0 ? front.t * (1.0 - 1e-5) : 1e30, t;
  Sighting at;
  bool met = receiver_seen(front.p, -sight, t_min, t_max, t, at);
  if (kind > 0.0) return met ? 0.0 : 1.0;
#ifdef AREA_LIGHTS
  vec3 lamp;  // has rays of its own
  if (area_light_seen(front.p, -sight, t_min, t, lamp)) return 0.0;
#endif
  vec3 rgb = surroundings(-sight);
  if (met) {
    Shading s = shade(at.p, at.n, at.surface, at.uv, at.side);
    rgb = s.direct + s.caustic + s.fill;
  }
  return (colour_from_rgb * rgb).y;
}

void main() {
  copy_all();
  uint listed = thread_number(), count = uint(counts.wavelengths), ray = listed / count;
  if (ray >= glow_rays) return;
  vec4 from = glow[2u * ray];
  own_eye = from.xyz;
  sight = glow[2u * ray + 1u].xyz;
  glow_emitted = vec3(0);
  glow_shift = fract(0.6180339887 * float(listed));
#ifdef CRYSTALS
  path_place = vec2(ray & 1023u, ray >> 10);
#endif
  bool met = meets_refractor();
  int band = first_band(glow_refractor) + int(listed % count);
  take_band(0, int(listed % count));
  float mirrored;
  uint place = 2u * glow_rays + listed;
  if (glow_unit < 0.0) {
    glow[place].w = met ? light_of_ray(from.w) : 0.0;
    return;
  }
  glow_arrives = glow[place].x * glow_unit;
  if (met) {
#ifdef WALK
#ifdef CRYSTALS
    glow_arrives *= 0.5;
#endif
    vec3 light = band_light(band, false, false, mirrored);
#else
    vec3 light = band_light(band, mirrored);
#endif
  }
#if defined(WALK) && defined(CRYSTALS)
  glow_emitted *= 0.5;
#endif
  if (glow_unit == 0.0) glow[place] = vec4(glow_emitted, met ? 1.0 : 0.0);
}
