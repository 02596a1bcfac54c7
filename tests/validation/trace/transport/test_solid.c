/* Refractors that are convex solids by themselves, against Embree's triangles and spheres. */
#include "tests/random.h"
#include "tests/scenes/scene_text.h"

#include "validation/trace/transport/geometry.h"

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void make(const char *text, abbe_scene *scene, abbe_geometry *g) {
  *scene = scene_of(text);
  OK(abbe_geometry_make(scene, g, &error));
}

static void drop(abbe_scene *scene, abbe_geometry *g) {
  abbe_geometry_free(g);
  abbe_scene_free(scene);
}

/* From places within the solid. */
static void check_against_embree(const char *text) {
  abbe_scene scene;
  abbe_geometry g;
  make(text, &scene, &g);
  const abbe_solid *s = &g.solid[0];
  assert_true(abbe_solid_is(s));
  uint64_t random = 5;
  float o[3] = {0, 0, 0};
  for (int i = 0; i < 20000; i++) {
    float d[3], length = 0, p[3], n[3];
    for (int k = 0; k < 3; k++) {
      d[k] = (float)random_between(&random, -1, 1);
      length += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) d[k] /= sqrtf(length);
    float t = abbe_solid_leave(s, o, d, p, n);
    abbe_hit hit;
    assert_true(abbe_geometry_hit(&g, ABBE_GEOMETRY_REFRACTORS, o, d, INFINITY, &hit));
    for (int k = 0; k < 3; k++) assert_near((double)p[k], (double)hit.p[k], 1e-5);
    assert_true(t >= 0);
    assert_near((double)dot(n, n), 1, 1e-6);
    assert_true(dot(n, d) > 0);
    /* at an edge either of its faces may be met */
    float along = 0;
    for (int k = 0; k < 3; k++) along += n[k] * (hit.p[k] - p[k]);
    assert_near((double)along, 0, 1e-5);
    /* the next ray from a place on this one */
    for (int k = 0; k < 3; k++) o[k] = i % 2 ? 0 : o[k] + 0.95f * t * d[k];
  }
  drop(&scene, &g);
}

