// What stands between a light and a place on a receiver.

// Light's direction of travel to p and its distance (directional: farther than anything).
void light_to(Light l, vec3 p, out vec3 d, out float distance_m) {
  if (int(l.position.w) == 2) {
    d = l.direction.xyz;
    distance_m = 1e30;
  } else {
    d = p - l.position.xyz;
    distance_m = length(d);
    d /= distance_m;
  }
}

// Where rays to light that travels along d begin: off the surface at p, of normal n, on the light's side, by more than
// floats may be off it, however far away the light is.
vec3 off_surface(vec3 p, vec3 n, vec3 d) {
  float gap = 8e-6 * (abs(p.x) + abs(p.y) + abs(p.z));
  return p + (dot(n, d) < 0.0 ? gap : -gap) * n;
}

// No other receiver stands between the light and p on a surface of normal n; in the air n is 0.
bool receiver_lit(int light, vec3 p, vec3 n, vec3 d, float distance_m) {
#ifndef RECEIVER_SHADOWS
  return true;
#else
  return !receiver_between(off_surface(p, n, d), -d, 0.0, distance_m * (1.0 - 2e-5));
#endif
}

#ifdef SHADOW_PLANES
// Share of a light that a convex refractor leaves: its shadow is within all its planes. A point of a light with a size
// stands for a part of it, whose penumbra is as wide as the edge is far.
float convex_lit(int light, int refractor, vec3 p) {
  vec3 x = int(LIGHT(light).position.w) == 2 ? p : p - LIGHT(light).position.xyz;
#ifdef ONE_SHADOW
  const int first = 0, count = SHADOW_PLANES;
#else
  ivec2 range = shadow_range[light * REFRACTORS + refractor].xy;
  int first = range.x, count = range.y;
#endif
  if (count == 0) return 1.0;
  float most = -1e30, wide = 0.0;
#ifdef SOFT_SHADOWS
  int at = 0;
#define CROSS(i) { float off = dot(SHADOW_PLANE(i).xyz, x) - SHADOW_PLANE(i).w; at = off > most ? i : at; most = max(most, off); }
  OF_SHADOW_PLANES(CROSS)
  wide = dot(shadow_edges[first + at], vec4(x, 1));
#else
#define CROSS(i) most = max(most, dot(SHADOW_PLANE(i).xyz, x) - SHADOW_PLANE(i).w);
  OF_SHADOW_PLANES(CROSS)
#endif
  return wide > 0.0 ? smoothstep(-wide, wide, most) : float(most >= 0.0);
}
#endif

#ifdef SPHERES
// Share of a light that a ball leaves, in front of p: of a light of some width what one disk leaves of another.
float sphere_lit(int light, vec4 sphere, vec3 p, vec3 from, vec3 d, float distance_m, Hit h) {
#ifdef SOFT_SHADOWS
  float along = dot(p - sphere.xyz, d), r = LIGHT(light).cube.z * along;
  if (int(LIGHT(light).position.w) != 2) r /= max(distance_m - along, 1e-6 * distance_m);
  if (r > 0.0) {
    float ball = sphere.w / r, off = max(length(p - sphere.xyz - along * d) / r, max(abs(ball - 1.0), 1e-6));
    if (off >= ball + 1.0) return 1.0;
    float x = (off * off + 1.0 - ball * ball) / (2.0 * off), y = off - x;
    return 1.0 - clamp((acos(clamp(x, -1.0, 1.0)) - off * sqrt(max(1.0 - x * x, 0.0)) +
                        ball * ball * acos(clamp(y / ball, -1.0, 1.0))) / PI, 0.0, 1.0);
  }
#endif
  return sphere_front(sphere, from, d, h) ? 0.0 : 1.0;
}
#endif

// Share of a light that refractors with exact surfaces leave, between it and p or around p.
float exact_lit(int light, vec3 p, vec3 d, float distance_m) {
  Hit h;
  // The ray begins close before all refractors: from farther away it would miss them by its rounding.
  h.t = min(distance_m, max(dot(p - refractor_bounds.xyz, d) + 1.01 * refractor_bounds.w, 0.0));
  vec3 from = p - h.t * d;
  float lit = 1.0;
  for (int r = 0; r < REFRACTORS; r++) {
#ifdef SHADOW_PLANES
    lit = min(lit, convex_lit(light, r, p));
#elif defined(CONVEX)
    if (refractors[r].info.x == MODEL_CONVEX && convex_front(refractors[r].info, from, d, h)) lit = 0.0;
#endif
#ifdef SPHERES
    if (refractors[r].info.x == MODEL_SPHERE)
      lit = min(lit, sphere_lit(light, refractors[r].sphere, p, from, d, distance_m, h));
#endif
  }
  return lit;
}

// Share of direct light that no refractor takes away before p.
float refractor_shadow(int light, vec3 p, vec3 d, float distance_m) {
  if (LIGHT(light).misc.w == 0.0) return 1.0;
  float exact = exact_lit(light, p, d, distance_m);
  if (exact == 0.0) return 0.0;
#ifdef FRONT_LAYER
  vec3 uvz;
  View v = LIGHT(light).near_view;
  if (!project(v, p, uvz)) return exact;
  ivec2 size = textureSize(light_layers, 0).xy;
  vec2 at = uvz.xy * vec2(size) - 0.5;
#ifdef CUBES
  // What a refractor shows beyond the seam of two faces is another face's.
  if (int(LIGHT(light).cube.x) != ALL_FACES && inside(uvz.xy)) at = clamp(at, vec2(0), vec2(size - 1));
#endif
  ivec2 base = ivec2(floor(at));
  vec2 f = at - vec2(base);
  float lit = 0.0;
  for (int k = 0; k < 4; k++) {
    ivec2 o = ivec2(k & 1, k >> 1), texel = base + o;
    bool outside = any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size));
    float front = outside ? 0.0 : textureLod(light_layers, vec3((vec2(texel) + 0.5) / vec2(size), float(2 * light)), 0.0).w;
    float w = (o.x == 1 ? f.x : 1.0 - f.x) * (o.y == 1 ? f.y : 1.0 - f.y);
    lit += front <= 0.0 || front > uvz.z ? w : 0.0;
  }
  return exact * lit;
#else
  return exact;
#endif
}
