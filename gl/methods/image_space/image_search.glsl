// Where a ray meets receivers, by what a view sees of them: the ways of scenes/view/estimator.h.
// ESTIMATOR, one of ESTIMATOR_SHAH and so on, ITERATIONS, and SEARCH_AS_PRINTED: starts and steps in metres.
// Who includes this gives
// look_up(at, seen), places_view(), places_axis(at) and, for the exact one, receiver_hit().
const float START_M = 1.0, STEP_M = 0.1, STEP_SHARE = 0.015625;
const int DOUBLINGS = 8;
const float BEHIND = 1e-3;  // share of the view's far end

vec3 search_o, search_r, search_seen;
bool search_found;

bool look_along(float d) {
  search_found = look_up(search_o + d * search_r, search_seen);
  return search_found;
}

// How far the ray is behind what is seen, or as a ratio to its distance; 0 where nothing is seen.
float behind(float d, bool ratio) {
  View v = places_view();
  vec3 at = search_o + d * search_r;
  if (!look_along(d)) return 0.0;
  if (v.origin.w < 0.5) return dot(at - search_seen, v.forward.xyz);
  float here = distance(at, v.origin.xyz), there = distance(search_seen, v.origin.xyz);
  return ratio ? (here - there) / there : here - there;
}

float cut(vec2 a, vec2 b) { return b.y == a.y ? b.x : b.x - b.y * (b.x - a.x) / (b.y - a.y); }

#if ESTIMATOR == ESTIMATOR_SHAH || ESTIMATOR == ESTIMATOR_AXIS
float search() {
#ifdef SEARCH_AS_PRINTED
  float d = START_M;
#else
  look_along(0.0);
  float d = distance(search_seen, search_o);
#endif
  for (int i = 0; i < ITERATIONS; i++) {
    bool seen = look_along(d);
#if ESTIMATOR == ESTIMATOR_AXIS
    vec3 axis = places_axis(search_o + d * search_r);
    float next = dot(search_seen - search_o, axis) / dot(search_r, axis);
#else
    float next = distance(search_seen, search_o);
#endif
    d = seen ? next : d;
  }
  look_along(d);
  return d;
}
#endif

#if ESTIMATOR == ESTIMATOR_NEWTON
float halve(float a, float b, int iterations) {
  float low = min(a, b), high = max(a, b);
  for (int i = 1; i < iterations; i++) {
    float middle = 0.5 * (low + high), g = behind(middle, false);
    bool before = search_found && g < 0.0;
    low = before ? middle : low;
    high = before ? high : middle;
  }
  return 0.5 * (low + high);
}

float search() {
#ifdef SEARCH_AS_PRINTED
  float d = STEP_M, h = STEP_M;
#else
  look_along(0.0);
  float d = 0.0, h = STEP_SHARE * distance(search_seen, search_o);
#endif
  float earlier = d, turned = 0.0;
  int left = 0;
  bool going = true;
  for (int i = 0; i < ITERATIONS; i++) {
    if (going) {
      float f = behind(d, false);
      bool seen = search_found;
      float next = behind(d + h, false);
      seen = seen && search_found;
#ifdef SEARCH_AS_PRINTED
      f = abs(f);
      next = abs(next);
#endif
      float to = d - f * h / (next - f);
      going = seen && f != 0.0 && next != f;
      search_found = seen;
#ifdef SEARCH_AS_PRINTED
      if (going && i > 0 && abs(to - earlier) < 0.25 * abs(to - d)) {
        turned = to;
        left = ITERATIONS - i;
        going = false;
      }
#endif
      if (going) {
        earlier = d;
        d = to;
      }
    }
  }
  return left > 0 ? halve(d, turned, left) : d;
}
#endif

#if ESTIMATOR == ESTIMATOR_SECANT
float search() {
  vec2 a = vec2(0.0, behind(0.0, false)), b;
  if (!search_found) return 0.0;
  b.x = distance(search_seen, search_o);
  b.y = behind(b.x, false);
  bool going = search_found;
  float d = going ? cut(a, b) : b.x;
  for (int i = 1; i < ITERATIONS; i++) {
    if (going && d != b.x && b.y != 0.0) {
      a = b;
      b = vec2(d, behind(d, false));
      going = search_found;
      d = going ? cut(a, b) : d;
    }
  }
  return d;
}
#endif

