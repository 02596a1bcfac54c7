/* Directional lights in place of an environment: what they keep of it. */
#include "tests/scenes/scene_text.h"

#include "scenes/environment_lights.h"
#include "scenes/geometry/vector.h"

static const double PI = 3.14159265358979;

#define PLAIN CAMERA FLOOR

static void add(const char *environment, size_t count, abbe_scene *scene, abbe_scene *out) {
  char text[2048];
  abbe_error error = {0};
  snprintf(text, sizeof text, PLAIN "environment: %s\n", environment);
  load_text(text, scene);
  if (abbe_environment_lights_add(scene, count, 380, 780, out, &error) != ABBE_OK)
    fail_msg("%s", error.text);
}

static void drop(abbe_scene *scene, abbe_scene *lit) {
  abbe_environment_lights_drop(lit);
  abbe_scene_free(scene);
}

/* Light sums: irradiance on a plane of normal n that every one of them is before. */
static double shine(const abbe_scene *lit, const double n[3]) {
  double sum = 0;
  for (size_t i = 0; i < lit->light_count; i++)
    sum -= lit->light[i].power * abbe_vector_dot(lit->light[i].direction, n);
  return sum;
}

static void one_softbox_is_one_light(void **state) {
  (void)state;
  abbe_scene scene, lit;
  add("{softboxes: [{elevation: 60, azimuth: 30, radius: 10, radiance: 3}]}", 1, &scene, &lit);
  assert_int_equal(lit.light_count, 1);
  assert_int_equal(lit.environment_lights, 1);
  const double r = 10 * PI / 180, e = 60 * PI / 180, a = 30 * PI / 180;
  const double way[3] = {-cos(e) * cos(a), -cos(e) * sin(a), -sin(e)};
  /* across its middle a disk of constant radiance gives pi L sin^2 r */
  assert_near(lit.light[0].power / (PI * 3 * pow(sin(r), 2)), 1, 1e-3);
  for (int k = 0; k < 3; k++) assert_near(lit.light[0].direction[k], way[k], 1e-3);
  assert_int_equal(lit.light[0].kind, ABBE_LIGHT_DIRECTIONAL);
  drop(&scene, &lit);
}

/* However many there are, they shine on a plane as the environment does, if all are before it. */
static void a_floor_has_its_irradiance(void **state) {
  (void)state;
  static const double up[3] = {0, 0, 1};
  for (size_t count = 1; count <= 16; count++) {
    abbe_scene scene, lit;
    double rgb[3];
    add("{dome: cos, rotate: 40, softboxes: [{elevation: 30, width: 40, height: 20, radiance: 5}, "
        "{elevation: 70, azimuth: 130, radius: 5, radiance: 20}]}",
        count, &scene, &lit);
    assert_true(lit.light_count >= 1 && lit.light_count <= count);
    abbe_environment_irradiance(scene.environment, up, rgb);
    assert_near(shine(&lit, up) / rgb[1], 1, 5e-3);
    for (size_t i = 1; i < lit.light_count; i++)
      assert_true(lit.light[i].power <= lit.light[i - 1].power);
    drop(&scene, &lit);
  }
}

/* The more, the less is left out. */
static void more_lights_keep_more(void **state) {
  (void)state;
  double before = 0;
  for (size_t count = 1; count <= 16; count *= 2) {
    abbe_scene scene, lit;
    double kept = 0;
    add("{uniform: 1}", count, &scene, &lit);
    for (size_t i = 0; i < lit.light_count; i++) kept += lit.light[i].power;
    kept /= scene.environment->luminance;
    assert_true(kept > before - 1e-9 && kept <= 1 + 1e-9);
    before = kept;
    drop(&scene, &lit);
  }
  assert_true(before > 0.85);
}

static void colours_are_the_lights_own(void **state) {
  (void)state;
  abbe_scene scene, lit;
  add("{softboxes: [{elevation: 60, radius: 10, radiance: [1, 0.1, 0.1]}, {elevation: 60, azimuth: "
      "180, radius: 10, radiance: 0.4}]}",
      2, &scene, &lit);
  assert_int_equal(lit.light_count, 2);
  /* the grey one shines as the illuminant does, the red one less in blue */
  for (size_t i = 0; i < 2; i++) {
    const abbe_illuminant *own = &lit.light[i].illuminant;
    const double blue = abbe_illuminant_power(own, 450) / abbe_illuminant_power(own, 640);
    const abbe_illuminant *all = &scene.environment->illuminant;
    const double white = abbe_illuminant_power(all, 450) / abbe_illuminant_power(all, 640);
    if (lit.light[i].direction[0] > 0)
      assert_near(blue / white, 1, 1e-9);
    else
      assert_true(blue < 0.3 * white);
  }
  drop(&scene, &lit);
}

/* Also at the zenith, where texels are thin. */
static void a_lamp_at_the_zenith_is_no_brighter(void **state) {
  (void)state;
  abbe_scene scene, lit;
  add("{softboxes: [{elevation: 90, radius: 3, radiance: 9}]}", 1, &scene, &lit);
  const double r = 3 * PI / 180;
  assert_near(lit.light[0].power / (PI * 9 * pow(sin(r), 2)), 1, 2e-3);
  assert_near(lit.light[0].direction[2], -1, 1e-6);
  drop(&scene, &lit);
}

static void own_lights_stay_and_leave_room(void **state) {
  (void)state;
  abbe_scene scene, lit;
  load_text(CAMERA POINT_LIGHT FLOOR "environment: {uniform: 1}\n", &scene);
  assert_int_equal(abbe_environment_lights_add(&scene, 99, 380, 780, &lit, NULL), ABBE_OK);
  assert_int_equal(lit.light_count, ABBE_SCENE_MAX_LIGHTS);
  assert_int_equal(lit.environment_lights, ABBE_SCENE_MAX_LIGHTS - 1);
  assert_string_equal(lit.light[0].name, "lamp");
  assert_string_equal(lit.light[1].name, "environment 1");
  drop(&scene, &lit);
  load_text(CAMERA POINT_LIGHT FLOOR, &scene);
  assert_int_equal(abbe_environment_lights_add(&scene, 4, 380, 780, &lit, NULL), ABBE_OK);
  assert_int_equal(lit.light_count, 1);
  assert_int_equal(lit.environment_lights, 0);
  drop(&scene, &lit);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(one_softbox_is_one_light),
                                     cmocka_unit_test(a_floor_has_its_irradiance),
                                     cmocka_unit_test(more_lights_keep_more),
                                     cmocka_unit_test(colours_are_the_lights_own),
                                     cmocka_unit_test(a_lamp_at_the_zenith_is_no_brighter),
                                     cmocka_unit_test(own_lights_stay_and_leave_room)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
