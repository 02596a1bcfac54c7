// Receivers as rays see them. Refractors are taken away.

struct Sighting {
  vec3 p, n;  // n faces the viewer
  int surface;
  vec2 uv, place;  // place: of a parallelogram, as off_anchor() says
  int side;  // chart_side, where there are CHART_SIDES
  int sheet;  // for a parallelogram: twice its number, and 1 where it is seen from behind
};

// The nearest receiver on the ray, no farther than t_max, if there is any. Sets face_n.
bool receiver_seen(vec3 o, vec3 d, float t_min, float t_max, out float t, out Sighting s) {
  int r = receiver_hit(o, d, t_min, t_max, t);
  if (r < 0) return false;
#ifdef RECEIVER_HIERARCHY
  Receiver rc = receivers[min(r, RECEIVER_ROOM - 1)];
#else
  Receiver rc = receivers[r];
#endif
  vec3 n = rc.normal.xyz;
  s.p = o + t * d;
  // Onto its plane, which the ray's length has rounded it off.
  if (r < RECEIVERS) s.p += (rc.normal.w - dot(n, s.p)) * n;
  s.place = off_anchor(rc, s.p);
  s.uv = s.place + vec2(rc.du.w, rc.dv.w);
  s.n = dot(n, d) > 0.0 ? -n : n;
  s.surface = int(rc.anchor.w);
  s.side = 0;
  s.sheet = 2 * r + (dot(n, d) > 0.0 ? 1 : 0);
#ifdef RECEIVER_HIERARCHY
  face_n = s.n;
  if (r >= RECEIVERS) triangle_at(r - RECEIVERS, s.p, -d, s.n, s.surface, s.uv);
#endif
#ifdef CHART_SIDES
  s.side = chart_side(r, d);
#endif
  return true;
}

#ifdef SEEN_BY_AREAS
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
#ifdef AREA_LIGHTS
  vec3 lamp;
  if (area_light_seen(o, d, 0.0, t, lamp)) {
    met = true;
    return Shading(lamp, vec3(0), vec3(0));
  }
#endif
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
#endif
