// The camera's rays through one refractor alone, a thread a pixel.

// XYZ of what a band shows through the first interface; the share that is mirrored there.
vec3 band_light(int band, out float mirrored) {
  take_band(band_set, band - first_band(refractor));
#ifdef CRYSTALS
  vec3 light = vec3(0);
  float passed = 0.0, reflected = 0.0;
  const float EACH = 2.0 / float(WAVES);
  crystal = crystal_of(refractor);
  for (wave = first_wave; wave < first_wave + WAVES; wave++) {
#ifdef KEEPS_SIGHTS
    uint before = sight_chain;
#endif
    light += EACH * through(front, sight);
    passed += EACH * wave_share;
    reflected += EACH * wave_mirrored;
#ifdef KEEPS_SIGHTS
    weigh_sights(before, EACH * sight_tail);
    sight_tail = vec3(1);
#endif
  }
#ifdef FILMS
  mirrored = reflected;
#else
  mirrored = 1.0 - passed;
#endif
  return light;
#else
  mirrored = face_shares(refractor, front.facet, true, -dot(sight, front.n), bands[band].weight_n.w).x;
  return through(front, sight);
#endif
}

#ifdef GLOW_RAYS
// glow_rays.glsl has its main().
#elif defined(REFINED)
void main() {
  copy_all();
  uint listed = thread_number();
  if (listed >= refine_count) return;
  uint what = refine[listed].y;
  ivec2 at = pixel_of(refine[listed].x);
  look(at);
  int base, count, joined = int(what >> 12 & 15u);
  wanted_level(what, base, count);
  vec3 sum = vec3(0);
  uint wanted = what & 255u;
  while (wanted != 0u) {
    int band = findLSB(wanted), end = min((band + 1) << joined, count);
    for (int i = band << joined; i < end; i++) {
      float mirrored;
      sum += band_light(base + i, mirrored);
    }
    wanted &= wanted - 1u;
  }
  add_to_picture(at, sum);
}
#else
void main() {
  copy_all();
  uint listed = pixel_first + thread_number();
  if (listed >= min(pixel_count, pixel_end)) return;
  look(pixel_of(pixel[listed]));
  int base, count;
  choose_bands(base, count);
#ifdef KEEPS_SIGHTS
  sight_chain = 0u;
#endif
  vec3 sum = vec3(0), mirror = vec3(0);
  for (int i = first_taken(pixel_of(pixel[listed]), count); i < count; i += taken_step(count)) {
    float mirrored;
#ifdef KEEPS_SIGHTS
    uint before = sight_chain;
#endif
    vec3 light = band_light(base + i, mirrored);
#ifdef KEEPS_SIGHTS
    weigh_sights(before, sight_tail);
#endif
    mirror += mirrored * bands[base + i].weight_n.xyz;
    sum += light;
#ifdef REFINES
    shown_by[i] = light;
#endif
  }
  vec3 mirrored = seen_outside(front.p, reflect(sight, front.n), spread_in_mirror(front));
  sum += mirror * (xyz_from_rgb * mirrored);
#ifdef KEEPS_SIGHTS
  sight_pixels[listed * SIGHT_WORDS + 8u] = sight_chain;
  sight_chain = 0u;
  if (sight_waits) note_sight(vec3(1), -1);
  sight_pixels[listed * SIGHT_WORDS + 7u] = sight_chain;
  keep_pixel(listed, sum, mirror);
#else
  write_pixel(pixel[listed], base, count, sum);
#endif
}
#endif
