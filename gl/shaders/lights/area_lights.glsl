// Lights with a size (docs/scene-files.md): opaque, as bright from every direction of their front, black behind.
// Points stand for them in the list of lights.

#ifdef AREA_LIGHTS
uniform vec4 area_light_place[AREA_LIGHTS];     // centre; radius of a disk, 0 of a rectangle
uniform vec3 area_light_facing[AREA_LIGHTS];    // unit normal of the side that shines
uniform vec3 area_light_edge[2 * AREA_LIGHTS];  // half a side, or a radius, over its square
uniform vec3 area_light_radiance[AREA_LIGHTS];
uniform ivec2 area_light_points[AREA_LIGHTS];   // the first of its points in the list of lights, and how many

bool area_light_met(int i, vec3 p, vec3 d, float t_min, float t_max, out float t) {
  float facing = dot(d, area_light_facing[i]);
  vec3 to = area_light_place[i].xyz - p;
  t = dot(to, area_light_facing[i]) / (facing == 0.0 ? 1e-30 : facing);
  vec3 off = t * d - to;
  float radius = area_light_place[i].w;
  bool within = radius > 0.0 ? dot(off, off) <= radius * radius
                             : max(abs(dot(off, area_light_edge[2 * i])),
                                   abs(dot(off, area_light_edge[2 * i + 1]))) <= 1.0;
  return t > t_min && t < t_max && within;
}

// Whether the ray from p meets a light before t_max, which is then where; and what it shows.
bool area_light_seen(vec3 p, vec3 d, float t_min, inout float t_max, out vec3 radiance) {
  bool seen = false;
  radiance = vec3(0);
  for (int i = 0; i < AREA_LIGHTS; i++) {
    float t;
    if (!area_light_met(i, p, d, t_min, t_max, t)) continue;
    seen = true;
    t_max = t;
    radiance = dot(d, area_light_facing[i]) < 0.0 ? area_light_radiance[i] : vec3(0);
  }
  return seen;
}

// That a light is a point of, -1: none.
int area_light_of(int light) { return int(LIGHT(light).cube.y) - 1; }
#endif

// Whether a light with a size, but not number `but`, stands on the ray.
bool area_light_between(vec3 p, vec3 d, float t_min, float t_max, int but) {
  bool between = false;
#ifdef AREA_LIGHTS
  for (int i = 0; i < AREA_LIGHTS; i++) {
    float t;
    between = between || (i != but && area_light_met(i, p, d, t_min, t_max, t));
  }
#endif
  return between;
}

// No other light's surface stands between a light and p; d and distance_m as of light_to.
bool area_lights_lit(int light, vec3 p, vec3 d, float distance_m) {
#ifdef AREA_LIGHTS
  bool far = int(LIGHT(light).position.w) == 2;
  return !area_light_between(p, -d, 0.0, far ? 1e30 : distance_m * (1.0 - 2e-5), area_light_of(light));
#else
  return true;
#endif
}