TEST(a_ray_leaves_where_embree_says) {
  check_against_embree(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  check_against_embree(
      CAMERA POINT_LIGHT FLOOR
      "- {name: stone, shape: brilliant, diameter: 0.1, transform: [{rotate: {axis: [1, 2, 0], "
      "angle: 30}}, {translate: [0, 0, 0.2]}], material: crown}\n");
  check_against_embree(CAMERA POINT_LIGHT FLOOR
                       "- {name: prism, shape: prism, side: 0.1, length: 0.1, transform: "
                       "[{translate: [0.3, 0, 0.2]}], material: crown}\n");
}

/* On a face, as rounding leaves it a little outside: at once, or across; never lost. */
TEST(rounding_at_a_face_loses_nothing) {
  abbe_scene scene;
  abbe_geometry g;
  make(CAMERA POINT_LIGHT FLOOR "- {name: stone, shape: brilliant, diameter: 0.1, transform: "
                                "[{translate: [0, 0, 0.2]}], material: crown}\n",
       &scene, &g);
  const abbe_solid *s = &g.solid[0];
  uint64_t random = 9;
  float o[3] = {0}, d[3] = {0, 0, 1}, p[3], n[3];
  for (int i = 0; i < 20000; i++) {
    float t = abbe_solid_leave(s, o, d, p, n);
    assert_true(t >= 0 && t < 3);
    for (int k = 0; k < 3; k++) o[k] = p[k] + 1e-7f * (float)(i % 3) * n[k];
    float length = 0;
    for (int k = 0; k < 3; k++) {
      d[k] = (float)random_between(&random, -1, 1) - n[k];
      length += d[k] * d[k];
    }
    for (int k = 0; k < 3; k++) d[k] /= sqrtf(length);
    if (dot(d, n) > 0)
      for (int k = 0; k < 3; k++) d[k] = -d[k];
  }
  drop(&scene, &g);
}

static void check_alone(const char *objects, const bool *alone) {
  abbe_scene scene;
  abbe_geometry g;
  make(printed(CAMERA POINT_LIGHT FLOOR "%s", objects), &scene, &g);
  for (size_t i = 0; i < g.refractor_count; i++)
    if (abbe_solid_is(&g.solid[i]) != alone[i])
      fail_msg("%zu is %s by itself: %s", i, alone[i] ? "not" : "", objects);
  drop(&scene, &g);
}

#define GLASS(name, shape, steps)                                                                  \
  "- {name: " name ", shape: " shape ", material: crown, transform: [" steps "]}\n"
#define WALL(name, shape, steps)                                                                   \
  "- {name: " name ", shape: " shape ", reflectance: 0.5, transform: [" steps "]}\n"
#define TURNED "{rotate: {axis: [0, 0, 1], angle: 45}}, "
#define CUBE "box, size: [0.1, 0.1, 0.1]"
#define AT(x, y, z) "{translate: [" x ", " y ", " z "]}"

TEST(what_another_surface_touches_is_none) {
  static const bool yes[] = {true, true}, no[] = {false, false}, second[] = {false, true};
  check_alone(GLASS("ball", "sphere, radius: 0.1", AT("0", "0", "0.101")), yes);
  check_alone(GLASS("ball", "sphere, radius: 0.1", AT("0", "0", "0.1")), no);
  check_alone(GLASS("cube", CUBE, AT("0", "0", "0.051")), yes);
  check_alone(GLASS("cube", CUBE, AT("0", "0", "0.05")), no);
  check_alone(GLASS("shell", "sphere, radius: 0.1", AT("0", "0", "0.3"))
                  GLASS("core", "sphere, radius: 0.05", AT("0", "0", "0.3")),
              no);
  check_alone(GLASS("cube", CUBE, AT("0", "0", "0.3"))
                  GLASS("bubble", "sphere, radius: 0.02", AT("0", "0", "0.3")),
              no);
  check_alone(GLASS("one", CUBE, AT("0", "0", "0.3")) GLASS("two", CUBE, AT("0.11", "0", "0.3")),
              yes);
  check_alone(GLASS("one", CUBE, AT("0", "0", "0.3")) GLASS("two", CUBE, AT("0.1", "0", "0.3")),
              no);
  /* their boxes meet, they do not */
  check_alone(GLASS("one", CUBE, TURNED AT("0", "0", "0.3"))
                  GLASS("two", CUBE, TURNED AT("0.09", "0.09", "0.3")),
              yes);
  check_alone(GLASS("ring", "ring, major: 0.1, minor: 0.02", AT("0", "0", "0.3"))
                  GLASS("ball", "sphere, radius: 0.02", AT("0", "0", "0.5")),
              second);
}

TEST(a_receiver_may_stand_around_it) {
  static const bool yes[] = {true}, no[] = {false};
  check_alone(WALL("room", "box, size: [1.5, 1.5, 1.1]", AT("0", "0", "0.6"))
                  GLASS("cube", CUBE, AT("0", "0", "0.4")),
              yes);
  check_alone(WALL("room", "box, size: [1.5, 1.5, 1.1]", AT("0", "0", "0.6"))
                  GLASS("ball", "sphere, radius: 0.1", AT("0", "0", "0.4")),
              yes);
  check_alone(WALL("leaf", "rectangle, width: 0.2, height: 0.2", AT("0", "0", "0.4"))
                  GLASS("cube", CUBE, AT("0", "0", "0.4")),
              no);
  check_alone(WALL("leaf", "rectangle, width: 0.2, height: 0.2", AT("0", "0", "0.4"))
                  GLASS("ball", "sphere, radius: 0.1", AT("0", "0", "0.4")),
              no);
  check_alone(WALL("speck", "rectangle, width: 0.01, height: 0.01", AT("0", "0", "0.4"))
                  GLASS("ball", "sphere, radius: 0.1", AT("0", "0", "0.4")),
              no);
}
