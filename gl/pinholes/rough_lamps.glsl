// What a rough mirror shows of lamps that it sees straight: rgb radiance in the lights' units, for all of the
// path's light. wider: by how much each facet's slopes are spread besides, along the grooves and across, as by
// what the path stands for.
vec3 lobe_shows(PathState w, Interface h, vec2 wider) {
  RoughHit m = rough_hit(w, h);
  vec2 facets = sqrt(m.facets * m.facets + wider * wider);
  vec3 spectrum = mirror_spectrum(h.hit.refractor), sum = vec3(0);
  for (int i = 0; i < LIGHTS; i++) {
    Light l = lights[i];
    bool far = int(l.position.w) == 2;
    vec3 to = far ? -l.direction.xyz : l.position.xyz - h.hit.p;
    float distance_m = far ? 4.0 * scene_size : length(to);
    to = far ? to : to / max(distance_m, 1e-20);
    vec3 wi = vec3(dot(to, m.x), dot(to, m.y), dot(to, m.n));
    float e = l.white.w * light_profile(l, -to) * wi.z / (far ? 1.0 : distance_m * distance_m);
    float shown = wi.z > 0.0 && dot(to, m.face_n) > 0.0 ? e * facets_reflect(facets, wi, m.wo) : 0.0;
    if (shown <= 0.0) continue;
    float cosine = min(dot(m.wo, normalize(wi + m.wo)), 1.0);
    PathState ray = w;
    ray.p = h.hit.p;
    ray.d = to;
    ray.refractor = h.hit.refractor;
    ray.facet = dot(to, h.face_n) < 0.0 ? -1 : 1;
    Interface between;
    between.hit.t = distance_m;
    if (next_interface(ray, between) || receiver_between(ray.p, to, 1e-4 * refractor_bounds.w, distance_m)) continue;
    sum += l.white.rgb * (shown * mirror_reflectance(spectrum, cosine));
  }
  return sum;
}
