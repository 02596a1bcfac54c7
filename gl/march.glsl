// The intersection of a ray with a surface known only as a layer of distances seen from a view.
// The fast iteration steps to the distance of the surface point that the last estimate projects
// to [ShahKonttinenPattanaik2007]; where its estimates start to alternate it stops, and the root
// is bracketed by steps and closed by bisection.

#include "view.glsl"

#ifndef MARCH_ITERATIONS
#define MARCH_ITERATIONS 5
#endif
#ifndef MARCH_STEPS
#define MARCH_STEPS 10
#endif
#ifndef MARCH_BISECTIONS
#define MARCH_BISECTIONS 8
#endif

// Distance layer value at uv, bilinear over the texels that hold something; 0: nothing there.
float layer_distance(sampler2DArray layers, vec3 uvl) {
  ivec2 size = textureSize(layers, 0).xy;
  vec2 at = uvl.xy * vec2(size) - 0.5;
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  float sum = 0.0, weights = 0.0, nearest = 0.0, lowest = 1e30, highest = 0.0, best = -1.0;
  for (int k = 0; k < 4; k++) {
    ivec2 o = ivec2(k & 1, k >> 1);
    float d = texelFetch(layers, ivec3(clamp(base + o, ivec2(0), size - 1), int(uvl.z)), 0).w;
    float w = (o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y);
    if (w > best) { best = w; nearest = d; }
    if (d <= 0.0) continue;
    sum += w * d;
    weights += w;
    lowest = min(lowest, d);
    highest = max(highest, d);
  }
  // Over a step of depth no mean surface exists: take the nearest texel's.
  if (nearest <= 0.0 || highest - lowest > 0.05 * nearest) return nearest;
  return sum / weights;
}

// How far p + t d lies behind (+) or before (-) the surface, along the view's ray.
bool behind_surface(View v, sampler2DArray layers, float layer, vec3 x, out float f, out vec3 q) {
  vec3 uvz;
  f = -1.0;
  if (!project(v, x, uvz) || !inside(uvz.xy)) return false;
  float s = layer_distance(layers, vec3(uvz.xy, layer));
  if (s <= 0.0) return false;
  vec3 o, r;
  view_ray(v, uvz.xy, o, r);
  q = o + s * r;
  f = uvz.z - s;
  return true;
}

// The first crossing from before to behind along the ray, closed by bisection.
bool march_bisect(View v, sampler2DArray layers, float layer, vec3 p, vec3 d, float t_max,
                  out float t) {
  float low = 0.0, high = -1.0, last = 0.0, f;
  vec3 q;
  bool was_before = true;
  for (int i = 1; i <= MARCH_STEPS && high < 0.0; i++) {
    float next = t_max * float(i) / float(MARCH_STEPS);
    bool seen = behind_surface(v, layers, layer, p + next * d, f, q);
    if (seen && f >= 0.0 && was_before) {
      low = last;
      high = next;
    }
    was_before = !seen || f < 0.0;
    last = next;
  }
  for (int k = 0; k < MARCH_BISECTIONS; k++) {
    float m = 0.5 * (low + high);
    bool there = behind_surface(v, layers, layer, p + m * d, f, q);
    if (there && f >= 0.0) high = m; else low = m;
  }
  t = 0.5 * (low + high);
  // A jump over the rim of something nearer is not a hit.
  bool there = behind_surface(v, layers, layer, p + high * d, f, q);
  return high > 0.0 && there && f < t_max * 2e-2;
}

bool march(View v, sampler2DArray layers, float layer, vec3 p, vec3 d, float t_start, float t_max,
           out float t) {
  float before = -1.0, tolerance = 1e-4 * t_max;
  t = t_start;
  for (int i = 0; i < MARCH_ITERATIONS; i++) {
    float f;
    vec3 q;
    if (!behind_surface(v, layers, layer, p + t * d, f, q)) break;
    if (abs(f) < tolerance && t > 0.0) return true;
    float next = distance(q, p);
    bool alternates = i > 0 && abs(next - before) < 0.25 * abs(next - t);
    before = t;
    t = next;
    if (alternates) break;
  }
  return march_bisect(v, layers, layer, p, d, t_max, t);
}
