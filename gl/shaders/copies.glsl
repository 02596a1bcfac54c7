// Tables that a shader reads over and over, copied before anything else. A software rasteriser reads a
// uniform block once for all lanes only where it is sure of all of them: before any branch or loop of
// main(), or behind all. Within, it reads lane by lane, whatever the place, which costs several times what
// is done with what is read, and forty instructions to compile for every number. EACH_PLANE(DO) is DO(0) DO(1) and so on, as loops
// of more than 32 turns are not unrolled; so are EACH_LIGHT, EACH_RECEIVER and EACH_SHADOW_PLANE. Who is
// copies says COPIES_TABLES and calls copy_tables() in the first line of main(), or behind a barrier there;
// all others read.

#ifndef COPIES_TABLES
#undef EACH_LIGHT
#undef EACH_RECEIVER
#undef EACH_PLANE
#undef EACH_SHADOW_PLANE
#endif

#ifdef EACH_LIGHT
Light own_light[LIGHT_ROOM];
#define LIGHT(i) own_light[i]
#define OF_LIGHTS(DO) EACH_LIGHT(DO)
#else
#define LIGHT(i) lights[i]
#define OF_LIGHTS(DO) for (int i = 0; i < LIGHTS; i++) DO(i)
#endif

#ifdef EACH_RECEIVER
Receiver own_receiver[RECEIVER_ROOM];
#define RECEIVER(i) own_receiver[i]
#define OF_RECEIVERS(DO) EACH_RECEIVER(DO)
#else
#define RECEIVER(i) receivers[i]
#define OF_RECEIVERS(DO) for (int i = 0; i < RECEIVERS; i++) DO(i)
#endif

// One solid has the whole table; of several, each has its own part.
#ifdef ONE_CONVEX
#define PLANE_FIRST 0
#define PLANE_COUNT PLANE_ROOM
#else
#define PLANE_FIRST info.y
#define PLANE_COUNT info.z
#endif
#ifdef EACH_PLANE
vec4 own_plane[PLANE_ROOM];
#define PLANE(i) own_plane[i]
#define OF_PLANES(DO) EACH_PLANE(DO)
#else
#define PLANE(i) planes[PLANE_FIRST + i]
#define OF_PLANES(DO) for (int i = 0; i < PLANE_COUNT; i++) DO(i)
#endif

#ifdef SHADOW_PLANES
// The shadows of convex refractors (gpu_scene.h): where the planes of each light and refractor begin,
// and how many they are. ONE_SHADOW: they are all of one.
layout(std140, binding = BINDING_SHADOW_PLANES) uniform ShadowPlanes {
  ivec4 shadow_range[LIGHT_ROOM * REFRACTOR_ROOM];
  vec4 shadow_planes[SHADOW_PLANES];
#ifdef SOFT_SHADOWS
  vec4 shadow_edges[SHADOW_PLANES];  // half of the penumbra's width there: . (x, 1)
#endif
};
#ifdef EACH_SHADOW_PLANE
vec4 own_shadow_plane[SHADOW_PLANES];
#define SHADOW_PLANE(i) own_shadow_plane[i]
#define OF_SHADOW_PLANES(DO) EACH_SHADOW_PLANE(DO)
#else
#define SHADOW_PLANE(i) shadow_planes[first + i]
#define OF_SHADOW_PLANES(DO) for (int i = 0; i < count; i++) DO(i)
#endif
#endif

// Uniforms by themselves cost as much, and a plain copy of one is taken for another name of it. This is none.
float read_now(float x) { return max(x, x); }
vec2 read_now(vec2 x) { return max(x, x); }
vec3 read_now(vec3 x) { return max(x, x); }
vec4 read_now(vec4 x) { return max(x, x); }
mat3 read_now(mat3 m) { return mat3(read_now(m[0]), read_now(m[1]), read_now(m[2])); }

void copy_tables() {
#ifdef COPIES_TABLES
  copy_counts();
#endif
#ifdef EACH_LIGHT
#define COPY_LIGHT(i) own_light[i] = lights[i];
  EACH_LIGHT(COPY_LIGHT)
#endif
#ifdef EACH_RECEIVER
#define COPY_RECEIVER(i) own_receiver[i] = receivers[i];
  EACH_RECEIVER(COPY_RECEIVER)
#endif
#ifdef EACH_PLANE
#define COPY_PLANE(i) own_plane[i] = planes[i];
  EACH_PLANE(COPY_PLANE)
#endif
#ifdef EACH_SHADOW_PLANE
#define COPY_SHADOW_PLANE(i) own_shadow_plane[i] = shadow_planes[i];
  EACH_SHADOW_PLANE(COPY_SHADOW_PLANE)
#endif
}
