// The irradiance of lights with a size where nothing hides them, in closed form: half the integral of
// (r x dr) . n / r^2 around what of the light is above the horizon of n [Howell2021].

#ifdef AREA_LIGHTS
// Twice the irradiance of the straight line from a to b.
float line_irradiance(vec3 a, vec3 b, vec3 n) {
  vec3 across = cross(a, b);
  float length_ = length(across);
  return length_ > 0.0 ? dot(across, n) * atan(length_, dot(a, b)) / length_ : 0.0;
}

// The irradiance of the rectangle c + [-1, 1] u + [-1, 1] v of unit radiance.
float rectangle_irradiance(vec3 c, vec3 u, vec3 v, vec3 n) {
  vec3 leaves = vec3(0), enters = vec3(0);
  float sum = 0.0;
  for (int k = 0; k < 4; k++) {
    vec3 a = c + (k == 0 || k == 3 ? -u : u) + (k < 2 ? -v : v);
    vec3 b = c + (k < 2 ? u : -u) + (k == 0 || k == 3 ? -v : v);
    float over_a = dot(a, n), over_b = dot(b, n);
    if (max(over_a, over_b) < 0.0) continue;
    vec3 cut = mix(a, b, over_a / (over_a - over_b));
    if (over_a < 0.0) enters = a = cut;
    if (over_b < 0.0) leaves = b = cut;
    sum += line_irradiance(a, b, n);
  }
  return 0.5 * abs(sum + line_irradiance(leaves, enters, n));
}

// The irradiance of the disk around c of unit radiance, seen from its front: with r(t) = c + radius
// (cos t u + sin t v), u from the foot of the perpendicular to its centre, the integrand is (k + l
// cos t + m sin t)
// (a + b cos t).
float disk_irradiance(vec3 c, float radius, vec3 facing, vec3 n) {
  vec3 across = c - dot(c, facing) * facing;
  float off = length(across);
  vec3 u = off > 1e-6 * radius ? across / off
                               : normalize(cross(facing, abs(facing.x) < 0.6 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
  vec3 v = cross(u, facing);
  float over = dot(c, n) / radius;                             // height of the centre above the horizon
  float high = length(vec2(dot(u, n), dot(v, n)));             // and of the rim above the centre
  if (over <= -high) return 0.0;
  float a = dot(c, c) + radius * radius, b = 2.0 * radius * off, s = sqrt(max((a - b) * (a + b), 1e-30));
  float k = -radius * radius * dot(facing, n), l = radius * dot(cross(c, v), n), m = -radius * dot(cross(c, u), n);
  float half_arc = PI, top = atan(dot(v, n), dot(u, n)), chord = 0.0;
  if (over < high) {
    half_arc = acos(clamp(-over / high, -1.0, 1.0));
    float from = top - half_arc, to = top + half_arc;
    chord = line_irradiance(c + radius * (cos(to) * u + sin(to) * v), c + radius * (cos(from) * u + sin(from) * v), n);
  }
  // Integrals of 1, cos t and sin t over a + b cos t, from end to end.
  float g = b / (a + s);
  vec3 sum = vec3(2.0 * half_arc / s, -2.0 * half_arc * g / s, 0.0);
  for (int end = -1; end <= 1 && half_arc < PI; end += 2) {
    float t = top + float(end) * half_arc, x = g * sin(t) / (1.0 + g * cos(t));
    float slope = abs(x) < 1e-2 ? 1.0 - x * x / 3.0 : atan(x) / x;  // x is short of a right angle, for g < 1
    float y = g * slope / (1.0 + g * cos(t)) * sin(t);
    sum.x -= float(end) * 2.0 * y / s;
    sum.y += float(end) * 2.0 * a * slope * sin(t) / ((1.0 + g * cos(t)) * (a + s) * s);
  }
  float from = a + b * cos(top - half_arc), change = b * (cos(top + half_arc) - cos(top - half_arc)) / from;
  float log_slope = abs(change) < 1e-2 ? 1.0 - change * (0.5 - change / 3.0) : log(1.0 + change) / change;
  sum.z = -log_slope * (cos(top + half_arc) - cos(top - half_arc)) / from;
  return 0.5 * max(k * sum.x + l * sum.y + m * sum.z + chord, 0.0);
}

float area_shares[AREA_LIGHTS];  // share of each light at the place that is shaded

// By how much the irradiance of each light at p is more than that of its points. Negative where none of these is above
// the horizon, but a part of the light: the irradiance of unit radiance, over the area.
void set_area_shares(vec3 p, vec3 n) {
  for (int i = 0; i < AREA_LIGHTS; i++) {
    vec3 c = area_light_place[i].xyz - p, facing = area_light_facing[i];
    vec3 u = area_light_edge[2 * i] / dot(area_light_edge[2 * i], area_light_edge[2 * i]);
    vec3 v = area_light_edge[2 * i + 1] / dot(area_light_edge[2 * i + 1], area_light_edge[2 * i + 1]);
    float radius = area_light_place[i].w, area = radius > 0.0 ? PI * radius * radius : 4.0 * length(cross(u, v));
    area_shares[i] = 1.0;
    if (dot(u, u) + dot(v, v) < 3e-4 * dot(c, c) || dot(c, facing) >= 0.0) continue;  // from afar it is its points
    float whole = radius > 0.0 ? disk_irradiance(c, radius, facing, n) : rectangle_irradiance(c, u, v, n), sum = 0.0;
    for (int k = 0; k < area_light_points[i].y; k++) {
      vec3 to = lights[area_light_points[i].x + k].position.xyz - p;
      float square = dot(to, to);
      sum += max(dot(to, n), 0.0) * max(-dot(to, facing), 0.0) / (square * square);
    }
    sum *= area / float(area_light_points[i].y);
    area_shares[i] = sum > 0.0 ? whole / sum : -whole / area;
  }
}
#endif
