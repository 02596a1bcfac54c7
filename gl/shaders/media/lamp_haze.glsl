// The light that a light sends straight to a ray through the air's haze, by STEPS_ALONG places on it; with the shadows of
// refractor.glsl and receiver.glsl.

// Where [from, to] of the ray is in the spot's cone; empty: from >= to (as validation's own is found, by the
// roots of a quadratic, convex as the cone is).
vec2 cone_part(Light l, vec3 o, vec3 d, float from, float to) {
  vec3 v = o - l.position.xyz, axis = l.direction.xyz;
  float c = l.direction.w, c2 = c * c, da = dot(d, axis), va = dot(v, axis);
  float a = da * da - c2, b = da * va - c2 * dot(v, d), e = va * va - c2 * dot(v, v), root = b * b - a * e;
  float q = -(b + (b < 0.0 ? -1.0 : 1.0) * sqrt(max(root, 0.0)));
  vec2 cut = root > 0.0 ? clamp(vec2(q / (a == 0.0 ? 1e-20 : a), q == 0.0 ? HAZE_FAR : e / q), from, to)
                        : vec2(from, to);
  if (cut.x > cut.y) cut = cut.yx;
  vec2 part = vec2(HAZE_FAR, -HAZE_FAR);
  for (int k = 0; k < 3; k++) {
    float low = k == 0 ? from : k == 1 ? cut.x : cut.y, high = k == 0 ? cut.x : k == 1 ? cut.y : to;
    vec3 x = v + 0.5 * (low + high) * d;
    float along = dot(x, axis);
    bool holds = high > low && along > 0.0 && along >= c * length(x);
    part = holds ? vec2(min(part.x, low), max(part.y, high)) : part;
  }
  return part;
}

// Place k of so many, and how much of the path it stands for: by equal angles about a light that is near.
vec2 place_along(Light l, vec3 o, vec3 d, vec2 part, int k) {
  float u = (float(k) + 0.5) / float(STEPS_ALONG);
  if (int(l.position.w) == 2)
    return vec2(mix(part.x, part.y, u), (part.y - part.x) / float(STEPS_ALONG));
  vec3 v = l.position.xyz - o;
  float middle = dot(v, d), height = max(length(v - middle * d), 1e-6 * (1.0 + abs(middle)));
  float a = angle_of(part.x - middle, height), b = angle_of(part.y - middle, height);
  float off = height * tan(mix(a, b, u));
  return vec2(middle + off, (b - a) * (height * height + off * off) / (height * float(STEPS_ALONG)));
}

// What haze scatters on [from, to] of a ray, all of it in the air's, of what a light sends straight there; seen through so
// many metres more.
vec3 lamp_light(int light, vec3 o, vec3 d, float from, float to, float more_m) {
  Light l = LIGHT(light);
  int kind = int(l.position.w);
  vec2 part = kind == 1 ? cone_part(l, o, d, from, to) : vec2(from, to);
  bool some = part.x < part.y;
  if (!some) part = vec2(from, to);
  vec3 sum = vec3(0);
  for (int k = 0; k < STEPS_ALONG; k++) {
    vec2 place = place_along(l, o, d, part, k);
    vec3 p = o + place.x * d, way;
    float distance_m;
    light_to(l, p, way, distance_m);
    float falloff = kind == 2 ? 1.0 : 1.0 / (distance_m * distance_m);
    float e = light_profile(l, way) * falloff * haze_phase(haze_air_g, -dot(way, d)) * place.y, first;
    float lit_m = haze_way(p, -way, 0.0, kind == 2 ? HAZE_FAR : distance_m, first);
    if (e > 0.0 && receiver_lit(light, p, vec3(0), way, distance_m) && area_lights_lit(light, p, way, distance_m))
      sum += e * refractor_shadow(light, p, way, distance_m) * haze_scattered(light, lit_m + place.x - from + more_m);
  }
  return some ? l.white.w * sum : vec3(0);
}
