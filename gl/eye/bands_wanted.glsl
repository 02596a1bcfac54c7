// Which bands of wavelengths a pixel takes: the fewer, the less the spectrum is spread out in it. Level 0
// has a band for each wavelength; each further level joins those of the one before by twos. The levels of a
// set stand one after another in `bands`.

// The index beyond the first interface over that before it, at both ends of the spectrum. least: what these should be
// apart, over the index, for the first interface to tell how far the spectrum is spread out. On multi-refractor paths
// that may be done by what is met later.
vec2 ends_n(int first, int last, out float least) {
  least = 0.0;
#ifdef WALK
  uint beyond = eye_inside ^ 1u << uint(refractor);
  int before_r = medium_of(eye_inside), beyond_r = medium_of(beyond);
  vec2 before = vec2(1), n = vec2(1);
  for (int r = 0; r < REFRACTORS; r++) {
    int at = first_band(r);
    vec2 own = vec2(bands[at].weight_n.w, bands[at + last - first].weight_n.w);
    before = r == before_r ? own : before;
    n = r == beyond_r ? own : n;
    least = max(least, 0.6 * abs(own.x - own.y) / own.y);
  }
  return n / before;
#else
  return vec2(bands[first].weight_n.w, bands[last].weight_n.w);
#endif
}

#ifdef SPHERES
// The two ends of the spectrum leave a sphere where they first meet it from inside: how far apart, in
// pixels, lies what they show then; 1e9 where that is on different receivers.
float sphere_spread(Hit front, vec3 d, vec2 ends) {
  vec3 at[2];
  int what[2];
  for (int k = 0; k < 2; k++) {
    float n = ends[k];
    vec3 interface_at = front.p, outer;
    if (dot(d, front.n) < 0.0) {
      vec3 inner, interface_n;
      vec4 s = refractors[refractor].sphere;
      refract_direction(d, front.n, 1.0 / n, inner);
      interface_n = normalize(front.n - 2.0 * dot(front.n, inner) * inner);
      refract_direction(inner, -interface_n, n, outer);
      interface_at = s.xyz + s.w * interface_n;
    } else {  // the eye is in it
      refract_direction(d, -front.n, 1.0 / n, outer);
    }
    at[k] = interface_at + scene_size * outer;
    what[k] = 0;
    float t;
    what[k] = receiver_hit(interface_at, outer, -touch * refractor_bounds.w, 1e30, t);
    if (what[k] >= 0) what[k] = receiver_part(what[k]);
    at[k] = interface_at + min(t, scene_size) * outer;
  }
  return what[0] != what[1] ? 1e9 : distance(at[0], at[1]) / (pixel_angle * distance(eye, at[0]));
}
#endif

// As many bands as the spread needs, one for every pixel and a half of it. For meshes it is
// estimated from the first interface alone; in facets inner reflections spread light further than
// the first exit shows, so a convex solid gets a band for each wavelength.
float wanted_bands(Hit front, vec3 d, int first, int last) {
  int model = refractors[refractor].info.x;
#ifdef MIRRORS
  if (is_mirror(refractor)) return 1e9;
#endif
  if (model == MODEL_CONVEX) return 1e9;
  float least;
  vec2 ends = ends_n(first, last, least);
  float apart = abs(ends.x - ends.y) / ends.y;
  if (apart < least) return 1e9;
#ifdef SPHERES
  if (model == MODEL_SPHERE) return sphere_spread(front, d, ends) / 1.5;
#endif
  float c = clamp(-dot(d, front.n), 0.05, 1.0);
  float turn = apart * (0.2 + sqrt(1.0 - c * c) / c);
  return turn * scene_size / (4.0 * front.t * pixel_angle) / 1.5;
}

// The first band of the next level, where each of `count` is two of this one's. Halved by a shift: of a signed division
// here LLVM 21 overwrites a constant where it has AVX-512, and a frame never ends.
void coarsen(bool coarser, inout int base, inout int count) {
  base += coarser ? count : 0;
  count = coarser ? (count + 1) >> 1 : count;
}

#ifdef REFINED
// Where the bands that a list entry wants begin, and how many there are on its level.
void wanted_level(uint what, out int base, out int count) {
  int level = int(what >> 8 & 15u);
  base = first_band(refractor);
  count = counts.wavelengths;
  for (int k = 0; k < counts.band_levels - 1; k++) coarsen(k < level, base, count);
}
#else
#ifdef REFINES
// Share of a pixel's light that a joined band may show wrong.
const float MOST_WRONG = 0.05;

int level = 0, joined = 0;
vec3 shown_by[COARSE_BANDS];
#endif

#ifdef COARSE_EYE
// In pictures of what moves: half as many, but of facets, which show bands apart; of mirrors two, and of what is seen
// from inside one.
float coarse_wanted(float wanted) {
#ifdef WALK
  if ((eye_inside >> uint(refractor) & 1u) != 0u) return 1.0;
#endif
#ifdef MIRRORS
  if (is_mirror(refractor)) return 2.0;
#endif
  return refractors[refractor].info.x == MODEL_CONVEX ? wanted : 0.5 * wanted;
}
#endif

// Those that the pixel takes: `count` from `base` on, of the coarsest level that has as many as are
// wanted, or of level 0, and at most counts.eye_bands. REFINES: at most COARSE_BANDS, for which they are joined further.
void choose_bands(out int base, out int count) {
  base = first_band(refractor);
  count = counts.wavelengths;
  float wanted = wanted_bands(front, sight, base, base + counts.wavelengths - 1);
#ifdef COARSE_EYE
  wanted = coarse_wanted(wanted);
#endif
#ifdef BAND_PARTS
  wanted = max(wanted, 3.0);  // twenty-four parts have the colour of two stones
#endif
  for (int k = 0; k < counts.band_levels - 1; k++) {
    bool coarser = float((count + 1) >> 1) >= wanted;
    coarsen(coarser, base, count);
#ifdef REFINES
    level += coarser ? 1 : 0;
#endif
  }
#ifdef REFINES
  for (int k = 0; k < counts.band_levels - 1; k++) {
    bool coarser = count > COARSE_BANDS;
    coarsen(coarser, base, count);
    joined += coarser ? 1 : 0;
  }
#else
  for (int k = 0; k < counts.band_levels - 1; k++) coarsen(count > counts.eye_bands, base, count);
#endif
}

// INTERLEAVES: the samples of a pixel share its bands, where these are more than two. Each sample takes
// every second band, its neighbours those between, of whose light each band has a share (camera_bands.h).
#ifdef INTERLEAVES
int taken_step(int count) { return count > 2 ? 2 : 1; }
int first_taken(ivec2 at, int count) {
  ivec2 place = SAMPLE_AT(at);
  return count > 2 ? (place.x ^ place.y) & 1 : 0;
}
#else
int taken_step(int count) { return 1; }
int first_taken(ivec2 at, int count) { return 0; }
#endif
#endif
