// Receivers as rays see them. Refractors are taken away.

struct Sighting {
  vec3 p, n;  // n faces the viewer
  int surface;
  vec2 uv;
  int side;  // chart_side, where there are CHART_SIDES
  int sheet;  // of a parallelogram: twice its number, and 1 where it is seen from behind
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
  s.uv = vec2(dot(s.p - rc.corner.xyz, rc.du.xyz), dot(s.p - rc.corner.xyz, rc.dv.xyz));
  s.n = dot(n, d) > 0.0 ? -n : n;
  s.surface = int(rc.corner.w);
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
