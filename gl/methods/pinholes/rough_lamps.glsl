// A light as a rough mirror shows it where nothing is between.
struct LampRay {
  PathState ray;  // to the light, with what the mirror leaves of its light
  float distance_m, e;  // e: that of its white, in the lights' units; 0: nothing
  vec3 shown;           // radiance, of what the mirror reflects of it
};

// Where w comes to the mirror. facets: how far the slopes of its facets, or of the path, are spread.
LampRay lobe_shows_lamp(int i, RoughHit m, vec2 facets, PathState w, Interface h) {
  Light l = lights[i];
  bool far = int(l.position.w) == 2;
  vec3 to = far ? -l.direction.xyz : l.position.xyz - h.hit.p;
  float distance_m = far ? 4.0 * scene_size : length(to);
  to = far ? to : to / max(distance_m, 1e-20);
  vec3 wi = vec3(dot(to, m.x), dot(to, m.y), dot(to, m.n));
  float e = l.white.w * light_profile(l, -to) * wi.z / (far ? 1.0 : distance_m * distance_m);
  e = wi.z > 0.0 && dot(to, m.face_n) > 0.0 ? e * facets_reflect(facets, wi, m.wo) : 0.0;
  float cosine = min(dot(m.wo, normalize(wi + m.wo)), 1.0);
  w.p = h.hit.p;
  w.d = to;
  w.refractor = h.hit.refractor;
  w.facet = dot(to, h.face_n) < 0.0 ? -1 : 1;
  absorb_at_mirror(w, h.hit.refractor, cosine);
  return LampRay(w, distance_m, e, e > 0.0 ? l.white.rgb * e : vec3(0));
}

#ifndef ASKS_FOR_LAMPS
// What a rough mirror shows of lights that it sees straight: XYZ of what the band has of it, in the lights' units. wider: by how much each facet's slopes are spread besides, along the grooves and across, as by
// what the path stands for.
vec3 lobe_shows(PathState w, Interface h, vec2 wider) {
  RoughHit m = rough_hit(w, h);
  vec2 facets = sqrt(m.facets * m.facets + wider * wider);
  vec3 sum = vec3(0);
  for (int i = 0; i < LIGHTS; i++) {
    LampRay l = lobe_shows_lamp(i, m, facets, w, h);
    vec3 light = in_band(l.ray, l.shown);  // before the search, which then keeps less
    Interface between;
    between.hit.t = l.distance_m;
    if (l.e <= 0.0 || next_interface(l.ray, between) ||
        receiver_between(l.ray.p, l.ray.d, 1e-4 * refractor_bounds.w, l.distance_m) ||
        !area_lights_lit(i, l.ray.p, -l.ray.d, l.distance_m))
      continue;
    sum += light;
  }
  return sum;
}
#endif
