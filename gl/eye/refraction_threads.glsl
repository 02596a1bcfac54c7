// The camera's rays on multi-refractor paths, by PIXEL_THREADS threads a pixel: so each band's are followed as far
// however many bands there are.

// Where a pixel has one thread that has what is its own: all of a group's would not fit.
#if PIXEL_THREADS == 1
#define JOIN
#define SHARED
#define OF_PIXELS(n) (n)
#define OF_PIXEL 0
#else
#define JOIN barrier();
#define SHARED shared
#define OF_PIXELS(n) (PIXELS * (n))
#define OF_PIXEL place
#endif

// llvmpipe also runs what no lane wants: of one band both branches are followed as one path's.
#ifdef COARSE_EYE
bool goes_both_ways(int count) { return count == 1; }
#else
bool goes_both_ways(int count) { return false; }
#endif

const int PIXELS = int(gl_WorkGroupSize.x) / PIXEL_THREADS;

SHARED vec3 path_sum[OF_PIXELS(PIXEL_THREADS)];

#ifdef HIERARCHY
// A search is dear: a pixel's first thread finds out for all what its ray meets first. The first threads
// of all pixels come first, then the second ones: where few bands are wanted, whole lanes are done early.
int place = int(gl_LocalInvocationID.x) % PIXELS, pixel_thread = int(gl_LocalInvocationID.x) / PIXELS;

SHARED ivec4 task[OF_PIXELS(1)];  // refractor, first band, how many, and whether something is met
SHARED Interface task_first[OF_PIXELS(1)];

void give_task(int base, int count) {
  task[OF_PIXEL] = ivec4(refractor, base, count, found ? 1 : 0);
  task_first[OF_PIXEL] = first;
}

void take_task(ivec2 at, out int base, out int count) {
  begin_path(at);
  refractor = task[OF_PIXEL].x;
  base = task[OF_PIXEL].y;
  band_set = base / counts.bands - refractor * BAND_SETS;
  count = task[OF_PIXEL].z;
  found = task[OF_PIXEL].w != 0;
  first = task_first[OF_PIXEL];
  front = first.hit;
}
#else
// Short loops are dear where what they change is kept in memory, as Mesa 22's llvmpipe does with what is
// written before a barrier and read behind it: each thread looks for itself. Neighbouring lanes have a
// pixel's bands, which take the same paths for longer than its neighbours do.
int place = int(gl_LocalInvocationID.x) / PIXEL_THREADS;
int pixel_thread = int(gl_LocalInvocationID.x) % PIXEL_THREADS;
#endif

// XYZ of what a band shows through the first interface, or off a mirror; or in_mirror: of what it shows
// reflected by an interface, by unit share; mirrored: the share that is. both: of all that it shows, and nothing is mirrored.
vec3 path_light(bool in_mirror, bool both, out float mirrored) {
#ifdef HAZE_BEYOND
  begin_haze(eye, sight, eye_inside == 0u ? first.hit.t : 0.0);
  start.haze_m = haze_begun;
#endif
  PathState w = start, reflected = start;
#ifdef MIRRORS
  bool off_mirror = is_mirror(first.hit.refractor);
  PathState off = start;
  if (off_mirror) reflect_off(off, first);
#else
  const bool off_mirror = false;
#endif
  float absorbed;
  if (off_mirror || !split(w, first, reflected, absorbed)) reflected.share = 0.0;
#ifdef MIRRORS
  if (off_mirror) w = off;
#endif
  mirrored = reflected.share;
#ifdef COARSE_EYE
  if (eye_inside != 0u && mirrored < share_limit) {  // what is mirrored back is taken for what the rest shows
    w.share += mirrored;
    mirrored = reflected.share = 0.0;
  }
#endif
  if (!both) reflected.share = mirrored > 0.0 ? 1.0 : 0.0;
  if (in_mirror) w = reflected;  // no share, off a mirror
  if (both)
    mirrored = 0.0;
  else
    reflected.share = 0.0;
  return shown(w, reflected);
}

#ifdef ROUGH
// The same by several paths, where a rough mirror is met first; in a loop, for what is called twice is compiled twice.
vec3 rough_light(bool in_mirror, bool both, out float mirrored) {
  vec3 sum = vec3(0);
  bool rough = is_rough(first.hit.refractor);
  int paths = !rough ? 1 : in_mirror ? 0 : LOBE_WAYS;
  lobe_ways = float(LOBE_WAYS);
  lobe_width = mirrored = 0.0;
  if (rough && !in_mirror) sum = lobe_shows(start, first, vec2(0.5 * pixel_angle));
  for (int k = 0; k < paths; k++) {
    lobe_u = lobe_way(k, lobe_shift);
    lobe_width = 0.0;
    sum += path_light(in_mirror, both, mirrored) / float(paths);
  }
  return sum;
}
#define path_light rough_light
#endif

vec3 band_light(int band, bool in_mirror, bool both, out float mirrored) {
  take_band(band_set, band - first_band(refractor));
#ifdef CRYSTALS
  vec3 light = vec3(0);
  const float EACH = 1.0 / float(WAVES);
  float once;
  mirrored = 0.0;
  for (int wave = first_wave; wave < first_wave + WAVES; wave++) {  // half of the light could become either
    start.wave = wave;
#ifdef KEEPS_SIGHTS
    uint before = sight_chain;
#endif
    light += EACH * path_light(in_mirror, both, once);
    mirrored += EACH * once;
#ifdef KEEPS_SIGHTS
    weigh_sights(before, EACH * sight_tail);
    sight_tail = vec3(1);
#endif
  }
  return light;
#else
  return path_light(in_mirror, both, mirrored);
#endif
}

