// What rays of the camera show of receivers, each for a part of the picture. Refractors are taken away.
uniform vec4 eye_view[6];
uniform vec2 receiver_samples;  // across and up

View own_eye_view;
vec2 own_samples;

void copy_all() {
  copy_tables();
  copy_surroundings();
  own_samples = read_now(receiver_samples);
  own_eye_view = View(read_now(eye_view[0]), read_now(eye_view[1]), read_now(eye_view[2]), read_now(eye_view[3]),
                      read_now(eye_view[4]), read_now(eye_view[5]));
}

vec3 on_plane(vec3 p, vec3 n, vec2 uv) {
  vec3 o, d;
  view_ray(own_eye_view, uv, o, d);
  return o + dot(p - o, n) / dot(d, n) * d;
}

// What a ray shows that stands for `area` of the window; met: a receiver, so far off.
Shading ray_light(vec2 uv, vec2 area, out bool met, out float t) {
  vec3 o, d;
  Sighting at;
  view_ray(own_eye_view, uv, o, d);
  met = receiver_seen(o, d, 0.0, 1e30, t, at);
  if (!met) return Shading(vec3(0), vec3(0), surroundings(d));
#ifdef RECEIVER_HIERARCHY
  vec3 n = face_n;
#else
  vec3 n = at.n;
#endif
  area_right = on_plane(at.p, n, uv + vec2(area.x, 0)) - at.p;
  area_above = on_plane(at.p, n, uv + vec2(0, area.y)) - at.p;
  return shade(at.p, at.n, at.surface, at.uv, at.side);
}
