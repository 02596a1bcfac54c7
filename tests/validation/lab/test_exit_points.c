/* Points on an object's surface: even by area, on the surface, of every wavelength by its chance.
 */
#include "tests/validation/trace_scene.h"

#include "validation/lab/exit_fill.h"

#define PI 3.14159265358979323846
enum { COUNT = 8192 };

static void make_points(const char *objects, abbe_scene *scene, abbe_lone_object *lone,
                        abbe_exit_points *points) {
  static double unit_map[1][9] = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const abbe_body_symmetry none = {1, unit_map};
  *scene = scene_of(printed("%s%s", CAMERA SUN FLOOR, objects));
  OK(abbe_lone_object_make(scene, 1, 0, lone, &error));
  OK(abbe_exit_points_make(lone, &none, COUNT, 380, 780, 0, points, &error));
  assert_int_equal(points->count, COUNT);
}

static void free_points(abbe_scene *scene, abbe_lone_object *lone, abbe_exit_points *points) {
  abbe_exit_points_free(points);
  abbe_lone_object_free(lone);
  abbe_scene_free(scene);
}

TEST(a_ball) {
  abbe_scene scene = {0};
  abbe_lone_object lone;
  abbe_exit_points points;
  double mean[3] = {0}, square[3] = {0};
  make_points(BALL("crown"), &scene, &lone, &points);
  assert_near(points.area, 4 * PI * 0.08 * 0.08, 1e-6);
  const abbe_surface *s = &lone.geometry.surface[0];
  for (size_t i = 0; i < COUNT; i++)
    for (int k = 0; k < 3; k++) {
      const abbe_exit_point *p = &points.point[i];
      assert_near((double)p->place[k],
                  (double)s->centre[k] + (double)s->radius * (double)p->normal[k], 1e-6);
      mean[k] += (double)p->normal[k] / COUNT;
      square[k] += (double)p->normal[k] * (double)p->normal[k] / COUNT;
    }
  for (int k = 0; k < 3; k++) {
    assert_near(mean[k], 0, 1e-3); /* at random 6e-3 */
    assert_near(square[k], 1.0 / 3, 1e-3);
  }
  free_points(&scene, &lone, &points);
}

/* Faces have points by their areas; wavelengths and decisions are even. */
TEST(a_brick) {
  static const double size[3] = {0.1, 0.08, 0.06};
  abbe_scene scene = {0};
  abbe_lone_object lone;
  abbe_exit_points points;
  double side[3] = {0}, bin = 0, expected = 0, chance[ABBE_LIGHT_EXITS_BINS], first = 0;
  make_points(BRICK("crown"), &scene, &lone, &points);
  const double area = 2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
  assert_near(points.area, area, 1e-6);
  for (size_t i = 0; i < COUNT; i++) {
    const abbe_exit_point *p = &points.point[i];
    for (int k = 0; k < 3; k++) side[k] += fabs((double)p->normal[k]) / COUNT;
    bin += (double)p->bin / COUNT;
    first += (double)p->chance[0] / COUNT;
    for (int k = 0; k < ABBE_EXIT_WALK_CHANCES; k++)
      assert_true(p->chance[k] >= 0 && p->chance[k] < 1);
  }
  for (int k = 0; k < 3; k++)
    assert_near(side[k], 2 * size[(k + 1) % 3] * size[(k + 2) % 3] / area, 2e-3);
  abbe_light_exits_chances(380, 780, chance);
  for (size_t i = 0; i < ABBE_LIGHT_EXITS_BINS; i++) expected += (double)i * chance[i];
  assert_near(bin, expected, 0.2);
  assert_near(first, 0.5, 2e-3);
  free_points(&scene, &lone, &points);
}

/* A sheet of metal reflects on both sides. */
TEST(an_open_mirror) {
  abbe_scene scene = {0};
  abbe_lone_object lone;
  abbe_exit_points points;
  size_t up = 0;
  make_points("- {name: pane, shape: rectangle, width: 0.1, height: 0.2, mirror: 0.9, transform: "
              "[{translate: [0, 0, 0.2]}]}\n",
              &scene, &lone, &points);
  assert_near(points.area, 0.04, 1e-7);
  for (size_t i = 0; i < COUNT; i++) up += points.point[i].normal[2] > 0;
  assert_int_equal(up, COUNT / 2);
  free_points(&scene, &lone, &points);
}