#ifdef GLOW_RAYS
// glow_rays.glsl has its main().
#elif defined(REFINED)
void main() {
  copy_all();
  uint listed = group_number() * uint(PIXELS) + uint(place);
  bool there = listed < refine_count;
  uvec2 entry = there ? refine[listed] : uvec2(0);
  ivec2 at = pixel_of(entry.x);
  int base, count;
#ifdef HIERARCHY
  if (pixel_thread == 0) {
    look(at);
    wanted_level(entry.y, base, count);
    give_task(base, count);
  }
  JOIN
  take_task(at, base, count);
#else
  look(at);
  wanted_level(entry.y, base, count);
#endif
  uint wanted = entry.y & 255u;
  int joined = int(entry.y >> 12 & 15u), most = bitCount(wanted) << joined;
  vec3 sum = vec3(0);
  for (int k = pixel_thread; k < most; k += PIXEL_THREADS) {
    uint rest = wanted;
    for (int before = k >> joined; before > 0; before--) rest &= rest - 1u;
    int i = (findLSB(rest) << joined) + (k & ((1 << joined) - 1));
    float mirrored;
    vec3 light = band_light(base + min(i, count - 1), false, false, mirrored);
    sum += i < count ? light : vec3(0);
  }
  path_sum[OF_PIXEL * PIXEL_THREADS + pixel_thread] = sum;
  JOIN
  if (pixel_thread > 0 || !there) return;
  vec3 all = vec3(0);
  for (int k = 0; k < PIXEL_THREADS; k++) all += path_sum[OF_PIXEL * PIXEL_THREADS + k];
  add_to_picture(at, all);
}
#else
SHARED vec3 path_mirror[OF_PIXELS(PIXEL_THREADS)], in_the_mirror[OF_PIXELS(1)];
#ifdef REFINES
SHARED vec3 path_shown[OF_PIXELS(COARSE_BANDS)];
#endif

void main() {
  copy_all();
  uint listed = pixel_first + group_number() * uint(PIXELS) + uint(place);
  bool there = listed < min(pixel_count, pixel_end);
  uint where = there ? pixel[listed] : 0u;
  int base, count;
#ifdef HIERARCHY
  if (pixel_thread == 0) {
    look(pixel_of(where));
    choose_bands(base, count);
    give_task(base, count);
  }
  JOIN
  take_task(pixel_of(where), base, count);
#else
  look(pixel_of(where));
  choose_bands(base, count);
#endif
#ifdef KEEPS_SIGHTS
  uint own_chain = 0u;
#endif
  vec3 sum = vec3(0), mirror = vec3(0);
  int taken_first = first_taken(pixel_of(where), count), taken_by = taken_step(count);
  int taken = (count - taken_first + taken_by - 1) / taken_by;  // and the mirror
  bool both = goes_both_ways(count);
  int last = both ? taken - 1 : taken;
  for (int k = there ? pixel_thread : taken + 1; k <= last; k += PIXEL_THREADS) {
    bool in_mirror = k == taken;
    // What is mirrored is alike for all wavelengths: their joined band shows it.
    int i = taken_first + k * taken_by, band = in_mirror ? first_band(refractor) + counts.bands - 1 : base + i;
    float mirrored;
#ifdef KEEPS_SIGHTS
    sight_chain = in_mirror ? 0u : own_chain;
    uint before = sight_chain;
#endif
    vec3 light = band_light(band, in_mirror, both, mirrored);
    vec3 weight = in_mirror ? vec3(0) : bands[band].weight_n.xyz;
#ifdef KEEPS_SIGHTS
    weigh_sights(before, sight_tail);
    if (in_mirror) sight_pixels[listed * SIGHT_WORDS + 7u] = sight_chain;
    own_chain = in_mirror ? own_chain : sight_chain;
#endif
    mirror += mirrored * weight;
    sum += in_mirror ? vec3(0) : light;
    if (in_mirror || both) in_the_mirror[OF_PIXEL] = light;
#ifdef REFINES
    if (!in_mirror) path_shown[OF_PIXEL * COARSE_BANDS + i] = light;
#endif
  }
#ifdef KEEPS_SIGHTS
  if (there) sight_pixels[listed * SIGHT_WORDS + 8u + uint(pixel_thread)] = own_chain;
#endif
  path_sum[OF_PIXEL * PIXEL_THREADS + pixel_thread] = sum;
  path_mirror[OF_PIXEL * PIXEL_THREADS + pixel_thread] = mirror;
  JOIN
  if (pixel_thread > 0 || !there) return;
  vec3 all = vec3(0), all_mirror = vec3(0);
  for (int k = 0; k < PIXEL_THREADS; k++) {
    all += path_sum[OF_PIXEL * PIXEL_THREADS + k];
    all_mirror += path_mirror[OF_PIXEL * PIXEL_THREADS + k];
  }
#ifdef REFINES
  for (int i = 0; i < COARSE_BANDS; i++)
    shown_by[i] = i < count ? path_shown[OF_PIXEL * COARSE_BANDS + i] : vec3(0);
#endif
#ifdef KEEPS_SIGHTS
  keep_pixel(listed, all + all_mirror * in_the_mirror[OF_PIXEL], all_mirror);
#else
  write_pixel(where, base, count, all + all_mirror * in_the_mirror[OF_PIXEL]);
#endif
}
#endif