#if ESTIMATOR == ESTIMATOR_FALSE_POSITION || ESTIMATOR == ESTIMATOR_ILLINOIS || \
    ESTIMATOR == ESTIMATOR_BISECTION || ESTIMATOR == ESTIMATOR_RATIO
const bool BY_RATIO = ESTIMATOR == ESTIMATOR_RATIO;
const bool HALVES = BY_RATIO || ESTIMATOR == ESTIMATOR_ILLINOIS;

float within(vec2 low, vec2 high) {
#if ESTIMATOR == ESTIMATOR_BISECTION
  return 0.5 * (low.x + high.x);
#else
  return cut(low, high);
#endif
}

float search() {
  vec2 low = vec2(0.0, behind(0.0, BY_RATIO)), high = vec2(0.0);
  if (!search_found) return 0.0;
  float to = distance(search_seen, search_o);
  bool held = false;
  for (int i = 0; i <= DOUBLINGS; i++) {
    if (!held) {
      high = vec2(to, behind(to, BY_RATIO));
      held = search_found && high.y >= 0.0;
      if (!held && search_found) low = high;
      to = search_found ? 2.0 * to : 0.5 * (low.x + to);
    }
  }
  search_found = held;
  if (!held) return high.x;
  int side = 0;
  bool going = true;
  float d = within(low, high);
  for (int i = 1; i < ITERATIONS; i++) {
    if (going) {
      float g = behind(d, BY_RATIO);
      going = !search_found || g != 0.0;
      if (going && search_found && g < 0.0) {
        low = vec2(d, g);
        if (HALVES && side < 0) high.y *= 0.5;
        side = -1;
      } else if (going) {
        high = vec2(d, search_found ? g : high.y);
        if (HALVES && side > 0) low.y *= 0.5;
        side = 1;
      }
      d = going ? within(low, high) : d;
    }
  }
  search_found = true;
  return d;
}
#endif

#if ESTIMATOR == ESTIMATOR_MARCH
float search() {
  if (!look_along(0.0)) return 0.0;
  float size = 4.0 * distance(search_seen, search_o) / float(ITERATIONS), at = -1.0;
  for (int i = 1; i <= ITERATIONS; i++) {
    if (at < 0.0) {
      float g = behind(size * float(i), false);
      if (search_found && g >= 0.0) at = size * (float(i) - 0.5);
    }
  }
  search_found = at >= 0.0;
  return at;
}
#endif

#if ESTIMATOR == ESTIMATOR_IMPOSTOR
float search() {
  View v = places_view();
  bool perspective = v.origin.w > 0.5, ahead = dot(search_r, places_axis(v.origin.xyz + search_r)) > 0.0;
  float far = 0.0;
  bool seen = perspective && ahead && look_up(v.origin.xyz + search_r, search_seen);
  if (seen) far = distance(search_seen, v.origin.xyz);
  if (!seen) far = look_along(0.0) ? distance(search_seen, search_o) : 0.0;
  vec2 low = vec2(0.0, behind(0.0, true)), high = vec2(0.0);
  if (!search_found || far <= 0.0) {
    search_found = false;
    return 0.0;
  }
  float scale = perspective ? far : 1.0, d = -scale * low.y;
  bool going = true;
  for (int i = 1; i < ITERATIONS; i++) {
    if (going) {
      vec2 here = vec2(d, behind(d, true));
      going = search_found && here.y != 0.0;
      if (going && here.y < 0.0) low = here;
      if (going && here.y >= 0.0) high = here;
      if (going) d = high.x > 0.0 ? cut(low, high) : d - scale * here.y;
    }
  }
  return d;
}
#endif

// From o along the unit direction r. False where nothing is found.
bool find_receiver(vec3 o, vec3 r, out vec3 at) {
#if ESTIMATOR == ESTIMATOR_EXACT
  float t;
  at = o;
  if (receiver_hit(o, r, -1e-5 * refractor_bounds.w, 1e30, t) < 0) return false;
  at = o + t * r;
  return true;
#else
  search_o = o;
  search_r = r;
  float d = search();
#if ESTIMATOR == ESTIMATOR_SHAH || ESTIMATOR == ESTIMATOR_AXIS
  at = search_seen;
#else
  at = o + d * r;
#endif
  return search_found && d >= -BEHIND * places_view().range.y;
#endif
}
